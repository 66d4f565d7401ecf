//! Crash-safe writing of folders, and the user's own folders.

use std::{
    env,
    fs::File,
    io,
    path::{self, Path, PathBuf},
};

use directories::ProjectDirs;

use super::disk;
use super::error::{FileError, OWN_FOLDER};

/// Returns the folder for this program's data of the user.
pub fn user_data() -> Result<PathBuf, FileError> {
    let folder = own_folder().or_else(|| Some(system_folders()?.data_dir().to_owned()));
    folder.ok_or(FileError::NoUserFolder)
}

/// Returns the path of the user's settings; `None` if the system has no folder for it.
pub fn user_settings() -> Option<PathBuf> {
    let folder = own_folder().or_else(|| Some(system_folders()?.config_dir().to_owned()))?;
    Some(folder.join("settings.toml"))
}

fn own_folder() -> Option<PathBuf> {
    let folder = env::var_os(OWN_FOLDER).filter(|folder| !folder.is_empty())?;
    // Without a working folder it stays relative, so that its use fails: another library must not take its place.
    Some(path::absolute(&folder).unwrap_or_else(|_| folder.into()))
}

fn system_folders() -> Option<ProjectDirs> {
    ProjectDirs::from("", "", "partsight")
}

/// Returns the folder that contains a file.
pub fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    }
}

/// Returns the last component of a path, or the whole path if there is none.
pub fn file_name(path: &Path) -> String {
    let name = path.file_name().unwrap_or(path.as_os_str());
    name.to_string_lossy().into_owned()
}

/// Creates a folder in `parent` whose name begins with `prefix`, to be filled and then renamed. Dropping it removes it.
pub fn new_folder(parent: &Path, prefix: &str) -> io::Result<tempfile::TempDir> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(prefix);
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt as _;
        // As for an ordinary new folder, less the umask: other users may read it.
        builder.permissions(std::fs::Permissions::from_mode(0o777));
    }
    disk::temporary_folder(&builder, parent)
}

/// Writes and syncs a new file, for folders that are renamed once complete. Fails if a file of that name is there: a failed
/// write would have destroyed it.
pub fn write_file(path: &Path, content: &[u8]) -> io::Result<()> {
    let mut file = disk::create_new(path)?;
    disk::write_all(&mut file, content)?;
    disk::sync_all(&file)
}

/// Flushes a folder's entries, so that new names survive a power cut. Only Unix can open a folder for that; other
/// systems leave it to the file system.
pub fn sync_folder(folder: &Path) -> io::Result<()> {
    if cfg!(unix) {
        disk::sync_all(&File::open(folder)?)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_new_file_never_takes_the_place_of_another() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("spray-0badcafe.csv");
        write_file(&path, b"the only copy").unwrap();
        let error = write_file(&path, b"the").unwrap_err();
        assert_eq!(error.kind(), io::ErrorKind::AlreadyExists);
        assert_eq!(std::fs::read(&path).unwrap(), b"the only copy");
    }
}
