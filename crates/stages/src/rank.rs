//! Ranking: how well each reference explains the scene's shape, best first.
//!
//! Default matcher: for every view of a reference, the circular correlation of the complex rays L·e^{iΘ} over all lags
//! (by FFT) yields the lag, the rotation in the plane and the remaining distance between the outlines at once. The best
//! few views are then laid over the scene's image, openings included, and scored by their overlap. Lengths are metric
//! throughout, so size is evidence. Of a library of more than 256 references, those whose summaries rule out a score among
//! the first 16 are not compared.
//!
//! Paper matcher: Algorithm 2 with eq. 7 and 11 and Note 1, as written.

mod placement;

use placement::{PlacementSearch, most_score, refine_first};

pub use self::placement::ImagePlacement;
use crate::{
    contour::Contour,
    project::PlaneImage,
    reference::Reference,
    shape_summary::ShapeSummary,
    signature::{FanSignature, LiteralSignature},
};
use geometry::{
    parallel::{map_each, map_in_order, num_cores},
    units::Metres,
};

/// The matcher that ranks the references.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Matcher {
    /// Circular correlation of complex rays, then overlap of the images.
    #[default]
    Default,
    /// The paper's Algorithm 2, literally.
    Paper,
}

/// Parameters of [`rank`].
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(default)]
pub struct RankParams {
    /// The matcher to use.
    pub matcher: Matcher,
    /// Number of placements per reference that are laid over the scene's image, 1..20. Raising it costs time and
    /// helps with near-symmetric parts.
    pub num_overlaid: usize,
    /// Distance between outlines at which the score has dropped to 1/e, 10..200 mm.
    pub outline_tolerance: Metres,
    /// Maximum number of references that the default matcher compares in full, 256..100 000; those that their summaries
    /// allow the highest scores come first. Raising it costs time where nothing scores high.
    pub num_compared: usize,
    /// Minimum number of references to rank on all cores instead of one, 1..100 000. Lowering it costs time where
    /// starting the threads takes longer than ranking. `partsight-bench scaling` finds the crossover; on two cores, two
    /// workers paid off from 16 references and four from 32; below that, only a tenth of a millisecond is at stake.
    pub parallel_from: usize,
}

impl Default for RankParams {
    fn default() -> Self {
        Self {
            matcher: Matcher::Default,
            num_overlaid: 6,
            outline_tolerance: Metres::from_mm(60.0),
            num_compared: 2048,
            parallel_from: 32,
        }
    }
}

/// The scene's shape from the earlier stages.
#[derive(Clone, Copy, Debug)]
pub struct Query<'a> {
    /// Binary image.
    pub plane: &'a PlaneImage,
    /// Outline and openings.
    pub contour: &'a Contour,
    /// Signature of the outline.
    pub signature: &'a FanSignature,
}

/// Match of one reference.
#[derive(Clone, Debug, PartialEq)]
pub struct MatchEntry {
    /// Index into the given references.
    pub reference: usize,
    /// The part's name.
    pub part: String,
    /// The name under which the reference is enrolled; differs from the part's name where the part has several.
    pub enrolled_as: String,
    /// 0..1; 1 for the same shape.
    pub score: f64,
    /// The matcher's own distance: metres between outlines by default, ‖A - C‖₁ for the paper's.
    pub distance: f64,
    /// Placements, best first; empty for the paper's matcher.
    pub placements: Vec<ImagePlacement>,
}

/// The compared references, best first.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MatchRanking {
    /// One entry per compared reference, in descending order of score.
    pub entries: Vec<MatchEntry>,
}

/// Ranks the references.
pub fn rank(query: &Query<'_>, references: &[Reference], params: &RankParams) -> MatchRanking {
    let num_workers = if references.len() < params.parallel_from {
        1
    } else {
        num_cores()
    };
    rank_by(num_workers, query, references, params)
}

/// Like [`rank`], with the given number of workers, which does not affect the result.
pub fn rank_by(
    num_workers: usize,
    query: &Query<'_>,
    references: &[Reference],
    params: &RankParams,
) -> MatchRanking {
    let mut entries: Vec<MatchEntry> = match params.matcher {
        Matcher::Default => rank_by_overlap(num_workers, query, references, params),
        Matcher::Paper => rank_literally(num_workers, query, references),
    };
    // A stable sort: equal scores keep the library's order.
    entries.sort_by(|a, b| b.score.total_cmp(&a.score));
    if let Some(first) = entries.first_mut() {
        refine_first(&mut first.placements, query, &references[first.reference]);
        first.distance = match (params.matcher, first.placements.first()) {
            (Matcher::Default, Some(placement)) => placement.outline_distance.0,
            _ => first.distance,
        };
    }
    MatchRanking { entries }
}

fn rank_literally(
    num_workers: usize,
    query: &Query<'_>,
    references: &[Reference],
) -> Vec<MatchEntry> {
    let of_query = LiteralSignature::of(&query.contour.outline_pixels);
    let distances = map_each(references.len(), num_workers, |reference| {
        let literal = references[reference].literal();
        let distance = literal.distance(&of_query);
        (distance, distance / literal.norm().max(f64::MIN_POSITIVE))
    });
    let least = distances.iter().map(|d| d.0).fold(f64::INFINITY, f64::min);
    distances
        .into_iter()
        .enumerate()
        .map(|(reference, (distance, relative))| MatchEntry {
            reference,
            part: references[reference].name.clone(),
            enrolled_as: references[reference].enrolled_as.clone(),
            // The paper takes the smallest distance (eq. 11) whatever its size; the score only has to preserve that order.
            score: (1.0 - relative).clamp(0.0, 1.0) * 0.5
                + 0.5 * (least / distance.max(f64::MIN_POSITIVE)).min(1.0),
            distance,
            placements: Vec::new(),
        })
        .collect()
}

fn rank_by_overlap(
    num_workers: usize,
    query: &Query<'_>,
    references: &[Reference],
    params: &RankParams,
) -> Vec<MatchEntry> {
    let entry = |placer: &mut PlacementSearch<'_>, reference: usize| {
        let enrolled = &references[reference];
        let placements = placer.place(enrolled);
        MatchEntry {
            reference,
            part: enrolled.name.clone(),
            enrolled_as: enrolled.enrolled_as.clone(),
            score: placements.first().map_or(0.0, |p| p.score(params)),
            distance: placements
                .first()
                .map_or(f64::INFINITY, |p| p.outline_distance.0),
            placements,
        }
    };
    let prepare = || PlacementSearch::new(query, params);
    if references.len() <= EXHAUSTIVE_UP_TO {
        return map_in_order(references.len(), num_workers, prepare, entry);
    }
    let summary = ShapeSummary::of(query.plane, query.signature);
    let most = map_each(references.len(), num_workers, |reference| {
        most_score(&summary, &references[reference], params)
    });
    let mut order: Vec<usize> = (0..references.len()).collect();
    // The order is total, so it does not depend on the number of workers.
    order.sort_unstable_by(|a, b| most[*b].total_cmp(&most[*a]).then(a.cmp(b)));
    order.truncate(params.num_compared);
    let mut entries: Vec<MatchEntry> = Vec::new();
    for block in order.chunks(EXHAUSTIVE_UP_TO) {
        let num_better = entries.iter().filter(|entry| entry.score > most[block[0]]);
        if num_better.count() >= NUM_CERTAIN {
            break;
        }
        entries.extend(map_in_order(
            block.len(),
            num_workers,
            prepare,
            |placer, i| entry(placer, block[i]),
        ));
    }
    entries.sort_unstable_by_key(|entry| entry.reference);
    entries
}

/// Number of first entries that are those of an exhaustive ranking, but for the sampling of areas, unless
/// [`RankParams::num_compared`] ends the ranking before.
pub const NUM_CERTAIN: usize = 16;
/// Largest number of references that are ranked exhaustively; of more, as many are compared at a time.
pub const EXHAUSTIVE_UP_TO: usize = 256;

/// Finds the placements of one reference over the scene, best first; for a matcher that finds none itself.
pub fn place(query: &Query<'_>, reference: &Reference, params: &RankParams) -> Vec<ImagePlacement> {
    let mut placements = PlacementSearch::new(query, params).place(reference);
    refine_first(&mut placements, query, reference);
    placements
}
