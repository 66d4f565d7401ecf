//! What the workspace knows, and what changes it.

use std::{path::PathBuf, sync::Arc};

use super::{
    change::LibraryChange,
    draft::{Draft, Field, Form},
    selection::{BoxMode, Corrections, Edit, Selection},
    subject::{EnrolInput, InitialSelection},
    undo::{
        DraftEffect, LibraryStep, UndoDirection, UndoStack, UndoStep, apply_step, change,
        changed_library, did,
    },
    work::{EnrolAnswer, EnrolRequest},
};
use crate::{
    app::{
        action::{Effect, notify},
        job::{Request, Trouble},
        lane::TaskQueue,
        shots::{self, ScanRequest, ShotsState},
        source::SceneSource,
        state::{Notice, NoticeKind, State},
    },
    library::{PartName, PartNaming},
};

/// What the workspace knows.
#[derive(Debug, Default)]
pub struct EnrolState {
    /// The part that is about to be enrolled.
    pub draft: Option<Draft>,
    /// How many drafts there were.
    pub num_drafts: u64,
    /// The enrolled part that the draft, or the next one, replaces.
    pub replacing: Option<PartName>,
    /// The part that the last change of the library left there.
    pub latest: Option<LastChangedPart>,
    /// How many changes of the library there were.
    pub num_changes: u64,
    /// The enrolled part that is looked at.
    pub open: Option<OpenedPart>,
    /// What a box in the picture does.
    pub box_mode: BoxMode,
    /// What is shown of the draft.
    panes: DraftPanes,
    /// What is shown of a draft that is a scan, which has no picture of its own.
    scan_panes: ScanPanes,
    /// Of the scan that the draft is, if it is one.
    pub shots: ShotsState,
    /// What can be taken back and done again.
    pub steps: UndoStack,
    /// The generation of the request for another draft, until that is there.
    taking: Option<u64>,
    /// The change of the library that is being made.
    pub(super) pending: Option<(UndoDirection, LibraryStep)>,
}

/// An enrolled part that is looked at.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OpenedPart {
    /// The part.
    pub name: PartName,
    /// What it is called, as a person writes it.
    pub form: Form,
}

/// The part that the last change of the library left there.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LastChangedPart {
    /// The part.
    pub name: PartName,
    /// What became of it, in words.
    pub what: &'static str,
}

/// What is shown of the draft.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum DraftPanes {
    /// The picture and the 3-D view.
    #[default]
    Both,
    /// The picture alone.
    Picture,
    /// The 3-D view alone.
    View,
}

impl DraftPanes {
    /// Every choice.
    pub const ALL: [Self; 3] = [Self::Both, Self::Picture, Self::View];

    /// What a person calls it.
    pub fn title(self) -> &'static str {
        match self {
            Self::Both => "Both",
            Self::Picture => "Picture",
            Self::View => "3-D",
        }
    }
}

/// The panes of a scan: at first the 3-D view alone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct ScanPanes(DraftPanes);

impl Default for ScanPanes {
    fn default() -> Self {
        Self(DraftPanes::View)
    }
}

impl EnrolState {
    /// What is shown of the draft.
    pub fn panes(&self) -> DraftPanes {
        if self.has_scan() {
            self.scan_panes.0
        } else {
            self.panes
        }
    }

    fn has_scan(&self) -> bool {
        let draft = self.draft.as_ref();
        draft.is_some_and(|draft| draft.subject.scan().is_some())
    }
}

/// Something that happened in the workspace.
#[derive(Debug)]
pub enum EnrolAction {
    /// Take the scene in front as the draft.
    TakeShown,
    /// Correct what is kept.
    Correct(Edit),
    /// Start from other points.
    TakeAs(InitialSelection),
    /// Take all corrections away.
    Reset,
    /// Have a box do something else.
    BoxMode(BoxMode),
    /// Show other panes.
    Panes(DraftPanes),
    /// Write a line about the draft.
    Write(Field),
    /// Look at the draft again, after it was cancelled.
    LookAgain,
    /// Save the draft.
    Save,
    /// Put the draft away.
    Discard,
    /// Take the last step back.
    Undo,
    /// Do again what was taken back last.
    Redo,
    /// Look at an enrolled part.
    Open(PartName),
    /// Look at the draft again.
    Close,
    /// Write a line about the enrolled part that is looked at.
    WriteOpen(Field),
    /// Call it so.
    Rename,
    /// Move a part to the trash.
    Remove(PartName),
    /// Enrol this part anew: the draft, or the next one, replaces it.
    Replace(PartName),
    /// Replace none: the draft becomes a new part.
    ReplaceNone,
    /// Store the spray path in this file with the enrolled part that is looked at.
    StorePath(PathBuf),
    /// Take the spray path of a part away.
    RemovePath(PartName),
}

impl State {
    /// The name for people of the enrolled part that the draft, or the next one, replaces.
    pub fn replaced_title(&self) -> Option<&str> {
        let library = self.library.as_ref()?;
        let name = match &self.enrol.draft {
            Some(draft) => &draft.form.name,
            None => self.enrol.replacing.as_ref()?.as_str(),
        };
        library.place_of(name).map(|place| library.title(place))
    }

    /// True while the draft is not the one that was asked for last.
    pub fn is_taking_another(&self) -> bool {
        let work = self.works.get(&TaskQueue::Enrol);
        work.is_some_and(|work| self.enrol.taking == Some(work.generation))
    }

    /// True while the library is being changed.
    pub fn is_changing_library(&self) -> bool {
        self.works.contains_key(&TaskQueue::Library)
    }
}

/// Carries out an action.
pub fn apply(state: &mut State, action: EnrolAction) -> Option<Effect> {
    match action {
        EnrolAction::TakeShown => return load_shown_part(state),
        EnrolAction::Correct(edit) => {
            return correct(state, |corrections| corrections.edits.push(edit));
        }
        EnrolAction::TakeAs(taking) => {
            let subject = &state.enrol.draft.as_ref()?.subject;
            if subject.allows(taking) {
                return correct(state, |corrections| {
                    *corrections = Corrections::none(taking);
                });
            }
        }
        EnrolAction::Reset => return correct(state, |corrections| corrections.edits.clear()),
        EnrolAction::BoxMode(mode) => state.enrol.box_mode = mode,
        EnrolAction::Panes(panes) => {
            let own = &mut state.enrol;
            if own.has_scan() {
                own.scan_panes = ScanPanes(panes);
            } else {
                own.panes = panes;
            }
        }
        EnrolAction::Write(field) => {
            let form = &mut state.enrol.draft.as_mut()?.form;
            form.write(field);
            // Under another name it is another part.
            state
                .enrol
                .replacing
                .take_if(|name| name.as_str() != form.name);
        }
        EnrolAction::LookAgain => return select(state),
        EnrolAction::Save => return save(state),
        EnrolAction::Discard => {
            let former = state.enrol.draft.take()?;
            did(state, UndoStep::Draft(Some(Box::new(former))));
        }
        EnrolAction::Undo => return apply_step(state, UndoDirection::Back),
        EnrolAction::Redo => return apply_step(state, UndoDirection::Again),
        EnrolAction::Open(name) => open(state, name),
        EnrolAction::Close => state.enrol.open = None,
        EnrolAction::WriteOpen(field) => state.enrol.open.as_mut()?.form.write(field),
        EnrolAction::Rename => return rename(state),
        EnrolAction::Remove(name) => {
            return change(state, LibraryChange::Remove(name), DraftEffect::Stays);
        }
        EnrolAction::Replace(name) => {
            let words = words_of(state, &name)?;
            if let Some(draft) = &mut state.enrol.draft {
                draft.form = Form::of(words);
            }
            state.enrol.replacing = Some(name);
            state.enrol.open = None;
        }
        EnrolAction::StorePath(file) => {
            let name = state.enrol.open.as_ref()?.name.clone();
            return change(
                state,
                LibraryChange::ReadPath(name, file),
                DraftEffect::Stays,
            );
        }
        EnrolAction::RemovePath(name) => {
            return change(
                state,
                LibraryChange::SetPath(name, None),
                DraftEffect::Stays,
            );
        }
        EnrolAction::ReplaceNone => {
            state.enrol.replacing = None;
            if let Some(draft) = &mut state.enrol.draft {
                draft.form = Form::default();
            }
        }
    }
    None
}

/// Takes in what the threads answer.
pub fn hear(
    state: &mut State,
    generation: u64,
    outcome: Result<EnrolAnswer, Trouble>,
) -> Option<Effect> {
    match outcome {
        Ok(EnrolAnswer::Taken(subject, selection)) => {
            taken(state, subject, selection);
            shots::settle(state, TaskQueue::Enrol, generation, None);
        }
        Ok(EnrolAnswer::Selected(selection)) => {
            state.enrol.draft.as_mut()?.selection = selection;
        }
        Ok(EnrolAnswer::Checked(checked)) => {
            state.enrol.draft.as_mut()?.checked = Some(checked);
        }
        Ok(EnrolAnswer::Changed(changed)) => return changed_library(state, *changed),
        Err(_) => {
            if !state.is_changing_library()
                && let Some((way, step)) = state.enrol.pending.take()
                && way != UndoDirection::First
            {
                // It still can be taken back or done again.
                state.enrol.steps.from(way).push(UndoStep::Library(step));
            }
        }
    }
    None
}

/// Gets something to enrol.
pub(in crate::app) fn take(state: &mut State, source: SceneSource, what: String) -> Effect {
    state.enrol.open = None;
    let recipe = Arc::clone(&state.recipe);
    let effect = state.begin(what, Request::Enrol(EnrolRequest::Take { source, recipe }));
    state.enrol.taking = Some(state.generation);
    effect
}

/// Puts the shots of a scan together to enrol what they show.
pub(in crate::app) fn take_scan(state: &mut State, request: ScanRequest, what: String) -> Effect {
    state.enrol.open = None;
    let effect = state.begin(what, Request::Enrol(EnrolRequest::TakeScan(request)));
    state.enrol.taking = Some(state.generation);
    effect
}

fn load_shown_part(state: &mut State) -> Option<Effect> {
    if let Some(effect) = shots::enrol_shown(state) {
        return Some(effect);
    }
    let inspected = &state.shown.as_ref()?.inspected;
    let source = SceneSource::AtHand(Arc::clone(&inspected.scene), inspected.origin.clone());
    Some(take(state, source, "Taking the scene in front".into()))
}

/// The former draft can be brought back; what was written about it is kept, for it may be the same part again.
fn taken(state: &mut State, subject: Arc<EnrolInput>, selection: Arc<Selection>) {
    for warning in &subject.warnings {
        notify(state, Trouble::of(warning).into());
    }
    for warning in subject.scan().map_or(&[][..], |fused| &fused.warnings) {
        notify(state, warning.clone().into());
    }
    let former = state.enrol.draft.take();
    let replaced = state.enrol.replacing.clone();
    let replaced = replaced.and_then(|name| words_of(state, &name));
    let form = match (replaced, &former) {
        (Some(words), _) => Form::of(words),
        (None, Some(former)) => former.form.clone(),
        (None, None) => Form::default(),
    };
    if let Some(former) = former {
        did(state, UndoStep::Draft(Some(Box::new(former))));
    }
    state.enrol.taking = None;
    state.enrol.num_drafts += 1;
    state.enrol.draft = Some(Draft {
        number: state.enrol.num_drafts,
        corrections: Corrections::none(subject.usual),
        subject,
        selection,
        checked: None,
        form,
    });
}

/// Changes the corrections, if that changes anything, and has them gone through.
fn correct(state: &mut State, change: impl FnOnce(&mut Corrections)) -> Option<Effect> {
    let draft = state.enrol.draft.as_mut()?;
    if !draft.subject.can_be_corrected() {
        return None;
    }
    let before = draft.corrections.clone();
    change(&mut draft.corrections);
    if draft.corrections == before {
        return None;
    }
    let step = UndoStep::Corrections(draft.number, before);
    did(state, step);
    select(state)
}

/// Has the corrections gone through.
pub(super) fn select(state: &mut State) -> Option<Effect> {
    let draft = state.enrol.draft.as_mut()?;
    draft.checked = None;
    let request = EnrolRequest::Select {
        subject: Arc::clone(&draft.subject),
        corrections: draft.corrections.clone(),
        recipe: Arc::clone(&state.recipe),
    };
    Some(state.begin("Looking at the part", Request::Enrol(request)))
}

fn save(state: &mut State) -> Option<Effect> {
    let draft = state.enrol.draft.as_ref()?;
    let words = match draft.form.words() {
        Ok(words) => words,
        Err(error) => {
            notify(state, Trouble::of(&error).into());
            return None;
        }
    };
    let Some(checked) = draft.ready() else {
        let notice = Notice {
            kind: NoticeKind::Look,
            what: "There is nothing to save yet".into(),
            advice: "Save once the picture of what will be stored is there".into(),
        };
        notify(state, notice);
        return None;
    };
    let save = LibraryChange::Save(Arc::clone(&checked.enrolled), words);
    change(state, save, DraftEffect::MakesWay(None))
}

fn rename(state: &mut State) -> Option<Effect> {
    let open = state.enrol.open.as_ref()?;
    match open.form.words() {
        Ok(words) => {
            let rename = LibraryChange::Rename(open.name.clone(), words);
            change(state, rename, DraftEffect::Stays)
        }
        Err(error) => {
            notify(state, Trouble::of(&error).into());
            None
        }
    }
}

pub(super) fn open(state: &mut State, name: PartName) {
    let words = words_of(state, &name);
    // A damaged one cannot be described; it can be removed.
    let form = words.map_or_else(Form::default, Form::of);
    state.enrol.open = Some(OpenedPart { name, form });
}

pub(super) fn words_of(state: &State, name: &PartName) -> Option<PartNaming> {
    let library = state.library.as_ref()?;
    let part = library.parts.get(library.place_of(name.as_str())?)?;
    Some(part.words())
}

#[cfg(test)]
mod tests;
