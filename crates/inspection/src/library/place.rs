//! The library to use when none is named.

use std::{
    io,
    path::{Path, PathBuf},
};

use image::RgbaImage;

use super::{
    Library,
    entry::{NEW_PREFIX, THUMBNAIL},
    error::LibraryError,
    load::{LibraryListing, LibraryLoad, list_shipped, load_shipped, read_shipped},
    name::PartName,
    numbers::{GivenNumbers, PartNumbers},
    problem::EntryProblem,
    shipped::{shipped_entries, shipped_files, shipped_numbers, write_shipped},
    spray_path::{SprayPath, SprayPathError},
    store::LibraryFolder,
    stored_part::StoredPart,
};
use files::{
    disk, file_name, new_folder, read_bytes, read_picture, sync_folder, user_data, write_atomically,
};
use stages::reference::ReferenceParams;

/// A library and the reason for choosing it.
#[derive(Debug)]
pub enum LibraryPlace {
    /// The caller named it.
    Given(LibraryFolder),
    /// The user's own, in the system's folder for user data.
    User(LibraryFolder),
    /// The shipped parts inside the program, because this error prevents a folder of the user's own.
    Program(LibraryError),
}

/// The published version that a library was taken from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TakenVersion {
    /// Its number.
    pub version: u32,
    /// The store, for people.
    pub store: String,
    /// True if the library was changed since.
    pub is_changed: bool,
}

impl LibraryPlace {
    /// Returns the library's folder, if it has one.
    pub fn folder(&self) -> Option<&LibraryFolder> {
        match self {
            Self::Given(folder) | Self::User(folder) => Some(folder),
            Self::Program(_) => None,
        }
    }

    /// Returns the folder to change, or why there is none.
    pub fn into_folder(self) -> Result<LibraryFolder, LibraryError> {
        match self {
            Self::Given(folder) | Self::User(folder) => Ok(folder),
            Self::Program(reason) => Err(reason),
        }
    }

    /// Returns where the library is, for people.
    pub fn location(&self) -> String {
        self.folder().map_or_else(
            || "inside the program".into(),
            |folder| folder.path().display().to_string(),
        )
    }

    /// Loads all parts; see [`LibraryFolder::load`].
    pub fn load(&self, params: &ReferenceParams) -> Result<LibraryLoad, LibraryError> {
        self.load_after(params, &Library::default())
    }

    /// As [`Self::load`], and takes the parts that have not changed from the library that was loaded before.
    pub fn load_after(
        &self,
        params: &ReferenceParams,
        former: &Library,
    ) -> Result<LibraryLoad, LibraryError> {
        self.folder().map_or_else(
            || Ok(load_shipped(params)),
            |folder| folder.load_after(params, former),
        )
    }

    /// Lists all parts; see [`LibraryFolder::list`].
    pub fn list(&self) -> Result<LibraryListing, LibraryError> {
        self.folder()
            .map_or_else(|| Ok(list_shipped()), LibraryFolder::list)
    }

    /// As [`Self::load`], and checks every file of every part against its cloud.
    pub fn verify(&self, params: &ReferenceParams) -> Result<LibraryLoad, LibraryError> {
        self.folder()
            .map_or_else(|| Ok(load_shipped(params)), |folder| folder.verify(params))
    }

    /// Loads one part.
    pub fn read(
        &self,
        name: &str,
        params: &ReferenceParams,
    ) -> Result<Result<StoredPart, EntryProblem>, LibraryError> {
        match self.folder() {
            Some(folder) => folder.read(name, params),
            None => read_shipped(name, params).ok_or_else(|| LibraryError::NoSuchPart {
                path: PathBuf::from(self.location()),
                name: name.to_owned(),
                available: shipped_entries().into_iter().map(|e| e.name).collect(),
            }),
        }
    }

    /// Reads the files of a part, names and contents; see [`LibraryFolder::files_of`].
    pub fn contents_of(&self, name: &PartName) -> Result<Vec<(String, Vec<u8>)>, LibraryError> {
        let Some(folder) = self.folder() else {
            let files = shipped_files(name.as_str()).unwrap_or_default().iter();
            return Ok(files
                .map(|(file, content)| ((*file).to_owned(), content.to_vec()))
                .collect());
        };
        let files = folder.files_of(name)?.into_iter();
        files
            .map(|path| Ok((file_name(&path), read_bytes(&path)?)))
            .collect()
    }

    /// Reads the thumbnail of a part; `None` if it is missing or unreadable.
    pub fn thumbnail(&self, name: &str) -> Option<RgbaImage> {
        let picture = if let Some(folder) = self.folder() {
            read_picture(&folder.thumbnail(name)?).ok()
        } else {
            let entry = shipped_entries().into_iter().find(|e| e.name == name)?;
            image::load_from_memory(entry.shipped_file(THUMBNAIL)?).ok()
        };
        Some(picture?.into_rgba8())
    }

    /// Reads the stored spray path of a part; `None` if none is stored.
    pub fn spray_path(&self, name: &str) -> Result<Option<SprayPath>, SprayPathError> {
        self.folder()
            .map_or(Ok(None), |folder| folder.spray_path(name))
    }

    /// Returns the stored numbers of the parts.
    pub fn numbers(&self) -> Result<PartNumbers, LibraryError> {
        self.folder()
            .map_or_else(|| Ok(shipped_numbers()), LibraryFolder::numbers)
    }

    /// Gives a number to every part that has none; see [`LibraryFolder::give_numbers`]. In a library that cannot be
    /// written, those parts are numbered in the order of their names.
    pub fn give_numbers(&self) -> Result<GivenNumbers, LibraryError> {
        let Some(folder) = self.folder() else {
            return Ok(GivenNumbers {
                numbers: shipped_numbers(),
                unstored: None,
            });
        };
        match folder.give_numbers() {
            Ok(numbers) => Ok(GivenNumbers {
                numbers,
                unstored: None,
            }),
            Err(error @ LibraryError::Unwritable { .. }) => Ok(GivenNumbers {
                numbers: folder.numbers_to_give()?,
                unstored: Some(error),
            }),
            Err(error) => Err(error),
        }
    }

    /// Returns in words why this library was chosen.
    pub fn describe(&self) -> &'static str {
        match self {
            Self::Given(_) => "given",
            Self::User(_) => "your own",
            Self::Program(_) => "the shipped parts",
        }
    }
}

/// Opens the library at `given`, or else the user's own, which is filled with the shipped parts the first time. If that
/// cannot be written, uses the shipped parts inside the program. The working directory does not matter.
pub fn open_library(given: Option<&Path>) -> Result<LibraryPlace, LibraryError> {
    if let Some(path) = given {
        return LibraryFolder::open(path).map(LibraryPlace::Given);
    }
    match user_path().and_then(|path| open_filled(&path)) {
        Ok(own) => Ok(LibraryPlace::User(own)),
        // The shipped parts must not take the place of the user's.
        Err(error @ LibraryError::Gone { .. }) => Err(error),
        Err(error) => Ok(LibraryPlace::Program(error)),
    }
}

/// Opens the library in this folder. Creates it the first time only; a file beside it marks that this was done.
fn open_filled(path: &Path) -> Result<LibraryFolder, LibraryError> {
    let made = path.with_extension("made");
    if !path.is_dir() {
        if made.exists() {
            let path = path.to_owned();
            return Err(LibraryError::Gone { path, made });
        }
        fill(path).map_err(|source| LibraryError::Unwritable {
            path: path.to_owned(),
            source,
        })?;
    }
    if !made.exists() {
        // Without it the library works all the same.
        let _ = write_atomically(&made, |_| Ok(()));
    }
    LibraryFolder::open(path)
}

fn user_path() -> Result<PathBuf, LibraryError> {
    let folder = user_data()?;
    Ok(folder.join("library"))
}

/// Creates the user's library, completely or not at all.
fn fill(path: &Path) -> io::Result<()> {
    let parent = path.parent().unwrap_or(Path::new("."));
    disk::create_dir_all(parent)?;
    let building = new_folder(parent, &format!("{NEW_PREFIX}library-"))?;
    write_shipped(building.path())?;
    match disk::rename(building.path(), path) {
        Ok(()) => {
            // Renamed away, so there is nothing to clean up.
            let _ = building.keep();
            sync_folder(parent)
        }
        // Another instance created it first.
        Err(_) if path.is_dir() => Ok(()),
        Err(error) => Err(error),
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;
    use geometry::error::Advice as _;

    #[test]
    fn the_users_library_is_filled_once_and_then_left_alone() {
        let data = tempfile::tempdir().expect("a folder");
        let path = data.path().join("partsight").join("library");
        fill(&path).expect("made");
        let folder = LibraryFolder::open(&path).expect("there");
        let names = folder.names().expect("listed");
        fs::write(path.join("note.txt"), "mine").expect("written");
        fill(&path).expect("left alone");
        assert!(path.join("note.txt").exists());
        assert_eq!(folder.names().expect("listed"), names);
        assert_eq!(
            fs::read_dir(data.path().join("partsight"))
                .expect("listed")
                .count(),
            1
        );
    }

    #[test]
    fn a_library_that_is_gone_is_not_made_again_until_its_mark_is_removed() {
        let data = tempfile::tempdir().expect("a folder");
        let path = data.path().join("library");
        open_filled(&path).expect("made");
        fs::rename(&path, data.path().join("elsewhere")).expect("moved");
        let error = open_filled(&path).expect_err("gone");
        assert!(error.advice().contains("library.made"), "{error:?}");
        assert!(!path.exists());
        fs::rename(data.path().join("elsewhere"), &path).expect("moved back");
        open_filled(&path).expect("there");
        fs::remove_dir_all(&path).expect("removed");
        fs::remove_file(data.path().join("library.made")).expect("removed");
        open_filled(&path).expect("made again");
    }

    #[test]
    fn a_library_named_by_the_caller_is_never_made() {
        let missing = Path::new("no/such/library");
        assert!(matches!(
            open_library(Some(missing)),
            Err(LibraryError::NotFound { .. })
        ));
        assert!(!missing.exists());
    }
}
