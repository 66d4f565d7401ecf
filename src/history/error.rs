//! Why the history cannot be read or written, and what to do about it.

use std::{
    io,
    path::{Path, PathBuf},
};

use rusqlite::ErrorCode;

use super::frames::FrameError;
use crate::{
    error::Advice,
    files::{FileError, advice_on, words_of},
};

/// Why the history cannot be read or written.
#[derive(Debug, thiserror::Error)]
pub enum HistoryError {
    /// Its folder cannot be made or used.
    #[error("{}: the history cannot be kept there: {}", path.display(), words_of(source))]
    Unwritable {
        /// The folder.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
    /// The disk has no room.
    #[error("{}: the history cannot be written: the disk is full", path.display())]
    DiskFull {
        /// The file.
        path: PathBuf,
    },
    /// The file, its folder or its disk is write-protected.
    #[error("{}: the history is write-protected", path.display())]
    ReadOnly {
        /// The file.
        path: PathBuf,
    },
    /// Another program is writing and does not come to an end.
    #[error("{}: another program is busy with the history", path.display())]
    Busy {
        /// The file.
        path: PathBuf,
    },
    /// The file is not as it was written.
    #[error("{}: the history is damaged: {what}", path.display())]
    Damaged {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        what: String,
    },
    /// Written by a newer program; nothing of it was touched.
    #[error(
        "{}: the history was written by a newer version of Partsight (format {found}, this one knows {known})",
        path.display()
    )]
    Newer {
        /// The file.
        path: PathBuf,
        /// Its version.
        found: u32,
        /// The newest known.
        known: u32,
    },
    /// The file is no history; nothing of it was touched.
    #[error("{}: this is the database of another program, not a history of Partsight", path.display())]
    Foreign {
        /// The file.
        path: PathBuf,
    },
    /// There is no history yet.
    #[error("{}: there is no history yet", path.display())]
    NotFound {
        /// The file looked for.
        path: PathBuf,
    },
    /// The database says something else.
    #[error("{}: the history cannot be used: {source}", path.display())]
    Database {
        /// The file.
        path: PathBuf,
        /// What it says.
        source: rusqlite::Error,
    },
    /// A frame cannot be written or read.
    #[error(transparent)]
    Frame(#[from] FrameError),
    /// The table cannot be written.
    #[error(transparent)]
    Table(#[from] FileError),
    /// No inspection of that number.
    #[error("there is no inspection {number} in the history")]
    NoSuchInspection {
        /// The number.
        number: i64,
    },
    /// The system does not say where a user's data belong.
    #[error("this system names no folder for a user's data")]
    NoUserFolder,
}

impl HistoryError {
    /// What a failure of the database means.
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
            // What its version promises is not there.
            Some(ErrorCode::Unknown) if source.to_string().contains("no such ") => Self::Damaged {
                path,
                what: source.to_string(),
            },
            _ => Self::Database { path, source },
        }
    }

    /// True where the file may be sound and only cannot be written now.
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

/// What the database says where the system says that the disk is full or fails.
fn is_disk_error(source: &rusqlite::Error) -> bool {
    source.sqlite_error_code() == Some(ErrorCode::SystemIoFailure)
}

impl Advice for HistoryError {
    fn advice(&self) -> String {
        match self {
            Self::Unwritable { source, .. } => advice_on(source).into(),
            Self::DiskFull { .. } => "Make room on the disk".into(),
            Self::ReadOnly { .. } => {
                "Make its folder writable, or ask for access to this one".into()
            }
            Self::Busy { .. } => "Close other windows of Partsight, or wait for them".into(),
            Self::Damaged { .. } => {
                "Close every other window of Partsight and start it again: the file is then set aside and a new one started".into()
            }
            Self::Newer { .. } => {
                "Update Partsight on this computer, or keep the history in another folder (--history)".into()
            }
            Self::Foreign { .. } => {
                "Keep the history in another folder (--history), or move that file to where it belongs".into()
            }
            Self::NotFound { .. } => {
                "Inspect something first, or name the folder with --history".into()
            }
            Self::Database { source, .. } if is_disk_error(source) => {
                "Make room on the disk, or check whether it still works; the history stays as it is".into()
            }
            Self::Database { .. } => {
                "Try again; if it happens again, move the file away: a new one is then started".into()
            }
            Self::Frame(error) => error.advice(),
            Self::Table(error) => error.advice(),
            Self::NoSuchInspection { .. } => {
                "Use one of the numbers that `partsight history list` shows".into()
            }
            Self::NoUserFolder => "Name a folder with --history".into(),
        }
    }
}
