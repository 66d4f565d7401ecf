//! Locks on files between programs.

use std::fs::{File, TryLockError};
use std::io;
use std::path::Path;

use super::{disk, refuse_special};

/// A lock on a file, held until it is dropped. Only the lock counts: the file stays.
#[derive(Debug)]
#[must_use]
pub struct FileLock(File);

impl FileLock {
    /// Waits until nobody else holds the lock. On network file systems without locks it counts as taken.
    pub fn exclusive(path: &Path) -> io::Result<Self> {
        let file = open(path)?;
        held(file.lock(), file)
    }

    /// Waits until nobody holds the exclusive lock. On network file systems without locks it counts as taken.
    pub fn shared(path: &Path) -> io::Result<Self> {
        let file = open(path)?;
        held(file.lock_shared(), file)
    }

    /// Takes the exclusive lock; `None` if somebody else holds it. Without locks the error is
    /// [`io::ErrorKind::Unsupported`].
    pub fn try_exclusive(path: &Path) -> io::Result<Option<Self>> {
        let file = open(path)?;
        match file.try_lock() {
            Ok(()) => Ok(Some(Self(file))),
            Err(TryLockError::WouldBlock) => Ok(None),
            Err(TryLockError::Error(error)) => Err(error),
        }
    }
}

impl Drop for FileLock {
    /// Closing the file is not enough: a child process that is just being started still has a copy of the descriptor, and
    /// the lock is free only when the last copy is closed.
    fn drop(&mut self) {
        let _ = self.0.unlock();
    }
}

/// Opens the file, and creates it if it is missing; refuses anything but a regular file.
fn open(path: &Path) -> io::Result<File> {
    refuse_special(path)?;
    disk::open(File::options().create(true).append(true), path)
}

fn held(taken: io::Result<()>, file: File) -> io::Result<FileLock> {
    match taken {
        Err(error) if error.kind() != io::ErrorKind::Unsupported => Err(error),
        _ => Ok(FileLock(file)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_lock_is_free_once_it_is_dropped_though_a_copy_of_its_descriptor_is_open() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.lock");
        let lock = FileLock::exclusive(&path).unwrap();
        let _in_a_child = lock.0.try_clone().unwrap();
        assert!(FileLock::try_exclusive(&path).unwrap().is_none());
        drop(lock);
        assert!(FileLock::try_exclusive(&path).unwrap().is_some());
        let shared = [(); 2].map(|()| FileLock::shared(&path).unwrap());
        assert!(FileLock::try_exclusive(&path).unwrap().is_none());
        drop(shared);
        assert!(FileLock::try_exclusive(&path).unwrap().is_some());
    }
}
