//! The clock by which a run is dated: this computer's, or that of a simulated robot, which waits for a computer that is too slow.

use std::{
    sync::Mutex,
    time::{Duration, Instant},
};

use capture::{CaptureError, RobotConnection, RobotRequest, SourceSpec};
use geometry::error::lock;

/// The clock of a run.
pub(super) enum RunClock {
    /// This computer's, since the start of the run.
    Computer(Instant),
    /// A simulated robot's, and its time as far as it was told.
    Robot(Mutex<(RobotConnection, Duration)>),
}

impl RunClock {
    /// The clock for this camera, from now on.
    pub(super) fn of_source(source: &SourceSpec) -> Result<Self, CaptureError> {
        let SourceSpec::SimulatedRobot(at) = source else {
            return Ok(Self::Computer(Instant::now()));
        };
        let mut robot = RobotConnection::open(*at)?;
        let reply = robot.ask(RobotRequest::Time)?;
        Ok(Self::Robot(Mutex::new((robot, reply.at))))
    }

    /// The time. That of a robot that is gone stands still; the robot's connection says that it is gone.
    pub(super) fn now(&self) -> Duration {
        match self {
            Self::Computer(started) => started.elapsed(),
            Self::Robot(robot) => {
                let mut held = lock(robot);
                let (robot, last) = &mut *held;
                if let Ok(reply) = robot.ask(RobotRequest::Time) {
                    *last = reply.at;
                }
                *last
            }
        }
    }

    /// When the frame arrived that has this number, came at this moment, and has been inspected by now.
    pub(super) fn arrived(&self, number: u64, at: Instant) -> Duration {
        match self {
            Self::Computer(started) => at.saturating_duration_since(*started),
            Self::Robot(robot) => {
                let mut held = lock(robot);
                let (robot, last) = &mut *held;
                let reply = robot.ask(RobotRequest::Inspected(number));
                reply.map_or(*last, |reply| reply.at)
            }
        }
    }
}
