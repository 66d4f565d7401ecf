//! The trash of a library: removed and replaced parts, in folders named after part and time.

use std::{
    fs, io,
    path::{Path, PathBuf},
};

use super::{error::LibraryError, name::PartName, store::LibraryFolder};
use files::disk;

/// Name of the trash folder within the library.
pub(super) const TRASH: &str = ".trash";

/// A part in the trash.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TrashEntry {
    /// Name of the part.
    pub name: PartName,
    /// Path in the trash; [`LibraryFolder::restore`] restores it.
    pub kept: PathBuf,
    /// Timestamp to the second, and a counter within that second.
    order: (String, u32),
}

impl LibraryFolder {
    /// Returns all parts that can be restored, newest first; empty if there is no trash.
    pub fn trashed(&self) -> Result<Vec<TrashEntry>, LibraryError> {
        let list = || -> io::Result<Vec<TrashEntry>> {
            let found = match fs::read_dir(self.path().join(TRASH)) {
                Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(Vec::new()),
                found => found?,
            };
            let mut all = Vec::new();
            for found in found {
                all.extend(trashed(found?.path()));
            }
            all.sort_by(|a, b| b.order.cmp(&a.order).then_with(|| a.name.cmp(&b.name)));
            Ok(all)
        };
        list().map_err(|source| LibraryError::Unreadable {
            path: self.path().to_owned(),
            source,
        })
    }
}

/// Moves a folder of the library into the trash. Returns its path there.
pub(super) fn move_in(library: &Path, folder: &Path, name: &str) -> io::Result<PathBuf> {
    let trash = library.join(TRASH);
    disk::create_dir_all(&trash)?;
    let now = geometry::clock::now().strftime("%Y%m%dT%H%M%SZ");
    let place = (1..=9999)
        .map(|n| match n {
            1 => trash.join(format!("{name}-{now}")),
            n => trash.join(format!("{name}-{now}-{n}")),
        })
        .find(|place| !place.exists())
        .ok_or(io::ErrorKind::AlreadyExists)?;
    disk::rename(folder, &place)?;
    Ok(place)
}

/// Returns the name of the part at this path in the trash; `None` if there is none.
pub(super) fn name_of(library: &Path, kept: &Path) -> Option<PartName> {
    let is_inside = kept.parent() == Some(library.join(TRASH).as_path());
    let found = trashed(kept.to_owned()).filter(|_| is_inside)?;
    Some(found.name)
}

fn trashed(kept: PathBuf) -> Option<TrashEntry> {
    let file_name = kept.file_name()?.to_str()?;
    // Names of parts have no capitals, so this separates the timestamp from the name.
    let (name, stamp, count) = file_name.match_indices('-').find_map(|(at, _)| {
        let mut rest = file_name[at + 1..].splitn(2, '-');
        let stamp = rest.next().filter(|stamp| is_stamp(stamp))?;
        let count = rest.next().map_or(Some(1), |n| n.parse().ok())?;
        Some((&file_name[..at], stamp, count))
    })?;
    let (name, order) = (PartName::new(name).ok()?, (stamp.to_owned(), count));
    kept.is_dir().then_some(TrashEntry { name, kept, order })
}

/// Returns whether a text is a timestamp such as `20260102T030405Z`.
fn is_stamp(text: &str) -> bool {
    text.len() == 16
        && text.bytes().enumerate().all(|(i, byte)| match i {
            8 => byte == b'T',
            15 => byte == b'Z',
            _ => byte.is_ascii_digit(),
        })
}
