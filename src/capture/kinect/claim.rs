//! The right to the one context of the process.

use std::sync::atomic::{AtomicBool, Ordering};

static IS_TAKEN: AtomicBool = AtomicBool::new(false);

/// The right, given back when it is dropped.
pub(super) struct DeviceLock(());

impl DeviceLock {
    /// The right, unless somebody has it.
    pub(super) fn take() -> Option<Self> {
        let was_free = IS_TAKEN.compare_exchange(false, true, Ordering::Acquire, Ordering::Relaxed);
        was_free.ok().map(|_| Self(()))
    }
}

impl Drop for DeviceLock {
    fn drop(&mut self) {
        IS_TAKEN.store(false, Ordering::Release);
    }
}
