//! The global pose: from no start at all.
//!
//! Lengths follow from the clouds: their extent limits the error of a start, their spacing the accuracy of the result.
//! Two clouds of the same whole object have the same principal variances, and their principal axes coincide up to half
//! turns. These starts come first. If one of them fits well, the search ends, because a rigid motion that maps such a cloud
//! onto itself also maps its axes onto themselves. Otherwise rotations spread evenly over SO(3), centre on centre, compete
//! in rounds: all are refined a little on few points, and the best go on to more points and finer scales. The centre of a
//! view is not that of the part, so the best are shifted and go through the rounds once more.
//!
//! A nearly flat sheet can slide along its own surface, so the poses that fit on the fine scale are also compared by the
//! borders of both clouds. Copies of the same points need no borders, and are then exact.
//!
//! Known limits: a view also ends where the surface turns away from the camera. Such a border has no counterpart, and
//! attracts the pose to any other border nearby.

mod best;
mod translations;

use nalgebra::Point3;
use rand::{SeedableRng as _, seq::SliceRandom as _};
use rand_pcg::Pcg64;

use super::{
    PoseError, PoseEstimate,
    centred::Centred,
    prepared::PreparedTarget,
    refine::{AlignmentSource, AlignmentTarget, Costs, Level, Refined, Search, costs, refine},
    starts::{all_round, along_axes},
};
use geometry::{
    cloud::PointCloud,
    principal::{PrincipalAxes, principal_axes},
    rigid::{RigidTransform, pose_error},
    statistics::sample_evenly,
    surface_grid::SurfaceGrid,
    units::Metres,
    voxel::downsample,
};

/// Trials that are refined on the fine likeness: the best, and two to compare it with.
const NUM_FINISHED: usize = 3;
/// Share of the source that lies on the target where nothing is left to be found elsewhere.
const COMPLETE: f64 = 0.99;
/// Principal variances that differ by less than this share are those of the same whole thing.
const ALIKE: f64 = 0.15;
/// Principal variances that differ by less than this share leave their axes free to turn into each other.
const TURNABLE: f64 = 0.25;
/// What a stretch of a border may be off by where both clouds show the whole thing, and where the source may end
/// elsewhere, metres: on them most bounds hold (`partsight-bench registration`).
const OUTLINE_ERROR_OF_WHOLE_M: f64 = 0.003;
const OUTLINE_ERROR_OF_VIEW_M: f64 = 0.01;
/// Share of the source that lies on the target where a start along the axes convinces.
const CONVINCING: f64 = 0.9;

/// Points of a source at most in which its borders are looked for, and those of them that are used.
const MOST_FOR_EDGES: usize = 12_000;
const NUM_EDGES: usize = 256;

/// A level ends once its steps are below this share of its scale: in the rounds, and in the level before the last.
const ROUGHLY_SETTLED: f64 = 0.05;
const NEARLY_SETTLED: f64 = 0.02;

/// A round of the search.
struct Round {
    /// Points of the source.
    num_points: usize,
    /// Scale in extents of the target.
    scale: f64,
    max_steps: usize,
    /// Trials that go on.
    num_kept: usize,
}

/// From what a start is off by, some 40°, to what the fine likeness closes.
const RACE: [Round; 4] = [
    Round {
        num_points: 80,
        scale: 0.35,
        max_steps: 4,
        num_kept: 60,
    },
    Round {
        num_points: 120,
        scale: 0.2,
        max_steps: 4,
        num_kept: 24,
    },
    Round {
        num_points: 250,
        scale: 0.1,
        max_steps: 6,
        num_kept: 10,
    },
    Round {
        num_points: 400,
        scale: 0.06,
        max_steps: 8,
        num_kept: 5,
    },
];

/// A pose on its way, with what it costs.
struct PoseTrial {
    costs: Costs,
    refined: Refined,
}

/// The pose of a source on a prepared target, from a start or from none. Both about their own middle.
pub(super) fn search(
    source: &Centred,
    prepared: &PreparedTarget,
    no_turn: RigidTransform,
    start: Option<RigidTransform>,
    is_cancelled: &dyn Fn() -> bool,
) -> Result<PoseEstimate, PoseError> {
    let search = GlobalSearch::new(source, prepared, is_cancelled);
    let axes = (&search.axes, &prepared.axes);
    let mut finished = Vec::new();
    let mut outline_error = OUTLINE_ERROR_OF_VIEW_M;
    if let Some(start) = start {
        finished = search.successive_halving([start], &RACE)?;
    } else {
        let near_at_hand = || std::iter::once(no_turn).chain(along_axes(axes.0, axes.1));
        if have_same_shape(axes.0, axes.1) {
            finished = search.successive_halving(near_at_hand(), &RACE[2..])?;
            let best = finished.first();
            let overlap = best.map_or(0.0, |best| search.overlap(best));
            if overlap < CONVINCING {
                finished.clear();
            } else if overlap < COMPLETE {
                search.try_translations(&mut finished)?;
            }
        }
        if finished.is_empty() {
            let starts = near_at_hand().chain(all_round(axes.0, axes.1));
            finished = search.successive_halving(starts, &RACE)?;
            let elsewhere = search.put_elsewhere(&finished);
            finished.extend(search.successive_halving(elsewhere, &RACE)?);
            finished = search.distinct(finished);
        } else {
            outline_error = OUTLINE_ERROR_OF_WHOLE_M;
        }
    }
    search.refine_best(finished, outline_error)
}

/// True for clouds of the same whole thing, whose axes cannot turn into each other.
fn have_same_shape(a: &PrincipalAxes, b: &PrincipalAxes) -> bool {
    let close = |a: f64, b: f64, share: f64| (a - b).abs() <= share * a.max(b);
    let (a, b) = (&a.variances, &b.variances);
    (0..3).all(|i| close(a[i], b[i], ALIKE)) && (0..2).all(|i| !close(a[i], a[i + 1], TURNABLE))
}

struct GlobalSearch<'a> {
    prepared: &'a PreparedTarget,
    all_points: &'a [Point3<f32>],
    /// Evenly dense, as the target's coarse likeness: a camera sees what is near it in more points.
    coarse: AlignmentSource,
    source: AlignmentSource,
    axes: PrincipalAxes,
    is_cancelled: &'a dyn Fn() -> bool,
}

impl<'a> GlobalSearch<'a> {
    fn new(
        source: &'a Centred,
        prepared: &'a PreparedTarget,
        is_cancelled: &'a dyn Fn() -> bool,
    ) -> Self {
        let some = sample_evenly(&source.points, prepared.finest().num_surface);
        let some = some.copied().collect();
        let all = sample_evenly(&source.points, MOST_FOR_EDGES);
        let all = PointCloud::from_points(all.copied());
        let even = downsample(&all, Metres(prepared.coarse_target().spacing)).points;
        let axes = principal_axes(even.iter().map(|p| (p.cast(), 1.0))).unwrap_or(source.axes);
        let ends = SurfaceGrid::new(&all.points).ends();
        let mut edges: Vec<Point3<f32>> = ends.iter().map(|end| end.at).collect();
        edges.shuffle(&mut Pcg64::seed_from_u64(1));
        edges.truncate(NUM_EDGES);
        Self {
            prepared,
            all_points: &source.points,
            coarse: shuffled(even, edges.clone()),
            source: shuffled(some, edges),
            axes,
            is_cancelled,
        }
    }

    /// Refines the starts on the coarse likeness by these rounds of [`RACE`], fewer and fewer of them, and the best few on the
    /// fine one; the cheapest of different poses first. A start along the axes needs the last rounds only.
    fn successive_halving(
        &self,
        starts: impl IntoIterator<Item = RigidTransform>,
        rounds: &[Round],
    ) -> Result<Vec<PoseTrial>, PoseError> {
        let extent = self.prepared.extent();
        let target = self.prepared.coarse_target();
        let mut trials: Vec<PoseTrial> = starts.into_iter().map(PoseTrial::unrefined).collect();
        for round in rounds {
            let level = Level {
                num_surface: round.num_points,
                num_edges: 0,
                scale: round.scale * extent,
                max_steps: round.max_steps,
                settled: ROUGHLY_SETTLED,
                search: Search::Field,
            };
            trials = self.further(trials, &self.coarse, &target, &[level], 2.0 * level.scale)?;
            trials.truncate(4 * round.num_kept);
            trials = self.distinct(trials);
            trials.truncate(round.num_kept);
        }
        self.finish(trials)
    }

    /// Refines the best few on the fine likeness, down to its spacing.
    fn finish(&self, mut trials: Vec<PoseTrial>) -> Result<Vec<PoseTrial>, PoseError> {
        trials.truncate(NUM_FINISHED);
        let (extent, target) = (self.prepared.extent(), self.prepared.target());
        let finest = self.prepared.finest().scale;
        // One at least, however few points there are: what poses cost is compared after the same refinement only.
        let coarsest = (0.03 * extent).max(finest);
        let levels: Vec<Level> = std::iter::successors(Some(coarsest), |s| Some(s / 2.0))
            .take_while(|scale| *scale >= finest)
            .map(|scale| Level {
                num_surface: 600,
                num_edges: 200,
                scale,
                max_steps: 7,
                settled: NEARLY_SETTLED,
                search: Search::Field,
            })
            .collect();
        let limit = (0.05 * extent).max(2.0 * finest);
        let trials = self.further(trials, &self.source, &target, &levels, limit)?;
        Ok(self.distinct(trials))
    }

    /// Takes every trial through the levels and sorts them by what they then cost, each distance cut off at `limit`.
    fn further(
        &self,
        mut trials: Vec<PoseTrial>,
        source: &AlignmentSource,
        target: &AlignmentTarget<'_>,
        levels: &[Level],
        limit: f64,
    ) -> Result<Vec<PoseTrial>, PoseError> {
        for trial in &mut trials {
            if (self.is_cancelled)() {
                return Err(PoseError::Cancelled);
            }
            trial.refine(source, target, levels);
            let level = &levels[levels.len() - 1];
            let pose = &trial.refined.target_from_source;
            trial.costs = costs(source, target, pose, level, limit);
        }
        Ok(sorted(trials))
    }

    /// Of poses that a refinement would close, the cheapest; the cheapest of all first.
    fn distinct(&self, trials: Vec<PoseTrial>) -> Vec<PoseTrial> {
        let mut kept: Vec<PoseTrial> = Vec::new();
        for trial in sorted(trials) {
            let is_new = kept.iter().all(|k| {
                let (a, b) = (
                    &k.refined.target_from_source,
                    &trial.refined.target_from_source,
                );
                let apart = pose_error(a, b, &self.axes.mean);
                apart.rotation.degrees() > 5.0 || apart.shift.0 > 0.1 * self.prepared.extent()
            });
            if is_new {
                kept.push(trial);
            }
        }
        kept
    }
}

/// Any first n of the points are spread over the source.
fn shuffled(mut surface: Vec<Point3<f32>>, edges: Vec<Point3<f32>>) -> AlignmentSource {
    surface.shuffle(&mut Pcg64::seed_from_u64(1));
    AlignmentSource { surface, edges }
}

fn sorted(mut trials: Vec<PoseTrial>) -> Vec<PoseTrial> {
    trials.sort_by(|a, b| a.costs.whole().total_cmp(&b.costs.whole()));
    trials
}

impl PoseTrial {
    fn refine(&mut self, source: &AlignmentSource, target: &AlignmentTarget<'_>, levels: &[Level]) {
        let start = &self.refined.target_from_source;
        self.refined.append(refine(source, target, start, levels));
    }

    fn unrefined(target_from_source: RigidTransform) -> Self {
        Self {
            costs: Costs {
                surface: f64::INFINITY,
                ..Costs::default()
            },
            refined: Refined {
                target_from_source,
                iterations: Vec::new(),
                stopped: super::Stopped::IterationLimit,
            },
        }
    }
}
