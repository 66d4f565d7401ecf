//! Confirmation: the best few of the ranking are put where they would have to be, and looked for there.
//!
//! Outlines are alike where parts are not, and fail where a part is half hidden. So every placement of the best-ranked
//! references becomes a start of a pose, refined coarsely; each reference's best is refined further, and its score
//! then follows from distances and from what the camera sees: is the scene's part on the reference, and is the
//! reference in the scene? Where only a piece of a part is in sight, the stretches of its outline that are not its own
//! are left out, and the piece is laid onto all references by itself.

mod candidate;
mod ends;
mod evidence;
mod outline_shift;
mod partial;

use nalgebra::{Point3, Vector3};
use rand::{SeedableRng as _, seq::SliceRandom as _};
use rand_pcg::Pcg64;

pub use self::evidence::{Evidence, FEATURES, NUM_FEATURES};
use self::{
    candidate::{Candidate, Trial},
    ends::{Outline, outline_of},
    outline_shift::outline_shift,
    partial::Piece,
};
use crate::{
    stages::{
        pose::{
            PoseError, PoseEstimate,
            closest::Closest,
            quality::{NUM_LOOKED_FOR, Tolerance},
            refine::{Level, Search, Source, refine},
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
    /// References looked at, 1..20. Raising it costs about 1 ms each and helps parts half hidden.
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

/// Steps below a twentieth of a millimetre at the last scale say nothing: the bounds of a pose are a millimetre and more.
const SETTLED: f64 = 0.005;
/// From coarse to fine: the first levels are run for every placement, the next for the best of each reference,
/// the last for the winner. Scales begin at what a placement is off by.
const FIRST: [Level; 2] = [
    Level {
        num_surface: 150,
        num_edges: 48,
        scale: 0.04,
        max_steps: 5,
        settled: SETTLED,
        search: Search::Field,
    },
    Level {
        num_surface: 150,
        num_edges: 48,
        scale: 0.02,
        max_steps: 4,
        settled: SETTLED,
        search: Search::Field,
    },
];
/// The plane of a piece is not that of the part: a piece starts further off.
const FIRST_OF_A_PIECE: [Level; 2] = [
    Level {
        scale: 0.06,
        max_steps: 10,
        ..FIRST[0]
    },
    Level {
        max_steps: 6,
        ..FIRST[1]
    },
];
const SECOND: [Level; 1] = [Level {
    num_surface: 250,
    num_edges: 64,
    scale: 0.025,
    max_steps: 8,
    settled: SETTLED,
    search: Search::Field,
}];
/// The last steps alone take all points.
const THIRD: [Level; 3] = [
    Level {
        num_surface: 400,
        num_edges: 128,
        scale: 0.015,
        max_steps: 10,
        settled: SETTLED,
        search: Search::Field,
    },
    Level {
        num_surface: 400,
        num_edges: 128,
        scale: 0.01,
        max_steps: 15,
        settled: SETTLED,
        search: Search::Tree,
    },
    Level {
        num_surface: 1500,
        num_edges: 256,
        scale: 0.01,
        max_steps: 15,
        settled: SETTLED,
        search: Search::Tree,
    },
];
/// Distance at which a point counts as plainly off, metres.
const COST_LIMIT: f64 = 0.04;
/// A coarse pose that costs this many times the best one is not refined.
const HOPELESS: f64 = 2.5;

/// Re-orders the ranking by the confirmed scores, and gives the pose of the first. Each entry keeps its own pose.
pub fn confirm(
    scene: &Scene<'_>,
    references: &[Reference],
    ranking: MatchRanking,
    params: &ConfirmParams,
) -> (MatchRanking, Result<PoseEstimate, PoseError>) {
    let seen = Seen::new(scene, params);
    if seen.source.surface.len() < 20 {
        let error = PoseError::TooFewPoints {
            which: "source",
            found: seen.source.surface.len(),
            needed: 20,
        };
        return (ranking, Err(error));
    }
    let num_looked_at = match &seen.piece {
        // What a piece looks like from afar says little: all are looked at.
        Some(_) => params.num_references.max(NUM_FOR_A_PIECE),
        None => params.num_references,
    }
    .min(ranking.entries.len());
    let trials: Vec<Vec<Trial>> = ranking.entries[..num_looked_at]
        .iter()
        .map(|entry| seen.coarse_trials(&references[entry.reference], &entry.placements))
        .collect();
    let costs = trials.iter().flatten().map(|trial| trial.cost);
    let least = costs.fold(f64::INFINITY, f64::min);
    let mut trials = trials.into_iter();
    let mut confirmed: Vec<(MatchEntry, Option<Candidate>)> = ranking
        .entries
        .into_iter()
        .map(|mut entry| {
            let candidate = trials.next().and_then(|trials| {
                // What is far off already will not win: it is scored where it is.
                let is_worth_more = trials.first()?.cost < HOPELESS * least;
                let levels: &[Level] = if is_worth_more { &SECOND } else { &[] };
                seen.best_candidate(&references[entry.reference], &trials, levels)
            });
            entry.score = match &candidate {
                Some(candidate) => candidate.evidence.score(),
                None => entry.score * UNCONFIRMED,
            };
            (entry, candidate)
        })
        .collect();
    // Those that were not looked at stay behind those that were.
    sort_by_score(&mut confirmed[..num_looked_at]);
    let best = confirmed.first().map_or(0.0, |c| c.0.score);
    for (entry, candidate) in &mut confirmed[..num_looked_at] {
        if let Some(candidate) = candidate.as_mut().filter(|_| entry.score > CONTENDS * best) {
            seen.finish(&references[entry.reference], candidate);
            entry.score = candidate.evidence.score();
        }
    }
    sort_by_score(&mut confirmed[..num_looked_at]);
    let entries: Vec<MatchEntry> = confirmed
        .into_iter()
        .map(|(mut entry, candidate)| {
            entry.pose = candidate.as_ref().map(Candidate::estimate);
            entry.evidence = candidate.map(|c| c.evidence);
            entry
        })
        .collect();
    let pose = entries.first().and_then(|first| first.pose.clone());
    (
        MatchRanking { entries },
        pose.ok_or(PoseError::NoReferenceCloud),
    )
}

fn sort_by_score(confirmed: &mut [(MatchEntry, Option<Candidate>)]) {
    confirmed.sort_by(|a, b| b.0.score.total_cmp(&a.0.score));
}

/// Whose score is more than this share of the best one's is refined to the end.
const CONTENDS: f64 = 0.6;

/// The scene's side of all comparisons, prepared once.
struct Seen<'a> {
    scene: &'a Scene<'a>,
    source: Source,
    centre: Point3<f64>,
    /// Share of the outline where only the view ends.
    cut_share: f64,
    /// `None` if a whole part is in sight.
    piece: Option<Piece>,
    tolerance: Tolerance,
}

impl<'a> Seen<'a> {
    fn new(scene: &'a Scene<'a>, params: &ConfirmParams) -> Self {
        let outline = outline_of(scene);
        let source = thinned_source(scene, &outline, params);
        Self {
            scene,
            centre: centre_of(&source.surface),
            source,
            cut_share: outline.cut_share,
            piece: piece_of(scene, &outline),
            tolerance: Tolerance {
                base: params.tolerance,
                noise_at_1m: scene.part.noise_at_1m,
            },
        }
    }

    /// Refines a candidate to the end.
    fn finish(&self, reference: &Reference, candidate: &mut Candidate) {
        let Some(target) = reference.target(candidate.view) else {
            return;
        };
        let start = candidate.refined.target_from_source;
        let last = refine(&self.source, &target, &start, &THIRD);
        candidate.refined.iterations.extend(last.iterations);
        candidate.refined.stopped = last.stopped;
        candidate.refined.target_from_source = last.target_from_source;
        let (source, pose) = (&self.source, &last.target_from_source);
        let closest = Closest::of_each(&source.surface, &target, pose, Search::Tree);
        candidate.uncertainty = Some(uncertainty(source, &closest, &target, pose, &THIRD[2]));
        (candidate.fit, candidate.evidence) =
            self.weigh(reference, candidate.view, pose, &closest, NUM_LOOKED_FOR);
        let view = &reference.views[candidate.view];
        let noise = self.scene.part.noise_at_1m;
        candidate.evidence.outline_shift_m = outline_shift(
            source,
            &target,
            &view.contour,
            &view.plane_from_part,
            pose,
            noise,
        );
    }
}

/// What a ranking's score is worth when the part was not looked for.
pub const UNCONFIRMED: f64 = 0.3;

/// Thins part and edges at random, so that any first n of them are spread over the part.
fn thinned_source(scene: &Scene<'_>, outline: &Outline, params: &ConfirmParams) -> Source {
    let mut rng = Pcg64::seed_from_u64(params.seed);
    let points = &scene.part.cloud.points;
    let wanted = THIRD[2].num_surface;
    let mut surface: Vec<Point3<f32>> = points
        .iter()
        .step_by((points.len() / wanted).max(1))
        .copied()
        .collect();
    surface.shuffle(&mut rng);
    let camera_from_plane = scene.query.plane.plane_from_camera.inverse();
    let mut edges: Vec<Point3<f32>> = outline
        .own
        .iter()
        .step_by((outline.own.len() / 300).max(1))
        .map(|p| (camera_from_plane * p).cast())
        .collect();
    edges.shuffle(&mut rng);
    Source { surface, edges }
}

/// An outline of which more than this share is not the part's own is that of a piece.
const CUT_SHARE: f64 = 0.04;
/// References that a piece is laid onto.
const NUM_FOR_A_PIECE: usize = 16;
/// Spacing of the points that stand for a piece's area, pixels.
const PIECE_SPACING: usize = 6;

/// The piece of a part that the scene shows; `None` if it shows a whole part.
fn piece_of(scene: &Scene<'_>, outline: &Outline) -> Option<Piece> {
    if outline.cut_share < CUT_SHARE {
        return None;
    }
    let plane = scene.query.plane;
    let image = &plane.image;
    let mut area = Vec::new();
    for row in (0..image.height).step_by(PIECE_SPACING) {
        for column in (0..image.width).step_by(PIECE_SPACING) {
            if image.is_set(column as i64, row as i64) {
                area.push(plane.plane_point(column as f64, row as f64));
            }
        }
    }
    Piece::new(outline.own.iter().map(nalgebra::Point3::xy), &area)
}

fn centre_of(points: &[Point3<f32>]) -> Point3<f64> {
    let sum = points
        .iter()
        .fold(Vector3::zeros(), |sum: Vector3<f64>, p| {
            sum + p.coords.cast::<f64>()
        });
    Point3::from(sum / points.len().max(1) as f64)
}
