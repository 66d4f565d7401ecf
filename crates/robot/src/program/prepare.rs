//! Converts a carried path to the points of a program, and checks whether an arm reaches them.

use super::{ProgramPoint, ProgramSettings};
use crate::{
    RobotFrame,
    arm::{ArmError, ArmPoint, CheckParams, FilmRoom, PathCheck, PlacedArm, check_path},
    spray::CarriedPath,
};

/// Returns the nozzle poses of a path in the robot's base frame, for an arm. `speed`, in m/s, applies where the path
/// sets none.
pub fn arm_points(carried: &CarriedPath, frame: &RobotFrame, speed: f64) -> Vec<ArmPoint> {
    let last = carried.points.len().saturating_sub(1);
    let aim = carried.stand_off();
    let points = carried
        .points
        .iter()
        .enumerate()
        .map(|(i, point)| ArmPoint {
            robot_from_nozzle: frame.robot_from_camera * point.camera_from_nozzle,
            speed: point.speed.unwrap_or(speed),
            aim: point.meets.map_or(aim, |hit| hit.distance.0),
            is_turn_free: point.is_round,
            is_gun_on: point.is_gun_on,
            // A program blends neither the first nor the last point.
            is_stop: i == 0 || i == last,
        });
    points.collect()
}

/// Checks whether an arm reaches a carried path without a collision, and the ways to it and from it. With the room of its
/// film, joints that cannot accelerate as needed may slow the gun while it sprays.
pub fn check_reach(
    arm: &PlacedArm,
    carried: &CarriedPath,
    frame: &RobotFrame,
    settings: &ProgramSettings,
    film: Option<&FilmRoom>,
) -> Result<PathCheck, ArmError> {
    let points = arm_points(carried, frame, settings.params.speed);
    let params = CheckParams {
        film,
        ..settings.params.check_params()
    };
    check_path(arm, &points, &params)
}

/// Returns the points of a program. With `reach`, the nozzle is turned and tilted as in the check.
pub fn program_points(
    carried: &CarriedPath,
    frame: &RobotFrame,
    reach: Option<&PathCheck>,
) -> Vec<ProgramPoint> {
    let points = carried.points.iter().enumerate().map(|(i, point)| {
        let checked = reach.and_then(|reach| reach.points.get(i));
        let robot_from_nozzle = checked.map_or_else(
            || frame.robot_from_camera * point.camera_from_nozzle,
            |checked| checked.robot_from_nozzle,
        );
        ProgramPoint {
            robot_from_nozzle,
            is_gun_on: point.is_gun_on,
            speed: point.speed,
        }
    });
    points.collect()
}

#[cfg(test)]
mod tests {
    use nalgebra::{Isometry3, Point3, Translation3, UnitQuaternion, Vector3};

    use super::*;
    use crate::{
        arm::{Arm, Body, GUN_RADIUS_M, Obstacle, Obstacles, PointProblem},
        spray::{BandStatus, CarriedPoint},
    };
    use geometry::{
        rigid::RigidTransform,
        units::{Metres, Radians},
    };

    /// A line 200 mm across, 1.6 m in front of the robot at this height, with the nozzle pointing away from it.
    fn line(height: f64) -> CarriedPath {
        let turn = UnitQuaternion::from_axis_angle(&Vector3::y_axis(), std::f64::consts::FRAC_PI_2);
        let points = (0..5).map(|i| {
            let at = Translation3::new(1.6, 0.05 * f64::from(i) - 0.1, height);
            let camera_from_nozzle = Isometry3::from_parts(at, turn);
            CarriedPoint {
                camera_from_nozzle,
                meets: None,
                band: BandStatus::NotSeen,
                is_gun_on: true,
                speed: None,
                is_round: false,
            }
        });
        CarriedPath {
            points: points.collect(),
        }
    }

    /// An arm that reaches the line, and its calibration.
    fn cell() -> (PlacedArm, RobotFrame) {
        let turn = UnitQuaternion::from_axis_angle(&Vector3::y_axis(), -0.8);
        let arm = PlacedArm {
            arm: Arm::named("irb4600").expect("known"),
            robot_from_base: RigidTransform::identity(),
            flange_from_nozzle: Isometry3::from_parts(Translation3::new(0.0, 0.0, 0.25), turn),
            gun_radius: GUN_RADIUS_M,
            obstacles: Obstacles::default(),
        };
        let frame = RobotFrame {
            robot_from_camera: RigidTransform::identity(),
            name: "cell".into(),
        };
        (arm, frame)
    }

    #[test]
    fn the_way_to_the_path_and_from_it_has_to_be_reached_as_well() {
        let (arm, frame) = cell();
        let mut settings = ProgramSettings::default();
        let stops = arm_points(&line(1.2), &frame, settings.params.speed);
        let stops: Vec<bool> = stops.iter().map(|point| point.is_stop).collect();
        assert_eq!(stops, [true, false, false, false, true]);
        let near = check_reach(&arm, &line(1.2), &frame, &settings, None).expect("checked");
        assert_eq!(near.missed("arm"), None, "{near:?}");
        let [begin, end] = near.ends.as_ref().expect("ends");
        for (end, point) in [(begin, &near.points[0]), (end, &near.points[4])] {
            let (end, point) = (end.joints.expect("reached"), point.joints.expect("reached"));
            let moved = end.iter().zip(&point).map(|(a, b)| (a - b).abs());
            assert!(moved.fold(0.0, f64::max) > 0.01, "{near:?}");
            assert_eq!(arm.arm.configuration(&end), arm.arm.configuration(&point));
        }
        // The arm does not reach 5 m behind the nozzle.
        settings.params.approach = Metres(5.0);
        let far = check_reach(&arm, &line(1.2), &frame, &settings, None).expect("checked");
        let problems: Vec<bool> = far.points.iter().map(|p| p.problem.is_some()).collect();
        assert_eq!(problems, [true, false, false, false, true]);
        let doubt = far.missed("arm").expect("not reached").to_string();
        assert!(doubt.starts_with("arm misses 2 of 5 points"), "{doubt}");
        let none = CarriedPath { points: Vec::new() };
        assert!(check_reach(&arm, &none, &frame, &settings, None).is_err());
        // Counted as in the path, without the approach point.
        let mut stopped = line(1.2);
        stopped.points[2].speed = Some(0.0);
        let error = check_reach(&arm, &stopped, &frame, &settings, None).expect_err("no speed");
        assert!(error.to_string().contains("point 3"), "{error}");
    }

    #[test]
    fn a_part_in_the_way_of_the_gun_is_a_collision_also_on_the_way_to_the_path() {
        let (arm, frame) = cell();
        let checked = |points: &[Point3<f32>], x: f64, approach: f64| {
            let robot_from_part = Translation3::new(x, 0.0, 1.2).into();
            let arm = arm.clone().with_part(points, &robot_from_part);
            let mut settings = ProgramSettings::default();
            settings.params.approach = Metres(approach);
            settings.params.max_tilt = Radians(0.0);
            check_reach(&arm, &line(1.2), &frame, &settings, None).expect("checked")
        };
        // A 1 m plate with a point every 10 mm, perpendicular to the jet.
        let side = |i: u16| 0.01 * f32::from(i) - 0.5;
        let plate = (0..=100).flat_map(|i| (0..=100).map(move |k| [side(i), side(k)]));
        let plate: Vec<Point3<f32>> = plate.map(|[y, z]| Point3::new(0.0, y, z)).collect();
        // 150 mm in front of the mouth, as a part hangs.
        assert_eq!(checked(&plate, 1.75, 0.1).missed("arm"), None);
        // 50 mm behind it.
        let through = checked(&plate, 1.55, 0.1);
        let wanted = "arm misses 5 of 5 points, 5 of them because it would collide";
        assert_eq!(
            through
                .missed("arm")
                .map(|missed| missed.to_string())
                .as_deref(),
            Some(wanted)
        );
        let wanted = |obstacle| {
            let body = Body::Gun;
            Some(PointProblem::Collision { body, obstacle })
        };
        assert_eq!(through.points[2].problem, wanted(Obstacle::Part));
        // The same plate as another part that hangs there.
        let beside = arm
            .clone()
            .with_other_part(&plate, &Translation3::new(1.55, 0.0, 1.2).into());
        let mut settings = ProgramSettings::default();
        settings.params.max_tilt = Radians(0.0);
        let checked_beside = check_reach(&beside, &line(1.2), &frame, &settings, None);
        let problem = checked_beside.expect("checked").points[2].problem.clone();
        assert_eq!(problem, wanted(Obstacle::OtherPart));
        // A bolt at the program's start, 300 mm behind the first point.
        let bolt: Vec<Point3<f32>> = (-1_i16..=1)
            .map(|i| Point3::new(0.0, 0.01 * f32::from(i) - 0.1, -0.02))
            .collect();
        let begun = checked(&bolt, 1.26, 0.3);
        let problems: Vec<bool> = begun.points.iter().map(|p| p.problem.is_some()).collect();
        assert_eq!(problems, [true, false, false, false, false], "{begun:?}");
        assert_eq!(begun.num_collisions(), 1);
        assert_eq!(checked(&bolt, 1.26, 0.1).missed("arm"), None);
    }
}
