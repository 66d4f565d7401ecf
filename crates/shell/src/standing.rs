//! Whether a robot may act on a result of this session: everything that shows, copies or writes one asks here.

use std::ptr;

use super::session::{Session, Source};
use crate::{
    inspection::{inspected::Inspected, source::Origin},
    source::live::SourceState,
};
use capture::SourceSpec;
use inspection::pipeline::live::MotionState;
use station::{Currency, Doubt, doubts};

impl Session {
    /// How a result relates to what hangs before the source now.
    pub fn currency(&self, inspected: &Inspected) -> Currency {
        let is_it = |other: &Inspected| ptr::eq(other, inspected);
        let shown = self.shown.as_ref();
        let shown = shown.filter(|shown| is_it(&shown.inspected));
        let is_past = shown.is_some_and(|shown| shown.is_past);
        let status = self.live.status.as_ref().filter(|_| self.is_live());
        if !is_past && status.is_some_and(|status| matches!(status.source, SourceState::Lost(_))) {
            return Currency::SourceLost;
        }
        let is_newest = self.latest(|_| true).is_some_and(|newest| is_it(newest));
        let is_left_behind = self.inspecting.is_some() || self.failed.is_some();
        if !is_newest
            || is_left_behind
            || shown.is_some_and(|shown| shown.is_past || shown.is_outdated)
        {
            return Currency::Superseded;
        }
        if !self.is_live() {
            return if self.is_after_live() {
                Currency::Superseded
            } else {
                Currency::CapturedAt(inspected.captured_at)
            };
        }
        match status {
            Some(status) if status.source == SourceState::Running && status.num_inspected > 0 => {
                // The status may be of a newer frame than the one in front.
                match status.stillness {
                    Some(MotionState::Moving | MotionState::Watching) => Currency::Moving,
                    _ if inspected.is_open() => Currency::Moving,
                    Some(MotionState::Steady { .. }) => Currency::Current,
                    None => Currency::CapturedAt(inspected.captured_at),
                }
            }
            _ => Currency::Superseded,
        }
    }

    /// Why a robot must not act on a result, the reason to show first; empty if it may.
    pub fn robot_doubts(&self, inspected: &Inspected) -> Vec<Doubt> {
        let robot = self.robot_of(inspected).map(|robot| &**robot);
        let mut found = doubts(&inspected.inspection, &self.currency(inspected), robot);
        if self.shift.reported_as(inspected).is_some() {
            found.insert(0, Doubt::ReportedWrong);
        }
        found
    }

    /// True if the part of a result hangs nowhere: it is simulated, or was recorded earlier. What is written of it says so.
    pub fn is_staged(&self, inspected: &Inspected) -> bool {
        inspected.origin.is_simulated() || self.is_replayed(inspected)
    }

    /// True if the result is of a frame that was recorded earlier.
    pub fn is_replayed(&self, inspected: &Inspected) -> bool {
        matches!(inspected.origin, Origin::Frame { .. })
            && matches!(&self.source, Source::Camera(spec) if matches!(**spec, SourceSpec::Recording(_)))
    }

    /// True if a robot may act on a result, and the part hangs there: only then it is shown in green.
    pub fn is_go(&self, inspected: &Inspected) -> bool {
        !self.is_staged(inspected) && self.robot_doubts(inspected).is_empty()
    }
}
