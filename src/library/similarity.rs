//! Finds enrolled parts that are hard to tell apart.
//!
//! The standard view of the part is ranked like a scene, and the best few are then confirmed in it: a door and the same
//! door enrolled again under another name score nearly 1, and every inspection of either has almost no margin. The
//! score of a pair is the confirmed one, limited to that of the outlines where those differ. All rotations in the
//! picture count, including half turns.
//!
//! A mesh or a scan has no single view that could be confirmed. Its outlines are compared, and as a left part seen from behind
//! has the outline of the right one, parts with the same outlines are laid onto each other: the score is then at most the share
//! of the points that coincide.
//!
//! The mirror image of the part is tried as well: a right door is not a left one, and an inspection distinguishes the two
//! where it sees enough of them, but no other enrolled part is as similar to it.
//!
//! Limit: views that show only half of the part are not tried.

use super::Library;
use crate::{
    error::Advice,
    geometry::{cloud::PointCloud, rigid::RigidTransform, statistics::sample_evenly},
    stages::{
        confirm::{ConfirmParams, ConfirmedRanking, Scene, confirm},
        pose::{PoseMethod, align_to, closest::Correspondence, refine::Search},
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

/// Distance of a point from the other surface, beside it and along its normal, at which the surfaces coincide, metres. Two
/// scans of one real part are 1.3 mm apart (root mean square); a left door turned over lies 5 mm off the right one.
const SAME_PLACE: f64 = 0.012;
const SAME_SURFACE: f64 = 0.004;

/// Points of a cloud that are compared with the other.
const NUM_COMPARED: usize = 2000;

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
        // A camera cannot see all of it at once.
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
        // Laying clouds onto each other takes some 0.1 s, so only where it decides.
        let score = if coverage != Coverage::OneSide && score >= LEAST_SCORE {
            score.min(coincidence(reference, &others[entry.reference]))
        } else {
            score
        };
        scores[entry.reference] = PairScore { score, outline };
    }
    scores
}

/// Lays one cloud onto the other, and returns the share of its points that coincide with the other, 0..1; of the two shares the
/// larger, because a scan may show more of a part than another one. 0 if no pose is found.
fn coincidence(one: &Reference, other: &Reference) -> f64 {
    let laid = other.whole().and_then(|target| {
        let params = PoseMethod::Global.into();
        align_to(&one.cloud, target, &params, None, &|| false)
    });
    laid.map_or(0.0, |laid| {
        let pose = &laid.target_from_source;
        share_on(one, pose, other).max(share_on(other, &pose.inverse(), one))
    })
}

/// Returns the share of a cloud's points that coincide with the other's surface at this pose, 0..1.
fn share_on(from: &Reference, onto_from: &RigidTransform, onto: &Reference) -> f64 {
    let Some(target) = onto.target(0) else {
        return 0.0;
    };
    let points = sample_evenly(&from.cloud.points, NUM_COMPARED).copied();
    let points: Vec<_> = points.collect();
    let closest = Correspondence::of_each(&points, &target, onto_from, Search::Tree);
    let coincides = |point: &&Correspondence| {
        let surface = point.on_surface(&target, SAME_PLACE * SAME_PLACE);
        surface.is_some_and(|surface| surface.off.abs() < SAME_SURFACE)
    };
    closest.iter().filter(coincides).count() as f64 / points.len().max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        library::{EnrolParams, PartDescription, PartName, enrol_captured, enrol_mesh},
        simulate::{CellSetup, PartKind, PartModel, Side, frame},
        stages::scene::scene_from_frame,
    };

    fn enrolled(kind: PartKind, side: Side, seed: u64) -> Reference {
        let setup = CellSetup::with_part(kind, side, 0, seed);
        let scene = scene_from_frame(&frame(&setup).frame);
        let about = about(&format!("{}_{seed}", kind.name()));
        let enrolled = enrol_captured(&scene, &about, &EnrolParams::default());
        enrolled.expect("a part").reference
    }

    fn about(name: &str) -> PartDescription {
        PartDescription {
            name: PartName::new(name).expect("a name"),
            title: String::new(),
            notes: String::new(),
            from: "a test".into(),
            at: jiff::Timestamp::UNIX_EPOCH,
            simulated: true,
        }
    }

    #[test]
    fn meshes_of_a_left_and_a_right_door_are_told_apart_and_a_copy_is_not() {
        let door = |name: &str, side| {
            let model = PartModel::new(PartKind::FrontDoor, side, 0);
            let enrolled = enrol_mesh(model.mesh(), &about(name), &EnrolParams::default());
            enrolled.expect("a part").reference
        };
        let library = Library {
            references: vec![door("left", Side::Left)],
        };
        let right = door("right", Side::Right);
        assert_eq!(most_similar(&right, Coverage::AllAround, &library), None);
        let all = likenesses(&right, Coverage::AllAround, &library);
        assert!(all[0].is_mirrored && all[0].score > 0.9, "{all:?}");
        let copy = door("copy", Side::Left);
        let again = most_similar(&copy, Coverage::AllAround, &library).expect("alike");
        assert!(!again.is_mirrored && again.other == "left", "{again:?}");
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
