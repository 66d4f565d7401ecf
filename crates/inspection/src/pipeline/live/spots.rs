//! Several parts before a camera at the same time: each hangs at a spot of its own, and every frame shows anew what is there.
//!
//! While nothing moves, a part has the same readings in every frame, and what is seen elsewhere is another part. While
//! something moves, a part that has left its place, or whose verdict does not count yet, may be anywhere: it is the nearest
//! one that is left over. Then only an accepted part is taken for a further one: people and halves of parts are not.
//!
//! Known limits: parts that pass without ever hanging still are as many as were seen at the same time. Of a rack that is moved on
//! by one place while no frame shows a gap between its parts, each part is taken for the one that hung there before.

use nalgebra::{Point3, Vector3};

use super::{
    MotionState,
    hung::{HungParts, Presence},
};
use crate::pipeline::{Inspection, Recipe, Unrecognisable, Verdict};
use stages::{
    scene::SceneCloud,
    segment::{SegmentParams, SegmentedPart, segment},
};

/// Share of the readings of two frames, of those that either has, from which they show the same thing. A part that hangs still
/// has more than half even if only one half of it is found; neighbours on a rack share hardly any.
const SAME_MIN_OVERLAP: f64 = 0.2;

/// The spot of each part of a scene, all inspected with [`run_all`](crate::pipeline::run_all), among those `known`, or a further
/// one; `None` for what is no part of its own. Where only one part is looked for, whatever is seen is that part.
pub fn spots_of(
    known: &[&HungParts],
    found: &[&Inspection],
    scene: &SceneCloud,
    stillness: MotionState,
    recipe: &Recipe,
) -> Vec<Option<usize>> {
    let is_one = recipe.max_parts() == 1 && recipe.expected.is_empty();
    if is_one && known.len() <= 1 {
        return vec![Some(0); found.len()];
    }
    let still_since = match stillness {
        MotionState::Steady { since, .. } => Some(since),
        MotionState::Watching | MotionState::Moving => None,
    };
    let presences: Vec<Presence<'_>> = known
        .iter()
        .map(|parts| parts.presence(scene, still_since))
        .collect();
    let mut spots = vec![None; found.len()];
    let mut overlapping = Vec::new();
    let mut passing = Vec::new();
    for (index, inspection) in found.iter().enumerate() {
        let Some(part) = part_of(inspection) else {
            continue;
        };
        let middle = middle_of(part);
        for (spot, presence) in presences.iter().enumerate() {
            let (Presence::Passing(surface) | Presence::Hanging(surface)) = presence else {
                continue;
            };
            let overlap = surface.overlap(part);
            if overlap >= SAME_MIN_OVERLAP {
                overlapping.push((overlap, index, spot));
            }
            if matches!(presence, Presence::Passing(_)) {
                let distance = (surface.middle - middle).norm();
                passing.push((!inspection.verdict.is_accepted(), distance, index, spot));
            }
        }
    }
    overlapping.sort_by(|a, b| b.0.total_cmp(&a.0));
    passing.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let overlapping = overlapping.iter().map(|(_, index, spot)| (*index, *spot));
    let passing = passing.iter().map(|(_, _, index, spot)| (*index, *spot));
    for (index, spot) in overlapping.chain(passing) {
        if spots[index].is_none() && !spots.contains(&Some(spot)) {
            spots[index] = Some(spot);
        }
    }
    let is_empty = |spot: usize| matches!(presences.get(spot), None | Some(Presence::Empty));
    let is_alone = (0..known.len()).all(is_empty);
    for (index, inspection) in found.iter().enumerate() {
        let begins = match part_of(inspection) {
            None => found.len() == 1,
            Some(_) => {
                stillness != MotionState::Moving
                    || inspection.verdict.is_accepted()
                    || (is_alone && index == 0)
            }
        };
        if spots[index].is_none() && begins {
            let mut all = 0..known.len() + found.len();
            spots[index] = all.find(|spot| is_empty(*spot) && !spots.contains(&Some(*spot)));
        }
    }
    spots
}

/// The surface of an inspection that shows a part, enrolled or not.
fn part_of(inspection: &Inspection) -> Option<&SegmentedPart> {
    let part = inspection.segmentation.part.as_ref().ok();
    part.filter(|_| matches!(inspection.verdict, Verdict::Part { .. }))
}

fn middle_of(part: &SegmentedPart) -> Point3<f32> {
    let points = &part.cloud.points;
    let sum: Vector3<f32> = points.iter().map(|point| point.coords).sum();
    Point3::from(sum / points.len().max(1) as f32)
}

/// The inspection of a spot where a frame shows no part.
pub fn nothing_there() -> Inspection {
    let segmentation = segment(&SceneCloud::default(), &SegmentParams::default());
    Inspection::unrecognised(segmentation, Unrecognisable::EmptyLibrary)
}
