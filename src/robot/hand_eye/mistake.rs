//! Why pairs do not agree: each common mistake is undone in turn, and the one that makes them agree is reported.

use nalgebra::{Isometry3, Translation3, Vector3};

use super::{Equation, closed_form, doubt::HandEyeDoubt, refine};
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
    /// The camera's lengths were millimetres read as metres.
    #[error("the camera's lengths were a thousandth of what was read")]
    CameraInMillimetres,
    /// The camera's lengths were metres read as millimetres.
    #[error("the camera's lengths were a thousand times what was read")]
    CameraInMetres,
}

/// Returns why the pairs do not agree, if they do not.
pub(super) fn disagreement(equations: &[Equation], rms: PoseDelta) -> Option<HandEyeDoubt> {
    if rms.shift <= AGREE.shift && rms.rotation <= AGREE.rotation {
        return None;
    }
    // Even with inverted poses, robot and camera turn by the same angle.
    let apart = turns_apart(equations);
    if apart > TURNS_AGREE {
        return Some(HandEyeDoubt::TurnsDisagree { apart });
    }
    let as_given = quality(equations, rms);
    let tried = LikelyMistake::ALL.iter().filter_map(|&mistake| {
        let equations = mistake.undone(equations);
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

impl LikelyMistake {
    const ALL: [Self; 4] = [
        Self::RobotInverted,
        Self::CameraInverted,
        Self::CameraInMillimetres,
        Self::CameraInMetres,
    ];

    /// The equations as they were probably meant.
    fn undone(self, equations: &[Equation]) -> Vec<Equation> {
        let scaled = |pose: &RigidTransform, factor: f64| {
            let shift = Translation3::from(pose.translation.vector * factor);
            Isometry3::from_parts(shift, pose.rotation)
        };
        let undone = |e: &Equation| {
            let (g, b) = (&e.anchor_from_mount, &e.camera_from_target);
            let (g, b) = match self {
                Self::RobotInverted => (g.inverse(), *b),
                Self::CameraInverted => (*g, b.inverse()),
                Self::CameraInMillimetres => (*g, scaled(b, 0.001)),
                Self::CameraInMetres => (*g, scaled(b, 1000.0)),
            };
            Equation {
                anchor_from_mount: g,
                camera_from_target: b,
            }
        };
        equations.iter().map(undone).collect()
    }
}
