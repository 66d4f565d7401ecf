//! Errors of OpenNI, with advice.

use std::path::PathBuf;

use thiserror::Error;

use super::OPENNI;
use crate::{
    CameraLibraryError, Recovery,
    error::{only, quoted},
};
use geometry::error::Advice;

/// Why an OpenNI camera or file cannot be used, or delivers no more.
#[derive(Debug, Error)]
pub enum OpenNiError {
    /// libOpenNI2 cannot be used.
    #[error(transparent)]
    Library(#[from] CameraLibraryError),
    /// The library does not start, usually because it finds no drivers.
    #[error("libOpenNI2 cannot be started{}", quoted(said.first()))]
    NoDrivers {
        /// The library's messages.
        said: Vec<String>,
    },
    /// This program uses OpenNI already.
    #[error("OpenNI is in use by Partsight itself")]
    InUse,
    /// No camera is plugged in.
    #[error("no OpenNI camera is plugged in")]
    NoDevice,
    /// Other cameras are plugged in, but not the requested one.
    #[error("no OpenNI camera {uri} is plugged in{}", only(found))]
    NoSuchDevice {
        /// The requested URI.
        uri: String,
        /// URIs of those that are plugged in.
        found: Vec<String>,
    },
    /// The camera is plugged in but cannot be opened.
    #[error("the OpenNI camera cannot be opened{}", quoted(said.first()))]
    NotOpened {
        /// The library's messages.
        said: Vec<String>,
    },
    /// The camera offers depth in no supported format.
    #[error("{title} offers depth neither in millimetres nor in tenths of a millimetre")]
    NoDepthMode {
        /// The camera or file.
        title: String,
    },
    /// The camera does not report its field of view.
    #[error("{title} does not report its field of view")]
    NoFieldOfView {
        /// The camera or file.
        title: String,
    },
    /// The camera does not report whether its picture is mirrored.
    #[error("{title} does not report whether its picture is mirrored")]
    MirroringUnknown {
        /// The camera or file.
        title: String,
    },
    /// The camera sends only a part of the picture.
    #[error("{title} sends only a part of its picture")]
    Cropped {
        /// The camera or file.
        title: String,
    },
    /// The mode or the mirroring has changed since the camera was opened.
    #[error("the picture of {title} has changed its size, unit or mirroring")]
    Changed {
        /// The camera or file.
        title: String,
    },
    /// The camera opens, but its stream does not start.
    #[error("the OpenNI camera cannot be started{}", quoted(said.first()))]
    NotStarted {
        /// The library's messages.
        said: Vec<String>,
    },
    /// The camera was unplugged, or reports an error.
    #[error("the connection to the OpenNI camera was lost{}", quoted(said.first()))]
    Lost {
        /// The library's messages.
        said: Vec<String>,
    },
    /// The camera is there but sends nothing.
    #[error("the OpenNI camera sent nothing for {seconds} s")]
    Silent {
        /// For how long, seconds.
        seconds: u64,
    },
    /// The recorded file is not an OpenNI recording, or is damaged.
    #[error("{}: {what}", path.display())]
    FileUnusable {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        what: String,
    },
}

impl OpenNiError {
    /// How to recover: a camera may be plugged in, released or permitted at any time; a library or a file does not appear
    /// by itself.
    pub fn recovery(&self) -> Recovery {
        match self {
            Self::InUse
            | Self::NoDevice
            | Self::NoSuchDevice { .. }
            | Self::NotOpened { .. }
            | Self::NotStarted { .. }
            | Self::Lost { .. }
            | Self::Silent { .. } => Recovery::Reopen,
            Self::Library(_)
            | Self::NoDrivers { .. }
            | Self::NoDepthMode { .. }
            | Self::NoFieldOfView { .. }
            | Self::MirroringUnknown { .. }
            | Self::Cropped { .. }
            | Self::Changed { .. }
            | Self::FileUnusable { .. } => Recovery::None,
        }
    }
}

impl Advice for OpenNiError {
    fn advice(&self) -> String {
        match self {
            Self::Library(error) => error.advice(),
            Self::NoDrivers { .. } => {
                "Put the folder OpenNI2/Drivers with the camera's driver beside the library".into()
            }
            Self::InUse => {
                "Use the camera where it is open already, or close it there first".into()
            }
            Self::NoDevice => {
                "Plug the camera in; if it is plugged in, put its maker's driver into OpenNI2/Drivers beside the \
                 library".into()
            }
            Self::NoSuchDevice { .. } => {
                "See partsight capture --list: the name changes when the camera is plugged in again; openni alone takes the first one".into()
            }
            Self::NotOpened { .. } => format!(
                "Close other programs that use the camera; if there are none, install the udev rule that permits it ({}) and plug the camera in again",
                OPENNI.install
            ),
            Self::NoDepthMode { .. } => {
                "Record it again in millimetres, or update the camera's driver".into()
            }
            Self::NoFieldOfView { .. } => {
                "Update the camera's driver: without the field of view, readings cannot be placed in space".into()
            }
            Self::MirroringUnknown { .. } => {
                "Update the camera's driver, and record again with it: a mirrored picture gives wrong poses".into()
            }
            Self::Cropped { .. } => "Switch cropping off, and record the whole picture again".into(),
            Self::Changed { .. } => {
                "Leave the camera's settings as they are while it runs or records, then open it again".into()
            }
            Self::NotStarted { .. } => {
                "Plug the camera into another USB socket, with no other camera on the same hub".into()
            }
            Self::Lost { .. } => "Check the camera's cable".into(),
            Self::Silent { .. } => {
                "Plug the camera into a USB socket of the computer itself, not of a hub".into()
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
        let (title, said) = (String::from("It"), Vec::new());
        let errors = [
            OpenNiError::NoDrivers { said: said.clone() },
            OpenNiError::InUse,
            OpenNiError::NoDevice,
            OpenNiError::NoSuchDevice {
                uri: "A".into(),
                found: vec!["B".into()],
            },
            OpenNiError::NotOpened { said: said.clone() },
            OpenNiError::NoDepthMode {
                title: title.clone(),
            },
            OpenNiError::NoFieldOfView {
                title: title.clone(),
            },
            OpenNiError::MirroringUnknown {
                title: title.clone(),
            },
            OpenNiError::Cropped {
                title: title.clone(),
            },
            OpenNiError::Changed { title },
            OpenNiError::NotStarted { said: said.clone() },
            OpenNiError::Lost { said },
            OpenNiError::Silent { seconds: 5 },
            OpenNiError::FileUnusable {
                path: "a.oni".into(),
                what: "not there".into(),
            },
        ];
        check_messages(&errors);
    }
}
