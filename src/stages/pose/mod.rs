//! Pose: where the reference is in the scene, by ICP as the paper has it or by our global search.
//!
//! Every method aligns a *source* (the scene's part) to a *target* (a reference) and answers with the same
//! [`PoseEstimate`]. The paper minimises eq. 12, E(R, t) = mean ‖qᵢ - R pᵢ - t‖² over closest points; E is reported for
//! every method.

mod align;
pub mod edge_points;
mod equations;
mod global;
pub mod icp;
pub mod quality;
pub mod refine;

use crate::{geometry::rigid::RigidTransform, units::Metres};

pub use self::{
    align::align,
    quality::{Fit, Sight},
};

/// Fewer points than this do not fix a pose.
const MIN_POINTS: usize = 10;

/// How a pose is estimated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum PoseMethod {
    /// From no start: placements of the ranking or a spread of rotations, refined robustly.
    #[default]
    Global,
    /// Iterative closest point from one start (eq. 12), the paper's.
    Icp,
}

impl PoseMethod {
    /// The name used on the command line and in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Global => "global",
            Self::Icp => "icp",
        }
    }
}

/// Why an estimation ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Stopped {
    /// The last step moved the source by less than the tolerance.
    Converged,
    /// E fell below the target of Algorithm 3.
    BelowTarget,
    /// The allowed iterations were used up.
    IterationLimit,
}

impl Stopped {
    /// The name used in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Converged => "converged",
            Self::BelowTarget => "below_target",
            Self::IterationLimit => "iteration_limit",
        }
    }
}

/// One step of an estimation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Iteration {
    /// E(R, t) of eq. 12 over this step's pairs, square metres.
    pub e_m2: f64,
    /// The pose before the step's update.
    pub target_from_source: RigidTransform,
    /// Pairs of closest points used.
    pub num_pairs: usize,
}

/// A pose and everything known about it.
#[derive(Clone, Debug, PartialEq)]
pub struct PoseEstimate {
    /// Takes source space into target space. For an inspection the source is the scene and the target the
    /// reference: this is the paper's T (eq. 13), and its inverse is `camera_from_part`.
    pub target_from_source: RigidTransform,
    /// How it was found.
    pub method: PoseMethod,
    /// Why the search ended.
    pub stopped: Stopped,
    /// Every step of the run that led to this pose.
    pub iterations: Vec<Iteration>,
    /// How well it fits.
    pub fit: Fit,
    /// The best pose that is a different one, if another was tried.
    pub runner_up: Option<RunnerUp>,
}

/// The second-best pose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RunnerUp {
    /// The pose.
    pub target_from_source: RigidTransform,
    /// Its cost over the best pose's cost, at least 1; close to 1 means that the two cannot be told apart.
    pub ratio: f64,
}

/// A runner-up that costs less than this many times the best makes the pose ambiguous.
pub const AMBIGUOUS_BELOW: f64 = 1.15;

impl PoseEstimate {
    /// Takes part space into camera space: where a point of the reference is in the scene.
    pub fn camera_from_part(&self) -> RigidTransform {
        self.target_from_source.inverse()
    }

    /// True when a different pose fits (nearly) as well.
    pub fn is_ambiguous(&self) -> bool {
        self.runner_up.is_some_and(|r| r.ratio < AMBIGUOUS_BELOW)
    }
}

/// Why no pose could be estimated.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum PoseError {
    /// One of the clouds has too few points.
    #[error("the {which} cloud has {found} points, at least {needed} are needed")]
    TooFewPoints {
        /// Source or target.
        which: &'static str,
        /// Points found.
        found: usize,
        /// Points needed.
        needed: usize,
    },
    /// The closest points leave the pose free.
    #[error(
        "the {which} cloud leaves the pose free: its points lie on a line or a spot ({width:.5} m wide)"
    )]
    Degenerate {
        /// Source or target.
        which: &'static str,
        /// Standard deviation along the second principal axis, metres.
        width: f64,
    },
    /// No closest points within reach.
    #[error(
        "the clouds have only {found} pairs of points within {}, at least {needed} are needed",
        reach
    )]
    NoOverlap {
        /// Pairs found.
        found: usize,
        /// Pairs needed.
        needed: usize,
        /// Largest distance of a pair.
        reach: Metres,
    },
    /// The reference has no cloud.
    #[error("the reference is a flat shape without a cloud")]
    NoReferenceCloud,
}

impl crate::error::Advice for PoseError {
    fn advice(&self) -> String {
        match self {
            Self::TooFewPoints { .. } => "Capture the part again from nearer, or enrol it again".into(),
            Self::Degenerate { .. } => "Use a cloud that shows a surface, not a line or a single spot".into(),
            Self::NoOverlap { .. } => {
                "Check that both clouds show the same part in metres, or give a start with --initial".into()
            }
            Self::NoReferenceCloud => "Enrol the part from a capture, a cloud or a mesh".into(),
        }
    }
}
