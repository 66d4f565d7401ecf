//! Errors of the history, with advice.

use std::{
    io,
    path::{Path, PathBuf},
};

use rusqlite::ErrorCode;

use super::frames::{FrameError, FrameLoss};
use files::{FileError, advice_on, words_of};
use geometry::error::Advice;

/// Why the history cannot be read or written.
#[derive(Debug, thiserror::Error, Advice)]
pub enum HistoryError {
    /// The folder cannot be created or used.
    #[error("{}: the history cannot be kept there: {}", path.display(), words_of(source))]
    #[advice(advice_on(source))]
    Unwritable {
        /// The folder.
        path: PathBuf,
        /// The underlying error.
        source: io::Error,
    },
    /// The disk is full.
    #[error("{}: the history cannot be written: the disk is full", path.display())]
    #[advice = "Make room on the disk"]
    DiskFull {
        /// The file.
        path: PathBuf,
    },
    /// The file, its folder or its disk is write-protected.
    #[error("{}: the history is write-protected", path.display())]
    #[advice = "Make its folder writable, or ask for access to this one"]
    ReadOnly {
        /// The file.
        path: PathBuf,
    },
    /// Another program kept the file locked for too long.
    #[error("{}: another program is busy with the history", path.display())]
    #[advice = "Close other windows of Partsight, or wait until they are done"]
    Busy {
        /// The file.
        path: PathBuf,
    },
    /// The file is damaged.
    #[error("{}: the history is damaged: {what}", path.display())]
    #[advice = "Close every other window of Partsight and start it again: the file is then set aside and a new one started"]
    Damaged {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        what: String,
    },
    /// A newer version of the program wrote the file; it was left untouched.
    #[error(
        "{}: the history was written by a newer version of Partsight (format {found}, this one knows {known})",
        path.display()
    )]
    #[advice = "Update Partsight on this computer, or keep the history in another folder (--history)"]
    Newer {
        /// The file.
        path: PathBuf,
        /// Format version of the file.
        found: u32,
        /// Newest format version that this program reads.
        known: u32,
    },
    /// The file is not a history; it was left untouched.
    #[error("{}: this is the database of another program, not a history of Partsight", path.display())]
    #[advice = "Keep the history in another folder (--history), or move that file to where it belongs"]
    Foreign {
        /// The file.
        path: PathBuf,
    },
    /// The file was moved, deleted or replaced while it was in use.
    #[error(
        "{}: the history was moved, deleted or replaced while it was in use; new inspections go to the file that is there now",
        path.display()
    )]
    #[advice = "If earlier inspections are missing, stop every Partsight that uses this history and put the former file back; move or delete a history only while none is running"]
    Replaced {
        /// The file.
        path: PathBuf,
    },
    /// There is no history yet.
    #[error("{}: there is no history yet", path.display())]
    #[advice = "Inspect something first, or name the folder with --history"]
    NotFound {
        /// The file that was expected.
        path: PathBuf,
    },
    /// Any other error of the database.
    #[error("{}: the history cannot be used: {source}", path.display())]
    #[advice(if is_disk_error(source) {
        "Make room on the disk, check whether it still works, and raise a limit on the size of files (`ulimit -f`), if there is one; the history stays as it is"
    } else {
        "Try again; if it happens again, move the file away: a new one is then started"
    })]
    Database {
        /// The file.
        path: PathBuf,
        /// The underlying error.
        source: rusqlite::Error,
    },
    /// A frame cannot be written or read.
    #[error(transparent)]
    #[advice(transparent)]
    Frame(#[from] FrameError),
    /// A frame that the rule keeps cannot be written; its inspection is.
    #[error("frames are no longer kept: {source}")]
    #[advice(frames_not_kept(source))]
    FramesNotKept {
        /// The underlying error.
        source: FrameError,
    },
    /// The table cannot be written.
    #[error(transparent)]
    #[advice(transparent)]
    Table(#[from] FileError),
    /// There is no inspection with this number.
    #[error("there is no inspection {number} in the history")]
    #[advice = "Use one of the numbers that `partsight history list` shows"]
    NoSuchInspection {
        /// The number asked for.
        number: i64,
    },
    /// There is no run of servoing with this number.
    #[error("there is no servo run {number} in the history")]
    #[advice = "Use one of the numbers that `partsight history runs` shows"]
    NoSuchServoRun {
        /// The number asked for.
        number: i64,
    },
    /// There is no inspection of this part.
    #[error("{}: the history has no inspection of this part, so its true label is not set there", path.display())]
    #[advice = "If the history was moved or replaced, put the former file back and set the true label in History"]
    NoSuchPart {
        /// The file.
        path: PathBuf,
    },
}

impl HistoryError {
    /// Converts an error of the database.
    pub(super) fn of(path: &Path, source: rusqlite::Error) -> Self {
        let path = path.to_owned();
        match source.sqlite_error_code() {
            Some(ErrorCode::DiskFull) => Self::DiskFull { path },
            Some(ErrorCode::ReadOnly | ErrorCode::PermissionDenied | ErrorCode::CannotOpen) => {
                Self::ReadOnly { path }
            }
            Some(ErrorCode::DatabaseBusy | ErrorCode::DatabaseLocked) => Self::Busy { path },
            Some(ErrorCode::DatabaseCorrupt | ErrorCode::NotADatabase) => Self::Damaged {
                path,
                what: source.to_string(),
            },
            // A table or column that the file's version requires is missing.
            Some(ErrorCode::Unknown) if source.to_string().contains("no such ") => Self::Damaged {
                path,
                what: source.to_string(),
            },
            _ => Self::Database { path, source },
        }
    }

    /// Returns whether the file may be intact and only cannot be written now.
    pub(super) fn forbids_writing(&self) -> bool {
        match self {
            Self::Unwritable { .. } | Self::DiskFull { .. } | Self::ReadOnly { .. } => true,
            Self::Database { source, .. } => is_disk_error(source),
            _ => false,
        }
    }

    pub(super) fn io(path: &Path, source: io::Error) -> Self {
        Self::Unwritable {
            path: path.to_owned(),
            source,
        }
    }
}

/// Returns whether the system reported a full or failing disk.
fn is_disk_error(source: &rusqlite::Error) -> bool {
    source.sqlite_error_code() == Some(ErrorCode::SystemIoFailure)
}

fn frames_not_kept(source: &FrameError) -> String {
    match source.loss() {
        FrameLoss::DiskFull => {
            "Make room on the disk, or keep fewer frames (`partsight history keep`; in the window, Frames… in History): until then, inspections are written without them".into()
        }
        FrameLoss::NotWritable | FrameLoss::SlowDisk => format!(
            "{}; until then, inspections are written without frames",
            source.advice()
        ),
    }
}
