//! Which thread does what: work of one lane never holds up or cancels the work of another.

/// One lane, one thread; within it the newest request wins.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum TaskQueue {
    /// Captures, opens and inspects scenes.
    Inspect,
    /// Follows a camera, frame after frame.
    Live,
    /// Writes files that a person asked for.
    Write,
}

impl TaskQueue {
    /// Every lane.
    pub const ALL: [Self; 3] = [Self::Inspect, Self::Live, Self::Write];

    /// The name of its thread.
    pub fn name(self) -> &'static str {
        match self {
            Self::Inspect => "inspect",
            Self::Live => "live",
            Self::Write => "write",
        }
    }
}
