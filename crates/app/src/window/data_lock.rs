//! The lock by which a second window notices that another one is open with the same data folder.

use std::path::Path;

use files::{FileLock, disk};

/// Name of the lock file in the folder of the history.
const LOCK: &str = "window.lock";

/// Held while a window is open.
pub(super) struct DataLock {
    /// True if another window holds the lock.
    pub(super) is_taken: bool,
    _lock: Option<FileLock>,
}

impl DataLock {
    /// Tries to take the lock. If that fails for another reason, for example on a network file system without locks, it counts
    /// as free.
    pub(super) fn take(folder: Option<&Path>) -> Self {
        let taken = folder.and_then(|folder| {
            disk::create_dir_all(folder).ok()?;
            FileLock::try_exclusive(&folder.join(LOCK)).ok()
        });
        Self {
            is_taken: matches!(taken, Some(None)),
            _lock: taken.flatten(),
        }
    }
}
