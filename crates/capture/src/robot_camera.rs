//! The camera of a simulated robot that runs as a program of its own: its frames and its time, over TCP.
//!
//! ```text
//! frame          ─►  a head, and a picture if one was delivered since the last request
//! time           ─►  a head; from now on the robot waits until each frame has been inspected
//! inspected 12   ─►  a head, whose time is when frame 12 was due
//! ```
//!
//! Requests and heads are lines; a head is JSON. A picture follows its head: its depths row by row, two bytes each, the low one
//! first.

use std::{
    fmt,
    io::{self, BufRead, BufReader, Read as _, Write},
    net::{SocketAddr, TcpStream},
    thread,
    time::{Duration, Instant},
};

use serde::{Deserialize, Serialize};

use super::{
    error::CaptureError,
    source::{Captured, DepthSource, Image, NextCapture},
};
use geometry::depth_frame::{DepthFrame, Intrinsics};

/// What is asked of a simulated robot's camera.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RobotRequest {
    /// The next frame.
    Frame,
    /// The robot's time.
    Time,
    /// The frame with this number has been inspected, or left out for a newer one.
    Inspected(u64),
}

impl RobotRequest {
    /// Parses a request; `None` if it is none.
    pub fn read(line: &str) -> Option<Self> {
        match line.trim_end() {
            "frame" => Some(Self::Frame),
            "time" => Some(Self::Time),
            line => {
                let number = line.strip_prefix("inspected ")?;
                number.parse().ok().map(Self::Inspected)
            }
        }
    }
}

impl fmt::Display for RobotRequest {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Frame => f.write_str("frame"),
            Self::Time => f.write_str("time"),
            Self::Inspected(number) => write!(f, "inspected {number}"),
        }
    }
}

/// What a simulated robot's camera answers.
#[derive(Clone, Debug, PartialEq)]
pub struct RobotReply {
    /// The robot's time, or when the frame of the request was due.
    pub at: Duration,
    /// A frame, with its number since the robot was started.
    pub frame: Option<(u64, DepthFrame)>,
}

#[derive(Debug, Serialize, Deserialize)]
struct Head {
    at_ns: u64,
    picture: Option<Picture>,
}

#[derive(Debug, Serialize, Deserialize)]
struct Picture {
    number: u64,
    metres_per_unit: f64,
    intrinsics: Intrinsics,
}

/// Longest line of a head.
const MAX_HEAD_BYTES: u64 = 4096;
/// Most pixels of a picture.
const MAX_PIXELS: usize = 1 << 24;

impl RobotReply {
    /// Writes it.
    pub fn write(&self, to: &mut impl Write) -> io::Result<()> {
        let picture = self.frame.as_ref().map(|(number, frame)| Picture {
            number: *number,
            metres_per_unit: frame.metres_per_unit,
            intrinsics: frame.intrinsics,
        });
        let head = Head {
            at_ns: u64::try_from(self.at.as_nanos()).unwrap_or(u64::MAX),
            picture,
        };
        let mut bytes = serde_json::to_vec(&head)?;
        bytes.push(b'\n');
        let depths = self.frame.iter().flat_map(|(_, frame)| &frame.depth);
        bytes.extend(depths.flat_map(|depth| depth.to_le_bytes()));
        to.write_all(&bytes)
    }

    /// Reads one.
    pub fn read(from: &mut impl BufRead) -> io::Result<Self> {
        let wrong = |what: &str| io::Error::new(io::ErrorKind::InvalidData, what);
        let mut line = String::new();
        from.by_ref().take(MAX_HEAD_BYTES).read_line(&mut line)?;
        if line.is_empty() {
            return Err(io::ErrorKind::UnexpectedEof.into());
        }
        let head: Head = serde_json::from_str(&line)?;
        let frame = match head.picture {
            None => None,
            Some(picture) => {
                let Intrinsics {
                    width, height, fx, ..
                } = picture.intrinsics;
                let num_pixels = width.checked_mul(height);
                let num_pixels = num_pixels.filter(|num| (1..=MAX_PIXELS).contains(num));
                let num_pixels = num_pixels.ok_or_else(|| wrong("a picture of no usual size"))?;
                let is_positive = |number: f64| number > 0.0 && number.is_finite();
                if ![picture.metres_per_unit, fx, picture.intrinsics.fy]
                    .into_iter()
                    .all(is_positive)
                {
                    return Err(wrong("a picture of no camera"));
                }
                let mut bytes = vec![0; 2 * num_pixels];
                from.read_exact(&mut bytes)?;
                let depths = bytes.chunks_exact(2);
                let frame = DepthFrame {
                    intrinsics: picture.intrinsics,
                    metres_per_unit: picture.metres_per_unit,
                    depth: depths
                        .map(|pair| u16::from_le_bytes([pair[0], pair[1]]))
                        .collect(),
                    is_simulated: true,
                };
                Some((picture.number, frame))
            }
        };
        Ok(Self {
            at: Duration::from_nanos(head.at_ns),
            frame,
        })
    }
}

/// How long the robot may take to accept the connection, and to answer.
const TIMEOUT: Duration = Duration::from_secs(5);
/// How often a frame is asked for.
const POLL_INTERVAL: Duration = Duration::from_millis(3);

/// A connection to the camera of a simulated robot.
pub struct RobotConnection {
    at: SocketAddr,
    stream: BufReader<TcpStream>,
}

impl RobotConnection {
    /// Connects.
    pub fn open(at: SocketAddr) -> Result<Self, CaptureError> {
        let connect = || -> io::Result<_> {
            let stream = TcpStream::connect_timeout(&at, TIMEOUT)?;
            stream.set_nodelay(true)?;
            stream.set_read_timeout(Some(TIMEOUT))?;
            stream.set_write_timeout(Some(TIMEOUT))?;
            Ok(BufReader::new(stream))
        };
        let stream = connect().map_err(|source| CaptureError::NoRobot { at, source })?;
        Ok(Self { at, stream })
    }

    /// Asks, and waits for the answer.
    pub fn ask(&mut self, request: RobotRequest) -> Result<RobotReply, CaptureError> {
        let line = format!("{request}\n");
        let sent = self.stream.get_mut().write_all(line.as_bytes());
        let reply = sent.and_then(|()| RobotReply::read(&mut self.stream));
        reply.map_err(|source| CaptureError::NoRobot {
            at: self.at,
            source,
        })
    }
}

/// The camera of a simulated robot.
pub(super) struct RobotCamera(RobotConnection);

impl RobotCamera {
    /// Connects to the robot.
    pub(super) fn open(at: SocketAddr) -> Result<Self, CaptureError> {
        RobotConnection::open(at).map(Self)
    }
}

impl DepthSource for RobotCamera {
    fn title(&self) -> String {
        title(self.0.at)
    }

    fn is_simulated(&self) -> bool {
        true
    }

    fn next(&mut self, wait: Duration) -> Result<NextCapture, CaptureError> {
        let until = Instant::now() + wait;
        loop {
            let reply = self.0.ask(RobotRequest::Frame)?;
            if let Some((number, frame)) = reply.frame {
                let name = format!("frame {number} from the simulated robot");
                let captured = Captured::now(number, name, Image::Depth(frame));
                return Ok(NextCapture::Captured(captured));
            }
            if Instant::now() >= until {
                return Ok(NextCapture::NotYet);
            }
            thread::sleep(POLL_INTERVAL);
        }
    }
}

/// Title of the camera of the robot at this address.
pub(super) fn title(at: SocketAddr) -> String {
    format!("Camera of the simulated robot at {at}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use geometry::fixtures::small_frame;

    #[test]
    fn what_is_written_is_read_again_and_anything_else_is_refused() {
        for request in [
            RobotRequest::Frame,
            RobotRequest::Time,
            RobotRequest::Inspected(12),
        ] {
            let line = format!("{request}\r\n");
            assert_eq!(RobotRequest::read(&line), Some(request));
        }
        for line in ["", "frames", "inspected", "inspected -1"] {
            assert_eq!(RobotRequest::read(line), None, "{line}");
        }
        let frame = DepthFrame {
            is_simulated: true,
            ..small_frame(2, [700, 0, 65_535, 1])
        };
        let at = Duration::from_millis(1234);
        let replies = [None, Some((7, frame))].map(|frame| RobotReply { at, frame });
        let mut bytes = Vec::new();
        for reply in &replies {
            reply.write(&mut bytes).expect("memory");
        }
        let mut from = &bytes[..];
        for reply in replies {
            assert_eq!(RobotReply::read(&mut from).expect("written"), reply);
        }
        let is_refused = |bytes: &[u8]| RobotReply::read(&mut &*bytes).is_err();
        let second = bytes
            .iter()
            .position(|byte| *byte == b'\n')
            .expect("a line")
            + 1;
        assert!(is_refused(&[]) && is_refused(&bytes[second..bytes.len() - 1]));
        let huge = "{\"at_ns\":1,\"picture\":{\"number\":1,\"metres_per_unit\":0.001,\"intrinsics\":\
            {\"width\":9999999,\"height\":9999999,\"fx\":1,\"fy\":1,\"cx\":0,\"cy\":0}}}\n";
        assert!(is_refused(huge.as_bytes()));
        assert!(is_refused(&[b'x'; 10_000]));
    }
}
