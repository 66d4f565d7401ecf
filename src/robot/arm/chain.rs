//! The joints that an arm may take at each point of a path, and the cheapest chain of them.

use std::f64::consts::{FRAC_PI_4, PI, TAU};

use nalgebra::{Translation3, UnitQuaternion, Vector3};

use super::{
    Arm,
    check::ArmPoint,
    kinematics::{Joints, Solver},
    way::{SLOWEST, may_move_by_joints},
};
use crate::geometry::rigid::RigidTransform;

/// Costs in seconds of joint motion: of a singularity nearby, and of turning the nozzle by one step.
const SINGULAR_COST: f64 = 2.0;
const TURN_COST: f64 = 0.02;
/// Cost per radian by which a joint is beyond half a turn: some controllers cannot express such turns, and they strain
/// cables.
const WOUND_COST: f64 = 0.001;
/// Cost of a tilt per radian, so that the nozzle is only tilted where that avoids a problem or a singularity.
const TILT_COST: f64 = 6.0;
/// Cost of a joint move between two strokes: the arm stops before and after it.
const JOINT_MOVE_COST: f64 = 5.0;
/// Cost of joints that are faster than this share of their top speeds, times the excess: between two points they may be
/// faster than on average.
const RUSH_COST: f64 = 20.0;
const RUSH: f64 = 0.7;
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
    pub(super) tilt: Tilt,
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

/// A tilt of the nozzle about the point that it aims at: a rotation vector in the nozzle's xy plane, radians.
pub(super) type Tilt = [f64; 2];

/// The nozzle as the path has it.
pub(super) const UPRIGHT: Tilt = [0.0; 2];

/// Tilts in eight directions, by half of the limit and by all of it.
pub(super) fn tilts_up_to(limit: f64) -> Vec<Tilt> {
    let angles = [0.5 * limit, limit].into_iter();
    let all = angles.flat_map(|angle| {
        (0..8).map(move |k| {
            let (sin, cos) = (FRAC_PI_4 * f64::from(k)).sin_cos();
            [angle * cos, angle * sin]
        })
    });
    all.collect()
}

/// Pose of the nozzle at a point, tilted, and turned about its z axis.
pub(super) fn nozzle_at(point: &ArmPoint, [x, y]: Tilt, angle: f64) -> RigidTransform {
    let aim = Translation3::new(0.0, 0.0, point.aim);
    let tilt = UnitQuaternion::from_scaled_axis(Vector3::new(x, y, 0.0));
    let turn = UnitQuaternion::from_euler_angles(0.0, 0.0, angle);
    point.robot_from_nozzle * aim * tilt * aim.inverse() * turn
}

/// The turns to try at a point: all for a round jet; half a turn for a fan, which is symmetric.
pub(super) fn turns_of(point: &ArmPoint, num_turns: usize) -> impl Iterator<Item = usize> + use<> {
    let step = match (point.is_turn_free, num_turns.is_multiple_of(2)) {
        (true, _) => 1,
        (false, true) => num_turns / 2,
        (false, false) => num_turns,
    };
    (0..num_turns).step_by(step)
}

/// All joints at a point with these tilts of the nozzle.
pub(super) fn candidates_of(
    solver: &Solver<'_>,
    point: &ArmPoint,
    num_turns: usize,
    tilts: &[Tilt],
) -> Vec<Candidate> {
    let mut all = Vec::new();
    for tilt in tilts {
        let [x, y] = *tilt;
        for turn in turns_of(point, num_turns) {
            let pose = nozzle_at(point, *tilt, angle_of(turn, num_turns));
            for solution in solver.solutions(&pose, None) {
                let is_singular = solver.singularity(&solution).is_some();
                let configuration = solver.arm.configuration_bit(&solution);
                // Prefer the orientation of the path.
                let away = turn.min(num_turns - turn) as f64;
                let cost = 0.1 * TURN_COST * away
                    + TILT_COST * x.hypot(y)
                    + if is_singular { SINGULAR_COST } else { 0.0 };
                let within = solver.within_limits(&solution).into_iter();
                all.extend(within.map(|joints| {
                    let wound = joints.iter().map(|angle| (angle.abs() - PI).max(0.0));
                    Candidate {
                        joints,
                        turn,
                        tilt: *tilt,
                        configuration,
                        cost: cost + WOUND_COST * wound.sum::<f64>(),
                        is_collision: None,
                    }
                }));
            }
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
            let (start, end) = (&points[i - 1], &points[i]);
            // With the gun off, the arm may move more slowly.
            let speed = if start.is_gun_on {
                start.speed
            } else {
                start.speed.min(SLOWEST)
            };
            let allowed = move_time(&start.robot_from_nozzle, &end.robot_from_nozzle, speed);
            let jump_cost = if may_move_by_joints(arm, start, end) {
                JOINT_MOVE_COST
            } else {
                JUMP_COST
            };
            let step = |previous: &Candidate| {
                let apart = turns_apart(previous.turn, candidate.turn, num_turns);
                let (time, angle) = joint_time(arm, &previous.joints, &candidate.joints);
                // Speed of the fastest joint as a share of its maximum.
                let share = allowed.map_or(time, |allowed| time / allowed);
                let is_jump = share > 1.0
                    || angle > PI
                    || 4 * apart > num_turns
                    || previous.configuration != candidate.configuration;
                let rush = RUSH_COST * (share - RUSH).max(0.0);
                time + TURN_COST * apart as f64 + if is_jump { jump_cost } else { rush }
            };
            let cheapest = |is_near: bool| {
                let mut best = (f64::INFINITY, None);
                for (k, (previous, (cost, _))) in former.iter().zip(costs).enumerate() {
                    let is_out = is_near
                        && end.is_turn_free
                        && turns_apart(previous.turn, candidate.turn, num_turns) > 1;
                    if *cost >= best.0 || is_out {
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
