//! The whole inspection: moved and rotated parts, invalid points, cancellation, reproducible results; and cameras without a
//! camera: their libraries with played or recorded devices, and stub libraries.

#![allow(clippy::disallowed_methods, reason = "tests change files")]

mod cameras;
#[cfg(target_os = "linux")]
mod kinect;
#[cfg(target_os = "linux")]
mod openni;
#[cfg(target_os = "linux")]
mod own_process;
#[cfg(target_os = "linux")]
mod played_camera;
mod rack;
#[cfg(target_os = "linux")]
mod realsense;
mod several;

use std::cell::Cell;

use stages::fixtures::scene_of;

use geometry::{
    cloud::{Grid, PointCloud},
    parallel::on_one_core,
    rigid::pose_error,
};
use inspection::{
    fixtures::standard_library,
    library::{
        EnrolParams, Library, PartDescription, PartName, enrol_captured, enrol_surface,
        enrolment_pose,
    },
    pipeline::{
        Cancelled, Inspection, PoseChoice, ProgressObserver, Recipe, Rejection, Stage,
        Unrecognisable, Unwatched, Verdict, run,
    },
};
use nalgebra::{Isometry3, Point3, UnitQuaternion, Vector3};
use simulate::{
    CellSetup, Clutter, FIRST_OTHER_MAKE, ObjectKind, PartKind, PartPose, PoseRange, SensorNoise,
    Side, SimulatedObject, frame,
};
use stages::{
    pose::PoseMethod,
    rank::Matcher,
    scene::{SceneCloud, scene_from_cloud, scene_from_frame},
};

fn inspected(scene: &SceneCloud, library: &Library, recipe: &Recipe) -> Inspection {
    run(scene, library, recipe, &Unwatched).expect("not cancelled")
}

/// A front door far enough away to fit the picture at any rotation about the optical axis.
fn door(roll: f64, shift: [f64; 2]) -> SceneCloud {
    door_with(roll, shift, SensorNoise::kinect(5))
}

fn door_with(roll: f64, shift: [f64; 2], noise: SensorNoise) -> SceneCloud {
    let mut setup = CellSetup::with_part(PartKind::FrontDoor, Side::Left, 0, 5);
    setup.noise = noise;
    setup.pose = PartPose::Fixed(Isometry3::from_parts(
        Vector3::new(shift[0], shift[1], 1.7).into(),
        UnitQuaternion::from_axis_angle(&Vector3::z_axis(), roll),
    ));
    scene_of(&setup)
}

#[test]
fn moving_and_turning_the_part_leaves_its_signature_up_to_a_cyclic_shift() {
    let library = Library::default();
    let lengths = |scene: &SceneCloud| {
        let inspection = inspected(scene, &library, &Recipe::default());
        inspection.signature.expect("an outline").lengths()
    };
    let still = lengths(&door_with(0.0, [0.0, 0.0], SensorNoise::none()));
    for (roll, shift) in [(0.7, [0.0, 0.0]), (-2.2, [0.05, -0.04]), (0.0, [0.1, 0.03])] {
        let moved = lengths(&door_with(roll, shift, SensorNoise::none()));
        let n = still.len();
        let rms_at = |lag: usize| {
            let sum: f64 = (0..n)
                .map(|i| (still[i] - moved[(i + lag) % n]).powi(2))
                .sum();
            (sum / n as f64).sqrt()
        };
        let best = (0..n).map(rms_at).fold(f64::INFINITY, f64::min);
        // Two pixels of the binary image, to allow for noise at the edges of rays of half a metre.
        assert!(best < 0.010, "{best} m after a turn by {roll}");
    }
}

#[test]
fn the_pose_follows_the_part_in_both_directions() {
    let (library, camera_from_model) = (standard_library(), enrolment_pose());
    for kind in [PartKind::FrontDoor, PartKind::Fender, PartKind::TrunkLid] {
        let truth = Isometry3::from_parts(
            Vector3::new(0.04, -0.03, 1.5).into(),
            UnitQuaternion::from_euler_angles(0.2, -0.3, 1.9),
        );
        let mut setup = CellSetup::with_part(kind, Side::Left, 0, 11);
        setup.pose = PartPose::Fixed(truth);
        let scene = scene_of(&setup);
        let inspection = inspected(&scene, &library, &Recipe::default());
        let pose = inspection.pose.expect("asked for").expect("a pose");
        let camera_from_part = truth * camera_from_model.inverse();
        let at_part = camera_from_model * Point3::origin();
        for (found, expected, at) in [
            (pose.camera_from_part(), camera_from_part, at_part),
            (
                pose.target_from_source,
                camera_from_part.inverse(),
                camera_from_part * at_part,
            ),
        ] {
            let error = pose_error(&found, &expected, &at);
            assert!(
                error.rotation.degrees() < 1.0 && error.shift.mm() < 6.0,
                "{kind}: {error:?}"
            );
        }
    }
}

#[test]
fn the_same_scene_gives_the_same_bits() {
    let library = standard_library();
    let scene = door(0.4, [0.02, 0.0]);
    let once = inspected(&scene, &library, &Recipe::default());
    let again = inspected(&scene, &library, &Recipe::default());
    assert_eq!(once.segmentation, again.segmentation);
    assert_eq!(once.ranking, again.ranking);
    assert_eq!(once.pose, again.pose);
    assert_eq!(once.verdict, again.verdict);
}

#[test]
fn one_core_and_all_of_them_give_the_same_bits() {
    let library = standard_library();
    let fender = SimulatedObject::Part {
        kind: PartKind::Fender,
        side: Side::Left,
        model_seed: 0,
    };
    // A whole part; one that the picture cuts, which is searched for as a piece; and a thing like no part.
    let scenes = [
        door(0.4, [0.02, 0.0]),
        scene_of(&CellSetup::booth(fender, 5_800_519)),
        scene_of(&CellSetup::booth(
            SimulatedObject::Object(ObjectKind::Chair),
            3_900_012,
        )),
    ];
    for scene in &scenes {
        let alone = on_one_core(|| inspected(scene, &library, &Recipe::default()));
        let shared = inspected(scene, &library, &Recipe::default());
        assert_eq!(alone.segmentation, shared.segmentation);
        assert_eq!(alone.ranking, shared.ranking);
        assert_eq!(alone.pose, shared.pose);
        assert_eq!(alone.verdict, shared.verdict);
    }
}

#[test]
fn nothing_to_see_is_no_part_whatever_the_recipe() {
    let library = standard_library();
    let nowhere = Point3::new(f32::NAN, f32::NAN, f32::NAN);
    let cloud = |points: Vec<Point3<f32>>| scene_from_cloud(PointCloud::from_points(points));
    let empty_cell = scene_of(&CellSetup::new(SimulatedObject::Nothing, 3));
    let all_nan = scene_from_cloud(PointCloud {
        points: vec![nowhere; 640 * 480],
        grid: Some(Grid {
            width: 640,
            height: 480,
        }),
        ..PointCloud::default()
    });
    let scenes = [
        ("wall and floor only", empty_cell),
        ("all NaN", all_nan),
        ("empty", cloud(Vec::new())),
        ("one point", cloud(vec![Point3::new(0.0, 0.0, 1.0)])),
        ("all equal", cloud(vec![Point3::new(0.1, 0.2, 1.0); 5000])),
        (
            "a line",
            cloud(
                (0..5000)
                    .map(|i| Point3::new(i as f32 * 2e-4, 0.0, 1.0))
                    .collect(),
            ),
        ),
        (
            "far away",
            cloud(
                (0..5000)
                    .map(|i| Point3::new((i % 70) as f32 * 1e6, (i / 70) as f32 * 1e6, 1e9))
                    .collect(),
            ),
        ),
    ];
    for matcher in [Matcher::Default, Matcher::Paper] {
        for pose in [
            PoseChoice::Skip,
            PoseChoice::By(PoseMethod::Global),
            PoseChoice::By(PoseMethod::Icp),
            PoseChoice::By(PoseMethod::IcpGa),
        ] {
            let mut recipe = Recipe {
                pose,
                ..Recipe::default()
            };
            recipe.rank.matcher = matcher;
            for (what, scene) in &scenes {
                let inspection = inspected(scene, &library, &recipe);
                assert!(
                    matches!(inspection.verdict, Verdict::NoPart(_)),
                    "{what}: {:?}",
                    inspection.verdict
                );
            }
        }
    }
}

#[test]
fn a_scene_of_stray_points_is_never_accepted() {
    let library = standard_library();
    // Isolated flat and curved sheets unlike any part.
    for bend in [0.0, 0.5, -2.0] {
        let points = (0..20_000).map(|i| {
            let (u, v) = (
                (i % 200) as f32 * 0.005 - 0.5,
                (i / 200) as f32 * 0.005 - 0.25,
            );
            Point3::new(u, v, 1.2 + bend * u * u)
        });
        let inspection = inspected(
            &scene_from_cloud(PointCloud::from_points(points)),
            &library,
            &Recipe::default(),
        );
        if let Verdict::Part {
            part,
            score,
            rejected,
            ..
        } = &inspection.verdict
        {
            assert!(
                rejected.is_some(),
                "a sheet bent by {bend} was accepted as {part} with {score:.2}"
            );
        }
    }
}

#[test]
fn an_empty_library_says_so() {
    let inspection = inspected(
        &door(0.0, [0.0, 0.0]),
        &Library::default(),
        &Recipe::default(),
    );
    assert_eq!(
        inspection.verdict,
        Verdict::NoPart(Unrecognisable::EmptyLibrary)
    );
    assert!(inspection.contour.is_some(), "the stages before are kept");
}

#[test]
fn a_cancelled_inspection_stops_before_the_next_stage() {
    struct CancelAt {
        stage: Stage,
        reached: Cell<bool>,
    }
    impl ProgressObserver for CancelAt {
        fn begins(&self, stage: Stage) {
            assert!(!self.reached.get(), "{stage:?} began after the cancel");
            self.reached.set(stage == self.stage);
        }
        fn is_cancelled(&self) -> bool {
            self.reached.get()
        }
    }
    let library = standard_library();
    let scene = door(0.0, [0.0, 0.0]);
    for stage in [
        Stage::Segment,
        Stage::Project,
        Stage::Contour,
        Stage::Signature,
        Stage::Rank,
    ] {
        let watch = CancelAt {
            stage,
            reached: Cell::new(false),
        };
        let result = run(&scene, &library, &Recipe::default(), &watch);
        assert!(matches!(result, Err(Cancelled)), "cancelled at {stage:?}");
    }
}

/// Cancels at the eleventh query after the pose stage has begun.
#[derive(Default)]
struct Midway {
    is_posing: Cell<bool>,
    num_asked: Cell<usize>,
}
impl ProgressObserver for Midway {
    fn begins(&self, stage: Stage) {
        self.is_posing.set(stage == Stage::Pose);
    }
    fn is_cancelled(&self) -> bool {
        let more = usize::from(self.is_posing.get());
        self.num_asked.set(self.num_asked.get() + more);
        self.num_asked.get() > 10
    }
}

#[test]
fn icp_ga_finds_a_door_turned_too_far_for_icp_and_can_be_cancelled_midway() {
    let library = standard_library();
    let scene = door(2.0, [0.02, 0.01]);
    let by = |method| Recipe {
        pose: PoseChoice::By(method),
        ..Recipe::default()
    };
    let accepted = |recipe: &Recipe| {
        let verdict = inspected(&scene, &library, recipe).verdict;
        matches!(verdict, Verdict::Part { part, rejected: None, .. } if part == "front_door")
    };
    assert!(!accepted(&by(PoseMethod::Icp)));
    assert!(accepted(&by(PoseMethod::IcpGa)));

    let watch = Midway::default();
    let ended = run(&scene, &library, &by(PoseMethod::IcpGa), &watch);
    assert!(matches!(ended, Err(Cancelled)));
}

#[test]
fn a_capture_saved_as_bare_points_is_recognised_as_well() {
    let library = standard_library();
    for (i, kind) in (0..).zip(PartKind::ALL) {
        for seed in [i, i + 8] {
            let scene = scene_of(&CellSetup::with_part(kind, Side::Left, 0, 60 + seed));
            let bare =
                scene_from_cloud(PointCloud::from_points(scene.cloud.points.iter().copied()));
            let inspection = inspected(&bare, &library, &Recipe::default());
            let Verdict::Part {
                part,
                score,
                rejected,
                ..
            } = inspection.verdict
            else {
                panic!("{kind}, seed {seed}: {:?}", inspection.verdict);
            };
            assert!(
                part == kind.name() && rejected.is_none(),
                "{kind}, seed {seed}: {part} {score:.2} {rejected:?}"
            );
        }
    }
}

#[test]
fn a_right_hand_part_is_refused_as_the_mirror_image_of_the_left_one() {
    let library = standard_library();
    for kind in [PartKind::FrontDoor, PartKind::BackDoor, PartKind::Fender] {
        let setup = CellSetup::with_part(kind, Side::Right, 0, 41);
        let inspection = inspected(&scene_of(&setup), &library, &Recipe::default());
        let verdict = &inspection.verdict;
        let mirrored = match verdict {
            Verdict::Part {
                rejected: Some(Rejection::Mirrored { part, .. }),
                ..
            } => part.as_str(),
            other => panic!("{kind}: {other:?}"),
        };
        assert_eq!(mirrored, kind.name());
        assert!(verdict.is_unknown());
        // The pose is of the part that the verdict names.
        assert_eq!(inspection.reference(), Some(kind.name()));
    }
}

#[test]
fn a_part_whose_outline_its_stand_changes_is_found() {
    let library = standard_library();
    // A clamp holds the fender; the bars of the grille are as wide as the tubes that it hangs on.
    for (kind, seed) in [(PartKind::Fender, 5_800_519), (PartKind::Grille, 5_800_302)] {
        let subject = SimulatedObject::Part {
            kind,
            side: Side::Left,
            model_seed: 0,
        };
        let scene = scene_of(&CellSetup::booth(subject, seed));
        let inspection = inspected(&scene, &library, &Recipe::default());
        assert_eq!(
            inspection.reference(),
            Some(kind.name()),
            "{kind}, seed {seed}"
        );
        assert!(
            inspection
                .verdict
                .score()
                .is_some_and(|[score, _]| score > 0.7),
            "{:?}",
            inspection.verdict
        );
    }
}

#[test]
fn a_half_that_two_doors_share_is_accepted_as_neither() {
    let library = standard_library();
    // Regression: each was accepted as the other door, whose pose fits the half in sight slightly better.
    let halves = [
        (PartKind::FrontDoor, 17_800_500),
        (PartKind::FrontDoor, 17_800_596),
        (PartKind::BackDoor, 13_800_467),
    ];
    for (kind, seed) in halves {
        let subject = SimulatedObject::Part {
            kind,
            side: Side::Left,
            model_seed: 0,
        };
        let scene = scene_of(&CellSetup::booth(subject, seed));
        let verdict = inspected(&scene, &library, &Recipe::default()).verdict;
        assert!(
            matches!(verdict.rejected(), Some(Rejection::SmallMargin { .. })),
            "{kind}, seed {seed}: {verdict:?}"
        );
    }
}

#[test]
fn a_piece_is_found_whose_pose_first_stops_farther_along_the_sheet() {
    let library = standard_library();
    let subject = SimulatedObject::Part {
        kind: PartKind::Grille,
        side: Side::Left,
        model_seed: 0,
    };
    let scene = scene_of(&CellSetup::booth(subject, 15_800_198));
    let verdict = inspected(&scene, &library, &Recipe::default()).verdict;
    assert_eq!(verdict.guess(), Some("grille"));
    assert!(verdict.is_accepted(), "{verdict:?}");
}

#[test]
fn a_part_of_another_model_is_named_and_its_pose_is_marked_as_approximate() {
    let library = standard_library();
    let verdict_on = |model_seed: u64, kind: PartKind| {
        let setup = CellSetup::with_part(kind, Side::Left, model_seed, 51);
        let scene = scene_of(&setup);
        inspected(&scene, &library, &Recipe::default()).verdict
    };
    let mut num_marked = 0;
    for (kind, model_seed) in PartKind::ALL.into_iter().zip(7..) {
        let same = verdict_on(0, kind);
        assert!(same.is_accepted() && !same.is_approximate(), "{same:?}");
        let other = verdict_on(model_seed, kind);
        let is_named = matches!(&other, Verdict::Part { part, .. } if part == kind.name());
        assert!(is_named && !other.is_unknown(), "{other:?}");
        num_marked += usize::from(other.is_approximate());
    }
    // A model that differs only by millimetres cannot be told apart at this noise.
    assert!(num_marked >= 6, "{num_marked} of 8");
}

#[test]
fn a_part_half_out_of_the_picture_is_accepted_from_what_is_in_sight() {
    let library = standard_library();
    for (kind, right) in [
        (PartKind::FrontDoor, 0.55),
        (PartKind::BackDoor, -0.5),
        (PartKind::Fender, 0.5),
    ] {
        let mut setup = CellSetup::with_part(kind, Side::Left, 0, 71);
        let hung = Isometry3::translation(right, 0.05, 1.2);
        setup.pose = PartPose::Fixed(hung);
        let scene = scene_of(&setup);
        let inspection = inspected(&scene, &library, &Recipe::default());
        let is_named = matches!(
            &inspection.verdict,
            Verdict::Part { part, rejected: None, .. } if part == kind.name()
        );
        assert!(
            is_named && inspection.touches_edge(),
            "{kind}: {:?}",
            inspection.verdict
        );
        let pose = inspection.pose.expect("asked for").expect("found");
        let truth = hung * enrolment_pose().inverse();
        let middle = enrolment_pose() * Point3::origin();
        let off = pose_error(&pose.camera_from_part(), &truth, &middle);
        assert!(
            off.rotation.degrees() < 1.0 && off.shift.mm() < 10.0,
            "{kind}: {off:?}"
        );
    }
}

#[test]
fn the_half_of_a_bumper_that_is_not_enrolled_is_called_that() {
    let half = |aside: f64, seed: u64| {
        let mut setup = CellSetup::with_part(PartKind::FrontBumper, Side::Left, 0, seed);
        setup.pose = PartPose::Fixed(Isometry3::translation(aside, 0.0, 1.1));
        scene_of(&setup)
    };
    let about = PartDescription {
        name: PartName::new("front_bumper").expect("a name"),
        title: String::new(),
        notes: String::new(),
        from: "a capture".into(),
        at: jiff::Timestamp::UNIX_EPOCH,
        simulated: true,
    };
    let enrolled = enrol_captured(&half(0.62, 1), &about, &EnrolParams::default());
    let mut library = Library::default();
    library.references.push(enrolled.expect("a half").reference);
    let again = inspected(&half(0.6, 2), &library, &Recipe::default());
    assert!(again.verdict.is_accepted(), "{:?}", again.verdict);
    let other = |aside| inspected(&half(aside, 3), &library, &Recipe::default()).verdict;
    let verdict = other(-0.7);
    assert!(
        matches!(verdict.rejected(), Some(Rejection::OtherHalf { part, .. }) if part == "front_bumper"),
        "{verdict:?}"
    );
    // A strip in the middle is in both, and fits where it should not.
    let verdict = other(-0.62);
    assert!(!verdict.is_accepted(), "{verdict:?}");
}

#[test]
fn a_strip_without_readings_leaves_the_part_in_its_place() {
    let library = standard_library();
    let mut num_accepted = 0;
    for (kind, seed) in [
        (PartKind::FrontDoor, 3),
        (PartKind::TrunkLid, 4),
        (PartKind::Fender, 6),
    ] {
        let mut setup = CellSetup::with_part(kind, Side::Left, 0, seed);
        setup.pose = PartPose::Drawn(PoseRange::facing());
        let shot = frame(&setup);
        let camera_from_part = shot.truth.camera_from_part * enrolment_pose().inverse();
        // Towards the part's middle in the picture, from the side and from above.
        let middle = shot.truth.camera_from_part * Point3::origin();
        let pixel = setup.intrinsics.pixel_of(&middle);
        let pixel = <[f64; 2]>::from(pixel.expect("in the picture"));
        for across in 0..2 {
            let mut cut = shot.frame.clone();
            let width = cut.intrinsics.width;
            for (i, depth) in cut.depth.iter_mut().enumerate() {
                let at = [i % width, i / width][across] as f64;
                if (at - pixel[across] + 25.0).abs() < 6.5 {
                    *depth = 0;
                }
            }
            let inspection = inspected(&scene_from_frame(&cut), &library, &Recipe::default());
            let verdict = &inspection.verdict;
            let pose = inspection.found_pose().expect("a pose").camera_from_part();
            let off = pose_error(
                &pose,
                &camera_from_part,
                &(enrolment_pose() * Point3::origin()),
            );
            assert_eq!(verdict.guess(), Some(kind.name()), "{verdict:?}");
            assert!(
                off.rotation.degrees() < 0.6 && off.shift.mm() < 5.0,
                "{kind}: {off:?}"
            );
            num_accepted += usize::from(verdict.is_accepted());
        }
    }
    assert!(num_accepted >= 5, "{num_accepted} of 6");
}

#[test]
fn a_part_of_another_make_is_named_as_one_and_never_accepted() {
    let library = standard_library();
    let mut num_named = 0;
    for (kind, seed) in PartKind::ALL.into_iter().zip(81..) {
        let setup = CellSetup::with_part(kind, Side::Left, FIRST_OTHER_MAKE + seed, seed);
        let scene = scene_of(&setup);
        let verdict = inspected(&scene, &library, &Recipe::default()).verdict;
        assert!(!verdict.is_accepted(), "{kind}: {verdict:?}");
        num_named += usize::from(matches!(
            &verdict,
            Verdict::Part {
                part,
                rejected: Some(Rejection::AnotherMake { .. } | Rejection::AnotherModel { .. }),
                ..
            } if part == kind.name()
        ));
    }
    assert!(num_named >= 7, "{num_named} of 8");
}

#[test]
fn what_nobody_enrolled_is_unknown() {
    let library = standard_library();
    for (object, seed) in [
        (ObjectKind::Hood, 5),
        (ObjectKind::Board, 6),
        (ObjectKind::Box, 7),
    ] {
        let setup = CellSetup::new(SimulatedObject::Object(object), seed);
        let verdict = inspected(&scene_of(&setup), &library, &Recipe::default()).verdict;
        assert!(
            matches!(
                verdict,
                Verdict::Part {
                    rejected: Some(Rejection::Unknown { .. }),
                    ..
                }
            ),
            "{object:?}: {verdict:?}"
        );
    }
}

#[test]
fn a_part_behind_a_plank_among_clutter_and_noise_is_named() {
    let library = standard_library();
    for kind in [PartKind::FrontDoor, PartKind::TrunkLid, PartKind::Fender] {
        let mut setup = CellSetup::with_part(kind, Side::Left, 0, 23);
        setup.clutter = Clutter::InFront;
        setup.noise = SensorNoise {
            multiplier: 3.0,
            seed: 23,
        };
        let inspection = inspected(&scene_of(&setup), &library, &Recipe::default());
        let verdict = &inspection.verdict;
        assert!(
            matches!(verdict, Verdict::Part { part, .. } if part == kind.name()),
            "{kind}: {verdict:?}"
        );
        assert!(!verdict.is_unknown(), "{kind}: {verdict:?}");
    }
}

#[test]
fn a_second_reference_of_the_same_part_takes_nothing_from_its_margin() {
    let mut library = standard_library();
    let scene = door(0.3, [0.02, 0.0]);
    let margin = |library: &Library| {
        let verdict = inspected(&scene, library, &Recipe::default()).verdict;
        match verdict {
            Verdict::Part {
                part,
                margin,
                rejected: None,
                ..
            } if part == "front_door" => margin,
            other => panic!("{other:?}"),
        }
    };
    let alone = margin(&library);
    let again = library
        .references
        .iter()
        .find(|reference| reference.name == "front_door")
        .cloned();
    library.references.extend(again);
    assert!((margin(&library) - alone).abs() < 1e-9);
}

/// An object 1.5 m in front of the camera, turned about its axis.
fn turned_object(object: ObjectKind, turn: f64, seed: u64) -> SceneCloud {
    let mut setup = CellSetup::new(SimulatedObject::Object(object), seed);
    setup.pose = PartPose::Fixed(Isometry3::from_parts(
        Vector3::new(0.0, 0.0, 1.5).into(),
        UnitQuaternion::from_axis_angle(&Vector3::z_axis(), turn),
    ));
    scene_of(&setup)
}

/// A library that holds only this object, enrolled without a turn.
fn of_object(object: ObjectKind) -> Library {
    let about = PartDescription {
        name: PartName::new(object.name()).expect("a name"),
        title: String::new(),
        notes: String::new(),
        from: String::new(),
        at: jiff::Timestamp::UNIX_EPOCH,
        simulated: true,
    };
    let seen = turned_object(object, 0.0, 1);
    let enrolled = enrol_surface(&seen, 1, &about, &EnrolParams::default());
    Library {
        references: vec![enrolled.expect("a part").reference],
        ..Library::default()
    }
}

#[test]
fn a_part_that_looks_the_same_after_a_turn_has_an_ambiguous_pose_in_every_view() {
    for object in [ObjectKind::Box, ObjectKind::Wheel] {
        let library = of_object(object);
        let mut num_accepted = 0;
        for (seed, turn) in [0.0, 0.09, 1.57, 2.5, 3.1, 4.0].into_iter().enumerate() {
            let scene = turned_object(object, turn, 2 + seed as u64);
            let inspection = inspected(&scene, &library, &Recipe::default());
            if inspection.verdict.is_accepted() {
                num_accepted += 1;
                let pose = inspection.found_pose().expect("a pose");
                assert!(
                    pose.is_ambiguous(),
                    "{object:?} at {turn}: {:?}",
                    pose.runner_up
                );
            }
        }
        assert!(num_accepted >= 3, "{object:?}: {num_accepted}");
    }
}
