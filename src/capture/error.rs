//! Why there is no capture, what is odd about one, and what to do about it.

use std::{io, path::PathBuf};

use thiserror::Error;

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
    /// The system gives no thread for the camera.
    #[error("the camera's thread cannot be started: {source}")]
    NoThread {
        /// What the system says.
        source: io::Error,
    },
    /// The camera's thread ended by a fault of the program.
    #[error("the camera's thread ended by a fault of the program")]
    Crashed,
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
            Self::FolderGone { .. }
            | Self::File(_)
            | Self::MeshIsNoCapture { .. }
            | Self::NoThread { .. }
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
            Self::FolderUnreadable { source, .. } => advice_on(source).into(),
            Self::File(error) => error.advice(),
            Self::MeshIsNoCapture { path } => {
                format!(
                    "Enrol it as a reference: partsight enrol {}",
                    path.display()
                )
            }
            Self::NoThread { .. } => "Close other programs and start again".into(),
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
}

impl Advice for CaptureWarning {
    fn advice(&self) -> String {
        match self {
            Self::File(warning) => warning.advice(),
        }
    }
}
