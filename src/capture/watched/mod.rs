//! A folder to which another program saves captures.
//!
//! The folder is polled instead of relying on notifications by the system: polling works on every network share and USB
//! stick, and costs little. A file is captured once its size and time are the same in two successive looks. A file still
//! being written therefore waits, whether it grows in place or is renamed when complete. A file that cannot be read is
//! given more time before it is reported, because a writer may pause. A depth image waits for its intrinsics. A file that
//! is rewritten is a new capture. Hidden files, other endings and pictures other than depth images are ignored.
//!
//! Known limit: if a writer of a format without a length (XYZ) pauses for longer than [`LOOK`], the file is captured too
//! early; it is captured again when it is complete.

mod look;
#[cfg(test)]
mod tests;

use std::{
    collections::{BTreeMap, VecDeque},
    path::{Path, PathBuf},
    sync::Arc,
    thread,
    time::{Duration, Instant},
};

use jiff::Timestamp;

use self::look::{FileStamp, look};
use super::{
    error::CaptureError,
    read::read_image,
    source::{Captured, DepthSource, NextCapture, SkippedCapture},
    spec::{WatchedFrom, WatchedSpec},
};
use crate::files::{FileError, file_name, in_counting_order};

/// Pause between two looks.
const LOOK: Duration = Duration::from_millis(300);
/// After a look of a slow folder, the pause is at least this many times as long as the look.
const SHARE: u32 = 10;
/// Number of looks for which an unreadable file must stay the same before it is reported.
const PATIENCE: u32 = 10;

/// A folder to which another program saves captures.
pub struct WatchedFolder {
    folder: PathBuf,
    from: WatchedFrom,
    /// Every file ever seen. Files that disappear are kept: a share that comes back has the same files.
    files: BTreeMap<PathBuf, Watched>,
    has_looked: bool,
    next_look: Option<Instant>,
    /// Complete files that were not read yet, in order.
    ready: VecDeque<PathBuf>,
    number: u64,
}

/// State of a file in the folder.
#[derive(Clone, Copy, Debug)]
struct Watched {
    seen: FileStamp,
    /// When it was first seen with its present time of modification.
    first_seen: Instant,
    /// Number of looks for which it has stayed the same.
    same: u32,
    state: Progress,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Progress {
    /// It is changing, or may be.
    Waiting,
    /// It seemed complete but could not be read; it may be readable later.
    Doubtful,
    /// Captured, reported, or not wanted.
    Done,
}

impl WatchedFolder {
    /// Watches a folder, which need not exist yet.
    pub fn new(spec: &WatchedSpec) -> Self {
        Self {
            folder: spec.folder.clone(),
            from: spec.from,
            files: BTreeMap::new(),
            has_looked: false,
            next_look: None,
            ready: VecDeque::new(),
            number: 0,
        }
    }

    /// Looks once, and queues files that are complete now.
    fn look(&mut self) -> Result<(), CaptureError> {
        let found = look(&self.folder)?;
        let is_first = !self.has_looked;
        self.has_looked = true;
        let mut ready = Vec::new();
        for (path, seen, seen_at) in found {
            let file = self.files.entry(path.clone()).or_insert(Watched {
                seen,
                first_seen: seen_at,
                same: 0,
                state: if is_first && self.from == WatchedFrom::Now {
                    Progress::Done
                } else {
                    Progress::Waiting
                },
            });
            if file.seen != seen {
                let is_same_time = file.seen.modified == seen.modified;
                *file = Watched {
                    seen,
                    first_seen: if is_same_time {
                        file.first_seen
                    } else {
                        seen_at
                    },
                    same: 0,
                    state: Progress::Waiting,
                };
                continue;
            }
            let is_due = match file.state {
                Progress::Waiting => file.same >= 1,
                // Read it again only at the end of the patience.
                Progress::Doubtful => file.same == PATIENCE,
                Progress::Done => false,
            };
            file.same = file.same.saturating_add(1);
            if is_due && !self.ready.contains(&path) {
                ready.push((seen.modified, in_counting_order(&file_name(&path)), path));
            }
        }
        ready.sort();
        self.ready
            .extend(ready.into_iter().map(|(_, _, path)| path));
        Ok(())
    }

    /// Reads a complete file; `None` if there is nothing to report, or not yet.
    fn take(&mut self, path: &Path) -> Option<NextCapture> {
        let read = read_image(path);
        let file = self.files.get_mut(path)?;
        let is_last_try = file.state == Progress::Doubtful;
        let error = match read {
            Ok((image, warnings)) => {
                file.state = Progress::Done;
                self.number += 1;
                // If it was written again since it was seen, it is captured again.
                let written = Timestamp::try_from(file.seen.modified);
                return Some(NextCapture::Captured(Captured {
                    taken_at: written.unwrap_or_else(|_| Timestamp::now()),
                    arrived: file.first_seen,
                    warnings,
                    ..Captured::now(self.number, file_name(path), image)
                }));
            }
            Err(error) => error,
        };
        match &error {
            // A preview image beside a cloud, if the folder has delivered clouds.
            CaptureError::File(FileError::WrongPngKind { .. }) if self.number > 0 => {
                file.state = Progress::Done;
                None
            }
            // It disappeared before it was read; the share may come back with it.
            CaptureError::File(FileError::NotFound { .. }) => {
                file.state = Progress::Waiting;
                file.same = 0;
                None
            }
            _ if is_last_try => {
                file.state = Progress::Done;
                Some(NextCapture::Skipped(SkippedCapture {
                    name: file_name(path),
                    error: Arc::new(error),
                }))
            }
            _ => {
                file.state = Progress::Doubtful;
                None
            }
        }
    }
}

impl DepthSource for WatchedFolder {
    fn title(&self) -> String {
        format!("Folder {}", self.folder.display())
    }

    fn is_simulated(&self) -> bool {
        false
    }

    fn next(&mut self, wait: Duration) -> Result<NextCapture, CaptureError> {
        let until = Instant::now() + wait;
        loop {
            while let Some(path) = self.ready.pop_front() {
                if let Some(next) = self.take(&path) {
                    return Ok(next);
                }
            }
            let now = Instant::now();
            let due = *self.next_look.get_or_insert(now);
            if due > until {
                thread::sleep(until.saturating_duration_since(now));
                return Ok(NextCapture::NotYet);
            }
            thread::sleep(due.saturating_duration_since(now));
            let begun = Instant::now();
            if let Err(error) = self.look() {
                // The caller determines when to look again after an error.
                self.next_look = None;
                return Err(error);
            }
            self.next_look = Some(Instant::now() + LOOK.max(begun.elapsed() * SHARE));
            if self.ready.is_empty() && Instant::now() >= until {
                return Ok(NextCapture::NotYet);
            }
        }
    }
}
