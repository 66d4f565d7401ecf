//! Errors of RealSense cameras, with advice.

use std::path::{Path, PathBuf};

use thiserror::Error;

use super::REALSENSE;
use crate::{
    CameraLibraryError, Recovery,
    error::{only, quoted},
};
use geometry::error::Advice;

/// Why a RealSense camera or file cannot be used, or delivers no more.
#[derive(Debug, Error)]
pub enum RealsenseError {
    /// librealsense cannot be used.
    #[error(transparent)]
    Library(#[from] CameraLibraryError),
    /// The library does not start.
    #[error("librealsense2 cannot be started: {said}")]
    LibraryNotStarted {
        /// The library's message.
        said: String,
    },
    /// No camera is plugged in.
    #[error("no RealSense camera is plugged in")]
    NoDevice,
    /// Other cameras are plugged in, but not the requested one.
    #[error("no RealSense camera {serial} is plugged in, only {}", found.join(", "))]
    NoSuchDevice {
        /// The requested serial number.
        serial: String,
        /// Serial numbers of those that are plugged in.
        found: Vec<String>,
    },
    /// The camera is plugged in but cannot be opened.
    #[error("the RealSense camera cannot be opened: {said}")]
    NotOpened {
        /// The library's message.
        said: String,
    },
    /// The camera has no 16-bit depth: it is a tracking camera, or waits for its firmware.
    #[error("{title} has no depth")]
    NoDepth {
        /// The camera.
        title: String,
    },
    /// The camera has no preset of that name.
    #[error("{title} has no preset {preset:?}{}", only(offered))]
    NoSuchPreset {
        /// The camera.
        title: String,
        /// The requested preset.
        preset: String,
        /// Names of the camera's presets.
        offered: Vec<String>,
    },
    /// The depth image has a distortion model that is not supported.
    #[error(
        "{title} gives the distortion of its depth image by the {model} model, which Partsight does not read"
    )]
    UnknownLens {
        /// The camera or file.
        title: String,
        /// Name of the model.
        model: &'static str,
    },
    /// The camera reports impossible numbers.
    #[error("{title} reports impossible intrinsics: {what}")]
    BadNumbers {
        /// The camera or file.
        title: String,
        /// The numbers.
        what: String,
    },
    /// The camera opens, but its stream does not start.
    #[error("the RealSense camera cannot be started: {said}")]
    NotStarted {
        /// The library's message.
        said: String,
    },
    /// The camera was unplugged, or reports an error.
    #[error("the connection to the RealSense camera was lost{}", quoted(said.as_ref()))]
    Lost {
        /// The library's message.
        said: Option<String>,
    },
    /// The camera is there but sends nothing.
    #[error("the RealSense camera sent nothing for {seconds} s")]
    Silent {
        /// For how long, seconds.
        seconds: u64,
    },
    /// The recorded file is not a librealsense recording, or is damaged.
    #[error("{}: {what}", path.display())]
    FileUnusable {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        what: String,
    },
}

impl RealsenseError {
    /// How to recover: a camera may be plugged in, released, permitted or updated at any time; a library or a file does not
    /// appear by itself.
    pub fn recovery(&self) -> Recovery {
        match self {
            Self::NoDevice
            | Self::NoSuchDevice { .. }
            | Self::NotOpened { .. }
            | Self::NoDepth { .. }
            | Self::NotStarted { .. }
            | Self::Lost { .. }
            | Self::Silent { .. } => Recovery::Reopen,
            Self::Library(_)
            | Self::LibraryNotStarted { .. }
            | Self::NoSuchPreset { .. }
            | Self::UnknownLens { .. }
            | Self::BadNumbers { .. }
            | Self::FileUnusable { .. } => Recovery::None,
        }
    }

    /// Converts the error for a file, where it has other causes than for a camera.
    pub(super) fn of_file(self, path: &Path) -> Self {
        let what = match self {
            Self::NotOpened { said } | Self::NotStarted { said } => {
                format!("librealsense cannot play it: {said}")
            }
            Self::Lost { said } => {
                format!(
                    "librealsense cannot play the rest of it{}",
                    quoted(said.as_ref())
                )
            }
            Self::NoDepth { .. } | Self::Silent { .. } => {
                "it has no depth image that can be read".to_owned()
            }
            other => return other,
        };
        Self::FileUnusable {
            path: path.to_path_buf(),
            what,
        }
    }
}

impl Advice for RealsenseError {
    fn advice(&self) -> String {
        match self {
            Self::Library(error) => error.advice(),
            Self::LibraryNotStarted { .. } => {
                format!("Install a newer librealsense 2 ({})", REALSENSE.install)
            }
            Self::NoDevice => {
                "Plug the camera in, with a cable for USB 3; if it is plugged in, install the udev rule that lets \
                 your user open it".into()
            }
            Self::NoSuchDevice { .. } => {
                "Plug that one in, or list the cameras and choose another: partsight capture --list".into()
            }
            Self::NotOpened { .. } => {
                "Close other programs that use the camera; if there are none, install the udev rule that lets your user open it, and plug it in again".into()
            }
            Self::NoDepth { .. } => {
                "Use a depth camera, and update its firmware with its maker's RealSense Viewer".into()
            }
            Self::NoSuchPreset { offered, .. } if offered.is_empty() => {
                "Leave the source's preset option out".into()
            }
            Self::NoSuchPreset { .. } => {
                "Leave the source's preset option out, or name one that the camera has".into()
            }
            Self::UnknownLens { .. } => {
                "Use a camera whose depth image is not distorted, such as one of the D400 family".into()
            }
            Self::BadNumbers { .. } => {
                "Restore the camera's factory calibration with its maker's RealSense Viewer".into()
            }
            Self::NotStarted { .. } => {
                "Close other programs that use the camera; if there are none, plug it into another USB 3 socket, with no other camera on the same hub".into()
            }
            Self::Lost { .. } => "Check the camera's cable".into(),
            Self::Silent { .. } => {
                "Plug the camera into a USB 3 socket of the computer itself, not of a hub".into()
            }
            Self::FileUnusable { .. } => {
                "Check the name, or copy or record the file again".into()
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::check_messages;

    #[test]
    fn every_trouble_has_a_sentence_and_an_advice_of_its_own() {
        let (title, said) = (String::from("It"), String::from("no"));
        let errors = [
            RealsenseError::LibraryNotStarted { said: said.clone() },
            RealsenseError::NoDevice,
            RealsenseError::NoSuchDevice {
                serial: "1".into(),
                found: vec!["2".into()],
            },
            RealsenseError::NotOpened { said: said.clone() },
            RealsenseError::NoDepth {
                title: title.clone(),
            },
            RealsenseError::NoSuchPreset {
                title: title.clone(),
                preset: "High".into(),
                offered: vec!["Default".into()],
            },
            RealsenseError::NoSuchPreset {
                title: title.clone(),
                preset: "High".into(),
                offered: Vec::new(),
            },
            RealsenseError::UnknownLens {
                title: title.clone(),
                model: "F-Theta",
            },
            RealsenseError::BadNumbers {
                title,
                what: "a focal length of 0".into(),
            },
            RealsenseError::NotStarted { said: said.clone() },
            RealsenseError::Lost { said: Some(said) },
            RealsenseError::Silent { seconds: 5 },
            RealsenseError::FileUnusable {
                path: "a.bag".into(),
                what: "cut off".into(),
            },
        ];
        check_messages(&errors);
    }

    #[test]
    fn what_keeps_a_file_from_playing_names_the_file() {
        let path = Path::new("a.bag");
        let said = || "bad header".to_owned();
        for error in [
            RealsenseError::NotOpened { said: said() },
            RealsenseError::NotStarted { said: said() },
            RealsenseError::Lost { said: Some(said()) },
        ] {
            let error = error.of_file(path);
            assert!(error.to_string().starts_with("a.bag: "), "{error}");
            assert!(error.to_string().ends_with(": bad header"), "{error}");
            assert_eq!(error.recovery(), Recovery::None);
        }
        let title = String::from("It");
        let error = RealsenseError::NoDepth { title }.of_file(path);
        assert_eq!(error.recovery(), Recovery::None, "{error}");
        let other = RealsenseError::LibraryNotStarted { said: said() }.of_file(path);
        assert!(
            other
                .to_string()
                .starts_with("librealsense2 cannot be started"),
            "{other}"
        );
    }
}
