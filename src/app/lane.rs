//! Which thread does what: work of one lane never holds up or cancels the work of another.

/// One lane, one thread; within it the newest request wins.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Lane {
    /// Captures, opens and inspects scenes.
    Inspect,
    /// Prepares a part to be enrolled.
    Enrol,
    /// Inspects again with other parameters, and runs kept cases.
    Compare,
    /// Aligns clouds.
    Align,
    /// Writes files that a person asked for.
    Write,
    /// Changes the library: what it began it finishes.
    Library,
}

impl Lane {
    /// Every lane.
    pub const ALL: [Self; 6] = [
        Self::Inspect,
        Self::Enrol,
        Self::Compare,
        Self::Align,
        Self::Write,
        Self::Library,
    ];

    /// The name of its thread.
    pub fn name(self) -> &'static str {
        match self {
            Self::Inspect => "inspect",
            Self::Enrol => "enrol",
            Self::Compare => "compare",
            Self::Align => "align",
            Self::Write => "write",
            Self::Library => "library",
        }
    }
}
