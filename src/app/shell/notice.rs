//! Notices for the user, shown in the strip below the work.

use std::path::{Path, PathBuf};

use crate::{
    app::user_error::UserError,
    files::{FileWarning, import::ImportOptions},
};

/// Kind of a notice.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum NoticeKind {
    /// Something needs attention.
    #[default]
    Look,
    /// Something was done.
    Done,
    /// Something was done and can be undone.
    Undoable,
}

/// A notice for the user.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Notice {
    /// Decides mark and display time.
    pub kind: NoticeKind,
    /// What happened.
    pub what: String,
    /// What to do about it; may be empty.
    pub advice: String,
    /// The path with the suffix that reads it in millimetres, if that is offered.
    pub in_millimetres: Option<PathBuf>,
}

impl Notice {
    /// Makes a notice that needs attention.
    pub fn look(what: impl Into<String>, advice: impl Into<String>) -> Self {
        Self {
            kind: NoticeKind::Look,
            what: what.into(),
            advice: advice.into(),
            in_millimetres: None,
        }
    }

    /// Makes a notice of a warning about a file.
    pub fn of_file(path: &Path, warning: &FileWarning) -> Self {
        let mut notice = Self::from(UserError::of(warning));
        if matches!(warning, FileWarning::TooWideForMetres { .. }) {
            let mut again = path.as_os_str().to_owned();
            again.push(ImportOptions::MILLIMETRES.suffix());
            notice.in_millimetres = Some(again.into());
        }
        notice
    }

    /// Makes a notice that something was done.
    pub fn done(what: impl Into<String>) -> Self {
        Self {
            kind: NoticeKind::Done,
            what: what.into(),
            advice: String::new(),
            in_millimetres: None,
        }
    }

    /// Makes a notice that something was done and can be undone.
    pub fn undoable(what: impl Into<String>) -> Self {
        Self {
            kind: NoticeKind::Undoable,
            ..Self::done(what)
        }
    }
}

impl From<UserError> for Notice {
    fn from(UserError { what, advice }: UserError) -> Self {
        Self {
            kind: NoticeKind::Look,
            what,
            advice,
            in_millimetres: None,
        }
    }
}
