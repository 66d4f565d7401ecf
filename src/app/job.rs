//! What the window asks its threads for, what they answer, and who does it.

/// The name under which most of the window knows it.
pub use super::user_error::UserError as Trouble;
use super::{
    lane::TaskQueue,
    writing::{WriteRequest, WriteResult},
};

/// What the window asks for.
#[derive(Clone, Debug)]
pub enum Request {
    /// Write a file.
    Write(WriteRequest),
}

impl Request {
    /// Whose work it is.
    pub fn lane(&self) -> TaskQueue {
        match self {
            Self::Write(_) => TaskQueue::Write,
        }
    }
}

/// What comes back.
#[derive(Clone, Debug)]
pub enum TaskResult {
    /// What was written.
    Written(WriteResult),
}

/// An answer, or what went wrong.
pub type TaskOutcome = Result<TaskResult, Trouble>;

/// Does what is asked. Called from the thread of the request's lane.
pub fn answer(request: &Request) -> TaskOutcome {
    match request {
        Request::Write(request) => super::writing::answer(request).map(TaskResult::Written),
    }
}
