//! Simulated scans, compared with the truth.

use std::f64::consts::{PI, TAU};

use nalgebra::{Isometry3, Point3, Translation3, UnitQuaternion, Vector3};

use super::{
    part::{background_sign, require_two_to_show_part},
    *,
};
use crate::scene::scene_from_frame;
use geometry::{
    depth_frame::{DepthFrame, Intrinsics},
    mesh::TriangleMesh,
    nearest::KdTree,
    rigid::pose_error,
    units::Radians,
};
use simulate::{
    CellSetup, PartKind, PartPose, ScanSetup, SensorNoise, Side, SimulatedObject, SimulatedScan,
    SurfaceLabel, frame_of_mesh,
};

fn simulated(kind: PartKind, num_shots: usize, seed: u64) -> SimulatedScan {
    SimulatedScan::new(ScanSetup {
        subject: SimulatedObject::Part {
            kind,
            side: Side::Left,
            model_seed: 0,
        },
        num_shots,
        place_error: Metres::from_mm(3.0),
        turn_error: Radians::from_degrees(0.3),
        noise: 1.0,
        seed,
    })
}

fn shots_of(scan: &SimulatedScan) -> (Vec<Shot>, Vec<RigidTransform>) {
    let simulated = scan.shots();
    let truth = simulated.iter().map(|shot| shot.base_from_camera).collect();
    let shots = simulated.iter().enumerate().map(|(k, shot)| Shot {
        name: format!("shot {k}"),
        scene: Arc::new(scene_from_frame(&shot.frame)),
        base_from_camera: shot.given,
    });
    (shots.collect(), truth)
}

/// An observer that has cancelled.
struct Impatient;

impl ScanObserver for Impatient {
    fn is_cancelled(&self) -> bool {
        true
    }
}

fn put_together(shots: &[Shot]) -> Scan {
    assemble(shots, &ScanParams::default(), &Unwatched).expect("a scan")
}

/// The mean pose error over the shots: an error that all cameras share cannot be seen.
fn shared_error(scan: &Scan, truth: &[RigidTransform]) -> RigidTransform {
    let used = || {
        scan.used()
            .map(|(k, shot)| shot.base_from_camera * truth[k].inverse())
    };
    let n = used().count() as f64;
    let middle = Point3::new(1.9, 0.0, 1.1);
    let turn = used().fold(Vector3::zeros(), |sum, e| sum + e.rotation.scaled_axis()) / n;
    let turn = UnitQuaternion::from_scaled_axis(turn);
    let shift = used().fold(Vector3::zeros(), |sum, e| sum + (e * middle - middle)) / n;
    Isometry3::from_parts(
        Translation3::from(middle.coords + shift - turn * middle.coords),
        turn,
    )
}

#[test]
fn poses_that_are_off_are_recovered() {
    // Root mean square and largest error, millimetres. Few readings of a grille have neighbours all around; the floor and the
    // boxes, further away, constrain the poses there.
    for (kind, seed, rms_mm, most_mm) in [
        (PartKind::Fender, 1, 1.0, 1.5),
        (PartKind::FrontDoor, 2, 1.0, 1.5),
        (PartKind::Grille, 3, 1.5, 2.5),
    ] {
        let (shots, truth) = shots_of(&simulated(kind, 6, seed));
        let scan = put_together(&shots);
        let shared = shared_error(&scan, &truth);
        let mut sum_sq = 0.0;
        for (k, shot) in scan.used() {
            let expected = shared * truth[k];
            let middle = Point3::new(0.0, 0.0, 1.35);
            let error = pose_error(&shot.base_from_camera, &expected, &middle);
            assert!(
                error.shift.mm() < most_mm && error.rotation.degrees() < 0.1,
                "{kind:?} {}: {} and {}",
                shot.name,
                error.shift,
                error.rotation
            );
            sum_sq += error.shift.mm().powi(2);
        }
        assert!((sum_sq / 6.0).sqrt() < rms_mm, "{kind:?}: {sum_sq}");
        assert_eq!(scan.used().count(), 6);
        assert_eq!(scan.doubt, None, "{kind:?}");
        let rms = |overlap: Option<Overlap>| overlap.expect("an overlap").rms.mm();
        assert!(rms(scan.after.all) < rms(scan.before.all));
    }
}

#[test]
fn a_shot_whose_pose_is_wrong_is_named_and_left_out() {
    let (right, _) = shots_of(&simulated(PartKind::Fender, 5, 5));
    for shift in [[0.05, 0.0, 0.0], [0.0, 0.05, 0.0], [0.0, 0.0, -0.05]] {
        let mut shots = right.clone();
        shots[2].base_from_camera.translation.vector += Vector3::from(shift);
        let scan = put_together(&shots);
        let excluded: Vec<usize> = (0..5)
            .filter(|&k| scan.shots[k].excluded.is_some())
            .collect();
        assert_eq!(excluded, [2], "{shift:?}: {:?}", scan.shots[2].moved);
        // None of its readings is in the cloud.
        assert!(scan.cloud.seen_by.iter().all(|mask| mask & 4 == 0));
    }
}

/// Asserts that a scan is refused because its frames contradict one another.
fn assert_contradictory(shots: &[Shot]) {
    use geometry::error::Advice as _;

    let found = assemble(shots, &ScanParams::default(), &Unwatched);
    let Err(refused) = found else {
        let fates = found.expect("a scan").shots.into_iter();
        panic!(
            "{:?}",
            fates.map(|s| (s.moved, s.excluded)).collect::<Vec<_>>()
        );
    };
    let advice = refused.advice();
    assert!(
        advice.contains("each pose belongs to its frame"),
        "{refused}"
    );
}

#[test]
fn of_two_halves_that_contradict_each_other_neither_is_used() {
    let (right, _) = shots_of(&simulated(PartKind::Fender, 4, 5));
    for shift in [[0.0, 0.06, 0.0], [-0.06, 0.0, 0.0]] {
        let mut shots = right.clone();
        for shot in shots.iter_mut().step_by(2) {
            shot.base_from_camera.translation.vector += Vector3::from(shift);
        }
        assert_contradictory(&shots);
    }
}

#[test]
fn shots_of_two_parts_half_of_each_are_no_scan() {
    let (mut shots, _) = shots_of(&simulated(PartKind::FrontDoor, 4, 8));
    let (others, _) = shots_of(&simulated(PartKind::TrunkLid, 4, 8));
    for k in [1, 3] {
        shots[k] = others[k].clone();
    }
    assert_contradictory(&shots);
}

#[test]
fn a_drift_of_the_poses_is_how_much_they_disagree() {
    let simulated = simulated(PartKind::FrontDoor, 4, 9);
    let (mut shots, truth) = shots_of(&simulated);
    for (k, (shot, truth)) in shots.iter_mut().zip(&truth).enumerate() {
        shot.base_from_camera = Translation3::new(0.0, 0.0, 0.01 * k as f64) * truth;
    }
    let scan = put_together(&shots);
    assert_eq!(scan.used().count(), 4);
    let middle = scan.cloud.middle_of_part().expect("a part");
    // The first is 15 mm off the mean of 0, 10, 20 and 30 mm.
    let found = scan.disagreement(&middle);
    assert!((13.0..17.0).contains(&found.shift.mm()), "{found:?}");
    let Some(Doubt::PosesApart { names, apart }) = scan.doubt else {
        panic!("{:?}", scan.doubt);
    };
    assert_eq!(names, ["shot 0", "shot 3"]);
    assert!((22.0..31.0).contains(&apart.mm()), "{apart}");
}

/// A frame of a flat plate before a wall and beside a flat pillar, taken from `at` along the wall.
fn plate_from(at: f64) -> Shot {
    let camera = Intrinsics::KINECT;
    let depth = (0..camera.width * camera.height).map(|i| {
        let (u, v) = ((i % camera.width) as f64, (i / camera.width) as f64);
        let seen = |z: f64| camera.point_at(u, v, z) + Vector3::x() * at;
        let (plate, pillar) = (seen(1.0), seen(0.9));
        if plate.x.abs() < 0.3 && plate.y.abs() < 0.25 {
            10_000
        } else if pillar.x < -0.55 {
            9_000
        } else {
            19_000
        }
    });
    let frame = DepthFrame {
        intrinsics: camera,
        metres_per_unit: 0.0001,
        depth: depth.collect(),
        is_simulated: true,
    };
    Shot {
        name: format!("from {at}"),
        scene: Arc::new(scene_from_frame(&frame)),
        base_from_camera: Isometry3::translation(at, 0.0, 0.0),
    }
}

#[test]
fn a_pose_that_slides_a_flat_part_along_itself_is_found() {
    let mut shots = [0.0, 0.15, 0.3].map(plate_from);
    assert_eq!(put_together(&shots).doubt, None);
    let near_8_cm = |found: Metres| (55.0..105.0).contains(&found.mm());
    shots[1].base_from_camera.translation.vector.y += 0.08;
    // Of two shots, either may be wrong.
    let refused = assemble(&shots[..2], &ScanParams::default(), &Unwatched).expect_err("a tie");
    let ScanError::Contradiction { names, apart, .. } = refused else {
        panic!("{refused}");
    };
    assert_eq!(names, ["from 0", "from 0.15"]);
    assert!(apart.is_some_and(near_8_cm), "{apart:?}");
    // A third tells which.
    let scan = put_together(&shots);
    let why = scan.shots.iter().map(|shot| shot.excluded);
    let why: Vec<Option<Excluded>> = why.collect();
    let [None, Some(Excluded::WrongPose { moved }), None] = why[..] else {
        panic!("{why:?}");
    };
    assert!(near_8_cm(moved.shift), "{moved:?}");
    assert_eq!(scan.doubt, None);
}

#[test]
fn a_shot_that_takes_background_for_the_part_is_outvoted() {
    // From the left, the pillar is larger than the plate, but the view cuts it off on three sides.
    let (good, poor, poorer) = (plate_from(0.2), plate_from(-0.45), plate_from(-0.5));
    let scan = put_together(&[good, poor.clone()]);
    assert_eq!(
        scan.shots
            .iter()
            .map(|shot| shot.finds_part)
            .collect::<Vec<_>>(),
        [true, false]
    );
    let part = scan.cloud.part();
    assert!(part.cloud.points.len() > 5000);
    assert!(
        part.cloud
            .points
            .iter()
            .all(|p| p.x.abs() < 0.35 && p.z < 1.1)
    );
    assert_eq!(background_sign(&scan), None);
    // Where no shot knows better, enrolling is refused.
    let scan = put_together(&[poor, poorer]);
    assert!(background_sign(&scan).is_some());
}

#[test]
fn a_part_that_one_shot_alone_shows_is_not_inspected_as_a_scan() {
    let scan = put_together(&[plate_from(0.2), plate_from(1.4)]);
    let refused = require_two_to_show_part(&scan).expect_err("one");
    let name = "from 0.2".into();
    assert_eq!(refused, ScanError::PartInOneFrame { found: 2, name });
    let both = put_together(&[plate_from(0.2), plate_from(0.3)]);
    assert_eq!(require_two_to_show_part(&both), Ok(()));
}

#[test]
fn a_shot_that_overlaps_no_other_is_left_out() {
    let (mut shots, _) = shots_of(&simulated(PartKind::Fender, 4, 12));
    shots[1].base_from_camera.translation.vector.z += 10.0;
    let scan = put_together(&shots);
    let why = scan.shots.iter().map(|shot| shot.excluded);
    let expected = [None, Some(Excluded::OverlapsNone), None, None];
    assert_eq!(why.collect::<Vec<_>>(), expected);
    let refused = assemble(&shots[..2], &ScanParams::default(), &Unwatched);
    let refused = refused.expect_err("no overlap");
    assert!(matches!(
        refused,
        ScanError::NothingOverlaps { found: 2, .. }
    ));
}

#[test]
fn inverted_poses_are_recognised() {
    for num in [2, 4] {
        let (mut shots, _) = shots_of(&simulated(PartKind::Fender, num, 13));
        for shot in &mut shots {
            shot.base_from_camera = shot.base_from_camera.inverse();
        }
        let refused = assemble(&shots, &ScanParams::default(), &Unwatched);
        assert_eq!(refused.expect_err("inverted"), ScanError::PosesInverted);
    }
}

#[test]
fn a_shot_of_the_part_at_another_place_is_left_out() {
    let simulated = simulated(PartKind::FrontDoor, 5, 11);
    let (mut shots, _) = shots_of(&simulated);
    let elsewhere = Translation3::new(-0.06, 0.05, 0.0) * simulated.base_from_model;
    let moved = simulated.shot(3, &elsewhere);
    shots[3].scene = Arc::new(scene_from_frame(&moved.frame));
    let scan = put_together(&shots);
    let excluded: Vec<usize> = (0..5)
        .filter(|&k| scan.shots[k].excluded.is_some())
        .collect();
    assert_eq!(excluded, [3]);
    let Some(Excluded::PartMoved { share }) = scan.shots[3].excluded else {
        panic!("the part moved: {:?}", scan.shots[3].excluded);
    };
    assert!(share < 0.6, "{share}");
}

#[test]
fn the_fused_part_is_the_part() {
    let simulated = simulated(PartKind::Fender, 6, 21);
    let (mut shots, truth) = shots_of(&simulated);
    for (shot, truth) in shots.iter_mut().zip(&truth) {
        shot.base_from_camera = *truth;
    }
    let scan = put_together(&shots);
    let surface = simulated
        .part()
        .sample_evenly(40_000, 1)
        .expect("a surface");
    let in_base = surface
        .points
        .iter()
        .map(|p| (simulated.base_from_model * p.cast::<f64>()).cast());
    let in_base: Vec<Point3<f32>> = in_base.collect();
    let tree = KdTree::new(&in_base);
    let part = scan.cloud.part();
    let distances = part.cloud.points.iter().map(|p| {
        let nearest = tree.nearest(p, f32::INFINITY).expect("a surface");
        f64::from(nearest.distance_sq).sqrt()
    });
    let distances: Vec<f64> = distances.collect();
    let off = distances.iter().filter(|d| **d > 0.012).count() as f64 / distances.len() as f64;
    assert!(off < 0.01, "{off} of the part's points lie off the part");
    // The share that the cameras in front see: most of one face.
    let fused = KdTree::new(&part.cloud.points);
    let found = in_base
        .iter()
        .filter(|p| fused.nearest(p, 1e-4).is_some())
        .count();
    let share = found as f64 / in_base.len() as f64;
    assert!(share > 0.85, "{share} of the part is in the cloud");
    let by_many = part
        .seen_by
        .iter()
        .filter(|mask| mask.count_ones() >= 2)
        .count();
    assert!(by_many as f64 > 0.8 * part.seen_by.len() as f64);
}

#[test]
fn any_number_of_threads_gives_the_same_scan() {
    let (shots, _) = shots_of(&simulated(PartKind::TrunkLid, 4, 31));
    let by = |num_workers: usize| {
        let mut params = ScanParams::default();
        params.register.num_workers = num_workers;
        let scan = assemble(&shots, &params, &Unwatched).expect("a scan");
        let poses: Vec<RigidTransform> = scan.shots.iter().map(|s| s.base_from_camera).collect();
        (scan.cloud, poses)
    };
    assert!(by(1) == by(3));
}

#[test]
fn what_is_no_scan_is_refused_in_words() {
    use geometry::error::Advice as _;

    let (shots, _) = shots_of(&simulated(PartKind::Fender, 2, 41));
    let refused = |shots: &[Shot]| {
        let error = assemble(shots, &ScanParams::default(), &Unwatched).expect_err("no scan");
        assert!(!error.advice().is_empty());
        error
    };
    assert_eq!(refused(&shots[..1]), ScanError::TooFewShots { found: 1 });
    let many: Vec<Shot> = (0..65).map(|_| shots[0].clone()).collect();
    assert_eq!(refused(&many), ScanError::TooManyShots { found: 65 });
    let mut blind = shots.clone();
    blind[1].scene = Arc::default();
    assert!(matches!(
        refused(&blind),
        ScanError::TooFewReadings { found: 0, .. }
    ));
    let mut unorganised = shots.clone();
    let mut scene = SceneCloud::clone(&shots[1].scene);
    scene.cloud.grid = None;
    unorganised[1].scene = Arc::new(scene);
    assert!(matches!(refused(&unorganised), ScanError::NoPicture { .. }));
    let mut apart = shots.clone();
    apart[1].base_from_camera.translation.vector.z += 0.3;
    assert!(matches!(refused(&apart), ScanError::NothingAgrees { .. }));

    let cancelled = assemble(&shots, &ScanParams::default(), &Impatient);
    assert_eq!(cancelled.expect_err("cancelled"), ScanError::Cancelled);
}

/// Frames from all around of a box of 0.8 by 0.5 m and this thickness that hangs in free space, with the cameras' true poses.
fn all_around(thickness: f64, num: usize, seed: u64) -> Vec<Shot> {
    let half = [0.4, 0.25, 0.5 * thickness];
    let corner = |i: usize| {
        let at = |axis: usize| half[axis] * if i >> axis & 1 == 1 { 1.0 } else { -1.0 };
        Point3::new(at(0), at(1), at(2)).cast::<f32>()
    };
    let quads = [
        [0, 2, 3, 1],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 4, 6, 2],
        [1, 3, 7, 5],
    ];
    let mesh = TriangleMesh {
        vertices: (0..8).map(corner).collect(),
        triangles: quads
            .iter()
            .flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]])
            .collect(),
    };
    let shots = (0..num).map(|k| {
        let yaw = TAU * (k as f64 + 0.5) / num as f64;
        let up = if k % 2 == 0 { -0.35 } else { 0.35 };
        let eye = Point3::new(1.3 * yaw.sin(), up, -1.3 * yaw.cos());
        let base_from_camera = Isometry3::look_at_rh(&eye, &Point3::origin(), &Vector3::y())
            .inverse()
            * UnitQuaternion::from_axis_angle(&Vector3::x_axis(), PI);
        let setup = CellSetup {
            pose: PartPose::Fixed(base_from_camera.inverse()),
            noise: SensorNoise::kinect(seed * 100 + k as u64),
            ..CellSetup::new(SimulatedObject::Nothing, seed)
        };
        let mut taken = frame_of_mesh(&setup, &mesh);
        for (depth, label) in taken.frame.depth.iter_mut().zip(&taken.truth.labels) {
            if *label != SurfaceLabel::Part {
                *depth = 0;
            }
        }
        Shot {
            name: format!("shot {k}"),
            scene: Arc::new(scene_from_frame(&taken.frame)),
            base_from_camera,
        }
    });
    shots.collect()
}

#[test]
fn the_two_faces_of_a_sheet_keep_their_distance() {
    for (thickness, seed) in [(0.03, 2), (0.1, 3)] {
        let shots = all_around(thickness, 8, seed);
        let scan = put_together(&shots);
        let moved = |is_front: bool| {
            let faces = scan
                .used()
                .filter(|(k, _)| [0, 1, 6, 7].contains(k) == is_front);
            let depths = faces.map(|(k, shot)| {
                let given_from_camera = shots[k].base_from_camera;
                (shot.base_from_camera * given_from_camera.inverse() * Point3::origin()).z
            });
            depths.sum::<f64>() / 4.0
        };
        assert_eq!(scan.used().count(), 8);
        let apart = Metres(moved(true) - moved(false));
        assert!(apart.mm().abs() < 1.0, "{thickness}: {apart}");
    }
    // Of a thin one no frame shows the rim: nothing tells how far one face is from the other.
    let thin = assemble(&all_around(0.005, 8, 1), &ScanParams::default(), &Unwatched);
    let Err(ScanError::Apart { these, others }) = thin else {
        panic!("{thin:?}");
    };
    assert_eq!((these.len(), others.len()), (4, 4));
}
