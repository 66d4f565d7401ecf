//! The parts that hang before a followed camera one after the other: one inspection of each is recorded and published.

use std::{slice, sync::Arc, time::Duration};

use jiff::Timestamp;
use nalgebra::Point3;

use inspection::pipeline::{
    AcceptParams, Inspection, Verdict,
    live::{
        FrameRole, HungFrame, LiveParams, LiveTracker, MotionState, SteadyParams, refuse_moving,
        refuse_unless_again,
    },
};
use records::history::{HungId, HungRows, NewEntry};
use stages::scene::SceneCloud;

/// Follows one camera whose every frame is shown with its own verdict. `E` is what is recorded of a part.
pub struct PartFollower<E = NewEntry> {
    tracker: LiveTracker,
    rows: HungRows<E>,
    at: Duration,
    /// The verdict of the last frame by itself.
    own: Option<Verdict>,
    /// Time of the frame whose entry is held for a part that may leave before its verdict counts.
    held_at: Option<Duration>,
}

impl<E> Default for PartFollower<E> {
    fn default() -> Self {
        Self {
            tracker: LiveTracker::new(&LiveParams::default()),
            rows: HungRows::default(),
            at: Duration::ZERO,
            own: None,
            held_at: None,
        }
    }
}

impl<E> PartFollower<E> {
    /// Takes in a frame, and returns the scene to inspect. Call it for every frame.
    pub fn look(&mut self, scene: Arc<SceneCloud>, taken_at: Timestamp) -> Arc<SceneCloud> {
        self.at = Duration::try_from(taken_at.as_duration()).unwrap_or_default();
        self.own = None;
        self.tracker.look(scene, self.at)
    }

    /// Refuses the part of the frame's own inspection if it moves.
    pub fn refuse_if_moving(&mut self, inspection: &mut Inspection) {
        self.own = Some(inspection.verdict.clone());
        self.refuse(inspection);
    }

    fn refuse(&self, inspection: &mut Inspection) {
        if self.tracker.stillness() == MotionState::Moving {
            refuse_moving(inspection);
        }
    }

    /// Time of the last frame, by the camera.
    pub fn at(&self) -> Duration {
        self.at
    }

    /// Decides about an accepted part of a frame taken `at`, this one or an earlier one, and refuses it unless it hung
    /// still. Returns false if that is not known yet: while the source has just begun, it takes a frame as long after that one
    /// as [`SteadyParams::settle`]. `last` is the last frame's own inspection, `middle` the middle of the part, part space, metres.
    pub fn settle(
        &self,
        inspection: &mut Inspection,
        at: Duration,
        last: &Inspection,
        middle: Option<Point3<f64>>,
    ) -> bool {
        match self.tracker.stillness() {
            MotionState::Steady { since, .. } if since <= at => {}
            MotionState::Steady { .. } | MotionState::Moving => refuse_moving(inspection),
            MotionState::Watching if self.at < at + SteadyParams::default().settle => return false,
            MotionState::Watching => refuse_unless_again(inspection, slice::from_ref(last), middle),
        }
        true
    }

    /// Returns what to record now, after [`Self::refuse_if_moving`] for the same frame and [`Self::settle`] for those before
    /// it. The verdict that counts is formed from several frames; for a part that leaves before, the frame that shows it best
    /// is recorded with its own verdict, see [`Self::settled`]. `middle` is the middle of the named part, part space, metres.
    /// `entry` also gets whether the part is known to have hung still.
    pub fn take(
        &mut self,
        scene: &SceneCloud,
        mut inspection: Inspection,
        middle: Option<Point3<f64>>,
        accept: &AcceptParams,
        entry: impl Fn(&Inspection, HungId, bool) -> E,
    ) -> [Option<E>; 2] {
        // Frames are counted by their own verdicts.
        if let Some(own) = self.own.take() {
            inspection.verdict = own;
        }
        let own = inspection.verdict.clone();
        let verdict = self.tracker.judge(&mut inspection, middle, accept);
        let (left, role) = self.rows.see(&HungFrame {
            scene,
            at: self.at,
            inspection: &inspection,
            verdict: &verdict,
            middle,
            // Recipe and library do not change between frames.
            inputs: "",
        });
        let id = self.rows.id().clone();
        let now = match role {
            FrameRole::Nothing => None,
            FrameRole::Best => {
                inspection.verdict = own;
                self.refuse(&mut inspection);
                self.rows.hold(entry(&inspection, id, false));
                self.held_at = Some(self.at);
                None
            }
            FrameRole::First | FrameRole::Again => Some(entry(&inspection, id, true)),
        };
        [left, now]
    }

    /// The verdict of the frame of this time is settled: if that frame is recorded, should its part leave before a verdict
    /// counts, it is recorded with that verdict.
    pub fn settled(&mut self, at: Duration, entry: impl FnOnce(HungId) -> E) {
        if self.held_at == Some(at) && self.rows.is_holding() {
            self.rows.hold(entry(self.rows.id().clone()));
        }
    }

    /// Ends the source. Returns what is still to be recorded.
    pub fn end(mut self) -> Option<E> {
        self.rows.end()
    }
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
        let mut followed = PartFollower::default();
        let mut kept = Vec::new();
        for number in 1..=73_u64 {
            let scene = scene_at(number);
            let seconds = (number - 1) as f64 / 15.0;
            let taken_at = Timestamp::UNIX_EPOCH + SignedDuration::from_secs_f64(seconds);
            let scene = followed.look(scene, taken_at);
            // As if every frame by itself were accepted.
            let mut inspection = seen.clone();
            followed.refuse_if_moving(&mut inspection);
            let is_accepted = inspection.verdict.is_accepted();
            match seconds {
                // It comes in, and then swings by less and less.
                0.4..2.0 => assert!(!is_accepted, "after {seconds} s"),
                4.4.. => assert!(is_accepted, "after {seconds} s"),
                _ => {}
            }
            let entry =
                |inspection: &Inspection, _, is_still| (inspection.verdict.is_accepted(), is_still);
            let entries = followed.take(&scene, inspection, None, &recipe.accept, entry);
            kept.extend(entries.into_iter().flatten().map(|entry| (seconds, entry)));
        }
        // One verdict that counts, formed at rest from frames by their own verdicts.
        let [(seconds, entry)] = kept[..] else {
            panic!("{kept:?}");
        };
        assert!(seconds > 2.0 && entry == (true, true), "{kept:?}");
    }

    #[test]
    fn a_part_that_leaves_before_its_verdict_counts_is_recorded_with_the_verdict_of_its_frame() {
        let mut cell = SimulatedCell::new(SimulatedSpec {
            scene: CellScene::Part(simulate::PartKind::Fender),
            frames_per_second: 10.0,
            ..SimulatedSpec::default()
        });
        let recipe = Recipe::default();
        let library = shipped_library();
        let mut followed = PartFollower::default();
        let entry =
            |inspection: &Inspection, _, is_still| (inspection.verdict.is_accepted(), is_still);
        let mut frames = Vec::new();
        for number in 1..=3_u64 {
            let scene = Arc::new(scene_from_image(cell.frame(number).0));
            let seconds = number as f64 / 10.0;
            let taken_at = Timestamp::UNIX_EPOCH + SignedDuration::from_secs_f64(seconds);
            let scene = followed.look(scene, taken_at);
            let mut inspection = run(&scene, &library, &recipe, &Unwatched).expect("run");
            followed.refuse_if_moving(&mut inspection);
            assert!(inspection.verdict.is_accepted());
            let taken = followed.take(&scene, inspection.clone(), None, &recipe.accept, entry);
            assert_eq!(taken, [None, None], "too early to tell");
            frames.push((followed.at(), inspection));
        }
        // The source ends here: whoever shows the frames refuses them, and one of them is recorded.
        for (at, mut inspection) in frames {
            refuse_moving(&mut inspection);
            followed.settled(at, |hung| entry(&inspection, hung, false));
        }
        assert_eq!(followed.end(), Some((false, false)));
    }
}
