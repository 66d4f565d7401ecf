use jiff::Timestamp;
use nalgebra::Unit;

use super::*;
use crate::{
    Convention, RobotFrame,
    paint::{Coat, PaintSurface, Pattern, plan},
    parse_written_pose,
};
use geometry::{error::Advice as _, fixtures::moved, rigid::from_euler_zyx};
use inspection::fixtures::shipped_library;
use stages::{fixtures::plate, reference::Coverage};

fn seen_at(pose: &RigidTransform) -> PointCloud {
    moved(&plate().cloud, pose)
}

fn before(x: f64, y: f64, distance: f64) -> PathPoint {
    PathPoint {
        nozzle: Point3::new(x, y, 1.2 - distance),
        direction: Vector3::z_axis(),
        stand_off: None,
        is_gun_on: true,
        speed: None,
        fan: None,
    }
}

fn path() -> SprayPath {
    let rows = [-0.2, 0.0, 0.2]
        .into_iter()
        .flat_map(|y| (0..9).map(move |i| before(0.09 * f64::from(i) - 0.36, y, 0.15)));
    SprayPath::new(rows.collect()).expect("points")
}

fn pose() -> RigidTransform {
    from_euler_zyx([0.1, -0.2, 0.3, 0.05, -0.04, 0.1])
}

#[test]
fn a_carried_path_keeps_its_distance_to_the_part() {
    let pose = pose();
    let carried = carry(&path(), &pose, &seen_at(&pose), &StandOffParams::default());
    assert_eq!(carried.num_inside(), carried.points.len());
    for (point, taught) in carried.points.iter().zip(path().points()) {
        let met = point.meets.expect("a surface");
        assert!((met.distance.mm() - 150.0).abs() < 0.5, "{met:?}");
        assert!(met.tilt.degrees() < 1.0, "{met:?}");
        let mouth: Point3<f64> = point.camera_from_nozzle.translation.vector.into();
        assert!((mouth - pose * taught.nozzle).norm() < 1e-12);
        let along = point.camera_from_nozzle * Vector3::z();
        assert!((along - pose * taught.direction.into_inner()).norm() < 1e-12);
    }
}

#[test]
fn a_part_that_is_elsewhere_than_its_pose_says_is_noticed() {
    let params = StandOffParams::default();
    for (z, tilt, expected) in [
        (0.049, 0.0, BandStatus::Inside),
        (0.051, 0.0, BandStatus::TooFar),
        (-0.049, 0.0, BandStatus::Inside),
        (-0.051, 0.0, BandStatus::TooNear),
        (-0.20, 0.0, BandStatus::TooNear),
        (0.0, 0.51, BandStatus::Inside),
        (0.0, 0.56, BandStatus::TooFlat),
    ] {
        let middle = Translation3::new(0.0, 0.0, 1.2);
        let turn = UnitQuaternion::from_axis_angle(&Vector3::y_axis(), tilt);
        let truly = Translation3::new(0.0, 0.0, z) * middle * turn * middle.inverse();
        let path = SprayPath::new(vec![before(0.0, 0.0, 0.15)]).expect("a point");
        let carried = carry(
            &path,
            &RigidTransform::identity(),
            &seen_at(&truly),
            &params,
        );
        assert_eq!(carried.points[0].band, expected, "{z} {tilt}: {carried:?}");
    }
    let path = SprayPath::new(vec![before(0.6, 0.0, 0.15)]).expect("a point");
    let past = carry(&path, &pose(), &seen_at(&pose()), &params);
    assert_eq!(past.points[0].band, BandStatus::NotSeen);
    assert_eq!(past.num_inside(), 0);
}

#[test]
fn a_path_in_another_frame_lies_off_the_reference() {
    let params = StandOffParams::default();
    let inside = |path: &SprayPath| {
        let bands = against_reference(path, &plate(), &params);
        bands
            .iter()
            .filter(|band| **band == BandStatus::Inside)
            .count()
    };
    assert_eq!(inside(&path()), 27);
    let path = path();
    let moved = path.points().iter().map(|point| PathPoint {
        nozzle: point.nozzle + Vector3::new(0.0, 0.0, -1.2),
        ..*point
    });
    assert_eq!(inside(&SprayPath::new(moved.collect()).expect("points")), 0);
}

#[test]
fn a_planned_path_aims_at_its_part_and_one_of_another_part_or_frame_does_not() {
    let library = shipped_library();
    let part = |name: &str| {
        let mut references = library.references.iter();
        let found = references.find(|reference| reference.name.as_str() == name);
        found.expect("shipped")
    };
    let planned = |name: &str, coat: &Coat| {
        let surface = PaintSurface::of(part(name), Coverage::OneSide, None).expect("a surface");
        plan(&surface, coat, &[]).expect("planned")
    };
    // Of the shipped parts, these have the fewest points that aim at them: far beyond the edges, along the outlines of
    // openings, and over bars.
    let coat = Coat::default();
    let beyond = Coat {
        overrun: 0.4,
        ..coat
    };
    let rings = Coat {
        pattern: Pattern::Contour,
        ..coat
    };
    for (name, coat) in [
        ("fender", beyond),
        ("grille", rings),
        ("radiator_support", coat),
    ] {
        let path = planned(name, &coat);
        assert_eq!(off_the_part(&path, part(name)), None, "{name}");
    }
    let of_grille = off_the_part(&planned("grille", &coat), part("front_door"));
    let of_grille = of_grille.expect("the path of another part");
    assert!(
        2 * of_grille.num_aiming < of_grille.num_spraying,
        "{of_grille}"
    );
    let fender = planned("fender", &coat);
    let shifted = |by: [f64; 3], knows_stand_off: bool| {
        let points = fender.points().iter().map(|point| PathPoint {
            nozzle: point.nozzle + Vector3::from(by),
            stand_off: point.stand_off.filter(|_| knows_stand_off),
            ..*point
        });
        let path = SprayPath::new(points.collect()).expect("points");
        off_the_part(&path, part("fender"))
    };
    for by in [[5.0, 5.0, 9.0], [1.5, 0.0, 0.0], [0.0, 0.0, -0.2]] {
        assert!(shifted(by, true).is_some(), "{by:?}");
    }
    // Another model, and a gun that sprays from farther away.
    assert_eq!(shifted([0.0, 0.0, -0.03], true), None);
    assert_eq!(shifted([0.0, 0.0, -0.2], false), None);
}

#[test]
fn a_path_on_the_surface_or_behind_it_is_refused_with_any_stand_off() {
    let at = |distance: f64, stand_off: Option<f64>| {
        let points = (0..9).map(|i| PathPoint {
            stand_off: stand_off.map(Metres),
            ..before(0.09 * f64::from(i) - 0.36, 0.0, distance)
        });
        let path = SprayPath::new(points.collect()).expect("points");
        off_the_part(&path, &plate())
    };
    for (distance, stand_off, is_refused) in [
        (0.15, None, false),
        (0.03, None, false),
        (0.01, None, true),
        // Points of the surface in place of the nozzle, and 35 mm farther.
        (0.0, None, true),
        (-0.035, None, true),
        (0.0, Some(0.15), true),
        (0.03, Some(0.03), false),
        (0.07, Some(0.03), false),
        (0.005, Some(0.03), true),
        (-0.015, Some(0.03), true),
    ] {
        let off = at(distance, stand_off);
        assert_eq!(off.is_some(), is_refused, "{distance} {stand_off:?}");
        let Some(off) = off else { continue };
        assert_eq!((off.num_aiming, off.num_too_near), (0, 9), "{off}");
        let wanted = "at 9 of 9 points with the gun on, the nozzle is less than 20 mm in front";
        assert!(off.to_string().contains(wanted), "{off}");
        assert!(off.advice().contains("nozzle_x_mm"), "{}", off.advice());
    }
    // A single such point may be at a fold or an edge.
    let mut points: Vec<PathPoint> = (0..40)
        .map(|i| before(0.018 * f64::from(i) - 0.36, 0.0, 0.15))
        .collect();
    points[7] = before(-0.2, 0.0, 0.01);
    let path = SprayPath::new(points).expect("points");
    assert_eq!(off_the_part(&path, &plate()), None);
}

#[test]
fn a_part_without_a_path_is_begun_before_its_middle() {
    let path = default_path(&plate(), &StandOffParams::default()).expect("normals");
    let [start] = path.points() else {
        panic!("one start");
    };
    assert!((start.nozzle - Point3::new(0.0, 0.0, 1.05)).norm() < 0.01);
    assert!((start.direction.into_inner() - Vector3::z()).norm() < 1e-6);
    let mut flat = plate();
    std::sync::Arc::make_mut(&mut flat.cloud).normals = None;
    assert_eq!(default_path(&flat, &StandOffParams::default()), None);
}

#[test]
fn the_tools_frame_is_right_handed_and_turns_with_the_part() {
    for direction in [
        Vector3::z(),
        Vector3::new(0.3, -0.5, 0.8),
        Vector3::x(),
        -Vector3::x(),
        Vector3::new(0.99, 0.05, 0.1),
    ] {
        let point = PathPoint {
            nozzle: Point3::new(0.1, 0.2, 0.3),
            direction: Unit::new_normalize(direction),
            stand_off: None,
            is_gun_on: true,
            speed: None,
            fan: None,
        };
        let frame = tool_frame(&point);
        let matrix = frame.rotation.to_rotation_matrix().into_inner();
        assert!((matrix.determinant() - 1.0).abs() < 1e-9);
        assert!((frame * Vector3::z() - point.direction.into_inner()).norm() < 1e-9);
    }
    for fan in [Vector3::new(0.6, 0.8, 0.0), -Vector3::new(0.6, 0.8, 0.0)] {
        let point = PathPoint {
            fan: Some(Unit::new_normalize(fan)),
            ..before(0.0, 0.0, 0.15)
        };
        // A fan has no front: both signs give the same frame.
        let x = tool_frame(&point) * Vector3::x();
        assert!((x - Vector3::new(0.6, 0.8, 0.0)).norm() < 1e-9, "{x}");
    }
    let square_on = tool_frame(&before(0.0, 0.0, 0.15));
    assert!((square_on * Vector3::x() - Vector3::x()).norm() < 1e-12);
}

#[test]
fn the_nozzle_does_not_turn_around_where_a_fan_changes_its_sign() {
    // The fan's x passes the value up to which its sign decides, and every other row runs back.
    let points = (0..40).map(|i| {
        let x = 0.3 * f64::from(i % 20) / 20.0;
        let sign = if i < 20 { -1.0 } else { 1.0 };
        PathPoint {
            fan: Some(Unit::new_normalize(Vector3::new(x, -0.9, 0.0) * sign)),
            ..before(0.01 * f64::from(i) - 0.2, 0.0, 0.15)
        }
    });
    let path = SprayPath::new(points.collect()).expect("points");
    let pose = pose();
    let carried = carry(&path, &pose, &seen_at(&pose), &StandOffParams::default());
    for (pair, taught) in carried.points.windows(2).zip(path.points()) {
        let [a, b] = [&pair[0], &pair[1]].map(|point| point.camera_from_nozzle.rotation);
        assert!(a.angle_to(&b) < 0.4, "{}", a.angle_to(&b));
        let fan = pose.inverse() * pair[0].camera_from_nozzle * Vector3::x();
        assert!(fan.cross(&taught.fan.expect("a fan")).norm() < 1e-9);
    }
}

#[test]
fn every_line_of_an_export_reads_back_to_the_nozzle_in_the_robots_frame() {
    let pose = pose();
    let carried = carry(&path(), &pose, &seen_at(&pose), &StandOffParams::default());
    let frame = RobotFrame {
        robot_from_camera: from_euler_zyx([-2.2, 0.1, -1.6, 1.5, -0.2, 2.0]),
        name: "Cell 2 (00112233)".into(),
    };
    let doubts = ["another pose fits".to_owned()];
    let unchecked = ["reach".to_owned()];
    for convention in Convention::ALL {
        let export = SprayExport {
            path: &carried,
            part: "plate",
            scene: "plate.pcd",
            frame: &frame,
            convention,
            params: &StandOffParams::default(),
            is_stored: true,
            is_accepted: true,
            is_simulated: true,
            doubts: &doubts,
            unchecked: &unchecked,
            at: Timestamp::UNIX_EPOCH,
        };
        let csv = export.csv();
        for word in [
            &*convention.meaning(),
            "robot's base frame",
            "Cell 2 (00112233)",
            "SIMULATED",
            "# DOUBT: another pose fits\n",
            "# NOT CHECKED: reach\n",
            "27 of 27 inside",
        ] {
            assert!(csv.contains(word), "{word}: {csv}");
        }
        let mut lines = csv.lines().filter(|line| !line.starts_with('#'));
        let heading = lines.next().expect("a heading");
        assert!(
            heading.ends_with(",stand_off_mm,tilt_deg,band,gun_on,speed_mm_s"),
            "{heading}"
        );
        let num = convention.names().len();
        let json: serde_json::Value = serde_json::from_str(&export.json()).expect("JSON");
        assert_eq!(json["doubts"], serde_json::json!(doubts));
        assert_eq!(json["not_checked"], serde_json::json!(unchecked));
        for (i, (line, taught)) in lines.zip(path().points()).enumerate() {
            let cells: Vec<&str> = line.split(',').collect();
            assert_eq!(cells.len(), num + 6, "{line}");
            assert_eq!(cells[0], (i + 1).to_string());
            assert_eq!(cells[num + 3..], ["inside", "1", ""]);
            let text = format!("{} {}", convention.name(), cells[1..=num].join(" "));
            let read = parse_written_pose(&text).expect("a pose").pose;
            let expected = frame.robot_from_camera * pose * tool_frame(taught);
            assert!(
                (read.translation.vector - expected.translation.vector).norm() < 2e-6,
                "{line}"
            );
            assert!(read.rotation.angle_to(&expected.rotation) < 1e-5, "{line}");
            let numbers: Vec<f64> = json["points"][i]["robot_from_nozzle"]["values"]
                .as_array()
                .expect("numbers")
                .iter()
                .map(|value| value["value"].as_f64().expect("a number"))
                .collect();
            let read = convention.read(&numbers).expect("a pose");
            assert!((read.to_homogeneous() - expected.to_homogeneous()).amax() < 1e-9);
        }
    }
}
