//! Makes the tilts of the nozzle change evenly near points at which joints cannot follow.
//!
//! The chain of candidates takes each point's tilt from a few, so that the tilt jumps from point to point, and with it the
//! joints. Here the tilts may take any value up to the largest. Two kinds of limits are linear in the joints' angles q:
//!
//! - the speed of a joint on a move with the gun on, (q₊ - q) / t;
//! - the change of its speed around a point, (q₊ - q) / t₊ - (q - q₋) / t₋, which must fit into one window of
//!   [`acceleration`](super::acceleration), as if all of it happened at the point.
//!
//! With the joints linearised in the tilts, each limit allows a strip between two parallel planes, and the largest tilt a
//! disc for each point. The tilts are projected onto one violated strip after the other, and onto the discs, until none is
//! violated: L. M. Bregman, "The method of successive projection for finding a common point of convex sets", Soviet
//! Mathematics Doklady 6, 1965. Each projection is the smallest change that satisfies its strip, so tilts change little. The
//! joints are then computed for the new tilts and linearised again. (Gauss-Newton steps oscillated: the limits have kinks.)
//!
//! The tilts found are a proposal, which is checked like any other path.
//!
//! Known limits: only joints whose accelerations are limited are examined. Configurations and turns of the nozzle stay as
//! they are. Obstacles, joint limits and the accelerations of a rail are not considered.

use super::{
    ArmPoint, CheckParams, PlacedArm, PointCheck,
    acceleration::{WINDOW_S, as_passed, runs_of},
    chain::{Candidate, Tilt, angle_of, nozzle_at},
    kinematics::{Joints, Solver},
    way::{nearest, outside},
};

/// Most times that the joints are linearised.
const MAX_ROUNDS: usize = 8;
/// Most projections onto each limit between two linearisations.
const MAX_SWEEPS: usize = 200;
/// Tilt over which the joints are linearised, radians.
const STEP_RAD: f64 = 1e-3;
/// Shares of the limits that are aimed at: straight moves between the points, and the speed within a move, are only
/// approximately even.
const ACCELERATION_SHARE: f64 = 0.95;
const SPEED_SHARE: f64 = 0.9;
/// A limit may be exceeded by this share.
const TOLERANCE: f64 = 1e-3;

/// Changes the tilts of chosen joints, and the joints with them, so that they change evenly at the points that may tilt.
pub(super) fn smooth_tilts(
    placed: &PlacedArm,
    solvers: &[Solver<'_>],
    points: &[ArmPoint],
    checked: &[PointCheck],
    chosen: &mut [Option<Candidate>],
    may_tilt: &[bool],
    params: &CheckParams<'_>,
) {
    let limits = limits_of(placed, points, checked, may_tilt);
    let joints_at = |i: usize, tilt: Tilt, near: &Candidate| {
        let turn = angle_of(near.turn, params.num_turns);
        let nozzle = nozzle_at(&points[i], tilt, turn);
        let joints = nearest(&solvers[i], &nozzle, &near.joints);
        joints.filter(|joints| outside(&solvers[i], joints).is_none())
    };
    for _ in 0..MAX_ROUNDS {
        let poses = chosen.iter().zip(may_tilt).enumerate();
        let poses = poses.map(|(i, (chosen, may_tilt))| {
            let chosen = chosen.as_ref()?;
            let slope = |axis: usize| -> Option<Joints> {
                let mut tilt = chosen.tilt;
                tilt[axis] += STEP_RAD;
                let joints = joints_at(i, tilt, chosen)?;
                Some(std::array::from_fn(|j| {
                    (joints[j] - chosen.joints[j]) / STEP_RAD
                }))
            };
            let slopes = || Some([slope(0)?, slope(1)?]);
            Some(Pose {
                tilt: chosen.tilt,
                joints: chosen.joints,
                slopes: may_tilt.then(slopes).flatten(),
            })
        });
        let mut poses: Vec<Option<Pose>> = poses.collect();
        let num_sweeps = (0..MAX_SWEEPS).take_while(|_| {
            let worst = limits
                .iter()
                .map(|limit| limit.project(&mut poses, params.max_tilt));
            worst.fold(0.0, f64::max) > 1.0 + TOLERANCE
        });
        if num_sweeps.count() == 0 {
            break;
        }
        for (i, (chosen, pose)) in chosen.iter_mut().zip(poses).enumerate() {
            if let (Some(chosen), Some(pose)) = (chosen, pose)
                && pose.tilt.map(f64::to_bits) != chosen.tilt.map(f64::to_bits)
                && let Some(joints) = joints_at(i, pose.tilt, chosen)
            {
                chosen.tilt = pose.tilt;
                chosen.joints = joints;
                chosen.is_collision = None;
            }
        }
    }
    for (chosen, solver) in chosen.iter_mut().zip(solvers) {
        if let Some(chosen) = chosen
            && chosen.is_collision.is_none()
        {
            chosen.is_collision = Some(solver.collides(&chosen.joints));
        }
    }
}

/// The nozzle at a point.
#[derive(Clone, Copy)]
struct Pose {
    tilt: Tilt,
    /// The joints at this tilt, linearised.
    joints: Joints,
    /// Their derivatives by each axis of the tilt; none if it must stay.
    slopes: Option<[Joints; 2]>,
}

impl Pose {
    fn tilt_by(&mut self, step: Tilt, max_tilt: f64) {
        let Some(slopes) = self.slopes else { return };
        let tilt = [0, 1].map(|axis| self.tilt[axis] + step[axis]);
        let excess = (tilt[0].hypot(tilt[1]) / max_tilt).max(1.0);
        for axis in 0..2 {
            let to = tilt[axis] / excess;
            let moved = to - self.tilt[axis];
            self.tilt[axis] = to;
            for (joint, slope) in self.joints.iter_mut().zip(slopes[axis]) {
                *joint += slope * moved;
            }
        }
    }
}

/// A limit of a weighted sum of the angles that a joint has at some points.
struct Limit {
    /// Indices of points, and their weights, 1/s.
    terms: Vec<(usize, f64)>,
    /// Greatest sum for each joint, rad/s.
    most: Joints,
}

impl Limit {
    /// Changes the tilts as little as possible so that each joint in turn is within the limit, as far as the largest tilt
    /// allows. Returns the greatest sum before, as a share of the limit.
    fn project(&self, poses: &mut [Option<Pose>], max_tilt: f64) -> f64 {
        let mut worst = 0.0_f64;
        for (joint, most) in self.most.into_iter().enumerate() {
            let (mut sum, mut norm) = (0.0, 0.0);
            for (i, weight) in &self.terms {
                let Some(pose) = &poses[*i] else { return 0.0 };
                sum += weight * pose.joints[joint];
                for slopes in pose.slopes.iter().flatten() {
                    norm += (weight * slopes[joint]).powi(2);
                }
            }
            worst = worst.max(sum.abs() / most);
            let excess = sum - sum.clamp(-most, most);
            if excess == 0.0 || norm == 0.0 {
                continue;
            }
            for (i, weight) in &self.terms {
                if let Some(pose) = &mut poses[*i]
                    && let Some(slopes) = pose.slopes
                {
                    let step = slopes.map(|slopes| -excess * weight * slopes[joint] / norm);
                    pose.tilt_by(step, max_tilt);
                }
            }
        }
        worst
    }
}

/// The limits that depend on a point that may tilt; none if the joints' accelerations are not limited.
fn limits_of(
    placed: &PlacedArm,
    points: &[ArmPoint],
    checked: &[PointCheck],
    may_tilt: &[bool],
) -> Vec<Limit> {
    let mut limits = Vec::new();
    let Some(accelerations) = placed.arm.accelerations else {
        return limits;
    };
    let changes = accelerations.map(|most| most * WINDOW_S * ACCELERATION_SHARE);
    let speeds = placed.arm.speeds.map(|most| most * SPEED_SHARE);
    let passed = as_passed(points, checked);
    for (first, run) in runs_of(placed, &passed, checked) {
        let mut add = |terms: &[(usize, f64)], most: Joints| {
            let terms = terms.iter().map(|(here, weight)| (first + here, *weight));
            let terms: Vec<(usize, f64)> = terms.collect();
            if terms.iter().any(|(i, _)| may_tilt[*i]) {
                limits.push(Limit { terms, most });
            }
        };
        let rate = |from: usize, to: usize| (run.times[to] - run.times[from]).recip();
        for here in 0..run.times.len() {
            if let [Some(before), Some(behind)] = run.around(here) {
                let [early, late] = [rate(before, here), rate(here, behind)];
                let terms = [(before, early), (here, -early - late), (behind, late)];
                add(&terms, changes);
            }
            let next = here + 1;
            if points[first + here].is_gun_on && next < run.times.len() {
                let rate = rate(here, next);
                if rate.is_finite() {
                    add(&[(here, -rate), (next, rate)], speeds);
                }
            }
        }
    }
    limits
}
