//! Checks a path against an arm.

use nalgebra::Translation3;

use super::{
    ArmError, FilmRoom, NotReached, PlacedArm,
    chain::{UPRIGHT, angle_of, nozzle_at, turns_of},
    check_points::{check_points, num_bad},
    kinematics::{Joints, Solver},
    problem::PointProblem,
    validate::validate,
    way::Way,
};
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

/// Parameters of [`check_path`].
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

/// Finds the joints for every point of the path, or the problem there. Points without a problem are reached one after
/// the other by straight moves at their speed; with the gun off, more slowly or by joint moves where that is needed.
/// With an approach distance, the moves to and from the path are checked as well; their problems are reported at the first
/// and the last point.
pub fn check_path(
    placed: &PlacedArm,
    points: &[ArmPoint],
    params: &CheckParams<'_>,
) -> Result<PathCheck, ArmError> {
    check_unless(&|| false, placed, points, params)
}

/// As [`check_path`], but returns [`ArmError::Cancelled`] soon after `is_cancelled` returns true.
pub(super) fn check_unless(
    is_cancelled: &(dyn Fn() -> bool + Sync),
    placed: &PlacedArm,
    points: &[ArmPoint],
    params: &CheckParams<'_>,
) -> Result<PathCheck, ArmError> {
    // Before the ends are added, so that an error counts the path's own points.
    validate(placed, points, params)?;
    let ends = params.approach.and_then(|away| ends_of(points, away));
    let Some([approach, retreat]) = ends else {
        let points = check_points(is_cancelled, placed, points, params)?;
        return Ok(PathCheck { points, ends: None });
    };
    let mut all = vec![approach];
    all.extend(points);
    // The gun is off behind the last point, whatever the path says.
    if let Some(last) = all.last_mut() {
        last.is_gun_on = false;
    }
    all.push(retreat);
    let mut points = check_points(is_cancelled, placed, &all, params)?;
    let retreat = points.pop();
    let approach = points.remove(0);
    if let (Some(last), Some(retreat)) = (points.last_mut(), &retreat) {
        last.problem = graver(last.problem.take(), retreat.problem.clone());
    }
    if let Some(first) = points.first_mut() {
        first.problem = graver(first.problem.take(), approach.problem.clone());
    }
    let ends = retreat.map(|retreat| [approach, retreat]);
    Ok(PathCheck { points, ends })
}

/// The approach point and the end of a program, this far behind the first and the last point of its path.
pub(super) fn ends_of(points: &[ArmPoint], distance: f64) -> Option<[ArmPoint; 2]> {
    let away = Translation3::new(0.0, 0.0, -distance);
    let behind = |point: &ArmPoint| ArmPoint {
        robot_from_nozzle: point.robot_from_nozzle * away,
        is_gun_on: false,
        ..*point
    };
    Some([behind(points.first()?), behind(points.last()?)])
}

/// Returns the problem to report: a collision takes precedence.
fn graver(own: Option<PointProblem>, other: Option<PointProblem>) -> Option<PointProblem> {
    if matches!(other, Some(PointProblem::Collision { .. })) {
        other
    } else {
        own.or(other)
    }
}

/// Whether a point can be reached at some turn without a collision.
pub(super) fn is_reached(solver: &Solver<'_>, point: &ArmPoint, num_turns: usize) -> bool {
    /// If the first few solutions collide, the others usually do as well, and there are hundreds of places to compare.
    const NUM_TESTED: usize = 6;
    let poses =
        turns_of(point, num_turns).map(|turn| nozzle_at(point, UPRIGHT, angle_of(turn, num_turns)));
    let solutions = poses.flat_map(|pose| solver.solutions(&pose, None));
    let mut within = solutions
        .filter(|joints| {
            solver.beyond_limit(joints).is_none() && solver.singularity(joints).is_none()
        })
        .take(NUM_TESTED);
    within.any(|joints| !solver.collides(&joints))
}
