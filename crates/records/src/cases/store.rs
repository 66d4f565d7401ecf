//! A folder of cases: listing, writing, reading, removing and restoring.
//!
//! Readers never write, so cases can be read from a write-protected medium. A lock admits one writer at a time.

use std::{
    fs, io, mem,
    path::{Path, PathBuf},
};

use super::{
    error::CaseError,
    judge::Truth,
    meta::{CaseDescription, CaseMeta, SCHEMA_VERSION},
};
use crate::history::{FrameRecord, read_frame_by, write_frame};
use files::{
    FileError, FileLock, disk, in_counting_order, new_folder, open_regular, parse_toml, read_bytes,
    replace_file, sync_folder, user_data, words_of, write_file,
};
use stages::scene::SceneCloud;

const META: &str = "case.toml";
/// The name of the scene's file, without its ending.
const SCENE: &str = "scene";
const NEW_PREFIX: &str = ".new-";
const TRASH: &str = ".trash";
const LOCK: &str = ".lock";
/// The largest `case.toml` that is read, in bytes.
const MAX_META_BYTES: u64 = 1 << 20;
/// Longest name of a case's folder without its number, in bytes.
const MAX_NAME: usize = 48;

/// A folder of cases. Writing the first case creates it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CaseFolder {
    path: PathBuf,
}

/// A case in the folder.
#[derive(Clone, Debug, PartialEq)]
pub struct KeptCase {
    /// Name of the case's folder.
    pub name: String,
    /// The content of `case.toml`.
    pub meta: CaseMeta,
}

/// The contents of a folder of cases.
#[derive(Debug, Default)]
pub struct CaseList {
    /// The cases by name; numbers in names are sorted by value.
    pub cases: Vec<KeptCase>,
    /// Errors of the cases that cannot be read.
    pub problems: Vec<CaseError>,
}

impl CaseFolder {
    /// Refers to the folder at this path, which need not exist.
    pub fn at(path: impl Into<PathBuf>) -> Self {
        Self { path: path.into() }
    }

    /// Returns the user's own folder of cases, in the system's folder for user data.
    pub fn of_user() -> Result<Self, CaseError> {
        let folder = user_data()?;
        Ok(Self::at(folder.join("cases")))
    }

    /// Returns the folder's path.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Lists the cases. Damaged ones become problems of the list. A folder that does not exist has no cases.
    pub fn list(&self) -> Result<CaseList, CaseError> {
        let mut list = CaseList::default();
        for name in self.names()? {
            match self.read_meta(&name) {
                Ok(Some(meta)) => list.cases.push(KeptCase { name, meta }),
                Ok(None) => {}
                Err(problem) => list.problems.push(problem),
            }
        }
        Ok(list)
    }

    /// Writes a case, whole or not at all. Its folder is named after its origin.
    pub fn keep(&self, scene: &SceneCloud, about: CaseDescription) -> Result<KeptCase, CaseError> {
        let kept = || -> io::Result<KeptCase> {
            disk::create_dir_all(&self.path)?;
            self.writing(|| {
                self.clear_leftovers()?;
                let (name, place) = free_name(&self.path, &plain_name(&about.origin))?;
                let building = new_folder(&self.path, NEW_PREFIX)?;
                let meta = CaseMeta {
                    schema_version: SCHEMA_VERSION,
                    about,
                    scene: write_frame(building.path(), SCENE, scene)?,
                };
                let text = toml::to_string(&meta).map_err(io::Error::other)?;
                write_file(&building.path().join(META), text.as_bytes())?;
                sync_folder(building.path())?;
                disk::rename(building.path(), place)?;
                // The folder has been renamed; do not remove it on drop.
                let _ = building.keep();
                sync_folder(&self.path)?;
                Ok(KeptCase { name, meta })
            })
        };
        kept().map_err(|source| self.unwritable(source))
    }

    /// Reads the scene of a case, bit for bit as it was written.
    pub fn read_scene(&self, case: &KeptCase) -> Result<SceneCloud, CaseError> {
        let folder = self.place_of(&case.name)?;
        case.scene(&|file| read_bytes(&folder.join(file)))
    }

    /// Reads all that an inspection of the case needs. What is damaged shows when it is unpacked.
    pub fn pack(&self, case: &KeptCase) -> Result<PackedCase, CaseError> {
        let folder = self.place_of(&case.name)?;
        let content = |file: &str| {
            let read = read_bytes(&folder.join(file));
            read.map_err(|error| case.damaged(&error))
        };
        let FrameRecord {
            file, empty_cell, ..
        } = &case.meta.scene;
        let empty_cell = empty_cell.as_deref().map(|file| {
            // A damaged scene is reported before a missing cell.
            content(file).or_else(|error| self.read_scene(case).and(Err(error)))
        });
        Ok(PackedCase {
            name: case.name.clone(),
            case_toml: toml::to_string(&case.meta).map_err(|error| case.damaged(&error))?,
            scene: content(file)?,
            empty_cell: empty_cell.transpose()?,
        })
    }

    /// Changes the true label of a case and returns the one before.
    pub fn set_truth(&self, name: &str, truth: Truth) -> Result<Truth, CaseError> {
        let folder = self.changeable(name)?;
        let meta = self.read_meta(name)?;
        let mut meta = meta.ok_or_else(|| self.no_such_case(name))?;
        let before = mem::replace(&mut meta.about.truth, truth);
        // The record of the scene is written as this schema has it.
        meta.schema_version = SCHEMA_VERSION;
        let written = || -> io::Result<()> {
            let text = toml::to_string(&meta).map_err(io::Error::other)?;
            self.writing(|| replace_file(&folder.join(META), text.as_bytes()))
        };
        written().map_err(|source| self.unwritable(source))?;
        Ok(before)
    }

    /// Moves a case, damaged or not, to the trash and returns its path there.
    pub fn remove(&self, name: &str) -> Result<PathBuf, CaseError> {
        let folder = self.changeable(name)?;
        let trash = self.path.join(TRASH);
        let moved = || -> io::Result<PathBuf> {
            self.writing(|| {
                disk::create_dir_all(&trash)?;
                let (_, place) = free_name(&trash, name)?;
                disk::rename(&folder, &place)?;
                sync_folder(&self.path)?;
                Ok(place)
            })
        };
        moved().map_err(|source| self.unwritable(source))
    }

    /// Moves a removed case from the trash back to its name.
    pub fn restore(&self, name: &str, from: &Path) -> Result<(), CaseError> {
        let place = self.path.join(name);
        if !is_plain(name) || !from.is_dir() {
            return Err(self.no_such_case(name));
        }
        let moved = || -> io::Result<()> {
            self.writing(|| {
                if place.exists() {
                    return Err(io::ErrorKind::AlreadyExists.into());
                }
                disk::rename(from, &place)?;
                sync_folder(&self.path)
            })
        };
        moved().map_err(|source| self.unwritable(source))
    }

    /// Path of a case.
    fn place_of(&self, name: &str) -> Result<PathBuf, CaseError> {
        let place = self.path.join(name);
        if place.is_dir() {
            Ok(place)
        } else {
            Err(self.no_such_case(name))
        }
    }

    /// Path of a case that may be changed: no other folder has such a name.
    fn changeable(&self, name: &str) -> Result<PathBuf, CaseError> {
        if is_plain(name) {
            self.place_of(name)
        } else {
            Err(self.no_such_case(name))
        }
    }

    fn no_such_case(&self, name: &str) -> CaseError {
        CaseError::NoSuchCase {
            path: self.path.clone(),
            name: name.to_owned(),
        }
    }

    fn unwritable(&self, source: io::Error) -> CaseError {
        CaseError::Unwritable {
            path: self.path.clone(),
            source,
        }
    }

    /// Returns the names of the folders that are not hidden, in counting order.
    fn names(&self) -> Result<Vec<String>, CaseError> {
        let listed = || -> io::Result<Vec<String>> {
            let found = match fs::read_dir(&self.path) {
                Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(Vec::new()),
                found => found?,
            };
            let mut names = Vec::new();
            for entry in found {
                let entry = entry?;
                let name = entry.file_name().to_string_lossy().into_owned();
                if !name.starts_with('.') && entry.path().is_dir() {
                    names.push(name);
                }
            }
            names.sort_by_key(|name| in_counting_order(name));
            Ok(names)
        };
        listed().map_err(|source| CaseError::Unreadable {
            path: self.path.clone(),
            source,
        })
    }

    /// Returns `None` for a folder that is not a case.
    fn read_meta(&self, name: &str) -> Result<Option<CaseMeta>, CaseError> {
        let folder = self.path.join(name);
        let damaged = |what: String| CaseError::Damaged {
            name: name.to_owned(),
            what,
        };
        let meta = folder.join(META);
        if !meta.exists() {
            // Without a scene it is some other folder.
            let what = format!("{META} is missing");
            let mut scenes = ["png", "pcd"].iter();
            return if scenes.any(|ending| folder.join(format!("{SCENE}.{ending}")).exists()) {
                Err(damaged(what))
            } else {
                Ok(None)
            };
        }
        let unreadable = |error: io::Error| damaged(format!("{META}: {}", words_of(&error)));
        let size = fs::metadata(&meta).map_err(unreadable)?.len();
        if size > MAX_META_BYTES {
            return Err(damaged(format!("{META} has {size} bytes")));
        }
        let text = open_regular(&meta)
            .and_then(io::read_to_string)
            .map_err(unreadable)?;
        let meta = parse_meta(name, &text)?;
        let FrameRecord { file, bytes, .. } = &meta.scene;
        let found = fs::metadata(folder.join(file)).map(|scene| scene.len());
        match found {
            Ok(found) if found == *bytes => Ok(Some(meta)),
            Ok(found) => Err(damaged(format!(
                "{file} has {found} bytes, expected {bytes}"
            ))),
            Err(error) if error.kind() == io::ErrorKind::NotFound => {
                Err(damaged(format!("{file} is missing")))
            }
            Err(error) => Err(damaged(format!("{file}: {}", words_of(&error)))),
        }
    }

    /// Removes what an interrupted writer left. Call it only under the lock: the folder of an active writer is not a leftover.
    fn clear_leftovers(&self) -> io::Result<()> {
        for entry in fs::read_dir(&self.path)? {
            let entry = entry?;
            if entry.file_name().to_string_lossy().starts_with(NEW_PREFIX) {
                disk::remove_dir_all(entry.path())?;
            }
        }
        Ok(())
    }

    /// Runs a change under the writers' lock.
    fn writing<T>(&self, change: impl FnOnce() -> io::Result<T>) -> io::Result<T> {
        let _lock = FileLock::exclusive(&self.path.join(LOCK))?;
        change()
    }
}

impl KeptCase {
    /// Its scene, with the content of each of its files from `content`. Errors name a file without its folder, so that
    /// they are the same wherever the case lies.
    fn scene(
        &self,
        content: &dyn Fn(&Path) -> Result<Vec<u8>, FileError>,
    ) -> Result<SceneCloud, CaseError> {
        let read = read_frame_by(Path::new(""), &self.meta.scene, content);
        read.map_err(|error| self.damaged(&error))
    }

    fn damaged(&self, what: &dyn std::fmt::Display) -> CaseError {
        CaseError::Damaged {
            name: self.name.clone(),
            what: what.to_string(),
        }
    }
}

/// A case in memory, which another computer can inspect.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PackedCase {
    /// Name of its folder.
    pub name: String,
    /// The text of its `case.toml`.
    pub case_toml: String,
    /// The file of its scene.
    pub scene: Vec<u8>,
    /// The file of its empty cell, if one was known.
    pub empty_cell: Option<Vec<u8>>,
}

impl PackedCase {
    /// The case and its scene, bit for bit as [`CaseFolder::read_scene`] reads it.
    pub fn unpack(self) -> Result<(KeptCase, SceneCloud), CaseError> {
        let case = KeptCase {
            meta: parse_meta(&self.name, &self.case_toml)?,
            name: self.name,
        };
        let scene = case.scene(&|file| {
            let packed = if file == Path::new(&case.meta.scene.file) {
                Some(&self.scene)
            } else {
                self.empty_cell.as_ref()
            };
            let path = file.to_owned();
            packed.cloned().ok_or(FileError::NotFound { path })
        })?;
        Ok((case, scene))
    }
}

/// Reads the text of a `case.toml`.
fn parse_meta(name: &str, text: &str) -> Result<CaseMeta, CaseError> {
    let damaged = |what: String| CaseError::Damaged {
        name: name.to_owned(),
        what,
    };
    let bad = |error: toml::de::Error| damaged(format!("{META}: {}", error.message()));
    let path = Path::new(name).join(META);
    let meta: CaseMeta = parse_toml(&path, text, SCHEMA_VERSION, bad)?;
    let cell = meta.scene.empty_cell.as_deref();
    if !is_plain(&meta.scene.file) || cell.is_some_and(|file| !is_plain(file)) {
        return Err(damaged(format!("{META} names no file of its own")));
    }
    Ok(meta)
}

/// Returns the first name in a folder that is free among `plain`, `plain_2` and so on, and its path.
fn free_name(folder: &Path, plain: &str) -> io::Result<(String, PathBuf)> {
    let mut names = (1..=99_999).map(|n| match n {
        1 => plain.to_owned(),
        n => format!("{plain}_{n}"),
    });
    let free = names.find(|name| !folder.join(name).exists());
    let name = free.ok_or(io::ErrorKind::AlreadyExists)?;
    let place = folder.join(&name);
    Ok((name, place))
}

/// Returns true for the name of a visible file or folder, without a path.
fn is_plain(name: &str) -> bool {
    !name.is_empty() && !name.starts_with('.') && !name.contains(['/', '\\'])
}

/// Reduces a name to lower-case letters, digits and single underscores, which every file system accepts.
fn plain_name(origin: &str) -> String {
    let stem = Path::new(origin).file_stem().unwrap_or_default();
    let mut name = String::new();
    for letter in stem.to_string_lossy().to_lowercase().chars() {
        if letter.is_ascii_alphanumeric() {
            name.push(letter);
        } else if !name.is_empty() && !name.ends_with('_') {
            name.push('_');
        }
    }
    name.truncate(MAX_NAME);
    let name = name.trim_end_matches('_');
    if name.is_empty() {
        "case".into()
    } else {
        name.into()
    }
}

#[cfg(test)]
mod tests;
