//! Which thread does what: work of one lane never holds up or cancels the work of another.

/// One lane, one thread; within it the newest request wins.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum TaskQueue {
    /// Captures, opens and inspects scenes.
    Inspect,
    /// Follows a camera, frame after frame.
    Live,
    /// Prepares a part to be enrolled.
    Enrol,
    /// Writes files that a person asked for.
    Write,
    /// Changes the library: what it began it finishes.
    Library,
}

impl TaskQueue {
    /// Every lane.
    pub const ALL: [Self; 5] = [
        Self::Inspect,
        Self::Live,
        Self::Enrol,
        Self::Write,
        Self::Library,
    ];

    /// The name of its thread.
    pub fn name(self) -> &'static str {
        match self {
            Self::Inspect => "inspect",
            Self::Live => "live",
            Self::Enrol => "enrol",
            Self::Write => "write",
            Self::Library => "library",
        }
    }
}
