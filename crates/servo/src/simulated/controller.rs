//! The controller's side of the protocols, at a simulated arm.

use std::time::Duration;

use prost::Message as _;
use serde::{Deserialize, Serialize};

use super::SimulatedArm;
use crate::stream::{
    Egm, Rsi, Rtde, Stream, StreamError,
    egm::{Angles, Header, Pose, Position, RUNNING, Robot, Sensor, State},
    rsi::Packet,
    rtde::{HEADER_BYTES, INPUTS, OUTPUTS, PLAYING, package, six},
};
use geometry::rigid::RigidTransform;
use robot::{
    Convention,
    arm::{Joints, PlacedArm},
};

/// A protocol of a controller.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum StreamProtocol {
    /// ABB's EGM.
    Egm,
    /// KUKA's RSI.
    Rsi,
    /// Universal Robots' RTDE.
    Rtde,
}

impl StreamProtocol {
    /// Every protocol.
    pub const ALL: [Self; 3] = [Self::Egm, Self::Rsi, Self::Rtde];

    /// Its name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Egm => "egm",
            Self::Rsi => "rsi",
            Self::Rtde => "ur",
        }
    }

    /// The protocol of this name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL
            .into_iter()
            .find(|protocol| protocol.name() == name)
    }

    /// The computer's side of it, for this arm.
    pub fn stream(self, arm: &PlacedArm) -> Box<dyn Stream + Send> {
        match self {
            Self::Egm => Box::<Egm>::default(),
            Self::Rsi => Box::new(Rsi::new(arm.clone())),
            Self::Rtde => Box::<Rtde>::default(),
        }
    }
}

/// A controller with its arm, which speaks a protocol.
pub struct SimulatedController {
    /// The arm.
    pub arm: SimulatedArm,
    /// Whether its program runs.
    pub is_running: bool,
    placed: PlacedArm,
    start: Joints,
    protocol: StreamProtocol,
    /// Number of the last report: in RSI its time stamp.
    number: u32,
    /// Bytes of a package of RTDE that is not yet whole.
    rest: Vec<u8>,
    /// True once the computer has said that the target is reached.
    has_arrived: bool,
    /// The last pose that EGM sent, and since when.
    same: Option<(RigidTransform, Duration)>,
}

/// In EGM the robot has arrived when it was sent the same pose for so long: longer than the servo waits for frames on the way.
const SAME_TIME: Duration = Duration::from_millis(2400);
/// The first number of a report.
const FIRST_NUMBER: u32 = 1000;
/// Numbers of the recipes of RTDE.
const RECIPES: [u8; 2] = [1, 2];

impl SimulatedController {
    /// A controller whose program runs.
    pub fn new(arm: SimulatedArm, placed: PlacedArm, protocol: StreamProtocol) -> Self {
        let start = arm
            .state()
            .joints
            .expect("a simulated arm tells its joints");
        Self {
            arm,
            is_running: true,
            placed,
            start,
            protocol,
            number: FIRST_NUMBER,
            rest: Vec::new(),
            has_arrived: false,
            same: None,
        }
    }

    /// True once its program has ended because the target is reached.
    pub fn has_arrived(&self) -> bool {
        self.has_arrived
    }

    /// Its next report.
    pub fn report(&mut self) -> Vec<u8> {
        let state = self.arm.state();
        let joints = state.joints.expect("a simulated arm tells its joints");
        let millis = u32::try_from(state.at.as_millis()).unwrap_or(u32::MAX);
        let degrees = joints.map(f64::to_degrees);
        match self.protocol {
            StreamProtocol::Egm => {
                self.number += 1;
                let states = if self.is_running { RUNNING } else { [1, 2, 1] };
                let [motors, motion, program] =
                    states.map(|state| Some(State { state: Some(state) }));
                let robot = Robot {
                    header: Some(Header {
                        number: Some(self.number),
                        time: Some(millis),
                        kind: Some(2),
                    }),
                    feedback: Some(Position {
                        joints: Some(Angles {
                            values: degrees.to_vec(),
                        }),
                        pose: Some(Pose::new(&state.robot_from_flange)),
                    }),
                    motors,
                    motion,
                    program,
                };
                robot.encode_to_vec()
            }
            StreamProtocol::Rsi => {
                self.number += 12;
                let angles = degrees.iter().zip(1..);
                let angles = angles.map(|(angle, axis)| format!(" A{axis}=\"{angle:.6}\""));
                let (angles, number) = (angles.collect::<String>(), self.number);
                let elements = format!("<AIPos{angles}/><Delay D=\"0\"/><IPOC>{number}</IPOC>");
                format!("<Rob Type=\"KUKA\">{elements}</Rob>").into_bytes()
            }
            StreamProtocol::Rtde => {
                let written = Convention::UniversalRobots.write(&state.robot_from_flange);
                let pose = written.values.iter().map(|value| value.value);
                let mut payload = vec![RECIPES[0]];
                payload.extend(pose.chain(joints).flat_map(f64::to_be_bytes));
                let runs = i32::from(self.is_running);
                payload.extend(PLAYING.to_be_bytes());
                payload.extend([1, runs].iter().flat_map(|word: &i32| word.to_be_bytes()));
                package(b'U', &payload)
            }
        }
    }

    /// Takes in what the computer sent, and returns what a controller answers to it.
    pub fn take(&mut self, bytes: &[u8]) -> Result<Vec<u8>, StreamError> {
        match self.protocol {
            StreamProtocol::Egm => {
                let unreadable = |error: prost::DecodeError| StreamError::Unreadable {
                    protocol: "EGM",
                    why: error.to_string(),
                };
                let sensor = Sensor::decode(bytes).map_err(unreadable)?;
                if let Some(pose) = sensor.planned.and_then(|planned| planned.pose) {
                    let pose = pose.transform()?;
                    let now = self.arm.state().at;
                    let same = self.same.filter(|(last, _)| *last == pose);
                    let (_, since) = *self.same.insert(same.unwrap_or((pose, now)));
                    self.has_arrived |= self.is_running && now >= since + SAME_TIME;
                    self.arm.send(pose);
                }
            }
            StreamProtocol::Rsi => {
                let packet = Packet::read(bytes, b"AKorr")?;
                if packet.stamp != Some(self.number.into()) {
                    return Err(StreamError::OutOfOrder {
                        number: packet.stamp.unwrap_or(0),
                        last: self.number.into(),
                    });
                }
                self.has_arrived |= packet.has_arrived;
                let correction = packet.joints.unwrap_or([0.0; 6]);
                let joints = [0, 1, 2, 3, 4, 5].map(|i| self.start[i] + correction[i]);
                if let Some(nozzle) = self.placed.nozzle_pose(&joints) {
                    self.arm
                        .send(nozzle * self.placed.flange_from_nozzle.inverse());
                }
            }
            StreamProtocol::Rtde => {
                self.rest.extend_from_slice(bytes);
                return self.packages();
            }
        }
        Ok(Vec::new())
    }

    /// Takes the whole packages of RTDE.
    fn packages(&mut self) -> Result<Vec<u8>, StreamError> {
        let types = |of: &[(&str, &str, usize)], recipe: u8| {
            let kinds: Vec<&str> = of.iter().map(|(_, kind, _)| *kind).collect();
            [&[recipe], kinds.join(",").as_bytes()].concat()
        };
        let unreadable = |why: String| StreamError::Unreadable {
            protocol: "RTDE",
            why,
        };
        // The recipe's number, two integers, and the pose.
        let input_bytes = 1 + INPUTS.iter().map(|(.., bytes)| bytes).sum::<usize>();
        let mut answers = Vec::new();
        while let Some(head) = self.rest.get(..HEADER_BYTES) {
            let length = usize::from(u16::from_be_bytes([head[0], head[1]]));
            if length < HEADER_BYTES {
                return Err(unreadable(format!("a package of {length} bytes")));
            }
            if self.rest.len() < length {
                break;
            }
            let taken: Vec<u8> = self.rest.drain(..length).collect();
            let (kind, payload) = (taken[2], &taken[HEADER_BYTES..]);
            match kind {
                b'V' | b'S' => answers.extend(package(kind, &[1])),
                b'O' => answers.extend(package(kind, &types(&OUTPUTS, RECIPES[0]))),
                b'I' => answers.extend(package(kind, &types(&INPUTS, RECIPES[1]))),
                b'U' => {
                    if payload.len() != input_bytes {
                        return Err(unreadable(format!("inputs of {} bytes", payload.len())));
                    }
                    self.has_arrived |= payload[8] == 1;
                    let pose = Convention::UniversalRobots.read(&six(&payload[9..]));
                    self.arm
                        .send(pose.map_err(|error| unreadable(error.to_string()))?);
                }
                _ => {}
            }
        }
        Ok(answers)
    }
}
