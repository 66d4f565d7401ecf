//! Parts that fit only as their mirror image: a part of the other side of the car, or an image with left and right
//! exchanged.
//!
//! One capture tells the two apart only if the part has no other side: because a car has it once, according to its
//! name, or because it is nearly its own mirror image. An image of a symmetric part looks right either way: if only its
//! mirror image is found, the search for the part itself failed, and is repeated.
//! Several captures tell more, see [`MirrorTally`].

use std::collections::BTreeSet;

use nalgebra::{Point3, Vector3};

use super::{
    Inspection, Recipe,
    hypothesis::{MIN_REPLACING_SCORE, try_surface},
    rejection::Rejection,
    surface::{InspectionInputs, SurfaceResult, inspect_surface},
    verdict::{Verdict, model_deviation, verdict},
    watch::Cancelled,
};
use geometry::{
    error::Advice, principal::principal_axes, rigid::RigidTransform, statistics::sample_evenly,
    units::Metres,
};
use stages::{
    confirm::ConfirmedMatch,
    pose::{
        closest::Correspondence,
        quality::{Tolerance, measure_fit},
        refine::{AlignmentSource, Level, Search, refine},
    },
    rack::Rack,
    reference::Reference,
    segment::SegmentedPart,
};
use texts::{Language, Message};

/// Least lead of a mirror image's score over that of the part itself.
const MIN_MIRROR_LEAD: f64 = 0.3;
/// Where the part itself fits nearly as well, its mirror image must deviate less by this factor.
const MIN_DEVIATION_RATIO: f64 = 2.0;

/// Rejects the best guess as mirrored if the mirror image of an enrolled part fits and the part itself does not. That part
/// becomes the first of the ranking.
pub(super) fn check_mirror_image(
    inspection: &mut Inspection,
    inputs: &InspectionInputs<'_>,
) -> Result<(), Cancelled> {
    let Ok(part) = &inspection.segmentation.part else {
        return Ok(());
    };
    let is_other_model = matches!(
        inspection.verdict,
        Verdict::Part {
            rejected: Some(Rejection::AnotherModel { .. }),
            ..
        }
    );
    if !is_other_model && inspection.best_score() + MIN_MIRROR_LEAD >= 1.0 {
        // No score can lead by that much.
        return Ok(());
    }
    let scene = &inputs.scene.mirrored();
    let recipe = inputs.recipe;
    let least = if is_other_model {
        recipe.accept.min_score
    } else {
        recipe
            .accept
            .unknown_below
            .max(inspection.best_score() + MIN_MIRROR_LEAD)
    };
    let mirrored = InspectionInputs {
        scene,
        rack: Rack::ANYWHERE,
        ..*inputs
    };
    let found = inspect_surface(&part.mirrored(scene), &mirrored, least)?;
    if !is_other_model && fits_either_way(&found, inputs, least) {
        let part = part.clone();
        return search_again(inspection, &part, inputs);
    }
    let seen = if is_other_model {
        closer_mirror_match(inspection, &found, recipe)
    } else {
        mirror_only_match(&found, inputs, least)
    };
    if let (Some(seen), Some(named)) = (seen, found.ranking.entries.first()) {
        put_first(inspection, named, recipe);
        if let Verdict::Part { rejected, .. } = &mut inspection.verdict {
            *rejected = Some(seen);
        }
    }
    Ok(())
}

/// True if the mirror image of a part was found that looks the same in a mirror.
fn fits_either_way(found: &SurfaceResult, inputs: &InspectionInputs<'_>, least: f64) -> bool {
    let best = found.ranking.entries.first();
    let best = best.filter(|best| best.score > least);
    let reference = best.and_then(|best| inputs.library.references.get(best.reference));
    reference.is_some_and(is_own_mirror_image)
}

/// Further draws of a part's points. In 5 of 37 views of a symmetric lid the first draw lost it, and most others found it.
const NUM_DRAWS: usize = 3;

/// Searches for the part itself with other draws of its points, and keeps the best result.
fn search_again(
    inspection: &mut Inspection,
    part: &SegmentedPart,
    inputs: &InspectionInputs<'_>,
) -> Result<(), Cancelled> {
    let mut recipe = inputs.recipe.clone();
    for _ in 0..NUM_DRAWS {
        recipe.confirm.seed += 1;
        let again = InspectionInputs {
            recipe: &recipe,
            ..*inputs
        };
        try_surface(inspection, part.clone(), MIN_REPLACING_SCORE, &again)?;
        if inspection.verdict.is_accepted() {
            break;
        }
    }
    Ok(())
}

/// Share of a part's points that lie on its mirror image if it is its own. The symmetric shipped parts reach 0.989, the back
/// bumper with its one exhaust 0.978, the others 0.83. A part that differs by less loses less than [`MIN_MIRROR_LEAD`] of
/// its score when it is held against its mirror image.
const MIN_SYMMETRIC_SHARE: f64 = 0.985;
/// Points of the part that are compared.
const NUM_COMPARED: usize = 1000;
/// Distance at which a point still lies on the mirror image.
const MIRROR_MAX_DISTANCE: Metres = Metres(0.01);
/// The principal plane of a part that was captured at an angle is off by some centimetres.
const ALIGNMENT_LEVELS: [Level; 2] = [
    Level {
        num_surface: NUM_COMPARED,
        num_edges: 0,
        scale: 0.03,
        max_steps: 8,
        settled: 0.005,
        search: Search::Field,
    },
    Level {
        num_surface: NUM_COMPARED,
        num_edges: 0,
        scale: 0.01,
        max_steps: 12,
        settled: 0.005,
        search: Search::Tree,
    },
];

/// True if the reference looks the same in a mirror. The plane of symmetry is perpendicular to a principal axis, so the
/// cloud is mirrored in each of the three planes and laid onto itself.
fn is_own_mirror_image(reference: &Reference) -> bool {
    let Some(target) = reference.whole_target(0) else {
        return false;
    };
    let points = sample_evenly(&reference.cloud.points, NUM_COMPARED);
    let Some(axes) = principal_axes(points.clone().map(|p| (p.cast::<f64>(), 1.0))) else {
        return false;
    };
    (0..3).any(|axis| {
        let across: Vector3<f64> = axes.axes.column(axis).into_owned();
        let mirrored = |p: &Point3<f32>| {
            let p = p.cast::<f64>();
            (p - across * (2.0 * across.dot(&(p - axes.mean)))).cast::<f32>()
        };
        let source = AlignmentSource {
            surface: points.clone().map(mirrored).collect(),
            edges: Vec::new(),
        };
        let refined = refine(
            &source,
            &target,
            &RigidTransform::identity(),
            &ALIGNMENT_LEVELS,
        );
        let pose = &refined.target_from_source;
        let closest = Correspondence::of_each(&source.surface, &target, pose, Search::Tree);
        let tolerance = Tolerance {
            base: MIRROR_MAX_DISTANCE,
            noise_at_1m: Metres(0.0),
        };
        measure_fit(&source.surface, &closest, &target, tolerance).overlap >= MIN_SYMMETRIC_SHARE
    })
}

/// Moves a part to the front of the ranking, so that name, score, pose and pictures are of the same part. There is no pose
/// if it ranked too low to be aligned, or was not compared at all.
fn put_first(inspection: &mut Inspection, named: &ConfirmedMatch, recipe: &Recipe) {
    let entries = &mut inspection.ranking.entries;
    let mut sorted = entries.iter();
    let index = sorted.position(|entry| entry.part == named.part);
    if index.is_none() {
        entries.push(ConfirmedMatch {
            score: 0.0,
            rival: 0.0,
            is_examined: false,
            placements: Vec::new(),
            pose: None,
            evidence: None,
            ..named.clone()
        });
    }
    let index = index.unwrap_or(entries.len() - 1);
    if index > 0 {
        entries[..=index].rotate_right(1);
        inspection.pose = entries[0].pose.clone().map(Ok);
        inspection.verdict = verdict(&inspection.ranking, inspection.pose.as_ref(), recipe);
    }
}

/// The rejection where the mirror image fits and the part itself is nothing like it.
fn mirror_only_match(
    found: &SurfaceResult,
    inputs: &InspectionInputs<'_>,
    least: f64,
) -> Option<Rejection> {
    let seen = found.ranking.entries.first()?;
    let (part, score) = (seen.part.clone(), seen.score);
    let reference = inputs.library.references.get(seen.reference)?;
    (score > least).then(|| {
        if is_central(&part) && !reference.cut.is_nothing() {
            Rejection::OtherHalf { part, score }
        } else if is_central(&part) {
            Rejection::MirroredImage { part, score }
        } else {
            Rejection::Mirrored { part, score }
        }
    })
}

/// The rejection where the mirror image of a nearly symmetric part fits better; such a part has no other side.
fn closer_mirror_match(
    inspection: &Inspection,
    found: &SurfaceResult,
    recipe: &Recipe,
) -> Option<Rejection> {
    let (straight, mirrored) = (
        inspection.ranking.entries.first()?,
        found.ranking.entries.first()?,
    );
    let is_accepted = found.verdict.as_ref().is_some_and(Verdict::is_accepted);
    let unlike = |evidence| model_deviation(evidence, &recipe.accept);
    let is_closer = MIN_DEVIATION_RATIO * unlike(mirrored.evidence.as_ref()?)
        < unlike(straight.evidence.as_ref()?);
    (is_accepted && is_closer && mirrored.part == straight.part).then(|| Rejection::MirroredImage {
        part: mirrored.part.clone(),
        score: mirrored.score,
    })
}

/// Words for parts that a car has once.
const CENTRAL: [&str; 13] = [
    "bumper",
    "trunk",
    "tailgate",
    "hatch",
    "hood",
    "bonnet",
    "grille",
    "grill",
    "radiator",
    "roof",
    "windshield",
    "windscreen",
    "spoiler",
];
/// Words for a side, or for a piece of one.
const SIDES: [&str; 9] = [
    "left", "right", "l", "r", "lh", "rh", "side", "corner", "driver",
];

/// True if by its name a car has the part once, in its middle.
fn is_central(part: &str) -> bool {
    let mut words = part.split(|c: char| !c.is_ascii_alphabetic());
    words.clone().any(|word| CENTRAL.contains(&word)) && !words.any(|word| SIDES.contains(&word))
}

/// Counts mirrored verdicts over the captures of one call or one source.
///
/// A single part of the other side is common, and so are many captures of it. If parts of several names all fit only
/// as mirror images and none fits as it is, the images are more likely mirrored.
#[derive(Clone, Debug, Default)]
pub struct MirrorTally {
    num_mirrored: usize,
    parts: BTreeSet<String>,
    is_any_straight: bool,
}

/// Everything that was recognised fits only as its mirror image.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error, Advice)]
#[error(
    "everything that was recognised ({num_captures} captures: {}) fits only as its mirror image: left and right may \
     be swapped in the images",
    parts.join(", ")
)]
#[advice(
    "If these are the enrolled parts and not those of the other side: {}",
    Message::new("put-right").text(Language::English)
)]
pub struct OnlyMirrored {
    /// Captures that show mirror images.
    pub num_captures: usize,
    /// The parts whose mirror images they show.
    pub parts: Vec<String>,
}

impl MirrorTally {
    /// Counts a verdict.
    pub fn add(&mut self, verdict: &Verdict) {
        match verdict {
            Verdict::Part {
                rejected:
                    Some(Rejection::Mirrored { part, .. } | Rejection::MirroredImage { part, .. }),
                ..
            } => {
                self.num_mirrored += 1;
                self.parts.insert(part.clone());
            }
            Verdict::Part { .. } => self.is_any_straight |= !verdict.is_unknown(),
            Verdict::NoPart(_) => {}
        }
    }

    /// Returns the suspicion that the images are mirrored, if there is one.
    pub fn suspicion(&self) -> Option<OnlyMirrored> {
        (self.parts.len() >= 2 && !self.is_any_straight).then(|| OnlyMirrored {
            num_captures: self.num_mirrored,
            parts: self.parts.iter().cloned().collect(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        fixtures::standard_library,
        pipeline::{Unwatched, run, watch::StageClock},
    };
    use simulate::{CellSetup, PartKind, Side};
    use stages::fixtures::scene_of;

    #[test]
    fn pose_and_score_of_a_mirror_image_are_those_of_the_part_that_it_is_called_the_image_of() {
        let recipe = Recipe::default();
        let library = standard_library();
        let setup = CellSetup::with_part(PartKind::FrontDoor, Side::Right, 0, 41);
        let scene = scene_of(&setup);
        let seen = run(&scene, &library, &recipe, &Unwatched).expect("not cancelled");
        assert!(seen.verdict.is_mirrored(), "{:?}", seen.verdict);
        for (is_aligned, is_compared) in [(true, true), (false, true), (false, false)] {
            // Another part is the nearest, and the door is the last, aligned or not, or was not compared.
            let mut inspection = seen.clone();
            let entries = &mut inspection.ranking.entries;
            let door = &mut entries[0];
            assert_eq!(door.part, "front_door");
            if !is_aligned {
                (door.is_examined, door.pose, door.evidence) = (false, None, None);
                door.score = 0.0;
            }
            let door = door.clone();
            entries.rotate_left(1);
            if !is_compared {
                entries.pop();
            }
            inspection.pose = entries[0].pose.clone().map(Ok);
            inspection.verdict = verdict(&inspection.ranking, inspection.pose.as_ref(), &recipe);
            assert_ne!(inspection.verdict.guess(), Some("front_door"));

            let inputs = InspectionInputs {
                scene: &scene,
                library: &library,
                recipe: &recipe,
                clock: &StageClock::start(&Unwatched),
                rack: Rack::ANYWHERE,
            };
            check_mirror_image(&mut inspection, &inputs).expect("not cancelled");
            assert!(inspection.verdict.is_mirrored());
            assert_eq!(inspection.verdict.guess(), Some("front_door"));
            assert_eq!(inspection.reference(), Some("front_door"));
            let pose = inspection.found_pose();
            assert_eq!(pose, door.pose.as_ref());
            let [score, margin] = inspection.verdict.score().expect("a part");
            assert!((score - door.score).abs() < 1e-12 && margin >= 0.0);
            let score = inspection.ranking.score_of(&door);
            assert_eq!(score.is_some(), door.is_examined);
        }
    }

    #[test]
    fn a_symmetric_part_whose_own_search_failed_is_searched_again_and_no_image_is_called_mirrored()
    {
        let recipe = Recipe::default();
        let library = standard_library();
        let scene = scene_of(&CellSetup::with_part(PartKind::TrunkLid, Side::Left, 0, 41));
        let seen = run(&scene, &library, &recipe, &Unwatched).expect("not cancelled");
        assert!(seen.verdict.is_accepted(), "{:?}", seen.verdict);
        // As if the search had missed it.
        let mut missed = seen;
        for entry in &mut missed.ranking.entries {
            (entry.score, entry.evidence) = (0.0, None);
        }
        missed.verdict = verdict(&missed.ranking, missed.pose.as_ref(), &recipe);
        assert!(!missed.verdict.is_accepted(), "{:?}", missed.verdict);
        let inputs = InspectionInputs {
            scene: &scene,
            library: &library,
            recipe: &recipe,
            clock: &StageClock::start(&Unwatched),
            rack: Rack::ANYWHERE,
        };
        check_mirror_image(&mut missed, &inputs).expect("not cancelled");
        assert!(!missed.verdict.is_mirrored(), "{:?}", missed.verdict);
        assert!(missed.verdict.is_accepted(), "{:?}", missed.verdict);
        assert_eq!(missed.verdict.guess(), Some("trunk_lid"));
    }

    #[test]
    fn parts_that_look_the_same_in_a_mirror_are_told_from_those_that_nearly_do() {
        let library = standard_library();
        for reference in &library.references {
            let expected = match reference.name.as_str() {
                "trunk_lid" | "front_bumper" | "radiator_support" | "grille" => true,
                "back_bumper" | "front_door" | "back_door" | "fender" => false,
                other => panic!("{other}"),
            };
            assert_eq!(
                is_own_mirror_image(reference),
                expected,
                "{}",
                reference.name
            );
        }
    }

    #[test]
    fn names_tell_which_parts_a_car_has_once() {
        for kind in PartKind::ALL {
            assert_eq!(is_central(kind.name()), !kind.is_sided(), "{kind}");
        }
        assert!(is_central("golf-7-hood") && is_central("rear_bumper2"));
        assert!(!is_central("bumper_corner") && !is_central("grille_left") && !is_central("cover"));
    }

    #[test]
    fn several_parts_that_fit_only_in_a_mirror_raise_the_suspicion_and_one_that_fits_ends_it() {
        let verdict = |rejected| Verdict::Part {
            part: "fender".into(),
            score: 0.0,
            margin: 0.0,
            rejected,
            is_approximate: false,
        };
        let mirrored = |part: &str| {
            verdict(Some(Rejection::Mirrored {
                part: part.into(),
                score: 1.0,
            }))
        };
        assert_eq!(mirrored("front_door").guess(), Some("front_door"));
        let mut tally = MirrorTally::default();
        for _ in 0..5 {
            tally.add(&mirrored("fender"));
        }
        assert_eq!(tally.suspicion(), None, "a series of one right-hand part");
        tally.add(&verdict(Some(Rejection::Unknown {
            nearest: "fender".into(),
            score: 0.0,
        })));
        tally.add(&mirrored("front_door"));
        let suspicion = tally.suspicion().expect("two parts");
        assert_eq!(suspicion.num_captures, 6);
        assert_eq!(suspicion.parts, ["fender", "front_door"]);
        tally.add(&verdict(None));
        assert_eq!(tally.suspicion(), None);
    }
}
