//! Robots that report their pose every few milliseconds and take the next one: the makers' protocols, as pure functions of
//! bytes.
//!
//! | protocol | transport | reported | commanded |
//! | --- | --- | --- | --- |
//! | [`Egm`] | UDP, protobuf; the controller begins | pose of the flange, joints | pose of the flange |
//! | [`Rsi`] | UDP, XML; the controller begins and needs an answer in its cycle | joints | joints, as corrections from the start |
//! | [`Rtde`] | TCP, big-endian; the controller listens | pose of the flange, joints | pose of the flange |
//!
//! A [`Drive`] joins a protocol with a [`Servo`](crate::Servo). None of this has been tested on a controller.

mod drive;
pub(crate) mod egm;
pub(crate) mod rsi;
pub(crate) mod rtde;

pub use self::{
    drive::{Drive, Driven},
    egm::Egm,
    rsi::Rsi,
    rtde::Rtde,
};

use geometry::{error::Advice, rigid::RigidTransform};
use robot::arm::Joints;

/// What a controller reports.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Report {
    /// Pose of the flange in the base frame.
    pub robot_from_flange: RigidTransform,
    /// Angles of the joints, if it tells them.
    pub joints: Option<Joints>,
    /// True while its program runs and follows what it is sent.
    pub is_following: bool,
}

/// A protocol, with what it remembers of a connection.
pub trait Stream {
    /// What to send whether or not there is a report: requests that open the connection. Nothing where the controller begins.
    fn requests(&mut self) -> Vec<u8> {
        Vec::new()
    }

    /// Takes in what came: a packet, or any piece of a stream of bytes. Returns the newest report in it.
    fn receive(&mut self, bytes: &[u8]) -> Result<Option<Report>, StreamError>;

    /// What to send: the answer to the last report, which sends the flange to a pose, and says whether the target is reached.
    /// (In EGM the controller finds out by itself, from poses that stay the same.)
    fn answer(&mut self, robot_from_flange: &RigidTransform, has_arrived: bool) -> Vec<u8>;
}

/// Why bytes are not a report.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error, Advice)]
pub enum StreamError {
    /// They are nothing of this protocol.
    #[error("not a packet of {protocol}: {why}")]
    #[advice = "Check which protocol the controller's program uses, and that nothing else sends to this port"]
    Unreadable {
        /// The protocol.
        protocol: &'static str,
        /// What is wrong.
        why: String,
    },
    /// The packet lacks a value that is needed.
    #[error("a packet of {protocol} lacks {what}")]
    #[advice = "Set up {protocol} on the controller as the guide shows (docs/guide/servo.md)"]
    Lacks {
        /// The protocol.
        protocol: &'static str,
        /// The value.
        what: &'static str,
    },
    /// It came before, or late.
    #[error("packet {number} came after packet {last}")]
    #[advice = "Connect the controller directly, or over a switch of its own"]
    OutOfOrder {
        /// Its number.
        number: u64,
        /// The greatest number before it.
        last: u64,
    },
    /// The controller does not do what it is asked.
    #[error("the controller refuses {what}")]
    #[advice = "Update the controller's software, and end other programs that use the same registers"]
    Refused {
        /// What.
        what: String,
    },
}

/// The pose as seven or six numbers of a maker's convention; an error if they are none.
fn pose_of(
    protocol: &'static str,
    convention: robot::Convention,
    numbers: &[f64],
) -> Result<RigidTransform, StreamError> {
    convention
        .read(numbers)
        .map_err(|error| StreamError::Unreadable {
            protocol,
            why: error.to_string(),
        })
}

#[cfg(test)]
pub(crate) mod tests;
