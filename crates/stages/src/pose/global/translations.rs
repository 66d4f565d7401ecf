//! Other poses that may fit: the best ones, shifted.
//!
//! Half a part fits a whole one in many places: a sheet slides along itself, the bars of a grille fit the next ones, and
//! both fit nearly as well turned by half a turn.

use nalgebra::{Translation3, Unit, UnitQuaternion};

use super::{COMPLETE, GlobalSearch, NUM_FINISHED, PoseTrial, sorted};
use crate::pose::{
    PoseError,
    refine::{Level, SETTLED, Search, costs},
};
use geometry::rigid::RigidTransform;

/// Number of shifts tried in each direction, and the size of each in extents of the target.
const SLIDES: i32 = 10;
const SLIDE: f64 = 0.06;
/// Further searches start on a grid along the target's two longest axes: its spacing in extents of the target, and the
/// number of steps in each direction.
const ELSEWHERE: f64 = 0.35;
const STEPS_ELSEWHERE: [i32; 2] = [3, 2];
/// Maximum number of rounds of shifts: each costs as much as the search before.
const MOST_ROUNDS: usize = 4;

impl GlobalSearch<'_> {
    /// Shifts the best pose, as long as this finds a better one and the overlap is not complete.
    pub(super) fn try_translations(&self, finished: &mut Vec<PoseTrial>) -> Result<(), PoseError> {
        for round in 0..MOST_ROUNDS {
            let Some(best) = finished.first() else {
                return Ok(());
            };
            let before = best.costs.whole();
            let mut aside = self.slid(&best.refined.target_from_source);
            if round > 0 {
                for axis in 0..3 {
                    aside.extend(self.slid(&self.half_turned(best, axis)));
                }
            }
            let mut aside = self.distinct(aside);
            aside.truncate(NUM_FINISHED);
            for trial in &mut aside {
                trial
                    .refined
                    .iterations
                    .clone_from(&best.refined.iterations);
            }
            finished.extend(self.finish(aside)?);
            *finished = self.distinct(std::mem::take(finished));
            let best = &finished[0];
            let is_done =
                self.overlap(best) >= COMPLETE || (round > 0 && best.costs.whole() >= before);
            if is_done {
                break;
            }
        }
        Ok(())
    }

    /// Shifts the best poses, as they are and turned by half a turn: the starts of another search.
    pub(super) fn put_elsewhere(&self, finished: &[PoseTrial]) -> Vec<RigidTransform> {
        let extent = self.prepared.extent();
        let axes = &self.prepared.axes.axes;
        let steps = |num: i32| (-num..=num).map(|i| f64::from(i) * ELSEWHERE * extent);
        let mut starts = Vec::new();
        for trial in finished.iter().take(NUM_FINISHED) {
            let pose = trial.refined.target_from_source;
            let turned = (0..3).map(|axis| self.half_turned(trial, axis));
            for pose in std::iter::once(pose).chain(turned) {
                let shifts = steps(STEPS_ELSEWHERE[0])
                    .flat_map(|a| steps(STEPS_ELSEWHERE[1]).map(move |b| (a, b)));
                starts.extend(shifts.map(|(a, b)| {
                    Translation3::from(axes.column(0) * a + axes.column(1) * b) * pose
                }));
            }
        }
        starts
    }

    /// Shifts a pose along the target's two longest axes; returns the shifts of least cost.
    fn slid(&self, pose: &RigidTransform) -> Vec<PoseTrial> {
        let (extent, target) = (self.prepared.extent(), self.prepared.target());
        let level = Level {
            num_surface: 120,
            num_edges: 0,
            scale: 0.0,
            max_steps: 0,
            settled: SETTLED,
            search: Search::Field,
        };
        let axes = &self.prepared.axes.axes;
        let steps = || (-SLIDES..=SLIDES).map(|i| f64::from(i) * SLIDE * extent);
        let slid: Vec<PoseTrial> = steps()
            .flat_map(|a| steps().map(move |b| (a, b)))
            .map(|(a, b)| {
                let shift = axes.column(0) * a + axes.column(1) * b;
                let aside = Translation3::from(shift) * pose;
                let mut trial = PoseTrial::unrefined(aside);
                trial.costs = costs(&self.source, &target, &aside, &level, 0.04 * extent);
                trial
            })
            .collect();
        let mut slid = sorted(slid);
        slid.truncate(20 * NUM_FINISHED);
        slid
    }

    /// The source turned by half a turn about one of the target's axes, its middle where it was.
    fn half_turned(&self, trial: &PoseTrial, axis: usize) -> RigidTransform {
        let pose = trial.refined.target_from_source;
        let middle = pose * self.axes.mean;
        let about = Unit::new_normalize(self.prepared.axes.axes.column(axis).into_owned());
        let turn = UnitQuaternion::from_axis_angle(&about, std::f64::consts::PI);
        Translation3::from(middle.coords) * turn * Translation3::from(-middle.coords) * pose
    }
}
