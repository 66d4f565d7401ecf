//! Confirmation: the best few of the ranking are put where they would have to be, and looked for there.
//!
//! Outlines are alike where parts are not, and fail where a part is half hidden. So every placement of the best-ranked
//! references becomes a start of a pose, refined coarsely; each reference's best is refined further, and its score
//! then follows from distances and from what the camera sees: is the scene's part on the reference, and is the
//! reference in the scene?

use nalgebra::{Isometry3, Point3, Translation3, UnitQuaternion, Vector3};
use rand::{SeedableRng as _, seq::SliceRandom as _};
use rand_pcg::Pcg64;

use crate::{
    geometry::rigid::{RigidTransform, pose_error},
    stages::{
        pose::{
            PoseError, PoseEstimate, PoseMethod, RunnerUp,
            global::{Level, Refined, Search, Source, Target, cost, refine},
            quality::{Fit, Tolerance, look_for, measure_fit},
        },
        rank::{MatchEntry, MatchRanking, Placement, Query},
        reference::Reference,
        scene::SceneCloud,
        segment::SegmentedPart,
    },
    units::Metres,
};

/// Parameters of [`confirm`].
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(default)]
pub struct ConfirmParams {
    /// References looked at, 1..20. Raising it costs about 1.5 ms each and helps parts half hidden.
    pub num_references: usize,
    /// Distance from a reference at which a scene point without noise still lies on it, 2..50 mm.
    pub tolerance: Metres,
    /// Seed for thinning the points.
    pub seed: u64,
}

impl Default for ConfirmParams {
    fn default() -> Self {
        Self {
            num_references: 5,
            tolerance: Metres::from_mm(10.0),
            seed: 1,
        }
    }
}

/// A scene's part as the confirmation sees it.
#[derive(Clone, Copy, Debug)]
pub struct Scene<'a> {
    /// All points, to look for a reference among them.
    pub scene: &'a SceneCloud,
    /// The part's points.
    pub part: &'a SegmentedPart,
    /// Their image, contour and signature.
    pub query: Query<'a>,
}

/// From coarse to fine: the first levels are run for every placement, the next for the best of each reference,
/// the last for the winner. Scales begin at what a placement is off by.
const FIRST: [Level; 2] = [
    Level {
        num_surface: 150,
        num_edges: 48,
        scale: 0.04,
        max_steps: 5,
        search: Search::Field,
    },
    Level {
        num_surface: 150,
        num_edges: 48,
        scale: 0.02,
        max_steps: 4,
        search: Search::Field,
    },
];
const SECOND: [Level; 1] = [Level {
    num_surface: 400,
    num_edges: 128,
    scale: 0.025,
    max_steps: 8,
    search: Search::Field,
}];
const THIRD: [Level; 2] = [
    Level {
        num_surface: 1000,
        num_edges: 256,
        scale: 0.015,
        max_steps: 10,
        search: Search::Field,
    },
    Level {
        num_surface: 1500,
        num_edges: 256,
        scale: 0.01,
        max_steps: 6,
        search: Search::Tree,
    },
];
/// Distance at which a point counts as plainly off, metres.
const COST_LIMIT: f64 = 0.04;
/// Scene points on which the figures of a fit are taken.
const NUM_MEASURED: usize = 1000;

/// Re-orders the ranking by the confirmed scores, and gives the pose of the first.
pub fn confirm(
    scene: &Scene<'_>,
    references: &[Reference],
    ranking: MatchRanking,
    params: &ConfirmParams,
) -> (MatchRanking, Result<PoseEstimate, PoseError>) {
    let source = thinned_source(scene, params);
    if source.surface.len() < 20 {
        let error = PoseError::TooFewPoints {
            which: "source",
            found: source.surface.len(),
            needed: 20,
        };
        return (ranking, Err(error));
    }
    let tolerance = Tolerance {
        base: params.tolerance,
        noise_at_1m: scene.part.noise_at_1m,
    };
    let mut confirmed: Vec<(MatchEntry, Option<Candidate>)> =
        Vec::with_capacity(ranking.entries.len());
    for (position, mut entry) in ranking.entries.into_iter().enumerate() {
        let reference = &references[entry.reference];
        let is_looked_at = position < params.num_references;
        let candidate = is_looked_at
            .then(|| best_candidate(scene, &source, reference, &entry.placements, tolerance))
            .flatten();
        entry.score = match &candidate {
            Some(candidate) => candidate.score,
            None => entry.score * UNCONFIRMED,
        };
        confirmed.push((entry, candidate));
    }
    // Those that were not looked at stay behind those that were.
    let num_looked_at = params.num_references.min(confirmed.len());
    confirmed[..num_looked_at].sort_by(|a, b| b.0.score.total_cmp(&a.0.score));
    let pose = match confirmed.first() {
        Some((entry, Some(best))) => references[entry.reference]
            .target(best.view)
            .map(|target| finish(scene, &source, &target, best, tolerance))
            .ok_or(PoseError::NoReferenceCloud),
        _ => Err(PoseError::NoReferenceCloud),
    };
    let entries = confirmed.into_iter().map(|c| c.0).collect();
    (MatchRanking { entries }, pose)
}

/// What a ranking's score is worth when the part was not looked for.
pub const UNCONFIRMED: f64 = 0.3;

struct Candidate {
    refined: Refined,
    /// The view whose edges it was refined to.
    view: usize,
    score: f64,
    runner_up: Option<RunnerUp>,
}

/// Thins part and edges at random, so that any first n of them are spread over the part.
fn thinned_source(scene: &Scene<'_>, params: &ConfirmParams) -> Source {
    let mut rng = Pcg64::seed_from_u64(params.seed);
    let points = &scene.part.cloud.points;
    let wanted = THIRD[1].num_surface.max(NUM_MEASURED);
    let mut surface: Vec<Point3<f32>> = points
        .iter()
        .step_by((points.len() / wanted).max(1))
        .copied()
        .collect();
    surface.shuffle(&mut rng);
    let camera_from_plane = scene.query.plane.plane_from_camera.inverse();
    let lifted = scene.query.contour.lifted(scene.query.plane);
    let mut edges: Vec<Point3<f32>> = lifted
        .iter()
        .step_by((lifted.len() / 300).max(1))
        .map(|p| (camera_from_plane * p).cast())
        .collect();
    edges.shuffle(&mut rng);
    Source { surface, edges }
}

/// A pose of one reference on its way from coarse to fine.
struct Trial {
    view: usize,
    refined: Refined,
    cost: f64,
}

fn best_candidate(
    scene: &Scene<'_>,
    source: &Source,
    reference: &Reference,
    placements: &[Placement],
    tolerance: Tolerance,
) -> Option<Candidate> {
    let centre = centre_of(&source.surface);
    let starts = distinct_starts(scene, reference, placements, &centre);
    let mut trials: Vec<Trial> = starts
        .into_iter()
        .filter_map(|(view, start)| attempt(source, reference, view, &start, &FIRST))
        .collect();
    trials.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    // Too few points decide between the two ways round of a near-symmetric part: both go on.
    let first = trials.first()?.refined.target_from_source;
    let other = trials
        .iter()
        .position(|t| is_apart(&first, &t.refined.target_from_source, &centre, POSE_APART));
    let mut contenders: Vec<Trial> = [Some(0), other]
        .into_iter()
        .flatten()
        .filter_map(|i| {
            let Trial { view, refined, .. } = &trials[i];
            let mut finer = attempt(
                source,
                reference,
                *view,
                &refined.target_from_source,
                &SECOND,
            )?;
            finer
                .refined
                .iterations
                .splice(0..0, refined.iterations.iter().copied());
            Some(finer)
        })
        .collect();
    contenders.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    let mut contenders = contenders.into_iter();
    let Trial {
        view,
        refined,
        cost,
    } = contenders.next()?;
    let runner_up = contenders
        .next()
        .map(|t| {
            (
                t.refined.target_from_source,
                t.cost / cost.max(f64::MIN_POSITIVE),
            )
        })
        .filter(|(pose, _)| is_apart(&refined.target_from_source, pose, &centre, POSE_APART))
        .map(|(target_from_source, ratio)| RunnerUp {
            target_from_source,
            ratio,
        });
    let target = reference.target(view)?;
    let fit = fit_of(
        scene,
        source,
        &target,
        &refined.target_from_source,
        tolerance,
        Search::Field,
    );
    Some(Candidate {
        score: fit.score(),
        refined,
        view,
        runner_up,
    })
}

/// Neighbouring views lead to nearly the same start: one of them is enough.
fn distinct_starts(
    scene: &Scene<'_>,
    reference: &Reference,
    placements: &[Placement],
    centre: &Point3<f64>,
) -> Vec<(usize, RigidTransform)> {
    let mut starts: Vec<(usize, RigidTransform)> = Vec::new();
    for placement in placements {
        let start = start_of(scene, reference, placement);
        if starts
            .iter()
            .all(|s| is_apart(&s.1, &start, centre, START_APART))
        {
            starts.push((placement.view, start));
        }
    }
    starts
}

fn attempt(
    source: &Source,
    reference: &Reference,
    view: usize,
    start: &RigidTransform,
    levels: &[Level],
) -> Option<Trial> {
    let target = reference.target(view)?;
    let refined = refine(source, &target, start, levels);
    let cost = cost(
        source,
        &target,
        &refined.target_from_source,
        levels.last()?,
        COST_LIMIT,
    );
    Some(Trial {
        view,
        refined,
        cost,
    })
}

/// The winner, refined to the end.
fn finish(
    scene: &Scene<'_>,
    source: &Source,
    target: &Target<'_>,
    best: &Candidate,
    tolerance: Tolerance,
) -> PoseEstimate {
    let last = refine(source, target, &best.refined.target_from_source, &THIRD);
    let mut iterations = best.refined.iterations.clone();
    iterations.extend(last.iterations);
    PoseEstimate {
        target_from_source: last.target_from_source,
        method: PoseMethod::Global,
        stopped: last.stopped,
        iterations,
        fit: fit_of(
            scene,
            source,
            target,
            &last.target_from_source,
            tolerance,
            Search::Tree,
        ),
        runner_up: best.runner_up,
    }
}

/// The pose that a placement in the plane stands for.
fn start_of(scene: &Scene<'_>, reference: &Reference, placement: &Placement) -> RigidTransform {
    let view = &reference.views[placement.view];
    let flat = view.scene_plane_from_view_plane(placement.turn, &scene.query.signature.centroid);
    let scene_plane_from_view_plane = Isometry3::from_parts(
        Translation3::new(flat.translation.x, flat.translation.y, 0.0),
        UnitQuaternion::from_axis_angle(&Vector3::z_axis(), flat.rotation.angle()),
    );
    view.plane_from_part.inverse()
        * scene_plane_from_view_plane.inverse()
        * scene.query.plane.plane_from_camera
}

fn centre_of(points: &[Point3<f32>]) -> Point3<f64> {
    let sum = points
        .iter()
        .fold(Vector3::zeros(), |sum: Vector3<f64>, p| {
            sum + p.coords.cast::<f64>()
        });
    Point3::from(sum / points.len().max(1) as f64)
}

/// Turn (degrees) and shift (millimetres) below which two starts lead to the same pose.
const START_APART: (f64, f64) = (8.0, 20.0);
/// Turn and shift beyond which a refinement would not close, so that two poses are different ones.
const POSE_APART: (f64, f64) = (10.0, 50.0);

fn is_apart(a: &RigidTransform, b: &RigidTransform, at: &Point3<f64>, limits: (f64, f64)) -> bool {
    // At the same point of the scene: the poses map from there.
    let apart = pose_error(a, b, at);
    apart.rotation.degrees() > limits.0 || apart.shift.mm() > limits.1
}

fn fit_of(
    scene: &Scene<'_>,
    source: &Source,
    target: &Target<'_>,
    target_from_source: &RigidTransform,
    tolerance: Tolerance,
    search: Search,
) -> Fit {
    let measured = &source.surface[..NUM_MEASURED.min(source.surface.len())];
    Fit {
        sight: look_for(
            target,
            &target_from_source.inverse(),
            scene.scene,
            tolerance,
        ),
        ..measure_fit(measured, target, target_from_source, tolerance, search)
    }
}
