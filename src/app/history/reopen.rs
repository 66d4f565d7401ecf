//! Past inspections made again: opened with every stage, or held against what is found today.

use std::sync::Arc;

use super::{
    apply::keep,
    state::{Purpose, Remaking, look},
    work::LookedAt,
};
use crate::{
    app::{
        action::{Effect, notify},
        inspect::work::{InspectRequest, Inspected},
        job::Request,
        live,
        source::{KeptScene, Origin, SceneSource},
        state::{Notice, NoticeKind, Shown, State, Workspace},
    },
    history::{Differences, Finding, Record},
};

/// Shows an inspection with every stage: as it is in memory, else made again with its own recipe.
pub(super) fn open(state: &mut State, number: i64) -> Option<Effect> {
    if let Some(inspected) = state.history.whole(number).cloned() {
        state.generation += 1;
        state.candidate = 0;
        state.shown = Some(Shown {
            generation: state.generation,
            inspected,
            is_past: true,
            session: None,
        });
        state.workspace = Workspace::Inspect;
        return live::give_way(state);
    }
    remake(state, number, Purpose::Open)
}

/// Inspects its scene again with the recipe and the library now in use.
pub(super) fn inspect_again(state: &mut State, number: i64) -> Option<Effect> {
    remake(state, number, Purpose::Compare)
}

/// Makes again what was waited for.
pub(super) fn go_on(state: &mut State) -> Option<Effect> {
    let (number, purpose) = state.history.then.take()?;
    state.history.looked_at_as(number)?;
    remake(state, number, purpose)
}

fn remake(state: &mut State, number: i64, purpose: Purpose) -> Option<Effect> {
    let Some(past) = state.history.looked_at_as(number).cloned() else {
        // Once it is there.
        state.history.selected = Some(number);
        state.history.then = Some((number, purpose));
        return Some(look(state));
    };
    let scene = &past.record.summary.scene;
    let Some(source) = source_of(state, &past.record) else {
        let notice = Notice {
            kind: NoticeKind::Look,
            what: format!("The frame of {scene} is not kept"),
            advice: "Keep more frames from now on: Frames… above the list".into(),
        };
        notify(state, notice);
        return None;
    };
    let (what, recipe) = match purpose {
        Purpose::Compare => (
            format!("Inspecting {scene} again"),
            Some(Arc::clone(&state.recipe)),
        ),
        Purpose::Open => (
            format!("Opening {scene}"),
            past.record.detail.recipe.clone(),
        ),
    };
    let Some(recipe) = recipe else {
        let notice = Notice {
            kind: NoticeKind::Look,
            what: format!("The recipe of {scene} was written by another version of Partsight"),
            advice: "Press Inspect again to use the recipe of today".into(),
        };
        notify(state, notice);
        return None;
    };
    if purpose == Purpose::Open {
        state.workspace = Workspace::Inspect;
    }
    let request = Request::Inspect(InspectRequest { source, recipe });
    let effect = state.begin(what, request);
    state.history.remaking = Some(Remaking {
        generation: state.generation,
        past,
        purpose,
    });
    Some(effect)
}

/// Where its scene can be had: in memory, among the kept frames, or where it came from.
fn source_of(state: &State, record: &Record) -> Option<SceneSource> {
    let history = &state.history;
    if let Some(whole) = history.whole(record.summary.number) {
        let scene = Arc::clone(&whole.scene);
        return Some(SceneSource::AtHand(scene, whole.origin.clone()));
    }
    let origin = origin_of(record);
    if let (Some(frame), Some(folder)) = (&record.detail.frame, &history.frames) {
        return Some(SceneSource::Kept(Box::new(KeptScene {
            folder: folder.clone(),
            frame: frame.clone(),
            origin,
        })));
    }
    origin.source()
}

/// As the window wrote it; a command writes none.
fn origin_of(record: &Record) -> Origin {
    let written = record.detail.origin.as_deref();
    let written = written.and_then(|origin| serde_json::from_str(origin).ok());
    written.unwrap_or_else(|| Origin::Frame {
        name: record.summary.scene.clone(),
        is_simulated: record.summary.is_simulated,
    })
}

/// What a new result is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TakenIn {
    /// An inspection of its own.
    New,
    /// A past one that was asked for again.
    Past,
}

/// Takes in a new result: a past one that was made again, or one to be written.
pub fn take_in(
    state: &mut State,
    generation: u64,
    inspected: &Arc<Inspected>,
) -> (TakenIn, Option<Effect>) {
    let history = &mut state.history;
    if history.repeated == Some(generation) {
        history.repeated = None;
        return (TakenIn::New, None);
    }
    let remaking = history.remaking.take_if(|of| of.generation == generation);
    let Some(remaking) = remaking else {
        let effect = keep(state, inspected);
        return (TakenIn::New, Some(effect));
    };
    let differences = differences(&remaking.past, inspected);
    match remaking.purpose {
        Purpose::Compare => {
            let number = remaking.past.record.summary.number;
            history.differences = Some((number, differences));
        }
        Purpose::Open if differences.is_same() => {}
        Purpose::Open => {
            let notice = other_result(&remaking.past.record, &differences);
            notify(state, notice);
        }
    }
    (TakenIn::Past, None)
}

fn differences(past: &LookedAt, inspected: &Inspected) -> Differences {
    let now = Finding::of(
        &inspected.inspection,
        &inspected.entry.record.detail.recipe_identity,
        &inspected.library.identity,
    );
    Differences::between(Finding::from(&past.record), now, inspected.middle)
}

fn other_result(record: &Record, differences: &Differences) -> Notice {
    let causes = differences.causes();
    let cause = match causes.as_slice() {
        [] => "its file or frame".to_owned(),
        causes => format!("the {}", causes.join(" and the ")),
    };
    Notice {
        kind: NoticeKind::Look,
        what: format!(
            "{} gives another result than it did: {cause} has changed since",
            record.summary.scene
        ),
        advice: "The history keeps the first result".into(),
    }
}
