//! Why a point of a path is no good.

use super::{
    kinematics::Singularity,
    obstacles::{Body, Obstacle},
};

/// Why a point is no good.
#[derive(Clone, Debug, PartialEq)]
pub enum PointProblem {
    /// The arm is too short, or its wrist too near to its own base.
    OutOfReach,
    /// A joint would have to turn farther than it can, in each of the solutions; this is the nearest.
    JointLimit {
        /// The joint, from 1.
        joint: usize,
        /// The angle that it would need, radians.
        angle: f64,
    },
    /// The arm can, but near a pose in which joints race.
    NearSingularity(Singularity),
    /// On the way from the point before, a joint would have to turn faster than it can.
    TooFast {
        /// The joint, from 1.
        joint: usize,
        /// The speed that it would need, rad/s.
        speed: f64,
    },
    /// On the way from the point before, the rail would have to move faster than it can.
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
        /// The greatest that it can, rad/s².
        limit: f64,
    },
    /// The same of the rail.
    RailAcceleration {
        /// The acceleration that it would need, m/s².
        acceleration: f64,
        /// The greatest that it can, m/s².
        limit: f64,
    },
    /// On the way from the point before, the arm would have to fold over, or to turn a joint once around.
    ConfigurationChange,
    /// Gun or arm come nearer to something than the clearance, at the point or on the way from the point before.
    Collision {
        /// What comes too near.
        body: Body,
        /// To what.
        obstacle: Obstacle,
    },
}

impl PointProblem {
    /// In words, without the point.
    pub fn describe(&self) -> String {
        match self {
            Self::OutOfReach => "out of reach".into(),
            Self::JointLimit { joint, angle } => {
                format!("joint {joint} would need {:.0} degrees", angle.to_degrees())
            }
            Self::NearSingularity(which) => format!("near a singularity: {}", which.name()),
            Self::TooFast { joint, speed } => {
                format!(
                    "joint {joint} would need {:.0} degrees/s",
                    speed.to_degrees()
                )
            }
            Self::RailTooFast { speed } => {
                format!("the rail would need {:.0} mm/s", 1000.0 * speed)
            }
            Self::JointAcceleration {
                joint,
                acceleration,
                limit,
            } => format!(
                "joint {joint} would need {:.0} degrees/s² and has {:.0}",
                acceleration.to_degrees(),
                limit.to_degrees()
            ),
            Self::RailAcceleration {
                acceleration,
                limit,
            } => format!(
                "the rail would need {:.0} mm/s² and has {:.0}",
                1000.0 * acceleration,
                1000.0 * limit
            ),
            Self::ConfigurationChange => "the arm would have to fold over".into(),
            Self::Collision { body, obstacle } => {
                let body = body.name();
                match obstacle {
                    Obstacle::Part => format!("the {body} is too near to the part"),
                    Obstacle::Floor => format!("the {body} is too near to the floor"),
                    Obstacle::Box(name) => format!("the {body} is too near to the box {name}"),
                    Obstacle::UpperArm => format!("the {body} is too near to the upper arm"),
                    Obstacle::Forearm => format!("the {body} is too near to the forearm"),
                    Obstacle::BaseColumn => format!("the {body} is too near to the base column"),
                }
            }
        }
    }

    /// True if joints or rail cannot accelerate as much: run slower there, or round the corner in a larger radius.
    pub fn is_acceleration(&self) -> bool {
        matches!(
            self,
            Self::JointAcceleration { .. } | Self::RailAcceleration { .. }
        )
    }

    /// Which kind it is, for programs.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::OutOfReach => "out_of_reach",
            Self::JointLimit { .. } => "joint_limit",
            Self::NearSingularity(_) => "near_singularity",
            Self::TooFast { .. } => "too_fast",
            Self::RailTooFast { .. } => "rail_too_fast",
            Self::JointAcceleration { .. } => "joint_acceleration",
            Self::RailAcceleration { .. } => "rail_acceleration",
            Self::ConfigurationChange => "configuration_change",
            Self::Collision { .. } => "collision",
        }
    }
}
