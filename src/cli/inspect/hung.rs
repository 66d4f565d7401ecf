//! The parts that hang in front of a followed source one after the other: one inspection of each is kept and published.

use std::{sync::Arc, time::Duration};

use jiff::Timestamp;
use nalgebra::Point3;

use inspection::pipeline::{
    AcceptParams, Inspection, Verdict,
    live::{FrameRole, HungFrame, LiveParams, LiveTracker, MotionState, refuse_moving},
};
use records::history::{HungId, HungRows, NewEntry};
use stages::{field_of_view::FieldOfView, scene::SceneCloud};

/// Tells successive parts apart.
pub(in crate::cli) struct FollowedParts<E = NewEntry> {
    tracker: LiveTracker,
    rows: HungRows<E>,
    /// The verdict of the last frame by itself.
    own: Option<Verdict>,
}

/// A frame and its own inspection.
pub(in crate::cli) struct FollowedFrame<'a> {
    pub(in crate::cli) scene: &'a Arc<SceneCloud>,
    pub(in crate::cli) taken_at: Timestamp,
    /// Middle of the named part, part space, metres.
    pub(in crate::cli) middle: Option<Point3<f64>>,
    pub(in crate::cli) accept: &'a AcceptParams,
}

impl<E> FollowedParts<E> {
    /// Creates the state before the first frame.
    pub(in crate::cli) fn new() -> Self {
        Self {
            tracker: LiveTracker::new(&LiveParams::default()),
            rows: HungRows::default(),
            own: None,
        }
    }

    /// Returns the camera's field of view as far as the frames have shown it.
    pub(in crate::cli) fn known_view(&self) -> Option<Arc<FieldOfView>> {
        self.tracker.known_view()
    }

    /// Takes in a frame, and refuses the part of its own inspection if it moves. Call it for every frame.
    pub(in crate::cli) fn look(&mut self, frame: &FollowedFrame<'_>, inspection: &mut Inspection) {
        let at = time_of(frame);
        self.tracker.look(Arc::clone(frame.scene), at);
        self.own = Some(inspection.verdict.clone());
        if self.is_moving() {
            refuse_moving(inspection);
        }
    }

    fn is_moving(&self) -> bool {
        self.tracker.stillness() == MotionState::Moving
    }

    /// Returns what to write now, after [`Self::look`] at the same frame. The verdict that counts is formed from several
    /// frames; for a part that leaves before, the frame that shows it best is used with its own verdict. `entry` also gets
    /// whether the part is known to have hung still.
    pub(in crate::cli) fn take(
        &mut self,
        frame: &FollowedFrame<'_>,
        mut inspection: Inspection,
        entry: impl Fn(&Inspection, HungId, bool) -> E,
    ) -> [Option<E>; 2] {
        // Frames are counted by their own verdicts.
        if let Some(own) = self.own.take() {
            inspection.verdict = own;
        }
        let own = inspection.verdict.clone();
        let verdict = self
            .tracker
            .judge(&mut inspection, frame.middle, frame.accept);
        let (left, role) = self.rows.see(&HungFrame {
            scene: frame.scene,
            at: time_of(frame),
            inspection: &inspection,
            verdict: &verdict,
            middle: frame.middle,
            // Recipe and library do not change between frames.
            inputs: "",
        });
        let id = self.rows.id().clone();
        let now = match role {
            FrameRole::Nothing => None,
            FrameRole::Best => {
                inspection.verdict = own;
                if self.is_moving() {
                    refuse_moving(&mut inspection);
                }
                self.rows.hold(entry(&inspection, id, false));
                None
            }
            FrameRole::First | FrameRole::Again => Some(entry(&inspection, id, true)),
        };
        [left, now]
    }

    /// Ends the source. Returns what is still to be written.
    pub(in crate::cli) fn end(mut self) -> Option<E> {
        self.rows.end()
    }
}

fn time_of(frame: &FollowedFrame<'_>) -> Duration {
    Duration::try_from(frame.taken_at.as_duration()).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use jiff::SignedDuration;

    use super::*;
    use capture::{CellScene, SimulatedCell, SimulatedSpec};
    use inspection::{
        fixtures::shipped_library,
        pipeline::{Recipe, Unwatched, run},
    };
    use stages::scene::scene_from_image;

    #[test]
    fn a_frame_of_a_part_that_swings_in_is_refused_and_one_of_a_part_at_rest_is_not() {
        let mut cell = SimulatedCell::new(SimulatedSpec {
            scene: CellScene::Line { every: 6.0 },
            frames_per_second: 15.0,
            ..SimulatedSpec::default()
        });
        let mut scene_at = |number: u64| Arc::new(scene_from_image(cell.frame(number).0));
        let recipe = Recipe::default();
        let seen = run(&scene_at(46), &shipped_library(), &recipe, &Unwatched);
        let seen = seen.expect("not cancelled");
        assert!(seen.verdict.is_accepted());
        let mut followed = FollowedParts::new();
        let mut kept = Vec::new();
        for number in 1..=73_u64 {
            let scene = scene_at(number);
            let seconds = (number - 1) as f64 / 15.0;
            let frame = FollowedFrame {
                scene: &scene,
                taken_at: Timestamp::UNIX_EPOCH + SignedDuration::from_secs_f64(seconds),
                middle: None,
                accept: &recipe.accept,
            };
            // As if every frame by itself were accepted.
            let mut inspection = seen.clone();
            followed.look(&frame, &mut inspection);
            let is_accepted = inspection.verdict.is_accepted();
            match seconds {
                // It comes in, and then swings by less and less.
                0.4..2.0 => assert!(!is_accepted, "after {seconds} s"),
                4.4.. => assert!(is_accepted, "after {seconds} s"),
                _ => {}
            }
            let entries = followed.take(&frame, inspection, |inspection, _, is_still| {
                (inspection.verdict.is_accepted(), is_still)
            });
            kept.extend(entries.into_iter().flatten().map(|entry| (seconds, entry)));
        }
        // One verdict that counts, formed at rest from frames by their own verdicts.
        let [(seconds, entry)] = kept[..] else {
            panic!("{kept:?}");
        };
        assert!(seconds > 2.0 && entry == (true, true), "{kept:?}");
    }
}
