//! The folder of a library: listing, saving and removing parts such that nothing enrolled is ever lost.
//!
//! A part is written into a hidden folder beside the others, synced, and renamed into place. One that is there
//! already is first renamed aside, and moved to the trash once the new one is in place. Whatever moment the power
//! fails at, the next look finds the old part or the new one:
//!
//! ```text
//! .new-door-x7/                 half written: ignored, cleared away by the next save
//! .old-door/ without door/      stopped between the two renames: .old-door is read, the next save puts it back
//! .old-door/ beside door/       stopped before the trash: the next save moves it there
//! ```
//!
//! Looking never writes: a library can lie on a medium that is write-protected. Writers take turns by a lock.

use std::{
    fs::{self, File},
    io::{self, Write as _},
    path::{Path, PathBuf},
};

use super::{
    name::PartName,
    part::{Part, PartMeta, cloud_bytes},
};
use crate::{
    error::Advice,
    files::{advice_on, words_of},
};

/// File names within a part's folder.
pub(super) const META: &str = "part.toml";
pub(super) const CLOUD: &str = "cloud.ply";
pub(super) const SIGNATURE: &str = "signature.json";
pub(super) const THUMBNAIL: &str = "thumbnail.png";

const NEW_PREFIX: &str = ".new-";
const OLD_PREFIX: &str = ".old-";
const TRASH: &str = ".trash";
const LOCK: &str = ".lock";

/// A library's folder.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LibraryFolder {
    path: PathBuf,
}

/// One part's folder in a library, whatever is in it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Entry {
    /// The name of the part that the folder stands for.
    pub(super) name: String,
    /// The folder.
    pub(super) path: PathBuf,
    /// Its files, if it lies inside the program.
    pub(super) shipped: Option<&'static ShippedFiles>,
}

/// Names and contents of the files of a part inside the program.
pub(super) type ShippedFiles = [(&'static str, &'static [u8]); 4];

impl Entry {
    /// A file of a part inside the program.
    pub(super) fn shipped_file(&self, name: &str) -> Option<&'static [u8]> {
        let mut files = self.shipped?.iter();
        files.find(|(n, _)| *n == name).map(|(_, bytes)| *bytes)
    }

    fn in_folder(name: String, path: PathBuf) -> Self {
        Self {
            name,
            path,
            shipped: None,
        }
    }
}

/// Where a part was saved.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Saved {
    /// Its folder.
    pub folder: PathBuf,
    /// Where the part of the same name that it replaced lies now, if there was one.
    pub replaced: Option<PathBuf>,
}

/// Why a library cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum LibraryError {
    /// No such folder.
    #[error("{}: no such library folder", path.display())]
    NotFound {
        /// The folder.
        path: PathBuf,
    },
    /// Something else than a folder.
    #[error("{}: not a folder", path.display())]
    NotAFolder {
        /// The path.
        path: PathBuf,
    },
    /// The system could not read.
    #[error("{}: cannot read the library: {}", path.display(), words_of(source))]
    Unreadable {
        /// The folder.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
    /// The system could not write; what was enrolled before still is.
    #[error("{}: cannot write to the library: {}", path.display(), words_of(source))]
    Unwritable {
        /// The folder.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
    /// No part of that name.
    #[error("{}: no part named {name}{}", path.display(), listed(available))]
    NoSuchPart {
        /// The library's folder.
        path: PathBuf,
        /// The name asked for.
        name: String,
        /// The names there are.
        available: Vec<String>,
    },
    /// The system does not say where a user's data belong.
    #[error("this system names no folder for a user's data")]
    NoUserFolder,
}

fn listed(names: &[String]) -> String {
    match names {
        [] => ", the library is empty".into(),
        names => format!("; it has {}", names.join(", ")),
    }
}

impl Advice for LibraryError {
    fn advice(&self) -> String {
        match self {
            Self::NotFound { .. } => {
                "Check the path and that the drive or stick is connected".into()
            }
            Self::NotAFolder { .. } => "Give the folder that holds the parts' folders".into(),
            Self::Unreadable { .. } => "Ask for access to this folder, or copy it elsewhere".into(),
            Self::Unwritable { source, .. } => {
                format!("{}, or name another with --library", advice_on(source))
            }
            Self::NoSuchPart { .. } => {
                "Use one of the names that `partsight library list` shows".into()
            }
            Self::NoUserFolder => "Name a folder with --library".into(),
        }
    }
}

impl LibraryFolder {
    /// A library that is there.
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

    /// A library that is there, or a new, empty one.
    pub fn open_or_create(path: &Path) -> Result<Self, LibraryError> {
        match Self::open(path) {
            Err(LibraryError::NotFound { path }) => {
                fs::create_dir_all(&path).map_err(|source| LibraryError::Unwritable {
                    path: path.clone(),
                    source,
                })?;
                Ok(Self { path })
            }
            opened => opened,
        }
    }

    /// The folder.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The names of all parts, damaged ones included, in order.
    pub fn names(&self) -> Result<Vec<String>, LibraryError> {
        Ok(self.entries()?.into_iter().map(|e| e.name).collect())
    }

    /// Folders that are not looked into because their name is no part's, in order.
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

    /// True if this is the folder of one part and not of a library.
    pub fn is_itself_a_part(&self) -> bool {
        self.path.join(META).is_file()
    }

    /// The folders of all parts in the order of their names; one that was renamed aside and never replaced counts.
    pub(super) fn entries(&self) -> Result<Vec<Entry>, LibraryError> {
        let list = || -> io::Result<Vec<Entry>> {
            let mut entries: Vec<Entry> = Vec::new();
            let mut aside: Vec<Entry> = Vec::new();
            for found in fs::read_dir(&self.path)? {
                let path = found?.path();
                let Some(file_name) = path.file_name().map(|n| n.to_string_lossy().into_owned())
                else {
                    continue;
                };
                if let Some(name) = file_name.strip_prefix(OLD_PREFIX) {
                    let name = name.to_owned();
                    aside.push(Entry::in_folder(name, path));
                } else if !file_name.starts_with('.') && is_entry(&file_name, &path) {
                    entries.push(Entry::in_folder(file_name, path));
                }
            }
            for old in aside {
                if !entries.iter().any(|e| e.name == old.name) {
                    entries.push(old);
                }
            }
            entries.sort_by(|a, b| a.name.cmp(&b.name));
            Ok(entries)
        };
        list().map_err(|source| LibraryError::Unreadable {
            path: self.path.clone(),
            source,
        })
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

    /// Saves a part; one of the same name goes to the trash once the new one is in place.
    pub fn save(&self, part: &Part) -> Result<Saved, LibraryError> {
        self.writing(|| {
            self.tidy_up()?;
            let name = part.meta.name.as_str();
            let building = new_folder(&self.path, name)?;
            write_part(building.path(), part)?;
            let folder = self.path.join(name);
            let aside = self.path.join(format!("{OLD_PREFIX}{name}"));
            let is_replacing = folder.exists();
            if is_replacing {
                fs::rename(&folder, &aside)?;
            }
            if let Err(error) = fs::rename(building.path(), &folder) {
                if is_replacing {
                    fs::rename(&aside, &folder)?;
                }
                return Err(error);
            }
            // Renamed away: nothing is left to be cleared up.
            let _ = building.keep();
            sync_folder(&self.path)?;
            let replaced = is_replacing
                .then(|| self.move_to_trash(&aside, name))
                .transpose()?;
            Ok(Saved { folder, replaced })
        })
    }

    /// Moves a part, damaged or not, to the trash and says where it lies there.
    pub fn remove(&self, name: &PartName) -> Result<PathBuf, LibraryError> {
        self.entry(name.as_str())?;
        self.writing(|| {
            self.tidy_up()?;
            let trash = self.move_to_trash(&self.path.join(name.as_str()), name.as_str())?;
            sync_folder(&self.path)?;
            Ok(trash)
        })
    }

    /// Runs one change while no other writer is at work.
    fn writing<T>(&self, change: impl FnOnce() -> io::Result<T>) -> Result<T, LibraryError> {
        let locked = || -> io::Result<T> {
            let lock = File::create(self.path.join(LOCK))?;
            match lock.lock() {
                // Some network file systems have no locks; a shop with one writer needs none.
                Err(error) if error.kind() == io::ErrorKind::Unsupported => {}
                taken => taken?,
            }
            change()
        };
        locked().map_err(|source| LibraryError::Unwritable {
            path: self.path.clone(),
            source,
        })
    }

    /// Finishes what an interrupted writer left. Only under the lock: another writer's folders are not leftovers.
    fn tidy_up(&self) -> io::Result<()> {
        for found in fs::read_dir(&self.path)? {
            let path = found?.path();
            let Some(file_name) = path.file_name().and_then(|n| n.to_str()) else {
                continue;
            };
            if let Some(name) = file_name.strip_prefix(OLD_PREFIX) {
                let folder = self.path.join(name);
                if folder.exists() {
                    self.move_to_trash(&path, name)?;
                } else {
                    fs::rename(&path, &folder)?;
                }
            } else if file_name.starts_with(NEW_PREFIX) {
                fs::remove_dir_all(&path)?;
            }
        }
        Ok(())
    }

    fn move_to_trash(&self, folder: &Path, name: &str) -> io::Result<PathBuf> {
        let trash = self.path.join(TRASH);
        fs::create_dir_all(&trash)?;
        let now = jiff::Timestamp::now().strftime("%Y%m%dT%H%M%SZ");
        let place = (1..=9999)
            .map(|n| match n {
                1 => trash.join(format!("{name}-{now}")),
                n => trash.join(format!("{name}-{now}-{n}")),
            })
            .find(|place| !place.exists())
            .ok_or(io::ErrorKind::AlreadyExists)?;
        fs::rename(folder, &place)?;
        Ok(place)
    }
}

/// A folder counts if it could be a part's or says that it is one; what else lies on a stick does not.
fn is_entry(file_name: &str, path: &Path) -> bool {
    path.is_dir() && (PartName::new(file_name).is_ok() || path.join(META).exists())
}

/// A hidden folder to build a part in; gone when dropped.
pub(super) fn new_folder(parent: &Path, name: &str) -> io::Result<tempfile::TempDir> {
    let mut builder = tempfile::Builder::new();
    let prefix = format!("{NEW_PREFIX}{name}-");
    builder.prefix(&prefix);
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt as _;
        // What an ordinary new folder has, less the user's mask: others on the machine may read the library.
        builder.permissions(fs::Permissions::from_mode(0o777));
    }
    builder.tempdir_in(parent)
}

fn write_part(folder: &Path, part: &Part) -> io::Result<()> {
    let Part {
        meta,
        cloud,
        signature,
        thumbnail,
    } = part;
    write_file(&folder.join(META), meta_text(meta)?.as_bytes())?;
    write_file(&folder.join(CLOUD), &cloud_bytes(cloud))?;
    write_file(&folder.join(SIGNATURE), &serde_json::to_vec(signature)?)?;
    let mut png = io::Cursor::new(Vec::new());
    thumbnail
        .write_to(&mut png, image::ImageFormat::Png)
        .map_err(io::Error::other)?;
    write_file(&folder.join(THUMBNAIL), png.get_ref())?;
    sync_folder(folder)
}

fn meta_text(meta: &PartMeta) -> io::Result<String> {
    toml::to_string(meta).map_err(io::Error::other)
}

pub(super) fn write_file(path: &Path, content: &[u8]) -> io::Result<()> {
    let mut file = File::create(path)?;
    file.write_all(content)?;
    file.sync_all()
}

/// Makes renames last. Only Unix lets a folder be opened for that; elsewhere the file system sees to it.
pub(super) fn sync_folder(folder: &Path) -> io::Result<()> {
    if cfg!(unix) {
        File::open(folder)?.sync_all()?;
    }
    Ok(())
}

#[cfg(test)]
mod tests;
