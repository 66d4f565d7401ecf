//! Errors and warnings of GenICam cameras, with advice.

use thiserror::Error;

use crate::{CameraLibraryError, Recovery, error::quoted};
use geometry::error::Advice;

/// Why a GenICam camera cannot be used or delivers no more, or why a frame cannot be read.
#[derive(Debug, Error)]
pub enum GenicamError {
    /// aravis cannot be used.
    #[error(transparent)]
    Library(#[from] CameraLibraryError),
    /// No camera answered.
    #[error("no GenICam camera answers on any network interface or USB port")]
    NoDevice,
    /// Other cameras answered, but not the requested one.
    #[error("no GenICam camera {device} answers, only {}", found.join(", "))]
    NoSuchDevice {
        /// The requested camera.
        device: String,
        /// IDs of the cameras that answered.
        found: Vec<String>,
    },
    /// The camera cannot be opened, or one of its nodes cannot be read.
    #[error("the camera cannot be opened: {said}")]
    NotOpened {
        /// The library's message.
        said: String,
    },
    /// Another program controls the camera.
    #[error("the camera is in use by another program")]
    InUse,
    /// The camera offers no format that is known to be depth.
    #[error("the camera offers no depth, only {}", offered.join(", "))]
    NoDepthFormat {
        /// Its pixel formats.
        offered: Vec<String>,
    },
    /// The camera does not offer the requested pixel format.
    #[error("the camera does not offer {format}, only {}", offered.join(", "))]
    FormatNotOffered {
        /// The requested format.
        format: &'static str,
        /// Its pixel formats.
        offered: Vec<String>,
    },
    /// The camera lacks a value that is needed to convert its pixels into lengths.
    #[error("the camera does not report its {node}, which its depth images need")]
    Untold {
        /// The missing node.
        node: &'static str,
    },
    /// The camera is set to something other than depth along the optical axis, or points in its own frame.
    #[error("{node} of the camera is {found}, expected {expected}")]
    WrongSetting {
        /// The node.
        node: &'static str,
        /// Its value.
        found: String,
        /// The value to set.
        expected: &'static str,
    },
    /// The camera opens, but its stream does not start.
    #[error("the camera cannot be started: {said}")]
    NotStarted {
        /// The library's message.
        said: String,
    },
    /// A frame is incomplete, or not an image of the expected kind.
    #[error("a frame of the camera cannot be used: {what}")]
    BadFrame {
        /// What is wrong with it.
        what: String,
    },
    /// The camera was unplugged, lost its power, or was taken by another program.
    #[error("the connection to the camera was lost{}", quoted(said.as_ref()))]
    Lost {
        /// The library's message.
        said: Option<String>,
    },
    /// The camera answers but sends nothing.
    #[error("the camera sent nothing for {seconds} s")]
    Silent {
        /// For how long, seconds.
        seconds: u64,
    },
}

impl GenicamError {
    /// How to recover: a camera may be plugged in, released or configured at any time; a library does not appear by itself.
    pub fn recovery(&self) -> Recovery {
        match self {
            Self::NoDevice
            | Self::NoSuchDevice { .. }
            | Self::NotOpened { .. }
            | Self::InUse
            | Self::NotStarted { .. }
            | Self::Lost { .. }
            | Self::Silent { .. } => Recovery::Reopen,
            Self::BadFrame { .. } => Recovery::AskAgain,
            Self::Library(_)
            | Self::NoDepthFormat { .. }
            | Self::FormatNotOffered { .. }
            | Self::Untold { .. }
            | Self::WrongSetting { .. } => Recovery::None,
        }
    }
}

impl Advice for GenicamError {
    fn advice(&self) -> String {
        match self {
            Self::Library(error) => error.advice(),
            Self::NoDevice => {
                "Check the camera's power and cable, and that a GigE camera has an address in the network of this computer".into()
            }
            Self::NoSuchDevice { .. } => {
                "Connect that one, or list the cameras and choose another: partsight capture --list"
                    .into()
            }
            Self::NotOpened { .. } => {
                "Close other programs that use the camera; for a USB camera, install the udev rule that lets your user open it"
                    .into()
            }
            Self::InUse => "Close the other program, then try again".into(),
            Self::NoDepthFormat { .. } => {
                "Use a 3-D camera; if its Mono16 is depth, say so and give its numbers: genicam,format=Mono16,camera=FILE".into()
            }
            Self::FormatNotOffered { .. } => {
                "Leave the source's format option out, or name one that the camera offers".into()
            }
            Self::Untold { .. } => {
                "Give the camera's numbers as they stand beside a depth PNG: genicam,camera=FILE"
                    .into()
            }
            Self::WrongSetting { node, expected, .. } => {
                format!("Set {node} to {expected} with the camera's own program")
            }
            Self::NotStarted { .. } => {
                "Switch the camera off and on again, and set a smaller picture if its pictures are very large"
                    .into()
            }
            Self::BadFrame { .. } => {
                "Connect the camera to a port of its own; for a GigE camera, use jumbo frames (MTU 9000)"
                    .into()
            }
            Self::Lost { .. } => "Check the camera's cable and its power supply".into(),
            Self::Silent { .. } => {
                "Set TriggerMode to Off with the camera's own program, and let the firewall pass UDP from the camera".into()
            }
        }
    }
}

/// Something odd about a GenICam camera that can be used nevertheless.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum GenicamWarning {
    /// The camera has no `Scan3dDistanceUnit`.
    #[error("the camera does not report its unit of length; millimetres are assumed")]
    UnitAssumed,
}

impl Advice for GenicamWarning {
    fn advice(&self) -> String {
        "Compare the size of a part in the 3-D view with the real one".into()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::check_messages;

    #[test]
    fn every_trouble_has_a_sentence_and_an_advice_of_its_own() {
        let said = String::from("timeout");
        let offered = vec![String::from("Mono8")];
        let errors = [
            GenicamError::NoDevice,
            GenicamError::NoSuchDevice {
                device: "A".into(),
                found: vec!["B".into()],
            },
            GenicamError::NotOpened { said: said.clone() },
            GenicamError::InUse,
            GenicamError::NoDepthFormat {
                offered: offered.clone(),
            },
            GenicamError::FormatNotOffered {
                format: "Mono16",
                offered,
            },
            GenicamError::Untold {
                node: "Scan3dFocalLength",
            },
            GenicamError::WrongSetting {
                node: "Scan3dOutputMode",
                found: "DisparityC".into(),
                expected: "CalibratedC",
            },
            GenicamError::NotStarted { said: said.clone() },
            GenicamError::BadFrame { what: said.clone() },
            GenicamError::Lost { said: Some(said) },
            GenicamError::Silent { seconds: 8 },
        ];
        check_messages(&errors);
    }
}
