//! A source of captures, and what it gives.

use std::{
    sync::Arc,
    time::{Duration, Instant},
};

use jiff::Timestamp;

use super::error::{CaptureError, CaptureWarning};
use crate::{
    geometry::{cloud::PointCloud, depth_frame::DepthFrame, rigid::RigidTransform},
    simulate::FrameTruth,
};

/// Gives captures one at a time. Opened, used and dropped on one thread, so it need not be `Send`.
pub trait DepthSource {
    /// What a person calls it.
    fn title(&self) -> String;

    /// True if what it gives was simulated, live or when it was recorded.
    fn is_simulated(&self) -> bool;

    /// The next capture, or [`NextCapture::NotYet`] after waiting at most about `wait`.
    ///
    /// An error ends this source unless its [`CaptureError::recovery`] says that it may be asked again.
    fn next(&mut self, wait: Duration) -> Result<NextCapture, CaptureError>;
}

/// What a source has to give.
#[derive(Debug)]
#[expect(
    clippy::large_enum_variant,
    reason = "nearly all are captures, each moved once"
)]
pub enum NextCapture {
    /// A capture.
    Captured(Captured),
    /// Something that was meant to be a capture and cannot be read; the source goes on.
    Skipped(SkippedCapture),
    /// Nothing within the time.
    NotYet,
    /// No more, ever.
    End,
}

/// One capture.
#[derive(Clone, Debug)]
pub struct Captured {
    /// Counts the captures of this source since it was opened, from 1.
    pub number: u64,
    /// What a person calls it, for lists and reports: "simulated frame 12", a file's name.
    pub name: String,
    /// When the camera saw it: of a recording the time then, of a file the time it was last written.
    pub taken_at: Timestamp,
    /// When the source handed it over; age and latency count from here.
    pub arrived: Instant,
    /// What was seen.
    pub image: Image,
    /// True if no camera was read, also where a recording of the simulated cell is replayed.
    pub is_simulated: bool,
    /// What is known about it; without the labels of its pixels.
    pub truth: Option<Arc<FrameTruth>>,
    /// Where the arm that carries the camera stood: takes the flange's frame to the robot's base, if that was recorded.
    pub robot_from_flange: Option<Box<RigidTransform>>,
    /// What is odd about it.
    pub warnings: Vec<CaptureWarning>,
}

/// What was seen, in camera space.
#[derive(Clone, Debug, PartialEq)]
pub enum Image {
    /// A depth image.
    Depth(DepthFrame),
    /// Points.
    Cloud(PointCloud),
}

impl Image {
    /// True if it says itself that no camera read it.
    pub fn is_simulated(&self) -> bool {
        match self {
            Self::Depth(frame) => frame.is_simulated,
            Self::Cloud(cloud) => cloud.is_simulated,
        }
    }
}

/// Something that was meant to be a capture and cannot be read.
#[derive(Clone, Debug)]
pub struct SkippedCapture {
    /// What a person calls it: a file's name.
    pub name: String,
    /// Why not.
    pub error: Arc<CaptureError>,
}
