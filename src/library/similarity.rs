//! Which enrolled part another one is hardest to tell from.
//!
//! The standard view of the part is ranked like a scene, and the best few are then looked for in it: a door and the
//! same door enrolled again under another name score nearly 1, and every inspection of either is a near tie.
//! The score of a pair is the one that an inspection confirms, held down to that of the outlines where those differ.

use super::Library;
use crate::{
    error::Advice,
    stages::{
        confirm::{ConfirmParams, ConfirmedRanking, Scene, confirm},
        rank::{Query, RankParams, rank},
        reference::{Coverage, Reference},
        scene::SceneCloud,
        segment::SegmentedPart,
    },
};

/// Two parts from this score on cannot be told apart. Two captures of one simulated part reach it, no two shipped parts
/// do.
const LEAST_SCORE: f64 = 0.9;

/// Least score of the outlines, openings included; those of a grille's two captures differ most, at 0.8. Those of
/// different shipped parts are below 0.5.
const LEAST_OUTLINE_SCORE: f64 = 0.7;

/// An enrolled part that looks like another one.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{name} cannot be told from {other} ({score:.2})")]
pub struct Similarity {
    /// The name that it is enrolled under, which need not be the part's.
    pub name: String,
    /// The name that the one which it looks like is enrolled under.
    pub other: String,
    /// The score with which it would be taken for that, 0..1.
    pub score: f64,
}

impl Advice for Similarity {
    fn advice(&self) -> String {
        let Self { name, other, .. } = self;
        format!(
            "Remove one of them, `partsight library remove {name}` or `partsight library remove {other}`, or enrol with --name {other} to replace it"
        )
    }
}

impl Similarity {
    /// True if inspections tell the two apart.
    pub fn is_distinguishable(&self) -> bool {
        self.score < LEAST_SCORE
    }
}

/// The part of the library that `reference` cannot be told from; `None` if it can from all. A part of the same name, which
/// it replaces, does not count.
pub fn most_similar(
    reference: &Reference,
    coverage: Coverage,
    library: &Library,
) -> Option<Similarity> {
    let mut all = likenesses(reference, coverage, library).into_iter();
    all.next().filter(|first| !first.is_distinguishable())
}

/// How like every part of the library `reference` is, the one that it is hardest to tell from first. A part of the same
/// name, which it replaces, does not count.
pub fn likenesses(reference: &Reference, coverage: Coverage, library: &Library) -> Vec<Similarity> {
    let name = reference.name.as_str();
    let others = library.references.iter().filter(|r| r.name != name);
    let others: Vec<Reference> = others.cloned().collect();
    let Some(view) = reference.views.first() else {
        return Vec::new();
    };
    let query = Query {
        plane: &view.plane,
        contour: &view.contour,
        signature: &view.signature,
    };
    let ranking = rank(&query, &others, &RankParams::default());
    let outline_score = |other: usize| {
        let mut entries = ranking.entries.iter();
        entries
            .find(|e| e.reference == other)
            .map_or(0.0, |e| e.score)
    };
    let confirmed = match coverage {
        Coverage::OneSide => {
            let scene = Scene {
                scene: &SceneCloud::default(),
                part: &SegmentedPart::whole(&reference.cloud),
                query,
            };
            confirm(&scene, &others, &ranking, &ConfirmParams::default(), 0.0).0
        }
        // Not what a camera sees at once: judged by its outline.
        Coverage::AllAround | Coverage::SeveralSides => ConfirmedRanking::unexamined(&ranking),
    };
    let figure = |other: usize, score: f64| match outline_score(other) {
        // Surfaces alone are blind one way: a small part lies well on any large one.
        outline if outline < LEAST_OUTLINE_SCORE => score.min(outline),
        _ => score,
    };
    let mut all: Vec<Similarity> = confirmed
        .entries
        .iter()
        .map(|entry| Similarity {
            // Only what is enrolled under a name can be removed or replaced.
            name: reference.enrolled_as.clone(),
            other: entry.enrolled_as.clone(),
            score: figure(entry.reference, entry.score),
        })
        .collect();
    all.sort_by(|a, b| b.score.total_cmp(&a.score));
    all
}
