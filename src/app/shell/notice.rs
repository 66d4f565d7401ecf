//! What a person should know: the notices in the strip below the work.

use std::path::{Path, PathBuf};

use crate::{
    app::user_error::UserError,
    files::{FileWarning, import::ImportOptions},
};

/// What a notice is about.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum NoticeKind {
    /// Something deserves a look.
    #[default]
    Look,
    /// Something was done.
    Done,
    /// Something was done that can be taken back.
    Undoable,
}

/// Something that a person should know.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Notice {
    /// What it is about.
    pub kind: NoticeKind,
    /// What happened.
    pub what: String,
    /// What to do about it; may be empty.
    pub advice: String,
    /// The file that it is about, as it can be read in millimetres instead.
    pub in_millimetres: Option<PathBuf>,
}

impl Notice {
    /// Something deserves a look.
    pub fn look(what: impl Into<String>, advice: impl Into<String>) -> Self {
        Self {
            kind: NoticeKind::Look,
            what: what.into(),
            advice: advice.into(),
            in_millimetres: None,
        }
    }

    /// What is odd about a file.
    pub fn of_file(path: &Path, warning: &FileWarning) -> Self {
        let mut notice = Self::from(UserError::of(warning));
        if matches!(warning, FileWarning::TooWideForMetres { .. }) {
            let mut again = path.as_os_str().to_owned();
            again.push(ImportOptions::MILLIMETRES.suffix());
            notice.in_millimetres = Some(again.into());
        }
        notice
    }

    /// Something was done.
    pub fn done(what: impl Into<String>) -> Self {
        Self {
            kind: NoticeKind::Done,
            what: what.into(),
            advice: String::new(),
            in_millimetres: None,
        }
    }

    /// Something was done that can be taken back.
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
