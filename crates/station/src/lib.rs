//! The station's job, for every front end: a scene is inspected, and the verdict goes to the history, to robots and to
//! files for them. Commands, window and server parse, draw and print.
//!
//! ```text
//! frame ─► CameraScenes ─► Station ─► Settled ─► Inspected ─► line of JSON, entry ─► Recorder ─► history
//!                                                   │
//! trigger ─► Camera ─► Answering ───────────────────┴───────► Found (for a robot), RobotFile (if there are no doubts)
//! ```
//!
//! Whether a robot may act on a result is decided here alone, so that operator, engineer, robot and files never disagree:
//! [`Inspected::doubts`] lists the reasons against it, and there must be none. Line of JSON, card, report, answer and
//! file for a robot all ask it.

#![cfg_attr(test, allow(clippy::disallowed_methods, reason = "tests change files"))]

mod answer;
mod camera;
mod doubt;
mod finder;
mod follow;
mod inspected;
mod line;
mod motion;
mod recorder;
pub mod robot_file;
mod scenes;
pub mod servoing;
mod station;

pub use self::{
    answer::{Answered, Answering, traced},
    camera::{Camera, NewFrame, NoFrame, camera_status},
    doubt::{ClockAhead, Doubt, age_doubt},
    finder::{NumberedPart, PartFinder},
    follow::{PartFollower, SeenFrame, SeenPart},
    inspected::{CaptureFacts, Inspected, LibraryNames, ScanFacts, Subject},
    line::{CountLog, Followed, FollowedFrame, LineFollower, LinePose, LineTracker, Moment},
    motion::MotionWatch,
    recorder::{Losses, Recorder},
    scenes::CameraScenes,
    station::{Following, InspectedScene, SceneToInspect, Settled, Station, StationSetup},
};
