//! ICP-GA, the paper's pose method (Algorithm 3): ICP and a genetic algorithm take turns at minimising E (eq. 12).
//!
//! ICP ends in the nearest valley of E. The genetic algorithm then searches around ICP's solution with E as its fitness,
//! and hands its best back to ICP, until E is below 1e-6 m². Its six genes are three angles, as R = Rz·Ry·Rx, and three
//! lengths: a turn about, and a shift along, the principal axes of the source, before ICP's solution is applied.
//!
//! What the paper leaves open, as it is done here:
//! - Where the genetic algorithm searches. The paper says the vicinity of ICP's solution; ICP's solution from T4 is half
//!   a turn off. So a round searches the *vicinity* of the best pose so far as long as that brings progress, with a
//!   range that follows its E; else it searches *elsewhere*, any turn, except where ICP ended before.
//! - When to give up. Algorithm 3 ends only below 1e-6 m², which two captures of the same part never reach: their points
//!   differ by the noise. Ours ends too when some rounds in a row brought no progress, or at a cap on the rounds.
//! - What E is summed over. Trying a pose sums over a few points, a round over a thousand; E is below the target only if
//!   it is over all points of the source.
//! - ICP goes on below 1e-6 m² until it settles: that takes a step or two, and stopping there may leave 0.3°.

mod params;
#[cfg(test)]
mod tests;

use std::ops::ControlFlow;

use nalgebra::{Isometry3, Point3, Translation3};
use rand::{SeedableRng as _, seq::SliceRandom as _};
use rand_pcg::Pcg64;

use super::{
    genetic::{Genes, minimise},
    icp::icp,
};
use crate::pose::{
    Iteration, MIN_POINTS, Phase, PoseError, PreparedTarget, RunnerUp, Stopped,
    centred::Centred,
    refine::{AlignmentTarget, Refined},
};
use geometry::rigid::{RigidTransform, from_euler_zyx, pose_error};

pub use self::params::IcpGaParams;

/// Points on which a round's E is taken.
const NUM_CHECKED: usize = 1000;
/// A pose whose rms distance is above this share of the target's extent is no solution: nothing is gained around it.
const LOST_ABOVE: f64 = 0.05;
/// The vicinity is at least this many spacings wide: that far ICP may hold on to the wrong neighbours.
const LEAST_SPACINGS: f64 = 2.0;
/// Poses elsewhere are at least this far turned from where ICP ended: within it, ICP would end there again.
const CLOSED_TURN_RAD: f64 = 0.35;
/// A point out of the field's reach counts as this far off, in extents of the target.
const FAR_OFF: f64 = 0.5;
/// Poses less apart than this are the same solution, degrees and extents of the target.
const SAME_TURN_DEGREES: f64 = 5.0;
const SAME_SHIFT: f64 = 0.1;

/// Aligns the source to the target from a start. The iterations are those of ICP and the generations of the genetic
/// algorithm, in order. Also returns the best other pose that ICP ended at, if there is one.
pub(crate) fn icp_ga(
    source: &Centred,
    target: &PreparedTarget,
    start: &RigidTransform,
    params: &IcpGaParams,
    is_cancelled: &dyn Fn() -> bool,
) -> Result<(Refined, Option<RunnerUp>), PoseError> {
    let mut search = Search::new(source, target, params);
    let mut pose = *start;
    let mut best = LocalMinimum {
        target_from_source: pose,
        e_m2: f64::INFINITY,
    };
    let mut num_idle = 0;
    let mut stopped = Stopped::IterationLimit;
    for _ in 0..params.max_rounds.max(1) {
        // Algorithm 3, line 4
        let valley = search.descend(&pose, is_cancelled)?;
        // Lines 5 to 7
        if search.is_below_threshold(&valley) {
            best = valley;
            stopped = Stopped::BelowThreshold;
            break;
        }
        if valley.e_m2 < best.e_m2 * (1.0 - params.least_progress) {
            num_idle = 0;
        } else {
            num_idle += 1;
        }
        if valley.e_m2 < best.e_m2 {
            best = valley;
        }
        if num_idle >= params.patience.max(1) {
            stopped = Stopped::NoProgress;
            break;
        }
        // Lines 9 to 11; line 12 is left to line 5, after the next ICP.
        let search_region = search.search_region(&best, num_idle);
        pose = search.evolve(&best, search_region, is_cancelled)?;
    }
    let runner_up = search.runner_up(&best);
    let refined = Refined {
        target_from_source: best.target_from_source,
        iterations: search.iterations,
        stopped,
    };
    Ok((refined, runner_up))
}

/// Where ICP ended.
#[derive(Clone, Copy, Debug)]
struct LocalMinimum {
    target_from_source: RigidTransform,
    /// E over the points that rounds are compared on.
    e_m2: f64,
}

/// Where the genetic algorithm searches.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum SearchRegion {
    /// Around the best pose, scored with the tree: its closest points are mostly the right ones.
    NearFine,
    /// Around the best pose, scored with the field.
    NearCoarse,
    /// Everywhere but where ICP ended.
    Elsewhere,
}

struct Search<'a> {
    params: &'a IcpGaParams,
    source: &'a [Point3<f32>],
    target: AlignmentTarget<'a>,
    /// In few points, for poses that are far off.
    coarse: AlignmentTarget<'a>,
    /// The source in an order of which any first n are spread over it.
    shuffled: Vec<Point3<f32>>,
    /// Takes the space of the principal axes of the source into source space.
    source_from_axes: RigidTransform,
    target_mean: Point3<f64>,
    /// Standard deviation of the target along its longest axis, metres.
    extent: f64,
    rng: Pcg64,
    valleys: Vec<LocalMinimum>,
    iterations: Vec<Iteration>,
}

impl<'a> Search<'a> {
    fn new(source: &'a Centred, prepared: &'a PreparedTarget, params: &'a IcpGaParams) -> Self {
        let mut rng = Pcg64::seed_from_u64(params.seed);
        let mut shuffled = source.points.clone();
        shuffled.shuffle(&mut rng);
        Self {
            params,
            source: &source.points,
            target: prepared.wide_target(),
            coarse: prepared.coarse_target(),
            shuffled,
            source_from_axes: source.axes.frame(),
            extent: prepared.extent(),
            target_mean: prepared.axes.mean,
            rng,
            valleys: Vec::new(),
            iterations: Vec::new(),
        }
    }

    fn first_points(&self, num: usize) -> &[Point3<f32>] {
        &self.shuffled[..num.clamp(MIN_POINTS, self.shuffled.len())]
    }

    /// ICP from a start.
    fn descend(
        &mut self,
        start: &RigidTransform,
        is_cancelled: &dyn Fn() -> bool,
    ) -> Result<LocalMinimum, PoseError> {
        let Self { params, target, .. } = *self;
        let points = self.first_points(params.icp.max_source_points);
        let cloud = &target.cloud.points;
        let descended = icp(
            points,
            cloud,
            target.tree(),
            start,
            &params.icp,
            is_cancelled,
        );
        let target_from_source = match descended {
            Ok(run) => {
                self.iterations.extend(run.iterations);
                run.target_from_source
            }
            // So far off that one corner of the target is closest to all: middle on middle is a better start.
            Err(PoseError::OneSidedPairs { .. }) => {
                let source_mean = self.source_from_axes * Point3::origin();
                let shift = self.target_mean - start.rotation * source_mean;
                Isometry3::from_parts(Translation3::from(shift), start.rotation)
            }
            Err(error) => return Err(error),
        };
        let valley = LocalMinimum {
            target_from_source,
            e_m2: self.e_m2(self.first_points(NUM_CHECKED), &target_from_source),
        };
        self.valleys.push(valley);
        Ok(valley)
    }

    /// Eq. (12) over some points of the source.
    fn e_m2(&self, points: &[Point3<f32>], pose: &RigidTransform) -> f64 {
        let moved = pose.cast::<f32>();
        let sum_sq: f64 = points
            .iter()
            .filter_map(|p| self.target.tree().nearest(&(moved * p), f32::INFINITY))
            .map(|n| f64::from(n.distance_sq))
            .sum();
        sum_sq / points.len() as f64
    }

    fn is_below_threshold(&self, valley: &LocalMinimum) -> bool {
        let target = self.params.target_e_m2;
        valley.e_m2 < target && self.e_m2(self.source, &valley.target_from_source) < target
    }

    fn search_region(&self, best: &LocalMinimum, num_idle: usize) -> SearchRegion {
        let rms = best.e_m2.sqrt();
        if num_idle > 0 || rms > LOST_ABOVE * self.extent {
            SearchRegion::Elsewhere
        } else if rms < self.target.spacing {
            SearchRegion::NearFine
        } else {
            SearchRegion::NearCoarse
        }
    }

    /// The genetic algorithm's best pose.
    fn evolve(
        &mut self,
        best: &LocalMinimum,
        search_region: SearchRegion,
        is_cancelled: &dyn Fn() -> bool,
    ) -> Result<RigidTransform, PoseError> {
        let Self {
            params,
            target,
            coarse,
            extent,
            source_from_axes,
            ..
        } = *self;
        let (genetic, range, first) = match search_region {
            SearchRegion::Elsewhere => {
                let (turn, shift) = (params.turn_range.0, params.shift_range * extent);
                (&params.elsewhere, ranges(turn, shift), half_turns(turn))
            }
            SearchRegion::NearFine | SearchRegion::NearCoarse => {
                let shift =
                    (params.vicinity_range * best.e_m2.sqrt()).max(LEAST_SPACINGS * target.spacing);
                (
                    &params.vicinity,
                    ranges(shift / extent, shift),
                    vec![[0.0; 6]],
                )
            }
        };
        let num_points = match search_region {
            SearchRegion::NearFine => params.num_fine_points,
            SearchRegion::NearCoarse | SearchRegion::Elsewhere => params.num_coarse_points,
        };
        let mut rng = self.rng.clone();
        let points = self.first_points(num_points);
        let axes_from_source = source_from_axes.inverse();
        let target_from_axes = best.target_from_source * source_from_axes;
        let posed = |genes: &Genes| target_from_axes * from_euler_zyx(*genes) * axes_from_source;
        let far_off_sq = (FAR_OFF * extent).powi(2) as f32;
        let distance_sq = |at: &Point3<f32>| {
            let nearest = match search_region {
                SearchRegion::NearFine => target.tree().nearest(at, f32::INFINITY),
                SearchRegion::NearCoarse => target.field.nearest(at),
                SearchRegion::Elsewhere => coarse.field.nearest(at),
            };
            nearest.map_or(far_off_sq, |n| n.distance_sq)
        };
        let is_closed = |pose: &RigidTransform| {
            search_region == SearchRegion::Elsewhere
                && self.valleys.iter().any(|valley| {
                    valley.target_from_source.rotation.angle_to(&pose.rotation) < CLOSED_TURN_RAD
                })
        };
        // Eq. (12), as far as it takes to know that it is above the bound.
        let fitness = |genes: &Genes, bound: f64| {
            let pose = posed(genes);
            if is_closed(&pose) {
                return f64::INFINITY;
            }
            let moved = pose.cast::<f32>();
            let most = bound * points.len() as f64;
            let mut sum_sq = 0.0;
            for p in points {
                sum_sq += f64::from(distance_sq(&(moved * p)));
                if sum_sq > most {
                    return f64::INFINITY;
                }
            }
            sum_sq / points.len() as f64
        };
        let mut generations = Vec::new();
        let winner = minimise(&first, &range, genetic, &mut rng, fitness, |best| {
            if best.cost.is_finite() {
                generations.push(Iteration {
                    phase: Phase::Genetic,
                    e_m2: best.cost,
                    target_from_source: posed(&best.genes),
                    num_pairs: points.len(),
                });
            }
            if best.cost < params.target_e_m2 || is_cancelled() {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        });
        let pose = posed(&winner.genes);
        self.rng = rng;
        self.iterations.extend(generations);
        if is_cancelled() {
            return Err(PoseError::Cancelled);
        }
        Ok(pose)
    }

    /// The best valley that is a different pose.
    fn runner_up(&self, best: &LocalMinimum) -> Option<RunnerUp> {
        let middle = self.source_from_axes * Point3::origin();
        let is_other = |valley: &&LocalMinimum| {
            let (a, b) = (&valley.target_from_source, &best.target_from_source);
            let apart = pose_error(a, b, &middle);
            apart.rotation.degrees() > SAME_TURN_DEGREES || apart.shift.0 > SAME_SHIFT * self.extent
        };
        let others = self.valleys.iter().filter(is_other);
        let runner_up = others.min_by(|a, b| a.e_m2.total_cmp(&b.e_m2))?;
        Some(RunnerUp {
            target_from_source: runner_up.target_from_source,
            ratio: (runner_up.e_m2 / best.e_m2.max(f64::MIN_POSITIVE)).max(1.0),
        })
    }
}

fn ranges(turn: f64, shift: f64) -> Genes {
    [turn, turn, turn, shift, shift, shift]
}

/// Half a turn about each axis, where the range of the angles allows it: a nearly flat part fits nearly as well so.
fn half_turns(turn_range: f64) -> Vec<Genes> {
    use std::f64::consts::PI;
    let about = |axis: usize| std::array::from_fn(|gene| if gene == axis { PI } else { 0.0 });
    if turn_range < PI {
        Vec::new()
    } else {
        (0..3).map(about).collect()
    }
}
