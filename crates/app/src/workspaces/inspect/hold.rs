//! Why a robot must not act on a recognised part, and what the operator or the engineer does about it.

use std::{sync::Arc, time::Duration};

use egui::Ui;

use robot::RobotFrame;
use shell::{
    inspection::{inspected::Inspected, source::Origin},
    session::{Session, UserRole},
};
use station::Doubt;
use ui::{
    language::{library_text, text, what_and_advice},
    user_error::UserError,
    widgets::sentence,
};

/// Time between two looks at the age of a capture, which counts in minutes.
const AGE_CHECK: Duration = Duration::from_secs(15);

/// Why a robot must not act on a result: the reason to show first, and what this person does about it. `None` if it may.
pub(super) struct Hold {
    /// The reason, in a few words.
    pub(super) reason: String,
    /// What to do.
    pub(super) advice: String,
}

impl Hold {
    /// What keeps a robot from acting on a result; also that the part hangs nowhere, which does not keep anything from
    /// being copied or written.
    pub(super) fn of(session: &Session, inspected: &Inspected, role: UserRole) -> Option<Self> {
        let doubts = session.robot_doubts(inspected);
        let first = doubts.first();
        let is_of_now = |doubt: &Doubt| {
            matches!(
                doubt,
                Doubt::ReportedWrong
                    | Doubt::Moving
                    | Doubt::SourceLost
                    | Doubt::Superseded
                    | Doubt::OtherOrder
            )
        };
        // Neither a calibration nor another capture helps a part that hangs nowhere.
        if !first.is_some_and(is_of_now) && inspected.subject.is_staged() {
            return Some(Self::staged(inspected, role));
        }
        first.map(|doubt| Self::of_doubt(doubt, session, inspected, role))
    }

    /// The robot frame in which the pose may be copied and a path be written, or why not. The pose of a part that hangs nowhere
    /// may: what is written of it says so.
    pub(super) fn robot_of_files<'a>(
        session: &'a Session,
        inspected: &'a Inspected,
    ) -> Result<&'a Arc<RobotFrame>, Self> {
        let doubts = session.robot_doubts(inspected);
        let robot = session.robot_of(inspected);
        robot.filter(|_| doubts.is_empty()).ok_or_else(|| {
            let first = doubts.first().unwrap_or(&Doubt::NotCalibrated);
            Self::of_doubt(first, session, inspected, session.role)
        })
    }

    /// Reason and advice as one text, for a control that cannot be used.
    pub(super) fn in_words(&self) -> String {
        format!("{}\n{}", self.reason, self.advice)
    }

    fn staged(inspected: &Inspected, role: UserRole) -> Self {
        Self {
            reason: if inspected.subject.is_replayed() {
                text!("inspect-hold-replayed")
            } else {
                text!("inspect-hold-simulated")
            },
            advice: choose_camera(role),
        }
    }

    fn of_doubt(found: &Doubt, session: &Session, inspected: &Inspected, role: UserRole) -> Self {
        let is_past = session.shown.as_ref().is_some_and(|shown| shown.is_past);
        let is_file = matches!(inspected.origin, Origin::File { .. } | Origin::Scan { .. });
        let [usual_reason, usual_advice] = what_and_advice(found);
        let reason = match found {
            Doubt::Superseded if is_past => text!("inspect-from-history"),
            Doubt::Superseded if session.inspecting.is_some() => text!("inspect-previous-result"),
            Doubt::NotAccepted => text!("inspect-no-pose-to-copy"),
            Doubt::NotCalibrated => text!("inspect-hold-not-calibrated"),
            Doubt::Old if is_file => text!("inspect-hold-old-file"),
            Doubt::Old => text!("inspect-hold-old"),
            _ => sentence(&usual_reason),
        };
        let advice = match (found, role) {
            (Doubt::Superseded, _) if session.inspecting.is_some() => text!("shell-wait"),
            (Doubt::Superseded, _) => inspect_current(session, role),
            (Doubt::Old, UserRole::Operator) if is_file => choose_camera(role),
            (Doubt::Old, UserRole::Engineer) if is_file => text!("inspect-hold-open-newer"),
            (Doubt::NotAccepted, _) => text!("inspect-no-pose-advice"),
            // What only the engineer can do.
            (Doubt::ReportedWrong, UserRole::Operator) => text!("operator-reported-wrong-next"),
            (Doubt::Ambiguous, UserRole::Operator) => {
                ["step-all-in-picture", "step-if-it-persists"]
                    .map(library_text)
                    .join("\n")
            }
            (Doubt::NoPose, UserRole::Operator) => library_text("step-unconfirmed-next"),
            (Doubt::NotCalibrated, UserRole::Operator) => {
                text!("inspect-hold-not-calibrated-operator")
            }
            (Doubt::ClockAhead(_), UserRole::Operator) => text!("inspect-hold-clock-operator"),
            _ => usual_advice,
        };
        Self { reason, advice }
    }
}

impl From<Hold> for UserError {
    fn from(hold: Hold) -> Self {
        Self {
            what: hold.reason,
            advice: hold.advice,
        }
    }
}

/// Draws the window again soon: a capture grows old without any event.
pub(super) fn look_again(ui: &Ui) {
    ui.ctx().request_repaint_after(AGE_CHECK);
}

/// Says how the part that hangs there now is inspected.
pub(super) fn inspect_current(session: &Session, role: UserRole) -> String {
    match &session.failed {
        // Live goes on with the next file by itself.
        Some(failed) if session.is_watching() => failed.advice.clone(),
        _ if session.is_watching() => text!("operator-save-capture"),
        _ if session.is_live() => text!("shell-wait"),
        _ if session.source.followed().is_some() => text!("operator-follow-current"),
        // A file shows what it showed before.
        _ => choose_camera(role),
    }
}

fn choose_camera(role: UserRole) -> String {
    match role {
        UserRole::Operator => text!("inspect-hold-choose-camera-operator"),
        UserRole::Engineer => text!("inspect-hold-choose-camera"),
    }
}

#[cfg(test)]
mod tests {
    use std::time::SystemTime;

    use super::*;
    use shell::{
        inspection::{inspected::inspected_cell, source::CellChoice},
        session::{Shown, Source},
    };

    const ROLES: [UserRole; 2] = [UserRole::Operator, UserRole::Engineer];

    #[test]
    fn the_current_part_is_inspected_as_its_source_allows() {
        let folder = || Source::Camera(Box::new("watch:captures".parse().expect("a source")));
        let file = || Source::File("door.pcd".into());
        let next = |source, is_live, failed: Option<UserError>| {
            let mut session = Session {
                source,
                failed,
                ..Session::default()
            };
            session.live.is_on = is_live;
            ROLES.map(|role| inspect_current(&session, role))
        };
        let unreadable = UserError {
            what: "door.pcd cannot be read".into(),
            advice: "Save it again".into(),
        };
        for (found, expected) in [
            (next(folder(), true, Some(unreadable)), ["Save it again"; 2]),
            (
                next(folder(), true, None),
                ["Save a capture to the folder: it is inspected automatically"; 2],
            ),
            (next(Source::default(), true, None), ["Wait a moment"; 2]),
            (
                next(Source::default(), false, None),
                ["Press Live or Capture for the current part"; 2],
            ),
            (
                next(file(), false, None),
                [
                    "Ask the engineer to choose a camera",
                    "Choose a camera as the source",
                ],
            ),
        ] {
            assert_eq!(found, expected);
        }
    }

    #[test]
    fn an_old_file_is_not_captured_again() {
        let mut inspected = inspected_cell(CellChoice::InTurn, 1);
        let hour = Duration::from_hours(1);
        inspected.set_origin(Origin::File {
            path: "door.pcd".into(),
            is_simulated: false,
        });
        inspected.set_captured_at(SystemTime::now() - hour);
        let session = Session {
            source: Source::File("door.pcd".into()),
            shown: Some(Shown::new(1, Arc::new(inspected))),
            ..Session::default()
        };
        let inspected = &session.shown.as_ref().expect("shown").inspected;
        let holds = ROLES.map(|role| Hold::of(&session, inspected, role).expect("old"));
        for (hold, advice) in holds.iter().zip([
            "Ask the engineer to choose a camera",
            "Open a newer capture, or choose a camera as the source",
        ]) {
            assert!(
                hold.reason.starts_with("From a file more than 10"),
                "{}",
                hold.reason
            );
            assert_eq!(hold.advice, advice);
        }
    }
}
