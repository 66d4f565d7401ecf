//! A folder to which another program saves captures.
//!
//! The folder is polled instead of relying on notifications by the system: polling works on every network share and USB
//! stick, and costs little. A file is captured once its size and time are the same in two successive looks. A file still
//! being written therefore waits, whether it grows in place or is renamed when complete. A file that cannot be read is
//! given more time before it is reported, because a writer may pause. A depth image waits for its intrinsics. A file that
//! is rewritten is a new capture. Hidden files, other endings and pictures other than depth images are ignored.
//!
//! Each look lists the names, and reads size and time of new files, of those that are not done, and of those that were
//! rewritten before. The others take turns, [`MAX_RECHECKED`] in a look, so that a new file is found as fast beside many old
//! ones.
//!
//! Known limit: if a writer of a format without a length (XYZ) pauses for longer than [`LOOK_INTERVAL`], the file is captured too
//! early; it is captured again when it is complete.

mod look;
#[cfg(test)]
mod tests;

use std::{
    collections::{BTreeMap, VecDeque},
    ffi::OsString,
    mem,
    path::{Path, PathBuf},
    sync::Arc,
    thread,
    time::{Duration, Instant},
};

use self::look::{FileStamp, list, stamp};
use super::{
    error::CaptureError,
    read::read_image,
    source::{Captured, DepthSource, NextCapture, SkippedCapture},
    spec::{WatchedFrom, WatchedSpec},
};
use files::{FileError, file_name, in_counting_order};
use geometry::clock;

/// Pause between two looks.
const LOOK_INTERVAL: Duration = Duration::from_millis(300);
/// After a look of a slow folder, the pause is at least this many times as long as the look.
const MIN_PAUSE_PER_LOOK: u32 = 10;
/// Number of files that are done and whose size and time are read again in one look.
const MAX_RECHECKED: usize = 1000;
/// Number of looks for which an unreadable file must stay the same before it is reported.
const MAX_UNREADABLE_LOOKS: u32 = 10;

/// A folder to which another program saves captures.
pub struct WatchedFolder {
    folder: PathBuf,
    from: WatchedFrom,
    /// Every file ever seen, by its name. Files that disappear are kept: a share that comes back has the same files.
    files: BTreeMap<OsString, Watched>,
    has_looked: bool,
    num_looks: usize,
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
    /// True if it has changed after it was done.
    is_rewritten: bool,
    /// Its number among all files, which determines its turn.
    number: usize,
    /// The last look that listed it.
    listed: usize,
}

impl Watched {
    /// Notes that a look has listed the file; true if its size and time are to be read.
    fn is_due(&mut self, look: usize, num_turns: usize) -> bool {
        // After it was away, it may be another file.
        let was_listed = mem::replace(&mut self.listed, look) + 1 == look;
        let is_its_turn = (self.number + look).is_multiple_of(num_turns);
        self.state != Progress::Done || self.is_rewritten || !was_listed || is_its_turn
    }
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
            num_looks: 0,
            next_look: None,
            ready: VecDeque::new(),
            number: 0,
        }
    }

    /// Looks once, and queues files that are complete now. Returns the number of files whose size and time were read.
    fn look(&mut self) -> Result<usize, CaptureError> {
        self.num_looks += 1;
        let names = list(&self.folder)?;
        let is_first = !mem::replace(&mut self.has_looked, true);
        let num_turns = names.len().div_ceil(MAX_RECHECKED).max(1);
        let (mut ready, mut num_read) = (Vec::new(), 0);
        for name in names {
            let known = self.files.get_mut(&name);
            if known.is_some_and(|file| !file.is_due(self.num_looks, num_turns)) {
                continue;
            }
            let path = self.folder.join(&name);
            num_read += 1;
            // Skip files that have disappeared since they were listed.
            let Some(seen) = stamp(&path) else {
                continue;
            };
            // A look at a slow share takes seconds.
            let seen_at = Instant::now();
            let number = self.files.len();
            let file = self.files.entry(name).or_insert(Watched {
                seen,
                first_seen: seen_at,
                same: 0,
                state: if is_first && self.from == WatchedFrom::Now {
                    Progress::Done
                } else {
                    Progress::Waiting
                },
                is_rewritten: false,
                number,
                listed: self.num_looks,
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
                    is_rewritten: file.is_rewritten || file.state == Progress::Done,
                    ..*file
                };
                continue;
            }
            let is_due = match file.state {
                Progress::Waiting => file.same >= 1,
                // Read it again only at the end of the patience.
                Progress::Doubtful => file.same == MAX_UNREADABLE_LOOKS,
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
        Ok(num_read)
    }

    /// Reads a complete file; `None` if there is nothing to report, or not yet.
    fn take(&mut self, path: &Path) -> Option<NextCapture> {
        let read = read_image(path);
        let file = self.files.get_mut(path.file_name()?)?;
        let is_last_try = file.state == Progress::Doubtful;
        let error = match read {
            Ok((image, warnings)) => {
                file.state = Progress::Done;
                self.number += 1;
                // If it was written again since it was seen, it is captured again.
                return Some(NextCapture::Captured(Captured {
                    taken_at: clock::timestamp(file.seen.modified),
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
            let (begun, is_first) = (Instant::now(), !self.has_looked);
            if let Err(error) = self.look() {
                // The caller determines when to look again after an error.
                self.next_look = None;
                return Err(error);
            }
            // The first look reads size and time of every file, and is the only one that does.
            let share = if is_first { 0 } else { MIN_PAUSE_PER_LOOK };
            self.next_look = Some(Instant::now() + LOOK_INTERVAL.max(begun.elapsed() * share));
            if self.ready.is_empty() && Instant::now() >= until {
                return Ok(NextCapture::NotYet);
            }
        }
    }
}
