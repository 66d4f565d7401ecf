//! Finds enrolled parts that are hard to tell apart.
//!
//! A part that was cut out of a scene is looked for in it as an inspection does: it is ranked, and the best few are then
//! confirmed. A door and the same door enrolled again under another name score nearly 1, and every inspection of either
//! has almost no margin. The score of a pair is the confirmed one; so two views of one part are found alike even where
//! each shows another piece of it. All rotations in the picture count, including half turns.
//!
//! Where the scene is not known, the part is looked for in its own standard view. What is beside it is then unknown too,
//! and a small part fits well onto any large one: where both are whole, the score is limited to that of the outlines if
//! those differ.
//!
//! A mesh or a scan has no single view that could be confirmed. Its outlines are compared, and as a left part seen from behind
//! has the outline of the right one, parts with the same outlines are laid onto each other: the score is then at most the share
//! of the points that coincide. The outline of a piece says nothing, so pieces are always laid on.
//!
//! The mirror image of the part is tried as well: a right door is not a left one, and an inspection distinguishes the two
//! where it sees enough of them, but no other enrolled part is as similar to it.

use super::{Enrolled, Library};
use geometry::{
    cloud::PointCloud,
    error::Advice,
    parallel::{map_each, num_cores},
    rigid::RigidTransform,
    statistics::sample_evenly,
};
use stages::{
    confirm::{ConfirmParams, Scene, confirm},
    contour::find_contour,
    pose::{PoseMethod, align_to, closest::Correspondence, refine::Search},
    project::project,
    rack::Rack,
    rank::{MatchRanking, Query, RankParams, rank},
    reference::{Coverage, Reference, ReferenceParams, ViewCut},
    scene::SceneCloud,
    segment::SegmentedPart,
    signature::describe,
};

/// Score from which on two parts are indistinguishable. Two captures of one simulated part reach it, no two shipped
/// parts do.
const MIN_INDISTINGUISHABLE_SCORE: f64 = 0.9;

/// Number of enrolled parts examined, those with the most similar outlines; each takes a few milliseconds.
const NUM_EXAMINED: usize = 20;

/// Outline score, openings included, below which outlines count as different. Two captures of a grille have the lowest
/// score of the same part, 0.8; different shipped parts stay below 0.5.
const MIN_OUTLINE_SCORE: f64 = 0.7;

/// Distance of a point from the other surface, beside it and along its normal, at which the surfaces coincide, metres. Two
/// scans of one real part are 1.3 mm apart (root mean square); a left door turned over lies 5 mm off the right one.
const COINCIDE_MAX_SHIFT_M: f64 = 0.012;
const COINCIDE_MAX_HEIGHT_M: f64 = 0.004;

/// Points of a cloud that are compared with the other.
const NUM_COMPARED: usize = 2000;

/// Similarity of one enrolled part to another.
#[derive(Clone, Debug, PartialEq, thiserror::Error, Advice)]
#[error("{name} cannot be told from {other} ({:.0} % alike)", score * 100.0)]
#[advice = "If both are the same part, enrol with --as {other} to store one more reference of it, or with --name {other} to replace it; \
           else remove one of them, `partsight library remove {name}` or `partsight library remove {other}`"]
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

impl Similarity {
    /// Returns whether inspections can tell the two apart.
    pub fn is_distinguishable(&self) -> bool {
        self.is_mirrored || self.score < MIN_INDISTINGUISHABLE_SCORE
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

/// Returns the part of the library that `reference` cannot be told from, without the scene that it may have been cut out of;
/// `None` if there is none. A part of the same name, which it would replace, does not count.
pub fn most_similar(
    reference: &Reference,
    coverage: Coverage,
    library: &Library,
) -> Option<Similarity> {
    let all = compared(reference, library, |others| {
        alone(reference, coverage, others)
    });
    all.into_iter()
        .next()
        .filter(|first| !first.is_distinguishable())
}

/// Returns the similarity of a part to every part of the library: first those that it cannot be told from, then by
/// descending score. A part of the same name, which it would replace, does not count. `scene` is the one that the part was
/// cut out of, if any.
pub fn likenesses(
    enrolled: &Enrolled,
    scene: Option<&SceneCloud>,
    library: &Library,
) -> Vec<Similarity> {
    let reference = &enrolled.reference;
    compared(reference, library, |others| {
        let captured = scene.zip(enrolled.seen.as_ref());
        let in_scene = captured.and_then(|(scene, part)| {
            let mirrored = scene.mirrored();
            let as_it_is = captured_scores(scene, part, others)?;
            let of_mirrored = captured_scores(&mirrored, &part.mirrored(&mirrored), others)?;
            Some([as_it_is, of_mirrored])
        });
        in_scene.unwrap_or_else(|| alone(reference, enrolled.part.meta.coverage, others))
    })
}

/// Sorts the other references by the scores of the part and of its mirror image.
fn compared(
    reference: &Reference,
    library: &Library,
    scores_of: impl FnOnce(&[Reference]) -> [Vec<PairScore>; 2],
) -> Vec<Similarity> {
    let name = reference.name.as_str();
    let others = library.references.iter().filter(|r| r.name != name);
    let others: Vec<Reference> = others.cloned().collect();
    let [scores, of_mirrored] = scores_of(&others);
    let pairs = scores.into_iter().zip(of_mirrored);
    let mut all: Vec<(Similarity, f64)> = others
        .iter()
        .zip(pairs)
        .map(|(other, (found, of_mirrored))| {
            // Prefer to report an indistinguishable part over a similar mirror image.
            let is_mirrored =
                found.score < MIN_INDISTINGUISHABLE_SCORE && of_mirrored.score > found.score;
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
    /// Score with which it would be taken for the other, 0..1.
    score: f64,
    /// Score of the outlines alone, 0..1; it still separates pairs whose scores are both nearly 1.
    outline: f64,
}

/// Rounds a score as it is displayed.
fn per_cent(score: f64) -> u32 {
    (score * 100.0).round() as u32
}

/// Returns the scores of a captured part in its scene, in the order of the others; `None` if it has no outline.
fn captured_scores(
    scene: &SceneCloud,
    part: &SegmentedPart,
    others: &[Reference],
) -> Option<Vec<PairScore>> {
    let params = ReferenceParams::default();
    let plane = &project(part, &params.project).ok()?;
    let contour = &find_contour(plane, &params.contour).ok()?;
    let signature = &describe(contour, &params.signature).ok()?;
    let query = Query {
        plane,
        contour,
        signature,
    };
    let ranking = rank(&query, others, &RankParams::default());
    let rack = Rack::ANYWHERE;
    let scene = Scene {
        scene,
        part,
        query,
        rack,
        expected: &[],
    };
    Some(confirmed(&scene, others, &ranking))
}

/// Returns the scores of a part without its scene, and those of its mirror image.
fn alone(reference: &Reference, coverage: Coverage, others: &[Reference]) -> [Vec<PairScore>; 2] {
    let of_mirrored = mirrored(reference, coverage).map_or_else(
        || vec![PairScore::default(); others.len()],
        |mirrored| scores(&mirrored, coverage, others),
    );
    [scores(reference, coverage, others), of_mirrored]
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
    let cut = ViewCut {
        left: reference.cut.right.map(|tangent| -tangent),
        right: reference.cut.left.map(|tangent| -tangent),
        ..reference.cut
    };
    let mirrored = Reference::prepare("", cloud, coverage, &ReferenceParams::default());
    Some(mirrored.ok()?.with_cut(cut))
}

/// Returns the score with which the reference would be taken for each of the others, in their order.
fn scores(reference: &Reference, coverage: Coverage, others: &[Reference]) -> Vec<PairScore> {
    let Some(view) = reference.views.first() else {
        return vec![PairScore::default(); others.len()];
    };
    let (plane, contour) = (view.plane(), view.contour());
    let query = Query {
        plane: &plane,
        contour: &contour,
        signature: view.signature(),
    };
    let ranking = rank(&query, others, &RankParams::default());
    let is_cut = !reference.cut.is_nothing();
    if coverage != Coverage::OneSide {
        // A camera cannot see all of it at once.
        return laid_on(reference, others, &ranking);
    }
    let scene = Scene {
        scene: &SceneCloud::default(),
        part: &SegmentedPart {
            is_piece: is_cut,
            ..SegmentedPart::whole(&reference.cloud)
        },
        query,
        rack: Rack::ANYWHERE,
        expected: &[],
    };
    let mut scores = confirmed(&scene, others, &ranking);
    for (pair, other) in scores.iter_mut().zip(others) {
        let are_whole = !is_cut && other.cut.is_nothing();
        // Surface overlap works in one direction only: a small part fits well onto any large one.
        if are_whole && pair.outline < MIN_OUTLINE_SCORE {
            pair.score = pair.score.min(pair.outline);
        }
    }
    scores
}

/// Looks for the others in a scene, and returns their scores in their order.
fn confirmed(scene: &Scene<'_>, others: &[Reference], ranking: &MatchRanking) -> Vec<PairScore> {
    let params = ConfirmParams {
        num_references: NUM_EXAMINED,
        ..ConfirmParams::default()
    };
    let mut scores = vec![PairScore::default(); others.len()];
    for entry in &ranking.entries {
        scores[entry.reference].outline = entry.score;
    }
    for entry in confirm(scene, others, ranking, &params, 0.0).0.entries {
        scores[entry.reference].score = entry.score;
    }
    scores
}

/// Returns the scores of the outlines, and of those examined whose clouds are laid onto each other, the share that coincides.
fn laid_on(reference: &Reference, others: &[Reference], ranking: &MatchRanking) -> Vec<PairScore> {
    let entries = ranking.entries.as_slice();
    let found = map_each(entries.len(), num_cores(), |index| {
        let outline = entries[index].score;
        let other = &others[entries[index].reference];
        let is_whole = other.cut.is_nothing();
        // Laying clouds onto each other takes some 0.1 s, so only where it decides.
        let score = if is_whole && outline >= MIN_INDISTINGUISHABLE_SCORE {
            outline.min(coincidence(reference, other))
        } else if !is_whole && index < NUM_EXAMINED {
            coincidence(reference, other)
        } else {
            outline
        };
        PairScore { score, outline }
    });
    let mut scores = vec![PairScore::default(); others.len()];
    for (entry, found) in entries.iter().zip(found) {
        scores[entry.reference] = found;
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
        let surface = point.on_surface(&target, COINCIDE_MAX_SHIFT_M * COINCIDE_MAX_SHIFT_M);
        surface.is_some_and(|surface| surface.off.abs() < COINCIDE_MAX_HEIGHT_M)
    };
    closest.iter().filter(coincides).count() as f64 / points.len().max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::library::{EnrolParams, PartDescription, PartName, enrol_captured, enrol_mesh};
    use simulate::{CellSetup, PartKind, PartModel, PartPose, Side};
    use stages::fixtures::scene_of;

    /// A captured part, and the scene that it was cut out of.
    fn captured(setup: &CellSetup, name: &str) -> (Enrolled, SceneCloud) {
        let scene = scene_of(setup);
        let enrolled = enrol_captured(&scene, &about(name), &EnrolParams::default());
        (enrolled.expect("a part"), scene)
    }

    fn enrolled(kind: PartKind, side: Side, seed: u64) -> (Enrolled, SceneCloud) {
        let setup = CellSetup::with_part(kind, side, 0, seed);
        captured(&setup, &format!("{}_{seed}", kind.name()))
    }

    /// A part of which the picture shows a piece: it hangs this far right of and below its middle, metres.
    fn piece(kind: PartKind, side: Side, [right, down]: [f64; 2]) -> (Enrolled, SceneCloud) {
        let mut setup = CellSetup::with_part(kind, side, 0, 7);
        setup.pose = PartPose::Fixed(RigidTransform::translation(right, down, 1.3));
        let (enrolled, scene) = captured(&setup, &format!("{}_piece", kind.name()));
        assert!(!enrolled.reference.cut.is_nothing());
        (enrolled, scene)
    }

    fn library(enrolled: impl IntoIterator<Item = Enrolled>) -> Library {
        let enrolled = enrolled.into_iter();
        Library {
            references: enrolled.map(|enrolled| enrolled.reference).collect(),
            ..Library::default()
        }
    }

    /// The part that the captured one cannot be told from.
    fn hardest(
        (enrolled, scene): &(Enrolled, SceneCloud),
        library: &Library,
    ) -> Option<Similarity> {
        let mut all = likenesses(enrolled, Some(scene), library).into_iter();
        all.next().filter(|first| !first.is_distinguishable())
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

    fn mesh(name: &str, kind: PartKind, side: Side) -> Enrolled {
        let model = PartModel::new(kind, side, 0);
        let enrolled = enrol_mesh(model.mesh(), &about(name), &EnrolParams::default());
        enrolled.expect("a part")
    }

    #[test]
    fn meshes_of_a_left_and_a_right_door_are_told_apart_and_a_copy_is_not() {
        let door = |name: &str, side| mesh(name, PartKind::FrontDoor, side);
        let library = library([door("left", Side::Left)]);
        let right = door("right", Side::Right);
        let all = likenesses(&right, None, &library);
        assert!(all[0].is_mirrored && all[0].score > 0.9, "{all:?}");
        let copy = door("copy", Side::Left).reference;
        let again = most_similar(&copy, Coverage::AllAround, &library).expect("alike");
        assert!(!again.is_mirrored && again.other == "left", "{again:?}");
    }

    #[test]
    fn a_right_door_is_most_like_the_left_one_in_a_mirror() {
        let library = library([
            enrolled(PartKind::FrontBumper, Side::Left, 1).0,
            enrolled(PartKind::FrontDoor, Side::Left, 2).0,
            enrolled(PartKind::Fender, Side::Left, 3).0,
        ]);
        let door = enrolled(PartKind::FrontDoor, Side::Right, 4);
        // With and without its scene.
        for scene in [Some(&door.1), None] {
            let all = likenesses(&door.0, scene, &library);
            assert_eq!(all.len(), 3);
            let first = &all[0];
            assert!(
                first.other.starts_with("front_door") && first.is_mirrored,
                "{all:?}"
            );
            assert!(first.score > 0.7 && first.is_distinguishable(), "{all:?}");
            assert!(first.in_words().starts_with("its mirror image "));
        }
        let reference = &door.0.reference;
        assert_eq!(most_similar(reference, Coverage::OneSide, &library), None);
        // The same door again is indistinguishable, and comes before any mirror image.
        let twin = enrolled(PartKind::FrontDoor, Side::Left, 5);
        for again in [
            hardest(&twin, &library),
            most_similar(&twin.0.reference, Coverage::OneSide, &library),
        ] {
            let again = again.expect("alike");
            assert!(!again.is_mirrored && again.other.starts_with("front_door"));
        }
        // Of two nearly identical doors, the identical one is the most similar.
        let mut copy = twin.0.reference.clone();
        copy.name = "copy".into();
        let doors = self::library([enrolled(PartKind::FrontDoor, Side::Left, 6).0, twin.0]);
        let nearest = most_similar(&copy, Coverage::OneSide, &doors).expect("alike");
        assert_eq!(nearest.other, "front_door_5");
    }

    #[test]
    fn two_pieces_of_one_part_are_not_told_apart_though_their_outlines_differ() {
        let right = piece(PartKind::Fender, Side::Left, [0.6, 0.0]);
        let (mut below, scene) = piece(PartKind::Fender, Side::Left, [0.0, 0.5]);
        below.reference.name = "below".into();
        let found = hardest(&(below, scene), &library([right.0])).expect("alike");
        assert_eq!(found.other, "fender_piece");
        assert!(found.advice().contains("--as fender_piece"), "{found}");
    }

    #[test]
    fn pieces_of_a_left_door_and_a_right_fender_are_told_apart() {
        let fender = piece(PartKind::Fender, Side::Right, [0.4, 0.3]).0;
        let door = piece(PartKind::FrontDoor, Side::Left, [0.4, 0.3]);
        assert_eq!(hardest(&door, &library([fender])), None);
    }

    #[test]
    fn a_mesh_is_not_told_from_a_captured_piece_of_it() {
        let library = library([
            piece(PartKind::Fender, Side::Left, [0.0, 0.5]).0,
            piece(PartKind::FrontDoor, Side::Left, [0.4, 0.3]).0,
        ]);
        let fender = mesh("fender", PartKind::Fender, Side::Left);
        let all = likenesses(&fender, None, &library);
        assert_eq!(all[0].other, "fender_piece");
        assert!(!all[0].is_distinguishable(), "{all:?}");
        assert!(all[1].is_distinguishable(), "{all:?}");
    }
}
