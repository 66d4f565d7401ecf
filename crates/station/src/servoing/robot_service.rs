//! A simulated robot as a program of its own: another program drives it over its protocol, and gets the frames of its camera over
//! TCP ([`RobotRequest`]).
//!
//! While that program asks for the time, the robot waits until each frame has been inspected, see [`SimulatedRobot`].

use std::{
    collections::VecDeque,
    io::{self, BufRead as _, BufReader, ErrorKind, Read as _},
    mem,
    net::{TcpListener, TcpStream},
    sync::{
        Mutex,
        atomic::{AtomicBool, Ordering},
    },
    thread::{self, ScopedJoinHandle},
    time::{Duration, Instant},
};

use super::{
    SimulatedRobot,
    simulated_robot::{MAX_AHEAD, ProgramEnd},
};
use capture::{RobotReply, RobotRequest};
use geometry::{depth_frame::DepthFrame, error::lock, rigid::PoseDelta};
use servo::simulated::SimulatedCell;

/// What became of a simulated robot.
#[derive(Debug)]
pub struct RobotOutcome {
    /// How its program has ended; `None` if it was ended by a person.
    pub end: Option<Result<(), ProgramEnd>>,
    /// The true error at the end.
    pub true_error: PoseDelta,
}

/// The camera of a simulated robot, for any number of connections.
struct RobotCamera<'a> {
    robot: &'a SimulatedRobot,
    cell: &'a SimulatedCell<'a>,
    frames: Mutex<Frames>,
    is_over: AtomicBool,
}

#[derive(Default)]
struct Frames {
    /// When the next one is taken.
    next: Duration,
    num_taken: u64,
    /// Those that were taken and are not due yet, and when they are.
    coming: VecDeque<(Duration, u64, DepthFrame)>,
    /// The newest one that is due, with its number.
    newest: Option<(u64, DepthFrame)>,
    /// Numbers of those that were taken and may not have been inspected, and when they are due: however long a slow computer draws
    /// one, it counts from then on.
    pending: VecDeque<(u64, Duration)>,
    /// Number of connections that ask for the time, and since when there are any.
    num_clocks: usize,
    clock_since: Duration,
}

/// Most connections to the camera.
const MAX_CONNECTIONS: usize = 8;
/// Longest request.
const MAX_REQUEST_BYTES: usize = 64;
/// Most frames that are remembered: if nobody says that they are inspected, the oldest are forgotten.
const MAX_PENDING: usize = 100;
/// How often it looks whether the robot's program has ended.
const POLL_INTERVAL: Duration = Duration::from_millis(20);
/// How long connections go on once the program has ended: who drives it learns of that later, and would take the camera for lost.
const TIME_AT_END: Duration = Duration::from_secs(3);
/// How long a connection may take to take what it asked for.
const WRITE_TIMEOUT: Duration = Duration::from_secs(5);

/// Gives the frames of a simulated robot until its program has ended, or `is_ending` says so. `cell` is the one that the robot
/// stands in.
pub fn serve_robot(
    robot: SimulatedRobot,
    cell: &SimulatedCell<'_>,
    camera: &TcpListener,
    is_ending: impl Fn() -> bool,
) -> io::Result<RobotOutcome> {
    camera.set_nonblocking(true)?;
    let frames_of = RobotCamera {
        robot: &robot,
        cell,
        frames: Mutex::default(),
        is_over: AtomicBool::new(false),
    };
    thread::scope(|scope| {
        let mut connections = Vec::new();
        let mut ended = None;
        while !is_ending() {
            connections.retain(|thread: &ScopedJoinHandle<'_, ()>| !thread.is_finished());
            if robot.has_ended() {
                let ended = ended.get_or_insert_with(Instant::now);
                if connections.is_empty() || ended.elapsed() > TIME_AT_END {
                    break;
                }
            }
            match camera.accept() {
                Ok((stream, _)) if connections.len() < MAX_CONNECTIONS => {
                    let frames_of = &frames_of;
                    connections.push(scope.spawn(move || frames_of.answer(&stream)));
                }
                // One too many: it is closed.
                Ok(_) => {}
                Err(_) => thread::sleep(POLL_INTERVAL),
            }
        }
        frames_of.is_over.store(true, Ordering::SeqCst);
    });
    let (at, flange) = robot.now();
    Ok(RobotOutcome {
        true_error: cell.true_error(&flange, at),
        end: robot.end(),
    })
}

impl RobotCamera<'_> {
    /// Answers what comes over a connection, until it is closed. If it breaks, the other side says so.
    fn answer(&self, stream: &TcpStream) {
        let mut is_clock = false;
        let _ = self.exchange(stream, &mut is_clock);
        if is_clock {
            let mut frames = lock(&self.frames);
            frames.num_clocks -= 1;
            self.set_end(&frames);
        }
    }

    fn exchange(&self, stream: &TcpStream, is_clock: &mut bool) -> io::Result<()> {
        stream.set_nonblocking(false)?;
        stream.set_nodelay(true)?;
        stream.set_read_timeout(Some(POLL_INTERVAL))?;
        stream.set_write_timeout(Some(WRITE_TIMEOUT))?;
        let (mut from, mut to) = (BufReader::new(stream), stream);
        let mut line = Vec::new();
        let mut last = 0;
        while !self.is_over.load(Ordering::SeqCst) {
            let left = MAX_REQUEST_BYTES.saturating_sub(line.len()) as u64;
            match from.by_ref().take(left).read_until(b'\n', &mut line) {
                Ok(_) => {
                    // Without an end of the line it is closed, or too long.
                    let text = line.strip_suffix(b"\n");
                    let text = text.and_then(|text| str::from_utf8(text).ok());
                    let Some(request) = text.and_then(RobotRequest::read) else {
                        return Ok(());
                    };
                    line.clear();
                    if request == RobotRequest::Time && !mem::replace(is_clock, true) {
                        self.begin_clock();
                    }
                    self.reply(request, &mut last).write(&mut to)?;
                }
                Err(error) => match error.kind() {
                    ErrorKind::WouldBlock | ErrorKind::TimedOut | ErrorKind::Interrupted => {}
                    _ => return Err(error),
                },
            }
        }
        Ok(())
    }

    /// The answer over a connection that got the frame with the number `last`.
    fn reply(&self, request: RobotRequest, last: &mut u64) -> RobotReply {
        match request {
            RobotRequest::Frame => self.next_frame(last),
            RobotRequest::Time => RobotReply {
                at: self.robot.now().0,
                frame: None,
            },
            RobotRequest::Inspected(number) => {
                let mut frames = lock(&self.frames);
                let known = frames.pending.iter().find(|(one, _)| *one == number);
                let at = known.map_or_else(|| self.robot.now().0, |(_, due)| *due);
                frames.pending.retain(|(one, _)| *one > number);
                self.set_end(&frames);
                RobotReply { at, frame: None }
            }
        }
    }

    /// Takes a frame if it is time, and delivers the newest one that is due, unless this connection has it.
    fn next_frame(&self, last: &mut u64) -> RobotReply {
        let setup = self.cell.setup();
        let (now, flange) = self.robot.now();
        let mut frames = lock(&self.frames);
        if frames.next <= now {
            let due = now + setup.delay;
            frames.next = now + setup.frame_period;
            frames.num_taken += 1;
            let number = frames.num_taken;
            if frames.pending.len() == MAX_PENDING {
                frames.pending.pop_front();
            }
            frames.pending.push_back((number, due));
            self.set_end(&frames);
            // Others ask for the time meanwhile.
            drop(frames);
            let frame = self.cell.frame(&flange, now, number);
            frames = lock(&self.frames);
            match frame {
                Some(frame) => frames.coming.push_back((due, number, frame)),
                None => frames.pending.retain(|(one, _)| *one != number),
            }
        }
        let now = self.robot.now().0;
        while let Some((_, number, frame)) = frames.coming.pop_front_if(|(due, ..)| *due <= now) {
            // One that took longer to draw than the next is not the newest.
            if frames
                .newest
                .as_ref()
                .is_none_or(|(newest, _)| *newest < number)
            {
                frames.newest = Some((number, frame));
            }
        }
        let frame = (frames.newest.as_ref()).filter(|(number, _)| *number > *last);
        let frame = frame.cloned();
        if let Some((number, _)) = &frame {
            *last = *number;
        }
        RobotReply { at: now, frame }
    }

    fn begin_clock(&self) {
        let mut frames = lock(&self.frames);
        if frames.num_clocks == 0 {
            frames.clock_since = self.robot.now().0;
        }
        frames.num_clocks += 1;
        self.set_end(&frames);
    }

    /// Lets the robot go on for a while after the first frame is due that may not have been inspected.
    fn set_end(&self, frames: &Frames) {
        let first = frames.pending.front().filter(|_| frames.num_clocks > 0);
        let until = first.map(|(_, due)| frames.clock_since.max(*due) + MAX_AHEAD);
        self.robot.go_on_until(until);
    }
}

#[cfg(test)]
mod tests {
    use std::{io::Write as _, net::SocketAddr};

    use super::*;
    use crate::servoing::{RobotAddress, SimulatedTrial};
    use capture::RobotConnection;
    use inspection::fixtures::shipped_library;

    #[test]
    fn every_connection_gets_each_frame_once_and_a_wrong_request_ends_its_own() {
        let library = shipped_library();
        let cell = SimulatedTrial::default().arrange("fender", &library);
        let cell = cell.expect("a start");
        let any = SocketAddr::from(([127, 0, 0, 1], 0));
        // Nobody drives it, so its time stands still.
        let robot = RobotAddress::UniversalRobots(any);
        let robot = SimulatedRobot::start_at(cell.controller(robot.protocol()), &robot);
        let (robot, _) = robot.expect("loopback");
        let camera = TcpListener::bind(any).expect("loopback");
        let at = camera.local_addr().expect("bound");
        let is_ending = AtomicBool::new(false);
        let (frames, rest) = thread::scope(|scope| {
            scope.spawn(|| serve_robot(robot, &cell, &camera, || is_ending.load(Ordering::SeqCst)));
            let ask = || -> Result<_, capture::CaptureError> {
                let mut connection = RobotConnection::open(at)?;
                let mut next = || connection.ask(RobotRequest::Frame).map(|reply| reply.frame);
                Ok([next()?, next()?])
            };
            let frames = [ask(), ask()];
            let wrong = || {
                let mut stream = TcpStream::connect(at)?;
                stream.write_all(b"frames, please\n")?;
                let mut rest = Vec::new();
                stream.read_to_end(&mut rest).map(|_| rest)
            };
            let rest = wrong();
            is_ending.store(true, Ordering::SeqCst);
            (frames, rest)
        });
        let [first, second] = frames.map(|frames| frames.expect("answers"));
        assert!(first[0].is_some() && first[1].is_none());
        assert!(first == second, "the same frame");
        assert_eq!(rest.expect("closed"), b"");
    }
}
