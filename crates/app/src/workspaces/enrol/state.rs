//! State of the workspace, the actions that change it, and the files that it asks for.

use std::{mem, path::PathBuf, sync::Arc};

use crate::{
    shots::{Asked, ShotsAction, ShotsFile, ShotsState},
    workspaces::enrol::{
        change::{Changed, LibraryChange},
        draft::{Draft, Field, Form, OpenedPart},
        kept::KeptDraft,
        meshes::{MeshAction, MeshList, MeshPicture},
        selection::{Corrections, Edit, OutlineMode},
        subject::InitialSelection,
        undo::{DraftEffect, LastChangedPart, LibraryStep, SavedDraft, UndoStep},
        work::{self, DraftEvent},
    },
};
use inspection::library::PartName;
use shell::{
    action::{Action, DialogRequest, Event},
    file_dialog::{FileChoice, FileDialog, FileRequest, all_files},
    inspection::{library_cache::LibraryView, source::ShotChoice},
    notice::{Notice, NoticeTopic},
    session::{Session, UserRole, WorkspaceKind},
    workspace::ShellContext,
};
use ui::{
    language::{text, what_and_advice},
    task::{Running, Task, TaskContext, TaskError, TaskRunner},
    undo_stack::{UndoDirection, UndoStack},
    user_error::UserError,
    viewport::DrawnShape,
};

/// State of the workspace.
#[derive(Debug)]
pub struct EnrolState {
    /// The part that is about to be enrolled.
    pub draft: Option<Draft>,
    /// The draft of an earlier start of the window, until it has been brought back.
    pub(super) coming: Option<KeptDraft>,
    /// Checksum that the selection of that draft had, until its selection is known again.
    pub(super) expected: Option<u32>,
    /// Number of drafts so far.
    pub num_drafts: u64,
    /// The enrolled part to be replaced by the draft or the next one.
    pub replacing: Option<PartName>,
    /// The part changed last, if it is in the library.
    pub latest: Option<LastChangedPart>,
    /// The draft that was saved last, unless it was of a mesh.
    pub(super) saved_from: Option<SavedDraft>,
    /// Number of library changes so far.
    pub num_changes: u64,
    /// The enrolled part whose card is open.
    pub open: Option<OpenedPart>,
    /// Shape drawn by dragging in the 3-D view; `None` if dragging turns the view.
    pub shape: Option<DrawnShape>,
    /// What a drawn box or lasso does.
    pub outline_mode: OutlineMode,
    /// The panes shown.
    panes: DraftPanes,
    /// The panes shown for a scan, which has no picture of its own.
    scan_panes: DraftPanes,
    /// State of the list of shots, for a draft that is a scan.
    pub shots: ShotsState,
    /// The meshes of a file, while a person chooses among them.
    pub mesh_list: Option<MeshList>,
    /// Draws the pictures of those meshes.
    pub(super) picture_task: Task<MeshPicture>,
    /// Steps that can be undone and redone.
    pub steps: UndoStack<UndoStep>,
    /// Prepares the draft; a newer correction replaces an older one.
    pub(super) draft_task: Task<DraftEvent>,
    /// The current job of the draft's task, or its last.
    pub(super) job: DraftJob,
    /// Changes the library; never cancelled.
    pub(super) change_task: Task<Box<Changed>>,
    /// The library change in progress.
    pub(super) pending: Option<(Option<UndoDirection>, LibraryStep)>,
    /// An outline was drawn and its effect is not known yet.
    is_outline_new: bool,
    /// The action to carry out once the engineer is in.
    held: Option<EnrolAction>,
    files: FileDialog<EnrolFile>,
}

/// A job of the draft's task.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum DraftJob {
    /// Gets a new draft.
    Take,
    /// Gets the draft of an earlier start of the window again.
    TakeAgain,
    /// Examines the present draft.
    Look,
}

impl EnrolState {
    /// Creates the state without a draft.
    pub fn new(runner: &TaskRunner) -> Self {
        Self {
            draft: None,
            coming: None,
            expected: None,
            num_drafts: 0,
            replacing: None,
            latest: None,
            saved_from: None,
            num_changes: 0,
            open: None,
            shape: None,
            outline_mode: OutlineMode::default(),
            panes: DraftPanes::default(),
            scan_panes: DraftPanes::View,
            shots: ShotsState::default(),
            mesh_list: None,
            picture_task: Task::new("mesh-pictures", runner),
            steps: UndoStack::default(),
            draft_task: Task::new("enrol", runner),
            job: DraftJob::Look,
            change_task: Task::new("library", runner),
            pending: None,
            is_outline_new: false,
            held: None,
            files: FileDialog::default(),
        }
    }

    /// The panes that show the draft.
    pub fn panes(&self) -> DraftPanes {
        if self.has_scan() {
            self.scan_panes
        } else {
            self.panes
        }
    }

    fn has_scan(&self) -> bool {
        let draft = self.draft.as_ref();
        draft.is_some_and(|draft| draft.subject.scan().is_some())
    }

    /// The job preparing a draft, if any.
    pub fn running(&self) -> Option<&Running> {
        self.draft_task.running()
    }

    /// Cancels that job.
    pub fn cancel(&mut self) {
        self.draft_task.cancel();
    }

    /// Title of the enrolled part that the draft, or the next one, would replace.
    pub fn replaced_title<'a>(&self, session: &'a Session) -> Option<&'a str> {
        let library = session.library.as_ref()?;
        let name = match &self.draft {
            Some(draft) => &draft.form.name,
            None => self.replacing.as_ref()?.as_str(),
        };
        library.index_of(name).map(|index| library.title(index))
    }

    /// True while another draft is being prepared.
    pub fn is_taking_another(&self) -> bool {
        self.running().is_some() && self.job != DraftJob::Look
    }

    /// True while the draft is being examined.
    pub(super) fn is_examining(&self) -> bool {
        self.running().is_some() && self.job == DraftJob::Look
    }

    /// The draft, if a person has put work into it.
    pub(super) fn worked_on(&self) -> Option<&Draft> {
        self.draft.as_ref().filter(|draft| {
            draft.form != Form::default()
                || draft.corrections != Corrections::none(draft.subject.usual)
        })
    }

    /// Describes unsaved work on the draft, if any.
    pub fn unsaved(&self) -> Option<String> {
        Some(match self.worked_on()?.form.title.trim() {
            "" => text!("enrol-unsaved"),
            title => text!("enrol-unsaved-titled", part = title),
        })
    }

    /// True while the library is being changed.
    pub fn is_changing_library(&self) -> bool {
        self.change_task.running().is_some()
    }

    /// True while pictures of meshes are being drawn.
    pub(super) fn is_drawing_meshes(&self) -> bool {
        self.picture_task.running().is_some()
    }

    /// The shots used by a draft that is a scan, or those requested while they are being prepared.
    pub fn shot_choice(&self) -> Option<&ShotChoice> {
        let fused = self.draft.as_ref()?.subject.scan()?;
        let asked = self.shots.asked_choice();
        let asked = asked.filter(|_| self.is_taking_another());
        Some(asked.unwrap_or(&fused.choice))
    }

    /// Carries out an action; an operator is first asked for the engineer.
    pub fn apply(&mut self, action: EnrolAction, cx: &mut ShellContext<'_>) {
        if cx.session.role == UserRole::Operator {
            self.held = Some(action);
            cx.send(Action::AskEngineer(WorkspaceKind::Enrol));
            return;
        }
        let library = cx.session.library.as_deref();
        match action {
            EnrolAction::TakeShown => self.take_shown(cx),
            EnrolAction::SeeInspected => {
                cx.send(Action::GoTo(WorkspaceKind::Inspect));
            }
            EnrolAction::Correct(edit) => {
                self.is_outline_new = matches!(edit, Edit::Outline(..));
                self.correct(cx, |all| all.edits.push(edit));
            }
            EnrolAction::TakeAs(taking) => {
                let draft = self.draft.as_ref();
                if draft.is_some_and(|draft| draft.subject.allows(taking)) {
                    self.correct(cx, |all| *all = Corrections::none(taking));
                }
            }
            EnrolAction::Reset => self.correct(cx, |all| all.edits.clear()),
            EnrolAction::Draw(shape) => self.shape = shape,
            EnrolAction::DrawNext => {
                self.shape = Some(match self.shape {
                    Some(DrawnShape::Box) => DrawnShape::Lasso,
                    Some(DrawnShape::Lasso | DrawnShape::Way) | None => DrawnShape::Box,
                });
            }
            EnrolAction::OutlineMode(mode) => self.outline_mode = mode,
            EnrolAction::Panes(panes) if self.has_scan() => self.scan_panes = panes,
            EnrolAction::Panes(panes) => self.panes = panes,
            EnrolAction::Write(field) => {
                if let Some(Draft { form, .. }) = &mut self.draft {
                    form.write(field, library);
                    // Under another name it is another part.
                    self.replacing.take_if(|name| name.as_str() != form.name);
                }
            }
            EnrolAction::LookAgain => self.look(cx),
            EnrolAction::Save if self.open.is_some() => self.rename(cx),
            EnrolAction::Save => self.save(cx),
            EnrolAction::Discard => self.discard(cx),
            EnrolAction::LeaveOutRest => {
                if let Some(draft) = &mut self.draft {
                    draft.chosen = None;
                }
            }
            EnrolAction::Meshes(action) => self.choose_meshes(action, cx),
            EnrolAction::Undo => self.undo(cx),
            EnrolAction::UndoChange => self.apply_step(UndoDirection::Undo, cx),
            EnrolAction::Redo => self.apply_step(UndoDirection::Redo, cx),
            EnrolAction::Open(name) => self.look_at(name, library),
            EnrolAction::Close => self.open = None,
            EnrolAction::WriteOpen(field) => {
                if let Some(open) = &mut self.open {
                    open.form.write(field, library);
                }
            }
            EnrolAction::Rename => self.rename(cx),
            EnrolAction::Remove(name) => {
                self.change(LibraryChange::Remove(name), DraftEffect::Stays, cx);
            }
            EnrolAction::Replace(name) => {
                if let Some(form) = form_of(&name, library) {
                    if let Some(draft) = &mut self.draft {
                        let before = mem::replace(&mut draft.form, form);
                        let replaced = self.replacing.as_ref().map(PartName::as_str);
                        // The form of another part to replace was not written for this one.
                        if replaced != Some(&before.name) {
                            draft.form_before = Some(before);
                        }
                    }
                    self.replacing = Some(name);
                    self.open = None;
                }
            }
            EnrolAction::ReplaceNone => {
                self.replacing = None;
                if let Some(draft) = &mut self.draft {
                    draft.form = draft.form_before.take().unwrap_or_default();
                }
            }
            EnrolAction::RemovePath(name) => {
                self.change(LibraryChange::SetPath(name, None), DraftEffect::Stays, cx);
            }
            EnrolAction::OpenScan => cx.send(Action::Ask(DialogRequest::Scan)),
            EnrolAction::Ask(file) => self.ask(file, cx),
            EnrolAction::Shots(ShotsAction::Ask(file)) => self.ask(EnrolFile::Scan(file), cx),
            EnrolAction::Chosen(EnrolFile::SprayPath, path) => {
                if let Some(open) = &self.open {
                    let change = LibraryChange::ReadPath(open.name.clone(), path);
                    self.change(change, DraftEffect::Stays, cx);
                }
            }
            EnrolAction::Chosen(EnrolFile::Scan(file), path) => {
                self.choose_shots(ShotsAction::Chosen(file, path), cx);
            }
            EnrolAction::Shots(action) => self.choose_shots(action, cx),
        }
    }

    /// Takes in the results of the tasks and of the file dialog.
    pub fn update(&mut self, cx: &mut ShellContext<'_>) {
        while let Some(event) = self.draft_task.poll() {
            match event {
                Ok(event) => self.receive(event, cx),
                Err(error) => {
                    cx.notify(Notice::from(error).about(NoticeTopic::Scene));
                    if self.job == DraftJob::TakeAgain {
                        self.words_alone(cx);
                    }
                }
            }
        }
        while let Some(drawn) = self.picture_task.poll() {
            match (drawn, &mut self.mesh_list) {
                (Ok(picture), Some(list)) => list.receive(picture),
                (Ok(_), None) => {}
                (Err(error), _) => cx.notify(error),
            }
        }
        match self.change_task.poll() {
            Some(Ok(changed)) => self.changed(*changed, cx),
            Some(Err(error)) => {
                cx.notify(error);
                self.not_changed();
            }
            None => {}
        }
        if let Some((file, path)) = cx.chosen(&mut self.files) {
            self.apply(EnrolAction::Chosen(file, path), cx);
        }
    }

    /// Handles an event of the shell.
    pub fn on_event(&mut self, event: &Event, cx: &mut ShellContext<'_>) {
        match event {
            Event::Undo(WorkspaceKind::Enrol) => self.apply(EnrolAction::UndoChange, cx),
            Event::EngineerIn => {
                if let Some(action) = self.held.take() {
                    self.apply(action, cx);
                }
            }
            Event::Escape => self.shape = None,
            Event::Inspected { .. }
            | Event::Left(_)
            | Event::TracedLate(..)
            | Event::PosesWanted(_)
            | Event::WrongPart(_)
            | Event::Drift(_)
            | Event::Labelled { .. }
            | Event::Undo(_)
            | Event::Export => {}
        }
    }

    fn receive(&mut self, event: DraftEvent, cx: &mut ShellContext<'_>) {
        match event {
            DraftEvent::Several(listing) => {
                cx.send(Action::RemoveNotices(NoticeTopic::Scene));
                self.job = DraftJob::Look;
                self.mesh_list = Some(MeshList::new(listing));
            }
            DraftEvent::Taken(subject, selection, chosen) => {
                self.taken(subject, selection, chosen, cx);
            }
            DraftEvent::Selected(selection) => {
                let expected = self.expected.take();
                if expected.is_some_and(|expected| expected != selection.checksum()) {
                    cx.notify(Notice::look(
                        text!("enrol-draft-differs"),
                        text!("enrol-draft-differs-advice"),
                    ));
                }
                let is_outline_new = mem::take(&mut self.is_outline_new);
                if let Some(draft) = &mut self.draft {
                    if is_outline_new && draft.selection.indices == selection.indices {
                        cx.notify(Notice::look(
                            text!("enrol-outline-nothing"),
                            text!("enrol-outline-nothing-advice"),
                        ));
                    }
                    draft.selection = selection;
                }
            }
            DraftEvent::Checked(checked) => {
                if let Some(draft) = &mut self.draft {
                    draft.checked = Some(checked);
                }
            }
            DraftEvent::PosesWanted(order, error) => {
                cx.notify(Notice::from(error).about(NoticeTopic::Scene));
                self.shots.ask_for_poses(*order);
                self.ask(EnrolFile::Scan(ShotsFile::Poses), cx);
            }
        }
    }

    fn ask(&mut self, file: EnrolFile, cx: &ShellContext<'_>) {
        let lock = &cx.services.dialogs;
        self.files.open(file, &file.request(), lock, cx.egui);
    }

    /// Starts another job of the draft's task.
    pub(super) fn start(
        &mut self,
        title: impl Into<String>,
        job: DraftJob,
        asked: Option<Asked>,
        work: impl FnOnce(&TaskContext<DraftEvent>) -> Result<DraftEvent, TaskError> + Send + 'static,
    ) {
        self.job = job;
        self.shots.started(asked);
        self.draft_task.start(title, work);
    }

    /// Changes the corrections; if they differ, applies them and examines the draft.
    fn correct(&mut self, cx: &mut ShellContext<'_>, change: impl FnOnce(&mut Corrections)) {
        let draft = self.draft.as_mut();
        let Some(draft) = draft.filter(|draft| draft.subject.can_be_corrected()) else {
            return;
        };
        let before = draft.corrections.clone();
        change(&mut draft.corrections);
        if draft.corrections != before {
            self.expected = None;
            let step = UndoStep::Corrections(draft.number, before);
            self.did(step, cx);
            self.look(cx);
        }
    }

    /// Applies the corrections and examines the draft.
    pub(super) fn look(&mut self, cx: &ShellContext<'_>) {
        let Some(draft) = &mut self.draft else {
            return;
        };
        draft.checked = None;
        let (subject, corrections) = (Arc::clone(&draft.subject), draft.corrections.clone());
        let (recipe, library_cache) = (
            Arc::clone(&cx.session.recipe),
            cx.services.library_cache.clone(),
        );
        self.start(
            text!("enrol-examining-part"),
            DraftJob::Look,
            None,
            move |context| work::look(&subject, &corrections, &recipe, &library_cache, context),
        );
    }

    fn save(&mut self, cx: &mut ShellContext<'_>) {
        let Some(draft) = &self.draft else {
            return;
        };
        match (draft.form.words(), draft.ready()) {
            (Err(error), _) => cx.notify(UserError::from(what_and_advice(&error))),
            (Ok(_), None) => cx.notify(Notice::look(
                text!("enrol-nothing-to-save"),
                text!("enrol-nothing-to-save-advice"),
            )),
            (Ok(words), Some(checked)) => {
                let of = draft.form.reference_of.clone();
                let save = LibraryChange::Save(Arc::clone(&checked.enrolled), words, of);
                self.change(save, DraftEffect::MakesWay(None), cx);
            }
        }
    }

    fn discard(&mut self, cx: &mut ShellContext<'_>) {
        if let Some(former) = self.draft.take() {
            let following = former.following();
            self.did(UndoStep::Draft(Some(Box::new(former))), cx);
            self.take_following(following, cx);
        }
    }

    fn rename(&mut self, cx: &mut ShellContext<'_>) {
        let Some(open) = &self.open else {
            return;
        };
        let library = cx.session.library.as_deref();
        let Some(before) = form_of(&open.name, library) else {
            return;
        };
        match open.form.words() {
            Ok(words) if before.words().is_ok_and(|before| before == words) => {}
            Ok(words) => {
                let rename = LibraryChange::Rename(open.name.clone(), words);
                self.change(rename, DraftEffect::Stays, cx);
            }
            Err(error) => cx.notify(UserError::from(what_and_advice(&error))),
        }
    }

    pub(super) fn look_at(&mut self, name: PartName, library: Option<&LibraryView>) {
        // A damaged part has no form, but it can be removed.
        let form = form_of(&name, library).unwrap_or_default();
        self.open = Some(OpenedPart { name, form });
    }
}

pub(super) fn form_of(name: &PartName, library: Option<&LibraryView>) -> Option<Form> {
    let library = library?;
    let part = library.parts.get(library.index_of(name.as_str())?)?;
    Some(Form::of(part))
}

/// Something that happened in the workspace.
#[derive(Debug)]
pub enum EnrolAction {
    /// Make the scene that Inspect shows the draft.
    TakeShown,
    /// Go to Inspect, which shows the part that was just saved.
    SeeInspected,
    /// Correct which points are kept.
    Correct(Edit),
    /// Start the corrections from another selection.
    TakeAs(InitialSelection),
    /// Remove all corrections.
    Reset,
    /// Draw this shape by dragging in the 3-D view; `None` turns the view instead.
    Draw(Option<DrawnShape>),
    /// Choose the box, or the lasso if the box was chosen.
    DrawNext,
    /// Choose what a drawn box or lasso does.
    OutlineMode(OutlineMode),
    /// Choose the panes.
    Panes(DraftPanes),
    /// Fill in a field of the draft's form.
    Write(Field),
    /// Examine the draft again, after it was cancelled.
    LookAgain,
    /// Save the draft; with the card of an enrolled part open, store that part's form.
    Save,
    /// Discard the draft; of several chosen meshes, the next one follows.
    Discard,
    /// Enrol none of the meshes that were chosen after the draft.
    LeaveOutRest,
    /// An action in the list of a file's meshes.
    Meshes(MeshAction),
    /// Undo the last step of the draft; without a draft, the last step of all.
    Undo,
    /// Undo the last step of all, as a notice offers after a change of the library.
    UndoChange,
    /// Redo the step undone last.
    Redo,
    /// Open the card of an enrolled part.
    Open(PartName),
    /// Close that card and return to the draft.
    Close,
    /// Fill in a field of the open part's form.
    WriteOpen(Field),
    /// Store the open part's form: name, title and notes.
    Rename,
    /// Move a part to the trash.
    Remove(PartName),
    /// Replace this enrolled part by the draft or the next one.
    Replace(PartName),
    /// Replace no part: the draft becomes a new one, with the form that it had before.
    ReplaceNone,
    /// Remove the spray path of a part.
    RemovePath(PartName),
    /// Ask for the folder of a scan to open.
    OpenScan,
    /// Ask for a file.
    Ask(EnrolFile),
    /// A file was chosen.
    Chosen(EnrolFile, PathBuf),
    /// An action on the shots of the draft.
    Shots(ShotsAction),
}

/// A file that a person is asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EnrolFile {
    /// The spray path of the open part.
    SprayPath,
    /// A file of the scan that the draft was made of.
    Scan(ShotsFile),
}

impl EnrolFile {
    fn request(self) -> FileRequest {
        match self {
            Self::SprayPath => FileRequest {
                title: text!("enrol-path-file-title"),
                filters: vec![(text!("enrol-path-files"), &["csv", "txt"]), all_files()],
                choice: FileChoice::File,
            },
            Self::Scan(file) => file.request(),
        }
    }
}

/// The panes that show the draft.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum DraftPanes {
    /// The picture and the 3-D view.
    #[default]
    Both,
    /// Only the picture.
    Picture,
    /// Only the 3-D view.
    View,
}

impl DraftPanes {
    /// Every choice, in the order of the buttons.
    pub const ALL: [Self; 3] = [Self::Both, Self::Picture, Self::View];

    /// Name for a person.
    pub fn title(self) -> String {
        match self {
            Self::Both => text!("enrol-both"),
            Self::Picture => text!("enrol-picture-pane"),
            Self::View => text!("enrol-view-pane"),
        }
    }

    /// Describes what choosing it does.
    pub(super) fn label(self) -> String {
        match self {
            Self::Both => text!("enrol-show-both"),
            Self::Picture => text!("enrol-show-picture"),
            Self::View => text!("enrol-show-view"),
        }
    }
}

#[cfg(test)]
mod tests;
