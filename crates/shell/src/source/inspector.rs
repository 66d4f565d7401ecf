//! The task that inspects scenes, and the one that loads the library that they are compared with.

use std::{
    fs,
    path::PathBuf,
    sync::{Arc, Mutex},
};

use super::live::{FollowedParts, assign_as_before};
use crate::{
    inspection::{
        folder_watch::FolderWatch,
        inspected::{InspectJob, Inspected, inspect_all, inspect_scan},
        library_cache::{LibraryCache, LibraryView},
        scan::Steps,
        source::{Origin, ScanOrder},
    },
    session::{ReinspectionPurpose, Source},
    trace::current_trace::CurrentTrace,
};
use files::file_of;
use geometry::{clock, error::lock};
use records::history::{
    Filter, HistoryBuffer, HungId, InspectionSummary, StoredVerdict, Summary, Traceability,
};
use ui::{
    language::text,
    task::{Running, Task, TaskContext, TaskError, TaskRunner},
    user_error::UserError,
};

/// Captures, opens and inspects scenes, and loads the library.
#[derive(Debug)]
pub struct Inspector {
    pub(super) task: Task<InspectorResult>,
    /// Loads the library at the start, and again after another program has changed it.
    pub loader: LibraryLoader,
    pub(crate) library_cache: LibraryCache,
    /// Purpose of the newest run.
    pub(super) purpose: ReinspectionPurpose,
    /// Number of frames captured from the simulated cell.
    pub num_captures: u64,
    /// The source before the file or scan that is being opened; it is used again if that fails.
    pub former_source: Option<Source>,
    /// True while the window starts, when an opened file may show a part that was inspected before.
    pub is_start: bool,
    /// True if the running capture has ended Live and the operator is to be told once it is taken.
    pub(super) has_ended_live: bool,
}

/// Result of a run.
#[derive(Debug)]
pub(super) enum InspectorResult {
    /// The parts of a scene.
    Inspected(Vec<Arc<Inspected>>),
    /// The poses of these shots were not found: the user has to choose their file.
    PosesWanted(Box<ScanOrder>, UserError),
    /// The library now in use, and the folder that was chosen for it, if any.
    Library(Arc<LibraryView>, Option<PathBuf>),
}

impl Inspector {
    /// Makes the inspector before the first capture.
    pub fn new(runner: &TaskRunner, library_cache: &LibraryCache) -> Self {
        Self {
            task: Task::new("inspect", runner),
            loader: LibraryLoader::new(runner, library_cache),
            library_cache: library_cache.clone(),
            purpose: ReinspectionPurpose::New,
            num_captures: 0,
            former_source: None,
            is_start: false,
            has_ended_live: false,
        }
    }

    /// The running inspection, if any.
    pub fn running(&self) -> Option<&Running> {
        self.task.running()
    }

    /// True while nothing is inspected or loaded.
    pub fn is_idle(&self) -> bool {
        self.running().is_none() && self.loader.is_idle()
    }

    #[cfg(test)]
    pub fn run_waiting(&self) -> bool {
        self.task.run_waiting()
    }
}

/// Which hung part an inspection belongs to.
#[derive(Debug)]
pub(super) enum PartAtHand {
    /// Those that hang before the source, as Live saw them last. One without a verdict that counts, or a new one, takes the
    /// current serial number.
    Followed(Arc<Mutex<FollowedParts>>, CurrentTrace),
    /// This one, which is in the history.
    Known(HungId, Traceability),
    /// Those in front, inspected again.
    InFront(Vec<Arc<Inspected>>),
    /// A new one with this traceability.
    Past(Traceability),
    /// The one inspected before if the file is the same, else a new one, which takes the current serial number.
    MaybeSeen(CurrentTrace),
}

/// Runs the job of the task.
pub(super) fn run(
    job: &InspectJob,
    part: PartAtHand,
    library_cache: &LibraryCache,
    context: &TaskContext<InspectorResult>,
) -> Result<InspectorResult, TaskError> {
    let parts = match job {
        InspectJob::Scene(request) => inspect_all(request, library_cache, context)?,
        InspectJob::Scan(request) => {
            let report = |done, total| context.progress(done, total);
            match inspect_scan(request, library_cache, &Steps::new(context, &report))? {
                Ok(inspected) => vec![inspected],
                Err(error) if error.wants_poses() => {
                    let order = Box::new(request.order.clone());
                    return Ok(InspectorResult::PosesWanted(order, UserError::of(&error)));
                }
                Err(error) => return Err(UserError::of(&error).into()),
            }
        }
    };
    let parts = part.assigned(parts, library_cache.history());
    Ok(InspectorResult::Inspected(
        parts.into_iter().map(Arc::new).collect(),
    ))
}

impl PartAtHand {
    /// Gives every part of a frame its hung part. Of a frame in which a part from the history hung beside others, it leaves
    /// that one.
    fn assigned(self, mut parts: Vec<Inspected>, history: &HistoryBuffer) -> Vec<Inspected> {
        let mut summaries = parts.iter().map(|part| &part.entry.record.summary);
        let shows_any = summaries.any(|summary| summary.verdict != StoredVerdict::NoPart);
        match self {
            Self::Followed(followed, current) => {
                lock(&followed).assign_capture(&mut parts, &current);
            }
            Self::Known(hung, trace) => {
                let row = history.part(&hung).ok().flatten();
                let record = row.and_then(|row| history.row(row.number).ok().flatten());
                let index = record.map_or(0, |record| {
                    let found = parts.iter().map(|part| &part.inspection);
                    InspectionSummary::from(&record).index_in(found)
                });
                let mut known = parts.remove(index);
                known.set_part(hung, trace);
                return vec![known];
            }
            Self::InFront(former) => assign_as_before(&mut parts, former),
            Self::Past(trace) => all_new(&mut parts, &trace),
            Self::MaybeSeen(current) => {
                // With a serial number it is another part.
                let is_seen = !current.has_complete_serial();
                let mut taken = Vec::new();
                let mut trace = None;
                for part in &mut parts {
                    let seen = is_seen
                        .then(|| seen_before(part, &taken, history))
                        .flatten();
                    let (hung, trace) = if let Some(seen) = seen {
                        (seen.hung, seen.trace)
                    } else {
                        let trace = trace.get_or_insert_with(|| current.take(shows_any));
                        (part.hung().clone(), trace.clone())
                    };
                    taken.push(hung.clone());
                    part.set_part(hung, trace);
                }
            }
        }
        parts
    }
}

/// Makes each a new part with this traceability.
fn all_new(parts: &mut [Inspected], trace: &Traceability) {
    for part in parts {
        part.set_part(part.hung().clone(), trace.clone());
    }
}

/// Maximum number of history rows of one file to check, newest first.
const MAX_SEEN: usize = 20;

/// Finds the past inspection of the same file, if the file has not been written since and the verdict is the same. Starting
/// the window again does not mean that another part was hung. `taken` are the parts that others of the frame are.
fn seen_before(
    inspected: &Inspected,
    taken: &[HungId],
    history: &HistoryBuffer,
) -> Option<Summary> {
    let Origin::File { path, .. } = &inspected.origin else {
        return None;
    };
    let written = fs::metadata(file_of(path))
        .and_then(|file| file.modified())
        .ok()?;
    let written = clock::timestamp(written);
    let now = &inspected.entry.record.summary;
    let filter = Filter {
        since: Some(written),
        verdict: Some(now.verdict.into()),
        text: now.source.clone(),
        ..Filter::default()
    };
    let is_same = |row: &Summary| {
        row.source == now.source && row.title == now.title && !taken.contains(&row.hung)
    };
    // The History workspace reports why the history cannot be read.
    let page = history.page(&filter, 0, MAX_SEEN).ok()?;
    page.rows.into_iter().find(is_same)
}

/// Keeps the library in use in step with its folder.
#[derive(Debug)]
pub struct LibraryLoader {
    pub(super) loading: Task<Arc<LibraryView>>,
    pub(super) reloading: Task<Option<Arc<LibraryView>>>,
    pub(super) watch: FolderWatch,
    /// True if the folder has changed and the library is not reloaded yet.
    pub(super) is_changed: bool,
    /// False while a part is being enrolled, so that the library does not change meanwhile.
    pub may_reload: bool,
    pub(super) library_cache: LibraryCache,
}

impl LibraryLoader {
    /// Makes the loader without loading anything yet.
    pub(super) fn new(runner: &TaskRunner, library_cache: &LibraryCache) -> Self {
        Self {
            loading: Task::new("library", runner),
            reloading: Task::new("reload", runner),
            watch: FolderWatch::new("library-watch", runner),
            is_changed: false,
            may_reload: true,
            library_cache: library_cache.clone(),
        }
    }

    /// True while nothing is being loaded.
    pub(super) fn is_idle(&self) -> bool {
        self.loading.running().is_none() && self.reloading.running().is_none()
    }

    /// Loads the library, independently of the workspace in front and of the first scene.
    pub fn load(&mut self) {
        let library_cache = self.library_cache.clone();
        self.loading
            .start(text!("shell-loading-library"), move |_| {
                Ok(Arc::clone(&library_cache.get().shown))
            });
    }

    pub(super) fn reload(&mut self) {
        self.is_changed = false;
        let library_cache = self.library_cache.clone();
        self.reloading
            .start(text!("shell-reloading-library"), move |_| {
                let changed = library_cache.refresh();
                let changed = changed.map_err(|error| UserError::of(&error))?;
                Ok(changed.map(|loaded| Arc::clone(&loaded.shown)))
            });
    }
}
