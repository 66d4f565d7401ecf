//! A path held against an arm.

use std::f64::consts::TAU;

use nalgebra::UnitQuaternion;

use super::{
    ArmError, PlacedArm,
    kinematics::{Joints, Singularity, Solver},
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
}

/// Parameters of [`check_path`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CheckParams {
    /// Turns about the nozzle's z axis that are tried, 1..72. Raising it costs as much time.
    pub num_turns: usize,
    /// Where the rail stands, metres; 0 without one.
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

/// Why a point is no good.
#[derive(Clone, Copy, Debug, PartialEq)]
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
    /// On the way from the point before, the arm would have to fold over.
    ConfigurationChange,
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
            Self::ConfigurationChange => "the arm would have to fold over".into(),
        }
    }
}

/// One point of a check.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointCheck {
    /// The joints there; none if it is out of reach or beyond a limit.
    pub joints: Option<Joints>,
    /// Turn about the nozzle's z axis against the path, radians within ±π.
    pub turn: f64,
    /// What is wrong with it.
    pub problem: Option<PointProblem>,
}

/// What came of a check.
#[derive(Clone, Debug, PartialEq)]
pub struct PathCheck {
    /// Every point, in the path's order.
    pub points: Vec<PointCheck>,
}

impl PathCheck {
    /// Points without a problem.
    pub fn num_reached(&self) -> usize {
        self.points
            .iter()
            .filter(|point| point.problem.is_none())
            .count()
    }

    /// Why no program should be written for this arm, in words; none if it reaches every point.
    pub fn doubt(&self, arm: &str) -> Option<String> {
        let (num, all) = (self.num_reached(), self.points.len());
        (num < all).then(|| format!("{arm} reaches {num} of {all} points"))
    }
}

/// Straight moves are followed in steps of at most this, metres and radians.
const STEP: [f64; 2] = [0.05, 0.175];
/// Costs as much as this many seconds of joint motion: a singularity nearby, and a turn by one step.
const SINGULAR_COST: f64 = 2.0;
const TURN_COST: f64 = 0.02;
/// A way that no joint manages costs this much and more.
const JUMP_COST: f64 = 1e4;
/// Two solutions are the same within this, radians.
const SAME: f64 = 1e-4;

/// One way to stand at a point.
#[derive(Clone, Copy)]
struct Candidate {
    joints: Joints,
    turn: usize,
    /// Of the point alone.
    cost: f64,
}

/// Every point of the path with the joints that reach it, or why none do. The points of a path without a problem are
/// reached one after the other by straight moves at their speed.
pub fn check_path(
    placed: &PlacedArm,
    points: &[ArmPoint],
    params: &CheckParams,
) -> Result<PathCheck, ArmError> {
    refuse_bad(placed, points, params)?;
    let solver = Solver::new(placed, params.rail);
    let candidates: Vec<Vec<Candidate>> = points
        .iter()
        .map(|point| candidates_of(&solver, point, params.num_turns))
        .collect();
    let chosen = best_chain(placed, points, &candidates, params.num_turns);
    let mut checked: Vec<PointCheck> = Vec::with_capacity(points.len());
    for (i, point) in points.iter().enumerate() {
        let Some(candidate) = chosen[i].map(|index| candidates[i][index]) else {
            checked.push(PointCheck {
                joints: None,
                turn: 0.0,
                problem: Some(why_not(&solver, point, params.num_turns)),
            });
            continue;
        };
        let turn = angle_of(candidate.turn, params.num_turns);
        let singular = solver.singularity(&candidate.joints);
        let before = i.checked_sub(1).and_then(|before| {
            let from: &PointCheck = &checked[before];
            Some((
                turned(&points[before], from.turn),
                from.joints?,
                points[before].speed,
            ))
        });
        let to = (turned(point, turn), candidate.joints);
        let moved = before.and_then(|from| way_problem(&solver, from, to));
        checked.push(PointCheck {
            joints: Some(candidate.joints),
            turn,
            problem: moved.or(singular.map(PointProblem::NearSingularity)),
        });
    }
    Ok(PathCheck { points: checked })
}

pub(super) fn refuse_bad(
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
    for (i, point) in points.iter().enumerate() {
        let is_speed = point.speed > 0.0 && point.speed < 100.0;
        if !(is_finite(&point.robot_from_nozzle) && is_speed) {
            return not_finite(format!("the pose or speed of point {}", i + 1));
        }
    }
    Ok(())
}

/// Angle of a step about z, radians within ±π; the steps are even.
fn angle_of(turn: usize, num_turns: usize) -> f64 {
    let angle = TAU * turn as f64 / num_turns as f64;
    if angle > std::f64::consts::PI {
        angle - TAU
    } else {
        angle
    }
}

/// Steps between two turns, the shorter way round.
fn turns_apart(a: usize, b: usize, num_turns: usize) -> usize {
    let apart = a.abs_diff(b);
    apart.min(num_turns.max(1).saturating_sub(apart))
}

fn turned(point: &ArmPoint, angle: f64) -> RigidTransform {
    point.robot_from_nozzle * UnitQuaternion::from_euler_angles(0.0, 0.0, angle)
}

/// The turns that are tried at a point.
fn turns_of(point: &ArmPoint, num_turns: usize) -> std::ops::Range<usize> {
    0..if point.is_turn_free {
        num_turns.max(1)
    } else {
        1
    }
}

fn candidates_of(solver: &Solver<'_>, point: &ArmPoint, num_turns: usize) -> Vec<Candidate> {
    let mut all = Vec::new();
    for turn in turns_of(point, num_turns) {
        let pose = turned(point, angle_of(turn, num_turns));
        for solution in solver.solutions(&pose, None) {
            let is_singular = solver.singularity(&solution).is_some();
            // Turning away from the path's own orientation gains nothing by itself.
            let away = turn.min(num_turns - turn) as f64;
            let cost = 0.1 * TURN_COST * away + if is_singular { SINGULAR_COST } else { 0.0 };
            all.extend(
                solver
                    .within_limits(&solution)
                    .into_iter()
                    .map(|joints| Candidate { joints, turn, cost }),
            );
        }
    }
    all
}

/// Seconds that the slowest joint needs from one to the other, and that joint.
fn joint_time(placed: &PlacedArm, from: &Joints, to: &Joints) -> (f64, usize) {
    let mut worst = (0.0, 0);
    for i in 0..6 {
        let time = (to[i] - from[i]).abs() / placed.arm.speeds[i];
        if time > worst.0 {
            worst = (time, i);
        }
    }
    worst
}

/// Seconds that a move takes: a turn on the spot takes as long as the joints want.
fn move_time(from: &RigidTransform, to: &RigidTransform, speed: f64) -> Option<f64> {
    /// Nothing moves by less, metres.
    const STANDS: f64 = 1e-4;
    let distance = (to.translation.vector - from.translation.vector).norm();
    (distance > STANDS).then(|| distance / speed)
}

/// The cheapest chain of candidates; none where there is no candidate, behind which a new chain begins.
fn best_chain(
    placed: &PlacedArm,
    points: &[ArmPoint],
    candidates: &[Vec<Candidate>],
    num_turns: usize,
) -> Vec<Option<usize>> {
    // Of every candidate the cost so far and the candidate of the point before.
    let mut chains: Vec<Vec<(f64, Option<usize>)>> = Vec::with_capacity(points.len());
    for (i, here) in candidates.iter().enumerate() {
        let before = i
            .checked_sub(1)
            .map(|before| (&candidates[before], &chains[before]));
        let row = here.iter().map(|candidate| {
            let Some((former, costs)) = before.filter(|(former, _)| !former.is_empty()) else {
                return (candidate.cost, None);
            };
            let (from, to) = (
                &points[i - 1].robot_from_nozzle,
                &points[i].robot_from_nozzle,
            );
            let allowed = move_time(from, to, points[i - 1].speed);
            let step = |previous: &Candidate| {
                let apart = turns_apart(previous.turn, candidate.turn, num_turns);
                let (time, _) = joint_time(placed, &previous.joints, &candidate.joints);
                let is_jump = allowed.map_or(time > 1.0, |allowed| time > allowed);
                time + TURN_COST * apart as f64 + if is_jump { JUMP_COST } else { 0.0 }
            };
            let cheapest = |is_near: bool| {
                let mut best = (f64::INFINITY, None);
                for (k, (previous, (cost, _))) in former.iter().zip(costs).enumerate() {
                    let is_out = turns_apart(previous.turn, candidate.turn, num_turns) > 1;
                    if *cost >= best.0 || (is_near && is_out) {
                        continue;
                    }
                    let cost = cost + step(previous);
                    if cost < best.0 {
                        best = (cost, Some(k));
                    }
                }
                best
            };
            // A nozzle that turns farther at once is only looked at where nothing else goes on.
            let near = cheapest(true);
            let best = if near.1.is_some() {
                near
            } else {
                cheapest(false)
            };
            (best.0 + candidate.cost, best.1)
        });
        let row = row.collect();
        chains.push(row);
    }
    let mut chosen = vec![None; points.len()];
    let mut next: Option<usize> = None;
    for (i, row) in chains.iter().enumerate().rev() {
        let cheapest = || {
            let costs = row.iter().enumerate();
            costs.min_by(|a, b| a.1.0.total_cmp(&b.1.0)).map(|(k, _)| k)
        };
        chosen[i] = next.or_else(cheapest);
        next = chosen[i].and_then(|k| row[k].1);
    }
    chosen
}

/// Follows a straight move from one chosen solution towards the next, and says what is wrong with it.
fn way_problem(
    solver: &Solver<'_>,
    (from, start, speed): (RigidTransform, Joints, f64),
    (to, end): (RigidTransform, Joints),
) -> Option<PointProblem> {
    let distance = (to.translation.vector - from.translation.vector).norm();
    let angle = from.rotation.angle_to(&to.rotation);
    let num = (distance / STEP[0]).max(angle / STEP[1]).ceil().max(1.0);
    let allowed = move_time(&from, &to, speed).map(|time| time / num);
    let mut at = start;
    for k in 1..=num as usize {
        let near = if k == num as usize {
            end
        } else {
            let share = k as f64 / num;
            let pose = nalgebra::Isometry3::from_parts(
                (from.translation.vector.lerp(&to.translation.vector, share)).into(),
                from.rotation.slerp(&to.rotation, share),
            );
            let off = |joints: &Joints| {
                let all = joints.iter().zip(&at);
                all.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
            };
            let solutions = solver.solutions(&pose, Some(&at)).into_iter();
            let nearest = solutions.min_by(|a, b| off(a).total_cmp(&off(b)));
            let Some(nearest) = nearest else {
                return Some(PointProblem::OutOfReach);
            };
            nearest
        };
        if let Some((joint, angle)) = outside(solver, &near) {
            return Some(PointProblem::JointLimit {
                joint: joint + 1,
                angle,
            });
        }
        for i in 0..6 {
            let moved = (near[i] - at[i]).abs();
            let time = allowed.unwrap_or(f64::INFINITY);
            if moved / time <= solver.arm.speeds[i] || moved < SAME {
                continue;
            }
            return Some(
                if solver.configuration(&near) == solver.configuration(&at) {
                    PointProblem::TooFast {
                        joint: i + 1,
                        speed: moved / time,
                    }
                } else {
                    PointProblem::ConfigurationChange
                },
            );
        }
        at = near;
    }
    None
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
            if nearest.is_none_or(|(least, _)| excess < least) {
                let joint = joint + 1;
                nearest = Some((excess, PointProblem::JointLimit { joint, angle }));
            }
        }
    }
    nearest.map_or(PointProblem::OutOfReach, |(_, problem)| problem)
}

/// Whether a point is reached at all, at any turn.
pub(super) fn is_reached(solver: &Solver<'_>, point: &ArmPoint, num_turns: usize) -> bool {
    turns_of(point, num_turns).any(|turn| {
        let solutions = solver.solutions(&turned(point, angle_of(turn, num_turns)), None);
        let mut within = solutions.iter().filter(|joints| {
            solver.beyond_limit(joints).is_none() && solver.singularity(joints).is_none()
        });
        within.next().is_some()
    })
}
