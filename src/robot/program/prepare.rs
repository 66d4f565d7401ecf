//! From a carried path to the points of a program, and whether an arm reaches them.

use std::{
    path::Path,
    time::{Duration, SystemTime},
};

use nalgebra::{Translation3, UnitQuaternion};

use super::{ProgramPoint, ProgramSettings};
use crate::robot::{
    RobotFrame,
    arm::{ArmError, ArmPoint, CheckParams, PathCheck, PlacedArm, check_path},
    spray::CarriedPath,
};

/// A part that was captured longer ago than this may hang elsewhere.
const STALE: Duration = Duration::from_mins(10);

/// True of a capture more than 10 minutes ago: no program is written of it unless forced.
pub fn is_stale(captured: SystemTime) -> bool {
    let age = SystemTime::now().duration_since(captured);
    age.is_ok_and(|age| age > STALE)
}

/// The same of a capture's file, by when it was written; false where the system does not tell.
pub fn is_stale_file(scene: &Path) -> bool {
    let written = scene.metadata().and_then(|meta| meta.modified());
    written.is_ok_and(is_stale)
}

/// The nozzle's places in the robot's base frame, for an arm; `speed` in m/s
/// where the path sets none.
pub fn arm_points(carried: &CarriedPath, frame: &RobotFrame, speed: f64) -> Vec<ArmPoint> {
    let points = carried.points.iter().map(|point| ArmPoint {
        robot_from_nozzle: frame.robot_from_camera * point.camera_from_nozzle,
        speed: point.speed.unwrap_or(speed),
        is_turn_free: point.is_round,
    });
    points.collect()
}

/// Whether an arm reaches a carried path. The program comes from an approach point and moves away at the end: what is wrong
/// there counts for the first and the last point.
pub fn check_reach(
    arm: &PlacedArm,
    carried: &CarriedPath,
    frame: &RobotFrame,
    settings: &ProgramSettings,
) -> Result<PathCheck, ArmError> {
    let mut points = arm_points(carried, frame, settings.speed);
    let (Some(first), Some(last)) = (points.first().copied(), points.last().copied()) else {
        return Err(ArmError::NoPoints);
    };
    let away = Translation3::new(0.0, 0.0, -settings.approach.0);
    let behind = |point: ArmPoint| ArmPoint {
        robot_from_nozzle: point.robot_from_nozzle * away,
        ..point
    };
    points.insert(0, behind(first));
    points.push(behind(last));
    let mut check = check_path(arm, &points, &CheckParams::default())?;
    let retreat = check.points.pop();
    let approach = check.points.remove(0);
    if let (Some(last), Some(retreat)) = (check.points.last_mut(), retreat) {
        last.problem = last.problem.or(retreat.problem);
    }
    if let Some(first) = check.points.first_mut() {
        first.problem = first.problem.or(approach.problem);
    }
    Ok(check)
}

/// The points of a program. `reach` turns the nozzle of a round jet about its axis as the arm reaches it.
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
    use nalgebra::{Isometry3, UnitQuaternion, Vector3};

    use super::*;
    use crate::{
        geometry::rigid::RigidTransform,
        robot::{
            arm::Arm,
            spray::{BandStatus, CarriedPoint},
        },
        units::Metres,
    };

    /// A line of 200 mm across, 1.6 m before the robot and as high as this, the nozzle away from it.
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

    #[test]
    fn the_way_to_the_path_and_from_it_has_to_be_reached_as_well() {
        let turn = UnitQuaternion::from_axis_angle(&Vector3::y_axis(), -0.8);
        let arm = PlacedArm {
            arm: Arm::named("irb4600").expect("known"),
            robot_from_base: RigidTransform::identity(),
            flange_from_nozzle: Isometry3::from_parts(Translation3::new(0.0, 0.0, 0.25), turn),
        };
        let frame = RobotFrame {
            robot_from_camera: RigidTransform::identity(),
            name: "cell".into(),
        };
        let mut settings = ProgramSettings::default();
        let near = check_reach(&arm, &line(1.2), &frame, &settings).expect("checked");
        assert_eq!(near.doubt("arm"), None, "{near:?}");
        // A metre behind the nozzle the arm would be in its own foot.
        settings.approach = Metres(1.4);
        let far = check_reach(&arm, &line(1.2), &frame, &settings).expect("checked");
        let problems: Vec<bool> = far.points.iter().map(|p| p.problem.is_some()).collect();
        assert_eq!(problems, [true, false, false, false, true]);
        assert_eq!(
            far.doubt("arm").as_deref(),
            Some("arm reaches 3 of 5 points")
        );
        let none = CarriedPath { points: Vec::new() };
        assert!(check_reach(&arm, &none, &frame, &settings).is_err());
    }
}
