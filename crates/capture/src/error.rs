//! Errors and warnings of sources, with advice.

use std::{io, net::SocketAddr, path::PathBuf};

use thiserror::Error;

use super::camera_error::CameraError;
use files::{FileError, FileWarning, advice_on, words_of};
use geometry::error::Advice;

/// Why a source cannot be opened, delivers no more, or cannot be recorded.
#[derive(Debug, Error, Advice)]
pub enum CaptureError {
    /// The folder of a recording, or one to watch, does not exist.
    #[error("{}: the folder does not exist", path.display())]
    #[advice(if *may_come {
        format!("Connect the drive or share that holds {}; captures go on by themselves", path.display())
    } else {
        "Check the name and that the drive is connected".into()
    })]
    FolderGone {
        /// The folder.
        path: PathBuf,
        /// True if it may appear later, as on a network share or a USB stick.
        may_come: bool,
    },
    /// The folder cannot be listed.
    #[error("{}: cannot read the folder: {}", path.display(), words_of(source))]
    #[advice = "Ask for access to this folder; it is looked for again by itself"]
    FolderUnreadable {
        /// The folder.
        path: PathBuf,
        /// The underlying error.
        source: io::Error,
    },
    /// A file of a source cannot be read.
    #[error(transparent)]
    #[advice(transparent)]
    File(#[from] FileError),
    /// The file is a mesh, not a capture of a camera.
    #[error("{}: a mesh, expected a depth camera's capture", path.display())]
    #[advice("Enrol it as a reference: partsight enrol {} --name NAME", path.display())]
    MeshIsNoCapture {
        /// The file.
        path: PathBuf,
    },
    /// The file is the capture of a camera that does not look along z, saved with faces.
    #[error("{}: {}", path.display(), FileWarning::CaptureWithFaces)]
    #[advice(FileWarning::CaptureWithFaces.advice())]
    CaptureWithFaces {
        /// The file.
        path: PathBuf,
    },
    /// A camera, its library or a file recorded by it failed.
    #[error(transparent)]
    #[advice(transparent)]
    Camera(#[from] CameraError),
    /// The folder has nothing to replay.
    #[error("{}: neither a recording nor a camera's file", path.display())]
    #[advice = "Give the folder that holds the frames, or record a source into one first"]
    NoFrames {
        /// The folder.
        path: PathBuf,
    },
    /// The recording contradicts itself.
    #[error("{}: damaged: {what}", path.display())]
    #[advice = "Copy the recording again from where it was made"]
    DamagedRecording {
        /// The file.
        path: PathBuf,
        /// The contradiction.
        what: String,
    },
    /// The folder to record to is not empty.
    #[error("{}: the folder is not empty", path.display())]
    #[advice = "Name a folder that is not there yet"]
    FolderInUse {
        /// The folder.
        path: PathBuf,
    },
    /// The recording cannot be continued.
    #[error("{}: cannot record: {}; {} kept", path.display(), words_of(source), counted(*num_kept))]
    #[advice(advice_on(source))]
    Unwritable {
        /// The folder, or the frame's file.
        path: PathBuf,
        /// Number of complete frames in the recording.
        num_kept: u64,
        /// The underlying error.
        source: io::Error,
    },
    /// No simulated robot answers, or what answers is none.
    #[error("no simulated robot gives frames at {at}: {}", words_of(source))]
    #[advice = "Start it with partsight simulate --robot, and give the address that it shows"]
    NoRobot {
        /// Where it should be.
        at: SocketAddr,
        /// The underlying error.
        source: io::Error,
    },
    /// The system refuses a thread for the camera.
    #[error("the camera's thread cannot be started: {source}")]
    #[advice = "Close other programs and start again"]
    NoThread {
        /// The underlying error.
        source: io::Error,
    },
    /// Frames are requested while the window does not follow its source.
    #[error("the window does not follow its source, so there are no frames")]
    #[advice = "Press Live in the window; if its source is a single file or a scan, first choose a camera, a recording or a folder"]
    NotFollowed,
    /// The camera's thread panicked.
    #[error("an error of the program ended the camera's thread")]
    #[advice = "Choose the source again, and report what was done before"]
    Crashed,
}

fn counted(num_frames: u64) -> String {
    match num_frames {
        0 => "no frame is".into(),
        1 => "1 frame is".into(),
        num => format!("{num} frames are"),
    }
}

/// How to recover from a source's error.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Recovery {
    /// Not automatically: a person has to act first.
    None,
    /// Open the source again after a while.
    Reopen,
    /// Query the same source again after a while: it remembers what it has delivered.
    AskAgain,
}

impl CaptureError {
    /// How to recover from this error.
    pub fn recovery(&self) -> Recovery {
        match self {
            Self::FolderGone { may_come: true, .. } | Self::FolderUnreadable { .. } => {
                Recovery::AskAgain
            }
            Self::Camera(error) => error.recovery(),
            Self::NoRobot { .. } => Recovery::Reopen,
            Self::FolderGone { .. }
            | Self::File(_)
            | Self::MeshIsNoCapture { .. }
            | Self::CaptureWithFaces { .. }
            | Self::NoFrames { .. }
            | Self::DamagedRecording { .. }
            | Self::FolderInUse { .. }
            | Self::Unwritable { .. }
            | Self::NoThread { .. }
            | Self::NotFollowed
            | Self::Crashed => Recovery::None,
        }
    }
}

/// Something odd about a capture that can be used nevertheless.
#[derive(Clone, Debug, PartialEq, Error, Advice)]
pub enum CaptureWarning {
    /// About the capture's file.
    #[error(transparent)]
    #[advice(transparent)]
    File(#[from] FileWarning),
    /// The library does not reveal the Kinect's focal length.
    #[error("the Kinect's focal length is not known; {pixels:.1} pixels are assumed")]
    #[advice(USE_LIBFREENECT)]
    AssumedFocalLength {
        /// The assumed focal length along columns and rows, pixels.
        pixels: f64,
    },
    /// The library delivers steps of disparity without the values to convert them into lengths.
    #[error("the Kinect's own calibration is not known; that of a typical Kinect is assumed")]
    #[advice(USE_LIBFREENECT)]
    AssumedDepthScale,
    /// The GenICam camera has no `Scan3dDistanceUnit`.
    #[error("the camera does not report its unit of length; millimetres are assumed")]
    #[advice = "Compare the size of a part in the 3-D view with the real one"]
    AssumedUnit,
    /// The end of the recording is missing.
    #[error("the recording was cut off; its {num_frames} whole frames are replayed")]
    #[advice = "Record again if the end matters; leave room on the disk, and stop before you unplug a drive"]
    CutOff {
        /// Number of complete frames.
        num_frames: usize,
    },
    /// The sequence has no file with the camera's numbers.
    #[error("{} is missing: a camera of 640×480 pixels, fx = fy = 525, with 5000 units to the metre is assumed", missing.display())]
    #[advice("Put the camera's intrinsics into {}, as beside a depth PNG", missing.display())]
    AssumedCamera {
        /// Where that file was expected.
        missing: PathBuf,
    },
}

impl CaptureWarning {
    /// True if it concerns the source and is thus the same for all its captures, so that showing it once is enough.
    pub fn is_about_source(&self) -> bool {
        !matches!(self, Self::File(warning) if !matches!(warning, FileWarning::Camera(_)))
    }
}

const USE_LIBFREENECT: &str =
    "Use the system's libfreenect 0.5 with a Kinect: it reads these values from the camera";
