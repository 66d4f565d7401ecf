//! The problems of a path's points.

use serde::Serialize;

use super::{
    kinematics::Singularity,
    obstacles::{Body, Obstacle},
};
use texts::{Described, Language};

/// Why the arm cannot run a point of a path.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum PointProblem {
    /// The arm is too short, or its wrist would be too near to its own base.
    OutOfReach,
    /// Every solution has a joint beyond its limit; this is the nearest to it.
    JointLimit {
        /// The joint, from 1.
        joint: usize,
        /// The angle that it would need, radians.
        angle: f64,
    },
    /// The arm reaches it, but near a pose in which joints would have to be too fast.
    NearSingularity {
        /// The pose that it is near.
        singularity: Singularity,
    },
    /// On the way from the previous point, a joint would have to be faster than it can.
    TooFast {
        /// The joint, from 1.
        joint: usize,
        /// The speed that it would need, rad/s.
        speed: f64,
    },
    /// On the way from the previous point, the rail would have to be faster than it can.
    RailTooFast {
        /// The speed that it would need, m/s.
        speed: f64,
    },
    /// Within the window of time around the point, a joint would have to accelerate more than it can.
    JointAcceleration {
        /// The joint, from 1.
        joint: usize,
        /// The acceleration that it would need, rad/s².
        acceleration: f64,
        /// The joint's limit, rad/s².
        limit: f64,
    },
    /// Within that window, the rail would have to accelerate more than it can.
    RailAcceleration {
        /// The acceleration that it would need, m/s².
        acceleration: f64,
        /// The rail's limit, m/s².
        limit: f64,
    },
    /// On the way from the previous point, the arm would have to change its configuration, or turn a joint once around.
    ConfigurationChange,
    /// Gun or arm come nearer to an obstacle than the clearance, at the point or on the way from the previous one.
    Collision {
        /// The body that is too near.
        body: Body,
        /// The obstacle.
        obstacle: Obstacle,
    },
}

texts::described!(PointProblem: "point" by "kind");

impl PointProblem {
    /// The problem without its figures, which differ from point to point, in the language of this thread.
    pub fn reason(&self) -> String {
        let (message, language) = (self.message(), Language::current());
        let reason = message.attribute(language, "reason");
        reason.unwrap_or_else(|| message.text(language))
    }

    /// The figure of a problem that has one; of two with the same reason, the greater is the worse.
    pub fn figure(&self) -> Option<f64> {
        match self {
            Self::JointLimit { angle, .. } => Some(angle.abs()),
            Self::TooFast { speed, .. } | Self::RailTooFast { speed } => Some(*speed),
            Self::JointAcceleration { acceleration, .. }
            | Self::RailAcceleration { acceleration, .. } => Some(*acceleration),
            Self::OutOfReach
            | Self::NearSingularity { .. }
            | Self::ConfigurationChange
            | Self::Collision { .. } => None,
        }
    }

    /// Returns true for an acceleration, which a lower speed or a corner of larger radius would reduce.
    pub fn is_acceleration(&self) -> bool {
        matches!(
            self,
            Self::JointAcceleration { .. } | Self::RailAcceleration { .. }
        )
    }

    /// Returns true for joints that cannot follow, which another orientation of the nozzle may avoid.
    pub fn is_of_joints(&self) -> bool {
        matches!(
            self,
            Self::JointLimit { .. }
                | Self::NearSingularity { .. }
                | Self::TooFast { .. }
                | Self::ConfigurationChange
        )
    }

    /// A name of the problem for programs.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::OutOfReach => "out_of_reach",
            Self::JointLimit { .. } => "joint_limit",
            Self::NearSingularity { .. } => "near_singularity",
            Self::TooFast { .. } => "too_fast",
            Self::RailTooFast { .. } => "rail_too_fast",
            Self::JointAcceleration { .. } => "joint_acceleration",
            Self::RailAcceleration { .. } => "rail_acceleration",
            Self::ConfigurationChange => "configuration_change",
            Self::Collision { .. } => "collision",
        }
    }
}
