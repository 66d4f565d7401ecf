//! Properties of real cameras: high resolution, lens distortion, images with left and right exchanged.

use files::{FileContent, depth_png::write_depth_png, open};
use geometry::{
    depth_frame::{DepthFrame, Intrinsics},
    distortion::Distortion,
    rigid::{RigidTransform, pose_error},
};
use inspection::{
    fixtures::standard_library,
    library::enrolment_pose,
    pipeline::{Inspection, MirrorTally, Recipe, Rejection, Verdict},
};
use nalgebra::{Isometry3, Point3, UnitQuaternion, Vector3};
use simulate::{CellSetup, PartKind, PartPose, SensorNoise, Side, frame};
use stages::scene::scene_from_frame;

use super::inspected;

/// Pose of the part in these tests.
fn hung() -> RigidTransform {
    Isometry3::from_parts(
        Vector3::new(0.04, -0.03, 1.6).into(),
        UnitQuaternion::from_euler_angles(0.15, -0.25, 0.4),
    )
}

fn seen_by(camera: Intrinsics, kind: PartKind, side: Side) -> DepthFrame {
    let mut setup = CellSetup::with_part(kind, side, 0, 11);
    setup.pose = PartPose::Fixed(hung());
    setup.noise = SensorNoise::kinect(11);
    setup.intrinsics = camera;
    frame(&setup).frame
}

/// Error of the pose: millimetres and degrees.
fn off(inspection: &Inspection) -> [f64; 2] {
    let pose = inspection.pose.as_ref().expect("asked for").as_ref();
    let truth = hung() * enrolment_pose().inverse();
    let at = enrolment_pose() * Point3::origin();
    let error = pose_error(&pose.expect("a pose").camera_from_part(), &truth, &at);
    [error.shift.mm(), error.rotation.degrees()]
}

#[test]
fn a_picture_of_five_million_pixels_gives_the_verdict_and_the_pose_of_a_small_one() {
    let library = standard_library();
    let fine = Intrinsics {
        width: 2560,
        height: 1920,
        fx: 2100.0,
        fy: 2100.0,
        cx: 1279.5,
        cy: 959.5,
        distortion: Distortion::NONE,
    };
    for kind in [PartKind::FrontDoor, PartKind::Grille] {
        let [small, large] = [Intrinsics::KINECT, fine].map(|camera| {
            let scene = scene_from_frame(&seen_by(camera, kind, Side::Left));
            assert_eq!(scene.cloud.points.len(), 640 * 480);
            inspected(&scene, &library, &Recipe::default())
        });
        for inspection in [&small, &large] {
            assert!(inspection.verdict.is_accepted(), "{:?}", inspection.verdict);
            assert_eq!(inspection.reference(), Some(kind.name()));
            let [mm, degrees] = off(inspection);
            assert!(mm < 4.0 && degrees < 0.4, "{kind}: {mm} mm, {degrees}°");
        }
    }
}

/// The frame of a camera with a lens, made from that of a pinhole camera in its place: the reading nearest to each
/// ray.
fn through_lens(pinhole: &DepthFrame, lens: Intrinsics) -> DepthFrame {
    let seen = |i: usize| {
        let ray = lens.point_at((i % lens.width) as f64, (i / lens.width) as f64, 1.0);
        let (u, v) = pinhole.intrinsics.pixel_of(&ray)?;
        let (u, v) = (u.round() as usize, v.round() as usize);
        pinhole.depth.get(v * pinhole.intrinsics.width + u).copied()
    };
    DepthFrame {
        intrinsics: lens,
        depth: (0..lens.width * lens.height)
            .map(|i| seen(i).unwrap_or(0))
            .collect(),
        ..pinhole.clone()
    }
}

#[test]
fn behind_a_lens_the_pose_is_as_good_as_without_one() {
    let library = standard_library();
    let wide = Intrinsics {
        width: 1400,
        height: 1100,
        fx: 700.0,
        fy: 700.0,
        cx: 699.5,
        cy: 549.5,
        distortion: Distortion::NONE,
    };
    let lens = Intrinsics {
        distortion: Distortion {
            k1: -0.2,
            k2: 0.04,
            p1: 0.002,
            p2: -0.001,
            ..Distortion::NONE
        },
        ..Intrinsics::KINECT
    };
    let frame = through_lens(&seen_by(wide, PartKind::FrontDoor, Side::Left), lens);
    let found = inspected(&scene_from_frame(&frame), &library, &Recipe::default());
    assert!(found.verdict.is_accepted(), "{:?}", found.verdict);
    let [mm, degrees] = off(&found);
    assert!(mm < 4.0 && degrees < 0.4, "{mm} mm, {degrees}°");
    // Read as a pinhole camera's frame, the part is bent.
    let bent = DepthFrame {
        intrinsics: Intrinsics::KINECT,
        ..frame
    };
    let found = inspected(&scene_from_frame(&bent), &library, &Recipe::default());
    assert!(!found.verdict.is_accepted(), "{:?}", found.verdict);
}

fn mirrored(mut frame: DepthFrame) -> DepthFrame {
    frame
        .depth
        .chunks_mut(frame.intrinsics.width)
        .for_each(<[u16]>::reverse);
    frame
}

fn rejection(frame: &DepthFrame) -> Verdict {
    inspected(
        &scene_from_frame(frame),
        &standard_library(),
        &Recipe::default(),
    )
    .verdict
}

#[test]
fn a_mirrored_image_is_named_where_no_part_of_another_side_can_be() {
    // The one of the shipped parts that a car has once and that is not quite symmetric.
    let frame = seen_by(Intrinsics::KINECT, PartKind::BackBumper, Side::Left);
    assert!(rejection(&frame).is_accepted());
    match rejection(&mirrored(frame)) {
        Verdict::Part {
            rejected: Some(Rejection::MirroredImage { part, .. }),
            ..
        } => assert_eq!(part, "back_bumper"),
        other => panic!("{other:?}"),
    }
}

#[test]
fn parts_of_several_names_that_are_all_mirrored_raise_a_suspicion() {
    let mut tally = MirrorTally::default();
    for kind in [PartKind::FrontDoor, PartKind::Fender] {
        let frame = mirrored(seen_by(Intrinsics::KINECT, kind, Side::Left));
        tally.add(&rejection(&frame));
    }
    let suspicion = tally.suspicion().expect("both fit only in a mirror");
    assert_eq!(suspicion.parts, ["fender", "front_door"]);
    tally.add(&rejection(&seen_by(
        Intrinsics::KINECT,
        PartKind::TrunkLid,
        Side::Left,
    )));
    assert_eq!(tally.suspicion(), None);
}

#[test]
fn a_file_that_says_its_image_is_mirrored_gives_the_frame_that_the_camera_saw() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("stored.png");
    let mut camera = Intrinsics::KINECT;
    (camera.cx, camera.distortion.p2) = (300.0, 0.001);
    let frame = DepthFrame {
        intrinsics: camera,
        ..seen_by(Intrinsics::KINECT, PartKind::Fender, Side::Left)
    };
    let stored = DepthFrame {
        intrinsics: camera.mirrored(),
        ..mirrored(frame.clone())
    };
    write_depth_png(&path, &stored).expect("written");
    assert_eq!(open(&path).expect("opened"), FileContent::Depth(stored));
    let json = path.with_extension("json");
    let text = std::fs::read_to_string(&json).expect("the camera");
    let flagged = text.replacen('{', "{\"mirrored\": true,", 1);
    std::fs::write(&json, flagged).expect("written");
    assert_eq!(open(&path).expect("opened"), FileContent::Depth(frame));
}
