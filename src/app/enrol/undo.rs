//! What was done, to be taken back and done again, in its order; and the changes of the library among it.

use std::{mem, sync::Arc};

use super::{
    change::{Changed, LibraryChange},
    draft::Draft,
    selection::Corrections,
    state::{LastChangedPart, open, select, words_of},
    work::EnrolRequest,
};
use crate::app::{
    action::{Effect, notify},
    answers::use_library,
    inspect::work::InspectRequest,
    job::Request,
    lane::TaskQueue,
    shots::{inspection_again, inspection_of},
    source::SceneSource,
    state::{Notice, NoticeKind, State},
};

/// What can be taken back, and what was taken back and can be done again; the latest last.
#[derive(Debug, Default)]
pub struct UndoStack {
    /// What was done.
    pub done: Vec<UndoStep>,
    /// What was taken back.
    pub undone: Vec<UndoStep>,
}

/// How to get from here to what was before, or back again.
#[derive(Clone, Debug)]
pub enum UndoStep {
    /// The corrections of the draft of this number as they were.
    Corrections(u64, Corrections),
    /// The draft as it was.
    Draft(Option<Box<Draft>>),
    /// A change of the library.
    Library(LibraryStep),
}

impl UndoStep {
    fn is_scan(&self) -> bool {
        match self {
            Self::Draft(Some(draft)) => draft.subject.scan().is_some(),
            Self::Draft(None) | Self::Corrections(..) | Self::Library(_) => false,
        }
    }
}

/// A change of the library.
#[derive(Clone, Debug)]
pub struct LibraryStep {
    /// The change to be made.
    pub change: LibraryChange,
    /// What was done first, in words.
    pub what: String,
    /// What becomes of the draft by it.
    pub draft: DraftEffect,
}

/// What becomes of the draft when a step is made.
#[derive(Clone, Debug)]
pub enum DraftEffect {
    /// It stays.
    Stays,
    /// It makes way for this one: a saved draft goes, and comes back when the saving is taken back.
    MakesWay(Option<Box<Draft>>),
}

/// Which way a step is made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UndoDirection {
    /// For the first time.
    First,
    /// Taken back.
    Back,
    /// Done again.
    Again,
}

/// More steps than this are forgotten, the oldest first.
const MAX_STEPS: usize = 100;
/// The same of drafts that are scans: each holds about a hundred megabytes.
const MAX_SCANS: usize = 4;

impl UndoStack {
    /// Something was done for the first time: what was taken back before can no longer be done again.
    pub fn push(&mut self, back: UndoStep) {
        self.undone.clear();
        self.done.push(back);
        if self.done.len() > MAX_STEPS {
            self.done.remove(0);
        }
        let scans = self.done.iter().enumerate().rev();
        let mut scans = scans.filter(|(_, step)| step.is_scan());
        if let Some((oldest, _)) = scans.nth(MAX_SCANS) {
            self.done.drain(..=oldest);
        }
    }

    /// The list that the next step that way is taken from.
    pub fn from(&mut self, way: UndoDirection) -> &mut Vec<UndoStep> {
        match way {
            UndoDirection::First | UndoDirection::Back => &mut self.done,
            UndoDirection::Again => &mut self.undone,
        }
    }

    /// The list that the way back is put into.
    pub fn to(&mut self, way: UndoDirection) -> &mut Vec<UndoStep> {
        match way {
            UndoDirection::Back => &mut self.undone,
            UndoDirection::First | UndoDirection::Again => &mut self.done,
        }
    }
}

/// Has the library changed for the first time; one change at a time.
pub(super) fn change(
    state: &mut State,
    change: LibraryChange,
    draft: DraftEffect,
) -> Option<Effect> {
    let step = LibraryStep {
        change,
        what: String::new(),
        draft,
    };
    start_change(state, UndoDirection::First, step)
}

fn start_change(state: &mut State, way: UndoDirection, step: LibraryStep) -> Option<Effect> {
    if state.is_changing_library() {
        return None;
    }
    let request = EnrolRequest::Change(step.change.clone());
    state.enrol.pending = Some((way, step));
    Some(state.begin("Changing the library", Request::Enrol(request)))
}

/// The library is another one now: what was made by it shows it.
pub(super) fn changed_library(state: &mut State, changed: Changed) -> Option<Effect> {
    let Changed {
        what,
        back,
        name,
        library,
    } = changed;
    let (way, mut step) = state.enrol.pending.take()?;
    use_library(state, &library);
    dismiss_undo_notices(state);
    track_replaced_part(state, &step.change);
    state.enrol.num_changes += 1;
    state.enrol.latest = name.clone().map(|name| LastChangedPart {
        name,
        what: match &step.change {
            LibraryChange::Rename(..) => "Just renamed",
            LibraryChange::Restore(_) => "Just brought back",
            LibraryChange::Save(..) | LibraryChange::Remove(_) => "Just saved",
            LibraryChange::ReadPath(..) | LibraryChange::SetPath(..) => "Path changed",
        },
    });
    step.change = back;
    let notice = match way {
        UndoDirection::First => {
            step.what.clone_from(&what);
            state.enrol.steps.undone.clear();
            Notice::undoable(what)
        }
        UndoDirection::Back => Notice::done(format!("Undone: {}", lower_first(&step.what))),
        UndoDirection::Again => Notice::undoable(step.what.clone()),
    };
    notify(state, notice);
    let mut saved = None;
    if let DraftEffect::MakesWay(other) = &mut step.draft {
        let coming = other.take();
        let going = state.enrol.draft.take().map(Box::new);
        if way != UndoDirection::Back {
            saved.clone_from(&going);
        }
        state.enrol.draft = coming.map(|draft| *draft);
        *other = going;
        state.enrol.replacing = None;
    }
    state.enrol.steps.to(way).push(UndoStep::Library(step));
    match (&state.enrol.open, name) {
        (Some(_), Some(name)) => open(state, name),
        (Some(_), None) => state.enrol.open = None,
        (None, _) => {}
    }
    let again = inspect_again(state, saved.as_deref());
    let select = select(state);
    Some(Effect::Several(again.into_iter().chain(select).collect()))
}

/// The part to be replaced may be called otherwise now, or be gone.
fn track_replaced_part(state: &mut State, made: &LibraryChange) {
    let Some(replaced) = state.enrol.replacing.clone() else {
        return;
    };
    if let LibraryChange::Rename(before, words) = made
        && *before == replaced
    {
        state.enrol.replacing = Some(words.name.clone());
        if let Some(draft) = &mut state.enrol.draft {
            draft.form.name = words.name.to_string();
            draft.form.title.clone_from(&words.title);
        }
    } else if words_of(state, &replaced).is_none() {
        state.enrol.replacing = None;
    }
}

/// Inspects what was saved, else the scene in front, by the library as it is now.
fn inspect_again(state: &mut State, saved: Option<&Draft>) -> Option<Effect> {
    let of_saved = saved.and_then(|draft| {
        if let Some(fused) = draft.subject.scan() {
            return Some(inspection_of(state, fused));
        }
        let scene = Arc::clone(draft.subject.scene()?);
        let source = SceneSource::AtHand(scene, draft.subject.origin.clone());
        let recipe = Arc::clone(&state.recipe);
        Some(Request::Inspect(InspectRequest { source, recipe }))
    });
    let is_busy = state.works.contains_key(&TaskQueue::Inspect);
    let shown = state.shown.as_ref().filter(|_| !is_busy);
    let of_shown = shown.map(|shown| inspection_again(state, &shown.inspected));
    let request = of_saved.or(of_shown)?;
    Some(state.begin("Inspecting again", request))
}

/// Takes the last step back, or does it again.
pub(super) fn apply_step(state: &mut State, way: UndoDirection) -> Option<Effect> {
    if state.is_changing_library() {
        return None;
    }
    loop {
        let step = state.enrol.steps.from(way).pop()?;
        dismiss_undo_notices(state);
        match step {
            UndoStep::Library(step) => return start_change(state, way, step),
            UndoStep::Draft(other) => {
                let current = state.enrol.draft.take().map(Box::new);
                state.enrol.draft = other.map(|draft| *draft);
                state.enrol.steps.to(way).push(UndoStep::Draft(current));
                return select(state);
            }
            UndoStep::Corrections(number, before) => {
                let draft = state.enrol.draft.as_mut();
                // Of a draft that is no longer there: the step before it counts.
                if let Some(draft) = draft.filter(|draft| draft.number == number) {
                    let now = mem::replace(&mut draft.corrections, before);
                    let back = UndoStep::Corrections(number, now);
                    state.enrol.steps.to(way).push(back);
                    return select(state);
                }
            }
        }
    }
}

/// Something else was done: it is what Undo takes back now.
pub(super) fn did(state: &mut State, back: UndoStep) {
    state.enrol.steps.push(back);
    dismiss_undo_notices(state);
}

/// Notices no longer offer to take back what they tell of.
fn dismiss_undo_notices(state: &mut State) {
    for notice in &mut state.notices {
        if notice.kind == NoticeKind::Undoable {
            notice.kind = NoticeKind::Done;
        }
    }
}

fn lower_first(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| {
        first.to_lowercase().chain(letters).collect()
    })
}
