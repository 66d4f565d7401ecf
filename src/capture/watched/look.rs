//! Lists the files in a watched folder.

use std::{
    fs, io,
    path::{Path, PathBuf},
    time::{Instant, SystemTime},
};

use crate::{
    capture::{error::CaptureError, read::may_be_capture},
    files::depth_png::intrinsics_path,
};

/// Time and size of a file; if one of them changes, so does the content.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct FileStamp {
    pub(super) modified: SystemTime,
    bytes: u64,
    /// Stamp of the JSON file beside a depth image, which may appear after the image.
    camera: Option<(SystemTime, u64)>,
}

/// Lists the files that may be captures, each with the time when its stamp was read: a look at a slow share takes seconds.
pub(super) fn look(folder: &Path) -> Result<Vec<(PathBuf, FileStamp, Instant)>, CaptureError> {
    let looked = || -> io::Result<Vec<(PathBuf, FileStamp, Instant)>> {
        let mut found = Vec::new();
        for entry in fs::read_dir(folder)? {
            let path = entry?.path();
            if !may_be_capture(&path) {
                continue;
            }
            // Skip files that have disappeared since they were listed.
            if let Some((modified, bytes)) = size_and_time(&path) {
                let seen_at = Instant::now();
                let is_image = path
                    .extension()
                    .is_some_and(|e| e.eq_ignore_ascii_case("png"));
                let camera = is_image.then(|| size_and_time(&intrinsics_path(&path)));
                let camera = camera.flatten();
                let seen = FileStamp {
                    modified,
                    bytes,
                    camera,
                };
                found.push((path, seen, seen_at));
            }
        }
        Ok(found)
    };
    looked().map_err(|source| {
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

/// Time and size of a file; `None` if it is not a regular file.
fn size_and_time(path: &Path) -> Option<(SystemTime, u64)> {
    let file = fs::metadata(path).ok().filter(fs::Metadata::is_file)?;
    Some((file.modified().ok()?, file.len()))
}
