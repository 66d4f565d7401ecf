//! Lists the files in a watched folder.

use std::{ffi::OsString, fs, io, path::Path, time::SystemTime};

use crate::{error::CaptureError, read::may_be_capture};
use files::depth_png::intrinsics_path;

/// Time and size of a file; if one of them changes, so does the content.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct FileStamp {
    pub(super) modified: SystemTime,
    bytes: u64,
    /// Stamp of the JSON file beside a depth image, which may appear after the image.
    camera: Option<(SystemTime, u64)>,
}

/// Lists the names of files that may be captures.
pub(super) fn list(folder: &Path) -> Result<Vec<OsString>, CaptureError> {
    let listed = || -> io::Result<Vec<OsString>> {
        let mut names = Vec::new();
        for entry in fs::read_dir(folder)? {
            let entry = entry?;
            let name = entry.file_name();
            let is_folder = || entry.file_type().is_ok_and(|kind| kind.is_dir());
            if may_be_capture(Path::new(&name)) && !is_folder() {
                names.push(name);
            }
        }
        Ok(names)
    };
    listed().map_err(|source| {
        let path = folder.to_owned();
        match source.kind() {
            io::ErrorKind::NotFound | io::ErrorKind::NotADirectory => CaptureError::FolderGone {
                path,
                may_come: true,
            },
            _ => CaptureError::FolderUnreadable { path, source },
        }
    })
}

/// Time and size of a file and, for a depth image, of its camera; `None` if it is not a regular file.
pub(super) fn stamp(path: &Path) -> Option<FileStamp> {
    let (modified, bytes) = size_and_time(path)?;
    let ending = path.extension();
    let is_image = ending.is_some_and(|ending| ending.eq_ignore_ascii_case("png"));
    let camera = is_image.then(|| size_and_time(&intrinsics_path(path)));
    Some(FileStamp {
        modified,
        bytes,
        camera: camera.flatten(),
    })
}

/// Time and size of a file; `None` if it is not a regular file.
fn size_and_time(path: &Path) -> Option<(SystemTime, u64)> {
    let file = fs::metadata(path).ok().filter(fs::Metadata::is_file)?;
    Some((file.modified().ok()?, file.len()))
}
