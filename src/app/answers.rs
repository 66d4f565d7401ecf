//! What the threads answer goes to where it belongs.

use super::{
    action::{Effect, notify},
    job::{TaskOutcome, TaskResult},
    lane::TaskQueue,
    state::{Notice, NoticeKind, State},
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
        TaskEvent::Partly { outcome, .. } => take_in(state, outcome),
        TaskEvent::Done { outcome, .. } => {
            state.works.remove(&lane);
            take_in(state, outcome);
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
fn take_in(state: &mut State, outcome: TaskOutcome) {
    match outcome {
        Ok(TaskResult::Written(written)) => notify(state, Notice::done(written.what)),
        Err(trouble) => notify(state, trouble.into()),
    }
}
