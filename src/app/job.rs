//! What the window asks its threads for, what they answer, and who does it.

use std::{path::PathBuf, sync::Arc};

/// The name under which most of the window knows it.
pub use super::user_error::UserError as Trouble;
use super::{
    enrol::{EnrolAnswer, EnrolRequest},
    inspect::work::{InspectRequest, Inspected, inspect, inspect_scan},
    lane::Lane,
    live::{LiveAnswer, LiveRequest},
    robot::{RobotAnswer, RobotRequest},
    shelf::{LibraryShown, Shelf},
    shots::{ScanOrder, ScanRequest},
    worker::Desk,
    writing::{WriteRequest, Written},
};

/// What the window asks for.
#[derive(Clone, Debug)]
pub enum Request {
    /// Get a scene and inspect it.
    Inspect(InspectRequest),
    /// Put the shots of a scan together and inspect them.
    InspectScan(ScanRequest),
    /// Follow a camera, or let it rest.
    Live(LiveRequest),
    /// Use another library: the one of this folder, else the one that is found without.
    Library(Option<PathBuf>),
    /// Something of the Enrol workspace.
    Enrol(EnrolRequest),
    /// Something of the robot's cell.
    Robot(RobotRequest),
    /// Write a file.
    Write(WriteRequest),
}

impl Request {
    /// Whose work it is.
    pub fn lane(&self) -> Lane {
        match self {
            Self::Inspect(_) | Self::InspectScan(_) | Self::Library(_) => Lane::Inspect,
            Self::Live(_) => Lane::Live,
            Self::Enrol(request) => request.lane(),
            Self::Robot(_) => Lane::Robot,
            Self::Write(_) => Lane::Write,
        }
    }
}

/// What comes back.
#[derive(Clone, Debug)]
pub enum Answer {
    /// A scene with everything that was found in it.
    Inspected(Arc<Inspected>),
    /// The poses of these shots were not found: a person has to name their file.
    PosesWanted(Box<ScanOrder>, Trouble),
    /// How following a camera stands.
    Live(LiveAnswer),
    /// The library that is in use now.
    Library(Arc<LibraryShown>),
    /// Something of the Enrol workspace.
    Enrol(EnrolAnswer),
    /// Something of the robot's cell.
    Robot(RobotAnswer),
    /// What was written.
    Written(Written),
}

/// An answer, or what went wrong.
pub type Outcome = Result<Answer, Trouble>;

/// Does what is asked; `None` when it was cancelled. Called from the thread of the request's lane.
pub fn answer(request: Request, shelf: &Shelf, desk: &dyn Desk<Outcome>) -> Option<Outcome> {
    match request {
        Request::Inspect(request) => match inspect(&request, shelf, desk) {
            Ok(inspected) => inspected.map(|found| Ok(Answer::Inspected(Arc::new(found)))),
            Err(error) => Some(Err(Trouble::of(&error))),
        },
        Request::InspectScan(request) => inspect_scan(&request, shelf, desk),
        Request::Live(request) => super::live::answer(&request, shelf, desk),
        Request::Library(given) => Some(match shelf.choose(given) {
            Ok(shelved) => Ok(Answer::Library(Arc::clone(&shelved.shown))),
            Err(error) => Err(Trouble::of(&error)),
        }),
        Request::Enrol(request) => super::enrol::answer(request, shelf, desk),
        Request::Write(request) => Some(super::writing::answer(&request).map(Answer::Written)),
        Request::Robot(request) => Some(super::robot::work::answer(request)),
    }
}
