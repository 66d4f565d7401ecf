//! The problems of a path's points.

use super::{
    kinematics::Singularity,
    obstacles::{Body, Obstacle},
};

/// Why the arm cannot run a point of a path.
#[derive(Clone, Debug, PartialEq)]
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
    NearSingularity(Singularity),
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

impl PointProblem {
    /// Describes the problem in words, without the point.
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
                    Obstacle::OtherPart => {
                        format!("the {body} is too near to another part that hangs there")
                    }
                    Obstacle::Floor => format!("the {body} is too near to the floor"),
                    Obstacle::Box(name) => format!("the {body} is too near to the box {name}"),
                    Obstacle::UpperArm => format!("the {body} is too near to the upper arm"),
                    Obstacle::Forearm => format!("the {body} is too near to the forearm"),
                    Obstacle::BaseColumn => format!("the {body} is too near to the base column"),
                }
            }
        }
    }

    /// Names the problem in words without its figures, which differ from point to point.
    pub fn reason(&self) -> String {
        match self {
            Self::JointLimit { joint, .. } => format!("joint {joint} beyond its limit"),
            Self::TooFast { joint, .. } => format!("joint {joint} too fast"),
            Self::RailTooFast { .. } => "rail too fast".into(),
            Self::JointAcceleration { joint, .. } => {
                format!("joint {joint} accelerates too slowly")
            }
            Self::RailAcceleration { .. } => "rail accelerates too slowly".into(),
            Self::OutOfReach
            | Self::NearSingularity(_)
            | Self::ConfigurationChange
            | Self::Collision { .. } => self.describe(),
        }
    }

    /// The figure of a problem that has one; of two with the same reason, the greater is the worse.
    pub fn figure(&self) -> Option<f64> {
        match self {
            Self::JointLimit { angle, .. } => Some(angle.abs()),
            Self::TooFast { speed, .. } | Self::RailTooFast { speed } => Some(*speed),
            Self::JointAcceleration { acceleration, .. }
            | Self::RailAcceleration { acceleration, .. } => Some(*acceleration),
            Self::OutOfReach
            | Self::NearSingularity(_)
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
                | Self::NearSingularity(_)
                | Self::TooFast { .. }
                | Self::ConfigurationChange
        )
    }

    /// A name of the problem for programs.
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
