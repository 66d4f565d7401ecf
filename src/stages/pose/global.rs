//! The global pose: from no start at all.
//!
//! Lengths follow from the clouds: their extent says how far off a start may be, their spacing how fine the answer
//! can be. The search tries the target's principal axes all four ways round and rotations spread evenly over SO(3)
//! (M. Alexa, "Super-Fibonacci spirals: fast, low-discrepancy sampling of SO(3)", CVPR 2022), each refined on few
//! points; the better ones go on to more points and finer scales.
//!
//! Known limits: a shift between clouds that share less than about half of their surface is only found if it is small
//! against their size, since starts put centre on centre.

use nalgebra::{Isometry3, Point3, Quaternion, Translation3, UnitQuaternion, Vector3};
use rand::{SeedableRng as _, seq::SliceRandom as _};
use rand_pcg::Pcg64;

use super::{
    Iteration, MIN_POINTS, PoseError, PoseEstimate, PoseMethod, RunnerUp,
    edge_points::EdgePoints,
    quality::{Tolerance, measure_fit},
    refine::{Level, Refined, Search, Source, Target, cost, refine},
};
use crate::{
    geometry::{
        cloud::PointCloud,
        nearest::KdTree,
        nearest_field::NearestField,
        normals::estimate_normals,
        principal::{PrincipalAxes, principal_axes},
        rigid::{RigidTransform, pose_error},
        voxel::downsample,
    },
    units::Metres,
};

/// Rotations tried beside the principal axes: no rotation is further than about 35° from one of them, within what the
/// coarse refinement closes.
const NUM_ROTATIONS: usize = 150;
/// Trials that go on after the coarse refinement.
const NUM_KEPT: usize = 12;
/// Trials that are refined to the end: the best, and two to compare it with.
const NUM_FINISHED: usize = 3;
/// Distance at which a point counts as plainly off in the coarse comparison, in extents of the target.
const COST_LIMIT: f64 = 0.2;
/// Points of the target at most: more do not sharpen the pose, and cost memory.
const MAX_TARGET_POINTS: usize = 150_000;
/// Points of the source used in the last refinement.
const NUM_SOURCE_POINTS: usize = 4_000;

/// As the clouds lie; then centre on centre: principal axes on principal axes, rotations spread evenly.
pub(super) fn starts(
    no_turn: RigidTransform,
    source: &PrincipalAxes,
    target: &PrincipalAxes,
) -> Vec<RigidTransform> {
    let about_centres = |turn: UnitQuaternion<f64>| {
        let shift = target.mean - turn * source.mean;
        Isometry3::from_parts(Translation3::from(shift), turn)
    };
    let (of_source, of_target) = (source.frame().rotation, target.frame().rotation);
    let half_turns = [
        UnitQuaternion::identity(),
        UnitQuaternion::from_axis_angle(&Vector3::x_axis(), std::f64::consts::PI),
        UnitQuaternion::from_axis_angle(&Vector3::y_axis(), std::f64::consts::PI),
        UnitQuaternion::from_axis_angle(&Vector3::z_axis(), std::f64::consts::PI),
    ];
    let along_axes = half_turns.map(|half| about_centres(of_target * half * of_source.inverse()));
    std::iter::once(no_turn)
        .chain(along_axes)
        .chain(spread_rotations(NUM_ROTATIONS).map(about_centres))
        .collect()
}

fn spread_rotations(num: usize) -> impl Iterator<Item = UnitQuaternion<f64>> {
    // The constants of the article: irrational ratios for which the spiral covers SO(3) evenly.
    const PHI: f64 = std::f64::consts::SQRT_2;
    const PSI: f64 = 1.533_751_168_755_204_3;
    (0..num).map(move |i| {
        let s = i as f64 + 0.5;
        let (r, big_r) = ((s / num as f64).sqrt(), (1.0 - s / num as f64).sqrt());
        let (alpha, beta) = (
            std::f64::consts::TAU * s / PHI,
            std::f64::consts::TAU * s / PSI,
        );
        let (sin_a, cos_a) = alpha.sin_cos();
        let (sin_b, cos_b) = beta.sin_cos();
        UnitQuaternion::from_quaternion(Quaternion::new(
            big_r * cos_b,
            r * sin_a,
            r * cos_a,
            big_r * sin_b,
        ))
    })
}

/// A pose on its way, with what it costs.
struct Trial {
    cost: f64,
    refined: Refined,
}

fn level(num_surface: usize, scale: f64, max_steps: usize, search: Search) -> Level {
    Level {
        num_surface,
        num_edges: 0,
        scale,
        max_steps,
        search,
    }
}

/// A target with what searching it needs, and the lengths that follow from it.
pub(super) struct PreparedTarget {
    cloud: PointCloud,
    tree: KdTree,
    field: NearestField,
    edges: EdgePoints,
    /// Distance between neighbouring points, metres.
    spacing: f64,
    /// Standard deviation along the widest axis, metres.
    extent: f64,
}

impl PreparedTarget {
    pub(super) fn new(points: &[Point3<f32>]) -> Self {
        let all = PointCloud::from_points(points.iter().copied());
        let mut spacing = spacing_of(points);
        let mut cloud = all;
        while cloud.points.len() > MAX_TARGET_POINTS {
            spacing *= 1.3;
            cloud = downsample(&cloud, Metres(spacing));
        }
        let tree = KdTree::new(&cloud.points);
        let centre = principal_axes(cloud.points.iter().map(|p| (p.cast(), 1.0)));
        let viewpoint = centre.map_or(Point3::origin(), |c| c.mean);
        let extent = centre.map_or(0.0, |c| c.variances[0].sqrt());
        // Three spacings reach some thirty neighbours: enough to average the noise of one point.
        cloud.normals = Some(estimate_normals(
            &cloud.points,
            &tree,
            Metres(3.0 * spacing),
            &viewpoint,
        ));
        let cell = (2.0 * spacing).max(extent / 60.0) as f32;
        let field = NearestField::new(&cloud.points, cell, (0.5 * extent) as f32);
        Self {
            tree,
            field,
            edges: EdgePoints::default(),
            spacing,
            extent,
            cloud,
        }
    }

    pub(super) fn target(&self) -> Target<'_> {
        let Self {
            cloud,
            tree,
            field,
            edges,
            ..
        } = self;
        Target {
            cloud,
            tree,
            field,
            edges,
            spacing: self.spacing,
        }
    }

    /// The best pose that any of the starts leads to.
    pub(super) fn search(
        &self,
        source: &[Point3<f32>],
        starts: &[RigidTransform],
        is_cancelled: &dyn Fn() -> bool,
    ) -> Result<PoseEstimate, PoseError> {
        let step = (source.len() / NUM_SOURCE_POINTS).max(1);
        let mut surface: Vec<Point3<f32>> = source.iter().step_by(step).copied().collect();
        surface.shuffle(&mut Pcg64::seed_from_u64(1));
        let source = Source {
            surface,
            edges: Vec::new(),
        };
        let centre = principal_axes(source.surface.iter().map(|p| (p.cast(), 1.0)))
            .map_or(Point3::origin(), |axes| axes.mean);

        let from_starts = starts.iter().map(|start| (start, [].as_slice()));
        let mut trials = self.trials(
            &source,
            from_starts,
            &self.coarse(),
            COST_LIMIT,
            is_cancelled,
        )?;
        trials.truncate(NUM_KEPT);
        let mut trials = self.further(
            &source,
            &trials,
            &self.middle(),
            COST_LIMIT / 2.0,
            is_cancelled,
        )?;
        trials = self.distinct(trials, &centre);
        trials.truncate(NUM_FINISHED);
        let trials = self.further(
            &source,
            &trials,
            &self.fine(),
            COST_LIMIT / 4.0,
            is_cancelled,
        )?;

        let mut trials = self.distinct(trials, &centre).into_iter();
        let best = trials.next().ok_or_else(|| self.no_overlap(0))?;
        let num_pairs = best.refined.iterations.last().map_or(0, |i| i.num_pairs);
        if num_pairs < MIN_POINTS {
            return Err(self.no_overlap(num_pairs));
        }
        let runner_up = trials.next().map(|t| RunnerUp {
            target_from_source: t.refined.target_from_source,
            ratio: t.cost / best.cost.max(f64::MIN_POSITIVE),
        });
        Ok(self.estimate(&source.surface, best.refined, PoseMethod::Global, runner_up))
    }

    /// From what a start is off by to what a coarse refinement closes.
    fn coarse(&self) -> [Level; 2] {
        [
            level(120, 0.35 * self.extent, 5, Search::Field),
            level(200, 0.15 * self.extent, 5, Search::Field),
        ]
    }

    fn middle(&self) -> [Level; 2] {
        [
            level(600, 0.1 * self.extent, 8, Search::Field),
            level(600, 0.05 * self.extent, 8, Search::Field),
        ]
    }

    /// Halving, down to the spacing.
    fn fine(&self) -> Vec<Level> {
        let finest = (1.5 * self.spacing).min(0.1 * self.extent);
        let mut levels: Vec<Level> =
            std::iter::successors(Some(0.03 * self.extent), |s| Some(s / 2.0))
                .take_while(|scale| *scale > finest)
                .map(|scale| level(1500, scale, 10, Search::Field))
                .collect();
        levels.push(level(NUM_SOURCE_POINTS, finest, 40, Search::Tree));
        levels
    }

    /// Refines every pose through the levels; the cheapest first. Each comes with the iterations that led to it.
    fn trials<'a>(
        &self,
        source: &Source,
        poses: impl Iterator<Item = (&'a RigidTransform, &'a [Iteration])>,
        levels: &[Level],
        cost_limit: f64,
        is_cancelled: &dyn Fn() -> bool,
    ) -> Result<Vec<Trial>, PoseError> {
        let target = self.target();
        let mut trials: Vec<Trial> = poses
            .map(|(pose, before)| {
                if is_cancelled() {
                    return Err(PoseError::Cancelled);
                }
                let mut refined = refine(source, &target, pose, levels);
                refined.iterations.splice(0..0, before.iter().copied());
                let level = &levels[levels.len() - 1];
                let limit = cost_limit * self.extent;
                let cost = cost(source, &target, &refined.target_from_source, level, limit);
                Ok(Trial { cost, refined })
            })
            .collect::<Result<_, _>>()?;
        trials.sort_by(|a, b| a.cost.total_cmp(&b.cost));
        Ok(trials)
    }

    fn further(
        &self,
        source: &Source,
        trials: &[Trial],
        levels: &[Level],
        cost_limit: f64,
        is_cancelled: &dyn Fn() -> bool,
    ) -> Result<Vec<Trial>, PoseError> {
        let poses = trials.iter().map(|t| {
            (
                &t.refined.target_from_source,
                t.refined.iterations.as_slice(),
            )
        });
        self.trials(source, poses, levels, cost_limit, is_cancelled)
    }

    fn no_overlap(&self, found: usize) -> PoseError {
        PoseError::NoOverlap {
            found,
            needed: MIN_POINTS,
            reach: Metres(0.5 * self.extent),
        }
    }

    /// Of poses that a refinement would close, the cheapest.
    fn distinct(&self, sorted: Vec<Trial>, centre: &Point3<f64>) -> Vec<Trial> {
        let mut kept: Vec<Trial> = Vec::new();
        for trial in sorted {
            let is_new = kept.iter().all(|k| {
                let (a, b) = (
                    &k.refined.target_from_source,
                    &trial.refined.target_from_source,
                );
                let apart = pose_error(a, b, centre);
                apart.rotation.degrees() > 5.0 || apart.shift.0 > 0.1 * self.extent
            });
            if is_new {
                kept.push(trial);
            }
        }
        kept
    }

    /// The estimate that a refined pose stands for.
    pub(super) fn estimate(
        &self,
        source: &[Point3<f32>],
        refined: Refined,
        method: PoseMethod,
        runner_up: Option<RunnerUp>,
    ) -> PoseEstimate {
        let step = (source.len() / NUM_SOURCE_POINTS).max(1);
        let measured: Vec<Point3<f32>> = source.iter().step_by(step).copied().collect();
        let tolerance = Tolerance {
            base: Metres(3.0 * self.spacing),
            noise_at_1m: Metres(0.0),
        };
        let fit = measure_fit(
            &measured,
            &self.target(),
            &refined.target_from_source,
            tolerance,
            Search::Tree,
        );
        PoseEstimate {
            target_from_source: refined.target_from_source,
            method,
            stopped: refined.stopped,
            iterations: refined.iterations,
            fit,
            runner_up,
        }
    }
}

/// The median distance of a point to its nearest neighbour, metres.
fn spacing_of(points: &[Point3<f32>]) -> f64 {
    const NUM_ASKED: usize = 500;
    let tree = KdTree::new(points);
    let step = (points.len() / NUM_ASKED).max(1);
    let mut distances: Vec<f32> = points
        .iter()
        .enumerate()
        .step_by(step)
        .filter_map(|(i, p)| tree.nearest_other(p, i).map(|n| n.distance_sq.sqrt()))
        // Twins say nothing about spacing.
        .filter(|d| *d > 0.0)
        .collect();
    if distances.is_empty() {
        return 1e-6;
    }
    let middle = distances.len() / 2;
    f64::from(*distances.select_nth_unstable_by(middle, f32::total_cmp).1)
}
