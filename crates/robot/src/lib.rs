//! From the camera to the robot: where the camera stands in the robot's base frame, where the part is in it, and in
//! which numbers the robot's controller expects a pose.
//!
//! Three transforms are easily confused; each has its own name:
//!
//! | name | is | for |
//! | --- | --- | --- |
//! | `camera_from_part` | the *pose*: from the enrolled part to the part in front of the camera | everything inside |
//! | `robot_from_part` | the same pose in the robot's base frame | a path written in the part's own frame |
//! | `robot_offset` | the *offset from the standard position*, in the robot's base frame | a path taught in the robot's base frame with the part at its standard position |
//!
//! The part's own frame is the camera's frame at enrolment, so `camera_from_part` is the identity at the standard
//! position. There `robot_offset` is the identity too, while `robot_from_part` is `robot_from_camera`.
//!
//! The offset that the window shows is a fourth transform, for people only: how far the part's *middle* moved, along
//! the camera's axes. It has the same rotation angle as `robot_offset` but another shift, since a rotation about a
//! distant origin also moves the middle. Never give it to a robot.

#![cfg_attr(test, allow(clippy::disallowed_methods, reason = "tests change files"))]

pub mod arm;
pub mod calibration;
pub mod cell_check;
mod convention;
mod euler;
pub mod frame_poses;
pub mod hand_eye;
pub mod line;
pub mod paint;
pub mod pairs;
pub mod part_target;
pub mod program;
mod robot_pose;
pub mod scan_frames;
pub mod spray;
mod written;

use serde::{Serialize, Serializer};

use geometry::rigid::RigidTransform;
use texts::{Described, Message};

pub use self::{
    convention::Convention,
    robot_pose::{ConventionError, GimbalLock, RobotPose, RobotValue, Unit},
    written::{
        MAX_POSE_DISTANCE_M, NOZZLE_DISTANCE_RANGE_M, WrittenPose, WrittenPoseError, parse_nozzle,
        parse_written_pose,
    },
};

/// Pose of the camera in the robot's base frame, and the calibration that it comes from.
#[derive(Clone, Debug, PartialEq)]
pub struct RobotFrame {
    /// Transform from the camera frame to the robot's base frame.
    pub robot_from_camera: RigidTransform,
    /// Where it comes from.
    pub name: FrameName,
}

/// Where a [`RobotFrame`] comes from, for people. In JSON it is written in words.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum FrameName {
    /// The calibration of this name.
    Named(String),
    /// The calibration of this identity, which has no name.
    Unnamed(String),
    /// The poses of a scan.
    OfScan,
}

impl From<&str> for FrameName {
    fn from(name: &str) -> Self {
        Self::Named(name.to_owned())
    }
}

impl Described for FrameName {
    fn message(&self) -> Message {
        match self {
            Self::Named(name) => Message::new("cell-calibration").with("name", &**name),
            Self::Unnamed(identity) => {
                Message::new("cell-unnamed-calibration").with("identity", &**identity)
            }
            Self::OfScan => Message::new("cell-scan-poses"),
        }
    }
}

texts::display!(FrameName);

impl Serialize for FrameName {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        to.collect_str(self)
    }
}

impl RobotFrame {
    /// Returns the transform from the part's own frame to its present pose in the robot's base frame.
    pub fn robot_from_part(&self, camera_from_part: &RigidTransform) -> RigidTransform {
        self.robot_from_camera * camera_from_part
    }

    /// Returns the transform that moves a path taught in the robot's base frame, with the part at its standard
    /// position, to where it must be now: `robot_from_camera * camera_from_part * camera_from_robot`. Multiplied from
    /// the left, it also moves taught poses: `robot_offset * robot_from_tool_taught`.
    pub fn robot_offset(&self, camera_from_part: &RigidTransform) -> RigidTransform {
        self.robot_from_camera * camera_from_part * self.robot_from_camera.inverse()
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{Point3, Vector3};

    use super::*;
    use geometry::rigid::from_euler_zyx;
    use texts::Language;

    /// A camera 2 m above the floor and 1.5 m in front of the robot, which looks back and down at it.
    fn frame() -> RobotFrame {
        RobotFrame {
            robot_from_camera: from_euler_zyx([-2.2, 0.1, -1.6, 1.5, -0.2, 2.0]),
            name: "cell 1".into(),
        }
    }

    #[test]
    fn a_frame_is_named_in_the_language_of_the_window_and_in_json_in_english() {
        let identity = "3b2f68d5".to_owned();
        let names = [
            "Cell 2 (3b2f68d5)".into(),
            FrameName::Unnamed(identity),
            FrameName::OfScan,
        ];
        assert_eq!(
            serde_json::to_string(&names).expect("written"),
            r#"["Cell 2 (3b2f68d5)","an unnamed calibration (3b2f68d5)","the poses of the scan"]"#
        );
        assert_eq!(
            names.map(|name| name.message().text(Language::German)),
            [
                "Cell 2 (3b2f68d5)",
                "eine Kalibrierung ohne Namen (3b2f68d5)",
                "die Posen des Scans"
            ]
        );
    }

    #[test]
    fn a_point_of_the_part_is_where_the_camera_sees_it() {
        let camera_from_part = from_euler_zyx([0.1, -0.2, 0.3, 0.05, 0.02, -0.04]);
        let in_part = Point3::new(0.3, -0.1, 1.4);
        let seen = camera_from_part * in_part;
        let frame = frame();
        let in_robot = frame.robot_from_part(&camera_from_part) * in_part;
        assert!((frame.robot_from_camera * seen - in_robot).norm() < 1e-12);
    }

    #[test]
    fn at_the_standard_position_the_offset_moves_nothing_and_the_part_is_at_the_camera() {
        let frame = frame();
        let standard = RigidTransform::identity();
        assert!(
            (frame.robot_offset(&standard).to_homogeneous() - standard.to_homogeneous()).norm()
                < 1e-12
        );
        assert_eq!(frame.robot_from_part(&standard), frame.robot_from_camera);
    }

    #[test]
    fn the_offset_carries_a_taught_point_with_the_part() {
        let frame = frame();
        let camera_from_part = from_euler_zyx([-0.05, 0.4, 0.1, -0.1, 0.03, 0.2]);
        // A nozzle taught 15 cm in front of a spot on the part at its standard position.
        let spot = Point3::new(-0.2, 0.3, 1.3);
        let before = Vector3::new(0.0, 0.0, -0.15);
        let taught = frame.robot_from_camera * (spot + before);
        let now = frame.robot_offset(&camera_from_part) * taught;
        let spot_now = frame.robot_from_part(&camera_from_part) * spot;
        assert!(((now - spot_now).norm() - 0.15).abs() < 1e-12);
        let expected = frame.robot_from_camera * (camera_from_part * (spot + before));
        assert!((now - expected).norm() < 1e-12);
        // The other two transforms do not give this point.
        assert!((frame.robot_from_part(&camera_from_part) * taught - expected).norm() > 0.1);
        assert!((camera_from_part * taught - expected).norm() > 0.1);
    }
}
