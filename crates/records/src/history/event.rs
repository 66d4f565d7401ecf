//! Events of the history.

use super::{open::SetAside, retention::PruneResult};

/// A change of the history, or a failure.
#[derive(Clone, Debug, PartialEq)]
pub enum HistoryEvent {
    /// An inspection was added to the list.
    Added {
        /// The ticket with which it was passed in.
        ticket: u64,
        /// Its number in the list; negative while it waits.
        number: i64,
    },
    /// A damaged file was set aside and a new one created.
    SetAside(SetAside),
    /// Writing failed: inspections wait in memory from now on.
    Failed {
        /// The error.
        what: String,
        /// What to do about it.
        advice: String,
    },
    /// Writing works again.
    Works {
        /// The numbers of the waiting inspections, before and after.
        numbers: Vec<(i64, i64)>,
        /// Number of inspections lost because too many waited.
        num_lost: usize,
    },
    /// A remark or a true label was written.
    Changed {
        /// Number of the inspection.
        number: i64,
    },
    /// A change (a remark, a true label or the retention rule) could not be written, or the file was moved, deleted or
    /// replaced.
    NotChanged {
        /// The error.
        what: String,
        /// What to do about it.
        advice: String,
    },
    /// A frame that the rule keeps could not be written. Reported once, until a frame is kept again.
    FramesNotKept {
        /// The error.
        what: String,
        /// What to do about it.
        advice: String,
    },
    /// A frame was kept again after that.
    FramesKept,
    /// Rows may have changed: another program wrote, keeping a case labelled a part, or a serial number arrived after the
    /// verdict of its part.
    FilesChanged,
    /// The retention rule changed.
    RuleChanged,
    /// Frames were removed.
    Swept(PruneResult),
}
