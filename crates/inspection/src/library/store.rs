//! The folder of a library: listing and changing its parts so that no enrolled part is ever lost.
//!
//! Removed and replaced parts are kept whole in `.trash` and can be restored.
//!
//! Reading never writes: a library may be on a write-protected medium. `install` describes how one part replaces
//! another, and what an interruption leaves behind.

use std::{
    fs, io,
    path::{Path, PathBuf},
};

use super::{
    entry::{
        CLOUD, Entry, META, NEW_PREFIX, SIGNATURE, THUMBNAIL, copy_files, is_entry, meta_text,
        rewrite_meta, write_part,
    },
    error::LibraryError,
    install::RenamedFolder,
    name::PartName,
    part::{FileCheck, Part, PartMeta, PartNaming},
    stored_part::{meta_of, problem_of},
    trash,
};
use files::{disk, new_folder, sync_folder, write_file};

/// Folder of a library.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LibraryFolder {
    path: PathBuf,
}

/// Result of saving a part.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Saved {
    /// Folder of the part.
    pub folder: PathBuf,
    /// New path of the part of the same name that it replaced, if any.
    pub replaced: Option<PathBuf>,
    /// True if the replaced part has a spray path. The path stays with that part, since it is in its frame.
    pub left_path: bool,
}

/// Result of renaming a part.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Renamed {
    /// Former name, title and notes.
    pub before: PartNaming,
    /// Path of the former folder in the trash, if the name changed.
    pub former: Option<PathBuf>,
    /// Number of additional references that were updated to the new name.
    pub num_references: usize,
}

/// Result of restoring a part from the trash.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Restored {
    /// Name of the part.
    pub name: PartName,
    /// New path of the part of the same name that it replaced, if any.
    pub replaced: Option<PathBuf>,
}

impl LibraryFolder {
    /// Opens an existing library.
    pub fn open(path: &Path) -> Result<Self, LibraryError> {
        let path = path.to_owned();
        match fs::metadata(&path) {
            Ok(metadata) if metadata.is_dir() => Ok(Self { path }),
            Ok(_) => Err(LibraryError::NotAFolder { path }),
            Err(error) if error.kind() == io::ErrorKind::NotFound => {
                Err(LibraryError::NotFound { path })
            }
            Err(source) => Err(LibraryError::Unreadable { path, source }),
        }
    }

    /// Opens an existing library, or creates an empty one.
    pub fn open_or_create(path: &Path) -> Result<Self, LibraryError> {
        match Self::open(path) {
            Err(LibraryError::NotFound { path }) => {
                disk::create_dir_all(&path).map_err(|source| LibraryError::Unwritable {
                    path: path.clone(),
                    source,
                })?;
                Ok(Self { path })
            }
            opened => opened,
        }
    }

    /// Returns the path of the folder.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Returns the names of all parts, including damaged ones, in order.
    pub fn names(&self) -> Result<Vec<String>, LibraryError> {
        Ok(self.entries()?.into_iter().map(|e| e.name).collect())
    }

    /// Returns the folders that are ignored because their names are not valid for a part, in order.
    pub fn skipped(&self) -> Result<Vec<String>, LibraryError> {
        let list = || -> io::Result<Vec<String>> {
            let mut skipped = Vec::new();
            for found in fs::read_dir(&self.path)? {
                let path = found?.path();
                let name = path.file_name().unwrap_or_default().to_string_lossy();
                if path.is_dir() && !name.starts_with('.') && !is_entry(&name, &path) {
                    skipped.push(name.into_owned());
                }
            }
            skipped.sort();
            Ok(skipped)
        };
        list().map_err(|source| LibraryError::Unreadable {
            path: self.path.clone(),
            source,
        })
    }

    /// Returns whether this is the folder of one part instead of a library.
    pub fn is_itself_a_part(&self) -> bool {
        self.path.join(META).is_file()
    }

    /// Returns whether this is in use as a library or as a part: any other folder can be opened as an empty library too.
    pub fn is_in_use(&self) -> bool {
        let is_part = |entry: &Entry| entry.path.join(META).is_file();
        let has_parts = |entries: Vec<Entry>| entries.iter().any(is_part);
        self.is_itself_a_part()
            || self.entries().is_ok_and(has_parts)
            || self.numbers().is_ok_and(|numbers| !numbers.is_empty())
    }

    /// Returns the library that was probably meant by this folder without parts: its parent if it is a part itself,
    /// otherwise its `reference_parts`.
    pub fn probably_meant(&self) -> Option<PathBuf> {
        if self.is_itself_a_part() {
            let path = self.path.canonicalize().ok()?;
            return path.parent().map(Path::to_owned);
        }
        Some(self.path.join("reference_parts")).filter(|inner| inner.is_dir())
    }

    /// Returns the folders of all parts, sorted by name, including parts that were renamed aside and never replaced.
    pub(super) fn entries(&self) -> Result<Vec<Entry>, LibraryError> {
        let list = || -> io::Result<Vec<Entry>> {
            let mut entries: Vec<Entry> = Vec::new();
            for folder in self.part_folders() {
                let found = entries_in(&folder)?;
                entries.retain(|before| found.iter().all(|e| e.name != before.name));
                entries.extend(found);
            }
            entries.sort_by(|a, b| a.name.cmp(&b.name));
            Ok(entries)
        };
        list().map_err(|source| LibraryError::Unreadable {
            path: self.path.clone(),
            source,
        })
    }

    /// The files of a part that the program reads, those that are there: description, cloud, signature, thumbnail and
    /// spray path, in this order.
    pub fn files_of(&self, name: &PartName) -> Result<Vec<PathBuf>, LibraryError> {
        let (entry, meta) = self.entry_with_meta(name.as_str())?;
        let spray = meta.spray.as_ref().and_then(FileCheck::spray_file_name);
        let fixed = [META, CLOUD, SIGNATURE, THUMBNAIL].map(str::to_owned);
        let files = fixed.into_iter().chain(spray);
        let files = files.map(|file| entry.path.join(file));
        Ok(files.filter(|file| file.is_file()).collect())
    }

    /// The folder of one part.
    pub(super) fn entry(&self, name: &str) -> Result<Entry, LibraryError> {
        let entries = self.entries()?;
        let available = || entries.iter().map(|e| e.name.clone()).collect();
        entries
            .iter()
            .find(|e| e.name == name)
            .cloned()
            .ok_or_else(|| LibraryError::NoSuchPart {
                path: self.path.clone(),
                name: name.to_owned(),
                available: available(),
            })
    }

    /// The folder and the `part.toml` of one part.
    pub(super) fn entry_with_meta(&self, name: &str) -> Result<(Entry, PartMeta), LibraryError> {
        let entry = self.entry(name)?;
        let meta = meta_of(&entry).map_err(Box::new)?;
        Ok((entry, meta))
    }

    /// Saves a part; an existing part of that name goes to the trash once the new one is in place. A part that has references
    /// of its own is not replaced by a reference of another part: they would be left without a part.
    pub fn save(&self, part: &Part) -> Result<Saved, LibraryError> {
        if let Some(of) = part.meta.reference_of() {
            let references = self.references_of(&part.meta.name)?;
            if !references.is_empty() {
                return Err(LibraryError::HasReferences {
                    name: part.meta.name.clone(),
                    of: of.clone(),
                    references,
                });
            }
        }
        self.writing(|| {
            self.finish_interrupted_write()?;
            let name = part.meta.name.as_str();
            let former = self.entry_with_meta(name);
            let building = new_folder(&self.path, &format!("{NEW_PREFIX}{name}-"))?;
            write_part(building.path(), part)?;
            let replaced = self.replace_entry(building.path(), name, name)?;
            // Renamed away, so there is nothing to clean up.
            let _ = building.keep();
            Ok(Saved {
                folder: self.path.join(name),
                left_path: former.is_ok_and(|(_, former)| former.spray.is_some()),
                replaced,
            })
        })
    }

    /// Moves a part, damaged or not, to the trash. Returns its path there.
    pub fn remove(&self, name: &PartName) -> Result<PathBuf, LibraryError> {
        self.entry(name.as_str())?;
        self.writing(|| {
            self.finish_interrupted_write()?;
            let trash = trash::move_in(&self.path, &self.path.join(name.as_str()), name.as_str())?;
            sync_folder(&self.path)?;
            Ok(trash)
        })
    }

    /// Returns the text of a part's `part.toml`, which no other version of the part has; `None` if it cannot be read.
    pub fn version_of(&self, name: &PartName) -> Option<String> {
        let entry = self.entry(name.as_str()).ok()?;
        fs::read_to_string(entry.path.join(META)).ok()
    }

    /// Returns name, title and notes of a part.
    pub fn words(&self, name: &PartName) -> Result<PartNaming, LibraryError> {
        let (_, meta) = self.entry_with_meta(name.as_str())?;
        Ok(meta.words())
    }

    /// Changes name, title and notes of a part. Under another name, a new folder is built from the same files; the
    /// former one goes to the trash once the new one is in place and the additional references name it. Otherwise only
    /// `part.toml` is rewritten.
    pub fn rename(&self, name: &PartName, words: &PartNaming) -> Result<Renamed, LibraryError> {
        self.entry(name.as_str())?;
        self.writing(|| {
            self.finish_interrupted_write()?;
            let meta = match self.renamed_meta(name, &words.name) {
                Ok(meta) => meta,
                Err(error) => return Ok(Err(error)),
            };
            let before = meta.words();
            let folder = self.path.join(name.as_str());
            // A part that names itself as its part keeps doing so.
            let part = meta.part.clone();
            let part = part.map(|part| {
                if part == *name {
                    words.name.clone()
                } else {
                    part
                }
            });
            let meta = PartMeta {
                name: words.name.clone(),
                part,
                title: words.title.clone(),
                notes: words.notes.clone(),
                ..meta
            };
            let (former, num_references) = if words.name == *name {
                rewrite_meta(&folder, &meta)?;
                (None, 0)
            } else {
                let building = new_folder(&self.path, &format!("{NEW_PREFIX}{}-", words.name))?;
                copy_files(&folder, building.path())?;
                write_file(&building.path().join(META), meta_text(&meta)?.as_bytes())?;
                sync_folder(building.path())?;
                // First: if this is interrupted, the part gets a new number, and none the number of another part.
                if let Err(error) = self.carry_number(name, &words.name)? {
                    return Ok(Err(error));
                }
                let aside =
                    self.install_entry(building.path(), words.name.as_str(), name.as_str())?;
                // Renamed away, so there is nothing to clean up.
                let _ = building.keep();
                let num_references = self.carry_references(name, &words.name)?;
                (self.trash_replaced(aside, name.as_str())?, num_references)
            };
            Ok(Ok(Renamed {
                before,
                former,
                num_references,
            }))
        })?
    }

    /// Restores a part from the trash; an existing part of that name goes there once the restored one is in place. A
    /// damaged part does not replace a sound one.
    pub fn restore(&self, kept: &Path) -> Result<Restored, LibraryError> {
        let not_there = || LibraryError::NotInTrash {
            kept: kept.to_owned(),
        };
        let name = trash::name_of(&self.path, kept).ok_or_else(not_there)?;
        if let Some(present) = self.entry(name.as_str()).ok()
            && problem_of(&present).is_none()
        {
            let coming = Entry::in_folder(name.to_string(), kept.to_owned());
            if let Some(problem) = problem_of(&coming) {
                return Err(LibraryError::DamagedInTrash {
                    name,
                    problem: Box::new(problem),
                });
            }
        }
        self.writing(|| {
            self.finish_interrupted_write()?;
            let replaced = self.replace_entry(kept, name.as_str(), name.as_str())?;
            Ok(Restored { name, replaced })
        })
    }

    /// Returns the `part.toml` of a part that is to be renamed to `to`.
    fn renamed_meta(&self, name: &PartName, to: &PartName) -> Result<PartMeta, LibraryError> {
        if to != name && self.path.join(to.as_str()).exists() {
            return Err(LibraryError::NameTaken {
                path: self.path.clone(),
                name: to.clone(),
            });
        }
        let (_, meta) = self.entry_with_meta(name.as_str())?;
        Ok(meta)
    }
}

/// The folders of the parts in one folder.
fn entries_in(folder: &Path) -> io::Result<Vec<Entry>> {
    let mut entries: Vec<Entry> = Vec::new();
    let mut aside: Vec<Entry> = Vec::new();
    for found in fs::read_dir(folder)? {
        let path = found?.path();
        let Some(file_name) = path.file_name().map(|n| n.to_string_lossy().into_owned()) else {
            continue;
        };
        if let Some(RenamedFolder { name, successor }) = RenamedFolder::parse(&file_name) {
            if !folder.join(successor).exists() {
                aside.push(Entry::in_folder(name.to_owned(), path));
            }
        } else if !file_name.starts_with('.') && is_entry(&file_name, &path) {
            entries.push(Entry::in_folder(file_name, path));
        }
    }
    for old in aside {
        if !entries.iter().any(|e| e.name == old.name) {
            entries.push(old);
        }
    }
    Ok(entries)
}

#[cfg(test)]
mod tests;
