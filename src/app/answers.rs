//! What the threads answer goes to where it belongs.

use std::{
    path::{Path, PathBuf},
    sync::Arc,
};

use super::{
    action::{Effect, inspect_again, notify},
    inspect::{scan, work::Inspected},
    job::{TaskOutcome, TaskResult, Trouble},
    lane::TaskQueue,
    live,
    shelf::LibraryView,
    source::Origin,
    state::{Event, Notice, NoticeKind, ReinspectionPurpose, Shown, Source, State},
    worker::TaskEvent,
};

/// Takes in what a thread tells, unless it is about something that nobody waits for any more.
pub(super) fn hear(
    state: &mut State,
    lane: TaskQueue,
    news: TaskEvent<TaskOutcome>,
) -> Option<Effect> {
    let of = news.generation();
    let work = state.works.get_mut(&lane);
    let work = work.filter(|work| work.generation == of)?;
    match news {
        TaskEvent::Begins { stage, .. } => work.stage = Some(stage),
        TaskEvent::Progress { done, total, .. } => work.progress = Some((done, total)),
        TaskEvent::Partly { outcome, .. } => return take_in(state, lane, of, outcome),
        TaskEvent::Done { outcome, .. } => {
            state.works.remove(&lane);
            return take_in(state, lane, of, outcome);
        }
        TaskEvent::Panicked { message, .. } => {
            state.works.remove(&lane);
            let broke_off = Notice {
                kind: NoticeKind::Look,
                what: format!("The work broke off inside the program: {message}"),
                advice: "Try again; if it happens again, keep the file and report it".into(),
            };
            notify(state, broke_off);
        }
    }
    None
}

/// What came out goes to where it belongs.
fn take_in(
    state: &mut State,
    lane: TaskQueue,
    generation: u64,
    outcome: TaskOutcome,
) -> Option<Effect> {
    match outcome {
        Ok(TaskResult::Inspected(inspected)) => return Some(show(state, generation, inspected)),
        Ok(TaskResult::PosesWanted(order, trouble)) => {
            return Some(scan::ask_for_poses(state, *order, trouble));
        }
        Ok(TaskResult::Live(answer)) => return live::hear(state, Ok(answer)),
        Ok(TaskResult::Library(library)) => {
            use_library(state, &library);
            return inspect_again(state);
        }
        Ok(TaskResult::Written(written)) => notify(state, Notice::done(written.what)),
        Err(trouble) => {
            notify(state, trouble.clone().into());
            match lane {
                TaskQueue::Inspect => without_scene(state),
                TaskQueue::Live => return live::hear(state, Err(trouble)),
                TaskQueue::Write => {}
            }
        }
    }
    None
}

/// A file that could not be inspected is no recent one.
fn without_scene(state: &mut State) {
    let session = &mut state.session;
    if let Source::File(path) = &session.source {
        session.recent.retain(|known| known != path);
    }
}

fn show(state: &mut State, generation: u64, inspected: Arc<Inspected>) -> Effect {
    for warning in &inspected.warnings {
        notify(state, Trouble::of(warning).into());
    }
    use_library(state, &inspected.library);
    let shots = inspected.scan.as_ref();
    if let Origin::File { path, .. } = &inspected.origin {
        remember(&mut state.recent, path);
    } else if let Some(folder) = shots.and_then(|scan| scan.fused.choice.set.files.folder()) {
        remember(&mut state.recent, folder);
    }
    for warning in shots.map_or(&[][..], |scan| &scan.fused.warnings) {
        notify(state, warning.clone().into());
    }
    let former = state.shown.as_ref();
    let former = former.and_then(|shown| Some(shown.inspected.scan.as_ref()?.fused.choice.clone()));
    let (of, purpose) = state.purpose;
    let purpose = if of == generation {
        purpose
    } else {
        ReinspectionPurpose::New
    };
    state.candidate = 0;
    state.shown = Some(Shown {
        generation,
        inspected: Arc::clone(&inspected),
        is_past: purpose == ReinspectionPurpose::Past,
        session: None,
    });
    scan::settle(state, former);
    Effect::Tell(Event::Inspected { inspected, purpose })
}

/// From now on this library is shown; what had to be set aside in it is said once.
pub(super) fn use_library(state: &mut State, library: &Arc<LibraryView>) {
    let is_other = |known: &Arc<_>| !Arc::ptr_eq(known, library);
    if state.library.as_ref().is_none_or(is_other) {
        for trouble in library.troubles.clone() {
            notify(state, trouble.into());
        }
        state.library = Some(Arc::clone(library));
    }
}

/// More files than this nobody looks through.
const MAX_RECENT: usize = 8;

/// Puts a file first among the recent ones.
fn remember(recent: &mut Vec<PathBuf>, path: &Path) {
    recent.retain(|known| known != path);
    recent.insert(0, path.to_owned());
    recent.truncate(MAX_RECENT);
}
