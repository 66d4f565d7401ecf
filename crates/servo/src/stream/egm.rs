//! ABB's Externally Guided Motion: messages of protobuf over UDP, which the controller begins.
//!
//! ABB, *Application manual Externally Guided Motion*, 3HAC073319: `EgmRobot` from the controller every 4 ms or a multiple,
//! `EgmSensor` back to it. With `EGMActPose` and `EGMRunPose`, tool `tool0` and work object `wobj0`, positions are those of the
//! flange in the base frame, in millimetres with a quaternion.

use prost::Message;

use super::{Report, Stream, StreamError, pose_of};
use geometry::rigid::RigidTransform;
use robot::{Convention, arm::Joints};

const NAME: &str = "EGM";
/// A packet with every field is below 1 KiB.
const MAX_PACKET_BYTES: usize = 4096;

// The messages, with the fields that are used. All are optional here, so that a missing number is not read as 0.

#[derive(Clone, PartialEq, Message)]
pub(crate) struct Robot {
    #[prost(message, optional, tag = "1")]
    pub(crate) header: Option<Header>,
    #[prost(message, optional, tag = "2")]
    pub(crate) feedback: Option<Position>,
    #[prost(message, optional, tag = "4")]
    pub(crate) motors: Option<State>,
    #[prost(message, optional, tag = "5")]
    pub(crate) motion: Option<State>,
    #[prost(message, optional, tag = "8")]
    pub(crate) program: Option<State>,
}

#[derive(Clone, PartialEq, Message)]
pub(crate) struct Sensor {
    #[prost(message, optional, tag = "1")]
    pub(crate) header: Option<Header>,
    #[prost(message, optional, tag = "2")]
    pub(crate) planned: Option<Position>,
}

#[derive(Clone, PartialEq, Message)]
pub(crate) struct Header {
    #[prost(uint32, optional, tag = "1")]
    pub(crate) number: Option<u32>,
    /// Milliseconds.
    #[prost(uint32, optional, tag = "2")]
    pub(crate) time: Option<u32>,
    #[prost(int32, optional, tag = "3")]
    pub(crate) kind: Option<i32>,
}

#[derive(Clone, PartialEq, Message)]
pub(crate) struct Position {
    #[prost(message, optional, tag = "1")]
    pub(crate) joints: Option<Angles>,
    #[prost(message, optional, tag = "2")]
    pub(crate) pose: Option<Pose>,
}

/// Degrees.
#[derive(Clone, PartialEq, Message)]
pub(crate) struct Angles {
    #[prost(double, repeated, packed = "false", tag = "1")]
    pub(crate) values: Vec<f64>,
}

#[derive(Clone, PartialEq, Message)]
pub(crate) struct Pose {
    #[prost(message, optional, tag = "1")]
    pub(crate) position: Option<Millimetres>,
    #[prost(message, optional, tag = "2")]
    pub(crate) rotation: Option<Quaternion>,
}

#[derive(Clone, Copy, PartialEq, Message)]
pub(crate) struct Millimetres {
    #[prost(double, optional, tag = "1")]
    pub(crate) x: Option<f64>,
    #[prost(double, optional, tag = "2")]
    pub(crate) y: Option<f64>,
    #[prost(double, optional, tag = "3")]
    pub(crate) z: Option<f64>,
}

/// The scalar first.
#[derive(Clone, Copy, PartialEq, Message)]
pub(crate) struct Quaternion {
    #[prost(double, optional, tag = "1")]
    pub(crate) u0: Option<f64>,
    #[prost(double, optional, tag = "2")]
    pub(crate) u1: Option<f64>,
    #[prost(double, optional, tag = "3")]
    pub(crate) u2: Option<f64>,
    #[prost(double, optional, tag = "4")]
    pub(crate) u3: Option<f64>,
}

#[derive(Clone, Copy, PartialEq, Message)]
pub(crate) struct State {
    #[prost(int32, optional, tag = "1")]
    pub(crate) state: Option<i32>,
}

/// `MSGTYPE_CORRECTION`.
const CORRECTION: i32 = 3;
/// `MOTORS_ON`, `MCI_RUNNING` and `RAPID_RUNNING`.
pub(crate) const RUNNING: [i32; 3] = [1, 3, 2];

impl Pose {
    pub(crate) fn new(robot_from_flange: &RigidTransform) -> Self {
        let written = Convention::Abb.write(robot_from_flange);
        let [x, y, z, u0, u1, u2, u3] =
            [0, 1, 2, 3, 4, 5, 6].map(|i| Some(written.values[i].value));
        Self {
            position: Some(Millimetres { x, y, z }),
            rotation: Some(Quaternion { u0, u1, u2, u3 }),
        }
    }

    pub(crate) fn transform(&self) -> Result<RigidTransform, StreamError> {
        let lacks = StreamError::Lacks {
            protocol: NAME,
            what: "the pose of the flange",
        };
        let (Some(p), Some(q)) = (self.position, self.rotation) else {
            return Err(lacks);
        };
        let numbers = [p.x, p.y, p.z, q.u0, q.u1, q.u2, q.u3].map(|number| number.ok_or(()));
        let numbers: Result<Vec<f64>, ()> = numbers.into_iter().collect();
        pose_of(NAME, Convention::Abb, &numbers.ok().ok_or(lacks)?)
    }
}

/// The side of the sensor.
#[derive(Clone, Debug, Default)]
pub struct Egm {
    /// Number and time of the last packet of the controller.
    last: Option<(u32, u32)>,
    num_sent: u32,
}

impl Stream for Egm {
    fn receive(&mut self, packet: &[u8]) -> Result<Option<Report>, StreamError> {
        let unreadable = |why: String| StreamError::Unreadable {
            protocol: NAME,
            why,
        };
        if packet.len() > MAX_PACKET_BYTES {
            return Err(unreadable(format!("it has {} bytes", packet.len())));
        }
        let robot = Robot::decode(packet).map_err(|error| unreadable(error.to_string()))?;
        let lacks = |what| StreamError::Lacks {
            protocol: NAME,
            what,
        };
        let header = robot.header.ok_or(lacks("its header"))?;
        let number = header.number.ok_or(lacks("its number"))?;
        let feedback = robot.feedback.ok_or(lacks("the pose of the flange"))?;
        let pose = feedback.pose.ok_or(lacks("the pose of the flange"))?;
        let robot_from_flange = pose.transform()?;
        let angles = feedback.joints.map(|joints| joints.values);
        let joints = angles.and_then(|angles| Joints::try_from(angles).ok());
        let joints = joints.filter(|joints| joints.iter().all(|angle| angle.is_finite()));
        if let Some((last, _)) = self.last
            && number <= last
        {
            return Err(StreamError::OutOfOrder {
                number: number.into(),
                last: last.into(),
            });
        }
        self.last = Some((number, header.time.unwrap_or(0)));
        let states = [robot.motors, robot.motion, robot.program].map(|state| state?.state);
        Ok(Some(Report {
            robot_from_flange,
            joints: joints.map(|joints| joints.map(f64::to_radians)),
            is_following: states == RUNNING.map(Some),
        }))
    }

    fn answer(&mut self, robot_from_flange: &RigidTransform, _has_arrived: bool) -> Vec<u8> {
        self.num_sent = self.num_sent.wrapping_add(1);
        let sensor = Sensor {
            header: Some(Header {
                number: Some(self.num_sent),
                time: self.last.map(|(_, time)| time),
                kind: Some(CORRECTION),
            }),
            planned: Some(Position {
                joints: None,
                pose: Some(Pose::new(robot_from_flange)),
            }),
        };
        sensor.encode_to_vec()
    }
}
