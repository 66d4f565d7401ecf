//! What was done, to be taken back and done again, in its order; and the changes of the library among it.

use std::{mem, sync::Arc};

use super::{
    change::{self, ChangeText, Changed, LibraryChange},
    draft::Draft,
    selection::Corrections,
    state::{EnrolState, form_of},
};
use crate::{
    app::{
        inspection::{
            inspected::SceneOrScan, library_cache::LibraryView, scan_choice::ScanOrder,
            source::SceneSource,
        },
        language::text,
        shell::{context::ShellContext, message::Message, notice::Notice},
    },
    library::PartName,
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
    pub what: ChangeText,
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

/// The part that the last change of the library left there.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LastChangedPart {
    /// The part.
    pub name: PartName,
    /// What became of it, in words.
    pub what: String,
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

impl EnrolState {
    /// Has the library changed for the first time; one change at a time.
    pub(super) fn change(
        &mut self,
        change: LibraryChange,
        draft: DraftEffect,
        cx: &ShellContext<'_>,
    ) {
        let step = LibraryStep {
            change,
            what: ChangeText::default(),
            draft,
        };
        self.start_change(UndoDirection::First, step, cx);
    }

    fn start_change(&mut self, way: UndoDirection, step: LibraryStep, cx: &ShellContext<'_>) {
        if self.is_changing_library() {
            return;
        }
        let (change, library_cache) = (step.change.clone(), cx.services.library_cache.clone());
        self.pending = Some((way, step));
        self.change_task
            .start(text!("enrol-changing-library"), move |_| {
                Ok(Box::new(change::change(&change, &library_cache)?))
            });
    }

    /// The library is another one now: what was made by it shows it.
    pub(super) fn changed(&mut self, changed: Changed, cx: &mut ShellContext<'_>) {
        let Changed {
            what,
            back,
            name,
            library,
        } = changed;
        let Some((way, mut step)) = self.pending.take() else {
            return;
        };
        self.track_replaced_part(&step.change, &library);
        self.num_changes += 1;
        self.latest = name.clone().map(|name| LastChangedPart {
            name,
            what: match &step.change {
                LibraryChange::Rename(..) => text!("enrol-just-renamed"),
                LibraryChange::Restore(_) => text!("enrol-just-brought-back"),
                LibraryChange::Save(..) | LibraryChange::Remove(_) => text!("enrol-just-saved"),
                LibraryChange::ReadPath(..) | LibraryChange::SetPath(..) => {
                    text!("enrol-path-changed")
                }
            },
        });
        step.change = back;
        let notice = match way {
            UndoDirection::First => {
                step.what.clone_from(&what);
                self.steps.undone.clear();
                Notice::undoable(what.whole)
            }
            UndoDirection::Back => Notice::done(text!("enrol-undone", what = &step.what.brief)),
            UndoDirection::Again => Notice::undoable(step.what.whole.clone()),
        };
        let mut saved = None;
        if let DraftEffect::MakesWay(other) = &mut step.draft {
            let coming = other.take();
            let going = self.draft.take().map(Box::new);
            if way != UndoDirection::Back {
                saved = going.as_deref().and_then(inspectable);
            }
            self.draft = coming.map(|draft| *draft);
            *other = going;
            self.replacing = None;
        }
        self.steps.to(way).push(UndoStep::Library(step));
        match (&self.open, name) {
            (Some(_), Some(name)) => self.look_at(name, Some(&library)),
            (Some(_), None) => self.open = None,
            (None, _) => {}
        }
        cx.send(Message::LibraryChanged { library, saved });
        cx.send(Message::WithdrawUndo);
        cx.notify(notice);
        self.look(cx);
    }

    /// The library could not be changed: the step still can be taken back or done again.
    pub(super) fn not_changed(&mut self) {
        if let Some((way, step)) = self.pending.take()
            && way != UndoDirection::First
        {
            self.steps.from(way).push(UndoStep::Library(step));
        }
    }

    /// The part to be replaced may be called otherwise now, or be gone.
    fn track_replaced_part(&mut self, made: &LibraryChange, library: &LibraryView) {
        let Some(replaced) = &self.replacing else {
            return;
        };
        if let LibraryChange::Rename(before, words) = made
            && before == replaced
        {
            self.replacing = Some(words.name.clone());
            if let Some(draft) = &mut self.draft {
                draft.form.name = words.name.to_string();
                draft.form.title.clone_from(&words.title);
            }
        } else if form_of(replaced, Some(library)).is_none() {
            self.replacing = None;
        }
    }

    /// Takes the last step back, or does it again.
    pub(super) fn apply_step(&mut self, way: UndoDirection, cx: &mut ShellContext<'_>) {
        if self.is_changing_library() {
            return;
        }
        while let Some(step) = self.steps.from(way).pop() {
            cx.send(Message::WithdrawUndo);
            match step {
                UndoStep::Library(step) => return self.start_change(way, step, cx),
                UndoStep::Draft(other) => {
                    let current = self.draft.take().map(Box::new);
                    self.draft = other.map(|draft| *draft);
                    self.steps.to(way).push(UndoStep::Draft(current));
                    return self.look(cx);
                }
                UndoStep::Corrections(number, before) => {
                    let draft = self.draft.as_mut();
                    // Of a draft that is no longer there: the step before it counts.
                    if let Some(draft) = draft.filter(|draft| draft.number == number) {
                        let now = mem::replace(&mut draft.corrections, before);
                        let back = UndoStep::Corrections(number, now);
                        self.steps.to(way).push(back);
                        return self.look(cx);
                    }
                }
            }
        }
    }

    /// Something else was done: it is what Undo takes back now, and no notice offers to take back something else.
    pub(super) fn did(&mut self, back: UndoStep, cx: &mut ShellContext<'_>) {
        self.steps.push(back);
        cx.send(Message::WithdrawUndo);
    }
}

/// What of a draft can be inspected: a mesh cannot.
fn inspectable(draft: &Draft) -> Option<SceneOrScan> {
    if let Some(fused) = draft.subject.scan() {
        return Some(SceneOrScan::Scan(ScanOrder::Known(fused.choice.clone())));
    }
    let scene = Arc::clone(draft.subject.scene()?);
    let source = SceneSource::AtHand(scene, draft.subject.origin.clone());
    Some(SceneOrScan::Scene(source))
}
