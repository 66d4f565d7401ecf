//! Where frames come from: the simulated cell, recordings, a watched folder, a Kinect.
//!
//! ```text
//! SourceSpec ─► open ─► DepthSource ─► Feed ─► Captured, to be inspected, recorded or shown
//!  "kinect"             one at a time   a thread of its own, newest first, finds a lost source again
//! ```
//!
//! A [`DepthSource`] is opened, used and dropped on one thread: some camera libraries want that. [`Feed`] is that
//! thread; whoever can wait for frames on its own thread may also use a source directly.

mod error;
mod feed;
mod kinect;
mod open;
mod rate;
mod read;
mod recording;
mod simulated;
mod source;
mod spec;
mod watched;

pub use self::error::{CaptureError, CaptureWarning, Recovery};
pub use self::feed::{Delivery, Feed, FeedItem, FeedState, FeedStatus};
pub use self::kinect::{KinectError, KinectWarning};
pub use self::open::{Listed, list, open};
pub use self::rate::FrameRate;
pub(crate) use self::read::read_image;
pub use self::recording::{Recorder, Replay};
pub use self::simulated::SimulatedCell;
pub use self::source::{Captured, DepthSource, Image, Next, Skipped};
pub use self::spec::{
    CellScene, HungPose, KinectSpec, Pace, RecordingSpec, SimulatedSpec, SourceSpec, SpecError,
    WatchedFrom, WatchedSpec,
};
pub use self::watched::WatchedFolder;
