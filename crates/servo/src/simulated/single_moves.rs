//! A whole run in single moves: the arm stands still while the camera looks, and moves on its own way in between.

use std::f64::consts::PI;

use nalgebra::Point3;

use super::{RunResult, SimulatedArm, SimulatedCell, run::Observed};
use crate::{
    ArmState, Limits, Look, OnePose, OnePoseAnswer, ServoError, ServoParams, Step, twist::part_way,
};
use geometry::rigid::{PoseDelta, RigidTransform};

/// How often in a row the robot asks again after it was told to stay.
const MAX_STAYS: usize = 5;
/// Share of the limits of speed and acceleration at which the robot moves.
const SHARE_OF_LIMITS: f64 = 0.9;

/// Asks for single moves in a cell, and makes them, until the target is reached or the robot has to stay again and again.
pub fn run_in_single_moves(
    cell: &SimulatedCell<'_>,
    params: &ServoParams,
    max_move: PoseDelta,
) -> Result<RunResult, ServoError> {
    let fence = cell.fence.clone();
    let mut moves = OnePose::new(cell.task.clone(), params.clone(), max_move, fence)?;
    let mut arm = cell.arm();
    let mut observed = Observed::new(cell);
    let mut num_stays = 0;
    let end = loop {
        stand(&mut arm, params.settle, &mut observed);
        let before = reported(&arm);
        let mut looks: Vec<Look> = Vec::new();
        for _ in 0..params.num_final {
            stand(&mut arm, cell.setup.frame_period, &mut observed);
            looks.extend(observed.look(&arm));
        }
        match moves.answer(&looks, [&before, &reported(&arm)]) {
            OnePoseAnswer::Move {
                robot_from_flange, ..
            } => {
                num_stays = 0;
                observed.result.num_moves += 1;
                go(&mut arm, &robot_from_flange, &params.limits, &mut observed);
            }
            OnePoseAnswer::Done(arrival) => break Step::Done(arrival),
            OnePoseAnswer::Stay(reason) => {
                num_stays += 1;
                if num_stays == MAX_STAYS {
                    break Step::Stop(reason);
                }
            }
        }
    };
    Ok(observed.ended(end, &arm))
}

/// What the robot tells of itself: its pose alone.
fn reported(arm: &SimulatedArm) -> ArmState {
    ArmState {
        joints: None,
        ..arm.state()
    }
}

/// Lets the arm stand for this long, and until it is at rest.
fn stand(arm: &mut SimulatedArm, at_least: std::time::Duration, observed: &mut Observed<'_, '_>) {
    let until = arm.state().at + at_least;
    while arm.state().at < until {
        arm.advance();
        observed.sample(arm, None, true, false);
    }
}

/// Moves in a straight line, with a speed that rises and falls evenly.
fn go(
    arm: &mut SimulatedArm,
    to: &RigidTransform,
    limits: &Limits,
    observed: &mut Observed<'_, '_>,
) {
    let from = arm.state().robot_from_flange;
    let points = observed.result.watched.iter();
    let shift = points.map(|point| (to * point - from * point).norm());
    let shift = shift.fold(0.0, f64::max);
    let turn = from.rotation.angle_to(&to.rotation);
    // The share of the way is (1 - cos πt/T) / 2.
    let time = |way: f64, speed: f64, acceleration: f64| {
        let by_speed = PI / 2.0 * way / (SHARE_OF_LIMITS * speed);
        let by_acceleration = (PI * PI / 2.0 * way / (SHARE_OF_LIMITS * acceleration)).sqrt();
        by_speed.max(by_acceleration)
    };
    let seconds = time(shift, limits.speed, limits.acceleration).max(time(
        turn,
        limits.turn_speed,
        limits.turn_acceleration,
    ));
    let period = arm.period().as_secs_f64();
    let num_steps = (seconds / period).ceil().max(1.0);
    for step in 1..=num_steps as usize {
        let share = (1.0 - (PI * step as f64 / num_steps).cos()) / 2.0;
        let pose = part_way(&from, to, &Point3::origin(), share);
        arm.send(pose);
        arm.advance();
        observed.sample(arm, Some(pose), true, false);
    }
    // The controller says that it is there once its motors are.
    stand(arm, 20 * arm.period(), observed);
}
