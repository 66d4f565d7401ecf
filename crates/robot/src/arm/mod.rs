//! Whether a six-axis arm can run a spray path, by its inverse kinematics.
//!
//! The arm has a spherical wrist and a parallel base (*ortho-parallel*), described by seven lengths and the signs and
//! offsets of its joints: M. Brandstötter, A. Angerer, M. Hofbaur, "An Analytical Solution of the Inverse Kinematics
//! Problem of Industrial Serial Manipulators with an Ortho-parallel Basis and a Spherical Wrist", Austrian Robotics
//! Workshop 2014. Each point has up to eight solutions, with every whole turn that the joints' limits allow; dynamic
//! programming picks those with the least time of joint motion. A round jet leaves the turn about the nozzle free: it
//! is tried in steps of 15°; a fan is the same turned by 180°. Near points that are not reached, the nozzle may also tilt
//! about the point that it aims at; `smooth_tilts` makes these tilts change evenly. Straight moves are also checked
//! between the points, as finely as the speeds of the joints need. With the gun off, the arm may move more slowly than
//! the path specifies, or in a joint move (`way`); with the gun on, more slowly as far as the film allows (`slowing`).
//!
//! Gun and arm must stay clear of [`Obstacles`] at every point and on the way to it.
//!
//! An arm may stand on a [`Rail`]. A rail with a top speed moves along the path: `rail_plan` chooses its position at
//! every point. Any other stands still, and a better position of it can be suggested.
//!
//! If their limits are known, the accelerations of joints and rail are checked too (`acceleration`).
//!
//! Known limits: the choice of configurations and turns does not consider accelerations. Joint 3 of FANUC arms is
//! counted from the horizontal on the controller; here it is the angle against the upper arm, and so is its limit.

mod acceleration;
mod chain;
mod check;
mod check_points;
mod error;
mod file;
mod film_room;
mod follow;
mod kinematics;
mod models;
mod obstacles;
mod path;
mod place;
mod problem;
mod rail;
mod rail_plan;
mod slowing;
mod smooth_tilts;
#[cfg(test)]
mod tests;
mod validate;
mod way;

use std::f64::consts::TAU;

use nalgebra::{Point3, Vector3};

use crate::Convention;
use geometry::rigid::RigidTransform;

pub use self::{
    check::check_path,
    error::{ArmError, NotReached},
    film_room::FilmRoom,
    kinematics::{Joints, Singularity},
    models::ARM_NAMES,
    obstacles::{Body, Obstacle, Obstacles},
    path::{ArmPoint, CheckParams, PathCheck, PointCheck, Way},
    place::{PlaceSuggestion, suggest_base, suggest_rail},
    problem::PointProblem,
    rail::Rail,
};

/// A six-axis arm with a spherical wrist.
#[derive(Clone, Debug, PartialEq)]
pub struct Arm {
    /// Name shown to people.
    pub name: String,
    /// a1, a2, b, c1, c2, c3, c4 of the source, metres.
    lengths: [f64; 7],
    /// Added to a joint of the model before its sign, radians.
    offsets: [f64; 6],
    /// Direction of each joint: 1 or -1.
    signs: [i8; 6],
    /// Least and greatest angle of each joint, radians.
    limits: [[f64; 2]; 6],
    /// Top speed of each joint, rad/s.
    speeds: [f64; 6],
    /// Greatest acceleration of each joint, rad/s²; none if not known.
    accelerations: Option<[f64; 6]>,
    /// Height of the controller's base frame above the foot, metres.
    base_height: f64,
    /// Radii of upper arm, forearm and wrist around their axes, metres.
    radii: [f64; 3],
    /// The maker whose controllers count the joints as here, except joint 3 of FANUC arms; none for an arm from a file.
    pub(super) maker: Option<Convention>,
    /// The rail on which it stands, if any.
    pub rail: Option<Rail>,
}

/// Default radius of a gun with its hoses, metres.
pub const GUN_RADIUS_M: f64 = 0.05;

/// An arm in its cell.
#[derive(Clone, Debug)]
pub struct PlacedArm {
    /// The arm.
    pub arm: Arm,
    /// Pose of its base in the frame of the path; the identity if the path is in the arm's own base frame.
    pub robot_from_base: RigidTransform,
    /// Pose of the nozzle on the flange.
    pub flange_from_nozzle: RigidTransform,
    /// Radius of the gun around the line from the flange to the nozzle's mouth, metres, 0.001..1.
    pub gun_radius: f64,
    /// Obstacles for gun and arm.
    pub obstacles: Obstacles,
}

impl PlacedArm {
    /// Radius with which the gun is checked, metres: that of a ball if the gun is wider than it is long, 0 for a nozzle at
    /// the flange, which leaves no gun.
    pub fn checked_gun_radius(&self) -> f64 {
        self.gun_radius.min(self.most_gun_radius())
    }

    /// Half the length of the gun.
    fn most_gun_radius(&self) -> f64 {
        self.flange_from_nozzle.translation.vector.norm() / 2.0
    }

    /// Adds what else hangs there as an obstacle; its points are in the camera's frame.
    #[must_use]
    pub fn with_other_part(
        self,
        points: &[Point3<f32>],
        robot_from_camera: &RigidTransform,
    ) -> Self {
        Self {
            obstacles: (self.obstacles).with_other_part(points, robot_from_camera),
            ..self
        }
    }

    /// Adds a part as an obstacle; its points are in the part's frame.
    #[must_use]
    pub fn with_part(self, points: &[Point3<f32>], robot_from_part: &RigidTransform) -> Self {
        Self {
            obstacles: self.obstacles.with_part(points, robot_from_part),
            ..self
        }
    }
}

impl Arm {
    /// Shift of the base at this position of the rail.
    pub(super) fn rail_shift(&self, position: f64) -> Vector3<f64> {
        self.rail.map_or_else(Vector3::zeros, |rail| {
            rail.direction.into_inner() * position
        })
    }

    /// The rail if it moves along the path, and its top speed, m/s.
    pub fn moving_rail(&self) -> Option<(Rail, f64)> {
        let rail = self.rail?;
        Some((rail, rail.speed?))
    }

    /// Whether a limit of acceleration is known: of the joints, or of a rail that moves along the path.
    fn limits_accelerations(&self) -> bool {
        let moving = self.moving_rail();
        self.accelerations.is_some() || moving.is_some_and(|(rail, _)| rail.acceleration.is_some())
    }

    /// Names what has no known limit of acceleration and is therefore not checked: "joints", "rail" (one that moves
    /// along the path) or "joints and rail".
    pub fn unchecked_accelerations(&self) -> Option<&'static str> {
        let moving = self.moving_rail();
        let is_rail = moving.is_some_and(|(rail, _)| rail.acceleration.is_none());
        match (self.accelerations.is_none(), is_rail) {
            (true, true) => Some("joints and rail"),
            (true, false) => Some("joints"),
            (false, true) => Some("rail"),
            (false, false) => None,
        }
    }

    /// The joints as the teach pendant of its maker shows them. FANUC counts joint 3 from the horizontal, so that it keeps
    /// its value while joint 2 alone moves: it is the angle against the upper arm less that of joint 2.
    pub fn on_pendant(&self, joints: &Joints) -> Joints {
        let [j1, j2, j3, j4, j5, j6] = *joints;
        match self.maker {
            // The forearm leans forward by joint 2 less joint 3: their signs are opposite.
            Some(Convention::Fanuc) => [j1, j2, j3 - j2, j4, j5, j6],
            _ => *joints,
        }
    }

    /// Top speeds of the joints, rad/s.
    pub fn joint_speeds(&self) -> &Joints {
        &self.speeds
    }

    /// Distance from joint 2 to the middle of the wrist with the arm stretched, metres.
    pub fn reach(&self) -> f64 {
        let [_, a2, _, _, c2, c3, _] = self.lengths;
        c2.abs() + a2.hypot(c3)
    }

    fn checked(self) -> Result<Self, ArmError> {
        for (i, [low, high]) in self.limits.into_iter().enumerate() {
            if !(low < high) || !(low.abs().max(high.abs()) < 20.0) {
                return Err(ArmError::Limits {
                    joint: i + 1,
                    low: low.to_degrees(),
                    high: high.to_degrees(),
                });
            }
            let (speed, sign, offset) = (self.speeds[i], self.signs[i], self.offsets[i]);
            let acceleration = self.accelerations.map(|limits| limits[i]);
            let is_speed = speed > 0.0 && speed < 100.0;
            let is_acceleration = acceleration.is_none_or(|a| a > 0.0 && a < 10_000.0);
            let acceleration = acceleration.unwrap_or_default();
            for (is_allowed, what, value) in [
                (is_speed, "speed", speed.to_degrees()),
                (is_acceleration, "acceleration", acceleration.to_degrees()),
                (sign.abs() == 1, "sign", f64::from(sign)),
                // The solver panics beyond a whole turn.
                (offset.abs() <= TAU, "offset", offset.to_degrees()),
            ] {
                if !is_allowed {
                    return Err(ArmError::Value {
                        what: format!("the {what} of joint {}", i + 1),
                        value,
                    });
                }
            }
        }
        let names = ["a1", "a2", "b", "c1", "c2", "c3", "c4", "base_height"];
        let lengths = self.lengths.into_iter().chain([self.base_height]);
        for (name, value) in names.into_iter().zip(lengths) {
            let is_link = matches!(name, "c2" | "c3");
            if !(value.abs() <= 10.0) || (is_link && value < 0.01) {
                return Err(ArmError::Value {
                    what: name.into(),
                    value: value * 1000.0,
                });
            }
        }
        for (name, radius) in ["upper arm", "forearm", "wrist"]
            .into_iter()
            .zip(self.radii)
        {
            if !(0.0..=1.0).contains(&radius) {
                return Err(ArmError::Value {
                    what: format!("the radius of the {name}"),
                    value: radius * 1000.0,
                });
            }
        }
        if let Some(rail) = self.rail {
            rail.checked()?;
        }
        Ok(self)
    }
}
