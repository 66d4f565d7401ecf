//! Whether two frames of one part agree, so that a single inspection may be relied upon.
//!
//! A part that swings is recognised, and its pose is right, in every frame; but it will not be there any more when a
//! robot comes. Two frames show this: their poses lie further apart than both may be off together.

use nalgebra::Point3;

use super::{ConsensusParams, PoseTolerance};
use crate::pipeline::{Inspection, Rejection, Verdict};
use geometry::{
    rigid::{RigidTransform, pose_error},
    units::{Metres, Radians},
};
use stages::pose::{PoseEstimate, Uncertainty};

/// Refuses an accepted part because it moves.
pub fn refuse_moving(inspection: &mut Inspection) {
    reject(inspection, |part| Some(Rejection::NotSteady { part }));
}

/// Refuses an accepted part unless `again`, the inspections of the parts of a later frame, at least one, accept it in the same
/// place. `middle` is the middle of the part, part space, metres.
pub fn refuse_unless_again(
    inspection: &mut Inspection,
    again: &[Inspection],
    middle: Option<Point3<f64>>,
) {
    let middle = middle.unwrap_or_else(Point3::origin);
    let Some(again) = same_part(inspection, again, middle).or(again.first()) else {
        return;
    };
    let is_near = is_near(inspection, again, middle);
    reject(inspection, |part| match &again.verdict {
        Verdict::Part {
            part: other,
            rejected,
            ..
        } if *other == part => match (rejected, is_near) {
            (Some(why), _) => Some(why.clone()),
            (None, Some(true)) => None,
            (None, Some(false)) => Some(Rejection::NotSteady { part }),
            (None, None) => Some(disagreement(part)),
        },
        Verdict::Part { rejected: None, .. } => Some(disagreement(part)),
        // It has left, or something is in front of it.
        _ => Some(Rejection::NotSteady { part }),
    });
}

/// The inspection of the same part, of equal ones that of the nearest.
fn same_part<'a>(
    inspection: &Inspection,
    again: &'a [Inspection],
    middle: Point3<f64>,
) -> Option<&'a Inspection> {
    let position = |of: &Inspection| {
        let pose = of.found_pose()?.camera_from_part();
        Some((pose * middle).coords)
    };
    let distance = |other: &Inspection| {
        let apart = position(inspection)
            .zip(position(other))
            .map(|(a, b)| (a - b).norm());
        apart.unwrap_or(f64::INFINITY)
    };
    let name = inspection.verdict.guess();
    let same = again.iter().filter(|other| other.verdict.guess() == name);
    same.min_by(|a, b| distance(a).total_cmp(&distance(b)))
}

fn reject(inspection: &mut Inspection, why: impl FnOnce(String) -> Option<Rejection>) {
    if let Verdict::Part {
        part,
        rejected: rejected @ None,
        ..
    } = &mut inspection.verdict
    {
        *rejected = why(part.clone());
    }
}

fn disagreement(part: String) -> Rejection {
    Rejection::Undecided {
        part,
        num_agreeing: 1,
        num_frames: 2,
        needed: 2,
    }
}

/// Whether the poses lie no further apart than both may be off together: the noise of both frames parts them. `None` if
/// they cannot be compared, because they are in the coordinates of different references. Without poses there is nothing
/// that could be off.
fn is_near(a: &Inspection, b: &Inspection, middle: Point3<f64>) -> Option<bool> {
    if a.reference() != b.reference() {
        return None;
    }
    let (Some(of_a), Some(of_b)) = (a.found_pose(), b.found_pose()) else {
        return Some(a.found_pose().is_none() && b.found_pose().is_none());
    };
    let pose = |of: &PoseEstimate| (of.camera_from_part(), of.bounds());
    Some(poses_agree(&pose(of_a), &pose(of_b), &middle))
}

/// Whether two poses of one part, with their bounds, lie no further apart than both may be off together. `middle` is the middle
/// of the part, part space, metres.
pub fn poses_agree(
    a: &(RigidTransform, Option<Uncertainty>),
    b: &(RigidTransform, Option<Uncertainty>),
    middle: &Point3<f64>,
) -> bool {
    let apart = pose_error(&a.0, &b.0, middle);
    let (shift, turn) = if let (Some(a), Some(b)) = (a.1, b.1) {
        (Metres(a.shift.0 + b.shift.0), Radians(a.turn.0 + b.turn.0))
    } else {
        // A method that gives no bounds.
        let PoseTolerance { shift, turn } = ConsensusParams::default().tolerance;
        (shift, turn)
    };
    apart.shift <= shift && apart.rotation <= turn
}

#[cfg(test)]
mod tests {
    use std::slice;

    use super::*;
    use crate::{
        fixtures::shipped_library,
        library::Library,
        pipeline::{Recipe, Unwatched, run},
    };
    use simulate::{PartKind, SensorNoise, fixtures::HangingPart};
    use stages::scene::scene_from_frame;

    /// The inspection of a frame with the part moved by `x` metres, with the noise of `seed`, and the part's middle.
    fn seen(
        library: &Library,
        part: &HangingPart,
        x: f64,
        seed: u64,
    ) -> (Inspection, Option<Point3<f64>>) {
        let noise = SensorNoise {
            seed,
            ..part.setup.noise
        };
        let scene = part.frame(noise, &RigidTransform::translation(x, 0.0, 0.0));
        let scene = scene_from_frame(&scene);
        let inspection = run(&scene, library, &Recipe::default(), &Unwatched);
        let inspection = inspection.expect("not cancelled");
        assert!(inspection.verdict.is_accepted(), "{:?}", inspection.verdict);
        let middle = inspection.middle(library);
        (inspection, middle)
    }

    fn rejection(inspection: &Inspection) -> Option<&Rejection> {
        inspection.verdict.rejected()
    }

    #[test]
    fn a_part_that_moved_between_two_frames_is_refused_and_one_with_other_noise_is_not() {
        let library = shipped_library();
        for (kind, noise, seed) in [(PartKind::Grille, 1.0, 4), (PartKind::FrontDoor, 2.0, 5)] {
            let mut part = HangingPart::new(kind, seed);
            part.setup.noise.multiplier = noise;
            let (first, middle) = seen(&library, &part, 0.0, 100);
            let still: Vec<_> = (101..124)
                .map(|seed| seen(&library, &part, 0.0, seed).0)
                .collect();
            for (k, earlier) in still.iter().enumerate() {
                for later in &still[k + 1..] {
                    let mut inspection = earlier.clone();
                    refuse_unless_again(&mut inspection, slice::from_ref(later), middle);
                    assert_eq!(rejection(&inspection), None, "{kind} at {noise}");
                }
            }
            for x in [0.012, -0.03, 0.2] {
                let mut inspection = first.clone();
                let again = seen(&library, &part, x, 101).0;
                refuse_unless_again(&mut inspection, &[again], middle);
                let why = rejection(&inspection);
                assert!(
                    matches!(why, Some(Rejection::NotSteady { .. })),
                    "{kind} at {x}: {why:?}"
                );
            }
        }
    }

    #[test]
    fn of_several_parts_each_is_compared_with_itself_in_whatever_order_they_come() {
        let library = shipped_library();
        let fender = HangingPart::new(PartKind::Fender, 3);
        let (here, middle) = seen(&library, &fender, 0.0, 1);
        let again = |x| seen(&library, &fender, x, 2).0;
        let (grille, _) = seen(&library, &HangingPart::new(PartKind::Grille, 4), 0.0, 2);
        let after = |later: &[Inspection]| {
            let mut inspection = here.clone();
            refuse_unless_again(&mut inspection, later, middle);
            rejection(&inspection).cloned()
        };
        // An equal part 300 mm beside it, and another one.
        assert_eq!(after(&[grille.clone(), again(0.3), again(0.0)]), None);
        let gone = after(&[grille.clone(), again(0.3)]);
        assert!(
            matches!(gone, Some(Rejection::NotSteady { .. })),
            "{gone:?}"
        );
        let other = after(&[grille]);
        assert!(
            matches!(other, Some(Rejection::Undecided { .. })),
            "{other:?}"
        );
    }

    #[test]
    fn what_the_later_frame_refuses_is_refused_for_its_reason() {
        let part = HangingPart::new(PartKind::Fender, 3);
        let (first, middle) = seen(&shipped_library(), &part, 0.0, 1);
        let after = |change: &dyn Fn(&mut Inspection)| {
            let (mut inspection, mut again) = (first.clone(), first.clone());
            change(&mut again);
            refuse_unless_again(&mut inspection, &[again], middle);
            rejection(&inspection).cloned()
        };
        assert_eq!(after(&|_| ()), None);
        let why = Rejection::HardlySeen {
            part: "fender".into(),
            score: 0.5,
        };
        let refused = after(&|again| reject(again, |_| Some(why.clone())));
        assert_eq!(refused, Some(why.clone()));
        let other = after(&|again| {
            if let Verdict::Part { part, .. } = &mut again.verdict {
                "grille".clone_into(part);
            }
        });
        assert!(
            matches!(other, Some(Rejection::Undecided { .. })),
            "{other:?}"
        );
        let gone = after(&|again| {
            again.verdict = Verdict::NoPart(crate::pipeline::Unrecognisable::EmptyLibrary);
        });
        assert!(
            matches!(gone, Some(Rejection::NotSteady { .. })),
            "{gone:?}"
        );
        // A refusal keeps its own reason.
        let mut refused = first.clone();
        reject(&mut refused, |_| Some(why.clone()));
        refuse_moving(&mut refused);
        assert_eq!(rejection(&refused), Some(&why));
    }
}
