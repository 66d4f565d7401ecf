//! The connection to a robot's controller.

use std::{
    fmt,
    io::{self, ErrorKind, Read as _, Write as _},
    net::{IpAddr, SocketAddr, TcpStream, UdpSocket},
    str::FromStr,
    time::Duration,
};

use files::words_of;
use geometry::error::Advice;
use robot::arm::PlacedArm;
use serve::parse_address;
use servo::{
    simulated::StreamProtocol,
    stream::{Egm, Rsi, Rtde, Stream, StreamError},
};

/// How a controller is reached.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RobotAddress {
    /// ABB's EGM: this computer listens here.
    Egm(SocketAddr),
    /// KUKA's RSI: this computer listens here.
    Rsi(SocketAddr),
    /// Universal Robots: the controller listens here for RTDE, and two ports lower for programs.
    UniversalRobots(SocketAddr),
}

/// The port at which Universal Robots' controllers listen for RTDE.
const RTDE_PORT: u16 = 30004;
/// How many ports lower they listen for programs.
pub(super) const PROGRAM_PORT_OFFSET: u16 = 2;
/// Greatest size of a UDP packet.
const MAX_PACKET_BYTES: usize = 65_536;
/// How long a controller may take to accept a connection or bytes.
const CONNECT_TIMEOUT: Duration = Duration::from_secs(5);

impl RobotAddress {
    /// An address of a controller of this protocol.
    pub fn new(protocol: StreamProtocol, at: SocketAddr) -> Self {
        match protocol {
            StreamProtocol::Egm => Self::Egm(at),
            StreamProtocol::Rsi => Self::Rsi(at),
            StreamProtocol::Rtde => Self::UniversalRobots(at),
        }
    }

    /// Its protocol.
    pub fn protocol(&self) -> StreamProtocol {
        match self {
            Self::Egm(_) => StreamProtocol::Egm,
            Self::Rsi(_) => StreamProtocol::Rsi,
            Self::UniversalRobots(_) => StreamProtocol::Rtde,
        }
    }

    /// The address.
    pub fn address(&self) -> SocketAddr {
        match self {
            Self::Egm(at) | Self::Rsi(at) | Self::UniversalRobots(at) => *at,
        }
    }

    /// The same protocol at another address.
    #[must_use]
    pub fn at(self, at: SocketAddr) -> Self {
        Self::new(self.protocol(), at)
    }

    /// What speaks its protocol. RSI needs the arm.
    pub fn stream(&self, arm: Option<&PlacedArm>) -> Result<Box<dyn Stream + Send>, LinkError> {
        Ok(match (self, arm) {
            (Self::Egm(_), _) => Box::<Egm>::default(),
            (Self::UniversalRobots(_), _) => Box::<Rtde>::default(),
            (Self::Rsi(_), Some(arm)) => Box::new(Rsi::new(arm.clone())),
            (Self::Rsi(_), None) => return Err(LinkError::NoArm),
        })
    }
}

impl fmt::Display for RobotAddress {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}={}", self.protocol().name(), self.address())
    }
}

impl FromStr for RobotAddress {
    type Err = LinkError;

    fn from_str(text: &str) -> Result<Self, LinkError> {
        let wrong = || LinkError::Address { text: text.into() };
        let (protocol, at) = text.split_once('=').ok_or_else(wrong)?;
        let protocol = StreamProtocol::named(protocol).ok_or_else(wrong)?;
        let at = match at.parse::<IpAddr>() {
            Ok(ip) if protocol == StreamProtocol::Rtde => Some(SocketAddr::new(ip, RTDE_PORT)),
            _ => parse_address(at).ok(),
        };
        Ok(Self::new(protocol, at.ok_or_else(wrong)?))
    }
}

/// Why a robot cannot be reached.
#[derive(Debug, thiserror::Error, Advice)]
pub enum LinkError {
    /// The text names no robot.
    #[error("{text:?} is not the address of a robot")]
    #[advice = "Give egm=IP:PORT or rsi=IP:PORT of this computer, or ur=IP of the robot, for example egm=192.168.1.10:6510"]
    Address {
        /// The text.
        text: String,
    },
    /// The protocol needs a model of the arm.
    #[error("RSI corrects joints, so the arm must be known")]
    #[advice = "Add --arm and --nozzle"]
    NoArm,
    /// The system does not listen there.
    #[error("cannot listen at {at}: {}", words_of(source))]
    #[advice = "Give the address of this computer's network card that leads to the robot, and end other programs that use the port"]
    Listen {
        /// The address.
        at: SocketAddr,
        /// The underlying error.
        source: io::Error,
    },
    /// The controller does not answer.
    #[error("no connection to the robot at {at}: {}", words_of(source))]
    #[advice = "Check the robot's address and cable, and that it is set to remote control"]
    Connect {
        /// The address.
        at: SocketAddr,
        /// The underlying error.
        source: io::Error,
    },
    /// The connection broke.
    #[error("the connection to the robot at {at} is lost: {}", words_of(source))]
    #[advice = "The robot stops by itself. Check the cable and the controller, and servo again"]
    Lost {
        /// The address.
        at: SocketAddr,
        /// The underlying error.
        source: io::Error,
    },
    /// The camera is a simulated robot's, and the robot is another one: it would move by what its own camera does not see.
    #[error(
        "the camera is that of a simulated robot at {camera}, and the robot at {robot} is another one"
    )]
    #[advice = "Give the robot's own camera as --source, or end the robot's program and start the simulated one"]
    OtherRobot {
        /// Where the robot is that reports.
        robot: IpAddr,
        /// Where the simulated one is.
        camera: IpAddr,
    },
    /// The controller speaks otherwise.
    #[error(transparent)]
    #[advice(transparent)]
    Stream(#[from] StreamError),
}

/// A connection to a controller.
pub struct RobotLink {
    at: SocketAddr,
    /// The computer of the robot, if it must be a simulated one.
    simulated_at: Option<IpAddr>,
    socket: Socket,
    buffer: Vec<u8>,
}

enum Socket {
    Udp {
        socket: UdpSocket,
        /// Who has sent the last packet; once it was a report, packets of others are ignored.
        from: Option<SocketAddr>,
        has_reported: bool,
    },
    Tcp(TcpStream),
}

impl RobotLink {
    /// Listens for the controller, or connects to it and starts the program there.
    pub fn open(robot: &RobotAddress) -> Result<Self, LinkError> {
        let at = robot.address();
        let socket = match robot {
            RobotAddress::Egm(_) | RobotAddress::Rsi(_) => {
                let socket = UdpSocket::bind(at);
                Socket::Udp {
                    socket: socket.map_err(|source| LinkError::Listen { at, source })?,
                    from: None,
                    has_reported: false,
                }
            }
            RobotAddress::UniversalRobots(_) => {
                let connect = |at: SocketAddr| {
                    let stream = TcpStream::connect_timeout(&at, CONNECT_TIMEOUT)
                        .and_then(|stream| stream.set_nodelay(true).map(|()| stream));
                    let stream = stream.and_then(|stream| {
                        stream
                            .set_write_timeout(Some(CONNECT_TIMEOUT))
                            .map(|()| stream)
                    });
                    stream.map_err(|source| LinkError::Connect { at, source })
                };
                let rtde = connect(at)?;
                let port = at.port().saturating_sub(PROGRAM_PORT_OFFSET);
                let program_at = SocketAddr::new(at.ip(), port);
                let sent = connect(program_at)?.write_all(Rtde::PROGRAM.as_bytes());
                sent.map_err(|source| LinkError::Lost {
                    at: program_at,
                    source,
                })?;
                Socket::Tcp(rtde)
            }
        };
        Ok(Self {
            at,
            simulated_at: None,
            socket,
            buffer: vec![0; MAX_PACKET_BYTES],
        })
    }

    /// The address that this computer listens at, with the port that the system chose, or that of the controller.
    pub fn address(&self) -> SocketAddr {
        match &self.socket {
            Socket::Udp { socket, .. } => socket.local_addr().unwrap_or(self.at),
            Socket::Tcp(_) => self.at,
        }
    }

    /// From now on takes a robot alone that is on the computer with this address, where a simulated one is.
    pub(super) fn expect_simulated(&mut self, at: IpAddr) {
        self.simulated_at = Some(at);
    }

    /// Notes that the last bytes were a report; returns the controller's address.
    pub(super) fn reported(&mut self) -> Result<SocketAddr, LinkError> {
        let robot = match &mut self.socket {
            Socket::Udp {
                from, has_reported, ..
            } => {
                *has_reported = true;
                from.unwrap_or(self.at)
            }
            Socket::Tcp(_) => self.at,
        };
        let (robot_ip, camera) = (robot.ip(), self.simulated_at);
        match camera.filter(|camera| !is_one_computer(robot_ip, *camera)) {
            Some(camera) => Err(LinkError::OtherRobot {
                robot: robot_ip,
                camera,
            }),
            None => Ok(robot),
        }
    }

    /// Waits for bytes of the controller; `None` if none come, or another computer's.
    pub(super) fn receive(&mut self, at_most: Duration) -> Result<Option<Vec<u8>>, LinkError> {
        let read = match &mut self.socket {
            Socket::Udp {
                socket,
                from,
                has_reported,
            } => socket
                .set_read_timeout(Some(at_most))
                .and_then(|()| socket.recv_from(&mut self.buffer))
                .map(|(length, sender)| {
                    if !*has_reported {
                        *from = Some(sender);
                    }
                    (*from == Some(sender)).then_some(length)
                }),
            Socket::Tcp(stream) => stream
                .set_read_timeout(Some(at_most))
                .and_then(|()| stream.read(&mut self.buffer))
                .and_then(|length| match length {
                    0 => Err(ErrorKind::UnexpectedEof.into()),
                    length => Ok(Some(length)),
                }),
        };
        match read {
            Ok(length) => Ok(length.map(|length| self.buffer[..length].to_vec())),
            Err(error) if is_nothing(&error) => Ok(None),
            Err(source) => Err(self.lost(source)),
        }
    }

    pub(super) fn send(&mut self, bytes: &[u8]) -> Result<(), LinkError> {
        if bytes.is_empty() {
            return Ok(());
        }
        let sent = match &mut self.socket {
            Socket::Udp {
                socket,
                from: Some(robot),
                ..
            } => socket.send_to(bytes, *robot).map(|_| ()),
            Socket::Udp { from: None, .. } => Ok(()),
            Socket::Tcp(stream) => stream.write_all(bytes),
        };
        match sent {
            Err(error) if is_nothing(&error) => Ok(()),
            sent => sent.map_err(|source| self.lost(source)),
        }
    }

    /// Whether the connection goes on after bytes that are no report: a packet may be another's, a stream of bytes is broken.
    pub(super) fn refused(&self, problem: &StreamError) -> Result<(), LinkError> {
        match self.socket {
            Socket::Udp { .. } => Ok(()),
            Socket::Tcp(_) => Err(problem.clone().into()),
        }
    }

    fn lost(&self, source: io::Error) -> LinkError {
        LinkError::Lost {
            at: self.at,
            source,
        }
    }
}

/// Nothing came in time. A peer that has closed its UDP socket (connection refused or reset) may open it again.
fn is_nothing(error: &io::Error) -> bool {
    matches!(
        error.kind(),
        ErrorKind::WouldBlock
            | ErrorKind::TimedOut
            | ErrorKind::Interrupted
            | ErrorKind::ConnectionRefused
            | ErrorKind::ConnectionReset
    )
}

/// True for addresses of one computer: the same, or both of this one.
fn is_one_computer(one: IpAddr, other: IpAddr) -> bool {
    // The system binds nothing else.
    let is_here = |ip: IpAddr| UdpSocket::bind((ip, 0)).is_ok();
    one == other || is_here(one) && is_here(other)
}
