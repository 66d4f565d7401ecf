//! Atomic replacement of a part's folder, so that no enrolled part is ever lost.
//!
//! A part is written into a hidden folder next to the others, synced, and renamed into place. An existing part of that
//! name is first renamed aside, and moved to the trash once the new one is in place. Whenever the power fails, the next
//! reader finds either the old part or the new one:
//!
//! ```text
//! .new-door-x7/                 half written: ignored, removed by the next save
//! .old-door/ without door/      stopped between the two renames: .old-door is read, the next save renames it back
//! .old-door/ beside door/       stopped before the move to the trash: the next save does it
//! .old-door+gate/               the same for a door that is renamed to gate: its successor is gate/
//! ```
//!
//! References of a renamed part are updated before its former folder goes to the trash: the next save that finds that
//! folder updates those that an interrupted rename left behind.
//!
//! Writers take turns by a lock. How all parts are replaced at once is in `replace_all`.

use std::{
    fs, io,
    path::{Path, PathBuf},
};

use super::{entry::NEW_PREFIX, error::LibraryError, name::PartName, store::LibraryFolder, trash};
use files::{FileLock, disk, sync_folder};

const OLD_PREFIX: &str = ".old-";
const LOCK: &str = ".lock";

impl LibraryFolder {
    /// Puts a folder in place as the part `name`, which succeeds `former`; `former` then goes to the trash. Returns its
    /// path there.
    pub(super) fn replace_entry(
        &self,
        coming: &Path,
        name: &str,
        former: &str,
    ) -> io::Result<Option<PathBuf>> {
        let aside = self.install_entry(coming, name, former)?;
        self.trash_replaced(aside, former)
    }

    /// As [`Self::replace_entry`], but leaves the former part where it was renamed aside. Returns that path, if there
    /// was one.
    pub(super) fn install_entry(
        &self,
        coming: &Path,
        name: &str,
        former: &str,
    ) -> io::Result<Option<PathBuf>> {
        let leaving = self.path().join(former);
        let aside = self.path().join(RenamedFolder::file_name(former, name));
        let is_succeeding = leaving.exists();
        if is_succeeding {
            disk::rename(&leaving, &aside)?;
        }
        if let Err(error) = disk::rename(coming, self.path().join(name)) {
            if is_succeeding {
                disk::rename(&aside, &leaving)?;
            }
            return Err(error);
        }
        sync_folder(self.path())?;
        Ok(is_succeeding.then_some(aside))
    }

    /// Moves a part that was renamed aside to the trash. Returns its path there.
    pub(super) fn trash_replaced(
        &self,
        aside: Option<PathBuf>,
        former: &str,
    ) -> io::Result<Option<PathBuf>> {
        aside
            .map(|aside| trash::move_in(self.path(), &aside, former))
            .transpose()
    }

    /// Runs a change while no other writer is active.
    pub(super) fn writing<T>(
        &self,
        change: impl FnOnce() -> io::Result<T>,
    ) -> Result<T, LibraryError> {
        let locked = || -> io::Result<T> {
            let _lock = FileLock::exclusive(&self.path().join(LOCK))?;
            change()
        };
        locked().map_err(|source| LibraryError::Unwritable {
            path: self.path().to_owned(),
            source,
        })
    }

    /// Completes or undoes interrupted writes. Call it only under the lock: the folders of an active writer are not
    /// leftovers.
    pub(super) fn finish_interrupted_write(&self) -> io::Result<()> {
        self.finish_replacement()?;
        for found in fs::read_dir(self.path())? {
            let path = found?.path();
            let Some(file_name) = path.file_name().and_then(|n| n.to_str()) else {
                continue;
            };
            if let Some(RenamedFolder { name, successor }) = RenamedFolder::parse(file_name) {
                if self.path().join(successor).exists() {
                    if let (Ok(from), Ok(to)) = (PartName::new(name), PartName::new(successor))
                        && from != to
                    {
                        self.carry_references(&from, &to)?;
                    }
                    trash::move_in(self.path(), &path, name)?;
                } else {
                    disk::rename(&path, self.path().join(name))?;
                }
            } else if file_name.starts_with(NEW_PREFIX) {
                disk::remove_dir_all(&path)?;
            }
        }
        Ok(())
    }
}

/// A part that was renamed aside, parsed from its folder's name.
pub(super) struct RenamedFolder<'a> {
    /// Name of the part.
    pub(super) name: &'a str,
    /// Name of the part that replaces it; usually the same.
    pub(super) successor: &'a str,
}

impl<'a> RenamedFolder<'a> {
    /// Separates the two names; no name can contain it.
    const SEPARATOR: char = '+';

    pub(super) fn parse(file_name: &'a str) -> Option<Self> {
        let name = file_name.strip_prefix(OLD_PREFIX)?;
        let (name, successor) = name.split_once(Self::SEPARATOR).unwrap_or((name, name));
        Some(Self { name, successor })
    }

    fn file_name(name: &str, successor: &str) -> String {
        if name == successor {
            format!("{OLD_PREFIX}{name}")
        } else {
            format!("{OLD_PREFIX}{name}{}{successor}", Self::SEPARATOR)
        }
    }
}
