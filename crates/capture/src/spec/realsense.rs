//! The options of a RealSense camera.

use std::{
    fmt,
    path::{Path, PathBuf},
};

use super::{
    Pace, REALSENSE, SpecError,
    options::{Options, escaped},
    recorded_file, write_camera, write_pace,
};

/// A RealSense camera, or a file that librealsense recorded.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RealsenseSpec {
    /// Serial number of the camera, or the path of a file that ends in `.bag` or `.db3`; `None` for the first camera that
    /// is found.
    pub device: Option<String>,
    /// Name of the visual preset to set, ignoring case; `None` to keep the camera's present one.
    pub preset: Option<String>,
    /// Pace of a file; `None` for each frame as soon as it is requested.
    pub pace: Option<Pace>,
    /// File or folder with the librealsense library; `None` for the system's.
    pub library: Option<PathBuf>,
}

impl RealsenseSpec {
    pub(super) const OPTIONS: &'static str = "preset pace library";

    pub(super) fn read(device: Option<&str>, options: &Options) -> Result<Self, SpecError> {
        let preset = |name: &str| Some(name.to_owned()).filter(|name| !name.is_empty());
        let spec = Self {
            device: device.map(str::to_owned),
            preset: options.value("preset", "a name", preset)?,
            pace: Pace::of_option(options)?,
            library: options.value("library", "a path", |path| Some(PathBuf::from(path)))?,
        };
        let (what, expected) = match spec.file() {
            None if spec.pace.is_some() => {
                ("realsense with a pace", "a file that ends in .bag or .db3")
            }
            Some(_) if spec.preset.is_some() => ("realsense with a preset", "a camera and no file"),
            _ => return Ok(spec),
        };
        Err(SpecError::BadValue {
            what,
            found: spec.device.unwrap_or_default(),
            expected: expected.to_owned(),
        })
    }

    /// The file to play; `None` for a camera.
    pub fn file(&self) -> Option<&Path> {
        recorded_file(self.device.as_deref(), &["bag", "db3"])
    }

    pub(super) fn title(&self) -> String {
        match (self.file(), &self.device) {
            (Some(file), _) => format!("Recording {}", file.display()),
            (None, Some(serial)) => format!("RealSense {serial}"),
            (None, None) => "RealSense".into(),
        }
    }

    pub(super) fn write(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            device,
            preset,
            pace,
            library,
        } = self;
        f.write_str(REALSENSE)?;
        if let Some(preset) = preset {
            write!(f, ",preset={}", escaped(preset))?;
        }
        write_pace(f, *pace)?;
        write_camera(f, library.as_deref(), device.as_deref())
    }
}
