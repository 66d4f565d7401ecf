//! Several parts in one frame.

use std::{cell::Cell, f64::consts::FRAC_PI_2};

use geometry::{
    depth_frame::DepthFrame,
    parallel::{num_cores, on_one_core},
    rigid::pose_error,
    units::Metres,
};
use inspection::{
    fixtures::standard_library,
    library::{Library, enrolment_pose},
    pipeline::{
        Expected, Inspection, ProgressObserver, Recipe, Rejection, Stage, Unwatched, run, run_all,
    },
};
use nalgebra::{Isometry3, Point3, UnitQuaternion, Vector3};
use simulate::{
    CellSetup, ObjectKind, PartKind, PartPose, RackKind, RackSetup, Side, SimulatedObject, frame,
    rack_frame,
};
use stages::scene::{SceneCloud, scene_from_frame};

/// Depth of the wall.
const WALL: Metres = Metres(3.0);

/// Something that hangs in the cell.
struct Hung {
    subject: SimulatedObject,
    camera_from_model: Isometry3<f64>,
}

/// Hangs a subject `x` metres to the right of the optical axis and `z` in front of the camera, rolled by radians.
fn hung(subject: SimulatedObject, x: f64, z: f64, roll: f64) -> Hung {
    Hung {
        subject,
        camera_from_model: Isometry3::from_parts(
            Vector3::new(x, 0.0, z).into(),
            UnitQuaternion::from_axis_angle(&Vector3::z_axis(), roll),
        ),
    }
}

fn part(kind: PartKind) -> SimulatedObject {
    SimulatedObject::Part {
        kind,
        side: Side::Left,
        model_seed: 0,
    }
}

/// One frame of all that hangs there: at each pixel the nearest reading of frames of the same cell with one thing each, and no
/// reading where one of them has none, unless another shows something in front of the wall.
fn scene_of_all(all: &[Hung]) -> SceneCloud {
    let frames: Vec<DepthFrame> = all
        .iter()
        .map(|one| {
            let mut setup = CellSetup::new(one.subject, 7);
            setup.pose = PartPose::Fixed(one.camera_from_model);
            setup.wall = WALL;
            frame(&setup).frame
        })
        .collect();
    let mut merged = frames[0].clone();
    let before_wall = ((WALL.0 - 0.4) / merged.metres_per_unit) as u16;
    for (i, depth) in merged.depth.iter_mut().enumerate() {
        let readings = frames.iter().map(|frame| frame.depth[i]);
        let is_gap = readings.clone().any(|depth| depth == 0);
        let nearest = readings.filter(|depth| *depth > 0).min().unwrap_or(0);
        *depth = if is_gap && nearest > before_wall {
            0
        } else {
            nearest
        };
    }
    scene_from_frame(&merged)
}

fn all_in(scene: &SceneCloud, library: &Library, max_parts: usize) -> Vec<Inspection> {
    let mut recipe = Recipe::default();
    recipe.segment.max_parts = max_parts;
    run_all(scene, library, &recipe, &Unwatched).expect("not cancelled")
}

/// Checks that the inspection accepted this part where it hangs.
fn check(inspection: &Inspection, expected: &Hung) {
    let SimulatedObject::Part { kind, .. } = expected.subject else {
        panic!("no part")
    };
    let verdict = &inspection.verdict;
    assert_eq!(verdict.guess(), Some(kind.name()), "{verdict:?}");
    assert!(verdict.is_accepted(), "{kind}: {verdict:?}");
    let pose = inspection.found_pose().expect("a pose");
    let truth = expected.camera_from_model * enrolment_pose().inverse();
    let middle = expected.camera_from_model * Point3::origin();
    let off = pose_error(
        &pose.camera_from_part(),
        &truth,
        &(truth.inverse() * middle),
    );
    assert!(
        off.rotation.degrees() < 1.5 && off.shift.mm() < 10.0,
        "{kind}: {off:?}"
    );
}

#[test]
fn every_part_is_accepted_once_at_its_place_from_left_to_right() {
    use PartKind::{BackDoor, Fender, FrontDoor, RadiatorSupport, TrunkLid};
    let library = standard_library();
    for kinds in [
        &[FrontDoor, TrunkLid][..],
        &[RadiatorSupport, Fender],
        &[BackDoor, FrontDoor],
        // Twice the same.
        &[Fender, Fender],
        &[Fender, RadiatorSupport, Fender],
    ] {
        let num = kinds.len();
        let apart = if num == 2 { 1.0 } else { 0.75 };
        let middle = (num as f64 - 1.0) / 2.0;
        let parts: Vec<Hung> = (0..)
            .zip(kinds)
            .map(|(i, kind)| {
                let index = f64::from(i);
                let x = (index - middle) * apart;
                // Three only fit on end.
                let on_end = if num == 2 { 0.0 } else { FRAC_PI_2 };
                let roll = 0.1 - 0.3 * index + on_end;
                hung(part(*kind), x, 2.0 + 0.1 * index, roll)
            })
            .collect();
        let scene = scene_of_all(&parts);
        let found = all_in(&scene, &library, num);
        assert_eq!(found.len(), num, "{kinds:?}");
        for (inspection, expected) in found.iter().zip(&parts) {
            check(inspection, expected);
        }
        // A reading belongs to one part at most.
        let mut taken: Vec<u32> = found
            .iter()
            .filter_map(|part| part.segmentation.part.as_ref().ok())
            .flat_map(|part| part.indices.iter().copied())
            .collect();
        let num_taken = taken.len();
        taken.sort_unstable();
        taken.dedup();
        assert_eq!(taken.len(), num_taken, "{kinds:?}");
        // On one core the same.
        let again = on_one_core(|| all_in(&scene, &library, num));
        for (a, b) in again.iter().zip(&found) {
            assert_eq!(a.verdict, b.verdict);
            assert_eq!(a.pose, b.pose);
        }
        // As many as hang there are found, however many more may.
        assert_eq!(all_in(&scene, &library, 5).len(), num, "{kinds:?}");
    }
}

/// Counts the surfaces that the calling thread projects.
#[derive(Default)]
struct ProjectedHere(Cell<usize>);

impl ProgressObserver for ProjectedHere {
    fn begins(&self, stage: Stage) {
        self.0
            .set(self.0.get() + usize::from(stage == Stage::Project));
    }
}

#[test]
fn the_next_part_is_inspected_on_another_core() {
    let library = standard_library();
    let (scene, _) = rack(RackKind::Apart, 2, 2);
    let mut recipe = Recipe::default();
    recipe.segment.max_parts = 2;
    let num_here = || {
        let watch = ProjectedHere::default();
        let found = run_all(&scene, &library, &recipe, &watch).expect("not cancelled");
        assert_eq!(found.len(), 2);
        watch.0.get()
    };
    assert_eq!(on_one_core(num_here), 2);
    assert_eq!(num_here(), if num_cores() > 1 { 1 } else { 2 });
}

#[test]
fn one_part_is_inspected_as_ever() {
    let library = standard_library();
    let parts = [
        hung(part(PartKind::FrontDoor), -0.5, 2.0, 0.1),
        hung(part(PartKind::TrunkLid), 0.5, 2.1, -0.2),
    ];
    let scene = scene_of_all(&parts);
    let one = run(&scene, &library, &Recipe::default(), &Unwatched).expect("not cancelled");
    let all = all_in(&scene, &library, 1);
    assert_eq!(all.len(), 1);
    assert_eq!((&all[0].verdict, &all[0].pose), (&one.verdict, &one.pose));
    assert!(one.verdict.is_accepted(), "{:?}", one.verdict);
    // Nor is anything else inspected if it is refused.
    let wheel = hung(SimulatedObject::Object(ObjectKind::Wheel), -0.6, 1.9, 0.0);
    let hood = hung(SimulatedObject::Object(ObjectKind::Hood), 0.5, 2.0, 0.0);
    assert_eq!(all_in(&scene_of_all(&[wheel, hood]), &library, 1).len(), 1);
    let alone = scene_of_all(&parts[..1]);
    let found = all_in(&alone, &library, 4);
    assert_eq!(found.len(), 1);
    check(&found[0], &parts[0]);
}

#[test]
fn the_expected_one_of_several_is_found_and_the_others_are_not_expected() {
    let library = standard_library();
    let (scene, parts) = rack(RackKind::Apart, 3, 4);
    let names = parts.iter().map(|hung| match hung.subject {
        SimulatedObject::Part { kind, .. } => kind.name(),
        _ => panic!("parts hang there"),
    });
    let names: Vec<&str> = names.collect();
    for (name, hung) in names.iter().zip(&parts) {
        let expected = Expected::new(vec![(*name).into()], None, |_| true);
        let recipe = Recipe {
            expected: expected.expect("a part"),
            ..Recipe::default()
        };
        let one = run(&scene, &library, &recipe, &Unwatched).expect("not cancelled");
        check(&one, hung);
        let all = run_all(&scene, &library, &recipe, &Unwatched).expect("not cancelled");
        assert_eq!(all.len(), 3);
        check(&all[0], hung);
        for other in &all[1..] {
            let rejected = other.verdict.rejected();
            assert!(
                matches!(rejected, Some(Rejection::NotExpected { part }) if part != name),
                "{name} of {names:?}: {rejected:?}"
            );
        }
        let all: Vec<&Inspection> = all.iter().collect();
        assert!(!recipe.expected.is_met(&all));
        assert!(recipe.expected.missing(&all).is_empty());
    }
}

#[test]
fn what_is_no_part_comes_last_and_is_never_accepted() {
    let library = standard_library();
    for object in [ObjectKind::Wheel, ObjectKind::Box, ObjectKind::Hood] {
        let things = [
            hung(SimulatedObject::Object(object), -0.6, 1.9, 0.0),
            hung(part(PartKind::Fender), 0.5, 2.0, 0.2),
        ];
        let found = all_in(&scene_of_all(&things), &library, 2);
        assert_eq!(found.len(), 2, "{object:?}");
        check(&found[0], &things[1]);
        let other = &found[1];
        assert!(!other.verdict.is_accepted(), "{object:?}");
        let surface = other.segmentation.part.as_ref().expect("a surface").surface;
        assert!(surface.expect("of a picture").area > 0.02, "{object:?}");
    }
}

/// A simulated rack: its scene, and what hangs there from left to right.
fn rack(kind: RackKind, num_places: usize, seed: u64) -> (SceneCloud, Vec<Hung>) {
    let setup = RackSetup::drawn(kind, num_places, 0, seed).expect("two to five places");
    let rack = rack_frame(&setup).expect("a plain cell");
    let parts = rack.truth.parts.iter().map(|part| Hung {
        subject: part.subject,
        camera_from_model: part.camera_from_part,
    });
    (scene_from_frame(&rack.frame), parts.collect())
}

#[test]
fn parts_that_touch_are_told_apart() {
    let library = standard_library();
    // Two and three of them that are one surface for the segmentation, along necks of different widths.
    for (num, seed) in [(2, 8), (2, 13), (3, 2), (3, 5), (3, 12)] {
        let (scene, parts) = rack(RackKind::Touching, num, seed);
        let joined = run(&scene, &library, &Recipe::default(), &Unwatched).expect("not cancelled");
        assert!(!joined.verdict.is_accepted(), "{num}, {seed}");
        let found = all_in(&scene, &library, num);
        assert_eq!(found.len(), num, "{seed}");
        for (inspection, expected) in found.iter().zip(&parts) {
            check(inspection, expected);
        }
    }
}

#[test]
fn a_right_part_beside_a_left_one_is_not_accepted() {
    let library = standard_library();
    for seed in 1..=6 {
        let (scene, parts) = rack(RackKind::Mirrored, 2, seed);
        let is_left = |part: &&Hung| {
            let SimulatedObject::Part { side, .. } = part.subject else {
                panic!("no part")
            };
            side == Side::Left
        };
        let left = parts.iter().find(is_left).expect("a left part");
        let found = all_in(&scene, &library, 2);
        assert_eq!(found.len(), 2, "{seed}");
        check(&found[0], left);
        let right = &found[1].verdict;
        assert!(
            right.is_unknown() && !right.is_accepted(),
            "{seed}: {right:?}"
        );
    }
}
