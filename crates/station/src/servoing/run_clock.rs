//! The clock by which a run is dated: this computer's, or that of a simulated robot, which waits for a computer that is too slow.

use std::{
    sync::Mutex,
    time::{Duration, Instant},
};

use capture::{CaptureError, RobotConnection, RobotRequest, SourceSpec};
use geometry::error::lock;

/// The clock of a run. It never goes back.
pub(super) struct RunClock(Mutex<ClockReading>);

/// What time it was last.
struct ClockReading {
    /// Whom to ask; `None` for this computer's clock, by which the time also goes on once a robot does not answer: so that the run
    /// ends for want of frames or reports, as with a real robot.
    robot: Option<RobotConnection>,
    at: Instant,
    time: Duration,
}

impl ClockReading {
    fn ask(&mut self, request: RobotRequest) -> Option<Duration> {
        let reply = self.robot.as_mut()?.ask(request);
        if reply.is_err() {
            self.robot = None;
        }
        Some(reply.ok()?.at)
    }

    /// The time at this moment by this computer's clock.
    fn time_at(&self, moment: Instant) -> Duration {
        let before = self.at.saturating_duration_since(moment);
        let since = moment.saturating_duration_since(self.at);
        self.time.saturating_sub(before) + since
    }
}

impl RunClock {
    /// The clock for this camera, from now on.
    pub(super) fn of_source(source: &SourceSpec) -> Result<Self, CaptureError> {
        let mut reading = ClockReading {
            robot: None,
            at: Instant::now(),
            time: Duration::ZERO,
        };
        if let SourceSpec::SimulatedRobot(at) = source {
            let mut robot = RobotConnection::open(*at)?;
            reading.time = robot.ask(RobotRequest::Time)?.at;
            reading.robot = Some(robot);
        }
        Ok(Self(Mutex::new(reading)))
    }

    /// The time.
    pub(super) fn now(&self) -> Duration {
        let mut reading = lock(&self.0);
        let asked = reading.ask(RobotRequest::Time);
        let now = Instant::now();
        let time = asked
            .unwrap_or_else(|| reading.time_at(now))
            .max(reading.time);
        (reading.at, reading.time) = (now, time);
        time
    }

    /// When the frame arrived that has this number, came at this moment, and has been inspected by now.
    pub(super) fn arrived(&self, number: u64, at: Instant) -> Duration {
        let mut reading = lock(&self.0);
        let asked = reading.ask(RobotRequest::Inspected(number));
        asked.unwrap_or_else(|| reading.time_at(at))
    }
}

#[cfg(test)]
mod tests {
    use std::{
        io::{BufRead as _, BufReader},
        net::TcpListener,
        thread,
    };

    use super::*;
    use capture::RobotReply;

    #[test]
    fn the_time_of_a_robot_never_goes_back_and_goes_on_without_it() {
        let robot = TcpListener::bind("127.0.0.1:0").expect("loopback");
        let source = SourceSpec::SimulatedRobot(robot.local_addr().expect("bound"));
        let times = [40, 70, 30, 60].map(Duration::from_secs);
        thread::scope(|scope| {
            scope.spawn(|| {
                let (stream, _) = robot.accept().expect("connected");
                let mut lines = BufReader::new(&stream).lines();
                for at in times {
                    lines.next().expect("asked").expect("a line");
                    let reply = RobotReply { at, frame: None };
                    reply.write(&mut &stream).expect("sent");
                }
            });
            let clock = RunClock::of_source(&source).expect("a robot");
            assert_eq!(clock.now(), times[1]);
            assert_eq!(clock.now(), times[1], "not back");
            let arrived = Instant::now();
            assert_eq!(clock.arrived(7, arrived), times[3]);
            // The robot is gone.
            let later = clock.now();
            assert!(later > times[1] && clock.arrived(8, arrived) < later);
            thread::sleep(Duration::from_millis(1));
            assert!(clock.now() > later);
        });
    }

    #[test]
    fn without_a_robot_it_is_the_clock_of_this_computer() {
        let source = "kinect".parse().expect("a source");
        let clock = RunClock::of_source(&source).expect("no robot");
        let (between, before) = (Instant::now(), clock.now());
        let arrived = clock.arrived(1, between);
        assert!(arrived <= before && clock.now() >= before, "{arrived:?}");
    }
}
