//! Confirmation: the best few of the ranking are put where they would have to be, and looked for there.
//!
//! Outlines are alike where parts are not, and fail where a part is half hidden. So every placement of the best-ranked
//! references becomes a start of a pose, refined coarsely; each reference's best is refined further, and its score
//! then follows from distances and from what the camera sees: is the scene's part on the reference, and is the
//! reference in the scene? Where only a piece of a part is in sight, of the scene's or of the reference's, only what
//! both show is compared, and the piece is laid onto the references by itself.

mod candidate;
mod confirmed_match;
mod evidence;
pub mod joint;
mod local_normal;
mod outline_ends;
mod outline_shift;
mod piece_search;

use nalgebra::{Point3, Vector3};
use rand::{SeedableRng as _, seq::SliceRandom as _};
use rand_pcg::Pcg64;

use self::{
    candidate::ReferenceCandidate,
    local_normal::LocalNormals,
    outline_ends::{Outline, outline_of},
    outline_shift::outline_shift,
    piece_search::PieceSample,
};
pub use self::{
    confirmed_match::{ConfirmedMatch, ConfirmedRanking},
    evidence::{Evidence, FEATURES, NUM_FEATURES, NUM_TYPE_FEATURES, TYPE_FEATURES},
};
use crate::{
    stages::{
        pose::{
            PoseError, PoseEstimate,
            closest::Correspondence,
            quality::{NUM_LOOKED_FOR, Tolerance},
            refine::{AlignmentSource, Level, Search, refine},
            uncertainty::uncertainty,
        },
        rank::{MatchEntry, MatchRanking, Query},
        reference::{Reference, border::BorderPoint},
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
    /// Seed for thinning the points, 0..999 999.
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
/// A piece is laid on by two points of its border: it starts further off.
const FIRST_OF_A_PIECE: [Level; 2] = [
    Level {
        max_steps: 7,
        ..FIRST[0]
    },
    Level {
        max_steps: 5,
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
/// What the noise leaves of itself in the mean over a patch of points that several frames saw, metres.
const NOISE_OF_JOINT: f64 = 0.001;
/// Turn (degrees) and shift (millimetres) beyond which poses that several frames lead to are different ones.
const POSES_APART: (f64, f64) = (3.0, 20.0);
/// Distance at which a point counts as plainly off, metres.
const COST_LIMIT: f64 = 0.04;
/// A coarse pose that costs this many times the best one is not refined.
const HOPELESS: f64 = 2.5;

/// The ranking by confirmed scores, and the pose of the first.
type Confirmed = (ConfirmedRanking, Result<PoseEstimate, PoseError>);

/// Draws of the border points of a piece: one in three misses a part that is half hidden and noisy.
const MOST_DRAWS: u64 = 3;
/// A best score below this says that a draw may have missed the part.
const MISSED_BELOW: f64 = 0.1;
/// It is drawn again only where a start cost less than this: 0.6 is a good fit, and where nothing is enrolled they cost more.
const NEARLY: f64 = 1.3;

/// Orders the matches by their confirmed scores, and gives the pose of the first.
pub fn confirm(
    scene: &Scene<'_>,
    references: &[Reference],
    ranking: &MatchRanking,
    params: &ConfirmParams,
) -> Confirmed {
    let score = |confirmed: &Confirmed| confirmed.0.entries.first().map_or(0.0, |e| e.score);
    let mut best: Option<Confirmed> = None;
    for draw in 0..MOST_DRAWS {
        let params = ConfirmParams {
            seed: params.seed + draw,
            ..params.clone()
        };
        let (confirmed, least_cost) = confirm_drawn(scene, references, ranking, &params);
        let may_be_missed =
            score(&confirmed) < MISSED_BELOW && least_cost.is_some_and(|cost| cost < NEARLY);
        if best
            .as_ref()
            .is_none_or(|best| score(&confirmed) > score(best))
        {
            best = Some(confirmed);
        }
        if !may_be_missed {
            break;
        }
    }
    best.expect("there is a first draw")
}

/// Confirms with one draw of a piece's border points; also the least cost of a piece on any reference.
fn confirm_drawn(
    scene: &Scene<'_>,
    references: &[Reference],
    ranking: &MatchRanking,
    params: &ConfirmParams,
) -> (Confirmed, Option<f64>) {
    let seen = PreparedScene::new(scene, references, params);
    if seen.source.surface.len() < 20 {
        let error = PoseError::TooFewPoints {
            which: "source",
            found: seen.source.surface.len(),
            needed: 20,
        };
        return ((ConfirmedRanking::untried(ranking, 1.0), Err(error)), None);
    }
    let mut entries: Vec<&MatchEntry> = ranking.entries.iter().collect();
    let num_looked_at = seen.select_entries(&mut entries, references, params);
    let trials = seen.trials(&entries[..num_looked_at], references);
    let costs = trials.iter().flatten().filter(|trial| !trial.is_piece);
    let least = costs.map(|trial| trial.cost).fold(f64::INFINITY, f64::min);
    let of_pieces = trials.iter().flatten().filter(|trial| trial.is_piece);
    let least_of_pieces = of_pieces.map(|trial| trial.cost).min_by(f64::total_cmp);
    let mut trials = trials.into_iter();
    let mut tried: Vec<Tried<'_>> = entries
        .into_iter()
        .enumerate()
        .map(|(number, entry)| {
            let candidate = trials.next().and_then(|trials| {
                // What is far off already will not win: it is scored where it is.
                let first = trials.first()?;
                let is_worth_more = first.is_piece || first.cost < HOPELESS * least;
                let levels: &[Level] = if is_worth_more { &SECOND } else { &[] };
                seen.best_candidate(&references[entry.reference], &trials, levels)
            });
            let score = match &candidate {
                Some(candidate) => candidate.evidence.score(),
                // Whatever a piece was laid onto without success is not it.
                None if number < num_looked_at => 0.0,
                None => entry.score * UNCONFIRMED_WEIGHT,
            };
            Tried {
                entry,
                score,
                candidate,
            }
        })
        .collect();
    // Those that were not looked at stay behind those that were.
    sort_by_score(&mut tried[..num_looked_at]);
    let best = tried.first().map_or(0.0, |first| first.score);
    for tried in &mut tried[..num_looked_at] {
        if let Some(candidate) = tried
            .candidate
            .as_mut()
            .filter(|_| tried.score > (CONTENDS * best).max(HOPELESS_SCORE))
        {
            seen.finish(&references[tried.entry.reference], candidate);
            tried.score = candidate.evidence.score();
        }
    }
    sort_by_score(&mut tried[..num_looked_at]);
    let entries: Vec<ConfirmedMatch> = tried.into_iter().map(Tried::confirmed).collect();
    let pose = entries.first().and_then(|first| first.pose.clone());
    let confirmed = (
        ConfirmedRanking { entries },
        pose.ok_or(PoseError::NoReferenceCloud),
    );
    (confirmed, least_of_pieces)
}

/// A match on its way through the confirmation.
struct Tried<'a> {
    entry: &'a MatchEntry,
    score: f64,
    /// `None` if it was not tried, or has no cloud.
    candidate: Option<ReferenceCandidate>,
}

impl Tried<'_> {
    fn confirmed(self) -> ConfirmedMatch {
        let Self {
            entry,
            score,
            candidate,
        } = self;
        ConfirmedMatch {
            score,
            pose: candidate.as_ref().map(ReferenceCandidate::estimate),
            evidence: candidate.map(|candidate| Evidence {
                shape: entry.score,
                ..candidate.evidence
            }),
            ..ConfirmedMatch::untried(entry, 1.0)
        }
    }
}

fn sort_by_score(tried: &mut [Tried<'_>]) {
    tried.sort_by(|a, b| b.score.total_cmp(&a.score));
}

/// Whose score is more than this share of the best one's is refined to the end.
const CONTENDS: f64 = 0.6;
/// What scores less will not be accepted however exactly it is placed.
const HOPELESS_SCORE: f64 = 1e-4;

/// The scene's side of all comparisons, prepared once.
struct PreparedScene<'a> {
    scene: &'a Scene<'a>,
    source: AlignmentSource,
    centre: Point3<f64>,
    /// Length of the outline that is the part's own, metres.
    own_m: f64,
    /// Share of the outline where only the view ends.
    cut_share: f64,
    /// `None` if a whole part is in sight, and whole ones are enrolled.
    piece: Option<PieceSample>,
    tolerance: Tolerance,
}

/// References that are cut off and looked at whatever they rank.
const MOST_CUT_REFERENCES: usize = 8;

impl<'a> PreparedScene<'a> {
    fn new(scene: &'a Scene<'a>, references: &[Reference], params: &ConfirmParams) -> Self {
        let outline = outline_of(scene);
        let source = thinned_source(scene, &outline, params);
        let are_whole = || {
            references
                .iter()
                .all(|reference| reference.cut.is_nothing())
        };
        let is_whole = outline.cut_share < CUT_SHARE && are_whole();
        let piece = (!is_whole).then(|| {
            PieceSample::new(
                &source.surface,
                oriented_border(scene, &outline),
                params.seed,
            )
        });
        Self {
            scene,
            centre: centre_of(&source.surface),
            source,
            own_m: outline.own.len() as f64 * scene.query.plane.pixel.0,
            cut_share: outline.cut_share,
            piece,
            tolerance: Tolerance {
                base: params.tolerance,
                noise_at_1m: scene.part.noise_at_1m,
            },
        }
    }

    /// What is laid onto a reference as a piece; `None` where both are whole.
    fn piece_for(&self, reference: &Reference) -> Option<&PieceSample> {
        let is_piece = self.cut_share >= CUT_SHARE || !reference.cut.is_nothing();
        self.piece.as_ref().filter(|_| is_piece)
    }

    /// Puts the entries that are to be looked at to the front, and counts them.
    fn select_entries(
        &self,
        entries: &mut [&MatchEntry],
        references: &[Reference],
        params: &ConfirmParams,
    ) -> usize {
        if self.cut_share >= CUT_SHARE {
            // What a piece looks like from afar says little: all are looked at.
            return params
                .num_references
                .max(NUM_FOR_A_PIECE)
                .min(entries.len());
        }
        let mut num = params.num_references.min(entries.len());
        let most = num + MOST_CUT_REFERENCES;
        for i in params.num_references..entries.len() {
            let is_cut = !references[entries[i].reference].cut.is_nothing();
            if is_cut && num < most {
                entries[num..=i].rotate_right(1);
                num += 1;
            }
        }
        num
    }

    /// Refines a candidate to the end.
    fn finish(&self, reference: &Reference, candidate: &mut ReferenceCandidate) {
        let Some(target) = reference.target(candidate.view) else {
            return;
        };
        let start = candidate.refined.target_from_source;
        let last = refine(&self.source, &target, &start, &THIRD);
        candidate.refined.iterations.extend(last.iterations);
        candidate.refined.stopped = last.stopped;
        candidate.refined.target_from_source = last.target_from_source;
        let (source, pose) = (&self.source, &last.target_from_source);
        let closest = Correspondence::of_each(&source.surface, &target, pose, Search::Tree);
        candidate.uncertainty = Some(uncertainty(source, &closest, &target, pose, &THIRD[2]));
        (candidate.fit, candidate.evidence) =
            self.evaluate(reference, candidate.view, pose, &closest, NUM_LOOKED_FOR);
        candidate.evidence.rival = candidate.rival;
        let view = &reference.views[candidate.view];
        let noise = self.scene.part.noise_at_1m;
        candidate.evidence.outline_shift_m = outline_shift(
            source,
            &target,
            &view.contour,
            &view.plane_from_part,
            pose,
            noise,
            &reference.cut,
        );
    }
}

/// What a ranking's score is worth when the part was not looked for.
pub const UNCONFIRMED_WEIGHT: f64 = 0.3;

/// Thins part and edges at random, so that any first n of them are spread over the part.
fn thinned_source(scene: &Scene<'_>, outline: &Outline, params: &ConfirmParams) -> AlignmentSource {
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
    AlignmentSource { surface, edges }
}

/// An outline of which more than this share is not the part's own is that of a piece.
const CUT_SHARE: f64 = 0.04;
/// References that a piece is laid onto.
const NUM_FOR_A_PIECE: usize = 16;
/// Points of the border that get a normal.
const NUM_ORIENTED: usize = 80;

/// The part's own border with the surface's normals, camera space.
fn oriented_border(scene: &Scene<'_>, outline: &Outline) -> Vec<BorderPoint> {
    let camera_from_plane = scene.query.plane.plane_from_camera.inverse();
    let normals = LocalNormals::new(scene);
    let step = outline.own.len().div_ceil(NUM_ORIENTED).max(1);
    let points = outline.own.iter().zip(&outline.along).step_by(step);
    points
        .filter_map(|(at, along)| {
            let at = camera_from_plane * at;
            let normal = normals.at(&at)?;
            let along = (camera_from_plane * along).cast::<f32>();
            // Along the border, and in the surface.
            let along = (along - normal * along.dot(&normal)).try_normalize(0.3)?;
            Some(BorderPoint {
                at: at.cast(),
                along,
                normal,
            })
        })
        .collect()
}

fn centre_of(points: &[Point3<f32>]) -> Point3<f64> {
    let sum = points
        .iter()
        .fold(Vector3::zeros(), |sum: Vector3<f64>, p| {
            sum + p.coords.cast::<f64>()
        });
    Point3::from(sum / points.len().max(1) as f64)
}
