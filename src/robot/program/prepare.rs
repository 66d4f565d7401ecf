//! Converts a carried path to the points of a program, and checks whether an arm reaches them.

use std::{
    path::Path,
    time::{Duration, SystemTime},
};

use nalgebra::{Translation3, UnitQuaternion};

use super::{ProgramPoint, ProgramSettings};
use crate::robot::{
    RobotFrame,
    arm::{
        ArmError, ArmPoint, CheckParams, PathCheck, PlacedArm, PointProblem, check_path, refuse_bad,
    },
    spray::CarriedPath,
};

/// A part captured longer ago than this may hang elsewhere by now.
const STALE: Duration = Duration::from_mins(10);

/// Returns true if the capture is more than 10 minutes old: a program of it must be forced.
pub fn is_stale(captured: SystemTime) -> bool {
    let age = SystemTime::now().duration_since(captured);
    age.is_ok_and(|age| age > STALE)
}

/// The same for a capture's file, by its time of modification; false if the system does not provide that.
pub fn is_stale_file(scene: &Path) -> bool {
    let written = scene.metadata().and_then(|meta| meta.modified());
    written.is_ok_and(is_stale)
}

/// Returns the nozzle poses of a path in the robot's base frame, for an arm. `speed`, in m/s, applies where the path
/// sets none.
pub fn arm_points(carried: &CarriedPath, frame: &RobotFrame, speed: f64) -> Vec<ArmPoint> {
    let points = carried.points.iter().map(|point| ArmPoint {
        robot_from_nozzle: frame.robot_from_camera * point.camera_from_nozzle,
        speed: point.speed.unwrap_or(speed),
        is_turn_free: point.is_round,
        is_gun_on: point.is_gun_on,
    });
    points.collect()
}

/// Checks whether an arm reaches a carried path without a collision. Also checks the approach point before it and the
/// retreat after it; their problems are reported at the first and the last point.
pub fn check_reach(
    arm: &PlacedArm,
    carried: &CarriedPath,
    frame: &RobotFrame,
    settings: &ProgramSettings,
) -> Result<PathCheck, ArmError> {
    let mut points = arm_points(carried, frame, settings.speed);
    let params = CheckParams::default();
    // Checked before the approach point is inserted, so that an error counts the path's own points.
    refuse_bad(arm, &points, &params)?;
    let (Some(first), Some(last)) = (points.first().copied(), points.last().copied()) else {
        return Err(ArmError::NoPoints);
    };
    let away = Translation3::new(0.0, 0.0, -settings.approach.0);
    let behind = |point: ArmPoint| ArmPoint {
        robot_from_nozzle: point.robot_from_nozzle * away,
        is_gun_on: false,
        ..point
    };
    let (approach, retreat) = (behind(first), behind(last));
    // The gun is off behind the last point, whatever the path says.
    if let Some(last) = points.last_mut() {
        last.is_gun_on = false;
    }
    points.insert(0, approach);
    points.push(retreat);
    let mut check = check_path(arm, &points, &params)?;
    let retreat = check.points.pop();
    let approach = check.points.remove(0);
    if let (Some(last), Some(retreat)) = (check.points.last_mut(), &retreat) {
        last.problem = graver(last.problem.take(), retreat.problem.clone());
    }
    if let Some(first) = check.points.first_mut() {
        first.problem = graver(first.problem.take(), approach.problem.clone());
    }
    check.ends = retreat.map(|retreat| [approach, retreat]);
    Ok(check)
}

/// Returns the problem to report: a collision takes precedence.
fn graver(own: Option<PointProblem>, other: Option<PointProblem>) -> Option<PointProblem> {
    if matches!(other, Some(PointProblem::Collision { .. })) {
        other
    } else {
        own.or(other)
    }
}

/// Returns the points of a program. With `reach`, the nozzle of a round jet is turned about its axis as in the check.
pub fn program_points(
    carried: &CarriedPath,
    frame: &RobotFrame,
    reach: Option<&PathCheck>,
) -> Vec<ProgramPoint> {
    let points = carried.points.iter().enumerate().map(|(i, point)| {
        let robot_from_nozzle = frame.robot_from_camera * point.camera_from_nozzle;
        let turn = reach
            .and_then(|reach| reach.points.get(i))
            .map_or(0.0, |checked| checked.turn);
        ProgramPoint {
            robot_from_nozzle: robot_from_nozzle
                * UnitQuaternion::from_euler_angles(0.0, 0.0, turn),
            is_gun_on: point.is_gun_on,
            speed: point.speed,
        }
    });
    points.collect()
}

#[cfg(test)]
mod tests {
    use nalgebra::{Isometry3, Point3, UnitQuaternion, Vector3};

    use super::*;
    use crate::{
        geometry::rigid::RigidTransform,
        robot::{
            arm::{Arm, Body, GUN_RADIUS, Obstacle, Obstacles},
            spray::{BandStatus, CarriedPoint},
        },
        units::Metres,
    };

    /// A line 200 mm across, 1.6 m in front of the robot at this height, with the nozzle pointing away from it.
    fn line(height: f64) -> CarriedPath {
        let turn = UnitQuaternion::from_axis_angle(&Vector3::y_axis(), std::f64::consts::FRAC_PI_2);
        let points = (0..5).map(|i| {
            let at = Translation3::new(1.6, 0.05 * f64::from(i) - 0.1, height);
            let camera_from_nozzle = Isometry3::from_parts(at, turn);
            CarriedPoint {
                camera_from_nozzle,
                part_from_nozzle: camera_from_nozzle,
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
            gun_radius: GUN_RADIUS,
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
        let near = check_reach(&arm, &line(1.2), &frame, &settings).expect("checked");
        assert_eq!(near.doubt("arm"), None, "{near:?}");
        let [begin, end] = near.ends.as_ref().expect("ends");
        for (end, point) in [(begin, &near.points[0]), (end, &near.points[4])] {
            let (end, point) = (end.joints.expect("reached"), point.joints.expect("reached"));
            let moved = end.iter().zip(&point).map(|(a, b)| (a - b).abs());
            assert!(moved.fold(0.0, f64::max) > 0.01, "{near:?}");
            assert_eq!(arm.arm.configuration(&end), arm.arm.configuration(&point));
        }
        // 1.4 m behind the nozzle the arm would be inside its own base.
        settings.approach = Metres(1.4);
        let far = check_reach(&arm, &line(1.2), &frame, &settings).expect("checked");
        let problems: Vec<bool> = far.points.iter().map(|p| p.problem.is_some()).collect();
        assert_eq!(problems, [true, false, false, false, true]);
        let doubt = far.doubt("arm").expect("not reached");
        assert!(doubt.starts_with("arm reaches 3 of 5 points"), "{doubt}");
        let none = CarriedPath { points: Vec::new() };
        assert!(check_reach(&arm, &none, &frame, &settings).is_err());
        // Counted as in the path, without the approach point.
        let mut stopped = line(1.2);
        stopped.points[2].speed = Some(0.0);
        let error = check_reach(&arm, &stopped, &frame, &settings).expect_err("no speed");
        assert!(error.to_string().contains("point 3"), "{error}");
    }

    #[test]
    fn a_part_in_the_way_of_the_gun_is_a_collision_also_on_the_way_to_the_path() {
        let (arm, frame) = cell();
        let checked = |points: &[Point3<f32>], x: f64, approach: f64| {
            let robot_from_part = Translation3::new(x, 0.0, 1.2).into();
            let arm = arm.clone().with_part(points, &robot_from_part);
            let settings = ProgramSettings {
                approach: Metres(approach),
                ..ProgramSettings::default()
            };
            check_reach(&arm, &line(1.2), &frame, &settings).expect("checked")
        };
        // A 1 m plate with a point every 10 mm, perpendicular to the jet.
        let side = |i: u16| 0.01 * f32::from(i) - 0.5;
        let plate = (0..=100).flat_map(|i| (0..=100).map(move |k| [side(i), side(k)]));
        let plate: Vec<Point3<f32>> = plate.map(|[y, z]| Point3::new(0.0, y, z)).collect();
        // 150 mm in front of the mouth, as a part hangs.
        assert_eq!(checked(&plate, 1.75, 0.1).doubt("arm"), None);
        // 50 mm behind it.
        let through = checked(&plate, 1.55, 0.1);
        let wanted = "arm reaches 0 of 5 points and would collide at 5";
        assert_eq!(through.doubt("arm").as_deref(), Some(wanted));
        let wanted = PointProblem::Collision {
            body: Body::Gun,
            obstacle: Obstacle::Part,
        };
        assert_eq!(through.points[2].problem, Some(wanted));
        // A bolt at the program's start, 300 mm behind the first point.
        let bolt: Vec<Point3<f32>> = (-1_i16..=1)
            .map(|i| Point3::new(0.0, 0.01 * f32::from(i) - 0.1, -0.02))
            .collect();
        let begun = checked(&bolt, 1.26, 0.3);
        let problems: Vec<bool> = begun.points.iter().map(|p| p.problem.is_some()).collect();
        assert_eq!(problems, [true, false, false, false, false], "{begun:?}");
        assert_eq!(begun.num_collisions(), 1);
        assert_eq!(checked(&bolt, 1.26, 0.1).doubt("arm"), None);
    }
}
