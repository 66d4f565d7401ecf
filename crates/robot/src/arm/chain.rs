//! The joints that an arm may take at each point of a path, and the cheapest chain of them.

use std::f64::consts::{FRAC_PI_4, PI, TAU};

use nalgebra::{Translation3, UnitQuaternion, Vector3};

use super::{
    Arm, ArmPoint,
    kinematics::{Joints, Solver},
    way::{MIN_TRAVEL_SPEED_M_S, may_move_by_joints},
};
use geometry::{
    parallel::{map_each, num_cores},
    rigid::RigidTransform,
};

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
const RUSH_SPEED_SHARE: f64 = 0.7;
/// Least cost of a move that is too fast for a joint, changes the configuration or turns a joint by more than half a
/// turn.
const JUMP_COST: f64 = 1e4;
/// A collision costs as much as a hundred jumps: like a solution beyond a limit, it is only chosen if none is free.
const COLLISION_COST: f64 = 1e6;
/// Chains chosen before every candidate is tested for collisions.
const NUM_LAZY_ROUNDS: usize = 3;
/// Number of configurations of an arm.
pub(super) const NUM_CONFIGURATIONS: usize = 8;
/// Minimum number of candidates of a point for which it pays to start threads.
const MIN_PARALLEL_CANDIDATES: usize = 1000;

/// Possible joints at a point.
#[derive(Clone, Copy)]
pub(super) struct Candidate {
    pub(super) joints: Joints,
    pub(super) turn: usize,
    pub(super) tilt: Tilt,
    /// The configuration, one of eight, as one bit.
    configuration: u8,
    /// Number of the solution for this pose of the nozzle; candidates that share it differ by whole turns of joints.
    solution: usize,
    /// Cost of the point itself, without the move to it.
    cost: f64,
    /// Whether it collides; none if not tested yet.
    pub(super) is_collision: Option<bool>,
}

impl Candidate {
    /// The configuration as a number from 0.
    fn configuration_number(&self) -> usize {
        self.configuration.trailing_zeros() as usize
    }

    /// Sets whether it collides, and adds a collision to its cost once.
    fn set_collision(&mut self, is_collision: bool) {
        if self.is_collision.is_none() && is_collision {
            self.cost += COLLISION_COST;
        }
        self.is_collision = Some(is_collision);
    }
}

/// Tests all candidates of a point for collisions. The poses of gun and wrist depend on that of the nozzle alone, and whole
/// turns of joints move nothing, so both are tested once for all candidates that share them.
pub(super) fn test_all(
    here: &mut [Candidate],
    solver: &Solver<'_>,
    point: &ArmPoint,
    num_turns: usize,
) {
    for posed in here.chunk_by_mut(|a, b| (a.turn, a.tilt) == (b.turn, b.tilt)) {
        let pose = nozzle_at(point, posed[0].tilt, angle_of(posed[0].turn, num_turns));
        let gun_collides = solver.gun_collides(&pose);
        for alike in posed.chunk_by_mut(|a, b| a.solution == b.solution) {
            let collides = gun_collides || solver.arm_collides(&alike[0].joints);
            for candidate in alike {
                candidate.set_collision(collides);
            }
        }
    }
}

/// Whether gun and wrist are clear of the cell's obstacles at some turn of the nozzle with one of these tilts. If not, no
/// arm reaches the point without a collision.
pub(super) fn is_gun_free(
    solver: &Solver<'_>,
    point: &ArmPoint,
    num_turns: usize,
    tilts: &[Tilt],
) -> bool {
    let mut poses = poses_of(point, num_turns, tilts);
    poses.any(|(_, _, pose)| !solver.gun_collides(&pose))
}

/// Whether the arm reaches the point without a collision at some turn of the nozzle with one of these tilts.
pub(super) fn is_free(
    solver: &Solver<'_>,
    point: &ArmPoint,
    num_turns: usize,
    tilts: &[Tilt],
) -> bool {
    let free = poses_of(point, num_turns, tilts).map(|(_, _, pose)| pose);
    let mut free = free.filter(|pose| !solver.gun_collides(pose));
    free.any(|pose| {
        let solutions = solver.solutions(&pose, None);
        solutions
            .iter()
            .any(|joints| !solver.within_limits(joints).is_empty() && !solver.arm_collides(joints))
    })
}

/// Angle of a step about z, radians within ±π; the steps are even.
pub(super) fn angle_of(turn: usize, num_turns: usize) -> f64 {
    let angle = TAU * turn as f64 / num_turns as f64;
    if angle > PI { angle - TAU } else { angle }
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

/// Tilt, turn and pose of the nozzle at a point for each of these tilts and every turn.
fn poses_of(
    point: &ArmPoint,
    num_turns: usize,
    tilts: &[Tilt],
) -> impl Iterator<Item = (Tilt, usize, RigidTransform)> {
    tilts.iter().flat_map(move |tilt| {
        turns_of(point, num_turns).map(move |turn| {
            let pose = nozzle_at(point, *tilt, angle_of(turn, num_turns));
            (*tilt, turn, pose)
        })
    })
}

/// All joints at a point with these tilts of the nozzle.
pub(super) fn candidates_of(
    solver: &Solver<'_>,
    point: &ArmPoint,
    num_turns: usize,
    tilts: &[Tilt],
) -> Vec<Candidate> {
    let mut all = Vec::new();
    for (tilt, turn, pose) in poses_of(point, num_turns, tilts) {
        let [x, y] = tilt;
        for (solution, folded) in solver.solutions(&pose, None).into_iter().enumerate() {
            let is_singular = solver.singularity(&folded).is_some();
            let configuration = solver.arm.configuration_bit(&folded);
            // Prefer the orientation of the path.
            let away = turn.min(num_turns - turn) as f64;
            let cost = 0.1 * TURN_COST * away
                + TILT_COST * x.hypot(y)
                + if is_singular { SINGULAR_COST } else { 0.0 };
            let within = solver.within_limits(&folded).into_iter();
            all.extend(within.map(|joints| {
                let wound = joints.iter().map(|angle| (angle.abs() - PI).max(0.0));
                Candidate {
                    joints,
                    turn,
                    tilt,
                    configuration,
                    solution,
                    cost: cost + WOUND_COST * wound.sum::<f64>(),
                    is_collision: None,
                }
            }));
        }
    }
    all
}

/// Returns the seconds that the slowest joint needs to turn by these angles, radians, and the largest of them.
fn joint_time(arm: &Arm, angles: impl Iterator<Item = f64>) -> (f64, f64) {
    let mut worst = (0.0_f64, 0.0_f64);
    for (angle, speed) in angles.zip(arm.speeds) {
        worst = (worst.0.max(angle / speed), worst.1.max(angle));
    }
    worst
}

/// Returns the seconds of a move; `None` for a turn on the spot, which takes as long as the joints need.
pub(super) fn move_time(from: &RigidTransform, to: &RigidTransform, speed: f64) -> Option<f64> {
    /// Shorter moves count as standing still, metres.
    const STANDSTILL_M: f64 = 1e-4;
    let distance = (to.translation.vector - from.translation.vector).norm();
    (distance > STANDSTILL_M).then(|| distance / speed)
}

/// Finds the cheapest chain of candidates including their collisions; each of its candidates has been tested.
///
/// A point under a round jet has up to 24 turns × 8 configurations, more with whole turns of joints. Testing one takes
/// five capsules and a search of the part's points along some of them, about as much work as finding it, and most are
/// never used. So only the candidates of the chain are tested, after R. Bohlin, L. E. Kavraki, "Path Planning Using
/// Lazy PRM", ICRA 2000: an untested candidate costs as little as a free one, so a chain stays the cheapest if all its
/// candidates prove free. If one collides, all candidates of its point are tested and another chain is chosen. A path
/// without collisions takes one test per point; one that collides nearly everywhere takes [`NUM_LAZY_ROUNDS`] more chains
/// and all tests. `solvers` has one solver per point, for the rail's position there. Returns `None` soon after
/// `is_cancelled` returns true.
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
    for _ in 0..NUM_LAZY_ROUNDS {
        let chosen = best_chain(arm, points, candidates, num_turns, is_cancelled)?;
        let mut is_final = true;
        for (i, (here, chosen)) in candidates.iter_mut().zip(&chosen).enumerate() {
            let chosen = chosen.and_then(|index| here.get_mut(index));
            let Some(untested) = chosen.filter(|candidate| candidate.is_collision.is_none()) else {
                continue;
            };
            let collides = solvers[i].collides(&untested.joints);
            untested.set_collision(collides);
            if collides {
                if is_cancelled() {
                    return None;
                }
                is_final = false;
                test_all(here, &solvers[i], &points[i], num_turns);
            }
        }
        if is_final {
            return Some(chosen);
        }
    }
    for (i, here) in candidates.iter_mut().enumerate() {
        if is_cancelled() {
            return None;
        }
        if here
            .iter()
            .any(|candidate| candidate.is_collision.is_none())
        {
            test_all(here, &solvers[i], &points[i], num_turns);
        }
    }
    best_chain(arm, points, candidates, num_turns, is_cancelled)
}

/// Cost of a chain up to a candidate, and the candidate at the previous point; none if the chain begins here.
type Chained = (f64, Option<usize>);

/// Candidates of a point whose joints are much the same.
struct Group {
    /// Least and greatest angle of each joint.
    range: [[f64; 2]; 6],
    /// Their indices in ascending order of their chains' costs.
    members: Vec<usize>,
}

/// The point before another one, whose candidates continue the chains up to here.
///
/// A point may have thousands of candidates, and comparing all of them with all of the next point takes minutes. Groups
/// of the same configuration, turn of the nozzle and whole turns of joints are compared, and one is left as soon as no
/// member can be part of the cheapest chain.
struct Former<'a> {
    arm: &'a Arm,
    candidates: &'a [Candidate],
    chains: &'a [Chained],
    /// By configuration and turn.
    groups: Vec<Vec<Vec<Group>>>,
    /// Least cost of a chain to each configuration; infinite if it has no candidate.
    least: [f64; NUM_CONFIGURATIONS],
    num_turns: usize,
    /// True if the nozzle may turn on the way to the next point.
    is_turn_free: bool,
    /// Seconds of the move to the next point.
    allowed: Option<f64>,
    jump_cost: f64,
}

impl<'a> Former<'a> {
    fn new(
        arm: &'a Arm,
        [start, end]: [&ArmPoint; 2],
        candidates: &'a [Candidate],
        chains: &'a [Chained],
        num_turns: usize,
    ) -> Self {
        let whole_turns = |angle: f64| (angle / TAU).round() as i8;
        let kind = |k: usize| {
            let Candidate {
                configuration,
                turn,
                joints,
                ..
            } = &candidates[k];
            (*configuration, *turn, joints.map(whole_turns))
        };
        let mut order: Vec<usize> = (0..candidates.len()).collect();
        order.sort_unstable_by(|&a, &b| {
            let by_cost = || chains[a].0.total_cmp(&chains[b].0);
            kind(a).cmp(&kind(b)).then_with(by_cost).then(a.cmp(&b))
        });
        let no_group = || (0..num_turns).map(|_| Vec::new()).collect();
        let mut groups: Vec<Vec<Vec<Group>>> =
            (0..NUM_CONFIGURATIONS).map(|_| no_group()).collect();
        let mut least = [f64::INFINITY; NUM_CONFIGURATIONS];
        for members in order.chunk_by(|&a, &b| kind(a) == kind(b)) {
            let first = members[0];
            let configuration = candidates[first].configuration_number();
            least[configuration] = least[configuration].min(chains[first].0);
            let mut range = candidates[first].joints.map(|angle| [angle; 2]);
            for &k in members {
                for ([low, high], angle) in range.iter_mut().zip(candidates[k].joints) {
                    *low = low.min(angle);
                    *high = high.max(angle);
                }
            }
            groups[configuration][candidates[first].turn].push(Group {
                range,
                members: members.to_vec(),
            });
        }
        // With the gun off, the arm may move more slowly.
        let speed = if start.is_gun_on {
            start.speed
        } else {
            start.speed.min(MIN_TRAVEL_SPEED_M_S)
        };
        Self {
            arm,
            candidates,
            chains,
            groups,
            least,
            num_turns,
            is_turn_free: end.is_turn_free,
            allowed: move_time(&start.robot_from_nozzle, &end.robot_from_nozzle, speed),
            jump_cost: if may_move_by_joints(arm, start, end) {
                JOINT_MOVE_COST
            } else {
                JUMP_COST
            },
        }
    }

    /// The cheapest chain to a candidate of the next point.
    fn chain_to(&self, candidate: &Candidate) -> Chained {
        // Larger turns of the nozzle are only considered if no smaller one continues without a collision.
        let all = self.num_turns / 2;
        let near = if self.is_turn_free { all.min(1) } else { all };
        let mut best = self.cheapest(candidate, near, (f64::INFINITY, None));
        let is_free = |k: usize| self.candidates[k].is_collision != Some(true);
        if !best.1.is_some_and(is_free) {
            best = self.cheapest(candidate, all, best);
        }
        (best.0 + candidate.cost, best.1)
    }

    /// The cheapest chain and move to a candidate with at most this many steps of turn, if it is cheaper than `best`.
    fn cheapest(&self, candidate: &Candidate, most_apart: usize, mut best: Chained) -> Chained {
        let own = candidate.configuration_number();
        let others = (0..NUM_CONFIGURATIONS).filter(|configuration| *configuration != own);
        for configuration in [own].into_iter().chain(others) {
            let change = if configuration == own {
                0.0
            } else {
                self.jump_cost
            };
            if self.least[configuration] + change > best.0 {
                continue;
            }
            for apart in 0..=most_apart {
                let is_jump = configuration != own || 4 * apart > self.num_turns;
                let up = (candidate.turn + apart) % self.num_turns;
                let down = (candidate.turn + self.num_turns - apart) % self.num_turns;
                let turns = [up].into_iter().chain((down != up).then_some(down));
                for group in turns.flat_map(|turn| &self.groups[configuration][turn]) {
                    best = self.cheapest_of(group, candidate, apart, is_jump, best);
                }
            }
        }
        best
    }

    /// As [`Self::cheapest`], from the members of one group.
    fn cheapest_of(
        &self,
        group: &Group,
        candidate: &Candidate,
        apart: usize,
        is_jump: bool,
        mut best: Chained,
    ) -> Chained {
        let turn_cost = TURN_COST * apart as f64;
        let joints = group.range.iter().zip(&candidate.joints);
        let shortest = joint_time(
            self.arm,
            joints.map(|([low, high], angle)| (low - angle).max(angle - high).max(0.0)),
        );
        // A jump may cost less than a rush.
        let least = self.rush_cost(shortest, is_jump).min(self.jump_cost);
        let least = shortest.0 + turn_cost + least;
        for &k in &group.members {
            if self.chains[k].0 + least > best.0 {
                break;
            }
            let joints = self.candidates[k].joints.iter().zip(&candidate.joints);
            let time = joint_time(self.arm, joints.map(|(from, to)| (to - from).abs()));
            let step = time.0 + turn_cost + self.rush_cost(time, is_jump);
            let cost = self.chains[k].0 + step;
            // Of equal chains the first candidate, in whichever order they are compared.
            if cost.total_cmp(&best.0).then(Some(k).cmp(&best.1)).is_lt() {
                best = (cost, Some(k));
            }
        }
        best
    }

    /// Cost of a jump, or else of joints that are nearly too fast.
    fn rush_cost(&self, (time, angle): (f64, f64), is_jump: bool) -> f64 {
        // Speed of the fastest joint as a share of its maximum.
        let share = self.allowed.map_or(time, |allowed| time / allowed);
        if is_jump || share > 1.0 || angle > PI {
            self.jump_cost
        } else {
            RUSH_COST * (share - RUSH_SPEED_SHARE).max(0.0)
        }
    }
}

/// Finds the cheapest chain of candidates; it has `None` at a point without candidates, after which a new chain begins.
fn best_chain(
    arm: &Arm,
    points: &[ArmPoint],
    candidates: &[Vec<Candidate>],
    num_turns: usize,
    is_cancelled: &dyn Fn() -> bool,
) -> Option<Vec<Option<usize>>> {
    // One chain per candidate of every point.
    let mut chains: Vec<Vec<Chained>> = Vec::with_capacity(points.len());
    for (i, here) in candidates.iter().enumerate() {
        if is_cancelled() {
            return None;
        }
        let before = i.checked_sub(1);
        let before = before.filter(|before| !candidates[*before].is_empty());
        let former = before.map(|before| {
            let ends = [&points[before], &points[i]];
            Former::new(arm, ends, &candidates[before], &chains[before], num_turns)
        });
        let num_workers = if here.len() < MIN_PARALLEL_CANDIDATES {
            1
        } else {
            num_cores()
        };
        let row = map_each(here.len(), num_workers, |k| match &former {
            Some(former) => former.chain_to(&here[k]),
            None => (here[k].cost, None),
        });
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
