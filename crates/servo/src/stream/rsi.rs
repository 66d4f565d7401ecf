//! KUKA's `RobotSensorInterface`: XML over UDP, which the controller begins every 4 or 12 ms; it counts each packet that is not
//! answered within its cycle, and breaks off after a few.
//!
//! ```text
//! <Rob Type="KUKA"><AIPos A1="0.0" A2="-90.0" …/>…<IPOC>4208163634</IPOC></Rob>
//! <Sen Type="Partsight"><AKorr A1="0.0125" …/><Arrived>0</Arrived><IPOC>4208163634</IPOC></Sen>
//! ```
//!
//! KUKA, *`RobotSensorInterface` 4.1*. Corrections are those of the object AXISCORR, absolute: degrees of each joint from where
//! it stood when RSI began. Corrections of a pose (POSCORR) are not used: which rotation their A, B and C mean depends on the
//! reference system, and differs from a pose's. So the arm's model is needed.

use quick_xml::{Reader, events::Event};

use super::{Report, Stream, StreamError};
use geometry::rigid::RigidTransform;
use robot::arm::{Joints, PlacedArm};

const NAME: &str = "RSI";
/// Packets with every element that RSI knows are below 4 KiB.
const MAX_PACKET_BYTES: usize = 8192;

/// The side of the sensor.
#[derive(Clone, Debug)]
pub struct Rsi {
    arm: PlacedArm,
    /// The joints when RSI began.
    start: Option<Joints>,
    /// The joints last commanded.
    commanded: Option<Joints>,
    /// The time stamp of the last packet.
    stamp: Option<u64>,
}

impl Rsi {
    /// Reads and writes the joints of this arm.
    pub fn new(arm: PlacedArm) -> Self {
        Self {
            arm,
            start: None,
            commanded: None,
            stamp: None,
        }
    }
}

impl Stream for Rsi {
    fn receive(&mut self, packet: &[u8]) -> Result<Option<Report>, StreamError> {
        let packet = Packet::read(packet, b"AIPos")?;
        let lacks = |what| StreamError::Lacks {
            protocol: NAME,
            what,
        };
        let stamp = packet.stamp.ok_or(lacks("IPOC"))?;
        let joints = packet.joints.ok_or(lacks("AIPos with A1 to A6"))?;
        if let Some(last) = self.stamp.filter(|last| stamp <= *last) {
            return Err(StreamError::OutOfOrder {
                number: stamp,
                last,
            });
        }
        let robot_from_nozzle = self.arm.nozzle_pose(&joints);
        let robot_from_nozzle = robot_from_nozzle.ok_or(lacks("finite joints"))?;
        self.stamp = Some(stamp);
        self.start.get_or_insert(joints);
        self.commanded.get_or_insert(joints);
        Ok(Some(Report {
            robot_from_flange: robot_from_nozzle * self.arm.flange_from_nozzle.inverse(),
            joints: Some(joints),
            is_following: true,
        }))
    }

    fn answer(&mut self, robot_from_flange: &RigidTransform, has_arrived: bool) -> Vec<u8> {
        let (Some(start), Some(commanded), Some(stamp)) = (self.start, self.commanded, self.stamp)
        else {
            return Vec::new();
        };
        let robot_from_nozzle = robot_from_flange * self.arm.flange_from_nozzle;
        // Where the arm does not reach, it stays; that it does not follow then stops the servo.
        let joints = self.arm.joints_near(&robot_from_nozzle, &commanded);
        let joints = joints.unwrap_or(commanded);
        self.commanded = Some(joints);
        let corrections = joints.iter().zip(start).zip(1..);
        let corrections = corrections
            .map(|((to, from), axis)| format!(" A{axis}=\"{:.6}\"", (to - from).to_degrees()));
        let corrections: String = corrections.collect();
        let arrived = format!("<Arrived>{}</Arrived>", u8::from(has_arrived));
        format!("<Sen Type=\"Partsight\"><AKorr{corrections}/>{arrived}<IPOC>{stamp}</IPOC></Sen>")
            .into_bytes()
    }
}

/// What is read from a packet of either side.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Packet {
    pub(crate) stamp: Option<u64>,
    /// Radians.
    pub(crate) joints: Option<Joints>,
    /// What the sensor says of the target.
    pub(crate) has_arrived: bool,
}

impl Packet {
    /// Reads the time stamp, and the joints of this element.
    pub(crate) fn read(packet: &[u8], element: &[u8]) -> Result<Self, StreamError> {
        let unreadable = |why: String| StreamError::Unreadable {
            protocol: NAME,
            why,
        };
        if packet.len() > MAX_PACKET_BYTES {
            return Err(unreadable(format!("it has {} bytes", packet.len())));
        }
        let mut reader = Reader::from_reader(packet);
        let mut read = Self::default();
        let mut inside = Vec::new();
        loop {
            let event = reader.read_event();
            match event.map_err(|error| unreadable(error.to_string()))? {
                Event::Start(tag) | Event::Empty(tag) if tag.name().as_ref() == element => {
                    let mut angles = [None; 6];
                    for attribute in tag.attributes() {
                        let attribute = attribute.map_err(|error| unreadable(error.to_string()))?;
                        let index = match attribute.key.as_ref() {
                            [b'A', digit @ b'1'..=b'6'] => usize::from(digit - b'1'),
                            _ => continue,
                        };
                        angles[index] = number_in::<f64>(&attribute.value);
                    }
                    let all: Option<Vec<f64>> = angles.into_iter().collect();
                    let all = all.and_then(|all| Joints::try_from(all).ok());
                    read.joints = all.map(|all| all.map(f64::to_radians));
                }
                Event::Start(tag) => inside = tag.name().as_ref().to_vec(),
                Event::Text(text) if inside == b"IPOC" => read.stamp = number_in(&text),
                Event::Text(text) if inside == b"Arrived" => {
                    read.has_arrived = number_in(&text) == Some(1);
                }
                Event::End(_) => inside.clear(),
                Event::Eof => return Ok(read),
                _ => {}
            }
        }
    }
}

fn number_in<T: std::str::FromStr>(text: &[u8]) -> Option<T> {
    std::str::from_utf8(text).ok()?.trim().parse().ok()
}
