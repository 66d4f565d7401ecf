//! Universal Robots' Real-Time Data Exchange: the controller listens on TCP port 30004; numbers are big-endian.
//!
//! Universal Robots, *Real-Time Data Exchange (RTDE) guide*, protocol version 2: each package has its length, a letter and a
//! payload. Ours negotiates the version, names the values that it reads and the registers that it writes, and starts. A
//! program on the controller ([`Rtde::PROGRAM`]) moves the flange to the pose in the registers with `servoj`, and stops when they
//! are no longer written.

use super::{Report, Stream, StreamError, pose_of};
use geometry::rigid::RigidTransform;
use robot::Convention;

const NAME: &str = "RTDE";
/// A package's length, with its head.
const MAX_PACKAGE_BYTES: usize = 4096;
/// Bytes of a package before its payload: its length and its letter.
pub(crate) const HEADER_BYTES: usize = 3;

/// What is read: after each name, the type that the controller gives it, and its bytes.
pub(crate) const OUTPUTS: [(&str, &str, usize); 5] = [
    ("actual_TCP_pose", "VECTOR6D", 48),
    ("actual_q", "VECTOR6D", 48),
    ("runtime_state", "UINT32", 4),
    ("safety_status", "INT32", 4),
    ("output_int_register_24", "INT32", 4),
];
/// What is written: a number that changes with every pose, whether the target is reached, and the pose.
pub(crate) const INPUTS: [(&str, &str, usize); 8] = [
    ("input_int_register_24", "INT32", 4),
    ("input_int_register_25", "INT32", 4),
    ("input_double_register_24", "DOUBLE", 8),
    ("input_double_register_25", "DOUBLE", 8),
    ("input_double_register_26", "DOUBLE", 8),
    ("input_double_register_27", "DOUBLE", 8),
    ("input_double_register_28", "DOUBLE", 8),
    ("input_double_register_29", "DOUBLE", 8),
];
/// Reports per second.
const REPORT_RATE_HZ: f64 = 125.0;
/// `PLAYING`.
pub(crate) const PLAYING: u32 = 2;
/// `NORMAL` and `REDUCED`.
const SAFE: [i32; 2] = [1, 2];

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Stage {
    Version,
    Outputs,
    Inputs,
    Start,
    Running,
}

/// The side of the computer.
#[derive(Clone, Debug)]
pub struct Rtde {
    stage: Stage,
    /// Bytes of a package that is not yet whole.
    rest: Vec<u8>,
    /// What the controller has to be sent next before reports come.
    request: Vec<u8>,
    outputs: u8,
    inputs: u8,
    count: i32,
}

impl Default for Rtde {
    fn default() -> Self {
        Self {
            stage: Stage::Version,
            rest: Vec::new(),
            request: package(b'V', &2_u16.to_be_bytes()),
            outputs: 0,
            inputs: 0,
            count: 0,
        }
    }
}

impl Rtde {
    /// The program for the controller: send it to TCP port 30002, or load it on the teach pendant.
    pub const PROGRAM: &str = include_str!("partsight_servo.script");

    fn take(&mut self, kind: u8, payload: &[u8]) -> Result<Option<Report>, StreamError> {
        let refused = |what: &str| StreamError::Refused { what: what.into() };
        match (self.stage, kind) {
            (Stage::Version, b'V') => {
                if payload != [1] {
                    return Err(refused("version 2 of RTDE"));
                }
                let names = OUTPUTS.map(|(name, ..)| name).join(",");
                let wanted = [&REPORT_RATE_HZ.to_be_bytes(), names.as_bytes()].concat();
                self.next(Stage::Outputs, b'O', &wanted);
            }
            (Stage::Outputs, b'O') => {
                self.outputs = recipe(payload, &OUTPUTS)?;
                let names = INPUTS.map(|(name, ..)| name).join(",");
                self.next(Stage::Inputs, b'I', names.as_bytes());
            }
            (Stage::Inputs, b'I') => {
                self.inputs = recipe(payload, &INPUTS)?;
                self.next(Stage::Start, b'S', &[]);
            }
            (Stage::Start, b'S') => {
                if payload != [1] {
                    return Err(refused("to start"));
                }
                self.stage = Stage::Running;
            }
            (Stage::Running, b'U') => return self.report(payload).map(Some),
            // Texts for people, which may come at any time.
            (_, b'M') => {}
            _ => {
                return Err(StreamError::Unreadable {
                    protocol: NAME,
                    why: format!("package {:?} is not expected", char::from(kind)),
                });
            }
        }
        Ok(None)
    }

    fn next(&mut self, stage: Stage, kind: u8, payload: &[u8]) {
        self.stage = stage;
        self.request = package(kind, payload);
    }

    fn report(&self, payload: &[u8]) -> Result<Report, StreamError> {
        let length: usize = OUTPUTS.iter().map(|(.., bytes)| bytes).sum();
        let unreadable = |why: String| StreamError::Unreadable {
            protocol: NAME,
            why,
        };
        let Some((id, values)) = payload
            .split_first()
            .filter(|(_, rest)| rest.len() == length)
        else {
            return Err(unreadable(format!("a report has {} bytes", payload.len())));
        };
        if *id != self.outputs {
            return Err(unreadable(format!("it has the values of recipe {id}")));
        }
        let (pose, rest) = values.split_at(48);
        let (joints, rest) = rest.split_at(48);
        let words: Vec<[u8; 4]> = rest
            .chunks_exact(4)
            .map(|word| [word[0], word[1], word[2], word[3]])
            .collect();
        let joints = six(joints);
        let is_following = u32::from_be_bytes(words[0]) == PLAYING
            && SAFE.contains(&i32::from_be_bytes(words[1]))
            && i32::from_be_bytes(words[2]) == 1;
        Ok(Report {
            robot_from_flange: pose_of(NAME, Convention::UniversalRobots, &six(pose))?,
            joints: joints
                .iter()
                .all(|angle| angle.is_finite())
                .then_some(joints),
            is_following,
        })
    }
}

impl Stream for Rtde {
    fn requests(&mut self) -> Vec<u8> {
        std::mem::take(&mut self.request)
    }

    fn receive(&mut self, bytes: &[u8]) -> Result<Option<Report>, StreamError> {
        self.rest.extend_from_slice(bytes);
        let mut newest = None;
        loop {
            let Some(head) = self.rest.get(..HEADER_BYTES) else {
                return Ok(newest);
            };
            let length = usize::from(u16::from_be_bytes([head[0], head[1]]));
            if !(HEADER_BYTES..=MAX_PACKAGE_BYTES).contains(&length) {
                return Err(StreamError::Unreadable {
                    protocol: NAME,
                    why: format!("a package of {length} bytes"),
                });
            }
            if self.rest.len() < length {
                return Ok(newest);
            }
            let package: Vec<u8> = self.rest.drain(..length).collect();
            newest = self.take(package[2], &package[HEADER_BYTES..])?.or(newest);
        }
    }

    fn answer(&mut self, robot_from_flange: &RigidTransform, has_arrived: bool) -> Vec<u8> {
        self.count = self.count.checked_add(1).unwrap_or(1);
        let written = Convention::UniversalRobots.write(robot_from_flange);
        let mut payload = vec![self.inputs];
        let words = [self.count, i32::from(has_arrived)];
        payload.extend(words.iter().flat_map(|word| word.to_be_bytes()));
        payload.extend(
            written
                .values
                .iter()
                .flat_map(|value| value.value.to_be_bytes()),
        );
        package(b'U', &payload)
    }
}

/// A package with its head.
pub(crate) fn package(kind: u8, payload: &[u8]) -> Vec<u8> {
    let length = u16::try_from(HEADER_BYTES + payload.len()).expect("our packages are short");
    [&length.to_be_bytes(), &[kind][..], payload].concat()
}

/// Six doubles.
pub(crate) fn six(bytes: &[u8]) -> [f64; 6] {
    let mut numbers = [0.0; 6];
    for (number, bytes) in numbers.iter_mut().zip(bytes.chunks_exact(8)) {
        *number = f64::from_be_bytes(bytes.try_into().expect("eight bytes"));
    }
    numbers
}

/// The number of a recipe, if the controller has all its values, and none is in use.
fn recipe(payload: &[u8], wanted: &[(&str, &str, usize)]) -> Result<u8, StreamError> {
    let (id, types) = payload.split_first().ok_or(StreamError::Lacks {
        protocol: NAME,
        what: "the number of a recipe",
    })?;
    let types = String::from_utf8_lossy(types);
    let mut types = types.split(',');
    for (name, kind, _) in wanted {
        let found = types.next().unwrap_or("nothing");
        if found != *kind {
            return Err(StreamError::Refused {
                what: format!("{name} ({found})"),
            });
        }
    }
    Ok(*id)
}
