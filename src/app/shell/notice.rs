//! Notices for the user, shown in the strip below the work.

use std::path::{Path, PathBuf};

use crate::{
    app::{language::text, user_error::UserError},
    files::{FileWarning, import::ImportOptions},
};

/// Extents of a scene, metres, for which it is likely that its file is in millimetres.
const IN_MILLIMETRES: std::ops::RangeInclusive<f64> = 0.1..=50.0;

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

/// What a notice is about; some notices go with it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum NoticeTopic {
    /// Something that was done or happened.
    #[default]
    Other,
    /// A scene: removed when another one is shown.
    Scene,
    /// Whether the source can be followed: removed once a source is followed or another one is shown.
    Following,
    /// Whether robots are answered: removed once they are, or are not to be.
    Answering,
}

/// A notice for the user.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Notice {
    /// Decides mark and display time.
    pub kind: NoticeKind,
    /// What it is about.
    pub topic: NoticeTopic,
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
            topic: NoticeTopic::Other,
            what: what.into(),
            advice: advice.into(),
            in_millimetres: None,
        }
    }

    /// Makes a notice of a warning about a file.
    pub fn of_file(path: &Path, warning: &FileWarning) -> Self {
        let mut notice = Self::from(UserError::of(warning)).about(NoticeTopic::Scene);
        if let FileWarning::TooWideForMetres { extent } = warning {
            let mut again = path.as_os_str().to_owned();
            let has_unit = again.to_string_lossy().contains("#units=");
            if !has_unit && IN_MILLIMETRES.contains(&(extent.0 / 1000.0)) {
                again.push(ImportOptions::MILLIMETRES.suffix());
                notice.in_millimetres = Some(again.into());
            } else {
                notice.what = text!("shell-too-wide", extent = format!("{:.0}", extent.0));
                notice.advice = text!("shell-too-wide-advice");
            }
        }
        notice
    }

    /// Says what the notice is about.
    #[must_use]
    pub fn about(self, topic: NoticeTopic) -> Self {
        Self { topic, ..self }
    }

    /// True if the newer notice makes this one obsolete: one success follows another, or the topic has one notice only.
    pub fn gives_way_to(&self, newer: &Self) -> bool {
        let has_topic = matches!(self.topic, NoticeTopic::Following | NoticeTopic::Answering);
        let are_successes = self.kind != NoticeKind::Look && newer.kind != NoticeKind::Look;
        self == newer || are_successes || has_topic && self.topic == newer.topic
    }

    /// Makes a notice that something was done.
    pub fn done(what: impl Into<String>) -> Self {
        Self {
            kind: NoticeKind::Done,
            topic: NoticeTopic::Other,
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
            topic: NoticeTopic::Other,
            what,
            advice,
            in_millimetres: None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::units::Metres;

    #[test]
    fn millimetres_are_offered_once_and_only_for_what_they_make_a_cell() {
        let offered = |path: &str, extent| {
            let warning = FileWarning::TooWideForMetres {
                extent: Metres(extent),
            };
            Notice::of_file(Path::new(path), &warning)
        };
        let first = offered("door.stl", 1732.0);
        let again = first.in_millimetres.expect("offered");
        assert_eq!(again, Path::new("door.stl#units=mm"));
        for other in [
            offered("door.stl#units=mm", 1732.0),
            offered("door.stl", 90.0),
            offered("door.stl", 1.7e6),
        ] {
            assert_eq!(other.in_millimetres, None, "{other:?}");
            assert!(!other.advice.contains("millimetres"), "{other:?}");
        }
    }
}
