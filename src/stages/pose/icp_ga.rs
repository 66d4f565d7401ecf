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

use std::ops::ControlFlow;

use nalgebra::{Isometry3, Point3, Translation3};
use rand::{SeedableRng as _, seq::SliceRandom as _};
use rand_pcg::Pcg64;

use super::{
    Iteration, MIN_POINTS, Phase, PoseError, PoseEstimate, PoseMethod, RunnerUp, Stopped,
    genetic::{Genes, GeneticParams, minimise},
    icp::{IcpParams, icp},
    quality::{Fit, Tolerance, look_for, measure_fit},
    refine::{Search as SearchBy, Target},
    spanned::spanned_axes,
};
use crate::{
    geometry::{
        nearest_field::NearestField,
        principal::PrincipalAxes,
        rigid::{RigidTransform, from_euler_zyx, pose_error},
    },
    stages::{reference::Reference, scene::SceneCloud, segment::SegmentedPart},
    units::{Metres, Radians},
};

/// Parameters of [`icp_ga`].
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(default)]
pub struct IcpGaParams {
    /// E at which Algorithm 3 is content, square metres, 0..1e-4; the paper's 1e-6 is 1 mm rms. Lowering it costs
    /// rounds, and below the noise of the clouds all of them.
    pub target_e_m2: f64,
    /// Each round's ICP. Raising its points or iterations slows every round: by experiment 400 points and 30 iterations
    /// are enough, as what they miss the next search finds. Its own target is 0, so that it settles.
    pub icp: IcpParams,
    /// The search around the best pose.
    pub vicinity: GeneticParams,
    /// Range of the search around the best pose, in rms distances of that pose, 1..10; as a turn, that length at the
    /// part's extent. Raising it finds what ICP left further off, and settles more coarsely.
    pub vicinity_range: f64,
    /// The search elsewhere.
    pub elsewhere: GeneticParams,
    /// Range of the angles elsewhere, 0..π. Less than π leaves out poses that a person knows to be impossible.
    pub turn_range: Radians,
    /// Range of the shifts elsewhere, as a share of the target's extent (its standard deviation along its longest axis),
    /// 0..2. Raising it finds smaller overlaps, and needs a larger population.
    pub shift_range: f64,
    /// Points of the source that a pose is tried on where it is to be told by millimetres, 20..1000. Raising it costs
    /// time in proportion.
    pub num_fine_points: usize,
    /// Points of the source that a pose is tried on elsewhere, 20..1000. Raising it costs time in proportion.
    pub num_coarse_points: usize,
    /// Most rounds of Algorithm 3, 1..1000. Each costs 5 to 40 ms.
    pub max_rounds: usize,
    /// Rounds in a row without progress after which there is none to be had, 1..100. Raising it finds hidden poses, and
    /// costs about 8 ms each where the target cannot be reached.
    pub patience: usize,
    /// Share by which E must fall for a round to count as progress, 0..1. Raising it gives up sooner.
    pub least_progress: f64,
    /// Seed of all that is drawn.
    pub seed: u64,
}

impl Default for IcpGaParams {
    fn default() -> Self {
        Self {
            target_e_m2: 1e-6,
            icp: IcpParams {
                max_iterations: 30,
                target_e_m2: 0.0,
                max_source_points: 400,
                ..IcpParams::default()
            },
            vicinity: GeneticParams {
                population: 60,
                tournament: 3,
                crossover_rate: 0.9,
                half_turn_rate: 0.0,
                ..GeneticParams::default()
            },
            vicinity_range: 4.0,
            elsewhere: GeneticParams::default(),
            turn_range: Radians(std::f64::consts::PI),
            shift_range: 0.5,
            num_fine_points: 60,
            num_coarse_points: 100,
            max_rounds: 40,
            patience: 8,
            least_progress: 0.02,
            seed: 1,
        }
    }
}

/// Points on which a round's E is taken.
const NUM_CHECKED: usize = 1000;
/// A pose whose rms distance is above this share of the target's extent is no solution: nothing is gained around it.
const LOST_ABOVE: f64 = 0.05;
/// The vicinity is at least this many spacings wide: that far ICP may hold on to the wrong neighbours.
const LEAST_SPACINGS: f64 = 2.0;
/// Poses elsewhere are at least this far turned from where ICP ended: within it, ICP would end there again.
const CLOSED_TURN: f64 = 0.35;
/// A point out of the field's reach counts as this far off, in extents of the target.
const FAR_OFF: f64 = 0.5;
/// Poses less apart than this are the same solution, degrees and extents of the target.
const SAME_TURN_DEGREES: f64 = 5.0;
const SAME_SHIFT: f64 = 0.1;

/// A run of Algorithm 3 and where it ended.
#[derive(Clone, Debug, PartialEq)]
pub struct IcpGaRun {
    /// The best pose.
    pub target_from_source: RigidTransform,
    /// Every iteration of ICP and every generation of the genetic algorithm, in order.
    pub iterations: Vec<Iteration>,
    /// Why it ended.
    pub stopped: Stopped,
    /// The best other pose that ICP ended at, if there is one.
    pub runner_up: Option<RunnerUp>,
}

/// Aligns the source to the target from a start. The target's field should answer up to half of its extent.
pub fn icp_ga(
    source: &[Point3<f32>],
    target: &Target<'_>,
    start: &RigidTransform,
    params: &IcpGaParams,
    is_cancelled: &dyn Fn() -> bool,
) -> Result<IcpGaRun, PoseError> {
    let mut search = Search::new(source, target, params)?;
    let mut pose = *start;
    let mut best = Valley {
        target_from_source: pose,
        e_m2: f64::INFINITY,
    };
    let mut num_idle = 0;
    let mut stopped = Stopped::IterationLimit;
    for _ in 0..params.max_rounds.max(1) {
        // Algorithm 3, line 4
        let valley = search.descend(&pose, is_cancelled)?;
        // Lines 5 to 7
        if search.is_below_target(&valley) {
            best = valley;
            stopped = Stopped::BelowTarget;
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
        let whereabouts = search.whereabouts(&best, num_idle);
        pose = search.evolve(&best, whereabouts, is_cancelled)?;
    }
    Ok(IcpGaRun {
        target_from_source: best.target_from_source,
        runner_up: search.runner_up(&best),
        iterations: search.iterations,
        stopped,
    })
}

/// Where ICP ended.
#[derive(Clone, Copy, Debug)]
struct Valley {
    target_from_source: RigidTransform,
    /// E over the points that rounds are compared on.
    e_m2: f64,
}

/// Where the genetic algorithm searches.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Whereabouts {
    /// Around the best pose, told by the tree: its closest points are mostly the right ones.
    NearFine,
    /// Around the best pose, told by the field.
    NearCoarse,
    /// Everywhere but where ICP ended.
    Elsewhere,
}

struct Search<'a> {
    params: &'a IcpGaParams,
    source: &'a [Point3<f32>],
    target: &'a Target<'a>,
    /// The source in an order of which any first n are spread over it.
    shuffled: Vec<Point3<f32>>,
    /// Takes the space of the principal axes of the source into source space.
    source_from_axes: RigidTransform,
    target_axes: PrincipalAxes,
    /// Standard deviation of the target along its longest axis, metres.
    extent: f64,
    rng: Pcg64,
    valleys: Vec<Valley>,
    iterations: Vec<Iteration>,
}

impl<'a> Search<'a> {
    fn new(
        source: &'a [Point3<f32>],
        target: &'a Target<'a>,
        params: &'a IcpGaParams,
    ) -> Result<Self, PoseError> {
        let source_axes = spanned_axes("source", source)?;
        let target_axes = spanned_axes("target", &target.cloud.points)?;
        let mut rng = Pcg64::seed_from_u64(params.seed);
        let mut shuffled = source.to_vec();
        shuffled.shuffle(&mut rng);
        Ok(Self {
            params,
            source,
            target,
            shuffled,
            source_from_axes: source_axes.frame(),
            extent: target_axes.variances[0].sqrt(),
            target_axes,
            rng,
            valleys: Vec::new(),
            iterations: Vec::new(),
        })
    }

    fn first_points(&self, num: usize) -> &[Point3<f32>] {
        &self.shuffled[..num.clamp(MIN_POINTS, self.shuffled.len())]
    }

    /// ICP from a start.
    fn descend(
        &mut self,
        start: &RigidTransform,
        is_cancelled: &dyn Fn() -> bool,
    ) -> Result<Valley, PoseError> {
        let Self { params, target, .. } = *self;
        let points = self.first_points(params.icp.max_source_points);
        let cloud = &target.cloud.points;
        let descended = icp(points, cloud, target.tree, start, &params.icp, is_cancelled);
        let target_from_source = match descended {
            Ok(run) => {
                self.iterations.extend(run.iterations);
                run.target_from_source
            }
            // So far off that one corner of the target is closest to all: middle on middle is a better start.
            Err(PoseError::OneSidedPairs { .. }) => {
                let source_mean = self.source_from_axes * Point3::origin();
                let shift = self.target_axes.mean - start.rotation * source_mean;
                Isometry3::from_parts(Translation3::from(shift), start.rotation)
            }
            Err(error) => return Err(error),
        };
        let valley = Valley {
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
            .filter_map(|p| self.target.tree.nearest(&(moved * p), f32::INFINITY))
            .map(|n| f64::from(n.distance_sq))
            .sum();
        sum_sq / points.len() as f64
    }

    fn is_below_target(&self, valley: &Valley) -> bool {
        let target = self.params.target_e_m2;
        valley.e_m2 < target && self.e_m2(self.source, &valley.target_from_source) < target
    }

    fn whereabouts(&self, best: &Valley, num_idle: usize) -> Whereabouts {
        let rms = best.e_m2.sqrt();
        if num_idle > 0 || rms > LOST_ABOVE * self.extent {
            Whereabouts::Elsewhere
        } else if rms < self.target.spacing {
            Whereabouts::NearFine
        } else {
            Whereabouts::NearCoarse
        }
    }

    /// The genetic algorithm's best pose.
    fn evolve(
        &mut self,
        best: &Valley,
        whereabouts: Whereabouts,
        is_cancelled: &dyn Fn() -> bool,
    ) -> Result<RigidTransform, PoseError> {
        let Self {
            params,
            target,
            extent,
            source_from_axes,
            ..
        } = *self;
        let (genetic, range, first) = match whereabouts {
            Whereabouts::Elsewhere => {
                let (turn, shift) = (params.turn_range.0, params.shift_range * extent);
                (&params.elsewhere, ranges(turn, shift), half_turns(turn))
            }
            Whereabouts::NearFine | Whereabouts::NearCoarse => {
                let shift =
                    (params.vicinity_range * best.e_m2.sqrt()).max(LEAST_SPACINGS * target.spacing);
                (
                    &params.vicinity,
                    ranges(shift / extent, shift),
                    vec![[0.0; 6]],
                )
            }
        };
        let num_points = match whereabouts {
            Whereabouts::NearFine => params.num_fine_points,
            Whereabouts::NearCoarse | Whereabouts::Elsewhere => params.num_coarse_points,
        };
        let mut rng = self.rng.clone();
        let points = self.first_points(num_points);
        let axes_from_source = source_from_axes.inverse();
        let target_from_axes = best.target_from_source * source_from_axes;
        let posed = |genes: &Genes| target_from_axes * from_euler_zyx(*genes) * axes_from_source;
        let far_off_sq = (FAR_OFF * extent).powi(2) as f32;
        let distance_sq = |at: &Point3<f32>| {
            let nearest = match whereabouts {
                Whereabouts::NearFine => target.tree.nearest(at, f32::INFINITY),
                Whereabouts::NearCoarse | Whereabouts::Elsewhere => target.field.nearest(at),
            };
            nearest.map_or(far_off_sq, |n| n.distance_sq)
        };
        let is_closed = |pose: &RigidTransform| {
            whereabouts == Whereabouts::Elsewhere
                && self.valleys.iter().any(|valley| {
                    valley.target_from_source.rotation.angle_to(&pose.rotation) < CLOSED_TURN
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
    fn runner_up(&self, best: &Valley) -> Option<RunnerUp> {
        let middle = self.source_from_axes * Point3::origin();
        let is_other = |valley: &&Valley| {
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

/// The pose of a scene's part by Algorithm 3, from the standard position, that is from no displacement.
pub fn locate_by_icp_ga(
    part: &SegmentedPart,
    reference: &Reference,
    scene: &SceneCloud,
    params: &IcpGaParams,
    is_cancelled: &dyn Fn() -> bool,
) -> Result<PoseEstimate, PoseError> {
    let target = reference.target(0).ok_or(PoseError::NoReferenceCloud)?;
    // The reference's own field answers near its surface only: the confirmation starts from placements.
    let points = &target.cloud.points;
    let extent = spanned_axes("target", points)?.variances[0].sqrt();
    let cell = (2.0 * target.spacing).max(extent / 60.0) as f32;
    let field = NearestField::new(points, cell, (FAR_OFF * extent) as f32);
    let target = Target {
        field: &field,
        ..target
    };
    let source = &part.cloud.points;
    let run = icp_ga(
        source,
        &target,
        &RigidTransform::identity(),
        params,
        is_cancelled,
    )?;
    let tolerance = Tolerance {
        base: Metres::from_mm(10.0),
        noise_at_1m: part.noise_at_1m,
    };
    let measured: Vec<Point3<f32>> = source
        .iter()
        .step_by(source.len().div_ceil(NUM_MEASURED).max(1))
        .copied()
        .collect();
    let pose = run.target_from_source;
    let fit = Fit {
        sight: look_for(&target, &pose.inverse(), scene, tolerance),
        ..measure_fit(&measured, &target, &pose, tolerance, SearchBy::Tree)
    };
    Ok(PoseEstimate {
        target_from_source: pose,
        method: PoseMethod::IcpGa,
        stopped: run.stopped,
        iterations: run.iterations,
        fit,
        runner_up: run.runner_up,
    })
}

/// Points on which the figures of a fit are taken.
const NUM_MEASURED: usize = 5000;
