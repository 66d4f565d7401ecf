//! Why there is no capture, what is odd about one, and what to do about it.

use std::{io, path::PathBuf};

use thiserror::Error;

use super::{
    genicam::{GenicamError, GenicamWarning},
    kinect::{KinectError, KinectWarning},
    openni::OpenNiError,
    realsense::RealsenseError,
};
use crate::{
    error::Advice,
    files::{FileError, FileWarning, advice_on, words_of},
};

/// Why a source cannot be opened, gives nothing more, or cannot be recorded.
#[derive(Debug, Error)]
pub enum CaptureError {
    /// The folder of a recording, or one to watch, is not there.
    #[error("{}: the folder is not there", path.display())]
    FolderGone {
        /// The folder.
        path: PathBuf,
        /// True if it may come: a network share, a stick.
        may_come: bool,
    },
    /// A folder that cannot be listed.
    #[error("{}: cannot read the folder: {}", path.display(), words_of(source))]
    FolderUnreadable {
        /// The folder.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
    /// One file of a source.
    #[error(transparent)]
    File(#[from] FileError),
    /// A mesh is nothing that a camera saw.
    #[error("{}: a mesh, expected what a depth camera saw", path.display())]
    MeshIsNoCapture {
        /// The file.
        path: PathBuf,
    },
    /// A Kinect.
    #[error(transparent)]
    Kinect(#[from] KinectError),
    /// A GenICam camera.
    #[error(transparent)]
    Genicam(#[from] GenicamError),
    /// An OpenNI camera, or a file of one.
    #[error(transparent)]
    OpenNi(#[from] OpenNiError),
    /// A RealSense camera, or a file of one.
    #[error(transparent)]
    Realsense(#[from] RealsenseError),
    /// A folder without anything to replay.
    #[error("{}: no recording, and no file of a camera", path.display())]
    NoFrames {
        /// The folder.
        path: PathBuf,
    },
    /// A recording made by a newer version.
    #[error("{}: made by a newer version: format {found}, this one reads up to {known}", path.display())]
    NewerRecording {
        /// Its list of frames.
        path: PathBuf,
        /// Its version.
        found: u32,
        /// The newest that is read.
        known: u32,
    },
    /// A recording that contradicts itself.
    #[error("{}: damaged: {what}", path.display())]
    DamagedRecording {
        /// The file.
        path: PathBuf,
        /// The contradiction.
        what: String,
    },
    /// A recording would be mixed with what is there.
    #[error("{}: the folder is not empty", path.display())]
    FolderInUse {
        /// The folder.
        path: PathBuf,
    },
    /// A recording cannot be written on.
    #[error("{}: cannot record: {}; {} kept", path.display(), words_of(source), counted(*num_kept))]
    Unwritable {
        /// The folder or the frame's file.
        path: PathBuf,
        /// Whole frames that the recording has.
        num_kept: u64,
        /// What the system says.
        source: io::Error,
    },
    /// The system gives no thread for the camera.
    #[error("the camera's thread cannot be started: {source}")]
    NoThread {
        /// What the system says.
        source: io::Error,
    },
    /// Frames are asked for that nobody takes from the source now.
    #[error("the window does not follow its source, so there are no frames")]
    NotFollowed,
    /// The camera's thread ended by a fault of the program.
    #[error("the camera's thread ended by a fault of the program")]
    Crashed,
}

fn counted(num_frames: u64) -> String {
    match num_frames {
        0 => "no frame is".into(),
        1 => "1 frame is".into(),
        num => format!("{num} frames are"),
    }
}

/// What helps after an error of a source.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Recovery {
    /// Nothing by itself: somebody has to do something first.
    None,
    /// Opening the source anew, after a while.
    Reopen,
    /// Asking the same source again, after a while: it remembers what it has given.
    AskAgain,
}

impl CaptureError {
    /// What helps.
    pub fn recovery(&self) -> Recovery {
        match self {
            Self::FolderGone { may_come: true, .. } | Self::FolderUnreadable { .. } => {
                Recovery::AskAgain
            }
            Self::Kinect(error) => error.recovery(),
            Self::Genicam(error) => error.recovery(),
            Self::OpenNi(error) => error.recovery(),
            Self::Realsense(error) => error.recovery(),
            Self::FolderGone { .. }
            | Self::File(_)
            | Self::MeshIsNoCapture { .. }
            | Self::NoFrames { .. }
            | Self::NewerRecording { .. }
            | Self::DamagedRecording { .. }
            | Self::FolderInUse { .. }
            | Self::Unwritable { .. }
            | Self::NoThread { .. }
            | Self::NotFollowed
            | Self::Crashed => Recovery::None,
        }
    }
}

impl Advice for CaptureError {
    fn advice(&self) -> String {
        match self {
            Self::FolderGone {
                path,
                may_come: true,
            } => format!(
                "Connect the drive or share that holds {}; captures go on by themselves",
                path.display()
            ),
            Self::FolderGone { .. } => {
                "Check the name and that the drive or stick is connected".into()
            }
            Self::FolderUnreadable { .. } => {
                "Ask for access to this folder; it is looked for again by itself".into()
            }
            Self::File(error) => error.advice(),
            Self::MeshIsNoCapture { path } => {
                format!(
                    "Enrol it as a reference: partsight enrol {}",
                    path.display()
                )
            }
            Self::Kinect(error) => error.advice(),
            Self::Genicam(error) => error.advice(),
            Self::OpenNi(error) => error.advice(),
            Self::Realsense(error) => error.advice(),
            Self::NoFrames { path } => format!(
                "Give the folder that holds the frames; partsight capture --out {} makes one",
                path.display()
            ),
            Self::NewerRecording { .. } => "Update Partsight on this computer".into(),
            Self::DamagedRecording { .. } => {
                "Copy the recording again from where it was made".into()
            }
            Self::FolderInUse { .. } => "Name a folder that is not there yet".into(),
            Self::Unwritable { source, .. } => advice_on(source).into(),
            Self::NoThread { .. } => "Close other programs and start again".into(),
            Self::NotFollowed => "Press Live in the window".into(),
            Self::Crashed => "Choose the source again, and report what was done before".into(),
        }
    }
}

/// Something odd about a capture that can be used nevertheless.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum CaptureWarning {
    /// About the file it came from.
    #[error(transparent)]
    File(#[from] FileWarning),
    /// About a Kinect.
    #[error(transparent)]
    Kinect(#[from] KinectWarning),
    /// About a GenICam camera.
    #[error(transparent)]
    Genicam(#[from] GenicamWarning),
    /// A recording whose end is missing.
    #[error("the recording was cut off; its {num_frames} whole frames are replayed")]
    CutOff {
        /// Frames that are whole.
        num_frames: usize,
    },
    /// A sequence that does not say its camera.
    #[error("{} is not there: taken for a camera of 640×480 pixels, fx = fy = 525, with 5000 units to the metre", missing.display())]
    AssumedCamera {
        /// Where the camera was looked for.
        missing: PathBuf,
    },
}

impl CaptureWarning {
    /// True if it is about the source, and so the same for its captures: told once, it is told.
    pub fn is_about_source(&self) -> bool {
        !matches!(self, Self::File(_))
    }
}

impl Advice for CaptureWarning {
    fn advice(&self) -> String {
        match self {
            Self::File(warning) => warning.advice(),
            Self::Kinect(warning) => warning.advice(),
            Self::Genicam(warning) => warning.advice(),
            Self::CutOff { .. } => {
                "Record again if the end matters; leave room on the disk and stop before pulling out a stick".into()
            }
            Self::AssumedCamera { missing } => format!(
                "Put the camera's numbers into {}, as they stand beside a depth PNG",
                missing.display()
            ),
        }
    }
}
