//! The camera of a simulated robot that runs as a program of its own: its frames and its time, over TCP.
//!
//! ```text
//! frame          ─►  a head, and a picture if there is a newer one than this connection got
//! time           ─►  a head; from now on the robot waits until each frame has been inspected
//! inspected 12   ─►  a head, whose time is when frame 12 was due
//! ```
//!
//! Requests and heads are lines; a head is JSON. A picture follows its head: its depths row by row, two bytes each, the low one
//! first. Whatever the head says, the picture counts as simulated.

use std::{
    fmt,
    io::{self, BufRead, BufReader, Read, Write},
    net::{SocketAddr, TcpStream},
    thread,
    time::{Duration, Instant},
};

use serde::{Deserialize, Serialize};

use super::{
    error::CaptureError,
    source::{Captured, DepthSource, Image, NextCapture},
};
use files::DepthCamera;
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
    camera: DepthCamera,
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
            camera: DepthCamera::from_frame(frame),
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
        let mut line = String::new();
        from.by_ref().take(MAX_HEAD_BYTES).read_line(&mut line)?;
        if line.is_empty() {
            return Err(io::ErrorKind::UnexpectedEof.into());
        }
        let head: Head = serde_json::from_str(&line)?;
        let frame = head.picture.map(|picture| {
            let frame = depths_after(picture.camera, from)?;
            Ok::<_, io::Error>((picture.number, frame))
        });
        let frame = frame.transpose()?;
        Ok(Self {
            at: Duration::from_nanos(head.at_ns),
            frame,
        })
    }
}

/// Reads the depths of a picture of this camera, once they are known to have a usual number.
fn depths_after(camera: DepthCamera, from: &mut impl Read) -> io::Result<DepthFrame> {
    let wrong = |what: String| io::Error::new(io::ErrorKind::InvalidData, what);
    let Intrinsics { width, height, .. } = camera.intrinsics;
    let num_pixels = width.checked_mul(height);
    let num_pixels = num_pixels.filter(|num| (1..=MAX_PIXELS).contains(num));
    let num_pixels =
        num_pixels.ok_or_else(|| wrong(format!("a picture of {width} × {height} pixels")))?;
    let camera = camera.checked().map_err(wrong)?;
    let mut bytes = vec![0; 2 * num_pixels];
    from.read_exact(&mut bytes)?;
    let depths = bytes.chunks_exact(2);
    Ok(DepthFrame {
        intrinsics: camera.intrinsics,
        metres_per_unit: camera.metres_per_unit,
        depth: depths
            .map(|pair| u16::from_le_bytes([pair[0], pair[1]]))
            .collect(),
        is_simulated: true,
    })
}

/// How long the robot may take to accept the connection, and for an answer, to its last byte.
const TIMEOUT: Duration = Duration::from_secs(5);
/// How often a frame is asked for.
const POLL_INTERVAL: Duration = Duration::from_millis(3);

/// A stream that is read until a given moment.
struct TimedStream {
    stream: TcpStream,
    until: Instant,
}

impl Read for TimedStream {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let left = self.until.saturating_duration_since(Instant::now());
        if left.is_zero() {
            return Err(io::ErrorKind::TimedOut.into());
        }
        self.stream.set_read_timeout(Some(left))?;
        self.stream.read(buffer)
    }
}

/// A connection to the camera of a simulated robot. After an error it is of no use: the answer may still come.
pub struct RobotConnection {
    at: SocketAddr,
    timed: BufReader<TimedStream>,
}

impl RobotConnection {
    /// Connects.
    pub fn open(at: SocketAddr) -> Result<Self, CaptureError> {
        let connect = || -> io::Result<_> {
            let stream = TcpStream::connect_timeout(&at, TIMEOUT)?;
            stream.set_nodelay(true)?;
            stream.set_write_timeout(Some(TIMEOUT))?;
            let until = Instant::now();
            Ok(BufReader::new(TimedStream { stream, until }))
        };
        let timed = connect().map_err(|source| CaptureError::NoRobot { at, source })?;
        Ok(Self { at, timed })
    }

    /// Asks, and waits for the answer.
    pub fn ask(&mut self, request: RobotRequest) -> Result<RobotReply, CaptureError> {
        let line = format!("{request}\n");
        let TimedStream { stream, until } = self.timed.get_mut();
        *until = Instant::now() + TIMEOUT;
        let sent = stream.write_all(line.as_bytes());
        let reply = sent.and_then(|()| RobotReply::read(&mut self.timed));
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
        assert!(is_refused(&[b'x'; 10_000]));
        let pixel = |width: usize, height: usize, fx: f64| {
            let head = format!(
                r#"{{"at_ns":1,"picture":{{"number":1,"camera":{{"width":{width},"height":{height},"fx":{fx},"fy":1,"cx":0,"cy":0,"metres_per_unit":0.001}}}}}}"#
            );
            [head.as_bytes(), b"\n", &[1, 2]].concat()
        };
        // It does not say that it is simulated.
        let read = RobotReply::read(&mut &pixel(1, 1, 1.0)[..]).expect("a pixel");
        let (_, frame) = read.frame.expect("a picture");
        assert!(frame.is_simulated && frame.depth == [0x0201], "{frame:?}");
        for bytes in [
            pixel(2, 1, 1.0),
            pixel(0, 1, 1.0),
            pixel(usize::MAX, 1, 1.0),
            pixel(usize::MAX, 2, 1.0),
            pixel(1, 1, 0.0),
        ] {
            assert!(is_refused(&bytes), "{bytes:?}");
        }
    }
}
