//! Errors and warnings of a Kinect, with advice.

use std::path::PathBuf;

use thiserror::Error;

use super::{FREENECT, freenect::Failed};
use crate::{
    CameraLibraryError, Recovery,
    error::{only, quoted},
};
use geometry::error::Advice;

/// Why a Kinect cannot be used, or delivers no more.
#[derive(Debug, Error)]
pub enum KinectError {
    /// libfreenect cannot be used.
    #[error(transparent)]
    Library(#[from] CameraLibraryError),
    /// The library cannot access USB.
    #[error("libfreenect cannot start: USB error {code}")]
    NoUsb {
        /// libusb's error code.
        code: i32,
    },
    /// No Kinect is plugged in.
    #[error("no Kinect is plugged in")]
    NoDevice,
    /// Other Kinects are plugged in, but not the requested one.
    #[error("no Kinect with serial number {serial} is plugged in{}", only(found))]
    NoSuchSerial {
        /// The requested serial number.
        serial: String,
        /// Serial numbers of those that are plugged in.
        found: Vec<String>,
    },
    /// The system does not permit this user to open the Kinect.
    #[error("a Kinect is plugged in, but the system does not allow it to be opened")]
    NoPermission {
        /// The installed udev rule that should permit it, if any.
        rule: Option<&'static str>,
    },
    /// Another program, or a driver of the system, uses the Kinect.
    #[error("the Kinect is in use by another program")]
    Busy,
    /// This program already uses a Kinect.
    #[error("the Kinect is in use by Partsight itself")]
    InUse,
    /// The Kinect cannot be opened for another reason.
    #[error("the Kinect cannot be opened{}", quoted(said.first()))]
    NotOpened {
        /// The library's messages.
        said: Vec<String>,
    },
    /// The Kinect offers depth in no supported format.
    #[error("the Kinect offers depth in none of the supported formats (millimetres, 11 bits)")]
    NoDepthMode,
    /// The Kinect opens, but its stream does not start.
    #[error("the Kinect cannot be started{}", quoted(said.first()))]
    NotStarted {
        /// The library's messages.
        said: Vec<String>,
    },
    /// The Kinect was unplugged, or lost its power.
    #[error("the connection to the Kinect was lost{}", quoted(said.first()))]
    Lost {
        /// The library's messages.
        said: Vec<String>,
    },
    /// The Kinect is there but sends nothing.
    #[error("the Kinect sent nothing for {seconds} s")]
    Silent {
        /// For how long, seconds.
        seconds: u64,
    },
    /// The library plays recorded sessions, and none is given.
    #[error("{library} plays recorded sessions, but FAKENECT_PATH names none")]
    NoSession {
        /// Name or path of the library.
        library: String,
    },
    /// The recorded session is damaged.
    #[error("{}: {what}", path.display())]
    SessionUnusable {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        what: String,
    },
}

/// Udev rules that let a user open a Kinect, under the names used by distributions and by our own package.
const RULES: [&str; 6] = [
    "/lib/udev/rules.d/60-libfreenect0.5.rules",
    "/usr/lib/udev/rules.d/60-libfreenect.rules",
    "/etc/udev/rules.d/51-kinect.rules",
    "/etc/udev/rules.d/66-kinect.rules",
    "/usr/lib/udev/rules.d/55-partsight-cameras.rules",
    "/etc/udev/rules.d/55-partsight-cameras.rules",
];

impl KinectError {
    /// How to recover: a Kinect may be plugged in, released or permitted at any time; a library does not appear by itself.
    pub fn recovery(&self) -> Recovery {
        match self {
            Self::NoDevice
            | Self::NoSuchSerial { .. }
            | Self::NoPermission { .. }
            | Self::Busy
            | Self::InUse
            | Self::NotOpened { .. }
            | Self::NotStarted { .. }
            | Self::Lost { .. }
            | Self::Silent { .. } => Recovery::Reopen,
            Self::Library(_)
            | Self::NoUsb { .. }
            | Self::NoDepthMode
            | Self::NoSession { .. }
            | Self::SessionUnusable { .. } => Recovery::None,
        }
    }

    pub(super) fn no_permission() -> Self {
        let rule = RULES
            .into_iter()
            .find(|rule| std::path::Path::new(rule).is_file());
        Self::NoPermission { rule }
    }

    /// Classifies the failure to open a camera. The library returns -1 for every failure and logs the reason as a line that
    /// ends with libusb's code or contains its name.
    pub(super) fn of_opening(failed: Failed) -> Self {
        let says = |code: i32, name: &str| {
            let tail = format!(": {code}");
            failed.code == code
                || failed
                    .said
                    .iter()
                    .any(|line| line.ends_with(&tail) || line.contains(name))
        };
        if says(-3, "LIBUSB_ERROR_ACCESS") {
            Self::no_permission()
        } else if says(-6, "LIBUSB_ERROR_BUSY") {
            Self::Busy
        } else if says(-4, "LIBUSB_ERROR_NO_DEVICE") {
            Self::Lost { said: failed.said }
        } else {
            Self::NotOpened { said: failed.said }
        }
    }
}

impl Advice for KinectError {
    fn advice(&self) -> String {
        match self {
            Self::Library(error) => error.advice(),
            Self::NoUsb { .. } => {
                "Check that this computer has USB and that the user may use it, then start again".into()
            }
            Self::NoDevice => {
                "Plug the Kinect in, and its own power supply too: without it only its motor is seen".into()
            }
            Self::NoSuchSerial { .. } => {
                "Plug that one in, or choose the source without a serial number to take whichever is there".into()
            }
            Self::NoPermission { rule: Some(rule) } => format!(
                "Add your user to the group plugdev, log in again and plug the Kinect in again, so that {rule} applies to it"
            ),
            Self::NoPermission { rule: None } => format!(
                "Install the udev rule that permits it ({}), then plug the Kinect in again",
                FREENECT.install
            ),
            Self::Busy => "Close the other program that shows the Kinect's picture, then try again".into(),
            Self::InUse => "Use the Kinect where it is open already, or close it there first".into(),
            Self::NotOpened { .. } => "Unplug the Kinect and plug it in again".into(),
            Self::NoDepthMode => {
                format!("Install another build of libfreenect ({})", FREENECT.install)
            }
            Self::NotStarted { .. } => {
                "Plug the Kinect into another USB socket, with no other camera on the same hub".into()
            }
            Self::Lost { .. } => "Check the Kinect's cable and its power supply".into(),
            Self::Silent { .. } => {
                "Check the Kinect's power supply, and plug it into a USB socket of the computer itself, not of a hub".into()
            }
            Self::NoSession { .. } => {
                "Set FAKENECT_PATH to a recorded session, or take the fakenect folder out of the library's path to use a Kinect".into()
            }
            Self::SessionUnusable { .. } => {
                "Record the session again, or take what is damaged out of its INDEX.txt".into()
            }
        }
    }
}

/// Something odd about a Kinect that can be used nevertheless.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum KinectWarning {
    /// The library does not reveal the camera's focal length.
    #[error("the Kinect's focal length is not known; {pixels:.1} pixels are assumed")]
    FocalLengthAssumed {
        /// The assumed focal length along columns and rows, pixels.
        pixels: f64,
    },
    /// The library delivers steps of disparity without the values to convert them into lengths.
    #[error("the Kinect's own calibration is not known; that of a typical Kinect is assumed")]
    DepthScaleAssumed,
}

impl Advice for KinectWarning {
    fn advice(&self) -> String {
        "Use the system's libfreenect 0.5 with a Kinect: it reads these values from the camera"
            .into()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::check_messages;

    fn failed(said: &str) -> Failed {
        Failed {
            code: -1,
            said: vec![said.into(), "Failed to open camera subdevice".into()],
        }
    }

    #[test]
    fn the_reason_is_found_in_what_the_library_says() {
        for (said, expected) in [
            ("Could not open camera: -3", "does not allow"),
            ("Could not open camera: -4", "was lost"),
            (
                "Failed to claim camera interface: LIBUSB_ERROR_BUSY",
                "another program",
            ),
            (
                "Failed to detach camera kernel driver: LIBUSB_ERROR_ACCESS",
                "does not allow",
            ),
            (
                "freenect_camera_init(): Failed to fetch const shift for device",
                "cannot be opened: ",
            ),
        ] {
            let error = KinectError::of_opening(failed(said));
            assert!(error.to_string().contains(expected), "{said}: {error}");
            assert_eq!(error.recovery(), Recovery::Reopen);
        }
    }

    #[test]
    fn every_trouble_has_a_sentence_and_an_advice_of_its_own() {
        let (library, said) = (String::from("libfreenect.so"), Vec::new());
        let errors = [
            KinectError::NoUsb { code: -99 },
            KinectError::NoDevice,
            KinectError::NoSuchSerial {
                serial: "A".into(),
                found: vec!["B".into()],
            },
            KinectError::NoPermission { rule: None },
            KinectError::NoPermission {
                rule: Some(RULES[0]),
            },
            KinectError::Busy,
            KinectError::InUse,
            KinectError::NotOpened { said: said.clone() },
            KinectError::NoDepthMode,
            KinectError::NotStarted { said: said.clone() },
            KinectError::Lost { said },
            KinectError::Silent { seconds: 5 },
            KinectError::NoSession { library },
            KinectError::SessionUnusable {
                path: "INDEX.txt".into(),
                what: "not there".into(),
            },
        ];
        check_messages(&errors);
    }
}
