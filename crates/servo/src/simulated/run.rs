//! A whole run: simulated frames, inspection, servo and arm, in simulated time.

use std::{collections::VecDeque, time::Duration};

use nalgebra::{Point3, Vector3};

use super::{SimulatedArm, SimulatedCell};
use crate::{Look, Servo, ServoError, ServoParams, Step};
use geometry::{
    rigid::{PoseDelta, RigidTransform},
    units::{Metres, Radians},
};

/// A moment of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Time since the start.
    pub at: Duration,
    /// Commanded pose of the flange.
    pub robot_from_flange: RigidTransform,
    /// True error of the camera at the part's middle, or of the nozzle at its mouth.
    pub error: PoseDelta,
    /// Whether the last look that arrived was one to move by; true before the first.
    pub is_usable: bool,
    /// Why the robot was held.
    pub is_held: bool,
}

/// The result of a run.
#[derive(Clone, Debug)]
pub struct RunResult {
    /// How it ended: [`Step::Done`] or [`Step::Stop`].
    pub end: Step,
    /// Every step.
    pub samples: Vec<Sample>,
    /// Number of frames inspected.
    pub num_frames: usize,
    /// Number of single moves; 0 of a run that streams poses.
    pub num_moves: usize,
    /// Least distance of tools and flange from the part's true surface, metres.
    pub least_distance: f64,
    /// Number of commands that the arm could not follow.
    pub num_unreachable: usize,
    /// True if the part hung there to the end.
    pub hangs: bool,
    /// Time between two samples, seconds.
    pub period: f64,
    /// Points on the flange whose speeds are limited.
    pub watched: Vec<Point3<f64>>,
}

/// Ends a run that neither arrives nor stops; the servo's own longest time must be shorter.
const MAX_DURATION: Duration = Duration::from_secs(200);

/// A run so far.
pub(super) struct Observed<'c, 'a> {
    cell: &'c SimulatedCell<'a>,
    surface: Vec<Point3<f64>>,
    pub(super) result: RunResult,
}

impl<'c, 'a> Observed<'c, 'a> {
    pub(super) fn new(cell: &'c SimulatedCell<'a>) -> Self {
        let mut watched = vec![Point3::origin()];
        watched.extend(cell.fence.tools.iter().map(|tool| tool.end));
        Self {
            cell,
            surface: cell.surface(),
            result: RunResult {
                end: Step::Stop(crate::StopReason::ByPerson),
                samples: Vec::new(),
                num_frames: 0,
                num_moves: 0,
                least_distance: f64::INFINITY,
                num_unreachable: 0,
                hangs: true,
                period: cell.setup.dynamics.period.as_secs_f64(),
                watched,
            },
        }
    }

    /// What the next frame shows; `None` if it is lost.
    pub(super) fn look(&mut self, arm: &SimulatedArm) -> Option<Look> {
        let number = self.result.num_frames as u64;
        self.result.num_frames += 1;
        self.cell.look(&arm.true_flange(), arm.state().at, number)
    }

    /// Notes where the arm is, and where it is sent; `None`: where it was sent before.
    pub(super) fn sample(
        &mut self,
        arm: &SimulatedArm,
        sent: Option<RigidTransform>,
        is_usable: bool,
        is_held: bool,
    ) {
        let (state, flange) = (arm.state(), arm.true_flange());
        if self.result.samples.len().is_multiple_of(8) {
            let part = self.cell.robot_from_part_at(state.at);
            let distance = least_distance(self.cell, &flange, &part, &self.surface);
            self.result.least_distance = self.result.least_distance.min(distance);
        }
        let before = self
            .result
            .samples
            .last()
            .map(|last| last.robot_from_flange);
        self.result.samples.push(Sample {
            at: state.at,
            robot_from_flange: sent.or(before).unwrap_or(state.robot_from_flange),
            error: self.cell.true_error(&flange, state.at),
            is_usable,
            is_held,
        });
    }

    pub(super) fn ended(mut self, end: Step, arm: &SimulatedArm) -> RunResult {
        self.result.end = end;
        self.result.hangs = self.cell.hangs(arm.state().at);
        self.result.num_unreachable = arm.num_unreachable();
        self.result
    }
}

/// Runs the servo in a cell until it arrives or stops.
pub fn run(cell: &SimulatedCell<'_>, params: &ServoParams) -> Result<RunResult, ServoError> {
    let setup = &cell.setup;
    let mut servo = Servo::new(cell.task.clone(), params.clone(), cell.fence.clone())?;
    let mut arm = cell.arm();
    let mut arriving: VecDeque<(Duration, Look)> = VecDeque::new();
    let mut next_frame = Duration::ZERO;
    let mut observed = Observed::new(cell);
    let mut is_usable = true;
    let mut end = Step::Stop(crate::StopReason::ByPerson);
    while arm.state().at < MAX_DURATION {
        arm.advance();
        let state = arm.state();
        let now = state.at;
        if now >= next_frame {
            next_frame += setup.frame_period;
            let look = observed.look(&arm);
            arriving.extend(look.map(|look| (now + setup.delay, look)));
        }
        let look = arriving.pop_front_if(|(at, _)| *at <= now);
        if let Some((_, look)) = &look {
            is_usable = look.seen.is_ok();
        }
        let step = servo.step(look.as_ref().map(|(_, look)| look), &state);
        let is_held = servo.held().is_some();
        if let Step::Command(pose) = step {
            observed.sample(&arm, Some(pose), is_usable, is_held);
            arm.send(pose);
        } else {
            observed.sample(&arm, None, is_usable, is_held);
            end = step;
            break;
        }
    }
    Ok(observed.ended(end, &arm))
}

/// Distance of the tools from the part's vertices less their radius, by comparing all.
fn least_distance(
    cell: &SimulatedCell<'_>,
    flange: &RigidTransform,
    robot_from_part: &RigidTransform,
    surface: &[Point3<f64>],
) -> f64 {
    let part_from_flange = robot_from_part.inverse() * flange;
    let from = part_from_flange * Point3::origin();
    let mut least = f64::INFINITY;
    for tool in &cell.fence.tools {
        let to = part_from_flange * tool.end;
        for point in surface {
            least = least.min(distance_to(&(to - from), &(point - from)) - tool.radius);
        }
    }
    least
}

/// Distance of a point from the segment from the origin.
fn distance_to(segment: &Vector3<f64>, point: &Vector3<f64>) -> f64 {
    let share = (segment.dot(point) / segment.norm_squared()).clamp(0.0, 1.0);
    (point - segment * share).norm()
}

impl RunResult {
    /// The greatest speed and acceleration of a watched point, and the angular ones, of the commanded poses, by differences.
    pub fn most(&self) -> [f64; 4] {
        let dt = self.period;
        let mut most = [0.0_f64; 4];
        for three in self.samples.windows(3) {
            let [a, b, c] = [0, 1, 2].map(|i| &three[i].robot_from_flange);
            for point in &self.watched {
                let (first, second) = (b * point - a * point, c * point - b * point);
                most[0] = most[0].max(second.norm() / dt);
                most[1] = most[1].max((second - first).norm() / (dt * dt));
            }
            let turn = |from: &RigidTransform, to: &RigidTransform| {
                (to.rotation * from.rotation.inverse()).scaled_axis()
            };
            let (first, second) = (turn(a, b), turn(b, c));
            most[2] = most[2].max(second.norm() / dt);
            most[3] = most[3].max((second - first).norm() / (dt * dt));
        }
        most
    }

    /// Number of steps at which the robot was moved faster than at the step before although the last look was none to move by.
    pub fn num_moved_blindly(&self) -> usize {
        let num = self.samples.windows(3).filter(|three| {
            let length = |from: &Sample, to: &Sample| {
                let shift = to.robot_from_flange.translation.vector
                    - from.robot_from_flange.translation.vector;
                let turn = from
                    .robot_from_flange
                    .rotation
                    .angle_to(&to.robot_from_flange.rotation);
                shift.norm() + turn
            };
            let faster = length(&three[1], &three[2]) > length(&three[0], &three[1]) + 1e-9;
            faster && !three[2].is_usable
        });
        num.count()
    }

    /// True error at the start and at the end; none without a step.
    pub fn errors(&self) -> Option<[PoseDelta; 2]> {
        Some([self.samples.first()?.error, self.samples.last()?.error])
    }

    /// By how much the error exceeded that of the start, at most.
    pub fn most_away(&self) -> PoseDelta {
        let Some(first) = self.samples.first().map(|sample| sample.error) else {
            return PoseDelta {
                shift: Metres(0.0),
                rotation: Radians(0.0),
            };
        };
        let most = |of: fn(&PoseDelta) -> f64| {
            let all = self
                .samples
                .iter()
                .map(|sample| of(&sample.error) - of(&first));
            all.fold(0.0, f64::max)
        };
        PoseDelta {
            shift: Metres(most(|error| error.shift.0)),
            rotation: Radians(most(|error| error.rotation.0)),
        }
    }
}

#[cfg(test)]
mod tests;
