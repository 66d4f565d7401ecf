//! What a person should know: the notices in the strip below the work.

use crate::app::user_error::UserError;

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
}

impl Notice {
    /// Something deserves a look.
    pub fn look(what: impl Into<String>, advice: impl Into<String>) -> Self {
        Self {
            kind: NoticeKind::Look,
            what: what.into(),
            advice: advice.into(),
        }
    }

    /// Something was done.
    pub fn done(what: impl Into<String>) -> Self {
        Self {
            kind: NoticeKind::Done,
            what: what.into(),
            advice: String::new(),
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
        }
    }
}
