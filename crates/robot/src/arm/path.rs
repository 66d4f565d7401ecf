//! The path that an arm has to run, how it is checked, and what the check finds.

use super::{FilmRoom, NotReached, kinematics::Joints, problem::PointProblem};
use geometry::rigid::RigidTransform;

/// A pose of the nozzle that the arm must reach.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ArmPoint {
    /// Pose of the nozzle in the frame of the path: origin at the mouth, z towards the part.
    pub robot_from_nozzle: RigidTransform,
    /// Speed on the way to the next point, m/s.
    pub speed: f64,
    /// Distance from the mouth to the point on the part that it aims at, metres: the nozzle is tilted about that point.
    pub aim: f64,
    /// True if the jet is round: the nozzle may turn about its z axis. A fan may turn by 180° only.
    pub is_turn_free: bool,
    /// True if the gun sprays on the way to the next point; a rail moves there only if it must.
    pub is_gun_on: bool,
    /// True if the arm stops here, so that no joint has to accelerate in passing.
    pub is_stop: bool,
}

/// Parameters of `check_path`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CheckParams<'a> {
    /// Turns about the nozzle's z axis that are tried, 1..72. The time grows in proportion.
    pub num_turns: usize,
    /// Maximum tilt of the nozzle, radians, 0..π/6. It is only tilted where the arm cannot otherwise follow the path.
    pub max_tilt: f64,
    /// Position of a rail that does not move along the path, metres; 0 without one.
    pub rail: f64,
    /// Distance of the approach point behind the first point, and of the end behind the last, metres; none to check the
    /// path alone.
    pub approach: Option<f64>,
    /// How much longer the gun may spray on each way of the path for joints and rail that cannot follow at its speed; none
    /// if it must keep the path's speeds.
    pub film: Option<&'a FilmRoom>,
}

impl Default for CheckParams<'_> {
    fn default() -> Self {
        Self {
            num_turns: 24,
            max_tilt: 0.0,
            rail: 0.0,
            approach: None,
            film: None,
        }
    }
}

/// How the arm moves to a point.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Way {
    /// In a straight line, at the speed of the path.
    #[default]
    Planned,
    /// In a straight line with the gun off, at this lower speed, m/s.
    Slower(f64),
    /// In a straight line with the gun on, at this lower speed, m/s; the film stays within its tolerance.
    SlowerSpraying(f64),
    /// By a joint move with the gun off, for example to change the configuration.
    Joints,
}

/// Result for one point.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PointCheck {
    /// The joints; none if the point is out of reach or beyond a limit.
    pub joints: Option<Joints>,
    /// Pose of the nozzle: that of the path, turned and tilted.
    pub robot_from_nozzle: RigidTransform,
    /// Turn about the nozzle's z axis relative to the path, radians within ±π.
    pub turn: f64,
    /// Tilt relative to the path about the point that the nozzle aims at, radians, 0 or more.
    pub tilt: f64,
    /// Position of the rail, metres; 0 without one.
    pub rail: f64,
    /// How the arm moves here from the previous point.
    pub way: Way,
    /// The problem of the point, or of the move to it, if any.
    pub problem: Option<PointProblem>,
}

/// Result of a check.
#[derive(Clone, Debug, PartialEq)]
pub struct PathCheck {
    /// One per point, in the path's order.
    pub points: Vec<PointCheck>,
    /// Approach point and end of a program of the path; none if the path alone was checked. Their problems are reported
    /// at the first and the last point.
    pub ends: Option<[PointCheck; 2]>,
}

impl PathCheck {
    /// Number of points without a problem.
    pub fn num_reached(&self) -> usize {
        self.points.len() - num_bad(&self.points)
    }

    /// Number of points at which the nozzle is tilted, and the greatest tilt, radians; `None` if it is tilted at none.
    pub fn tilted(&self) -> Option<(usize, f64)> {
        let tilts = self.points.iter().map(|point| point.tilt);
        let tilts = tilts.filter(|tilt| *tilt > 0.0);
        let (num, most) = tilts.fold((0, 0.0_f64), |(num, most), tilt| (num + 1, most.max(tilt)));
        (num > 0).then_some((num, most))
    }

    /// Numbers of moves with the gun off that are slower than in the path, of those that became joint moves, and of moves
    /// with the gun on that are slower.
    pub fn changed_moves(&self) -> [usize; 3] {
        let count = |is: fn(Way) -> bool| self.points.iter().filter(|point| is(point.way)).count();
        [
            count(|way| matches!(way, Way::Slower(_))),
            count(|way| way == Way::Joints),
            count(|way| matches!(way, Way::SlowerSpraying(_))),
        ]
    }

    /// Number of points at which, or on the way to which, gun or arm collide. The way to a point that is out of reach
    /// is not known.
    pub fn num_collisions(&self) -> usize {
        let problems = self.points.iter().map(|point| &point.problem);
        problems
            .filter(|problem| matches!(problem, Some(PointProblem::Collision { .. })))
            .count()
    }

    /// Least and greatest position of the rail along the path and at the ends of its program, metres.
    pub fn rail_range(&self) -> [f64; 2] {
        let ends = self.ends.iter().flatten();
        let positions = self.points.iter().chain(ends).map(|point| point.rail);
        let range = [f64::INFINITY, f64::NEG_INFINITY];
        positions.fold(range, |[low, high], at| [low.min(at), high.max(at)])
    }

    /// What the arm of this name misses; `None` if it reaches every point without a collision.
    pub fn missed(&self, arm: &str) -> Option<NotReached> {
        let (num_reached, num_points) = (self.num_reached(), self.points.len());
        (num_reached < num_points).then(|| NotReached {
            arm: arm.to_owned(),
            num_reached,
            num_collisions: self.num_collisions(),
            num_points,
        })
    }
}

/// Number of points with a problem.
pub(super) fn num_bad(checked: &[PointCheck]) -> usize {
    checked
        .iter()
        .filter(|point| point.problem.is_some())
        .count()
}
