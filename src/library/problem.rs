//! What can be wrong with a stored part.

use std::{io, path::PathBuf};

use super::{
    entry::{CLOUD, META},
    name::PartName,
    part::CloudCheck,
};
use crate::{error::Advice, files::FileError, stages::reference::ReferenceError};

/// The largest cloud taken as a reference: twelve times what enrolling makes.
pub(super) const MAX_POINTS: usize = 200_000;

/// A part that could not be loaded.
#[derive(Debug, thiserror::Error)]
#[error("{entry}: {reason}")]
pub struct EntryProblem {
    /// The name of its folder.
    pub entry: String,
    /// The folder.
    pub path: PathBuf,
    /// Why.
    pub reason: EntryError,
}

/// Why a stored part cannot be loaded.
#[derive(Debug, thiserror::Error)]
pub enum EntryError {
    /// Made by a newer version of this program.
    #[error("made by a newer version of Partsight (schema {found}, this one reads up to {known})")]
    Newer {
        /// Its version.
        found: u32,
        /// The newest version read.
        known: u32,
    },
    /// A file that must be there is not.
    #[error("{file} is missing")]
    Missing {
        /// The file.
        file: &'static str,
    },
    /// `part.toml` cannot be read by the system.
    #[error("{META} cannot be read: {source}")]
    Unreadable {
        /// What the system says.
        source: io::Error,
    },
    /// `part.toml` cannot be understood.
    #[error("{META} is damaged: {found}")]
    BadMeta {
        /// The first thing wrong.
        found: String,
    },
    /// Folder and `part.toml` do not agree on the name.
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
    /// The file of the cloud holds something else, or too much of it.
    #[error("{CLOUD} holds {found}, expected a cloud of at most {MAX_POINTS} points")]
    NotACloud {
        /// What it holds.
        found: String,
    },
    /// The cloud can be read, but is not the one that was enrolled.
    #[error(
        "{CLOUD} is damaged or was changed: it has {} points and the checksum {}, {META} says {} and {}",
        found.num_points, found.crc32, expected.num_points, expected.crc32
    )]
    ChangedCloud {
        /// What it is.
        found: CloudCheck,
        /// What was enrolled.
        expected: CloudCheck,
    },
    /// The cloud is no reference.
    #[error(transparent)]
    Reference(#[from] ReferenceError),
}

impl Advice for EntryProblem {
    fn advice(&self) -> String {
        match &self.reason {
            EntryError::Newer { .. } => {
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

/// Something odd about a part that could be loaded.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{entry}: {trouble}")]
pub struct EntryWarning {
    /// The part.
    pub entry: String,
    /// What is odd.
    pub trouble: EntryIssue,
}

/// What can be odd about a stored part.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum EntryIssue {
    /// A file that can be made again from the cloud is not there.
    #[error("{file} is missing; it was made again from the cloud in memory")]
    Missing {
        /// The file.
        file: &'static str,
    },
    /// A file that can be made again from the cloud is damaged or says something else than the cloud.
    #[error("{file} does not belong to the cloud; the cloud counts")]
    Stale {
        /// The file.
        file: &'static str,
    },
    /// The stored spray path cannot be used.
    #[error("its spray path cannot be used: {why}")]
    SprayPath {
        /// Why.
        why: String,
    },
    /// An interrupted replacement left the part under another name.
    #[error("an interrupted replacement left it aside; the next enrolment puts it back")]
    LeftAside,
}

impl Advice for EntryWarning {
    fn advice(&self) -> String {
        match self.trouble {
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
