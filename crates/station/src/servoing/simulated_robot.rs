//! A simulated robot that moves in real time, and speaks its protocol on this computer's loopback network.
//!
//! It waits for the answer to each report, and for frames to be inspected, so that a computer that is too slow slows the simulation
//! down instead of disturbing it. Its clock is the simulated one.

use std::{
    io::{self, Read as _, Write as _},
    net::{Ipv4Addr, SocketAddr, TcpListener, TcpStream, UdpSocket},
    sync::{
        Arc, Mutex,
        atomic::{AtomicBool, Ordering},
    },
    thread::{self, JoinHandle},
    time::{Duration, Instant},
};

use super::{LinkError, RobotAddress, RobotLink};
use geometry::{error::lock, rigid::RigidTransform};
use servo::simulated::{SimulatedController, StreamProtocol};

/// A simulated robot. Dropping it ends it.
pub struct SimulatedRobot {
    shared: Arc<Shared>,
    thread: Option<JoinHandle<()>>,
}

struct Shared {
    controller: Mutex<SimulatedController>,
    /// When the last frame that has been inspected counts.
    looked_at: Mutex<Duration>,
    is_over: AtomicBool,
}

/// How long it waits for an answer: its program then ends, as on a real controller.
const ANSWER_TIMEOUT: Duration = Duration::from_secs(1);
/// How far it goes on without a frame that has been inspected.
const MAX_AHEAD: Duration = Duration::from_millis(300);
/// How often it looks whether a frame counts by now.
const POLL_INTERVAL: Duration = Duration::from_millis(2);
/// Tries to find two free ports that belong together.
const MAX_TRIES: usize = 50;

impl SimulatedRobot {
    /// Starts a robot, and returns it with a connection to it.
    pub fn start(
        controller: SimulatedController,
        protocol: StreamProtocol,
    ) -> Result<(Self, RobotLink), LinkError> {
        let here = SocketAddr::from((Ipv4Addr::LOCALHOST, 0));
        let (link, cable) = match protocol {
            StreamProtocol::Egm | StreamProtocol::Rsi => {
                let link = RobotLink::open(&RobotAddress::Egm(here))?;
                let at = link.address();
                let socket = UdpSocket::bind(here).and_then(|socket| {
                    socket.connect(at)?;
                    socket.set_read_timeout(Some(ANSWER_TIMEOUT))?;
                    Ok(socket)
                });
                let socket = socket.map_err(|source| LinkError::Listen { at, source })?;
                (link, Cable::Udp(socket))
            }
            StreamProtocol::Rtde => {
                let listeners = two_listeners();
                let [programs, rtde] =
                    listeners.map_err(|source| LinkError::Listen { at: here, source })?;
                let at = rtde.local_addr();
                let at = at.map_err(|source| LinkError::Listen { at: here, source })?;
                let link = RobotLink::open(&RobotAddress::UniversalRobots(at))?;
                let stream = accepted(&rtde, &programs);
                let stream = stream.map_err(|source| LinkError::Connect { at, source })?;
                (link, Cable::Tcp(stream))
            }
        };
        let shared = Arc::new(Shared {
            controller: Mutex::new(controller),
            looked_at: Mutex::default(),
            is_over: AtomicBool::new(false),
        });
        let theirs = Arc::clone(&shared);
        let thread = thread::Builder::new()
            .name("simulated robot".into())
            .spawn(move || {
                // If the connection breaks, the robot's program ends, and the other side reports it.
                let _ = run(&theirs, cable);
            });
        let thread = thread.map_err(|source| LinkError::Listen {
            at: link.address(),
            source,
        })?;
        let robot = Self {
            shared,
            thread: Some(thread),
        };
        Ok((robot, link))
    }

    /// The simulated time, and where the flange really is.
    pub fn now(&self) -> (Duration, RigidTransform) {
        let controller = lock(&self.shared.controller);
        (controller.arm.state().at, controller.arm.true_flange())
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
        *lock(&self.shared.looked_at) = due;
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
            let _ = thread.join();
        }
    }
}

enum Cable {
    Udp(UdpSocket),
    Tcp(TcpStream),
}

fn run(shared: &Shared, mut cable: Cable) -> io::Result<()> {
    let controller = &shared.controller;
    let mut buffer = vec![0; 65_536];
    if let Cable::Tcp(stream) = &mut cable {
        // The requests that open the connection.
        let mut is_open = false;
        while !is_open {
            let length = stream.read(&mut buffer)?;
            let received = &buffer[..length];
            is_open = length == 0 || received.ends_with(&[0, 3, b'S']);
            let answer = lock(controller).take(received).map_err(io::Error::other)?;
            stream.write_all(&answer)?;
        }
    }
    let period = lock(controller).arm.period();
    let mut next = Instant::now();
    while !shared.is_over.load(Ordering::SeqCst) {
        next = (next + period).max(Instant::now());
        thread::sleep(next.saturating_duration_since(Instant::now()));
        let looked_at = *lock(&shared.looked_at);
        if lock(controller).arm.state().at > looked_at + MAX_AHEAD {
            continue;
        }
        let report = {
            let mut controller = lock(controller);
            controller.arm.advance();
            controller.report()
        };
        let length = match &mut cable {
            Cable::Udp(socket) => {
                socket.send(&report)?;
                socket.recv(&mut buffer)?
            }
            Cable::Tcp(stream) => {
                stream.write_all(&report)?;
                stream.read(&mut buffer)?
            }
        };
        if length == 0 {
            break;
        }
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

/// Listeners for programs, and two ports higher for RTDE.
fn two_listeners() -> io::Result<[TcpListener; 2]> {
    let mut last = io::Error::other("no two free ports");
    for _ in 0..MAX_TRIES {
        let programs = TcpListener::bind((Ipv4Addr::LOCALHOST, 0))?;
        let port = programs.local_addr()?.port();
        let rtde = port.checked_add(2).ok_or(io::ErrorKind::AddrInUse)?;
        match TcpListener::bind((Ipv4Addr::LOCALHOST, rtde)) {
            Ok(rtde) => return Ok([programs, rtde]),
            Err(error) => last = error,
        }
    }
    Err(last)
}

/// Takes the program, and the connection for RTDE.
fn accepted(rtde: &TcpListener, programs: &TcpListener) -> io::Result<TcpStream> {
    let (stream, _) = rtde.accept()?;
    let (mut sender, _) = programs.accept()?;
    let mut program = String::new();
    sender.read_to_string(&mut program)?;
    if !program.contains("servoj(") {
        return Err(io::Error::other("the program moves nothing"));
    }
    stream.set_nodelay(true)?;
    stream.set_read_timeout(Some(ANSWER_TIMEOUT))?;
    Ok(stream)
}
