//! The lock by which a second window notices that another one is open with the same data folder.

use std::{
    fs::{File, TryLockError},
    path::Path,
};

use files::{disk, open_lock};

/// Name of the lock file in the folder of the history.
const LOCK: &str = "window.lock";

/// Held while a window is open. Only the lock counts: the file stays when the window closes or crashes.
pub(super) struct DataLock {
    /// True if another window holds the lock.
    pub(super) is_taken: bool,
    _file: Option<File>,
}

impl DataLock {
    /// Tries to take the lock. If that fails for another reason, for example on a network file system without locks, it counts
    /// as free.
    pub(super) fn take(folder: Option<&Path>) -> Self {
        let file = folder.and_then(|folder| {
            disk::create_dir_all(folder).ok()?;
            open_lock(&folder.join(LOCK)).ok()
        });
        let is_taken = file
            .as_ref()
            .is_some_and(|file| matches!(file.try_lock(), Err(TryLockError::WouldBlock)));
        Self {
            is_taken,
            _file: file,
        }
    }
}
