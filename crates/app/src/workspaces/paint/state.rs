//! State of the workspace, the actions that change it, and the files that it asks for.

use std::{path::PathBuf, sync::Arc};

use crate::workspaces::paint::{
    design::{Design, Step},
    reach::{Reach, ReachRequest},
    region::PaintTool,
    work::{self, PaintResult, Planned, Request, UnpaintedPart},
};
use inspection::{
    library::{PartMeta, PartName, Side, SprayPath},
    pipeline::Verdict,
};
use robot::paint::{BUILT_IN_COATS, CoatFolder, KeepOut, PathEdit, built_in_coat};
use shell::{
    action::{Action, Event},
    cell::{ProgramSetup, program_file_name},
    file_dialog::{FileChoice, FileDialog, FileRequest, all_files, program_files},
    inspection::source::file_name,
    notice::{Notice, NoticeTopic},
    session::{PaintTab, Session, WorkspaceKind},
    workspace::ShellContext,
};
use ui::{
    language::text,
    parameter_control::ParameterChange,
    scrubber::Playback,
    task::{Running, Task, TaskRunner},
    undo_stack::{UndoDirection, UndoStack},
    user_error::UserError,
};

/// State of the workspace.
#[derive(Debug)]
pub struct PaintState {
    /// The design of the path.
    pub design: Design,
    /// The path shown.
    pub shown_path: ShownPath,
    /// The last path of the part to paint, with its film and input.
    pub planned: Option<Arc<Planned>>,
    /// The part to paint, until its first path is planned.
    pub(super) unpainted: Option<Arc<UnpaintedPart>>,
    /// Why there is no path for the last request.
    pub failed: Option<UserError>,
    /// What a left drag does.
    pub tool: PaintTool,
    /// True if the part is coloured by its film.
    pub is_film_shown: bool,
    /// Position on the timeline, seconds.
    pub time: f64,
    /// Whether the position advances by itself.
    pub playback: Playback,
    /// The name being entered for the coat.
    pub naming: Option<String>,
    /// Names of all coats.
    pub coats: Vec<String>,
    pub(super) coat_folder: Option<CoatFolder>,
    pub(super) steps: UndoStack<Step>,
    pub(super) asked: Option<Request>,
    /// The request that the last path answers.
    answered: Option<Request>,
    task: Task<PaintResult>,
    storing: Task<PaintResult>,
    /// The step being stored, and its direction if it is undone or redone.
    pending: Option<(Option<UndoDirection>, Step)>,
    pub(super) reach: Option<Result<Arc<Reach>, UserError>>,
    pub(super) reach_asked: Option<ReachRequest>,
    pub(super) reach_task: Task<Arc<Reach>>,
    /// Its result describes what was written.
    pub(super) writing: Task<Notice>,
    dialog: FileDialog<PaintFile>,
}

impl PaintState {
    /// Creates the state without a chosen part; `coats` is the folder of the user's coats.
    pub fn new(coats: Option<PathBuf>, runner: &TaskRunner) -> Self {
        let kept = built_in_coat(BUILT_IN_COATS[0]).expect("the program has it");
        Self {
            design: Design {
                part: None,
                cloud: None,
                coat: kept.recipe,
                kept,
                regions: Vec::new(),
                edits: Vec::new(),
            },
            shown_path: ShownPath::default(),
            planned: None,
            unpainted: None,
            failed: None,
            tool: PaintTool::default(),
            is_film_shown: true,
            time: 0.0,
            playback: Playback::default(),
            naming: None,
            coats: BUILT_IN_COATS.map(str::to_owned).to_vec(),
            coat_folder: coats.map(CoatFolder::at),
            steps: UndoStack::default(),
            asked: None,
            answered: None,
            task: Task::new("paint", runner),
            storing: Task::new("paint-store", runner),
            pending: None,
            reach: None,
            reach_asked: None,
            reach_task: Task::new("paint-reach", runner),
            writing: Task::new("paint-write", runner),
            dialog: FileDialog::default(),
        }
    }

    /// The job that plans, stores or checks reach, if any.
    pub fn running(&self) -> Option<&Running> {
        let own = self.task.running().or_else(|| self.storing.running());
        own.or_else(|| self.reach_task.running())
    }

    /// True while a path is being stored.
    pub fn is_storing(&self) -> bool {
        self.storing.running().is_some()
    }

    /// The file being written, if any.
    pub fn writing(&self) -> Option<&Running> {
        self.writing.running()
    }

    /// Whether there is a step to undo and one to redo.
    pub fn can_undo(&self) -> [bool; 2] {
        let steps = &self.steps;
        [!steps.done.is_empty(), !steps.undone.is_empty()]
    }

    /// True if the path shown was stored with the part when it was planned.
    pub(super) fn is_stored(&self) -> bool {
        let planned = self.planned.as_ref();
        planned.is_some_and(|planned| planned.is_stored)
    }

    /// Describes regions drawn by a person whose path is not stored.
    pub(super) fn unsaved(&self) -> Option<String> {
        (self.design.is_drawn_on() && !self.is_stored()).then(|| text!("paint-unsaved"))
    }

    /// Cancels planning and the reach check; the shown path stays.
    pub fn cancel(&mut self) {
        self.task.cancel();
        self.reach_task.cancel();
    }

    /// True while a path is planned or proposed.
    pub fn is_planning(&self) -> bool {
        self.planning().is_some()
    }

    /// The job that plans or proposes a path, if any.
    pub(super) fn planning(&self) -> Option<&Running> {
        self.task.running()
    }

    /// True while the shown path does not match the present request, even if its planning was cancelled.
    pub fn is_old(&self, session: &Session) -> bool {
        let is_answered = self.request(session) == self.answered;
        !is_answered || self.is_planning() || self.failed.is_some()
    }

    /// Forgets path and failure of another part, or of the part before it was enrolled anew: nothing of it is shown under the name
    /// of the part to paint now.
    fn forget_other_part(&mut self, session: &Session) {
        if session.library.is_none() {
            return;
        }
        let part = self.enrolled(session);
        let is_other = |known: &PartName| part.is_none_or(|part| part.name != *known);
        let planned = self.planned.as_ref();
        let is_planned = planned.is_some_and(|planned| is_other(&planned.part));
        let unpainted = self.unpainted.as_ref();
        let is_unpainted = unpainted.is_some_and(|unpainted| is_other(&unpainted.part));
        let asked = self.asked.as_ref();
        let is_asked = asked.is_some_and(|asked| {
            is_other(&asked.part) || part.is_none_or(|part| part.cloud != asked.cloud)
        });
        if is_planned || is_unpainted || is_asked {
            self.task.cancel();
            self.planned = None;
            self.unpainted = None;
            self.failed = None;
            self.asked = None;
            self.answered = None;
            self.time = 0.0;
            self.playback = Playback::Paused;
        }
    }

    /// True if no job runs and none will start with the next frame.
    pub(super) fn is_idle(&self, session: &Session) -> bool {
        let is_front = session.workspace == WorkspaceKind::Paint;
        let is_waiting = is_front
            && (self.request(session) != self.asked
                || self.reach_request(session) != self.reach_asked);
        !is_waiting && self.running().is_none() && self.writing().is_none()
    }

    /// The part to paint: the one chosen, else the one recognised last, else, if none was recognised, the first.
    pub fn part<'a>(&self, session: &'a Session) -> Option<&'a PartName> {
        Some(&self.enrolled(session)?.name)
    }

    /// The library's entry of the part to paint.
    pub(super) fn enrolled<'a>(&self, session: &'a Session) -> Option<&'a PartMeta> {
        let parts = &session.library.as_ref()?.parts;
        let named = |name: &str| parts.iter().find(|part| part.name.as_str() == name);
        let chosen = self.design.part.as_ref();
        let chosen = chosen.and_then(|chosen| named(chosen.as_str()));
        if chosen.is_some() {
            return chosen;
        }
        let shown = session.shown.as_ref();
        let inspection = shown.map(|shown| &shown.inspected.inspection);
        match inspection.map(|inspection| (&inspection.verdict, inspection.reference())) {
            Some((Verdict::Part { part, .. }, reference)) => recognised(part, reference, parts),
            _ => parts.first(),
        }
    }

    /// The path stored with the part, if any.
    pub fn stored<'a>(&self, session: &'a Session) -> Option<&'a SprayPath> {
        let library = session.library.as_ref()?;
        let index = library.index_of(self.part(session)?.as_str())?;
        Some(&library.spray_paths.get(index)?.as_ref()?.path)
    }

    /// Carries out an action.
    pub fn apply(&mut self, action: PaintAction, cx: &mut ShellContext<'_>) {
        let before = self.design.clone();
        let part = self.part(cx.session);
        let is_step = matches!(action, PaintAction::Undo | PaintAction::Redo);
        self.carry_out(action, cx);
        // Corrections refer to points and strokes of the former path.
        let is_corrected = !is_step && !self.design.edits.is_empty();
        let is_same_path = self.part(cx.session) == part && self.design.is_same_path(&before);
        if is_corrected && !is_same_path {
            self.design.edits.clear();
            cx.notify(Notice::look(
                text!("paint-edits-dropped"),
                text!("paint-edits-dropped-advice"),
            ));
        }
        self.forget_other_part(cx.session);
    }

    fn carry_out(&mut self, action: PaintAction, cx: &mut ShellContext<'_>) {
        match action {
            PaintAction::ChoosePart(part) => self.choose_part(part, cx),
            PaintAction::ChooseSide(side) => self.choose_side(side, cx),
            PaintAction::ChooseCoat(name) => self.choose_coat(&name, cx),
            PaintAction::Change(key, change) => self.change_parameter(key, change, cx),
            PaintAction::ResetCoat => self.change(|design| design.coat = design.kept.recipe),
            PaintAction::Name(name) => {
                self.naming = name;
                cx.send(Action::RemoveNotices(NoticeTopic::CoatName));
            }
            PaintAction::SaveCoat => self.save_coat(cx),
            PaintAction::Show(path) => self.shown_path = path,
            PaintAction::ShowTab(tab) => cx.send(Action::ShowPaintTab(tab)),
            PaintAction::Use(tool) => {
                self.tool = tool;
                if tool != PaintTool::Look {
                    cx.send(Action::ShowPaintTab(PaintTab::Regions));
                }
            }
            PaintAction::Add(regions) => self.add(regions, cx.session),
            PaintAction::Edit(edit) => self.draw(cx.session, |design| design.edits.push(edit)),
            PaintAction::Clear => self.change(Design::clear),
            PaintAction::Undo => self.step(UndoDirection::Undo, cx),
            PaintAction::Redo => self.step(UndoDirection::Redo, cx),
            PaintAction::Propose => {
                self.shown_path = ShownPath::Planned;
                self.plan(true, cx);
            }
            PaintAction::Store => self.store_shown(cx),
            PaintAction::ToggleFilm => self.is_film_shown = !self.is_film_shown,
            PaintAction::Ask(file) => {
                // Refuse before the user chooses a file.
                if file == PaintFile::Program
                    && let Some(error) = self.why_no_program(cx.session)
                {
                    return cx.notify(Notice::from(error).about(NoticeTopic::Program));
                }
                let lock = &cx.services.dialogs;
                let request = file.request(self.part(cx.session), cx.session);
                self.dialog.open(file, &request, lock, cx.egui);
            }
            PaintAction::Chosen(PaintFile::Table, file) => self.write_table(file),
            PaintAction::Chosen(PaintFile::Program, file) => self.export_program(file, cx),
            PaintAction::Chosen(PaintFile::Arm, file) => {
                let setup = ProgramSetup {
                    arm: Some(file.display().to_string()),
                    ..cx.session.program.clone()
                };
                self.set_up(setup, cx);
            }
            PaintAction::Chosen(PaintFile::Obstacles, file) => {
                let setup = ProgramSetup {
                    obstacles: Some(file.display().to_string()),
                    ..cx.session.program.clone()
                };
                self.set_up(setup, cx);
            }
            PaintAction::SetUp(setup) => self.set_up(setup, cx),
            PaintAction::ShowUnreached => self.show_unreached(cx.session),
            PaintAction::Scrub(time) => {
                self.playback = Playback::Paused;
                self.go_to(time);
            }
            PaintAction::Step(strokes) => {
                self.playback = Playback::Paused;
                self.go_by(strokes);
            }
            PaintAction::TogglePlay => self.toggle_play(),
            PaintAction::Advance(seconds) => self.advance(seconds),
        }
    }

    fn store_shown(&mut self, cx: &ShellContext<'_>) {
        let Some(planned) = self.planned.as_ref().filter(|_| !self.is_old(cx.session)) else {
            return;
        };
        let (part, path) = (planned.part.clone(), SprayPath::clone(&planned.path));
        self.store(None, part, Some(path), cx);
    }

    /// Stores a path with a part, or removes the one it has.
    pub(super) fn store(
        &mut self,
        way: Option<UndoDirection>,
        part: PartName,
        path: Option<SprayPath>,
        cx: &ShellContext<'_>,
    ) {
        if self.is_storing() {
            return;
        }
        self.pending = Some((way, Step::Stored(part.clone(), path.clone())));
        let library_cache = cx.services.library_cache.clone();
        self.storing.start(text!("paint-storing"), move |_| {
            Ok(work::store(&part, path.as_ref(), &library_cache)?)
        });
    }

    /// Stores the side that the part is painted from with it; corrections by hand belong to a path over another side.
    fn choose_side(&mut self, side: Side, cx: &ShellContext<'_>) {
        let part = self.part(cx.session).cloned();
        let Some(part) = part.filter(|_| !self.is_storing()) else {
            return;
        };
        self.change(|design| design.edits.clear());
        let library_cache = cx.services.library_cache.clone();
        self.storing.start(text!("paint-storing-side"), move |_| {
            Ok(work::choose_side(&part, side, &library_cache)?)
        });
    }

    fn write_table(&mut self, file: PathBuf) {
        let Some(planned) = self.planned.clone() else {
            return;
        };
        let title = text!("shell-writing", file = file_name(&file));
        self.writing.start(title, move |_| {
            let written = work::write(&file, &planned.part, &planned.path)?;
            Ok(Notice::done(written))
        });
    }

    /// The present request, if there is a part.
    fn request(&self, session: &Session) -> Option<Request> {
        let library = session.library.as_ref()?;
        let part = self.enrolled(session)?;
        Some(Request {
            part: part.name.clone(),
            cloud: part.cloud.clone(),
            library: library.identity.clone(),
            side: part.side,
            stored: part.spray.clone(),
            coat: self.design.coat,
            regions: self.design.regions.clone(),
            edits: self.design.edits.clone(),
            shown: self.shown_path,
        })
    }

    fn plan(&mut self, is_proposal: bool, cx: &ShellContext<'_>) {
        let Some(request) = self.request(cx.session) else {
            return;
        };
        self.asked = Some(request.clone());
        let library_cache = cx.services.library_cache.clone();
        let title = if is_proposal {
            text!("paint-proposing")
        } else {
            text!("paint-planning")
        };
        let is_unseen = self.planned.is_none() && self.unpainted.is_none();
        self.task.start(title, move |context| {
            if is_unseen {
                context.partial(work::unpainted(&request.part, &library_cache)?);
            }
            work::planned(&request, is_proposal, &library_cache, context)
        });
    }

    /// Takes in the results of the tasks and of the file dialog, and plans if needed.
    pub fn update(&mut self, cx: &mut ShellContext<'_>) {
        if cx.session.paint_tab != PaintTab::Regions {
            // A drag draws only while the tools for it are in sight.
            self.tool = PaintTool::Look;
        }
        self.follow_part(cx);
        while let Some(event) = self.task.poll() {
            match event {
                Ok(result) => self.receive(result, cx),
                Err(error) => self.failed = Some(error),
            }
        }
        match self.storing.poll() {
            Some(Ok(result)) => self.receive(result, cx),
            Some(Err(error)) => {
                // Keep a step that failed, so that it can be tried again.
                if let Some((Some(way), step)) = self.pending.take() {
                    self.steps.from(way).push(step);
                }
                cx.notify(error);
            }
            None => {}
        }
        cx.notify_written(&mut self.writing);
        if let Some((file, path)) = cx.chosen(&mut self.dialog) {
            self.apply(PaintAction::Chosen(file, path), cx);
        }
        if self.shown_path == ShownPath::Stored && self.stored(cx.session).is_none() {
            self.shown_path = ShownPath::Planned;
        }
        self.forget_other_part(cx.session);
        let is_front = cx.session.workspace == WorkspaceKind::Paint;
        if is_front && self.request(cx.session) != self.asked {
            self.plan(false, cx);
        }
        self.update_reach(cx);
    }

    /// Handles an event of the shell.
    pub(super) fn on_event(&mut self, event: &Event, cx: &mut ShellContext<'_>) {
        match event {
            Event::Escape if cx.session.workspace == WorkspaceKind::Paint => {
                self.tool = PaintTool::Look;
            }
            Event::Undo(WorkspaceKind::Paint) => self.undo_storing(cx),
            _ => {}
        }
    }

    fn show(&mut self, planned: Arc<Planned>) {
        self.failed = None;
        self.unpainted = None;
        self.planned = Some(planned);
        self.answered.clone_from(&self.asked);
        self.go_to(self.time);
    }

    fn receive(&mut self, result: PaintResult, cx: &mut ShellContext<'_>) {
        match result {
            PaintResult::Unpainted(part) => self.unpainted = Some(part),
            PaintResult::Planned(planned) => self.show(planned),
            PaintResult::Proposed(planned) => {
                // Drop a proposal if the design has changed meanwhile.
                if self.request(cx.session) == self.asked {
                    self.change(|design| {
                        design.coat = planned.coat;
                        design.edits.clear();
                    });
                    self.asked = self.request(cx.session);
                    self.show(planned);
                }
            }
            PaintResult::SideChosen(library) => {
                let saved = None;
                cx.send(Action::LibraryChanged { library, saved });
            }
            PaintResult::Stored {
                part,
                former,
                num_points,
                library,
            } => {
                let title = library.title_of(part.as_str()).to_owned();
                let what = match num_points {
                    Some(count) => text!("enrol-stored-path", count = count, part = title),
                    None => text!("enrol-removed-path", part = title),
                };
                let step = Step::Stored(part, former);
                let way = self.pending.take().and_then(|(way, _)| way);
                self.steps.add_inverse(way, step);
                cx.notify(match way {
                    Some(UndoDirection::Undo) => Notice::done(what),
                    _ => Notice::undoable(what, WorkspaceKind::Paint),
                });
                let saved = None;
                cx.send(Action::LibraryChanged { library, saved });
            }
        }
    }
}

/// The entry of a recognised part: the reference found, since each has a frame and a path of its own; if that is no longer
/// enrolled, the part's own reference, else another one of the part. Never another part.
fn recognised<'a>(
    part: &str,
    reference: Option<&str>,
    parts: &'a [PartMeta],
) -> Option<&'a PartMeta> {
    let references = parts.iter();
    let references = references.filter(|entry| entry.part_name().as_str() == part);
    references.min_by_key(|entry| match entry.name.as_str() {
        name if reference == Some(name) => 0,
        name if name == part => 1,
        _ => 2,
    })
}

/// An action in the workspace.
#[derive(Clone, Debug, PartialEq)]
pub enum PaintAction {
    /// Paint this enrolled part.
    ChoosePart(PartName),
    /// Paint the part from this side from now on.
    ChooseSide(Side),
    /// Use the coat of this name.
    ChooseCoat(String),
    /// Change the parameter with this key.
    Change(&'static str, ParameterChange),
    /// Reset every parameter to the saved coat.
    ResetCoat,
    /// Set the name being entered for the coat; `None` closes the field.
    Name(Option<String>),
    /// Save the coat under the entered name.
    SaveCoat,
    /// Choose the path to show.
    Show(ShownPath),
    /// Show this tab.
    ShowTab(PaintTab),
    /// Choose what a left drag in the view does; the tab of the regions shows the tools for all but turning the view.
    Use(PaintTool),
    /// Add these regions; new areas to be painted join the earlier ones.
    Add(Vec<KeepOut>),
    /// Correct the path by hand.
    Edit(PathEdit),
    /// Remove all regions and corrections by hand.
    Clear,
    /// Undo the last step.
    Undo,
    /// Redo the step undone last.
    Redo,
    /// Propose row spacing and speed.
    Propose,
    /// Store the path with the part.
    Store,
    /// Switch between colours by film and plain shape.
    ToggleFilm,
    /// Set arm and gun for robot programs.
    SetUp(ProgramSetup),
    /// Move to the next point that the arm does not reach.
    ShowUnreached,
    /// Ask for a file.
    Ask(PaintFile),
    /// A file was chosen.
    Chosen(PaintFile, PathBuf),
    /// Move to this time on the path, seconds.
    Scrub(f64),
    /// Move by this many strokes.
    Step(i32),
    /// Play or pause.
    TogglePlay,
    /// Advance playback by this many seconds.
    Advance(f64),
}

/// The path shown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ShownPath {
    /// The path planned with the coat.
    #[default]
    Planned,
    /// The path stored with the part.
    Stored,
}

/// A file that a person is asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PaintFile {
    /// The table that the path is written to.
    Table,
    /// The robot program that the path is written to.
    Program,
    /// The arm, a TOML file.
    Arm,
    /// The cell's boxes and floor, a TOML file.
    Obstacles,
}

impl PaintFile {
    /// The dialog to open. A new file is named after the part, a program as usual for the robot.
    fn request(self, part: Option<&PartName>, session: &Session) -> FileRequest {
        let part = part.map_or("part", PartName::as_str);
        match self {
            Self::Program => FileRequest {
                title: text!("paint-program-title"),
                filters: vec![program_files()],
                choice: FileChoice::NewFile(program_file_name(
                    part,
                    &session.program,
                    session.convention,
                )),
            },
            Self::Arm => FileRequest {
                title: text!("paint-arm-title"),
                filters: vec![("TOML".into(), &["toml"]), all_files()],
                choice: FileChoice::File,
            },
            Self::Obstacles => FileRequest {
                title: text!("paint-obstacles-title"),
                filters: vec![("TOML".into(), &["toml"]), all_files()],
                choice: FileChoice::File,
            },
            Self::Table => FileRequest {
                title: text!("paint-export-title"),
                filters: vec![(text!("shell-csv-files"), &["csv"])],
                choice: FileChoice::NewFile(format!("{part}-path.csv")),
            },
        }
    }
}

#[cfg(test)]
mod tests;
