//! The options of a GenICam camera.

use std::{fmt, path::PathBuf};

use super::{
    SpecError,
    options::{Options, escaped},
    write_camera,
};

/// A GenICam camera: GigE Vision or USB3 Vision.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct GenicamSpec {
    /// The camera's ID as shown by `capture --list`, or its IP address; `None` for the first that answers.
    pub device: Option<String>,
    /// The pixel format to set; `None` for depth if its numbers are known, else points.
    pub format: Option<GenicamFormat>,
    /// File with the numbers of the depth images, like the JSON beside a depth PNG, used in place of the camera's own.
    pub camera: Option<PathBuf>,
    /// File or folder with the aravis library; `None` for the system's.
    pub library: Option<PathBuf>,
}

/// A supported pixel format, named as in the Pixel Format Naming Convention.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GenicamFormat {
    /// `Coord3D_C16`: depth, 16 bits.
    Coord3dC16,
    /// `Coord3D_ABC32f`: points, three 32-bit floating-point numbers.
    Coord3dAbc32f,
    /// `Mono16`, grey values in most cameras; here it is depth.
    Mono16,
}

impl GenicamFormat {
    const ALL: [Self; 3] = [Self::Coord3dC16, Self::Coord3dAbc32f, Self::Mono16];

    /// The name used by cameras.
    pub fn name(self) -> &'static str {
        match self {
            Self::Coord3dC16 => "Coord3D_C16",
            Self::Coord3dAbc32f => "Coord3D_ABC32f",
            Self::Mono16 => "Mono16",
        }
    }

    /// The number used in frames.
    pub fn number(self) -> u32 {
        match self {
            Self::Coord3dC16 => 0x0110_00B8,
            Self::Coord3dAbc32f => 0x0260_00C0,
            Self::Mono16 => 0x0110_0007,
        }
    }
}

impl GenicamSpec {
    pub(super) const OPTIONS: &'static str = "format camera library";

    pub(super) fn read(device: Option<&str>, options: &Options) -> Result<Self, SpecError> {
        let path =
            |text: &str| Some(PathBuf::from(text)).filter(|path| !path.as_os_str().is_empty());
        let format = |name: &str| {
            let mut formats = GenicamFormat::ALL.into_iter();
            formats.find(|format| format.name() == name)
        };
        Ok(Self {
            device: device.map(str::to_owned),
            format: options.value(
                "format",
                "Coord3D_C16, Coord3D_ABC32f, or Mono16 if it is depth",
                format,
            )?,
            camera: options.value("camera", "a file", path)?,
            library: options.value("library", "a path", path)?,
        })
    }

    pub fn title(&self) -> String {
        match &self.device {
            None => "GenICam".into(),
            Some(device) => format!("GenICam {device}"),
        }
    }

    pub(super) fn write(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            device,
            format,
            camera,
            library,
        } = self;
        f.write_str(super::GENICAM)?;
        if let Some(format) = format {
            write!(f, ",format={}", format.name())?;
        }
        if let Some(camera) = camera {
            write!(f, ",camera={}", escaped(&camera.to_string_lossy()))?;
        }
        write_camera(f, library.as_deref(), device.as_deref())
    }
}
