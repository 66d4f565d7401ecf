//! Hand-eye calibration: where the camera sits, from pairs of a robot pose and a camera pose.
//!
//! The arm takes several poses, and at each the camera measures the pose of a target. Two transforms stay constant and
//! are solved for: that of the camera to its mount (X), and that of the target to the other side (Z). With the camera
//! on the flange the target stands in the cell; with the camera in the cell the target is on the flange. With the
//! robot's poses inverted for one of them, both mounts have the same equation:
//!
//! ```text
//! eye in hand   robot_from_flange · flange_from_camera · camera_from_target = robot_from_target
//! eye to hand   flange_from_robot ·  robot_from_camera · camera_from_target = flange_from_target
//!               ─────── Gᵢ ───────   ─────── X ───────   ────── Bᵢ ────────   ─────── Z ──────
//! ```
//!
//! This is AX = XB written with absolute poses: A = Gⱼ⁻¹Gᵢ and B = BⱼBᵢ⁻¹ for any two of them. The rotations of X and Z
//! follow in closed form from all pairs at once, the shifts by linear least squares. Then both poses are refined
//! together, with rotations and shifts weighted by how well each of them fits.
//!
//! Sources: M. Shah, "Solving the robot-world/hand-eye calibration problem using the Kronecker product", ASME Journal
//! of Mechanisms and Robotics 5(3), 2013, for the closed form; Y. C. Shiu and S. Ahmad, "Calibration of wrist-mounted
//! robotic sensors by solving homogeneous transform equations of the form AX = XB", IEEE Transactions on Robotics and
//! Automation 5(1), 1989, for what the turns must span; P. J. Rousseeuw, "Least median of squares regression", Journal
//! of the American Statistical Association 79, 1984, for finding pairs that do not belong.
//!
//! Deviations: Shah also solves for the shifts separately, but does not refine them; the refinement by Levenberg and
//! Marquardt, its weights, the bounds and the doubts are ours. The closed form contains no logarithm of a rotation, so
//! turns of 180° need no special care.
//!
//! Known limits: an error common to all pairs, such as a wrong scale of the camera or a wrongly measured tool, shows in
//! the residuals only as far as X and Z cannot absorb it, and is not in the bounds. If the poses of robot *and* camera
//! are inverted, X and Z change places and fit as well; only their lengths show it.

mod closed_form;
mod doubt;
mod mistake;
mod refine;
mod repeats;
mod span;
mod suspects;
#[cfg(test)]
mod tests;

use nalgebra::{Point3, Unit, Vector3};
use serde::{Deserialize, Serialize};

use geometry::{
    error::Advice,
    rigid::{PoseDelta, RigidTransform, is_finite, pose_error},
    units::{Metres, Radians},
};

pub use self::{doubt::HandEyeDoubt, mistake::LikelyMistake, span::Span};

/// What the camera is fixed to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Mount {
    /// The camera is fixed in the cell and looks at the robot: X is `robot_from_camera`.
    EyeToHand,
    /// The camera is on the robot's flange: X is `flange_from_camera`.
    EyeInHand,
}

impl Mount {
    /// Describes the mount in words, for people.
    pub fn describe(self) -> &'static str {
        match self {
            Self::EyeToHand => "eye to hand: the camera stands in the cell",
            Self::EyeInHand => "eye in hand: the camera is on the robot's flange",
        }
    }

    /// The name of X.
    pub fn camera_transform(self) -> &'static str {
        match self {
            Self::EyeToHand => "robot_from_camera",
            Self::EyeInHand => "flange_from_camera",
        }
    }

    /// The name of Z.
    pub fn target_transform(self) -> &'static str {
        match self {
            Self::EyeToHand => "flange_from_target",
            Self::EyeInHand => "robot_from_target",
        }
    }

    /// Gᵢ.
    fn carrier(self, robot_from_flange: &RigidTransform) -> RigidTransform {
        match self {
            Self::EyeToHand => robot_from_flange.inverse(),
            Self::EyeInHand => *robot_from_flange,
        }
    }
}

/// A pose of the arm and the target's pose that the camera measured there.
#[derive(Clone, Debug, PartialEq)]
pub struct PosePair {
    /// Name for people, such as a line of a file or the name of a capture.
    pub name: String,
    /// Pose of the flange in the robot's base frame, as the controller shows it.
    pub robot_from_flange: RigidTransform,
    /// Pose of the target in the camera frame.
    pub camera_from_target: RigidTransform,
}

/// What the camera measured the poses of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Target {
    /// A marker or a checkerboard: errors are alike in all directions.
    Marker,
    /// An enrolled part, measured by its surface and its outline.
    Part {
        /// The surface's mean normal, target frame; its sign is arbitrary.
        normal: Unit<Vector3<f64>>,
    },
}

/// Fewest pairs that determine X.
pub const LEAST_PAIRS: usize = 3;
/// Most pairs accepted; nobody takes as many.
pub const MOST_PAIRS: usize = 1000;

/// Why a calibration cannot be computed.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error, Advice)]
pub enum HandEyeError {
    /// Too few pairs.
    #[error("{found} different pairs of robot and camera poses, at least {LEAST_PAIRS} are needed")]
    #[advice = "Take 8 to 15 pairs, turning the flange about two different axes by 30° and more between them"]
    TooFewPairs {
        /// Pairs from different poses of the arm.
        found: usize,
    },
    /// Too many pairs.
    #[error("{found} pairs of robot and camera poses, at most {MOST_PAIRS} are taken")]
    #[advice = "Leave out all but a few dozen well spread pairs"]
    TooManyPairs {
        /// Pairs given.
        found: usize,
    },
    /// A pose has a number that is not finite.
    #[error("{pair}: a pose holds a number that is not finite")]
    #[advice = "Correct the numbers of {pair}, or leave it out"]
    NotFinite {
        /// Name of the pair.
        pair: String,
    },
    /// The arm's poses hardly differ, so nothing can be solved for.
    #[error("the pairs leave the camera's place open: no two poses of the arm differ enough")]
    #[advice = "Move the arm between the captures: turn the flange about two different axes by 30° to 90°"]
    Unsolvable,
}

/// The deviation of one pair from the solution.
#[derive(Clone, Debug, PartialEq)]
pub struct PairResidual {
    /// Name of the pair.
    pub name: String,
    /// Deviation of the measured from the expected pose of the target; the shift is that of its origin.
    pub off: PoseDelta,
}

/// How well the pairs agree.
#[derive(Clone, Debug, PartialEq)]
pub struct Residuals {
    /// One per pair, in the order given.
    pub pairs: Vec<PairResidual>,
    /// Root mean square over all pairs; pairs that repeat a pose of the arm count as one.
    pub rms: PoseDelta,
    /// Index of the pair with the largest shift.
    pub worst: usize,
}

impl Residuals {
    /// The pair with the largest shift.
    pub fn worst(&self) -> &PairResidual {
        &self.pairs[self.worst]
    }
}

/// Bounds of the error of X in 95 of 100 cases, if the pairs err independently.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct CalibrationBounds {
    /// Error of a point in the middle of the target positions; infinite if unconstrained.
    pub shift: Metres,
    /// Error of the camera's rotation; infinite if unconstrained.
    pub turn: Radians,
}

/// A solved calibration, its quality and its doubts.
#[derive(Clone, Debug, PartialEq)]
pub struct HandEye {
    /// What the camera is fixed to.
    pub mount: Mount,
    /// X: `robot_from_camera` or `flange_from_camera`.
    pub mount_from_camera: RigidTransform,
    /// Z: `flange_from_target` or `robot_from_target`.
    pub anchor_from_target: RigidTransform,
    /// How well the pairs agree with X and Z.
    pub residuals: Residuals,
    /// Bounds of the error of X.
    pub bounds: CalibrationBounds,
    /// What the poses span.
    pub span: Span,
    /// Doubts, the gravest first.
    pub doubts: Vec<HandEyeDoubt>,
}

impl HandEye {
    /// Returns false if the poses do not constrain the camera's place, or contradict each other: the result must not be
    /// used.
    pub fn is_usable(&self) -> bool {
        !self.doubts.iter().any(HandEyeDoubt::is_grave)
    }
}

/// Gᵢ and Bᵢ.
#[derive(Clone, Copy, Debug)]
struct Equation {
    anchor_from_mount: RigidTransform,
    camera_from_target: RigidTransform,
}

/// Pose of the flange in the robot's base frame, and that of the target in the camera frame.
type Poses = [RigidTransform; 2];

fn equations_of(mount: Mount, pairs: impl Iterator<Item = Poses>) -> Vec<Equation> {
    let equations = pairs.map(|[robot_from_flange, camera_from_target]| Equation {
        anchor_from_mount: mount.carrier(&robot_from_flange),
        camera_from_target,
    });
    equations.collect()
}

impl PosePair {
    fn poses(&self) -> Poses {
        [self.robot_from_flange, self.camera_from_target]
    }
}

impl Equation {
    /// The target's pose in the camera frame according to X and Z.
    fn predicted(&self, unknowns: &HandEyeSolution) -> RigidTransform {
        (self.anchor_from_mount * unknowns.mount_from_camera).inv_mul(&unknowns.anchor_from_target)
    }

    fn off(&self, unknowns: &HandEyeSolution) -> PoseDelta {
        pose_error(
            &self.camera_from_target,
            &self.predicted(unknowns),
            &Point3::origin(),
        )
    }
}

/// X and Z.
#[derive(Clone, Copy, Debug)]
struct HandEyeSolution {
    mount_from_camera: RigidTransform,
    anchor_from_target: RigidTransform,
}

/// Computes where the camera sits from at least [`LEAST_PAIRS`] pairs.
///
/// Pairs that do not span enough, or contradict each other, give a result with [`HandEye::doubts`]. Pairs that repeat a
/// pose of the arm count as one.
pub fn solve(pairs: &[PosePair], mount: Mount, target: Target) -> Result<HandEye, HandEyeError> {
    check(pairs)?;
    let different = repeats::different(pairs);
    if different.len() < LEAST_PAIRS {
        let found = different.len();
        return Err(HandEyeError::TooFewPairs { found });
    }
    let poses: Vec<Poses> = different.iter().map(PosePair::poses).collect();
    let equations = equations_of(mount, poses.iter().copied());
    let start = closed_form::solve(&equations).ok_or(HandEyeError::Unsolvable)?;
    let refined = refine::refine(&equations, start.unknowns);
    let unknowns = refined.unknowns;
    let off: Vec<PoseDelta> = equations.iter().map(|e| e.off(&unknowns)).collect();
    let all = equations_of(mount, pairs.iter().map(PosePair::poses));
    let residuals = residuals(pairs, &all, &unknowns, rms(&off));
    let span = Span::of(&different);
    let bounds = refined.bounds(&equations, target);
    let far = doubt::far_from_flange(mount, &poses, &unknowns);
    let doubts = doubt::doubts(
        &different, mount, &residuals, &span, bounds, start.lead, far,
    );
    Ok(HandEye {
        mount,
        mount_from_camera: unknowns.mount_from_camera,
        anchor_from_target: unknowns.anchor_from_target,
        residuals,
        bounds,
        span,
        doubts,
    })
}

fn check(pairs: &[PosePair]) -> Result<(), HandEyeError> {
    let found = pairs.len();
    if found > MOST_PAIRS {
        return Err(HandEyeError::TooManyPairs { found });
    }
    let bad = pairs
        .iter()
        .find(|p| !is_finite(&p.robot_from_flange) || !is_finite(&p.camera_from_target));
    bad.map_or(Ok(()), |pair| {
        Err(HandEyeError::NotFinite {
            pair: pair.name.clone(),
        })
    })
}

fn residuals(
    pairs: &[PosePair],
    equations: &[Equation],
    unknowns: &HandEyeSolution,
    rms: PoseDelta,
) -> Residuals {
    let off: Vec<PoseDelta> = equations.iter().map(|e| e.off(unknowns)).collect();
    let worst = (0..off.len())
        .max_by(|&a, &b| off[a].shift.0.total_cmp(&off[b].shift.0))
        .unwrap_or(0);
    Residuals {
        rms,
        worst,
        pairs: pairs
            .iter()
            .zip(off)
            .map(|(pair, off)| PairResidual {
                name: pair.name.clone(),
                off,
            })
            .collect(),
    }
}

/// Root mean squares of rotations and of shifts.
fn rms(off: &[PoseDelta]) -> PoseDelta {
    let mean = |square: fn(&PoseDelta) -> f64| {
        (off.iter().map(square).sum::<f64>() / off.len().max(1) as f64).sqrt()
    };
    PoseDelta {
        rotation: Radians(mean(|off| off.rotation.0.powi(2))),
        shift: Metres(mean(|off| off.shift.0.powi(2))),
    }
}
