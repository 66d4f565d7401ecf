//! Why pairs do not agree: each common mistake is undone in turn, and the one that makes them agree is reported.
//!
//! The pairs only show by which factor the unit of the camera differs from that of the robot. Which of the two is wrong
//! follows from the lengths: undoing the mistake must leave both as in a cell.

use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};

use super::{
    Equation, Mount, Poses, closed_form,
    doubt::{FARTHEST, HandEyeDoubt, NEAREST, farthest},
    equations_of, refine,
};
use crate::{
    geometry::{
        rigid::{PoseDelta, RigidTransform},
        statistics::median,
    },
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
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum LikelyMistake {
    /// The robot's poses were inverted, or the mount is the other one.
    #[error(
        "the robot's poses went the other way (flange_from_robot), or the camera sat on the other mount"
    )]
    RobotInverted,
    /// The camera's poses were inverted, or the mount is the other one: both give the same equations.
    #[error(
        "the camera sat on the other mount, or its poses went the other way (target_from_camera)"
    )]
    CameraInverted,
    /// The robot's angles about x and z were read for one another.
    #[error(
        "the first and the third angle of the robot's poses changed places: KUKA's A B C begin with the turn about z, FANUC's W P R and Yaskawa's Rx Ry Rz with that about x"
    )]
    AnglesSwapped,
    /// The camera's lengths were millimetres read as metres.
    #[error("the camera's lengths were a thousandth of what was read")]
    CameraInMillimetres,
    /// The camera's lengths were metres read as millimetres.
    #[error("the camera's lengths were a thousand times what was read")]
    CameraInMetres,
    /// The robot's lengths were millimetres read as metres.
    #[error("the robot's lengths were a thousandth of what was read")]
    RobotInMillimetres,
    /// The robot's lengths were metres read as millimetres.
    #[error("the robot's lengths were a thousand times what was read")]
    RobotInMetres,
}

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
    let tried = LikelyMistake::ALL.iter().filter_map(|&mistake| {
        let poses: Vec<Poses> = poses.iter().map(|pair| mistake.undone(pair)).collect();
        if mistake.is_of_unit() && !is_of_a_cell(&poses) {
            return None;
        }
        let equations = equations_of(mount, poses.into_iter());
        let fit = refine::refine(&equations, closed_form::solve(&equations)?.unknowns).unknowns;
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
    const ALL: [Self; 7] = [
        Self::RobotInverted,
        Self::CameraInverted,
        Self::AnglesSwapped,
        Self::CameraInMillimetres,
        Self::CameraInMetres,
        Self::RobotInMillimetres,
        Self::RobotInMetres,
    ];

    fn is_of_unit(self) -> bool {
        match self {
            Self::RobotInverted | Self::CameraInverted | Self::AnglesSwapped => false,
            Self::CameraInMillimetres
            | Self::CameraInMetres
            | Self::RobotInMillimetres
            | Self::RobotInMetres => true,
        }
    }

    /// The poses of a pair as they were probably meant.
    fn undone(self, [robot, camera]: &Poses) -> Poses {
        let scaled = |pose: &RigidTransform, factor: f64| {
            let shift = Translation3::from(pose.translation.vector * factor);
            Isometry3::from_parts(shift, pose.rotation)
        };
        match self {
            Self::RobotInverted => [robot.inverse(), *camera],
            Self::CameraInverted => [*robot, camera.inverse()],
            Self::AnglesSwapped => {
                let (about_x, about_y, about_z) = robot.rotation.euler_angles();
                let meant = UnitQuaternion::from_euler_angles(about_z, about_y, about_x);
                [Isometry3::from_parts(robot.translation, meant), *camera]
            }
            Self::CameraInMillimetres => [*robot, scaled(camera, 0.001)],
            Self::CameraInMetres => [*robot, scaled(camera, 1000.0)],
            Self::RobotInMillimetres => [scaled(robot, 0.001), *camera],
            Self::RobotInMetres => [scaled(robot, 1000.0), *camera],
        }
    }
}
