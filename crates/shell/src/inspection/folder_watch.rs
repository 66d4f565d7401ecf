//! Detects changes by other programs in a folder of entries, such as a command that changes the library or the recipes.
//!
//! A thread checks names, sizes and times of the visible entries every two seconds. Files are replaced as a whole, never
//! overwritten, so that the time of an entry that is a folder changes with every file in it.

use std::{
    ffi::{OsStr, OsString},
    fs,
    path::{Path, PathBuf},
    thread,
    time::{Duration, SystemTime},
};

use ui::{
    language::text,
    task::{Task, TaskContext, TaskError, TaskRunner},
};

/// Interval for checking cancellation.
const POLL_INTERVAL: Duration = Duration::from_millis(100);
/// Number of these between two checks of the folder.
const NUM_POLLS: usize = 20;

/// Watches one folder.
#[derive(Debug)]
pub struct FolderWatch {
    task: Task<()>,
    folder: Option<PathBuf>,
}

impl FolderWatch {
    /// Makes a watch without a folder. `name` becomes the name of the thread.
    pub fn new(name: &'static str, runner: &TaskRunner) -> Self {
        Self {
            task: Task::new(name, runner),
            folder: None,
        }
    }

    /// Watches this folder from now on.
    pub fn watch(&mut self, folder: &Path) {
        if self.folder.as_deref() != Some(folder) {
            self.folder = Some(folder.to_owned());
            let folder = folder.to_owned();
            let watch = move |context: &_| watch(&folder, context);
            self.task.start(text!("inspect-watching-folder"), watch);
        }
    }

    /// True if the folder has changed since the last call, and once after the watch began.
    pub fn has_changed(&mut self) -> bool {
        self.task.poll().is_some()
    }
}

fn watch(folder: &Path, context: &TaskContext<()>) -> Result<(), TaskError> {
    let mut before = entries(folder);
    // The folder may have changed since its content was loaded.
    context.latest(());
    loop {
        for _ in 0..NUM_POLLS {
            context.check()?;
            thread::sleep(POLL_INTERVAL);
        }
        let now = entries(folder);
        if now != before {
            before = now;
            context.latest(());
        }
    }
}

/// Name, size and time of an entry.
pub(super) type Entry = (OsString, u64, Option<SystemTime>);

/// Some disks, such as memory sticks, date their entries in steps of 2 s.
const SETTLED: Duration = Duration::from_secs(3);

/// True if every entry is so old that a later change shows in its time.
pub(super) fn are_settled(entries: &[Entry]) -> bool {
    let is_settled = |changed: SystemTime| changed.elapsed().is_ok_and(|age| age > SETTLED);
    entries
        .iter()
        .all(|(_, _, changed)| changed.is_some_and(is_settled))
}

/// Lists the visible entries, sorted by name; none if the folder cannot be read.
pub(super) fn entries(folder: &Path) -> Vec<Entry> {
    let found = fs::read_dir(folder).into_iter().flatten().flatten();
    let is_visible = |name: &OsStr| {
        let name = name.as_encoded_bytes();
        // SQLite's shared memory file changes even when the database is only read.
        !name.starts_with(b".") && !name.ends_with(b"-shm")
    };
    let visible = found.filter(|entry| is_visible(&entry.file_name()));
    let mut entries: Vec<Entry> = visible
        .map(|entry| {
            let found = fs::metadata(entry.path()).ok();
            let size = found.as_ref().map_or(0, fs::Metadata::len);
            let changed = found.and_then(|found| found.modified().ok());
            (entry.file_name(), size, changed)
        })
        .collect();
    entries.sort();
    entries
}
