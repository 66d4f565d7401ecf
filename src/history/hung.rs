//! One part as it hung there, and what is written down of it while a source is followed.

use std::{
    fmt,
    sync::atomic::{AtomicU32, Ordering},
};

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use super::entry::NewEntry;
use crate::pipeline::live::{FrameRole, HungFrame, HungParts, Left};

/// Names one part as it hung there once: all inspections of it bear the same.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(transparent)]
pub struct HungId(pub(super) String);

/// Counts this program's parts, so that two of one moment have two names.
static COUNT: AtomicU32 = AtomicU32::new(0);

impl HungId {
    /// Of a part that nobody has inspected before.
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

/// What is written down while a source is followed: an inspection for each part that hung there.
#[derive(Debug)]
pub struct HungRows<E = NewEntry> {
    parts: HungParts,
    id: HungId,
    visit: u64,
    /// Of a part whose verdict does not count yet.
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
    /// Takes in a frame. Answers with the inspection of a part that left before its verdict counted, and with what the
    /// frame is for the part that hangs there now: the best goes to [`hold`](Self::hold), the first and another one
    /// are written, all under [`id`](Self::id).
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

    /// The part that hangs there now, or hung there last.
    pub fn id(&self) -> &HungId {
        &self.id
    }

    /// Keeps the frame that shows the part best, until its verdict counts or it leaves.
    pub fn hold(&mut self, best: E) {
        self.best = Some(best);
    }

    /// The source has ended: the inspection of a part that still hangs there without a verdict that counts.
    pub fn end(&mut self) -> Option<E> {
        self.parts = HungParts::default();
        self.visit = 0;
        self.best.take()
    }
}
