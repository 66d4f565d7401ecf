//! The trait of capture sources, and captures.

use std::{
    fmt,
    sync::Arc,
    time::{Duration, Instant},
};

use jiff::Timestamp;

use super::error::{CaptureError, CaptureWarning};
use geometry::{cloud::PointCloud, depth_frame::DepthFrame, rigid::RigidTransform};
use simulate::FrameTruth;

/// Delivers captures one at a time. It is opened, used and dropped on one thread, so it need not be `Send`.
pub trait DepthSource {
    /// Title to show to the operator.
    fn title(&self) -> String;

    /// True if its captures are simulated, live or when they were recorded.
    fn is_simulated(&self) -> bool;

    /// Returns the next capture, or [`NextCapture::NotYet`] after waiting for about `wait`.
    ///
    /// An error ends the source, unless [`CaptureError::recovery`] allows another call.
    fn next(&mut self, wait: Duration) -> Result<NextCapture, CaptureError>;
}

/// What a source delivers.
#[derive(Debug)]
#[expect(
    clippy::large_enum_variant,
    reason = "nearly all are captures, each moved once"
)]
pub enum NextCapture {
    /// A capture.
    Captured(Captured),
    /// Something that should have been a capture and cannot be read; the source goes on.
    Skipped(SkippedCapture),
    /// Nothing within the time.
    NotYet,
    /// The source has ended.
    End,
}

/// A capture with its origin.
#[derive(Clone, Debug)]
pub struct Captured {
    /// Number of the capture since the source was opened, from 1.
    pub number: u64,
    /// Name for lists and reports: "simulated frame 12", or a file's name.
    pub name: String,
    /// When the camera captured it: for a recording the original time, for a file the time of its last modification.
    pub taken_at: Timestamp,
    /// When the source delivered it or, for a file of a watched folder, first saw it with its present time of modification;
    /// ages and latencies count from here.
    pub arrived: Instant,
    /// The image, in camera space.
    pub image: Image,
    /// True if it is simulated, also in a recording of the simulated cell.
    pub is_simulated: bool,
    /// The truth about it, if known, without labels of its pixels.
    pub truth: Option<Arc<FrameTruth>>,
    /// Pose of the flange in the robot's base frame, for a camera on the arm, if it was recorded.
    pub robot_from_flange: Option<Box<RigidTransform>>,
    /// Warnings about the capture.
    pub warnings: Vec<CaptureWarning>,
}

impl Captured {
    /// A capture that a camera has just delivered.
    pub fn now(number: u64, name: String, image: Image) -> Self {
        Self {
            number,
            name,
            taken_at: geometry::clock::now(),
            arrived: Instant::now(),
            is_simulated: image.is_simulated(),
            image,
            truth: None,
            robot_from_flange: None,
            warnings: Vec::new(),
        }
    }
}

/// The image of a capture, in camera space.
#[derive(Clone, Debug, PartialEq)]
pub enum Image {
    /// A depth image.
    Depth(DepthFrame),
    /// A point cloud.
    Cloud(PointCloud),
}

impl Image {
    /// True if the data themselves are marked as simulated.
    pub fn is_simulated(&self) -> bool {
        match self {
            Self::Depth(frame) => frame.is_simulated,
            Self::Cloud(cloud) => cloud.is_simulated,
        }
    }
}

/// Something that should have been a capture and cannot be read.
#[derive(Clone, Debug)]
pub struct SkippedCapture {
    /// Name to show to the operator, such as a file's name.
    pub name: String,
    /// Why it cannot be read.
    pub error: Arc<CaptureError>,
}

impl fmt::Display for SkippedCapture {
    /// The error, behind the name unless it has that itself, as the path of a file.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { name, error } = self;
        let what = error.to_string();
        if !what.contains(name.as_str()) {
            write!(f, "{name}: ")?;
        }
        f.write_str(&what)
    }
}
