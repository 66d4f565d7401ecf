//! Notices for the user, shown over the work.

use std::path::{Path, PathBuf};

use crate::{
    inspection::{
        report_files::WrittenForRobot,
        source::{Origin, file_name},
    },
    session::WorkspaceKind,
};
use capture::CaptureWarning;
use files::{FileWarning, import::ImportOptions};
use ui::{language::text, user_error::UserError};

/// Extents of a scene, metres, for which it is likely that its file is in millimetres.
const IN_MILLIMETRES: std::ops::RangeInclusive<f64> = 0.1..=50.0;

/// Kind of a notice.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoticeKind {
    /// Something needs attention.
    Look,
    /// Something was done.
    Done,
    /// Something was done, and this workspace can undo it.
    Undoable(WorkspaceKind),
}

/// What a notice is about; some notices go with it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoticeTopic {
    /// Something that was done or happened.
    Other,
    /// A scene: removed when another one is shown.
    Scene,
    /// Whether the source can be followed: removed once a source is followed or another one is shown.
    Following,
    /// What ended Live: removed once a source is followed again.
    LiveEnded,
    /// Whether the library can be loaded again: removed once it is.
    Library,
    /// Whether robots are answered: removed once they are, or are not to be.
    Answering,
    /// The name entered for a coat: removed once it is changed or the coat is saved.
    CoatName,
    /// Why a case cannot be kept: removed once one is kept, its truth is chosen, or another case is in front.
    Case,
    /// Why no robot program can be written: removed once arm, nozzle or gun are changed.
    Program,
    /// A doubtful serial number: removed once another one is scanned.
    Serial,
    /// Why it is not known what should hang there: removed once it is.
    Orders,
    /// Why the frames of the history are not kept: removed once one is.
    Frames,
    /// Another window is open with the same data folder: shown in both views.
    SecondWindow,
}

impl NoticeTopic {
    /// True if a newer notice about it replaces the former one.
    fn has_one_notice(self) -> bool {
        matches!(
            self,
            Self::Following
                | Self::LiveEnded
                | Self::Answering
                | Self::CoatName
                | Self::Case
                | Self::Program
                | Self::Serial
                | Self::Orders
                | Self::Frames
        )
    }
}

/// A notice for the user. Two are equal whatever number of others they stand for.
#[derive(Clone, Debug, Eq)]
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
    /// Number of earlier notices that this one stands for, too.
    pub num_more: usize,
}

impl PartialEq for Notice {
    fn eq(&self, other: &Self) -> bool {
        let Self {
            kind,
            topic,
            what,
            advice,
            in_millimetres,
            num_more: _,
        } = self;
        *kind == other.kind
            && *topic == other.topic
            && *what == other.what
            && *advice == other.advice
            && *in_millimetres == other.in_millimetres
    }
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
            num_more: 0,
        }
    }

    /// Makes a notice of a file written for a robot: what was not checked needs attention.
    pub fn of_robot_file(written: WrittenForRobot) -> Self {
        match written.not_checked {
            Some(not_checked) => Self::look(written.what, not_checked),
            None => Self::done(written.what),
        }
    }

    /// Makes a notice of a problem found while a scene was read.
    pub fn of_scene(origin: &Origin, warning: &CaptureWarning) -> Self {
        match (warning, origin) {
            (CaptureWarning::File(warning), Origin::File { path, .. }) => {
                Self::of_file(path, warning)
            }
            (CaptureWarning::File(warning), _) => {
                let notice = Self::from(UserError::of(warning)).about(NoticeTopic::Scene);
                notice.naming(&origin.shown_title())
            }
            _ => Self::from(UserError::of(warning)).about(NoticeTopic::Scene),
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
        notice.naming(&file_name(path))
    }

    /// Names the scene that the notice is about.
    fn naming(self, scene: &str) -> Self {
        let what = text!("shell-about-scene", scene = scene, what = &self.what);
        Self { what, ..self }
    }

    /// Says what the notice is about.
    #[must_use]
    pub fn about(self, topic: NoticeTopic) -> Self {
        Self { topic, ..self }
    }

    /// True if the newer notice makes this one obsolete: one success follows another, the topic has one notice only, or the
    /// newer one stands for both.
    pub fn gives_way_to(&self, newer: &Self) -> bool {
        let are_successes = self.kind != NoticeKind::Look && newer.kind != NoticeKind::Look;
        let is_replaced = self.topic.has_one_notice() && self.topic == newer.topic;
        self == newer || are_successes || is_replaced || self.is_like(newer)
    }

    /// True for two problems with the same advice, such as two files that cannot be read.
    fn is_like(&self, other: &Self) -> bool {
        let are_problems = self.kind == NoticeKind::Look && other.kind == NoticeKind::Look;
        are_problems
            && self.topic == other.topic
            && !self.topic.has_one_notice()
            && !self.advice.is_empty()
            && self.advice == other.advice
    }

    /// Counts the notices that the newer one stands for, if this one is among them.
    pub(super) fn num_covered_by(&self, newer: &Self) -> usize {
        if self == newer {
            self.num_more
        } else if self.is_like(newer) {
            self.num_more + 1
        } else {
            0
        }
    }

    /// Makes a notice that something was done.
    pub fn done(what: impl Into<String>) -> Self {
        Self {
            kind: NoticeKind::Done,
            ..Self::look(what, "")
        }
    }

    /// Makes a notice that something was done and can be undone by this workspace.
    pub fn undoable(what: impl Into<String>, by: WorkspaceKind) -> Self {
        Self {
            kind: NoticeKind::Undoable(by),
            ..Self::done(what)
        }
    }
}

impl From<UserError> for Notice {
    fn from(UserError { what, advice }: UserError) -> Self {
        Self::look(what, advice)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use geometry::units::Metres;

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
            assert!(other.what.starts_with("door.stl"), "{other:?}");
        }
    }

    #[test]
    fn a_notice_about_a_capture_names_it() {
        let origin = Origin::Frame {
            name: "left2_00.png".into(),
            is_simulated: false,
            capture: None,
        };
        let warning = CaptureWarning::File(FileWarning::SurplusBytes { num: 7 });
        let notice = Notice::of_scene(&origin, &warning);
        assert!(
            notice.what.starts_with("left2_00.png: 7 bytes"),
            "{notice:?}"
        );
        assert_eq!(notice.topic, NoticeTopic::Scene);
    }
}
