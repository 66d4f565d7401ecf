//! Why a case or a folder of cases cannot be used.

use std::{io, path::PathBuf};

use crate::history::HistoryError;
use files::{FileError, advice_on, words_of};
use geometry::error::Advice;

/// Why a case or a folder of cases cannot be used.
#[derive(Debug, thiserror::Error, Advice)]
pub enum CaseError {
    /// The folder cannot be read.
    #[error("{}: cannot read the kept cases: {}", path.display(), words_of(source))]
    #[advice = "Ask for access to this folder, or choose another"]
    Unreadable {
        /// The folder of cases.
        path: PathBuf,
        /// The underlying error.
        source: io::Error,
    },
    /// The folder cannot be written to; its cases are unchanged.
    #[error("{}: cannot write to the kept cases: {}", path.display(), words_of(source))]
    #[advice("{}, or choose another folder of cases", advice_on(source))]
    Unwritable {
        /// The folder of cases.
        path: PathBuf,
        /// The underlying error.
        source: io::Error,
    },
    /// A case differs from what was written.
    #[error("the kept case {name} is damaged and was set aside: {what}")]
    #[advice = "Copy it again from where it came from, or delete its folder"]
    Damaged {
        /// Name of the case's folder.
        name: String,
        /// The damage found.
        what: String,
    },
    /// A newer version of the program wrote a case, or the system has no folder for the cases.
    #[error(transparent)]
    #[advice(transparent)]
    File(#[from] FileError),
    /// There is no case of that name.
    #[error("{}: no kept case named {name}", path.display())]
    #[advice = "Check whether the folder was moved or renamed"]
    NoSuchCase {
        /// The folder of cases.
        path: PathBuf,
        /// The requested name.
        name: String,
    },
    /// The history to be exported as cases cannot be read.
    #[error(transparent)]
    #[advice(transparent)]
    History(#[from] HistoryError),
}
