//! A simulated robot that moves in real time, and speaks its protocol: on this computer's loopback network, or with another
//! program.
//!
//! It waits for the answer to each report, and for frames to be inspected, so that a computer that is too slow slows the simulation
//! down instead of disturbing it. Its clock is the simulated one.

use std::{
    io::{self, ErrorKind, Read as _, Write as _},
    net::{IpAddr, Ipv4Addr, Ipv6Addr, SocketAddr, TcpListener, TcpStream, UdpSocket},
    panic::resume_unwind,
    sync::{
        Arc, Mutex,
        atomic::{AtomicBool, Ordering},
    },
    thread::{self, JoinHandle},
    time::{Duration, Instant},
};

use super::{LinkError, RobotAddress, RobotLink, robot_link::PROGRAM_PORT_OFFSET};
use files::words_of;
use geometry::{
    error::{Advice, lock},
    rigid::RigidTransform,
};
use servo::simulated::{SimulatedController, StreamProtocol};

/// A simulated robot. Dropping it ends it.
pub struct SimulatedRobot {
    shared: Arc<Shared>,
    thread: Option<JoinHandle<io::Result<()>>>,
}

struct Shared {
    controller: Mutex<SimulatedController>,
    /// How far it goes on until more frames have been inspected; without end if nobody tells it.
    goes_until: Mutex<Option<Duration>>,
    is_over: AtomicBool,
}

/// Why the program of a simulated robot has ended before its target.
#[derive(Debug, thiserror::Error, Advice)]
#[error("the robot's program has ended before its target: {}", cause(source))]
#[advice = "See why the other side has stopped; then start both again"]
pub struct ProgramEnd {
    /// The underlying error.
    #[from]
    source: io::Error,
}

fn cause(error: &io::Error) -> String {
    match error.kind() {
        ErrorKind::WouldBlock | ErrorKind::TimedOut => {
            format!("no answer for {} s", ANSWER_TIMEOUT.as_secs())
        }
        ErrorKind::UnexpectedEof => "the other side has closed the connection".to_owned(),
        _ => words_of(error),
    }
}

/// How long it waits for an answer: its program then ends, as on a real controller.
const ANSWER_TIMEOUT: Duration = Duration::from_secs(2);
/// How often it reports to an address at which nothing listens yet.
const RETRY_INTERVAL: Duration = Duration::from_millis(100);
/// How far it goes on without a frame that has been inspected.
pub(super) const MAX_AHEAD: Duration = Duration::from_millis(300);
/// How often it looks whether a frame counts by now, or whether its program was sent.
const POLL_INTERVAL: Duration = Duration::from_millis(2);
/// What a program of Universal Robots calls to move by poses that are streamed.
const MOVES: &[u8] = b"servoj(";
/// Tries to find two free ports that belong together.
const MAX_TRIES: usize = 50;

impl SimulatedRobot {
    /// Starts a robot on the loopback network, and returns it with a connection to it.
    pub fn start(
        controller: SimulatedController,
        protocol: StreamProtocol,
    ) -> Result<(Self, RobotLink), LinkError> {
        let here = SocketAddr::from((Ipv4Addr::LOCALHOST, 0));
        let (robot, link) = match protocol {
            StreamProtocol::Egm | StreamProtocol::Rsi => {
                let link = RobotLink::open(&RobotAddress::new(protocol, here))?;
                let at = RobotAddress::new(protocol, link.address());
                (Self::start_at(controller, &at)?.0, link)
            }
            StreamProtocol::Rtde => {
                let at = RobotAddress::UniversalRobots(here);
                let (robot, at) = Self::start_at(controller, &at)?;
                (robot, RobotLink::open(&at)?)
            }
        };
        // Its frames are all inspected.
        robot.go_on_until(Some(MAX_AHEAD));
        Ok((robot, link))
    }

    /// Starts a robot that reports to this address, or, of Universal Robots, listens there. Returns it with the address, in which
    /// port 0 is the one that the system chose.
    pub fn start_at(
        controller: SimulatedController,
        address: &RobotAddress,
    ) -> Result<(Self, RobotAddress), LinkError> {
        let at = address.address();
        let listen = |source| LinkError::Listen { at, source };
        let (cable, at) = match address {
            RobotAddress::Egm(_) | RobotAddress::Rsi(_) => {
                (Cable::Udp(socket_to(at).map_err(listen)?), at)
            }
            RobotAddress::UniversalRobots(_) => {
                let listeners = two_listeners(at).map_err(listen)?;
                let at = listeners[1].local_addr().map_err(listen)?;
                (Cable::Listening(listeners), at)
            }
        };
        let shared = Arc::new(Shared {
            controller: Mutex::new(controller),
            goes_until: Mutex::default(),
            is_over: AtomicBool::new(false),
        });
        let theirs = Arc::clone(&shared);
        let thread = thread::Builder::new()
            .name("simulated robot".into())
            .spawn(move || run(&theirs, cable));
        let robot = Self {
            shared,
            thread: Some(thread.map_err(listen)?),
        };
        Ok((robot, address.at(at)))
    }

    /// The simulated time, and where the flange really is.
    pub fn now(&self) -> (Duration, RigidTransform) {
        let controller = lock(&self.shared.controller);
        (controller.arm.state().at, controller.arm.true_flange())
    }

    /// True once its program has ended.
    pub(super) fn has_ended(&self) -> bool {
        (self.thread.as_ref()).is_none_or(JoinHandle::is_finished)
    }

    /// Ends it; returns how its program has ended, if it had ended before.
    pub(super) fn end(mut self) -> Option<Result<(), ProgramEnd>> {
        let thread = self.thread.take_if(|thread| thread.is_finished())?;
        let end = thread.join().unwrap_or_else(|panic| resume_unwind(panic));
        Some(end.map_err(ProgramEnd::from))
    }

    /// Sets how far it goes on until more frames have been inspected; `None` for without end.
    pub(super) fn go_on_until(&self, until: Option<Duration>) {
        *lock(&self.shared.goes_until) = until;
    }

    /// Takes a frame, and says what its inspection finds, this long after the frame at the earliest: `look` gets where the flange
    /// really is, and the time. Once the flag is set, it returns soon.
    pub fn look<T>(
        &self,
        delay: Duration,
        is_over: &AtomicBool,
        look: impl FnOnce(&RigidTransform, Duration) -> T,
    ) -> T {
        let (at, flange) = self.now();
        let seen = look(&flange, at);
        let due = at + delay;
        self.go_on_until(Some(due + MAX_AHEAD));
        while self.now().0 < due && !is_over.load(Ordering::SeqCst) {
            thread::sleep(POLL_INTERVAL);
        }
        seen
    }
}

impl Drop for SimulatedRobot {
    fn drop(&mut self) {
        self.shared.is_over.store(true, Ordering::SeqCst);
        if let Some(thread) = self.thread.take() {
            // If the connection broke, the other side has reported it.
            let _ = thread.join();
        }
    }
}

/// What a robot is connected by, before its program begins.
enum Cable {
    Udp(UdpSocket),
    /// For programs, and for RTDE.
    Listening([TcpListener; 2]),
}

/// A connection over which reports are answered.
enum Line {
    Udp(UdpSocket),
    Tcp(TcpStream),
}

impl Line {
    fn send(&mut self, report: &[u8]) -> io::Result<()> {
        match self {
            Self::Udp(socket) => socket.send(report).map(|_| ()),
            Self::Tcp(stream) => stream.write_all(report),
        }
    }

    fn receive(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        match self {
            Self::Udp(socket) => socket.recv(buffer),
            Self::Tcp(stream) => match stream.read(buffer)? {
                0 => Err(ErrorKind::UnexpectedEof.into()),
                length => Ok(length),
            },
        }
    }
}

fn run(shared: &Shared, cable: Cable) -> io::Result<()> {
    let mut buffer = vec![0; 65_536];
    let line = match cable {
        Cable::Udp(socket) => reported(shared, socket, &mut buffer)?,
        Cable::Listening([programs, rtde]) => accepted(shared, &rtde, &programs, &mut buffer)?,
    };
    let Some(mut line) = line else {
        return Ok(());
    };
    let controller = &shared.controller;
    let period = lock(controller).arm.period();
    let mut next = Instant::now();
    while !shared.is_over.load(Ordering::SeqCst) {
        next = (next + period).max(Instant::now());
        thread::sleep(next.saturating_duration_since(Instant::now()));
        let until = *lock(&shared.goes_until);
        if until.is_some_and(|until| lock(controller).arm.state().at > until) {
            continue;
        }
        line.send(&report(controller))?;
        let length = line.receive(&mut buffer)?;
        let mut controller = lock(controller);
        controller
            .take(&buffer[..length])
            .map_err(io::Error::other)?;
        if controller.has_arrived() {
            break;
        }
    }
    Ok(())
}

/// The report after the next period.
fn report(controller: &Mutex<SimulatedController>) -> Vec<u8> {
    let mut controller = lock(controller);
    controller.arm.advance();
    controller.report()
}

/// Reports until there is an answer for the first time; `None` if the robot is to end before.
fn reported(shared: &Shared, socket: UdpSocket, buffer: &mut [u8]) -> io::Result<Option<Line>> {
    let controller = &shared.controller;
    while !shared.is_over.load(Ordering::SeqCst) {
        let sent = socket.send(&report(controller));
        match sent.and_then(|_| socket.recv(buffer)) {
            // Anything else may be the answer to an earlier report.
            Ok(length) if lock(controller).take(&buffer[..length]).is_ok() => {
                return Ok(Some(Line::Udp(socket)));
            }
            Ok(_) => {}
            Err(error) => match error.kind() {
                ErrorKind::WouldBlock | ErrorKind::TimedOut | ErrorKind::Interrupted => {}
                // Nothing listens there yet.
                ErrorKind::ConnectionRefused | ErrorKind::ConnectionReset => {
                    thread::sleep(RETRY_INTERVAL);
                }
                _ => return Err(error),
            },
        }
    }
    Ok(None)
}

/// A socket that exchanges packets with this address alone.
fn socket_to(at: SocketAddr) -> io::Result<UdpSocket> {
    let any: IpAddr = if at.is_ipv4() {
        Ipv4Addr::UNSPECIFIED.into()
    } else {
        Ipv6Addr::UNSPECIFIED.into()
    };
    let socket = UdpSocket::bind((any, 0))?;
    socket.connect(at)?;
    socket.set_read_timeout(Some(ANSWER_TIMEOUT))?;
    Ok(socket)
}

/// Listeners for programs, and for RTDE at this address, or where the system has two ports that belong together.
fn two_listeners(at: SocketAddr) -> io::Result<[TcpListener; 2]> {
    let listen = |port| {
        let listener = TcpListener::bind((at.ip(), port))?;
        // So that it may end before anything connects.
        listener.set_nonblocking(true)?;
        Ok::<_, io::Error>(listener)
    };
    let programs_at = |rtde: u16| rtde.checked_sub(PROGRAM_PORT_OFFSET);
    if at.port() > 0 {
        let port = programs_at(at.port()).ok_or(ErrorKind::AddrNotAvailable)?;
        return Ok([listen(port)?, listen(at.port())?]);
    }
    let mut last = io::Error::other("no two free ports");
    for _ in 0..MAX_TRIES {
        let rtde = listen(0)?;
        let port = programs_at(rtde.local_addr()?.port()).ok_or(ErrorKind::AddrInUse)?;
        match listen(port) {
            Ok(programs) => return Ok([programs, rtde]),
            Err(error) => last = error,
        }
    }
    Err(last)
}

/// Waits for a connection; `None` if the robot is to end before.
fn connected(shared: &Shared, listener: &TcpListener) -> io::Result<Option<TcpStream>> {
    while !shared.is_over.load(Ordering::SeqCst) {
        match listener.accept() {
            Ok((stream, _)) => {
                stream.set_nonblocking(false)?;
                stream.set_read_timeout(Some(ANSWER_TIMEOUT))?;
                return Ok(Some(stream));
            }
            Err(error) if error.kind() == ErrorKind::WouldBlock => thread::sleep(POLL_INTERVAL),
            Err(error) => return Err(error),
        }
    }
    Ok(None)
}

/// Takes the connection for RTDE, the program, and the requests that open the connection; `None` if the robot is to end before.
fn accepted(
    shared: &Shared,
    rtde: &TcpListener,
    programs: &TcpListener,
    buffer: &mut [u8],
) -> io::Result<Option<Line>> {
    let (Some(mut stream), Some(mut sender)) =
        (connected(shared, rtde)?, connected(shared, programs)?)
    else {
        return Ok(None);
    };
    if !moves(shared, &mut sender, buffer)? {
        return Err(io::Error::other("the program moves nothing"));
    }
    stream.set_nodelay(true)?;
    let mut is_open = false;
    while !is_open {
        if shared.is_over.load(Ordering::SeqCst) {
            return Ok(None);
        }
        let length = stream.read(buffer)?;
        let received = &buffer[..length];
        is_open = length == 0 || received.ends_with(&[0, 3, b'S']);
        let answer = lock(&shared.controller).take(received);
        stream.write_all(&answer.map_err(io::Error::other)?)?;
    }
    Ok(Some(Line::Tcp(stream)))
}

/// Takes a program, of which the buffer has room for more than any has; true if it moves the arm.
fn moves(shared: &Shared, sender: &mut TcpStream, buffer: &mut [u8]) -> io::Result<bool> {
    let mut length = 0;
    while !shared.is_over.load(Ordering::SeqCst) {
        match sender.read(&mut buffer[length..])? {
            0 => break,
            more => length += more,
        }
    }
    let mut program = buffer[..length].windows(MOVES.len());
    Ok(program.any(|words| words == MOVES))
}
