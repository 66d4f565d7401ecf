//! The lock on the process's only context.

use std::sync::atomic::{AtomicBool, Ordering};

static IS_TAKEN: AtomicBool = AtomicBool::new(false);

/// Exclusive right to a context; dropping it releases the right.
pub(super) struct DeviceLock(());

impl DeviceLock {
    /// Takes the right, unless it is already taken.
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
