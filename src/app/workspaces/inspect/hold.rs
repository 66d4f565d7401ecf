//! Why a robot must not act on a recognised part, and what the operator or the engineer does about it.

use std::time::Duration;

use egui::Ui;

use crate::{
    app::{
        inspection::{inspected::Inspected, source::Origin},
        language::text,
        shell::session::{Session, Source, UserRole},
        ui::widgets::sentence,
    },
    error::Advice as _,
    station::Doubt,
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
                Doubt::ReportedWrong | Doubt::Moving | Doubt::SourceLost | Doubt::Superseded
            )
        };
        // Neither a calibration nor another capture helps a part that hangs nowhere.
        if !first.is_some_and(is_of_now) && session.is_staged(inspected) {
            return Some(Self::staged(session, inspected, role));
        }
        first.map(|doubt| Self::of_doubt(doubt, session, inspected, role))
    }

    /// As [`of`](Self::of), but only what also keeps the pose from being copied and a path from being written.
    pub(super) fn of_files(session: &Session, inspected: &Inspected) -> Option<Self> {
        let doubts = session.robot_doubts(inspected);
        // What was not accepted never has a pose for a robot, however old it is.
        let refused = doubts.iter().find(|doubt| **doubt == Doubt::NotAccepted);
        let first = refused.or(doubts.first())?;
        Some(Self::of_doubt(first, session, inspected, session.role))
    }

    /// Reason and advice as one text, for a control that cannot be used.
    pub(super) fn in_words(&self) -> String {
        format!("{}\n{}", self.reason, self.advice)
    }

    fn staged(session: &Session, inspected: &Inspected, role: UserRole) -> Self {
        Self {
            reason: if session.is_replayed(inspected) {
                text!("inspect-hold-replayed")
            } else {
                text!("inspect-hold-simulated")
            },
            advice: by_role(
                role,
                text!("inspect-hold-choose-camera-operator"),
                text!("inspect-hold-choose-camera"),
            ),
        }
    }

    fn of_doubt(doubt: &Doubt, session: &Session, inspected: &Inspected, role: UserRole) -> Self {
        let shown = session.shown.as_ref();
        let is_past = shown.is_some_and(|shown| shown.is_past);
        let is_file = matches!(inspected.origin, Origin::File { .. } | Origin::Scan { .. });
        let (reason, advice) = match doubt {
            Doubt::ReportedWrong => (
                text!("operator-reported-wrong"),
                by_role(
                    role,
                    text!("operator-reported-wrong-next"),
                    inspect_current(&session.source),
                ),
            ),
            Doubt::SourceLost => (
                text!("inspect-hold-lost"),
                by_role(
                    role,
                    text!("operator-no-camera-next"),
                    text!("inspect-hold-lost-advice"),
                ),
            ),
            Doubt::Moving => (text!("inspect-hold-moving"), text!("inspect-let-it-hang")),
            Doubt::Superseded if is_past => (
                text!("inspect-from-history"),
                inspect_current(&session.source),
            ),
            Doubt::Superseded if session.inspecting.is_some() => {
                (text!("inspect-previous-result"), text!("inspect-wait"))
            }
            Doubt::Superseded => (
                text!("inspect-hold-superseded"),
                inspect_current(&session.source),
            ),
            Doubt::NoPose => (
                text!("inspect-hold-no-pose"),
                by_role(
                    role,
                    text!("operator-unconfirmed-next"),
                    text!("inspect-hold-no-pose-advice"),
                ),
            ),
            Doubt::NotCalibrated => (
                text!("inspect-hold-not-calibrated"),
                by_role(
                    role,
                    text!("inspect-hold-not-calibrated-operator"),
                    text!("inspect-hold-not-calibrated-advice"),
                ),
            ),
            Doubt::ClockAhead(clock) => (
                text!("inspect-hold-clock", seconds = clock.ahead.as_secs()),
                by_role(
                    role,
                    text!("inspect-hold-clock-operator"),
                    text!("program-clock-ahead-advice"),
                ),
            ),
            Doubt::Old if is_file => (
                text!("inspect-hold-old-file"),
                text!("inspect-hold-old-advice"),
            ),
            Doubt::Old => (text!("inspect-hold-old"), text!("inspect-hold-old-advice")),
            Doubt::Ambiguous => (
                text!("inspect-hold-ambiguous"),
                text!("inspect-hold-ambiguous-advice"),
            ),
            Doubt::NotAccepted => (
                text!("inspect-no-pose-to-copy"),
                text!("inspect-no-pose-advice"),
            ),
            other @ (Doubt::OffThePart(_) | Doubt::NotReached(_)) => {
                (sentence(&other.to_string()), other.advice())
            }
        };
        Self { reason, advice }
    }
}

/// Draws the window again soon: a capture grows old without any event.
pub(super) fn look_again(ui: &Ui) {
    ui.ctx().request_repaint_after(AGE_CHECK);
}

fn by_role(role: UserRole, operator: String, engineer: String) -> String {
    match role {
        UserRole::Operator => operator,
        UserRole::Engineer => engineer,
    }
}

/// Says how the part that hangs there now is inspected.
pub(super) fn inspect_current(source: &Source) -> String {
    match source.followed() {
        Some(_) => text!("operator-follow-current"),
        None => text!("operator-capture-current"),
    }
}
