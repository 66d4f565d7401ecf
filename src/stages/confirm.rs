//! Confirmation: the best few of the ranking are put where they would have to be, and looked for there.
//!
//! Outlines are alike where parts are not, and fail where a part is half hidden. So every placement of the best-ranked
//! references becomes a start of a pose, refined coarsely; each reference's best is refined further, and its score
//! then follows from distances and from what the camera sees: is the scene's part on the reference, and is the
//! reference in the scene?

mod candidate;

use nalgebra::{Point3, Vector3};
use rand::{SeedableRng as _, seq::SliceRandom as _};
use rand_pcg::Pcg64;

use self::candidate::{Candidate, Trial, best_candidate, coarse_trials};
use crate::{
    geometry::rigid::RigidTransform,
    stages::{
        pose::{
            PoseError, PoseEstimate, PoseMethod,
            quality::{Fit, Tolerance, look_for, measure_fit},
            refine::{Level, Search, Source, Target, refine},
            uncertainty::uncertainty,
        },
        rank::{MatchEntry, MatchRanking, Query},
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
        max_steps: 15,
        search: Search::Tree,
    },
];
/// Distance at which a point counts as plainly off, metres.
const COST_LIMIT: f64 = 0.04;
/// A coarse pose that costs this many times the best one is not refined.
const HOPELESS: f64 = 2.5;
/// Scene points on which the figures of a fit are taken.
const NUM_MEASURED: usize = 1000;

/// Re-orders the ranking by the confirmed scores, and gives the pose of the first. Each entry keeps its own pose.
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
    let centre = centre_of(&source.surface);
    let num_looked_at = params.num_references.min(ranking.entries.len());
    let trials: Vec<Vec<Trial>> = ranking.entries[..num_looked_at]
        .iter()
        .map(|entry| {
            coarse_trials(
                scene,
                &source,
                &references[entry.reference],
                &entry.placements,
                &centre,
            )
        })
        .collect();
    let least = trials
        .iter()
        .flatten()
        .map(|t| t.cost)
        .fold(f64::INFINITY, f64::min);
    let mut trials = trials.into_iter();
    let mut confirmed: Vec<(MatchEntry, Option<Candidate>)> = ranking
        .entries
        .into_iter()
        .map(|mut entry| {
            let reference = &references[entry.reference];
            let candidate = trials.next().and_then(|trials| {
                // What is far off already will not win: it is scored where it is.
                let is_worth_more = trials.first()?.cost < HOPELESS * least;
                let levels: &[Level] = if is_worth_more { &SECOND } else { &[] };
                best_candidate(scene, &source, reference, &trials, levels, tolerance)
            });
            entry.score = match &candidate {
                Some(candidate) => candidate.fit.score(),
                None => entry.score * UNCONFIRMED,
            };
            entry.pose = candidate.as_ref().map(Candidate::estimate);
            (entry, candidate)
        })
        .collect();
    // Those that were not looked at stay behind those that were.
    confirmed[..num_looked_at].sort_by(|a, b| b.0.score.total_cmp(&a.0.score));
    let pose = match confirmed.first() {
        Some((entry, Some(best))) => references[entry.reference]
            .target(best.view)
            .map(|target| finish(scene, &source, &target, best, tolerance))
            .ok_or(PoseError::NoReferenceCloud),
        _ => Err(PoseError::NoReferenceCloud),
    };
    let mut entries: Vec<MatchEntry> = confirmed.into_iter().map(|c| c.0).collect();
    if let (Some(first), Ok(pose)) = (entries.first_mut(), &pose) {
        first.pose = Some(pose.clone());
    }
    (MatchRanking { entries }, pose)
}

/// What a ranking's score is worth when the part was not looked for.
pub const UNCONFIRMED: f64 = 0.3;

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
        uncertainty: Some(uncertainty(
            source,
            target,
            &last.target_from_source,
            &THIRD[1],
        )),
        runner_up: best.runner_up,
    }
}

fn centre_of(points: &[Point3<f32>]) -> Point3<f64> {
    let sum = points
        .iter()
        .fold(Vector3::zeros(), |sum: Vector3<f64>, p| {
            sum + p.coords.cast::<f64>()
        });
    Point3::from(sum / points.len().max(1) as f64)
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
