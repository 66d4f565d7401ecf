//! Identity of a hung part, and which of its inspections are written while a source is followed.

use std::{
    fmt,
    sync::atomic::{AtomicU32, Ordering},
};

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use super::entry::NewEntry;
use crate::pipeline::live::{FrameRole, HungFrame, HungParts, Left};

/// Identifies a part while it hangs in the cell; all its inspections share the identifier.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(transparent)]
pub struct HungId(pub(super) String);

/// Counts this program's parts, which keeps the identifiers of simultaneous ones distinct.
static COUNT: AtomicU32 = AtomicU32::new(0);

impl HungId {
    /// Creates the identifier of a part that has not been inspected before.
    #[expect(clippy::new_without_default, reason = "each is another")]
    pub fn new() -> Self {
        let number = COUNT.fetch_add(1, Ordering::Relaxed);
        let at = Timestamp::now().as_microsecond();
        Self(format!("{at}-{}-{number}", std::process::id()))
    }
}

impl fmt::Display for HungId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

/// Selects the inspections to write while a source is followed: one for each hung part.
#[derive(Debug)]
pub struct HungRows<E = NewEntry> {
    parts: HungParts,
    id: HungId,
    visit: u64,
    /// Best inspection of a part whose verdict does not count yet.
    best: Option<E>,
}

impl<E> Default for HungRows<E> {
    fn default() -> Self {
        Self {
            parts: HungParts::default(),
            id: HungId::new(),
            visit: 0,
            best: None,
        }
    }
}

impl<E> HungRows<E> {
    /// Takes in a frame. Returns the best inspection of a part that left before its verdict counted, and the role of
    /// the frame for the present part: pass the best one to [`hold`](Self::hold); write the first and every further one
    /// under [`id`](Self::id).
    pub fn see(&mut self, frame: &HungFrame<'_>) -> (Option<E>, FrameRole) {
        let (left, role) = self.parts.see(frame);
        let best = self.best.take_if(|_| left != Left::Nothing);
        let left = best.filter(|_| left == Left::Part);
        if self.parts.visit() != self.visit {
            self.visit = self.parts.visit();
            self.id = HungId::new();
        }
        if role == FrameRole::First {
            self.best = None;
        }
        (left, role)
    }

    /// Returns the identifier of the part that hangs there now, or hung there last.
    pub fn id(&self) -> &HungId {
        &self.id
    }

    /// Holds the inspection that shows the part best, until its verdict counts or the part leaves.
    pub fn hold(&mut self, best: E) {
        self.best = Some(best);
    }

    /// Ends the source. Returns the held inspection of a part whose verdict does not count yet.
    pub fn end(&mut self) -> Option<E> {
        self.parts = HungParts::default();
        self.visit = 0;
        self.best.take()
    }
}
