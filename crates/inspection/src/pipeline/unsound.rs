//! Refuses parts, however well they fit, in scenes that no depth camera can have seen.

use super::{
    Inspection,
    rejection::{CAMERA_RANGE, Rejection},
    verdict::Verdict,
};
use geometry::{cloud::MAX_STRAY_SHARE, units::Metres};
use stages::scene::SceneCloud;

/// Share of a part's points that may lie out of range.
const MAX_OUT_OF_RANGE_SHARE: f64 = 0.01;

/// Rejects an accepted part if its scene cannot be right.
pub(super) fn refuse_unsound(inspection: &mut Inspection, scene: &SceneCloud) {
    let Ok(found) = &inspection.segmentation.part else {
        return;
    };
    let Verdict::Part {
        part,
        rejected: rejected @ None,
        ..
    } = &mut inspection.verdict
    else {
        return;
    };
    let part = || part.clone();
    let cloud = &scene.cloud;
    if cloud.surplus_bytes > 0 {
        let num = cloud.surplus_bytes;
        *rejected = Some(Rejection::SurplusBytes { part: part(), num });
        return;
    }
    let share = cloud.share_behind();
    if share > MAX_STRAY_SHARE {
        *rejected = Some(Rejection::BehindCamera {
            part: part(),
            share,
        });
        return;
    }
    let mut depths: Vec<f32> = found.cloud.points.iter().map(|p| p.z).collect();
    let range = CAMERA_RANGE.map(|end| end.0 as f32);
    let is_outside = |z: &&f32| !(range[0]..=range[1]).contains(*z);
    let num_outside = depths.iter().filter(is_outside).count();
    if num_outside as f64 > MAX_OUT_OF_RANGE_SHARE * depths.len() as f64 {
        let middle = depths.len() / 2;
        let (_, middle, _) = depths.select_nth_unstable_by(middle, f32::total_cmp);
        *rejected = Some(Rejection::OutOfRange {
            part: part(),
            depth: Metres(f64::from(*middle)),
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        fixtures::shipped_library,
        pipeline::{ProgressObserver, Recipe, Stage, Unrecognisable, Unwatched, run},
    };
    use geometry::error::Advice as _;
    use simulate::{CellSetup, PartKind, Side};
    use stages::fixtures::scene_of;

    fn fender() -> SceneCloud {
        scene_of(&CellSetup::with_part(PartKind::Fender, Side::Left, 0, 1))
    }

    #[test]
    fn a_part_that_fits_is_refused_in_a_scene_that_cannot_be_right() {
        let (scene, recipe) = (fender(), Recipe::default());
        let accepted = run(&scene, &shipped_library(), &recipe, &Unwatched).expect("not cancelled");
        assert!(accepted.verdict.is_accepted());
        let refused = |inspection: &Inspection, scene: &SceneCloud| {
            let mut inspection = inspection.clone();
            refuse_unsound(&mut inspection, scene);
            match inspection.verdict {
                Verdict::Part { rejected, .. } => rejected,
                Verdict::NoPart(_) => panic!("there is a part"),
            }
        };
        assert_eq!(refused(&accepted, &scene), None);
        let mut longer = scene.clone();
        longer.cloud.surplus_bytes = 4;
        let found = refused(&accepted, &longer);
        assert!(matches!(
            found,
            Some(Rejection::SurplusBytes { num: 4, .. })
        ));
        let mut turned = scene.clone();
        for point in turned.cloud.points.iter_mut().step_by(100) {
            point.z = -point.z;
        }
        let found = refused(&accepted, &turned);
        assert!(matches!(found, Some(Rejection::BehindCamera { share, .. }) if share > 0.005));
        for scale in [0.005, 200.0] {
            let mut inspection = accepted.clone();
            if let Ok(part) = &mut inspection.segmentation.part {
                for point in &mut part.cloud.points {
                    *point *= scale;
                }
            }
            let found = refused(&inspection, &scene).expect("out of range");
            assert!(matches!(found, Rejection::OutOfRange { .. }), "{found}");
            assert!(!found.advice().is_empty());
        }
    }

    #[test]
    fn a_panic_in_a_stage_is_the_verdict_of_that_scene() {
        struct Fails(Stage);
        impl ProgressObserver for Fails {
            fn begins(&self, stage: Stage) {
                assert!(stage != self.0, "no {stage:?} today");
            }
        }
        let (scene, library, recipe) = (fender(), shipped_library(), Recipe::default());
        for stage in [Stage::Segment, Stage::Rank, Stage::Pose] {
            let found = run(&scene, &library, &recipe, &Fails(stage)).expect("not cancelled");
            let Verdict::NoPart(Unrecognisable::Fault(fault)) = &found.verdict else {
                panic!("{:?}", found.verdict);
            };
            assert!(fault.to_string().contains("today"), "{fault}");
            assert_eq!(found.segmentation.labels.len(), scene.cloud.points.len());
        }
        let sound = run(&scene, &library, &recipe, &Unwatched).expect("not cancelled");
        assert!(sound.verdict.is_accepted());
    }
}
