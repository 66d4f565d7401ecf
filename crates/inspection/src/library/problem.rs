//! Problems of stored parts.

use std::{io, path::PathBuf};

use super::{
    entry::{CLOUD, META},
    name::PartName,
    part::FileCheck,
};
use files::FileError;
use geometry::error::Advice;
use stages::reference::ReferenceError;

/// Maximum number of points of a reference's cloud: twelve times what enrolling makes.
pub(super) const MAX_POINTS: usize = 200_000;

/// A part that could not be loaded.
#[derive(Debug, thiserror::Error)]
#[error("{entry}: {reason}")]
pub struct EntryProblem {
    /// Name of its folder.
    pub entry: String,
    /// Path of its folder.
    pub path: PathBuf,
    /// Why it cannot be loaded.
    pub reason: EntryError,
}

/// Why a stored part cannot be loaded.
#[derive(Debug, thiserror::Error)]
pub enum EntryError {
    /// A newer version of the program wrote it.
    #[error("{0}")]
    Newer(Box<FileError>),
    /// A required file is missing.
    #[error("{file} is missing")]
    Missing {
        /// The file.
        file: &'static str,
    },
    /// The system cannot read `part.toml`.
    #[error("{META} cannot be read: {source}")]
    Unreadable {
        /// The underlying error.
        source: io::Error,
    },
    /// `part.toml` cannot be parsed.
    #[error("{META} is damaged: {found}")]
    BadMeta {
        /// The first error.
        found: String,
    },
    /// The folder and `part.toml` have different names.
    #[error("the folder is named {folder}, but {META} says {name}")]
    NameMismatch {
        /// Name of the folder.
        folder: String,
        /// Name in the file.
        name: PartName,
    },
    /// The cloud cannot be read.
    #[error("{CLOUD} cannot be used: {0}")]
    BadCloud(Box<FileError>),
    /// The file of the cloud contains something else, or too many points.
    #[error("{CLOUD} holds {found}, expected a cloud of at most {MAX_POINTS} points")]
    NotACloud {
        /// What it contains.
        found: String,
    },
    /// The cloud is not the one that was enrolled.
    #[error(
        "{CLOUD} is damaged or was changed: it has {} points and the checksum {}, {META} says {} and {}",
        found.num_points, found.crc32, expected.num_points, expected.crc32
    )]
    ChangedCloud {
        /// Check of the present file.
        found: FileCheck,
        /// Check of the enrolled cloud.
        expected: FileCheck,
    },
    /// The cloud cannot be used as a reference.
    #[error(transparent)]
    Reference(#[from] ReferenceError),
}

impl From<FileError> for EntryError {
    fn from(newer: FileError) -> Self {
        Self::Newer(newer.into())
    }
}

impl Advice for EntryProblem {
    fn advice(&self) -> String {
        match &self.reason {
            EntryError::Newer(_) => {
                "Update Partsight, or enrol the part again with this version".into()
            }
            EntryError::NameMismatch { name, .. } => format!("Rename the folder to {name}"),
            EntryError::Unreadable { .. } => format!("Ask for access to {}", self.path.display()),
            _ => format!(
                "Copy {} again from where it was made, or remove it with `partsight library remove {}` and enrol it again",
                self.path.display(),
                self.entry
            ),
        }
    }
}

/// A warning about a loaded part.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{entry}: {issue}")]
pub struct EntryWarning {
    /// Name of the part's folder.
    pub entry: String,
    /// The problem.
    pub issue: EntryIssue,
}

/// A problem that does not keep a stored part from being loaded.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum EntryIssue {
    /// A file that can be made again from the cloud is missing.
    #[error("{file} is missing; it was made again from the cloud in memory")]
    Missing {
        /// The file.
        file: &'static str,
    },
    /// A file that can be made again from the cloud is damaged or does not match it.
    #[error("{file} does not belong to the cloud; the cloud is used")]
    Stale {
        /// The file.
        file: &'static str,
    },
    /// The stored spray path cannot be used.
    #[error("its spray path cannot be used: {why}")]
    SprayPath {
        /// The reason.
        why: String,
    },
    /// An interrupted replacement left the part under another folder name.
    #[error("an interrupted replacement set it aside; the next enrolment puts it back")]
    LeftAside,
}

impl Advice for EntryWarning {
    fn advice(&self) -> String {
        match self.issue {
            EntryIssue::Missing { .. } | EntryIssue::Stale { .. } => {
                "Copy the part again from where it was made, or enrol it again".into()
            }
            EntryIssue::SprayPath { .. } => {
                format!(
                    "Store the path again: partsight library path {} path.csv",
                    self.entry
                )
            }
            EntryIssue::LeftAside => "Check that the part is the one you want".into(),
        }
    }
}
