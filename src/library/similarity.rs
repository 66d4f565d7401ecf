//! Finds enrolled parts that are hard to tell apart.
//!
//! The standard view of the part is ranked like a scene, and the best few are then confirmed in it: a door and the same
//! door enrolled again under another name score nearly 1, and every inspection of either has almost no margin. The
//! score of a pair is the confirmed one, limited to that of the outlines where those differ. All rotations in the
//! picture count, including half turns.
//!
//! The mirror image of the part is tried as well: a right door is not a left one, and an inspection distinguishes the two
//! where it sees enough of them, but no other enrolled part is as similar to it.
//!
//! Limit: views that show only half of the part are not tried.

use super::Library;
use crate::{
    error::Advice,
    geometry::cloud::PointCloud,
    stages::{
        confirm::{ConfirmParams, ConfirmedRanking, Scene, confirm},
        rank::{Query, RankParams, rank},
        reference::{Coverage, Reference, ReferenceParams},
        scene::SceneCloud,
        segment::SegmentedPart,
    },
};

/// Score from which on two parts are indistinguishable. Two captures of one simulated part reach it, no two shipped
/// parts do.
const LEAST_SCORE: f64 = 0.9;

/// Number of enrolled parts examined, those with the most similar outlines; each takes about 1.5 ms.
const NUM_EXAMINED: usize = 20;

/// Outline score, openings included, below which outlines count as different. Two captures of a grille have the lowest
/// score of the same part, 0.8; different shipped parts stay below 0.5.
const LEAST_OUTLINE_SCORE: f64 = 0.7;

/// Similarity of one enrolled part to another.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{name} cannot be told from {other} ({:.0} % alike)", score * 100.0)]
pub struct Similarity {
    /// Name of the reference's entry, which may differ from the part's name.
    pub name: String,
    /// Name of the other reference's entry.
    pub other: String,
    /// Score with which it would be taken for the other, 0..1.
    pub score: f64,
    /// True if its mirror image is more similar to the other than the part itself.
    pub is_mirrored: bool,
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
    /// Returns whether inspections can tell the two apart.
    pub fn is_distinguishable(&self) -> bool {
        self.is_mirrored || self.score < LEAST_SCORE
    }

    /// Describes the similarity for people.
    pub fn in_words(&self) -> String {
        let mirrored = if self.is_mirrored {
            "its mirror image "
        } else {
            ""
        };
        format!("{mirrored}{:.0} % alike", self.score * 100.0)
    }
}

/// Returns the part of the library that `reference` cannot be told from; `None` if there is none. A part of the same
/// name, which it would replace, does not count.
pub fn most_similar(
    reference: &Reference,
    coverage: Coverage,
    library: &Library,
) -> Option<Similarity> {
    let mut all = likenesses(reference, coverage, library).into_iter();
    all.next().filter(|first| !first.is_distinguishable())
}

/// Returns the similarity of `reference` to every part of the library: first those that it cannot be told from, then by
/// descending score. A part of the same name, which it would replace, does not count.
pub fn likenesses(reference: &Reference, coverage: Coverage, library: &Library) -> Vec<Similarity> {
    let name = reference.name.as_str();
    let others = library.references.iter().filter(|r| r.name != name);
    let others: Vec<Reference> = others.cloned().collect();
    let scores = scores(reference, coverage, &others);
    let mirrored = mirrored(reference, coverage);
    let of_mirrored = mirrored.map_or_else(
        || vec![PairScore::default(); others.len()],
        |mirrored| self::scores(&mirrored, coverage, &others),
    );
    let pairs = scores.into_iter().zip(of_mirrored);
    let mut all: Vec<(Similarity, f64)> = others
        .iter()
        .zip(pairs)
        .map(|(other, (found, of_mirrored))| {
            // Prefer to report an indistinguishable part over a similar mirror image.
            let is_mirrored = found.score < LEAST_SCORE && of_mirrored.score > found.score;
            let PairScore { score, outline } = if is_mirrored { of_mirrored } else { found };
            let likeness = Similarity {
                // The name of the entry, since that is what can be removed or replaced.
                name: reference.enrolled_as.clone(),
                other: other.enrolled_as.clone(),
                score,
                is_mirrored,
            };
            (likeness, outline)
        })
        .collect();
    all.sort_by(|(a, outline_a), (b, outline_b)| {
        let doubtful_first = a.is_distinguishable().cmp(&b.is_distinguishable());
        doubtful_first
            .then(per_cent(b.score).cmp(&per_cent(a.score)))
            .then(outline_b.total_cmp(outline_a))
    });
    all.into_iter().map(|(likeness, _)| likeness).collect()
}

/// Scores of a pair of parts.
#[derive(Clone, Copy, Debug, Default)]
struct PairScore {
    /// Score that an inspection confirms, limited to that of the outlines where those differ, 0..1.
    score: f64,
    /// Score of the outlines alone, 0..1; it still separates pairs whose scores are both nearly 1.
    outline: f64,
}

/// Rounds a score as it is displayed.
fn per_cent(score: f64) -> u32 {
    (score * 100.0).round() as u32
}

/// Mirrors a reference; `None` if the result has no outline.
fn mirrored(reference: &Reference, coverage: Coverage) -> Option<Reference> {
    let mut cloud = PointCloud {
        points: reference.cloud.points.clone(),
        normals: reference.cloud.normals.clone(),
        ..PointCloud::default()
    };
    for point in &mut cloud.points {
        point.x = -point.x;
    }
    for normal in cloud.normals.iter_mut().flatten() {
        normal.x = -normal.x;
    }
    Reference::prepare("", cloud, coverage, &ReferenceParams::default()).ok()
}

/// Returns the score with which the reference would be taken for each of the others, in their order.
fn scores(reference: &Reference, coverage: Coverage, others: &[Reference]) -> Vec<PairScore> {
    let mut scores = vec![PairScore::default(); others.len()];
    let Some(view) = reference.views.first() else {
        return scores;
    };
    let query = Query {
        plane: &view.plane,
        contour: &view.contour,
        signature: &view.signature,
    };
    let ranking = rank(&query, others, &RankParams::default());
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
            let params = ConfirmParams {
                num_references: NUM_EXAMINED,
                ..ConfirmParams::default()
            };
            confirm(&scene, others, &ranking, &params, 0.0).0
        }
        // A camera cannot see all of it at once, so only its outline is compared.
        Coverage::AllAround | Coverage::SeveralSides => ConfirmedRanking::unexamined(&ranking),
    };
    for entry in &confirmed.entries {
        let outline = outline_score(entry.reference);
        // Surface overlap works in one direction only: a small part fits well onto any large one.
        let score = if outline < LEAST_OUTLINE_SCORE {
            entry.score.min(outline)
        } else {
            entry.score
        };
        scores[entry.reference] = PairScore { score, outline };
    }
    scores
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        library::{EnrolParams, PartDescription, PartName, enrol_captured},
        simulate::{CellSetup, PartKind, Side, frame},
        stages::scene::scene_from_frame,
    };

    fn enrolled(kind: PartKind, side: Side, seed: u64) -> Reference {
        let setup = CellSetup::with_part(kind, side, 0, seed);
        let scene = scene_from_frame(&frame(&setup).frame);
        let name = format!("{}_{seed}", kind.name());
        let about = PartDescription {
            name: PartName::new(&name).expect("a name"),
            title: String::new(),
            notes: String::new(),
            from: "a test".into(),
            at: jiff::Timestamp::UNIX_EPOCH,
            simulated: true,
        };
        let enrolled = enrol_captured(&scene, &about, &EnrolParams::default());
        enrolled.expect("a part").reference
    }

    #[test]
    fn a_right_door_is_most_like_the_left_one_in_a_mirror() {
        let library = Library {
            references: vec![
                enrolled(PartKind::FrontBumper, Side::Left, 1),
                enrolled(PartKind::FrontDoor, Side::Left, 2),
                enrolled(PartKind::Fender, Side::Left, 3),
            ],
        };
        let door = enrolled(PartKind::FrontDoor, Side::Right, 4);
        let all = likenesses(&door, Coverage::OneSide, &library);
        assert_eq!(all.len(), 3);
        let first = &all[0];
        assert!(
            first.other.starts_with("front_door") && first.is_mirrored,
            "{all:?}"
        );
        assert!(first.score > 0.7 && first.is_distinguishable(), "{all:?}");
        assert!(first.in_words().starts_with("its mirror image "));
        assert_eq!(most_similar(&door, Coverage::OneSide, &library), None);
        // The same door again is indistinguishable, and comes before any mirror image.
        let twin = enrolled(PartKind::FrontDoor, Side::Left, 5);
        let again = most_similar(&twin, Coverage::OneSide, &library).expect("alike");
        assert!(!again.is_mirrored && again.other.starts_with("front_door"));
        // Of two nearly identical doors, the identical one is the most similar.
        let doors = Library {
            references: vec![enrolled(PartKind::FrontDoor, Side::Left, 6), twin.clone()],
        };
        let mut copy = twin;
        copy.name = "copy".into();
        let nearest = most_similar(&copy, Coverage::OneSide, &doors).expect("alike");
        assert_eq!(nearest.other, "front_door_5");
    }
}
