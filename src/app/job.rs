//! What the window asks its threads for, what they answer, and who does it.

use std::{path::PathBuf, sync::Arc};

/// The name under which most of the window knows it.
pub use super::user_error::UserError as Trouble;
use super::{
    inspect::work::{InspectRequest, InspectScanError, Inspected, inspect, inspect_scan},
    lane::TaskQueue,
    live::{LiveAnswer, LiveRequest},
    shelf::{LibraryCache, LibraryView},
    shots::{FuseError, ScanOrder, ScanRequest, Steps},
    worker::JobContext,
    writing::{WriteRequest, WriteResult},
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
    /// Write a file.
    Write(WriteRequest),
}

impl Request {
    /// Whose work it is.
    pub fn lane(&self) -> TaskQueue {
        match self {
            Self::Inspect(_) | Self::InspectScan(_) | Self::Library(_) => TaskQueue::Inspect,
            Self::Live(_) => TaskQueue::Live,
            Self::Write(_) => TaskQueue::Write,
        }
    }
}

/// What comes back.
#[derive(Clone, Debug)]
pub enum TaskResult {
    /// A scene with everything that was found in it.
    Inspected(Arc<Inspected>),
    /// The poses of these shots were not found: a person has to name their file.
    PosesWanted(Box<ScanOrder>, Trouble),
    /// How following a camera stands.
    Live(LiveAnswer),
    /// The library that is in use now.
    Library(Arc<LibraryView>),
    /// What was written.
    Written(WriteResult),
}

/// An answer, or what went wrong.
pub type TaskOutcome = Result<TaskResult, Trouble>;

/// Does what is asked; `None` when it was cancelled. Called from the thread of the request's lane.
pub fn answer(
    request: Request,
    shelf: &LibraryCache,
    desk: &dyn JobContext<TaskOutcome>,
) -> Option<TaskOutcome> {
    match request {
        Request::Inspect(request) => match inspect(&request, shelf, desk) {
            Ok(inspected) => inspected.map(|found| Ok(TaskResult::Inspected(Arc::new(found)))),
            Err(error) => Some(Err(Trouble::of(&error))),
        },
        Request::InspectScan(request) => {
            let report = |done, total| desk.progress(done, total);
            let steps = Steps::new(desk, &report);
            Some(match inspect_scan(&request, shelf, desk, &steps)? {
                Ok(inspected) => Ok(TaskResult::Inspected(Arc::new(inspected))),
                Err(InspectScanError::Library(error)) => Err(Trouble::of(&error)),
                Err(InspectScanError::Fuse(error)) => not_fused(&error, &request),
            })
        }
        Request::Live(request) => super::live::answer(&request, shelf, desk),
        Request::Library(given) => Some(match shelf.choose(given) {
            Ok(shelved) => Ok(TaskResult::Library(Arc::clone(&shelved.shown))),
            Err(error) => Err(Trouble::of(&error)),
        }),
        Request::Write(request) => Some(super::writing::answer(&request).map(TaskResult::Written)),
    }
}

/// A scan whose poses are not found asks for their file.
fn not_fused(error: &FuseError, request: &ScanRequest) -> TaskOutcome {
    let trouble = Trouble::of(error);
    if error.wants_poses() {
        Ok(TaskResult::PosesWanted(
            Box::new(request.order.clone()),
            trouble,
        ))
    } else {
        Err(trouble)
    }
}
