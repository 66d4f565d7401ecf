//! Where parts may hang: the work volume, and the places of a rack.

use super::*;
use geometry::{
    oriented_box::OrientedBox,
    rigid::{RigidTransform, from_euler_zyx},
    units::{Metres, Radians},
};
use inspection::{
    fixtures::shipped_library,
    pipeline::run_all,
    rack::{MaxTurn, Place, PlacedPart, Rack, RackFile, RackFrame},
};
use simulate::{RackKind, RackSetup, rack_frame};
use stages::pose::PoseEstimate;

/// Three parts beside each other.
fn full_rack() -> (SceneCloud, Library, Recipe, Vec<Inspection>) {
    let setup = RackSetup::drawn(RackKind::Apart, 3, 0, 4).expect("three places");
    let scene = scene_from_frame(&rack_frame(&setup).expect("a frame").frame);
    let (library, mut recipe) = (shipped_library(), Recipe::default());
    recipe.segment.max_parts = 3;
    let found = run_all(&scene, &library, &recipe, &Unwatched).expect("not cancelled");
    assert!(found.len() == 3 && found.iter().all(|one| one.verdict.is_accepted()));
    (scene, library, recipe, found)
}

/// A place for each of these parts, from right to left, as they hang.
fn places_of(found: &[Inspection], library: &Library) -> RackFile {
    let mut file = RackFile::default();
    for (number, one) in (1..).zip(found.iter().rev()) {
        let taken = file.take_place(&number.to_string(), one, one.middle(library), None);
        assert!(taken.expect("camera space"));
    }
    file
}

/// The place of each part and why it was refused, and the empty places.
fn shown(found: &[Inspection], recipe: &Recipe) -> String {
    let parts = found.iter().map(|one| {
        let place = one.place.as_deref().unwrap_or("none");
        let kind = one.verdict.refusal().map(|why| format!(" {}", why.kind()));
        format!("{place}{}", kind.unwrap_or_default())
    });
    let empty = recipe
        .empty_places(&found.iter().collect::<Vec<_>>())
        .into_iter();
    let empty = empty.map(|place| format!("{place} empty"));
    parts.chain(empty).collect::<Vec<_>>().join(", ")
}

#[test]
fn parts_at_their_places_are_accepted_in_the_order_of_the_places() {
    let (scene, library, mut recipe, found) = full_rack();
    recipe.segment.max_parts = 1;
    recipe.rack = places_of(&found, &library).rack;
    let hung = run_all(&scene, &library, &recipe, &Unwatched).expect("not cancelled");
    assert_eq!(
        shown(&hung, &recipe),
        "1, 2, 3",
        "as many as there are places"
    );
    for (hung, before) in hung.iter().zip(found.iter().rev()) {
        assert_eq!(hung.verdict.guess(), before.verdict.guess());
        let pose = |one: &Inspection| one.found_pose().map(PoseEstimate::camera_from_part);
        assert!(
            pose(hung) == pose(before),
            "it is found as without the rack"
        );
        let turn = hung.turn_at_place.expect("it may only hang as it does");
        assert!(turn.found.0 < 1e-6 && turn.is_allowed(), "{turn:?}");
    }
    let mut turned = |angles: Option<[f64; 3]>| {
        recipe.rack.places[2].parts[0].angles_rad = angles;
        let hung = run_all(&scene, &library, &recipe, &Unwatched).expect("not cancelled");
        assert_eq!(shown(&hung, &recipe), "1, 2, 3");
        hung[2].turn_at_place
    };
    let [rx, ry, rz] = places_of(&found, &library).rack.places[2].parts[0]
        .angles_rad
        .expect("an orientation");
    let turn = turned(Some([rx, ry, rz + 0.1])).expect("limited");
    assert!((turn.found.0 - 0.1).abs() < 1e-6, "{turn:?}");
    assert_eq!(turned(None), None);
}

#[test]
fn a_part_that_hangs_where_or_as_it_may_not_is_refused() {
    let (scene, library, mut recipe, found) = full_rack();
    let rack = places_of(&found, &library).rack;
    let mut hung = |change: &dyn Fn(&mut Rack)| {
        recipe.rack = rack.clone();
        change(&mut recipe.rack);
        let hung = run_all(&scene, &library, &recipe, &Unwatched).expect("not cancelled");
        shown(&hung, &recipe)
    };
    // The last place is that of the part on the left.
    let turned = hung(&|rack| {
        let Some([rx, ry, rz]) = rack.places[2].parts[0].angles_rad else {
            panic!("an orientation");
        };
        rack.places[2].parts[0].angles_rad = Some([rx, ry, rz + 0.5]);
    });
    assert_eq!(turned, "1, 2, 3 turned");
    let other = hung(&|rack| rack.places[2].parts[0].name = "hood".into());
    assert_eq!(other, "1, 2, 3 wrong_place");
    let beside = hung(&|rack| rack.places[2].region.centre_m[1] -= 0.4);
    assert_eq!(beside, "1, 2, none beside_places, 3 empty");
    let any = hung(&|rack| {
        rack.places[2].parts.clear();
        rack.places[1].parts[0].angles_rad = None;
    });
    assert_eq!(any, "1, 2, 3");
}

#[test]
fn the_part_of_a_single_place_is_found_beside_others() {
    let (scene, library, mut recipe, found) = full_rack();
    recipe.segment.max_parts = 1;
    let rack = places_of(&found, &library).rack;
    for place in rack.places {
        let name = place.name.clone();
        recipe.rack.places = vec![place];
        let hung = run_all(&scene, &library, &recipe, &Unwatched).expect("not cancelled");
        let shown = shown(&hung, &recipe);
        assert!(
            shown.starts_with(&name) && !shown.contains("empty"),
            "{shown}"
        );
        assert!(hung[0].verdict.is_accepted(), "{shown}");
    }
}

#[test]
fn nothing_outside_the_work_volume_is_looked_at() {
    let (scene, library, mut recipe, found) = full_rack();
    for one in &found {
        let mut file = RackFile::default();
        assert!(file.take_volume(one, None).expect("camera space"));
        recipe.rack = file.rack;
        let inside = run_all(&scene, &library, &recipe, &Unwatched).expect("not cancelled");
        assert!(inside[0].verdict.is_accepted() && !inside[0].leaves_volume);
        assert_eq!(inside[0].verdict.guess(), one.verdict.guess());
        // A piece of the next part may reach into the box around this one.
        assert!(inside[1..].iter().all(|other| other.leaves_volume));
        // Half of the part is outside.
        let region = &mut recipe.rack.volume[0];
        region.centre_m[0] += region.size_m[0] / 2.0;
        let cut = run(&scene, &library, &recipe, &Unwatched).expect("not cancelled");
        assert!(cut.leaves_volume, "{:?}", one.verdict.guess());
        let kind = cut.verdict.refusal().map(|why| why.kind().to_string());
        // What is inside may suffice.
        let kind = kind.unwrap_or_default();
        assert!(["", "cut_by_volume", "unknown"].contains(&&*kind), "{kind}");
    }
}

#[test]
fn of_two_poses_of_a_symmetric_part_the_allowed_one_is_found() {
    for object in [ObjectKind::Box, ObjectKind::Wheel] {
        let library = of_object(object);
        let mut num_accepted = 0;
        for (seed, turn) in [0.0, 0.09, 1.57, 2.5, 3.1, 4.0].into_iter().enumerate() {
            let scene = turned_object(object, turn, 2 + seed as u64);
            let free = inspected(&scene, &library, &Recipe::default());
            let Some(pose) = free.found_pose().filter(|_| free.verdict.is_accepted()) else {
                continue;
            };
            num_accepted += 1;
            let runner_up = pose.runner_up.expect("a runner-up").target_from_source;
            for wanted in [pose.target_from_source, runner_up] {
                let camera_from_part = wanted.inverse();
                let middle = library.references[0].middle().expect("points");
                let mut recipe = Recipe::default();
                recipe.rack.places.push(Place {
                    name: "hook".into(),
                    region: OrientedBox {
                        centre_m: (camera_from_part * middle).coords.into(),
                        size_m: [0.3; 3],
                        angles_rad: [0.0; 3],
                    },
                    max_turn: MaxTurn::Total(Radians(0.3)),
                    parts: vec![PlacedPart {
                        name: object.name().into(),
                        angles_rad: Some(camera_from_part.rotation.euler_angles().into()),
                    }],
                });
                let hung = inspected(&scene, &library, &recipe);
                let shown = format!("{object:?} at {turn}: {:?}", hung.verdict);
                assert!(hung.verdict.is_accepted(), "{shown}");
                let pose = hung.found_pose().expect("a pose");
                let apart = pose_error(&pose.camera_from_part(), &camera_from_part, &middle);
                assert!(
                    apart.rotation.degrees() < 3.0 && apart.shift.mm() < 10.0,
                    "{apart:?}"
                );
                assert!(!pose.is_ambiguous(), "{shown}");
            }
        }
        assert!(num_accepted >= 3, "{object:?}: {num_accepted}");
    }
}

#[test]
fn a_rack_in_the_base_frame_is_the_same_in_camera_space() {
    let (_, library, _, found) = full_rack();
    let base_from_camera = from_euler_zyx([-1.9, 0.1, -1.6, 1.5, -0.2, 2.0]);
    let mut file = RackFile {
        frame: RackFrame::Base,
        ..RackFile::default()
    };
    let taken = file.take_place(
        "1",
        &found[0],
        found[0].middle(&library),
        Some(&base_from_camera),
    );
    assert!(taken.expect("calibrated"));
    assert!(file.in_camera(None).is_err(), "not calibrated");
    let reference = found[0].best_reference(&library).expect("named");
    let pose = found[0].found_pose().expect("a pose");
    let place = &file
        .in_camera(Some(&base_from_camera))
        .expect("calibrated")
        .places[0];
    let turn = place.turn(reference, &pose.camera_from_part());
    assert!(turn.expect("known").found.0 < 1e-6);
    let middle = pose.camera_from_part() * reference.middle().expect("points");
    assert!(place.region.distance(&middle) <= 0.0);
    let elsewhere = RigidTransform::translation(0.0, 0.0, Metres::from_mm(400.0).0);
    let moved = file.in_camera(Some(&(base_from_camera * elsewhere)));
    assert!(
        moved.expect("calibrated").places[0]
            .region
            .distance(&middle)
            > 0.2
    );
}
