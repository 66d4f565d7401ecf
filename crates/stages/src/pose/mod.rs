//! Pose: where the reference is in the scene, by ICP or ICP-GA as the paper has them, or by our global search.
//!
//! Every method aligns a *source* (the scene's part) to a *target* (a reference) and answers with the same
//! [`PoseEstimate`]. The paper minimises eq. 12, E(R, t) = mean ‖qᵢ - R pᵢ - t‖² over closest points; E is reported for
//! every method.

mod align;
pub(crate) mod centred;
pub mod closest;
pub mod displacements;
pub mod edge_points;
mod equations;
mod global;
mod prepared;
pub mod quality;
pub mod refine;
pub mod scale;
mod starts;
pub mod uncertainty;

use std::fmt;

use geometry::{rigid::RigidTransform, units::Metres};
use texts::{Described, Message};

pub use self::{
    align::{AlignParams, align, align_to, align_with},
    prepared::PreparedTarget,
    quality::{FitQuality, VisibilityShares},
    scale::{OffScale, ScaleEstimate},
    uncertainty::{Axis, FreeMotion, Uncertainty},
};

/// Fewer points than this do not fix a pose.
pub(crate) const MIN_POINTS: usize = 10;

/// How a pose is estimated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum PoseMethod {
    /// From no start: placements of the ranking or a spread of rotations, refined robustly.
    #[default]
    Global,
    /// Iterative closest point from one start (eq. 12), the paper's.
    Icp,
    /// ICP and a genetic algorithm in turns (Algorithm 3), the paper's.
    IcpGa,
}

impl PoseMethod {
    /// Every method, the paper's first.
    pub const ALL: [Self; 3] = [Self::Icp, Self::IcpGa, Self::Global];

    /// The name used on the command line and in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Global => "global",
            Self::Icp => "icp",
            Self::IcpGa => "icp-ga",
        }
    }
}

/// Why an estimation ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Stopped {
    /// The last step moved the source by less than the tolerance.
    Converged,
    /// E fell below the threshold of Algorithm 3.
    #[serde(rename = "below_target")]
    BelowThreshold,
    /// The allowed iterations were used up.
    IterationLimit,
    /// Some rounds of Algorithm 3 in a row found nothing better.
    NoProgress,
}

impl Stopped {
    /// The name used in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Converged => "converged",
            Self::BelowThreshold => "below_target",
            Self::IterationLimit => "iteration_limit",
            Self::NoProgress => "no_progress",
        }
    }
}

impl Described for Stopped {
    fn message(&self) -> Message {
        Message::new(format!("stopped-{}", self.name().replace('_', "-")))
    }
}

texts::display!(Stopped);

/// What a step of an estimation is a step of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Phase {
    /// An iteration of ICP.
    Icp,
    /// A generation of the genetic algorithm.
    Genetic,
    /// A step of our robust refinement.
    Refinement,
}

/// One step of an estimation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Iteration {
    /// What it is a step of.
    pub phase: Phase,
    /// E(R, t) of eq. 12 over this step's pairs, square metres.
    pub e_m2: f64,
    /// The pose that E was taken at: before the step's update, and for a generation the best so far.
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
    pub fit: FitQuality,
    /// How far off it may be; `None` of a pose that was not refined to the end.
    pub uncertainty: Option<Uncertainty>,
    /// The best pose that is a different one, if another was tried.
    pub runner_up: Option<RunnerUp>,
    /// Size of the source relative to the target's; `None` where too little is seen, of two clouds that are aligned, of scans,
    /// and of a pose that was not refined to the end.
    pub scale: Option<ScaleEstimate>,
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

    /// Returns how far off it may be, if it was refined to the end and nothing may slide or turn.
    pub fn bounds(&self) -> Option<Uncertainty> {
        self.uncertainty.filter(Uncertainty::is_held)
    }

    /// Carries the poses into other spaces; distances stay as they are.
    fn in_other_spaces(&mut self, carried: impl Fn(&RigidTransform) -> RigidTransform) {
        let runner_up = self.runner_up.iter_mut().map(|r| &mut r.target_from_source);
        let steps = self
            .iterations
            .iter_mut()
            .map(|i| &mut i.target_from_source);
        for pose in steps.chain(runner_up).chain([&mut self.target_from_source]) {
            *pose = carried(pose);
        }
    }

    /// Why the pose should not be relied upon, if there is a reason.
    pub fn doubt(&self) -> Option<PoseWarning> {
        let overlap = self.fit.overlap;
        let ambiguous = self.runner_up.filter(|r| r.ratio < AMBIGUOUS_BELOW);
        if overlap < LEAST_OVERLAP {
            Some(PoseWarning::LittleOverlap {
                overlap,
                needed: LEAST_OVERLAP,
            })
        } else if let Some(runner_up) = ambiguous {
            Some(PoseWarning::Ambiguous {
                ratio: runner_up.ratio,
            })
        } else if let Some(freedom) = self.uncertainty.and_then(|u| u.freedom) {
            Some(PoseWarning::Loose { freedom })
        } else if let Some(off) = self.off_scale() {
            Some(PoseWarning::OffScale(off))
        } else if self.stopped == Stopped::IterationLimit {
            Some(PoseWarning::Unsettled {
                num_iterations: self.iterations.len(),
            })
        } else {
            None
        }
    }

    /// How much larger or smaller the source certainly is than the target. A pose that may slide, or be another one, does not
    /// show it.
    pub fn off_scale(&self) -> Option<OffScale> {
        self.bounds().filter(|_| !self.is_ambiguous())?;
        self.scale?.off()
    }

    /// True when a different pose fits (nearly) as well.
    pub fn is_ambiguous(&self) -> bool {
        self.runner_up.is_some_and(|r| r.ratio < AMBIGUOUS_BELOW)
    }
}

/// Less of the source on the target than this is chance: a plane through a ball shares as much with it.
const LEAST_OVERLAP: f64 = 0.25;

/// Why a pose should not be relied upon.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error, serde::Serialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum PoseWarning {
    /// The source hardly lies on the target.
    LittleOverlap {
        /// Share of the source on the target.
        overlap: f64,
        /// Least share.
        needed: f64,
    },
    /// A different pose fits (nearly) as well.
    Ambiguous {
        /// Cost of the other pose over this one's.
        ratio: f64,
    },
    /// The source could slide or turn, and still lie on the target.
    Loose {
        /// How it could move most easily.
        freedom: FreeMotion,
    },
    /// The source is larger or smaller than the target.
    OffScale(OffScale),
    /// The search was still moving when its iterations were used up.
    Unsettled {
        /// Iterations used.
        num_iterations: usize,
    },
}

texts::described!(PoseWarning: "pose" by "kind");

/// One of the two clouds that are aligned.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum CloudRole {
    /// The cloud that is moved.
    Source,
    /// The cloud that it is moved onto.
    Target,
}

impl fmt::Display for CloudRole {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Source => "source",
            Self::Target => "target",
        })
    }
}

/// Why no pose could be estimated.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error, serde::Serialize, serde::Deserialize)]
#[serde(tag = "cause", rename_all = "snake_case")]
pub enum PoseError {
    /// One of the clouds has too few points.
    TooFewPoints {
        /// Source or target.
        which: CloudRole,
        /// Points found.
        found: usize,
        /// Points needed.
        needed: usize,
    },
    /// The closest points leave the pose free.
    Degenerate {
        /// Source or target.
        which: CloudRole,
        /// Standard deviation along the second principal axis, metres.
        #[serde(rename = "width_m")]
        width: f64,
    },
    /// All closest points of ICP lie on a spot or a line.
    OneSidedPairs {
        /// Pairs used.
        num_pairs: usize,
        /// Root mean square distance of the pairs.
        #[serde(rename = "rms_m")]
        rms: Metres,
    },
    /// No closest points within reach.
    NoOverlap {
        /// Pairs found.
        found: usize,
        /// Pairs needed.
        needed: usize,
        /// Largest distance of a pair.
        #[serde(rename = "reach_m")]
        reach: Metres,
    },
    /// One cloud is many times the other.
    SizesDiffer {
        /// Size of the larger over that of the smaller.
        ratio: f64,
    },
    /// The coordinates are so large that they do not resolve the cloud.
    TooFarOut {
        /// Source or target.
        which: CloudRole,
        /// Largest coordinate.
        #[serde(rename = "distance_m")]
        distance: Metres,
    },
    /// The reference has no cloud.
    NoReferenceCloud,
    /// The caller cancelled.
    Cancelled,
}

texts::described!(PoseError: "pose" by "cause");
