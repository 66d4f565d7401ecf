//! Undo and redo of the draft's steps and the library's changes, in one order.

use std::{
    mem,
    sync::{Arc, Weak},
};

use jiff::{Timestamp, tz::TimeZone};

use super::{
    change::{self, ChangeText, Changed, LibraryChange, PartVersion},
    draft::Draft,
    selection::Corrections,
    state::{EnrolState, form_of},
};
use geometry::clock;
use inspection::library::PartName;
use shell::{
    action::Action,
    inspection::{
        inspected::Inspected,
        library_cache::LibraryView,
        source::{ScanOrder, SceneOrScan, SceneSource, ShotSet},
    },
    notice::Notice,
    session::{Session, WorkspaceKind},
    workspace::ShellContext,
};
use stages::scene::SceneCloud;
use ui::{language::text, undo_stack::UndoDirection};

/// How to return to an earlier state, or forward again.
#[derive(Clone, Debug)]
pub enum UndoStep {
    /// Set the corrections of the draft with this number.
    Corrections(u64, Corrections),
    /// Set the draft.
    Draft(Option<Box<Draft>>),
    /// Change the library.
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

/// A change of the library as a step.
#[derive(Clone, Debug)]
pub struct LibraryStep {
    /// The change to make.
    pub change: LibraryChange,
    /// Description of the original change.
    pub what: ChangeText,
    /// Effect on the draft.
    pub draft: DraftEffect,
    /// The part as the previous change left it; `None` for a new change.
    pub left: Option<PartVersion>,
}

/// Effect of a library step on the draft.
#[derive(Clone, Debug)]
pub enum DraftEffect {
    /// The draft stays.
    Stays,
    /// The draft is exchanged for this one: a saved draft goes, and comes back when saving is undone.
    MakesWay(Option<Box<Draft>>),
}

/// The draft that was saved last.
#[derive(Debug)]
pub(super) struct SavedDraft {
    /// Name of the part.
    pub(super) part: PartName,
    /// What it was made of.
    pub(super) matter: SavedMatter,
}

/// What a saved draft was made of. It is compared by identity: two captures may have the same name.
#[derive(Debug)]
pub(super) enum SavedMatter {
    /// A scene.
    Scene(Weak<SceneCloud>),
    /// The shots of a scan.
    Shots(Weak<ShotSet>),
}

impl SavedMatter {
    /// `None` for a mesh, which cannot be inspected.
    fn of(draft: &Draft) -> Option<Self> {
        if let Some(fused) = draft.subject.scan() {
            return Some(Self::Shots(Arc::downgrade(&fused.choice.set)));
        }
        Some(Self::Scene(Arc::downgrade(draft.subject.scene()?)))
    }

    /// True if this is an inspection of it.
    pub(super) fn is_inspected_in(&self, inspected: &Inspected) -> bool {
        match (self, &inspected.scan) {
            (Self::Scene(scene), None) => scene.as_ptr() == Arc::as_ptr(&inspected.scene),
            (Self::Shots(set), Some(scan)) => set.as_ptr() == Arc::as_ptr(&scan.fused.choice.set),
            _ => false,
        }
    }
}

/// The part changed last, if it is in the library.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LastChangedPart {
    /// Name of the part.
    pub name: PartName,
    /// Kind of the change.
    pub what: PartChange,
    /// When it was changed.
    pub at: Timestamp,
}

impl LastChangedPart {
    /// Describes the change, with its time or, on another day, its date.
    pub fn shown(&self) -> String {
        let [at, now] = [self.at, clock::now()].map(|at| at.to_zoned(TimeZone::system()));
        let is_today = at.date() == now.date();
        let format = if is_today { "%H:%M" } else { "%Y-%m-%d" };
        let time = at.strftime(format).to_string();
        match self.what {
            PartChange::Renamed => text!("enrol-renamed-at", time = time),
            PartChange::BroughtBack => text!("enrol-brought-back-at", time = time),
            PartChange::Saved => text!("enrol-saved-at", time = time),
            PartChange::Path => text!("enrol-path-changed-at", time = time),
        }
    }
}

/// Kind of a part's last change.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PartChange {
    /// Its name, title or notes changed.
    Renamed,
    /// It was brought back from the trash.
    BroughtBack,
    /// It was saved.
    Saved,
    /// Its spray path was stored or removed.
    Path,
}

impl PartChange {
    fn of(change: &LibraryChange) -> Self {
        match change {
            LibraryChange::Rename(..) => Self::Renamed,
            LibraryChange::Restore(_) => Self::BroughtBack,
            LibraryChange::Save(..) | LibraryChange::Remove(_) => Self::Saved,
            LibraryChange::ReadPath(..) | LibraryChange::SetPath(..) => Self::Path,
        }
    }
}

/// Limit of drafts that are scans: each holds about 100 MB.
const MAX_SCANS: usize = 4;

impl EnrolState {
    /// Starts a new change of the library, unless one is in progress.
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
            left: None,
        };
        self.start_change(None, step, cx);
    }

    /// Starts a change; `way` is `None` for a new one.
    fn start_change(
        &mut self,
        way: Option<UndoDirection>,
        step: LibraryStep,
        cx: &ShellContext<'_>,
    ) {
        if self.is_changing_library() {
            return;
        }
        let (change, left) = (step.change.clone(), step.left.clone());
        let library_cache = cx.services.library_cache.clone();
        self.pending = Some((way, step));
        self.change_task
            .start(text!("enrol-changing-library"), move |_| {
                let changed = change::change(change, left.as_ref(), &library_cache)?;
                Ok(Box::new(changed))
            });
    }

    /// Takes in a completed change of the library.
    pub(super) fn changed(&mut self, changed: Changed, cx: &mut ShellContext<'_>) {
        let Changed {
            what,
            back,
            left,
            name,
            library,
        } = changed;
        let Some((way, mut step)) = self.pending.take() else {
            return;
        };
        self.track_saved_part(&step.change);
        self.track_replaced_part(&step.change, &library);
        self.num_changes += 1;
        self.latest = name.clone().map(|name| LastChangedPart {
            name,
            what: PartChange::of(&step.change),
            at: clock::now(),
        });
        step.change = back;
        step.left = Some(left);
        let notice = match way {
            None => {
                step.what.clone_from(&what);
                Notice::undoable(what.whole, WorkspaceKind::Enrol)
            }
            Some(UndoDirection::Undo) => {
                Notice::done(text!("enrol-undone", what = &step.what.brief))
            }
            Some(UndoDirection::Redo) => {
                Notice::undoable(step.what.whole.clone(), WorkspaceKind::Enrol)
            }
        };
        let (mut saved, mut following) = (None, None);
        if let DraftEffect::MakesWay(other) = &mut step.draft {
            let coming = other.take();
            let going = self.draft.take().map(Box::new);
            let kept = going.as_ref().filter(|_| way != Some(UndoDirection::Undo));
            let matter = kept.and_then(|draft| SavedMatter::of(draft));
            let named = name.clone().zip(matter);
            self.saved_from = named.map(|(part, matter)| SavedDraft { part, matter });
            if way.is_none() {
                let newest = going.as_deref();
                let newest = newest.filter(|draft| self.is_newest(draft, cx.session));
                saved = newest.and_then(inspectable);
                following = going.as_ref().and_then(|draft| draft.following());
            }
            self.draft = coming.map(|draft| *draft);
            *other = going;
            self.replacing = None;
        }
        self.steps.add_inverse(way, UndoStep::Library(step));
        match (&self.open, name) {
            (Some(_), Some(name)) => self.look_at(name, Some(&library)),
            (Some(_), None) => self.open = None,
            (None, _) => {}
        }
        cx.send(Action::LibraryChanged { library, saved });
        cx.send(Action::WithdrawUndo(WorkspaceKind::Enrol));
        cx.notify(notice);
        self.look(cx);
        self.take_following(following, cx);
    }

    /// True if nothing has been captured since the draft's scene.
    fn is_newest(&self, draft: &Draft, session: &Session) -> bool {
        let is_last = draft.number == self.num_drafts && !self.is_taking_another();
        let is_same_in_front = draft.in_front.ptr_eq(&scene_in_front(session));
        is_last && is_same_in_front && session.live.unseen.is_empty()
    }

    /// Puts the step of a failed change back, so that it can be undone or redone later.
    pub(super) fn not_changed(&mut self) {
        if let Some((Some(way), step)) = self.pending.take() {
            self.steps.from(way).push(UndoStep::Library(step));
        }
    }

    /// Follows the part that was saved last if it was renamed.
    fn track_saved_part(&mut self, made: &LibraryChange) {
        if let LibraryChange::Rename(before, words) = made
            && let Some(saved) = &mut self.saved_from
            && saved.part == *before
        {
            saved.part = words.name.clone();
        }
    }

    /// Follows the part to be replaced if it was renamed; forgets it if it is gone.
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

    /// Index of the step that is undone next: the last one of the draft, else, without a draft, the last of all. So a
    /// draft does not give way to a part that was saved before it.
    pub(super) fn next_undo(&self) -> Option<usize> {
        let done = &self.steps.done;
        let Some(draft) = &self.draft else {
            return done.len().checked_sub(1);
        };
        let is_save = |step: &UndoStep| match step {
            UndoStep::Library(step) => matches!(step.draft, DraftEffect::MakesWay(_)),
            UndoStep::Corrections(..) | UndoStep::Draft(_) => false,
        };
        let of_draft = |step: &UndoStep| match step {
            UndoStep::Corrections(number, _) => *number == draft.number,
            UndoStep::Draft(_) => true,
            UndoStep::Library(_) => false,
        };
        let steps = done.iter().enumerate().rev();
        let mut since_save = steps.take_while(|(_, step)| !is_save(step));
        let next = since_save.find(|(_, step)| of_draft(step));
        next.map(|(index, _)| index)
    }

    /// Undoes that step.
    pub(super) fn undo(&mut self, cx: &mut ShellContext<'_>) {
        // Otherwise the steps would change their order, and none be undone.
        if self.is_changing_library() {
            return;
        }
        if let Some(index) = self.next_undo() {
            let step = self.steps.done.remove(index);
            self.steps.done.push(step);
            self.apply_step(UndoDirection::Undo, cx);
        }
    }

    /// Undoes or redoes one step.
    pub(super) fn apply_step(&mut self, way: UndoDirection, cx: &mut ShellContext<'_>) {
        if self.is_changing_library() {
            return;
        }
        while let Some(step) = self.steps.from(way).pop() {
            cx.send(Action::WithdrawUndo(WorkspaceKind::Enrol));
            match step {
                UndoStep::Library(step) => return self.start_change(Some(way), step, cx),
                UndoStep::Draft(other) => {
                    let current = self.draft.take().map(Box::new);
                    self.draft = other.map(|draft| *draft);
                    let back = UndoStep::Draft(current);
                    self.steps.add_inverse(Some(way), back);
                    return self.look(cx);
                }
                UndoStep::Corrections(number, before) => {
                    let draft = self.draft.as_mut();
                    // Skip steps of a draft that is gone.
                    if let Some(draft) = draft.filter(|draft| draft.number == number) {
                        let now = mem::replace(&mut draft.corrections, before);
                        let back = UndoStep::Corrections(number, now);
                        self.steps.add_inverse(Some(way), back);
                        return self.look(cx);
                    }
                }
            }
        }
    }

    /// Records a new step, and withdraws the offers to undo in earlier notices.
    pub(super) fn did(&mut self, back: UndoStep, cx: &mut ShellContext<'_>) {
        self.steps.push(back);
        let done = &mut self.steps.done;
        let scans = done.iter().enumerate().rev();
        let mut scans = scans.filter(|(_, step)| step.is_scan());
        if let Some((oldest, _)) = scans.nth(MAX_SCANS) {
            done.drain(..=oldest);
        }
        cx.send(Action::WithdrawUndo(WorkspaceKind::Enrol));
    }
}

/// The scene that Inspect shows, compared by identity.
pub(super) fn scene_in_front(session: &Session) -> Weak<SceneCloud> {
    let shown = session.shown.as_ref();
    shown.map_or_else(Weak::new, |shown| Arc::downgrade(&shown.inspected.scene))
}

/// Returns the part of a draft that can be inspected; `None` for a mesh.
fn inspectable(draft: &Draft) -> Option<SceneOrScan> {
    if let Some(fused) = draft.subject.scan() {
        return Some(SceneOrScan::Scan(ScanOrder::Known(fused.choice.clone())));
    }
    let scene = Arc::clone(draft.subject.scene()?);
    let source = SceneSource::AtHand(scene, draft.subject.origin.clone());
    Some(SceneOrScan::Scene(source))
}
