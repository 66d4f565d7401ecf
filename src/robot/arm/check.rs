//! A path held against an arm.

use super::{
    Arm, ArmError, PlacedArm,
    chain::{Candidate, angle_of, candidates_of, free_chain, move_time, turned, turns_of},
    kinematics::{Joints, Solver},
    problem::PointProblem,
    rail_plan::rail_positions,
};
use crate::geometry::rigid::{RigidTransform, is_finite};

/// A place of the nozzle that the arm shall reach.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ArmPoint {
    /// Frame of the path from the nozzle: origin at the mouth, z towards the part.
    pub robot_from_nozzle: RigidTransform,
    /// Speed on the way to the next point, m/s.
    pub speed: f64,
    /// True if the jet is round: the nozzle may turn about its z axis.
    pub is_turn_free: bool,
    /// True if the gun sprays on the way to the next point: a rail rather moves elsewhere.
    pub is_gun_on: bool,
}

/// Parameters of [`check_path`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CheckParams {
    /// Turns about the nozzle's z axis that are tried, 1..72. Raising it costs as much time.
    pub num_turns: usize,
    /// Where a rail stands that does not move along the path, metres; 0 without one.
    pub rail: f64,
}

impl Default for CheckParams {
    fn default() -> Self {
        Self {
            num_turns: 24,
            rail: 0.0,
        }
    }
}

/// One point of a check.
#[derive(Clone, Debug, PartialEq)]
pub struct PointCheck {
    /// The joints there; none if it is out of reach or beyond a limit.
    pub joints: Option<Joints>,
    /// Turn about the nozzle's z axis against the path, radians within ±π.
    pub turn: f64,
    /// Where the rail is, metres; 0 without one.
    pub rail: f64,
    /// What is wrong with it.
    pub problem: Option<PointProblem>,
}

/// What came of a check.
#[derive(Clone, Debug, PartialEq)]
pub struct PathCheck {
    /// Every point, in the path's order.
    pub points: Vec<PointCheck>,
    /// Where a program of the path begins and ends; none if the path alone was checked. What is wrong there counts for the
    /// first and the last point.
    pub ends: Option<[PointCheck; 2]>,
}

impl PathCheck {
    /// Points without a problem.
    pub fn num_reached(&self) -> usize {
        self.points
            .iter()
            .filter(|point| point.problem.is_none())
            .count()
    }

    /// Points at which, or on the way to which, gun or arm come too near to something. The way to a point that is out of
    /// reach is not known.
    pub fn num_collisions(&self) -> usize {
        let problems = self.points.iter().map(|point| &point.problem);
        problems
            .filter(|problem| matches!(problem, Some(PointProblem::Collision { .. })))
            .count()
    }

    /// The least and the greatest position of the rail along the path and at the ends of its program, metres.
    pub fn rail_range(&self) -> [f64; 2] {
        let ends = self.ends.iter().flatten();
        let positions = self.points.iter().chain(ends).map(|point| point.rail);
        let range = [f64::INFINITY, f64::NEG_INFINITY];
        positions.fold(range, |[low, high], at| [low.min(at), high.max(at)])
    }

    /// Why no program should be written for this arm, in words; none if it reaches every point.
    pub fn doubt(&self, arm: &str) -> Option<String> {
        let (num, all) = (self.num_reached(), self.points.len());
        let collisions = match self.num_collisions() {
            0 => String::new(),
            num => format!(" and would collide at {num}"),
        };
        (num < all).then(|| format!("{arm} reaches {num} of {all} points{collisions}"))
    }
}

/// Straight moves are followed in steps of at most this, metres and radians.
const STEP: [f64; 2] = [0.05, 0.175];
/// Two solutions are the same within this, radians.
const SAME: f64 = 1e-4;

/// Every point of the path with the joints that reach it, or why none do. The points of a path without a problem are
/// reached one after the other by straight moves at their speed.
pub fn check_path(
    placed: &PlacedArm,
    points: &[ArmPoint],
    params: &CheckParams,
) -> Result<PathCheck, ArmError> {
    refuse_bad(placed, points, params)?;
    let rails = rail_positions(placed, points, params);
    let solvers: Vec<Solver<'_>> = rails
        .iter()
        .map(|rail| Solver::new(placed, *rail))
        .collect();
    let mut candidates: Vec<Vec<Candidate>> = solvers
        .iter()
        .zip(points)
        .map(|(solver, point)| candidates_of(solver, point, params.num_turns))
        .collect();
    let chosen = free_chain(&solvers, points, &mut candidates, params.num_turns);
    let mut checked: Vec<PointCheck> = Vec::with_capacity(points.len());
    for (i, point) in points.iter().enumerate() {
        let (solver, rail) = (&solvers[i], rails[i]);
        let Some(candidate) = chosen[i].map(|index| candidates[i][index]) else {
            checked.push(PointCheck {
                joints: None,
                turn: 0.0,
                rail,
                problem: Some(why_not(solver, point, params.num_turns)),
            });
            continue;
        };
        let turn = angle_of(candidate.turn, params.num_turns);
        let singular = solver.singularity(&candidate.joints);
        let before = i.checked_sub(1).and_then(|before| {
            let from: &PointCheck = &checked[before];
            let end = WayEnd {
                nozzle: turned(&points[before], from.turn),
                joints: from.joints?,
                rail: from.rail,
            };
            Some((end, points[before].speed))
        });
        let to = WayEnd {
            nozzle: turned(point, turn),
            joints: candidate.joints,
            rail,
        };
        // What would break something comes first.
        let here = if candidate.is_collision == Some(true) {
            solver.collision(&candidate.joints)
        } else {
            None
        };
        let problem = here
            .or_else(|| before.and_then(|(from, speed)| way_problem(placed, &from, &to, speed)));
        checked.push(PointCheck {
            joints: Some(candidate.joints),
            turn,
            rail,
            problem: problem.or(singular.map(PointProblem::NearSingularity)),
        });
    }
    Ok(PathCheck {
        points: checked,
        ends: None,
    })
}

/// Refuses what cannot be checked; a point is named by its place in `points`.
pub(in crate::robot) fn refuse_bad(
    placed: &PlacedArm,
    points: &[ArmPoint],
    params: &CheckParams,
) -> Result<(), ArmError> {
    let not_finite = |what: String| Err(ArmError::NotFinite { what });
    if points.is_empty() {
        return Err(ArmError::NoPoints);
    }
    if !is_finite(&placed.robot_from_base) {
        return not_finite("the pose of the arm's base".into());
    }
    if !is_finite(&placed.flange_from_nozzle) {
        return not_finite("the pose of the nozzle on the flange".into());
    }
    if !params.rail.is_finite() {
        return not_finite("the position of the rail".into());
    }
    if let Some(rail) = placed.arm.rail {
        rail.checked()?;
    }
    for (what, value) in [
        ("the radius of the gun", placed.gun_radius),
        ("the clearance", placed.obstacles.clearance),
    ] {
        if !(0.0..=1.0).contains(&value) {
            return Err(ArmError::Value {
                what: what.into(),
                value: 1000.0 * value,
            });
        }
    }
    for (i, point) in points.iter().enumerate() {
        let is_speed = point.speed > 0.0 && point.speed < 100.0;
        if !(is_finite(&point.robot_from_nozzle) && is_speed) {
            return not_finite(format!("the pose or speed of point {}", i + 1));
        }
    }
    Ok(())
}

/// Where a straight move begins or ends.
struct WayEnd {
    nozzle: RigidTransform,
    joints: Joints,
    rail: f64,
}

/// Follows a straight move from one chosen solution towards the next, and says what is wrong with it.
fn way_problem(
    placed: &PlacedArm,
    start: &WayEnd,
    end: &WayEnd,
    speed: f64,
) -> Option<PointProblem> {
    let (from, to) = (&start.nozzle, &end.nozzle);
    let distance = (to.translation.vector - from.translation.vector).norm();
    let angle = from.rotation.angle_to(&to.rotation);
    let ride = (end.rail - start.rail).abs();
    let num = (distance.max(ride) / STEP[0]).max(angle / STEP[1]);
    let num = num.ceil().max(1.0);
    let allowed = move_time(from, to, speed);
    let mut trouble = rail_problem(&placed.arm, ride, allowed);
    let allowed = allowed.map(|time| time / num);
    let mut at = start.joints;
    for k in 1..=num as usize {
        let share = k as f64 / num;
        let solver = Solver::new(placed, start.rail + (end.rail - start.rail) * share);
        let near = if k == num as usize {
            end.joints
        } else {
            let pose = nalgebra::Isometry3::from_parts(
                (from.translation.vector.lerp(&to.translation.vector, share)).into(),
                from.rotation.slerp(&to.rotation, share),
            );
            let Some(nearest) = nearest(&solver, &pose, &at) else {
                return trouble.or(Some(PointProblem::OutOfReach));
            };
            // It comes before whatever else is wrong. The ends of the way are points, which are tested.
            if let Some(collision) = solver.collision(&nearest) {
                return Some(collision);
            }
            nearest
        };
        trouble = trouble.or_else(|| step_problem(&solver, &at, &near, allowed));
        if k == num as usize {
            trouble = trouble.or_else(|| arrival_problem(&solver, start, end, &at));
        }
        at = near;
    }
    trouble
}

/// The largest difference between two joints, radians.
fn apart(a: &Joints, b: &Joints) -> f64 {
    let all = a.iter().zip(b);
    all.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// The joints nearest to `at` that reach a pose.
fn nearest(solver: &Solver<'_>, pose: &RigidTransform, at: &Joints) -> Option<Joints> {
    let solutions = solver.solutions(pose, Some(at)).into_iter();
    solutions.min_by(|a, b| apart(a, at).total_cmp(&apart(b, at)))
}

/// What is wrong if a straight move from `at`, shortly before its end, does not arrive with the joints chosen there. However
/// slow the move is, the controller neither folds the arm over on it nor turns a joint once around.
fn arrival_problem(
    solver: &Solver<'_>,
    start: &WayEnd,
    end: &WayEnd,
    at: &Joints,
) -> Option<PointProblem> {
    /// Two solutions that are not singular are farther apart, radians.
    const OTHER: f64 = 0.01;
    // At a singularity, which is a problem of its own, several solutions meet.
    let ends = [&start.joints, &end.joints];
    if ends
        .iter()
        .any(|joints| solver.singularity(joints).is_some())
    {
        return None;
    }
    let arrives = nearest(solver, &end.nozzle, at)?;
    if apart(&arrives, &end.joints) < OTHER {
        return None;
    }
    let beyond = outside(solver, &arrives).map(|(joint, angle)| PointProblem::JointLimit {
        joint: joint + 1,
        angle,
    });
    Some(beyond.unwrap_or(PointProblem::ConfigurationChange))
}

/// Whether the rail gets as far in so many seconds, or in as many as it wants.
fn rail_problem(arm: &Arm, ride: f64, allowed: Option<f64>) -> Option<PointProblem> {
    /// The times of a run are sums, which are not exact.
    const EXACT: f64 = 1e-6;
    let (_, fastest) = arm.moving_rail()?;
    let speed = ride / allowed?;
    (speed > fastest * (1.0 + EXACT)).then_some(PointProblem::RailTooFast { speed })
}

/// What is wrong with a short step from one solution to the next, which may take so many seconds, or as many as it wants.
fn step_problem(
    solver: &Solver<'_>,
    at: &Joints,
    near: &Joints,
    allowed: Option<f64>,
) -> Option<PointProblem> {
    if let Some((joint, angle)) = outside(solver, near) {
        return Some(PointProblem::JointLimit {
            joint: joint + 1,
            angle,
        });
    }
    let time = allowed.unwrap_or(f64::INFINITY);
    let is_too_fast = |i: &usize| {
        let moved = (near[*i] - at[*i]).abs();
        moved / time > solver.arm.speeds[*i] && moved >= SAME
    };
    let i = (0..6).find(is_too_fast)?;
    Some(
        if solver.arm.configuration(near) == solver.arm.configuration(at) {
            PointProblem::TooFast {
                joint: i + 1,
                speed: (near[i] - at[i]).abs() / time,
            }
        } else {
            PointProblem::ConfigurationChange
        },
    )
}

/// The first joint outside its limits, as it stands.
fn outside(solver: &Solver<'_>, joints: &Joints) -> Option<(usize, f64)> {
    let limits = solver.arm.limits.iter().zip(joints).enumerate();
    let mut beyond =
        limits.filter(|(_, ([low, high], angle))| !(low - SAME..=high + SAME).contains(*angle));
    beyond.next().map(|(i, (_, angle))| (i, *angle))
}

/// Why no solution is left at a point.
fn why_not(solver: &Solver<'_>, point: &ArmPoint, num_turns: usize) -> PointProblem {
    let mut nearest: Option<(f64, PointProblem)> = None;
    for turn in turns_of(point, num_turns) {
        for joints in solver.solutions(&turned(point, angle_of(turn, num_turns)), None) {
            let Some((joint, angle)) = solver.beyond_limit(&joints) else {
                continue;
            };
            let [low, high] = solver.arm.limits[joint];
            let excess = (low - angle).max(angle - high);
            if nearest.as_ref().is_none_or(|(least, _)| excess < *least) {
                let joint = joint + 1;
                nearest = Some((excess, PointProblem::JointLimit { joint, angle }));
            }
        }
    }
    nearest.map_or(PointProblem::OutOfReach, |(_, problem)| problem)
}

/// Whether a point is reached at all, at any turn, without a collision.
pub(super) fn is_reached(solver: &Solver<'_>, point: &ArmPoint, num_turns: usize) -> bool {
    /// Where the first few collide the others usually do as well, and hundreds of places are asked for.
    const NUM_TESTED: usize = 6;
    let poses = turns_of(point, num_turns).map(|turn| turned(point, angle_of(turn, num_turns)));
    let solutions = poses.flat_map(|pose| solver.solutions(&pose, None));
    let mut within = solutions
        .filter(|joints| {
            solver.beyond_limit(joints).is_none() && solver.singularity(joints).is_none()
        })
        .take(NUM_TESTED);
    within.any(|joints| !solver.collides(&joints))
}
