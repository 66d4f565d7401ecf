//! What happened to the history, for whoever watches it.

use super::{open::SetAside, retention::PruneResult};

/// What happened to the history.
#[derive(Clone, Debug, PartialEq)]
pub enum HistoryEvent {
    /// An inspection is in the list: the number that it was handed over with, and the one that it has now.
    Added {
        /// As it was handed over.
        ticket: u64,
        /// As it is listed; below 0 as long as it waits.
        number: i64,
    },
    /// A damaged file was set aside and a new one begun.
    SetAside(SetAside),
    /// It cannot be written: inspections wait in memory from now on.
    Failed {
        /// Why.
        what: String,
        /// What to do.
        advice: String,
    },
    /// It is written again.
    Works {
        /// The numbers of those that waited, before and now.
        numbers: Vec<(i64, i64)>,
        /// Inspections that were too many to wait.
        num_lost: usize,
    },
    /// A remark or a true label was written down.
    Changed {
        /// Of which inspection.
        number: i64,
    },
    /// A remark or a true label could not be written down.
    NotChanged {
        /// Why.
        what: String,
        /// What to do.
        advice: String,
    },
    /// Rows may have changed: perhaps another program wrote, or a part was labelled while a case was kept.
    FilesChanged,
    /// Frames are kept by another rule.
    RuleChanged,
    /// Frames were taken away.
    Swept(PruneResult),
}
