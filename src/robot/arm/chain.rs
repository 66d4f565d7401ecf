//! The joints that an arm may take at each point of a path, and the cheapest chain of them.

use std::f64::consts::{PI, TAU};

use nalgebra::UnitQuaternion;

use super::{
    Arm,
    check::ArmPoint,
    kinematics::{Joints, Solver},
};
use crate::geometry::rigid::RigidTransform;

/// Costs in seconds of joint motion: of a singularity nearby, and of turning the nozzle by one step.
const SINGULAR_COST: f64 = 2.0;
const TURN_COST: f64 = 0.02;
/// Least cost of a move that is too fast for a joint, changes the configuration or turns a joint by more than half a
/// turn.
const JUMP_COST: f64 = 1e4;
/// A collision costs as much as a hundred jumps: like a solution beyond a limit, it is only chosen if none is free.
const COLLISION_COST: f64 = 1e6;
/// Chains chosen before every candidate is tested for collisions.
const LAZY_ROUNDS: usize = 3;

/// Possible joints at a point.
#[derive(Clone, Copy)]
pub(super) struct Candidate {
    pub(super) joints: Joints,
    pub(super) turn: usize,
    /// The configuration, one of eight, as one bit.
    configuration: u8,
    /// Cost of the point itself, without the move to it.
    cost: f64,
    /// Whether it collides; none if not tested yet.
    pub(super) is_collision: Option<bool>,
}

impl Candidate {
    /// Whether it collides. Tests it once and adds a collision to its cost.
    fn collides(&mut self, solver: &Solver<'_>) -> bool {
        if let Some(known) = self.is_collision {
            return known;
        }
        let collides = solver.collides(&self.joints);
        if collides {
            self.cost += COLLISION_COST;
        }
        self.is_collision = Some(collides);
        collides
    }
}

/// Angle of a step about z, radians within ±π; the steps are even.
pub(super) fn angle_of(turn: usize, num_turns: usize) -> f64 {
    let angle = TAU * turn as f64 / num_turns as f64;
    if angle > PI { angle - TAU } else { angle }
}

/// Steps between two turns, the shorter way round.
fn turns_apart(a: usize, b: usize, num_turns: usize) -> usize {
    let apart = a.abs_diff(b);
    apart.min(num_turns - apart)
}

pub(super) fn turned(point: &ArmPoint, angle: f64) -> RigidTransform {
    point.robot_from_nozzle * UnitQuaternion::from_euler_angles(0.0, 0.0, angle)
}

/// The turns to be tried at a point.
pub(super) fn turns_of(point: &ArmPoint, num_turns: usize) -> std::ops::Range<usize> {
    0..if point.is_turn_free { num_turns } else { 1 }
}

pub(super) fn candidates_of(
    solver: &Solver<'_>,
    point: &ArmPoint,
    num_turns: usize,
) -> Vec<Candidate> {
    let mut all = Vec::new();
    for turn in turns_of(point, num_turns) {
        let pose = turned(point, angle_of(turn, num_turns));
        for solution in solver.solutions(&pose, None) {
            let is_singular = solver.singularity(&solution).is_some();
            let configuration = solver.arm.configuration_bit(&solution);
            // Turning away from the path's own orientation has no benefit of its own.
            let away = turn.min(num_turns - turn) as f64;
            let cost = 0.1 * TURN_COST * away + if is_singular { SINGULAR_COST } else { 0.0 };
            all.extend(
                solver
                    .within_limits(&solution)
                    .into_iter()
                    .map(|joints| Candidate {
                        joints,
                        turn,
                        configuration,
                        cost,
                        is_collision: None,
                    }),
            );
        }
    }
    all
}

/// Returns the seconds that the slowest joint needs between two positions, and the largest angle of a joint, radians.
fn joint_time(arm: &Arm, from: &Joints, to: &Joints) -> (f64, f64) {
    let mut worst = (0.0_f64, 0.0_f64);
    for ((to, from), speed) in to.iter().zip(from).zip(arm.speeds) {
        let angle = (to - from).abs();
        worst = (worst.0.max(angle / speed), worst.1.max(angle));
    }
    worst
}

/// Returns the seconds of a move; `None` for a turn on the spot, which takes as long as the joints need.
pub(super) fn move_time(from: &RigidTransform, to: &RigidTransform, speed: f64) -> Option<f64> {
    /// Shorter moves count as standing still, metres.
    const STANDS: f64 = 1e-4;
    let distance = (to.translation.vector - from.translation.vector).norm();
    (distance > STANDS).then(|| distance / speed)
}

/// Finds the cheapest chain of candidates including their collisions; each of its candidates has been tested.
///
/// A point under a round jet has up to 24 turns × 8 configurations, more with whole turns of joints. Testing one takes
/// five capsules and a search of the part's points along some of them, about as much work as finding it, and most are
/// never used. So only the candidates of the chain are tested, after R. Bohlin, L. E. Kavraki, "Path Planning Using
/// Lazy PRM", ICRA 2000: an untested candidate costs as little as a free one, so a chain stays the cheapest if all its
/// candidates prove free. If one collides, all candidates of its point are tested and another chain is chosen. A path
/// without collisions takes one test per point; one that collides nearly everywhere takes [`LAZY_ROUNDS`] more chains
/// and a test of each candidate. `solvers` has one solver per point, for the rail's position there. Returns `None` soon
/// after `is_cancelled` returns true.
pub(super) fn free_chain(
    solvers: &[Solver<'_>],
    points: &[ArmPoint],
    candidates: &mut [Vec<Candidate>],
    num_turns: usize,
    is_cancelled: &dyn Fn() -> bool,
) -> Option<Vec<Option<usize>>> {
    let Some(arm) = solvers.first().map(|solver| solver.arm) else {
        return Some(Vec::new());
    };
    for _ in 0..LAZY_ROUNDS {
        let chosen = best_chain(arm, points, candidates, num_turns, is_cancelled)?;
        let mut is_final = true;
        for ((here, chosen), solver) in candidates.iter_mut().zip(&chosen).zip(solvers) {
            let chosen = chosen.and_then(|index| here.get_mut(index));
            let untested = chosen.filter(|candidate| candidate.is_collision.is_none());
            if untested.is_some_and(|candidate| candidate.collides(solver)) {
                is_final = false;
                for candidate in here {
                    candidate.collides(solver);
                }
            }
        }
        if is_final {
            return Some(chosen);
        }
    }
    for (here, solver) in candidates.iter_mut().zip(solvers) {
        if is_cancelled() {
            return None;
        }
        for candidate in here {
            candidate.collides(solver);
        }
    }
    best_chain(arm, points, candidates, num_turns, is_cancelled)
}

/// Finds the cheapest chain of candidates; it has `None` at a point without candidates, after which a new chain begins.
fn best_chain(
    arm: &Arm,
    points: &[ArmPoint],
    candidates: &[Vec<Candidate>],
    num_turns: usize,
    is_cancelled: &dyn Fn() -> bool,
) -> Option<Vec<Option<usize>>> {
    // For every candidate, the cost up to it and the candidate at the previous point.
    let mut chains: Vec<Vec<(f64, Option<usize>)>> = Vec::with_capacity(points.len());
    for (i, here) in candidates.iter().enumerate() {
        if is_cancelled() {
            return None;
        }
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
                let (time, angle) = joint_time(arm, &previous.joints, &candidate.joints);
                let is_jump = allowed.map_or(time > 1.0, |allowed| time > allowed)
                    || angle > PI
                    || previous.configuration != candidate.configuration;
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
            // Larger turns of the nozzle are only considered if no smaller one continues without a collision.
            let near = cheapest(true);
            let is_free = |k: usize| former[k].is_collision != Some(true);
            let best = if near.1.is_some_and(is_free) {
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
    Some(chosen)
}
