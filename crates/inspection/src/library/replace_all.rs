//! How all parts of a library are replaced at once: whole or not at all, wherever the program is killed.
//!
//! The new parts are written into a hidden folder in the library, which is synced and then renamed. From that rename on
//! they are the library, for every reader; what follows only tidies up, and the next writer completes it:
//!
//! ```text
//! .new-all-x7/     half written: ignored, cleared away by the next writer
//! .replacement/    all new parts. Only these are read; the former ones are being moved to the trash
//! .remainder/      the former ones are gone. These are being moved to their places; they and those in place are read
//! ```
//!
//! A former part of which the new library has the very same files is not moved to the trash, but removed.

use std::{
    collections::BTreeMap,
    ffi::OsString,
    fs,
    io::{self, Read as _},
    path::{Path, PathBuf},
};

use super::{
    entry::{NEW_PREFIX, is_entry},
    error::LibraryError,
    name::PartName,
    store::LibraryFolder,
    trash,
};
use files::{disk, new_folder, open_regular, sync_folder};

const REPLACEMENT: &str = ".replacement";
const REMAINDER: &str = ".remainder";

impl LibraryFolder {
    /// Puts the parts that `build` writes into an empty folder in the place of all others; files beside them take the
    /// place of those of the same name. Where `build` refuses, everything stays as it is. Says where the former parts
    /// lie in the trash now.
    ///
    /// An error may also come after the rename that makes the new parts the library: they count all the same, and the
    /// next writer tidies up.
    pub fn replace_all<E>(
        &self,
        build: impl FnOnce(&Path) -> io::Result<Result<(), E>>,
    ) -> Result<Result<Vec<PathBuf>, E>, LibraryError> {
        self.writing(|| {
            self.finish_interrupted_write()?;
            let building = new_folder(self.path(), &format!("{NEW_PREFIX}all-"))?;
            if let Err(refused) = build(building.path())? {
                return Ok(Err(refused));
            }
            sync_folder(building.path())?;
            disk::rename(building.path(), self.path().join(REPLACEMENT))?;
            // Renamed away: nothing is left to be cleared up.
            let _ = building.keep();
            sync_folder(self.path())?;
            let trashed = self.finish_replacement()?;
            self.finish_interrupted_write()?;
            Ok(Ok(trashed))
        })
    }

    /// Where a file beside the parts lies, wherever an interrupted replacement left it.
    pub fn file_beside_parts(&self, name: &str) -> PathBuf {
        let left = self.replacement_folders().into_iter();
        let left = left
            .map(|folder| folder.join(name))
            .find(|path| path.is_file());
        left.unwrap_or_else(|| self.path().join(name))
    }

    /// The folders that parts are read from. A part in a later one counts where an earlier one has it, too.
    pub(super) fn part_folders(&self) -> Vec<PathBuf> {
        let [replacement, remainder] = self.replacement_folders();
        if replacement.is_dir() {
            vec![replacement]
        } else if remainder.is_dir() {
            // Listed first: a part that takes its place meanwhile is then found in both, never in none.
            vec![remainder, self.path().to_owned()]
        } else {
            vec![self.path().to_owned()]
        }
    }

    /// Tidies up after all parts were replaced, and returns what was moved to the trash. Call it only under the lock.
    pub(super) fn finish_replacement(&self) -> io::Result<Vec<PathBuf>> {
        let [replacement, remainder] = self.replacement_folders();
        let mut trashed = Vec::new();
        if replacement.is_dir() {
            for name in self.leaving(&replacement)? {
                let former = self.path().join(&name);
                // A former part that cannot be read may differ, and must not stop every later writer.
                if has_same_files(&former, &replacement.join(&name)).unwrap_or(false) {
                    // Under a name by which it is cleared away, because removing a folder can be interrupted.
                    disk::rename(&former, self.path().join(format!("{NEW_PREFIX}{name}")))?;
                } else {
                    trashed.push(trash::move_in(self.path(), &former, &name)?);
                }
            }
            sync_folder(self.path())?;
            disk::rename(&replacement, &remainder)?;
            sync_folder(self.path())?;
        }
        if remainder.is_dir() {
            // Listed whole first: some systems skip entries of a folder that changes while it is listed.
            let left = fs::read_dir(&remainder)?.collect::<io::Result<Vec<_>>>()?;
            for found in left {
                disk::rename(found.path(), self.path().join(found.file_name()))?;
            }
            sync_folder(self.path())?;
            disk::remove_dir(&remainder)?;
        }
        Ok(trashed)
    }

    fn replacement_folders(&self) -> [PathBuf; 2] {
        [REPLACEMENT, REMAINDER].map(|name| self.path().join(name))
    }

    /// The names of former parts, and of whatever lies where a new part goes.
    fn leaving(&self, replacement: &Path) -> io::Result<Vec<String>> {
        let mut leaving = Vec::new();
        for found in fs::read_dir(self.path())? {
            let found = found?;
            let Ok(name) = found.file_name().into_string() else {
                continue;
            };
            let is_in_the_way = PartName::new(&name).is_ok() && replacement.join(&name).exists();
            if !name.starts_with('.') && (is_entry(&name, &found.path()) || is_in_the_way) {
                leaving.push(name);
            }
        }
        Ok(leaving)
    }
}

/// True if both are folders of the same plain files and of nothing else.
fn has_same_files(one: &Path, other: &Path) -> io::Result<bool> {
    if !one.is_dir() || !other.is_dir() {
        return Ok(false);
    }
    let (mine, theirs) = (contents(one)?, contents(other)?);
    Ok(mine.is_some() && mine == theirs)
}

/// Names and contents of the files of a folder, in order; `None` if it holds anything but plain files.
fn contents(folder: &Path) -> io::Result<Option<BTreeMap<OsString, Vec<u8>>>> {
    let mut files = BTreeMap::new();
    for found in fs::read_dir(folder)? {
        let found = found?;
        if !found.file_type()?.is_file() {
            return Ok(None);
        }
        let mut content = Vec::new();
        open_regular(&found.path())?.read_to_end(&mut content)?;
        files.insert(found.file_name(), content);
    }
    Ok(Some(files))
}
