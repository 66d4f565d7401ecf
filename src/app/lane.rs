//! Which thread does what: work of one lane never holds up or cancels the work of another.

/// One lane, one thread; within it the newest request wins.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum TaskQueue {
    /// Writes files that a person asked for.
    Write,
}

impl TaskQueue {
    /// Every lane.
    pub const ALL: [Self; 1] = [Self::Write];

    /// The name of its thread.
    pub fn name(self) -> &'static str {
        match self {
            Self::Write => "write",
        }
    }
}
