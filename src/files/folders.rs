//! Folders that are written so that a power cut leaves nothing half done, and where the user's own are.

use std::{
    fs::{self, File},
    io,
    path::Path,
};

use directories::ProjectDirs;

use super::disk;

/// Where the system keeps this program's data and settings of a user; `None` where it has no place for them.
pub(crate) fn user_folders() -> Option<ProjectDirs> {
    ProjectDirs::from("", "", "partsight")
}

/// The folder that a file is in.
pub(crate) fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    }
}

/// The last part of a path, or all of it where there is none.
pub(crate) fn file_name(path: &Path) -> String {
    let name = path.file_name().unwrap_or(path.as_os_str());
    name.to_string_lossy().into_owned()
}

/// A folder in `parent` whose name begins so, to be filled and then renamed; dropping it removes it.
pub(crate) fn new_folder(parent: &Path, prefix: &str) -> io::Result<tempfile::TempDir> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(prefix);
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt as _;
        // What an ordinary new folder has, less the user's mask: others on the machine may read it.
        builder.permissions(fs::Permissions::from_mode(0o777));
    }
    disk::temporary_folder(&builder, parent)
}

/// Writes a new file in place and syncs it: for folders that are renamed once they are complete.
pub(crate) fn write_file(path: &Path, content: &[u8]) -> io::Result<()> {
    let mut file = disk::create(path)?;
    disk::write_all(&mut file, content)?;
    disk::sync_all(&file)
}

/// Makes what was named anew in a folder last. Only Unix lets a folder be opened for that; elsewhere the file system
/// sees to it.
pub(crate) fn sync_folder(folder: &Path) -> io::Result<()> {
    if cfg!(unix) {
        disk::sync_all(&File::open(folder)?)?;
    }
    Ok(())
}
