//! A servo at the end of a connection.

use std::time::Duration;

use super::{Report, Stream, StreamError};
use crate::{ArmState, Look, Servo, Step, StopReason};
use geometry::rigid::RigidTransform;

/// A robot that a servo drives through a protocol.
pub struct Drive {
    stream: Box<dyn Stream + Send>,
    servo: Servo,
    /// The newest look that the servo has not taken in yet.
    look: Option<Look>,
    /// Where the robot was sent last; none before it follows.
    commanded: Option<RigidTransform>,
}

/// What to do with the bytes that came.
#[derive(Clone, Debug, PartialEq)]
pub struct Driven {
    /// What to send.
    pub send: Vec<u8>,
    /// What the servo does, if there was a report.
    pub step: Option<Step>,
    /// Why the bytes were none.
    pub problem: Option<StreamError>,
}

impl Drive {
    /// A robot that is not connected yet.
    pub fn new(stream: Box<dyn Stream + Send>, servo: Servo) -> Self {
        Self {
            stream,
            servo,
            look: None,
            commanded: None,
        }
    }

    /// The servo.
    pub fn servo(&self) -> &Servo {
        &self.servo
    }

    /// Requests that open the connection: to be sent first.
    pub fn opening(&mut self) -> Vec<u8> {
        self.stream.requests()
    }

    /// Takes in a look, for the next report.
    pub fn look(&mut self, look: Look) {
        self.look = Some(look);
    }

    /// Allows the step that waits, see [`Servo::move_in_steps`].
    pub fn allow_step(&mut self) {
        self.servo.allow_step();
    }

    /// Brakes, and then stops for good.
    pub fn stop(&mut self, reason: StopReason) {
        self.servo.stop(reason);
    }

    /// Takes in what came at this time, by the clock of the frames. Bytes that are no report have no answer, and none has an answer
    /// once the servo has stopped: its robot is at rest by then, and its program ends for want of one.
    pub fn take(&mut self, bytes: &[u8], at: Duration) -> Driven {
        let report = match self.stream.receive(bytes) {
            Ok(report) => report,
            Err(problem) => {
                return Driven {
                    send: Vec::new(),
                    step: None,
                    problem: Some(problem),
                };
            }
        };
        let mut send = self.stream.requests();
        let step = report.map(|report| self.step(&report, at));
        let to = step.as_ref().and_then(|step| match step {
            Step::Command(pose) => Some((*pose, false)),
            Step::Done(_) => self.commanded.map(|pose| (pose, true)),
            Step::Stop(_) => None,
        });
        if let Some((pose, has_arrived)) = to {
            send.extend(self.stream.answer(&pose, has_arrived));
        }
        Driven {
            send,
            step,
            problem: None,
        }
    }

    fn step(&mut self, report: &Report, at: Duration) -> Step {
        if self.commanded.is_none() && !report.is_following {
            // Its program has not begun: it stays where it is.
            return Step::Command(report.robot_from_flange);
        }
        if !report.is_following {
            self.servo.stop(StopReason::RobotStopped);
        }
        let arm = ArmState {
            at,
            robot_from_flange: report.robot_from_flange,
            joints: report.joints,
        };
        let step = self.servo.step(self.look.take().as_ref(), &arm);
        if let Step::Command(pose) = step {
            self.commanded = Some(pose);
        }
        step
    }
}
