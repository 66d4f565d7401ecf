//! Errors of a library.

use std::{io, path::PathBuf};

use super::{name::PartName, problem::EntryProblem};
use files::{FileError, advice_on, words_of};
use geometry::error::Advice;

/// Why a library cannot be used or changed.
#[derive(Debug, thiserror::Error, Advice)]
pub enum LibraryError {
    /// The folder does not exist.
    #[error("{}: no such library folder", path.display())]
    #[advice = "Check the path and that the drive is connected, or create the folder"]
    NotFound {
        /// The folder.
        path: PathBuf,
    },
    /// The user's own library was created before and is no longer there.
    #[error("{}: your library is no longer there", path.display())]
    #[advice("Connect its drive or put the folder back, or name another with --library; to begin again with the shipped parts, remove {}", made.display())]
    Gone {
        /// Its folder.
        path: PathBuf,
        /// The file that marks that it was created before.
        made: PathBuf,
    },
    /// The path is not a folder.
    #[error("{}: not a folder", path.display())]
    #[advice = "Give the folder that holds the parts' folders"]
    NotAFolder {
        /// The path.
        path: PathBuf,
    },
    /// The folder cannot be read.
    #[error("{}: cannot read the library: {}", path.display(), words_of(source))]
    #[advice = "Ask for access to this folder, or copy it elsewhere"]
    Unreadable {
        /// The folder.
        path: PathBuf,
        /// The underlying error.
        source: io::Error,
    },
    /// The folder cannot be written; everything enrolled before is unchanged.
    #[error("{}: cannot write to the library: {}", path.display(), words_of(source))]
    #[advice("{}, or name another with --library", advice_on(source))]
    Unwritable {
        /// The folder.
        path: PathBuf,
        /// The underlying error.
        source: io::Error,
    },
    /// There are more parts than fit into memory.
    #[error("{}: the library has {found} parts, and at most {limit} can be used together", path.display())]
    #[advice = "Split it into several folders, and name the one that a line needs with --library"]
    TooManyParts {
        /// The library's folder.
        path: PathBuf,
        /// Number of parts.
        found: usize,
        /// The most that can be used together.
        limit: usize,
    },
    /// The zones of a surface are not valid; what was stored before is unchanged.
    #[error("{name}: {found}")]
    #[advice = "Give lengths above 0 millimetres, and a limit of scrap of at least the tolerance"]
    BadZones {
        /// The part.
        name: PartName,
        /// What is wrong.
        found: String,
    },
    /// There is no part with this name.
    #[error("{}: no part named {name}{}", path.display(), listed(available))]
    #[advice(if available.is_empty() {
        "Enrol a part first, in the Enrol workspace or with partsight enrol FILE --name NAME"
    } else {
        "Use one of the names that `partsight library list` shows"
    })]
    NoSuchPart {
        /// The library's folder.
        path: PathBuf,
        /// The name asked for.
        name: String,
        /// The names of all parts.
        available: Vec<String>,
    },
    /// The part cannot be changed because its `part.toml` cannot be read.
    #[error(transparent)]
    #[advice(transparent)]
    Damaged(#[from] Box<EntryProblem>),
    /// Another part has this name.
    #[error("{}: there is a part named {name} already", path.display())]
    #[advice = "Choose another name, or remove or rename {name} first"]
    NameTaken {
        /// The library's folder.
        path: PathBuf,
        /// The name asked for.
        name: PartName,
    },
    /// The part has references of its own, which would be left without a part.
    #[error(
        "{name} cannot become a reference of {of}: it has references of its own, {}",
        joined(references)
    )]
    #[advice = "Rename {name} first (`partsight library rename {name} --to NAME`), which takes its references along, or remove them"]
    HasReferences {
        /// Name of the part.
        name: PartName,
        /// The part that it was to become a reference of.
        of: PartName,
        /// Its references.
        references: Vec<PartName>,
    },
    /// The part in the trash is damaged, and the library has a sound one of that name.
    #[error(
        "{name} was not restored, because the removed part is damaged ({problem}); the one in the library is unchanged"
    )]
    #[advice("To restore an older one, move {} out of the .trash folder; to get the damaged one nevertheless, remove {name} first", problem.path.display())]
    DamagedInTrash {
        /// Name of the part.
        name: PartName,
        /// Why the removed part cannot be loaded.
        problem: Box<EntryProblem>,
    },
    /// The trash has no such entry.
    #[error("{}: no removed part is kept there", kept.display())]
    #[advice = "Look into the library's .trash folder: it may have been emptied or moved by hand"]
    NotInTrash {
        /// The path asked for.
        kept: PathBuf,
    },
    /// The file with the numbers of the parts cannot be used. New numbers could be those of other parts.
    #[error("{}: cannot read the numbers of the parts: {reason}", path.display())]
    #[advice = "Correct the file, or restore it from a copy; if you remove it, all parts get new numbers, and robots need new programs"]
    BadNumbers {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        reason: String,
    },
    /// The system has no folder for the library.
    #[error(transparent)]
    #[advice(transparent)]
    File(#[from] FileError),
}

fn joined(names: &[PartName]) -> String {
    let names: Vec<&str> = names.iter().map(PartName::as_str).collect();
    names.join(", ")
}

fn listed(names: &[String]) -> String {
    match names {
        [] => ", the library is empty".into(),
        names => format!("; it has {}", names.join(", ")),
    }
}
