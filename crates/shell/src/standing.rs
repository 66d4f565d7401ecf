//! Whether a robot may act on a result: everything that shows, copies or writes one asks here.

use std::{ptr, sync::Arc};

use super::session::Session;
use crate::{inspection::inspected::Inspected, source::live::SourceState};
use inspection::{library::Truth, pipeline::live::MotionState};
use records::history::{StoredVerdict, Summary};
use station::{self, Doubt, Subject, age_doubt};
use ui::widgets::Mark;

/// Returns the mark of a verdict that is not about what hangs there now: green only without doubts. `is_ok` is `None` where
/// no part was found, because an empty cell is not a bad part.
pub fn verdict_mark(is_ok: Option<bool>, has_doubts: bool) -> Mark {
    match is_ok {
        None => Mark::Open,
        Some(false) => Mark::Bad,
        Some(true) if has_doubts => Mark::Look,
        Some(true) => Mark::Good,
    }
}

/// Returns the mark of an inspection in the history.
pub fn past_mark(past: &Summary) -> Mark {
    let is_ok = (past.verdict != StoredVerdict::NoPart).then(|| past.is_ok());
    verdict_mark(is_ok, !past.noted.robot_doubts.is_empty())
}

impl Session {
    /// Why another part may hang before the source now, or this one elsewhere; `None` if it hangs there as captured.
    pub fn currency(&self, inspected: &Inspected) -> Option<Doubt> {
        let shown = self.shown.as_ref();
        let shown = shown.filter(|shown| shown.includes(inspected));
        let is_past = shown.is_some_and(|shown| shown.is_past);
        let status = self.live.status.as_ref().filter(|_| self.is_live());
        if !is_past && status.is_some_and(|status| matches!(status.source, SourceState::Lost(_))) {
            return Some(Doubt::SourceLost);
        }
        let mut unseen = self.live.unseen.iter();
        let is_newest = if self.live.unseen.is_empty() {
            shown.is_some()
        } else {
            unseen.any(|unseen| ptr::eq(Arc::as_ptr(unseen), inspected))
        };
        // The rack was changed since, or moved with another calibration.
        let is_of_other_rack =
            inspected.scan.is_none() && inspected.recipe.rack != *self.rack.in_camera();
        let is_left_behind = self.inspecting.is_some() || self.failed.is_some() || is_of_other_rack;
        if !is_newest
            || is_left_behind
            || shown.is_some_and(|shown| shown.is_past || shown.is_outdated)
        {
            return Some(Doubt::Superseded);
        }
        if !self.is_live() {
            return if self.is_after_live() {
                Some(Doubt::Superseded)
            } else {
                age_doubt(inspected.captured_at)
            };
        }
        match status {
            Some(status) if status.source == SourceState::Running && status.num_inspected > 0 => {
                // The status may be of a newer frame than the one in front.
                match status.stillness {
                    Some(MotionState::Moving | MotionState::Watching) => Some(Doubt::Moving),
                    _ if inspected.is_open() => Some(Doubt::Moving),
                    Some(MotionState::Steady { .. }) => None,
                    None => age_doubt(inspected.captured_at),
                }
            }
            _ => Some(Doubt::Superseded),
        }
    }

    /// What was inspected, as it stands now: with what a person reported since, and whether the part still hangs there.
    pub fn subject_now(&self, inspected: &Inspected) -> Subject {
        let reported_as = self.shift.reported_as(inspected).map(Truth::name);
        let is_of_other_order = self.is_of_other_order(inspected);
        let other_order = || is_of_other_order.then_some(Doubt::OtherOrder);
        Subject {
            currency: self.currency(inspected).or_else(other_order),
            reported_as: reported_as.map(str::to_owned),
            ..inspected.subject.clone()
        }
    }

    /// Why a robot must not act on a result, the reason to show first; empty if it may.
    pub fn robot_doubts(&self, inspected: &Inspected) -> Vec<Doubt> {
        let robot = self.robot_of(inspected).map(|robot| &**robot);
        let subject = self.subject_now(inspected);
        inspected.as_recorded(&subject, robot).doubts()
    }

    /// True if a robot may act on a result, and the part hangs there: only then it is shown in green.
    pub fn is_go(&self, inspected: &Inspected) -> bool {
        !inspected.subject.is_staged() && self.robot_doubts(inspected).is_empty()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use records::fixtures::history_entry;

    #[test]
    fn a_past_inspection_is_green_only_if_it_was_accepted_without_doubts() {
        let past = |verdict, doubts: &[&str], label: Option<Truth>| {
            let mut past = history_entry(1, verdict, "fender").record.summary;
            past.noted.robot_doubts = doubts.iter().map(|kind| (*kind).to_owned()).collect();
            past.label = label;
            past_mark(&past)
        };
        let accepted = StoredVerdict::Accepted;
        assert_eq!(past(accepted, &[], None), Mark::Good);
        assert_eq!(past(accepted, &["old"], None), Mark::Look);
        let wrong = Some(Truth::NotEnrolled);
        assert_eq!(past(accepted, &["old"], wrong), Mark::Bad);
        assert_eq!(past(StoredVerdict::Rejected, &[], None), Mark::Bad);
        assert_eq!(past(StoredVerdict::NoPart, &[], None), Mark::Open);
    }
}
