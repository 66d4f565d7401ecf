//! A folder that another program saves captures into.
//!
//! The folder is looked at again and again rather than having the system tell of changes: that works on every network
//! share and stick, and a look costs little. A file is taken once it has had the same size and time at two looks, so a
//! file that is still being written waits, whether it grows in place or is renamed when complete. A file that cannot be
//! read is given more time before it is named: a writer may pause. A depth image waits for its intrinsics. A file that
//! is written again is a new capture. Hidden files, other endings and pictures that are no depth images are left alone.
//!
//! Known limit: a writer of a format without a length in it (XYZ) that pauses for longer than [`LOOK`] is taken too
//! early; the capture is taken again when the file is complete.

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
    read::{read_image, written_at},
    source::{Captured, DepthSource, NextCapture, SkippedCapture},
    spec::{WatchedFrom, WatchedSpec},
};
use crate::files::{FileError, file_name, in_counting_order};

/// The pause between two looks.
const LOOK: Duration = Duration::from_millis(300);
/// A slow folder is not looked at more than one part in so many of the time.
const SHARE: u32 = 10;
/// Looks at which an unreadable file must have been the same before it is named.
const PATIENCE: u32 = 10;

/// A folder that another program saves captures into.
pub struct WatchedFolder {
    folder: PathBuf,
    from: WatchedFrom,
    /// Every file that was ever seen. Kept also when it is gone: a share that comes back brings the same files.
    files: BTreeMap<PathBuf, Watched>,
    has_looked: bool,
    next_look: Option<Instant>,
    /// Complete, and not taken yet, in order.
    ready: VecDeque<PathBuf>,
    number: u64,
}

/// A file of the folder.
#[derive(Clone, Copy, Debug)]
struct Watched {
    seen: FileStamp,
    /// Looks at which it was the same.
    same: u32,
    state: Progress,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Progress {
    /// It changes, or may.
    Waiting,
    /// It was complete, and could not be read; it may be still.
    Doubtful,
    /// Taken, named, or not wanted.
    Done,
}

impl WatchedFolder {
    /// Watches a folder; it need not be there yet.
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

    /// Looks once, and queues what is complete now.
    fn look(&mut self) -> Result<(), CaptureError> {
        let found = look(&self.folder)?;
        let is_first = !self.has_looked;
        self.has_looked = true;
        let mut ready = Vec::new();
        for (path, seen) in found {
            let file = self.files.entry(path.clone()).or_insert(Watched {
                seen,
                same: 0,
                state: if is_first && self.from == WatchedFrom::Now {
                    Progress::Done
                } else {
                    Progress::Waiting
                },
            });
            if file.seen != seen {
                *file = Watched {
                    seen,
                    same: 0,
                    state: Progress::Waiting,
                };
                continue;
            }
            let is_due = match file.state {
                Progress::Waiting => file.same >= 1,
                // Read again at the end of the patience only.
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

    /// Reads a file that is complete; `None` if there is nothing to say of it, or not yet.
    fn take(&mut self, path: &Path) -> Option<NextCapture> {
        let read = read_image(path);
        let file = self.files.get_mut(path)?;
        let is_last_try = file.state == Progress::Doubtful;
        let error = match read {
            Ok((image, warnings)) => {
                file.state = Progress::Done;
                self.number += 1;
                return Some(NextCapture::Captured(Captured {
                    number: self.number,
                    name: file_name(path),
                    taken_at: written_at(path).unwrap_or_else(Timestamp::now),
                    arrived: Instant::now(),
                    is_simulated: image.is_simulated(),
                    image,
                    truth: None,
                    robot_from_flange: None,
                    warnings,
                }));
            }
            Err(error) => error,
        };
        match &error {
            // A preview beside a cloud, or gone again before it was read.
            CaptureError::File(FileError::WrongPngKind { .. } | FileError::NotFound { .. }) => {
                file.state = Progress::Done;
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
                // Whoever asks again has waited as long as he thinks fit.
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
