//! Which library is meant when none is named.

use std::{
    fs, io,
    path::{Path, PathBuf},
};

use super::{
    shipped::write_shipped,
    store::{LibraryError, LibraryFolder, new_folder, sync_folder},
};

/// The folder looked for in the working directory.
const IN_WORKING_FOLDER: &str = "reference_parts";

/// A library, and why it is this one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum LibraryPlace {
    /// Named by the caller.
    Given(LibraryFolder),
    /// `reference_parts/` in the working directory.
    WorkingFolder(LibraryFolder),
    /// The user's own, in the folder that the system keeps for a user's data.
    User(LibraryFolder),
}

impl LibraryPlace {
    /// The library.
    pub fn folder(&self) -> &LibraryFolder {
        match self {
            Self::Given(folder) | Self::WorkingFolder(folder) | Self::User(folder) => folder,
        }
    }

    /// Why it is this one, in words.
    pub fn describe(&self) -> &'static str {
        match self {
            Self::Given(_) => "given",
            Self::WorkingFolder(_) => "found in the working directory",
            Self::User(_) => "your own",
        }
    }
}

/// The library at `given`, else `reference_parts/` in the working directory if there, else the user's own, which is
/// filled with the shipped parts the first time.
pub fn open_library(given: Option<&Path>) -> Result<LibraryPlace, LibraryError> {
    if let Some(path) = given {
        return LibraryFolder::open(path).map(LibraryPlace::Given);
    }
    let here = Path::new(IN_WORKING_FOLDER);
    if here.is_dir() {
        return LibraryFolder::open(here).map(LibraryPlace::WorkingFolder);
    }
    let path = user_path()?;
    if !path.is_dir() {
        fill(&path).map_err(|source| LibraryError::Unwritable {
            path: path.clone(),
            source,
        })?;
    }
    LibraryFolder::open(&path).map(LibraryPlace::User)
}

fn user_path() -> Result<PathBuf, LibraryError> {
    let folders =
        directories::ProjectDirs::from("", "", "partsight").ok_or(LibraryError::NoUserFolder)?;
    Ok(folders.data_dir().join("library"))
}

/// Makes the user's library, complete or not at all.
fn fill(path: &Path) -> io::Result<()> {
    let parent = path.parent().unwrap_or(Path::new("."));
    fs::create_dir_all(parent)?;
    let building = new_folder(parent, "library")?;
    write_shipped(building.path())?;
    match fs::rename(building.path(), path) {
        Ok(()) => {
            // Renamed away: nothing is left to be cleared up.
            let _ = building.keep();
            sync_folder(parent)
        }
        // Another start was quicker.
        Err(_) if path.is_dir() => Ok(()),
        Err(error) => Err(error),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
    fn a_library_named_by_the_caller_is_never_made() {
        let missing = Path::new("no/such/library");
        assert!(matches!(
            open_library(Some(missing)),
            Err(LibraryError::NotFound { .. })
        ));
        assert!(!missing.exists());
    }
}
