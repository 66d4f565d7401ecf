//! Confirmation: aligns the best few references of the ranking with the scene, and scores each at its pose.
//!
//! Different parts may have similar outlines, and a part that is half hidden does not show its own. So every placement of
//! the best-ranked references becomes a start of a pose and is refined coarsely; each reference's best pose is refined
//! further. Its score (`evidence`) follows from distances and from what the camera sees: does the scene's part lie on the
//! reference, and is the reference in the scene? Where only a piece is in sight, of the scene's part or of the reference,
//! only what both show is compared, and the piece is also aligned with the references by itself.

mod candidate;
mod confirmed_match;
mod evidence;
mod hidden_sides;
pub mod joint;
mod local_normal;
mod outline_ends;
mod outline_shift;
mod piece_search;
mod prepared_scene;

pub(crate) use self::evidence::facing_view;
use self::{
    candidate::{MAX_ODDS_OF_RIVALS, ReferenceCandidate},
    evidence::most_score,
    outline_ends::outline_of,
    outline_shift::edges_of_part,
    prepared_scene::{PreparedScene, thinned_source},
};
pub use self::{
    confirmed_match::{ConfirmedMatch, ConfirmedRanking},
    evidence::{Evidence, FEATURES, NUM_FEATURES, NUM_TYPE_FEATURES, TYPE_FEATURES},
    hidden_sides::by_hidden_sides,
    prepared_scene::CUT_SHARE,
};
use crate::{
    pose::{
        CloudRole, PoseError, PoseEstimate, ScaleEstimate, Uncertainty,
        closest::Correspondence,
        refine::{Level, Search},
        scale::scale,
        uncertainty::uncertainty,
    },
    rack::Rack,
    rank::{MatchEntry, MatchRanking, Query},
    reference::Reference,
    scene::SceneCloud,
    segment::SegmentedPart,
};
use geometry::{rigid::RigidTransform, units::Metres};

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
    /// Where parts may hang: of two poses that fit alike, one that is allowed there is found.
    pub rack: &'a Rack,
    /// Names of the parts that should hang there; of two that look alike, the expected one is found.
    pub expected: &'a [String],
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
const JOINT_NOISE_M: f64 = 0.001;
/// Turn (degrees) and shift (millimetres) beyond which poses that several frames lead to are different ones.
const POSES_APART_DEG_MM: (f64, f64) = (3.0, 20.0);
/// Distance at which a point counts as plainly off, metres.
const PLAINLY_OFF_M: f64 = 0.04;
/// A coarse pose that costs this many times the best one is not refined.
const MAX_COST_RATIO: f64 = 2.5;

/// The ranking by confirmed scores, and the pose of the first.
type Confirmed = (ConfirmedRanking, Result<PoseEstimate, PoseError>);

/// A best score below this says that a draw may have missed the part.
const MISSED_MAX_SCORE: f64 = 0.1;
/// It is drawn again only for references on which a start cost less than this: 0.6 is a good fit, and where nothing is
/// enrolled they cost more.
const PIECE_MAX_START_COST: f64 = 1.3;
/// Nor is it drawn again where one cost less than this: that draw found where the piece fits, and what speaks against the
/// part there is not the draw's doing.
const PIECE_GOOD_START_COST: f64 = 0.25;

/// Orders the matches by their confirmed scores, and gives the pose of the first.
///
/// Poses that cannot reach `least_score` are not refined further; only those that may be accepted are refined to the end. If
/// too little is in sight for any pose to reach it, no reference is examined, and all scores are 0.
pub fn confirm(
    scene: &Scene<'_>,
    references: &[Reference],
    ranking: &MatchRanking,
    params: &ConfirmParams,
    least_score: f64,
) -> Confirmed {
    let mut seen = PreparedScene::new(scene, references, params, least_score);
    if seen.source.surface.len() < 20 {
        let error = PoseError::TooFewPoints {
            which: CloudRole::Source,
            found: seen.source.surface.len(),
            needed: 20,
        };
        return (ConfirmedRanking::unexamined(ranking), Err(error));
    }
    let mut entries: Vec<&MatchEntry> = ranking.entries.iter().collect();
    let can_reach_it = most_score(scene.query.contour.area, seen.own_m()) >= least_score;
    let num_looked_at = if can_reach_it {
        seen.select_entries(&mut entries, references, params)
    } else {
        0
    };
    let (looked_at, others) = entries.split_at(num_looked_at);
    let mut tried = seen.examine(looked_at, references, least_score);
    // One draw of a piece's border in three misses a part that is half hidden and noisy. About 200 second draws gave four
    // acceptances; as many third draws gave none. Where there is a score to beat, none of 130 second draws led to an acceptance.
    let may_draw_again = least_score <= 0.0;
    seen.finish(&mut tried, references, least_score);
    let best = tried.first().map_or(0.0, |first| first.score);
    let costs = tried.iter().map(|tried| tried.piece_cost);
    let least_cost = costs.fold(f64::INFINITY, f64::min);
    if may_draw_again
        && best < MISSED_MAX_SCORE
        && (PIECE_GOOD_START_COST..PIECE_MAX_START_COST).contains(&least_cost)
    {
        let candidates = tried
            .iter()
            .filter(|tried| tried.piece_cost < PIECE_MAX_START_COST);
        let candidates: Vec<&MatchEntry> = candidates.map(|tried| tried.entry).collect();
        seen.draw_again(params.seed + 1);
        let mut again = seen.examine(&candidates, references, least_score);
        seen.finish(&mut again, references, least_score);
        for again in again {
            let mut before = tried.iter_mut();
            let before = before.find(|before| before.entry.reference == again.entry.reference);
            if let Some(before) = before.filter(|before| before.score < again.score) {
                *before = again;
            }
        }
        sort_by_score(&mut tried);
    }
    seen.put_expected_first(&mut tried, references);
    if let Some(first) = tried.first_mut()
        && let Some((index, candidate)) = first.finished()
    {
        let reference = &references[index];
        // Rival poses matter only for a candidate that may be accepted.
        if candidate.evidence.score() > REFINE_FULLY_MIN_SCORE {
            seen.weigh_turned(reference, candidate);
        }
        candidate.scale = seen.scale(reference, candidate);
        // It stays the first, because the others are not refined to the end.
        first.score = candidate.evidence.score();
    }
    // Those that were not looked at stay behind those that were.
    let others = others.iter().map(|entry| ConfirmedMatch {
        score: 0.0,
        ..ConfirmedMatch::unexamined(entry)
    });
    let tried = tried.into_iter().map(Tried::confirmed);
    let entries: Vec<ConfirmedMatch> = tried.chain(others).collect();
    let pose = entries.first().and_then(|first| first.pose.clone());
    (
        ConfirmedRanking { entries },
        pose.ok_or(PoseError::NoReferenceCloud),
    )
}

/// The bounds and the scale at a pose that another method found for the scene's part; `None` if the reference has nothing to
/// align with.
pub fn bounds_and_scale(
    scene: &Scene<'_>,
    reference: &Reference,
    target_from_source: &RigidTransform,
    seed: u64,
) -> Option<(Uncertainty, Option<ScaleEstimate>)> {
    let source = thinned_source(scene, &outline_of(scene), seed);
    let view = facing_view(reference, target_from_source);
    let target = reference.target(view)?;
    let (surface, pose) = (&source.surface, target_from_source);
    let closest = Correspondence::of_each(surface, &target, pose, Search::Tree);
    let noise = scene.part.noise_at_1m;
    let plane_from_part = &reference.views[view].plane_from_part;
    let edges = edges_of_part(
        &source,
        &target,
        plane_from_part,
        pose,
        noise,
        &reference.cut,
    );
    Some((
        uncertainty(&source, &closest, &target, pose, &THIRD[2], 1),
        scale(&source, &edges, &target, pose, noise),
    ))
}

impl PreparedScene<'_> {
    /// Looks for some references in the scene; the best comes first.
    fn examine<'a>(
        &self,
        entries: &[&'a MatchEntry],
        references: &[Reference],
        least_score: f64,
    ) -> Vec<Tried<'a>> {
        let trials = self.trials(entries, references, least_score);
        let costs = trials.iter().flatten().filter(|trial| !trial.is_piece);
        let least = costs.map(|trial| trial.cost).fold(f64::INFINITY, f64::min);
        let candidates = self.in_parallel(entries.len(), |number| {
            let first = trials[number].first()?;
            // What is far off already will not win: it is scored where it is.
            let is_worth_more = first.is_piece || first.cost < MAX_COST_RATIO * least;
            let levels: &[Level] = if is_worth_more { &SECOND } else { &[] };
            let reference = &references[entries[number].reference];
            self.best_candidate(reference, &trials[number], levels)
        });
        let mut tried: Vec<Tried<'a>> = entries
            .iter()
            .zip(trials)
            .zip(candidates)
            .map(|((entry, trials), candidate)| {
                let of_piece = trials.iter().filter(|trial| trial.is_piece);
                Tried {
                    entry,
                    // Whatever a piece was laid onto without success is not it.
                    score: candidate.as_ref().map_or(0.0, |c| c.evidence.score()),
                    piece_cost: of_piece
                        .map(|trial| trial.cost)
                        .fold(f64::INFINITY, f64::min),
                    candidate,
                }
            })
            .collect();
        sort_by_score(&mut tried);
        tried
    }

    /// Refines the first further, if it may reach `least_score` then, and what may become as good; to the end only what may be
    /// accepted.
    fn finish(&self, tried: &mut [Tried<'_>], references: &[Reference], least_score: f64) {
        let hopeless = if self.is_piece {
            REFINE_PIECE_MIN_SCORE
        } else {
            REFINE_MIN_SCORE
        };
        let least = (least_score / MAX_SCORE_GAIN).max(hopeless);
        self.refine_above(tried, least, MAX_SCORE_GAIN, |tried, candidate| {
            let is_in_doubt = !candidate.is_settled && tried.score < REFINE_FULLY_MIN_SCORE;
            is_in_doubt.then(|| self.settled(&references[tried.entry.reference], candidate))?
        });
        let least = DEFAULT_MIN_SCORE / MAX_LATER_SCORE_GAIN;
        self.refine_above(tried, least, MAX_LATER_SCORE_GAIN, |tried, candidate| {
            let is_unfinished = candidate.uncertainty.is_none();
            is_unfinished.then(|| self.finished(&references[tried.entry.reference], candidate))?
        });
    }

    /// Where parts that score alike include expected and unexpected ones: compares them by every reading, and puts first the
    /// expected one that leads over all unexpected ones.
    fn put_expected_first(&self, tried: &mut [Tried<'_>], references: &[Reference]) {
        let best = tried.first().map_or(0.0, |first| odds(first.score));
        let num_within = |tried: &[Tried<'_>], least: f64| {
            let within = tried.iter().take_while(|tried| odds(tried.score) > least);
            within.count()
        };
        // What is put first is less likely than the best, and so are its own rivals.
        let num_rivals = num_within(tried, best / MAX_ODDS_OF_RIVALS.powi(2));
        let num_firsts = num_within(tried, best / MAX_ODDS_OF_RIVALS);
        let rivals = &mut tried[..num_rivals];
        let is_expected = |tried: &Tried<'_>| self.scene.expected.contains(&tried.entry.part);
        let num_expected = rivals.iter().filter(|tried| is_expected(tried)).count();
        if num_expected == 0 || num_expected == num_rivals {
            return;
        }
        for tried in &mut *rivals {
            if let Some((index, candidate)) = tried.finished() {
                let pose = candidate.refined.target_from_source;
                let close = self.look_closely(&references[index], candidate.view, &pose);
                candidate.evidence.close = close;
            }
        }
        let lead = |one: &Tried<'_>, other: &Tried<'_>| {
            let evidence = |tried: &Tried<'_>| Some(tried.candidate.as_ref()?.evidence);
            evidence(one)?.lead_over(&evidence(other)?)
        };
        let leads = |one: &Tried<'_>| {
            let mut others = rivals.iter().filter(|other| !is_expected(other));
            is_expected(one) && others.all(|other| lead(one, other).is_some_and(|lead| lead > 0.0))
        };
        if let Some(index) = rivals[..num_firsts].iter().position(leads) {
            rivals[..=index].rotate_right(1);
        }
    }

    /// Refines the first, if its score is above `least`, and the others if they may become the first when scores grow by
    /// `most_gained` at most and the first may be accepted.
    fn refine_above(
        &self,
        tried: &mut [Tried<'_>],
        least: f64,
        most_gained: f64,
        refined: impl Fn(&Tried<'_>, &ReferenceCandidate) -> Option<ReferenceCandidate> + Sync,
    ) {
        let best = tried.first().map_or(0.0, |first| first.score);
        let least_of_others = if best * most_gained < DEFAULT_MIN_SCORE {
            f64::INFINITY
        } else {
            (best / most_gained).max(RUNNER_UP_MIN_SCORE)
        };
        let refined = self.in_parallel(tried.len(), |index| {
            let least = if index == 0 { least } else { least_of_others };
            let tried = &tried[index];
            let candidate = tried.candidate.as_ref().filter(|_| tried.score > least)?;
            refined(tried, candidate)
        });
        for (tried, refined) in tried.iter_mut().zip(refined) {
            if let Some(candidate) = refined {
                tried.score = candidate.evidence.score();
                tried.candidate = Some(candidate);
            }
        }
        sort_by_score(tried);
    }
}

/// A match that was looked for in the scene.
struct Tried<'a> {
    entry: &'a MatchEntry,
    score: f64,
    /// Least cost of a piece on the reference; infinite without one.
    piece_cost: f64,
    /// `None` if it has no cloud, or no start was worth a refinement.
    candidate: Option<ReferenceCandidate>,
}

impl Tried<'_> {
    /// Its reference, and its candidate if that is refined to the end.
    fn finished(&mut self) -> Option<(usize, &mut ReferenceCandidate)> {
        let candidate = self.candidate.as_mut()?;
        let is_finished = candidate.uncertainty.is_some();
        is_finished.then_some((self.entry.reference, candidate))
    }

    fn confirmed(self) -> ConfirmedMatch {
        let Self {
            entry,
            score,
            candidate,
            ..
        } = self;
        ConfirmedMatch {
            score,
            rival: candidate.as_ref().map_or(0.0, |candidate| candidate.rival),
            is_examined: true,
            pose: candidate.as_ref().map(ReferenceCandidate::estimate),
            evidence: candidate.map(|candidate| Evidence {
                shape: entry.score,
                ..candidate.evidence
            }),
            ..ConfirmedMatch::unexamined(entry)
        }
    }
}

fn sort_by_score(tried: &mut [Tried<'_>]) {
    tried.sort_by(|a, b| b.score.total_cmp(&a.score));
}

/// How many times more probable than not a match with this score is.
fn odds(score: f64) -> f64 {
    score / (1.0 - score).max(f64::EPSILON)
}

/// Poses that score less are not refined.
const REFINE_MIN_SCORE: f64 = 1e-4;
/// The same for a piece, which below 0.05 counts as unlike every enrolled part; for a whole part, lower scores count, too.
const REFINE_PIECE_MIN_SCORE: f64 = 0.05 / MAX_SCORE_GAIN;
/// The default score of acceptance. If the best pose cannot reach it, the others are not refined.
const DEFAULT_MIN_SCORE: f64 = 0.9;
/// Poses that score more skip the intermediate level and are refined to the end at once.
const REFINE_FULLY_MIN_SCORE: f64 = 0.5;
/// Poses behind the first that score less are not refined: they do not become the first.
const RUNNER_UP_MIN_SCORE: f64 = 0.005;
/// The last refinement makes no score grow by more than this factor: at most 22 in 657 candidates of five suites.
const MAX_SCORE_GAIN: f64 = 25.0;
/// The same after its first level: of 419 scores above 0.05 one grew 6.1-fold, the others by less, and of 254 below it none
/// reached 0.12.
const MAX_LATER_SCORE_GAIN: f64 = 6.0;
