//! Why a library cannot be used or changed.

use std::{io, path::PathBuf};

use super::{name::PartName, problem::EntryProblem};
use crate::{
    error::Advice,
    files::{advice_on, words_of},
};

/// Why a library cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum LibraryError {
    /// No such folder.
    #[error("{}: no such library folder", path.display())]
    NotFound {
        /// The folder.
        path: PathBuf,
    },
    /// Something else than a folder.
    #[error("{}: not a folder", path.display())]
    NotAFolder {
        /// The path.
        path: PathBuf,
    },
    /// The system could not read.
    #[error("{}: cannot read the library: {}", path.display(), words_of(source))]
    Unreadable {
        /// The folder.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
    /// The system could not write; what was enrolled before still is.
    #[error("{}: cannot write to the library: {}", path.display(), words_of(source))]
    Unwritable {
        /// The folder.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
    /// No part of that name.
    #[error("{}: no part named {name}{}", path.display(), listed(available))]
    NoSuchPart {
        /// The library's folder.
        path: PathBuf,
        /// The name asked for.
        name: String,
        /// The names there are.
        available: Vec<String>,
    },
    /// The part cannot be changed because its description cannot be read.
    #[error(transparent)]
    Damaged(#[from] Box<EntryProblem>),
    /// Another part has that name.
    #[error("{}: there is a part named {name} already", path.display())]
    NameTaken {
        /// The library's folder.
        path: PathBuf,
        /// The name wanted.
        name: PartName,
    },
    /// The trash holds no such thing.
    #[error("{}: nothing that was removed lies there", kept.display())]
    NotInTrash {
        /// Where it was looked for.
        kept: PathBuf,
    },
    /// The system does not say where a user's data belong.
    #[error("this system names no folder for a user's data")]
    NoUserFolder,
}

fn listed(names: &[String]) -> String {
    match names {
        [] => ", the library is empty".into(),
        names => format!("; it has {}", names.join(", ")),
    }
}

impl Advice for LibraryError {
    fn advice(&self) -> String {
        match self {
            Self::NotFound { .. } => {
                "Check the path and that the drive or stick is connected, or create the folder"
                    .into()
            }
            Self::NotAFolder { .. } => "Give the folder that holds the parts' folders".into(),
            Self::Unreadable { .. } => "Ask for access to this folder, or copy it elsewhere".into(),
            Self::Unwritable { source, .. } => {
                format!("{}, or name another with --library", advice_on(source))
            }
            Self::NoSuchPart { available, .. } if available.is_empty() => {
                "Enrol a part first, in the Enrol workspace or with partsight enrol FILE --name NAME".into()
            }
            Self::NoSuchPart { .. } => {
                "Use one of the names that `partsight library list` shows".into()
            }
            Self::Damaged(problem) => problem.advice(),
            Self::NameTaken { name, .. } => {
                format!("Choose another name, or remove or rename {name} first")
            }
            Self::NotInTrash { .. } => {
                "Look into the library's .trash folder: it may have been emptied or moved by hand"
                    .into()
            }
            Self::NoUserFolder => "Name a folder with --library".into(),
        }
    }
}
