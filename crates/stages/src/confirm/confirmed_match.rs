//! What the confirmation makes of a ranking.

use super::Evidence;
use crate::{
    pose::PoseEstimate,
    rank::{ImagePlacement, MatchEntry, MatchRanking},
};

/// A ranked reference with what its pose says about it.
#[derive(Clone, Debug, PartialEq)]
pub struct ConfirmedMatch {
    /// Index of the reference among those ranked.
    pub reference: usize,
    /// The part's name.
    pub part: String,
    /// The name that the reference is enrolled under; another than the part's where it is one of several.
    pub enrolled_as: String,
    /// The probability that it is there at its pose, 0..1; 0 if it ranked too low to be examined. Of a ranking that was not
    /// confirmed at all, the matcher's, see [`MatchEntry::score`].
    pub score: f64,
    /// The score of the best other pose of the same reference; 0 if none was weighed.
    pub rival: f64,
    /// True if it was looked for in the scene.
    pub is_examined: bool,
    /// The matcher's own distance, see [`MatchEntry::distance`].
    pub distance: f64,
    /// Placements by the matcher, best first; the paper's matcher finds none.
    pub placements: Vec<ImagePlacement>,
    /// Its pose; `None` if it ranked too low to be tried, or has no cloud. The first's is refined to the end, the others'
    /// as far as it took to see that they are not the first.
    pub pose: Option<PoseEstimate>,
    /// What speaks for and against it at that pose; ICP and ICP-GA collect none.
    pub evidence: Option<Evidence>,
}

impl ConfirmedMatch {
    /// A match as the matcher left it.
    pub fn unexamined(entry: &MatchEntry) -> Self {
        let MatchEntry {
            reference,
            part,
            enrolled_as,
            score,
            distance,
            placements,
        } = entry.clone();
        Self {
            reference,
            part,
            enrolled_as,
            score,
            rival: 0.0,
            is_examined: false,
            distance,
            placements,
            pose: None,
            evidence: None,
        }
    }
}

/// The compared references, best first.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ConfirmedRanking {
    /// One entry per compared reference, in descending order of score, but an expected one before those that look like it;
    /// those that were not examined come last.
    pub entries: Vec<ConfirmedMatch>,
}

impl ConfirmedRanking {
    /// The ranking as the matcher left it.
    pub fn unexamined(ranking: &MatchRanking) -> Self {
        let entries = ranking.entries.iter();
        Self {
            entries: entries.map(ConfirmedMatch::unexamined).collect(),
        }
    }

    /// The score of one of its entries; `None` of one that was not examined where others were.
    pub fn score_of(&self, entry: &ConfirmedMatch) -> Option<f64> {
        let is_any_examined = self.entries.iter().any(|entry| entry.is_examined);
        (entry.is_examined || !is_any_examined).then_some(entry.score)
    }

    /// The best entry of each part, best first: a part may be enrolled by several references.
    pub fn by_part(&self) -> impl Iterator<Item = &ConfirmedMatch> {
        let entries = &self.entries;
        entries.iter().enumerate().filter_map(|(i, entry)| {
            let is_first = entries[..i].iter().all(|before| before.part != entry.part);
            is_first.then_some(entry)
        })
    }

    /// The best entry of a part other than the first.
    pub fn runner_up(&self) -> Option<&ConfirmedMatch> {
        self.by_part().nth(1)
    }
}
