//! Why pairs do not agree: each common mistake is undone in turn, and the one that makes them agree is reported.
//!
//! The pairs only show by which factor the unit of the camera differs from that of the robot. Which of the two is wrong
//! follows from the lengths: undoing the mistake must leave both as in a cell.

use nalgebra::{Isometry3, Quaternion, Translation3, UnitQuaternion, Vector3};

use super::{
    Equation, Mount, Poses, closed_form,
    doubt::{FARTHEST, HandEyeDoubt, NEAREST, farthest},
    equations_of, refine,
};
use geometry::{
    error::Advice,
    rigid::{PoseDelta, RigidTransform},
    statistics::median,
    units::{Metres, Radians},
};

/// Robot and camera turns differ by the camera's error, which is always less than this.
const TURNS_AGREE: Radians = Radians(0.05);
/// Pairs of a working cell agree better than this.
const AGREE: PoseDelta = PoseDelta {
    rotation: Radians(0.026),
    shift: Metres(0.015),
};
/// A mistake is reported if undoing it reduces the disagreement to less than this share.
const MUCH_BETTER: f64 = 0.25;

/// A common mistake that would explain the pairs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error, Advice)]
pub enum LikelyMistake {
    /// The robot's poses were inverted, or the mount is the other one.
    #[error(
        "the robot's poses went the other way (flange_from_robot), or the camera sat on the other mount"
    )]
    #[advice = "Check the mount, and that the robot's poses are robot_from_flange: the flange as the controller shows it"]
    RobotInverted,
    /// The camera's poses were inverted, or the mount is the other one: both give the same equations.
    #[error(
        "the camera sat on the other mount, or its poses went the other way (target_from_camera)"
    )]
    #[advice = "Check the mount first (--mount). Only if it is right, invert the camera's poses: camera_from_target says where the camera sees the target"]
    CameraInverted,
    /// Robot and camera poses were both inverted: X and Z change places, and the pairs agree as well.
    #[error(
        "the poses of robot and camera both went the other way (flange_from_robot and target_from_camera)"
    )]
    #[advice = "Check that the robot's poses are robot_from_flange and the camera's camera_from_target"]
    BothInverted,
    /// The robot's angles about x and z were read for one another.
    #[error(
        "the first and the third angle of the robot's poses changed places: KUKA's A B C begin with the turn about z, FANUC's W P R and Yaskawa's Rx Ry Rz with that about x"
    )]
    #[advice = "Check the convention of the robot's poses: kuka, or fanuc or yaskawa"]
    AnglesSwapped,
    /// The scalar of the robot's quaternions was read at the wrong end.
    #[error(
        "the scalar of the robot's quaternions stood at the other end: ABB's q1 q2 q3 q4 begin with it, quaternion-xyzw ends with it"
    )]
    #[advice = "Check the convention of the robot's poses: abb has the scalar first, quaternion-xyzw last"]
    RobotScalarMoved,
    /// The same for the camera's quaternions.
    #[error(
        "the scalar of the camera's quaternions stood at the other end: ABB's q1 q2 q3 q4 begin with it, quaternion-xyzw ends with it"
    )]
    #[advice = "Check the convention of the camera's poses: abb has the scalar first, quaternion-xyzw last"]
    CameraScalarMoved,
    /// The camera's lengths were millimetres read as metres.
    #[error("the camera's lengths were a thousandth of what was read")]
    #[advice(CHECK_CAMERA_UNIT)]
    CameraInMillimetres,
    /// The camera's lengths were metres read as millimetres.
    #[error("the camera's lengths were a thousand times what was read")]
    #[advice(CHECK_CAMERA_UNIT)]
    CameraInMetres,
    /// The robot's lengths were millimetres read as metres.
    #[error("the robot's lengths were a thousandth of what was read")]
    #[advice(CHECK_ROBOT_UNIT)]
    RobotInMillimetres,
    /// The robot's lengths were metres read as millimetres.
    #[error("the robot's lengths were a thousand times what was read")]
    #[advice(CHECK_ROBOT_UNIT)]
    RobotInMetres,
}

const CHECK_CAMERA_UNIT: &str =
    "Check the unit of the camera's poses: name the convention that they are written in";
const CHECK_ROBOT_UNIT: &str = "Check the unit of the robot's poses: write them in that of their convention (partsight report --conventions)";

/// Returns why the pairs do not agree, if they do not.
pub(super) fn disagreement(mount: Mount, poses: &[Poses], rms: PoseDelta) -> Option<HandEyeDoubt> {
    if rms.shift <= AGREE.shift && rms.rotation <= AGREE.rotation {
        return None;
    }
    let equations = equations_of(mount, poses.iter().copied());
    // Even with inverted poses or swapped angles, robot and camera turn by the same angle.
    let apart = turns_apart(&equations);
    if apart > TURNS_AGREE {
        return Some(HandEyeDoubt::TurnsDisagree { apart });
    }
    let as_given = quality(&equations, rms);
    let tried = UNDONE.iter().filter_map(|&(mistake, undone)| {
        let poses: Vec<Poses> = poses.iter().map(undone).collect();
        if mistake.is_of_unit() && !is_of_a_cell(&poses) {
            return None;
        }
        let equations = equations_of(mount, poses.into_iter());
        let start = closed_form::solve(&equations)?.unknowns;
        let fit = refine::refine(&equations, start).unknowns;
        let off: Vec<PoseDelta> = equations.iter().map(|e| e.off(&fit)).collect();
        let then = super::rms(&off);
        Some((quality(&equations, then), mistake, then))
    });
    let best = tried.min_by(|a, b| a.0.total_cmp(&b.0));
    Some(match best {
        Some((quality, mistake, then)) if quality < MUCH_BETTER * as_given => {
            HandEyeDoubt::Mistaken { mistake, rms, then }
        }
        _ => HandEyeDoubt::Disagree { rms },
    })
}

/// Median difference of the angles by which robot and camera turned between two captures.
fn turns_apart(equations: &[Equation]) -> Radians {
    let angle = |a: &RigidTransform, b: &RigidTransform| a.rotation.angle_to(&b.rotation);
    let mut apart: Vec<f64> = Vec::new();
    for (i, a) in equations.iter().enumerate() {
        for b in &equations[i + 1..] {
            let robot = angle(&a.anchor_from_mount, &b.anchor_from_mount);
            let camera = angle(&a.camera_from_target, &b.camera_from_target);
            apart.push((robot - camera).abs());
        }
    }
    Radians(median(apart.into_iter()).unwrap_or(0.0))
}

/// Disagreement of the equations, independent of their unit of length: shifts are relative to the spread of the
/// targets.
fn quality(equations: &[Equation], rms: PoseDelta) -> f64 {
    let positions = equations
        .iter()
        .map(|e| e.camera_from_target.translation.vector);
    let num = equations.len() as f64;
    let middle = positions.clone().sum::<Vector3<f64>>() / num;
    let spread_sq: f64 = positions.map(|p| (p - middle).norm_squared()).sum();
    let spread = (spread_sq / num).sqrt();
    rms.shift.0 / spread.max(f64::MIN_POSITIVE) + rms.rotation.0
}

/// Whether the robot's and the camera's positions are as far from their origins as in a cell.
fn is_of_a_cell(poses: &[Poses]) -> bool {
    let [flange, target] = farthest(poses);
    let range = NEAREST..=FARTHEST;
    range.contains(&flange) && range.contains(&target)
}

impl LikelyMistake {
    fn is_of_unit(self) -> bool {
        match self {
            Self::RobotInverted
            | Self::CameraInverted
            | Self::BothInverted
            | Self::AnglesSwapped
            | Self::RobotScalarMoved
            | Self::CameraScalarMoved => false,
            Self::CameraInMillimetres
            | Self::CameraInMetres
            | Self::RobotInMillimetres
            | Self::RobotInMetres => true,
        }
    }
}

/// Takes a mistake back.
type Undo = fn(&Poses) -> Poses;

/// Mistakes that make the pairs disagree, each with the poses of a pair as they were probably meant.
const UNDONE: [(LikelyMistake, Undo); 11] = [
    (LikelyMistake::RobotInverted, |[robot, camera]| {
        [robot.inverse(), *camera]
    }),
    (LikelyMistake::CameraInverted, |[robot, camera]| {
        [*robot, camera.inverse()]
    }),
    (LikelyMistake::AnglesSwapped, |[robot, camera]| {
        let (about_x, about_y, about_z) = robot.rotation.euler_angles();
        let meant = UnitQuaternion::from_euler_angles(about_z, about_y, about_x);
        [with_rotation(robot, meant), *camera]
    }),
    (LikelyMistake::RobotScalarMoved, |[robot, camera]| {
        [with_rotation(robot, scalar_last(robot)), *camera]
    }),
    (LikelyMistake::RobotScalarMoved, |[robot, camera]| {
        [with_rotation(robot, scalar_first(robot)), *camera]
    }),
    (LikelyMistake::CameraScalarMoved, |[robot, camera]| {
        [*robot, with_rotation(camera, scalar_last(camera))]
    }),
    (LikelyMistake::CameraScalarMoved, |[robot, camera]| {
        [*robot, with_rotation(camera, scalar_first(camera))]
    }),
    (LikelyMistake::CameraInMillimetres, |[robot, camera]| {
        [*robot, scaled(camera, 0.001)]
    }),
    (LikelyMistake::CameraInMetres, |[robot, camera]| {
        [*robot, scaled(camera, 1000.0)]
    }),
    (LikelyMistake::RobotInMillimetres, |[robot, camera]| {
        [scaled(robot, 0.001), *camera]
    }),
    (LikelyMistake::RobotInMetres, |[robot, camera]| {
        [scaled(robot, 1000.0), *camera]
    }),
];

fn with_rotation(pose: &RigidTransform, rotation: UnitQuaternion<f64>) -> RigidTransform {
    Isometry3::from_parts(pose.translation, rotation)
}

fn scaled(pose: &RigidTransform, factor: f64) -> RigidTransform {
    let shift = Translation3::from(pose.translation.vector * factor);
    Isometry3::from_parts(shift, pose.rotation)
}

/// The rotation of x y z w that were read as w x y z.
fn scalar_last(pose: &RigidTransform) -> UnitQuaternion<f64> {
    let read = pose.rotation;
    UnitQuaternion::new_normalize(Quaternion::new(read.k, read.w, read.i, read.j))
}

/// The rotation of w x y z that were read as x y z w.
fn scalar_first(pose: &RigidTransform) -> UnitQuaternion<f64> {
    let read = pose.rotation;
    UnitQuaternion::new_normalize(Quaternion::new(read.i, read.j, read.k, read.w))
}
