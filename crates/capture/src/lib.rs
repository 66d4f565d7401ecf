//! Sources of frames: the simulated cell, a simulated robot, recordings, a watched folder, a Kinect, and cameras through
//! GenICam, OpenNI and RealSense.
//!
//! ```text
//! SourceSpec ─► open ─► DepthSource ─► Feed ─► Captured, to be inspected, recorded or shown
//!  "kinect"             one at a time   a thread of its own, newest first, finds a lost source again
//! ```
//!
//! A [`DepthSource`] is opened, used and dropped on one thread, as some camera libraries require. [`Feed`] is that thread;
//! a caller that can wait for frames on its own thread may also use a source directly.

#![cfg_attr(test, allow(clippy::disallowed_methods, reason = "tests change files"))]

mod camera_error;
mod camera_library;
mod driver_search;
mod error;
mod feed;
#[cfg(any(test, feature = "fixtures"))]
pub mod fixtures;
mod genicam;
mod kinect;
mod open;
mod openni;
mod rate;
mod read;
mod read_timeout;
mod realsense;
mod recording;
mod robot_camera;
mod simulated;
mod source;
mod spec;
mod watched;

pub use self::camera_error::{CameraError, CameraErrorKind};
pub use self::camera_library::{ARAVIS, CameraLibrary, FREENECT, OPENNI, REALSENSE};
pub use self::error::{CaptureError, CaptureWarning, Recovery};
pub use self::feed::{BackpressurePolicy, Feed, FeedItem, FeedState, FeedStatus};
pub use self::open::{list, open};
pub use self::rate::FrameRate;
pub use self::read::may_be_capture;
pub use self::read::read_image;
pub use self::recording::{Recorder, Replay};
pub use self::robot_camera::{RobotConnection, RobotReply, RobotRequest};
pub use self::simulated::{SimulatedCell, simulated_frame_number};
pub use self::source::{Captured, DepthSource, Image, NextCapture, SkippedCapture};
pub use self::spec::{
    CellScene, GenicamFormat, GenicamSpec, KinectSpec, NUM_ON_RACK, OpenNiSpec, Pace,
    RealsenseSpec, RecordingSpec, SimulatedPose, SimulatedSpec, SourceListing, SourceSpec,
    SpecError, WatchedFrom, WatchedSpec,
};
pub use self::watched::WatchedFolder;
