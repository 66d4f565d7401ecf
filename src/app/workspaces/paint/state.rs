//! What the workspace knows, and what changes it.

use std::{path::PathBuf, sync::Arc};

use super::{
    action::{PaintAction, PaintFile, ShownPath},
    region::PaintTool,
    work::{self, PaintResult, Planned, Request},
};
use crate::{
    app::{
        inspection::source::file_name,
        language::text,
        shell::{
            context::ShellContext,
            file_dialog::FileDialog,
            message::{Event, Message},
            notice::Notice,
            session::{Session, WorkspaceKind},
        },
        task::{Running, Task, TaskEvent, TaskRunner},
        ui::parameter_control::ParameterChange,
        user_error::UserError,
    },
    error::Advice as _,
    library::{PartName, SprayPath},
    paint::{BUILT_IN_COATS, Coat, CoatFolder, KeepOut, PathEdit, built_in_coat},
    pipeline::{RecipeFile, Replace, Verdict, parameters::Parameter},
};

/// What is painted how: what Undo brings back.
#[derive(Clone, Debug, PartialEq)]
pub struct Design {
    /// The part; none before one was chosen.
    pub part: Option<PartName>,
    /// The coat as it is kept.
    pub kept: RecipeFile<Coat>,
    /// The coat as it is now.
    pub coat: Coat,
    /// Where paint goes and where not.
    pub regions: Vec<KeepOut>,
    /// What was corrected by hand in the path that they give.
    pub edits: Vec<PathEdit>,
}

/// A step that can be taken back.
#[derive(Clone, Debug)]
enum Step {
    /// The design as it was.
    Design(Box<Design>),
    /// The path that was stored with a part.
    Stored(PartName, Option<SprayPath>),
}

/// More steps than this are forgotten, the oldest first.
const MAX_STEPS: usize = 100;

/// Whether the gun moves by itself.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Playback {
    /// It stands.
    #[default]
    Paused,
    /// It moves on.
    Playing,
}

/// Which way a path that was stored goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Way {
    First,
    Back,
    Again,
}

/// What the workspace knows.
#[derive(Debug)]
pub struct PaintState {
    /// What is painted how.
    pub design: Design,
    /// Which path is shown.
    pub shown_path: ShownPath,
    /// The last path, its film, and what they were made of.
    pub planned: Option<Arc<Planned>>,
    /// Why there is no path for what was asked last.
    pub failed: Option<UserError>,
    /// What a left drag does.
    pub tool: PaintTool,
    /// True if the part is coloured by its film.
    pub is_film_shown: bool,
    /// Place on the timeline, seconds.
    pub time: f64,
    /// Whether it moves on.
    pub playback: Playback,
    /// The name that is being written for the coat.
    pub naming: Option<String>,
    /// Names of all coats.
    pub coats: Vec<String>,
    coat_folder: Option<CoatFolder>,
    asked: Option<Request>,
    done: Vec<Step>,
    undone: Vec<Step>,
    task: Task<PaintResult>,
    storing: Task<PaintResult>,
    way: Way,
    writing: Task<PathBuf>,
    dialog: FileDialog<PaintFile>,
}

impl PaintState {
    /// Before a part was chosen; the user's coats are in `coats`.
    pub fn new(coats: Option<PathBuf>, runner: &TaskRunner) -> Self {
        let kept = built_in_coat(BUILT_IN_COATS[0]).expect("the program has it");
        Self {
            design: Design {
                part: None,
                coat: kept.recipe,
                kept,
                regions: Vec::new(),
                edits: Vec::new(),
            },
            shown_path: ShownPath::default(),
            planned: None,
            failed: None,
            tool: PaintTool::default(),
            is_film_shown: true,
            time: 0.0,
            playback: Playback::default(),
            naming: None,
            coats: BUILT_IN_COATS.map(str::to_owned).to_vec(),
            coat_folder: coats.map(CoatFolder::at),
            asked: None,
            done: Vec::new(),
            undone: Vec::new(),
            task: Task::new("paint", runner),
            storing: Task::new("paint-store", runner),
            way: Way::First,
            writing: Task::new("paint-write", runner),
            dialog: FileDialog::default(),
        }
    }

    /// The run that plans or stores, if any.
    pub fn running(&self) -> Option<&Running> {
        self.task.running().or_else(|| self.storing.running())
    }

    /// True while a path is being stored.
    pub fn is_storing(&self) -> bool {
        self.storing.running().is_some()
    }

    /// The file being written, if any.
    pub fn writing(&self) -> Option<&Running> {
        self.writing.running()
    }

    /// True if there is something to take back, and something to do again.
    pub fn can_undo(&self) -> [bool; 2] {
        [!self.done.is_empty(), !self.undone.is_empty()]
    }

    /// Regions that a person has drawn and whose path is not stored, in words.
    pub(super) fn unsaved(&self) -> Option<String> {
        let is_stored = self
            .planned
            .as_ref()
            .is_some_and(|planned| planned.is_stored);
        let is_drawn = !self.design.regions.is_empty() || !self.design.edits.is_empty();
        (is_drawn && !is_stored).then(|| text!("paint-unsaved"))
    }

    /// Stops planning; what was shown stays.
    pub fn cancel(&mut self) {
        self.task.cancel();
    }

    /// True while what is shown is not what was asked for last.
    pub fn is_old(&self, session: &Session) -> bool {
        let is_asked = self.request(session) == self.asked;
        !is_asked || self.task.running().is_some() || self.failed.is_some()
    }

    /// True if nothing is at work, nor waits for the next frame to begin.
    pub(super) fn is_idle(&self, session: &Session) -> bool {
        let is_front = session.workspace == WorkspaceKind::Paint;
        let is_waiting = is_front && self.request(session) != self.asked;
        !is_waiting && self.running().is_none() && self.writing().is_none()
    }

    /// The part that is painted: the one chosen, else the one that was recognised last, else the first.
    pub fn part<'a>(&'a self, session: &'a Session) -> Option<&'a PartName> {
        let parts = &session.library.as_ref()?.parts;
        let names = || parts.iter().map(|part| &part.name);
        let chosen = self.design.part.as_ref();
        let chosen = chosen.and_then(|chosen| names().find(|name| *name == chosen));
        let recognised = || {
            let verdict = &session.shown.as_ref()?.inspected.inspection.verdict;
            let Verdict::Part { part, .. } = verdict else {
                return None;
            };
            names().find(|name| name.as_str() == part)
        };
        chosen.or_else(recognised).or_else(|| names().next())
    }

    /// The path that is stored with the part, if one is.
    pub fn stored<'a>(&self, session: &'a Session) -> Option<&'a SprayPath> {
        let library = session.library.as_ref()?;
        let place = library.place_of(self.part(session)?.as_str())?;
        library.spray_paths.get(place)?.as_ref()
    }

    /// Carries out an action.
    pub fn apply(&mut self, action: PaintAction, cx: &mut ShellContext<'_>) {
        let before = self.design.clone();
        let is_step = matches!(action, PaintAction::Undo | PaintAction::Redo);
        self.carry_out(action, cx);
        // Points and strokes of another path are others.
        let is_corrected = !is_step && !self.design.edits.is_empty();
        if is_corrected && !self.design.is_same_path(&before) {
            self.design.edits.clear();
            cx.notify(Notice::look(
                text!("paint-edits-dropped"),
                text!("paint-edits-dropped-advice"),
            ));
        }
    }

    fn carry_out(&mut self, action: PaintAction, cx: &mut ShellContext<'_>) {
        match action {
            PaintAction::ChoosePart(part) => {
                let is_other = self.part(cx.session) != Some(&part);
                self.change(|design| {
                    design.part = Some(part);
                    if is_other {
                        design.regions.clear();
                    }
                });
            }
            PaintAction::ChooseCoat(name) => self.choose_coat(&name, cx),
            PaintAction::Change(key, change) => self.change_parameter(key, change, cx),
            PaintAction::ResetCoat => self.change(|design| design.coat = design.kept.recipe),
            PaintAction::Name(name) => self.naming = name,
            PaintAction::SaveCoat => self.save_coat(cx),
            PaintAction::Show(path) => self.shown_path = path,
            PaintAction::Use(tool) => self.tool = tool,
            PaintAction::Add(regions) => self.add(regions),
            PaintAction::Edit(edit) => self.change(|design| design.edits.push(edit)),
            PaintAction::Clear => self.change(|design| {
                design.regions.clear();
                design.edits.clear();
            }),
            PaintAction::Undo => self.step(Way::Back, cx),
            PaintAction::Redo => self.step(Way::Again, cx),
            PaintAction::Propose => {
                self.shown_path = ShownPath::Planned;
                self.plan(true, cx);
            }
            PaintAction::Store => self.store_shown(cx),
            PaintAction::ToggleFilm => self.is_film_shown = !self.is_film_shown,
            PaintAction::Ask(file) => {
                let lock = &cx.services.dialogs;
                self.dialog.open(file, &file.request(), lock, cx.egui);
            }
            PaintAction::Chosen(PaintFile::Table, file) => self.write_table(file),
            PaintAction::Scrub(time) => {
                self.playback = Playback::Paused;
                self.go_to(time);
            }
            PaintAction::Step(strokes) => {
                self.playback = Playback::Paused;
                self.go_by(strokes);
            }
            PaintAction::TogglePlay => self.toggle_play(),
            PaintAction::Advance(seconds) => {
                if self.playback == Playback::Playing {
                    self.go_to(self.time + seconds);
                    if self.time >= self.duration() {
                        self.playback = Playback::Paused;
                    }
                }
            }
        }
    }

    /// Changes the design; Undo brings back what it was.
    fn change(&mut self, change: impl FnOnce(&mut Design)) {
        let before = self.design.clone();
        change(&mut self.design);
        if self.design == before {
            return;
        }
        self.shown_path = ShownPath::Planned;
        self.undone.clear();
        self.done.push(Step::Design(Box::new(before)));
        if self.done.len() > MAX_STEPS {
            self.done.remove(0);
        }
    }

    fn change_parameter(
        &mut self,
        key: &'static str,
        change: ParameterChange,
        cx: &mut ShellContext<'_>,
    ) {
        let Some(parameter) = Parameter::<Coat>::of_key(key) else {
            return;
        };
        let mut coat = self.design.coat;
        match change {
            ParameterChange::Reset => parameter.copy(&self.design.kept.recipe, &mut coat),
            ParameterChange::Set(value) => {
                if let Err(error) = parameter.set(&mut coat, value) {
                    cx.notify(UserError::of(&error));
                    return;
                }
            }
        }
        // A slider that is being drawn is one step.
        let is_same_slider = matches!(self.done.last(), Some(Step::Design(before))
            if self.undone.is_empty() && differs_by(&before.coat, &self.design.coat, parameter)
                && before.regions == self.design.regions && before.part == self.design.part);
        if is_same_slider && cx.egui.input(|input| input.pointer.any_down()) {
            self.design.coat = coat;
        } else {
            self.change(|design| design.coat = coat);
        }
    }

    fn choose_coat(&mut self, name: &str, cx: &mut ShellContext<'_>) {
        let found = match (built_in_coat(name), &self.coat_folder) {
            (Some(own), _) => Ok(own),
            (None, Some(folder)) => folder.open(name),
            (None, None) => return,
        };
        match found {
            Ok(kept) => self.change(|design| {
                design.coat = kept.recipe;
                design.kept = kept;
            }),
            Err(error) => cx.notify(UserError::of(&error)),
        }
    }

    /// Lists the coats anew: files may have been added.
    pub(super) fn list_coats(&mut self, cx: &mut ShellContext<'_>) {
        let Some(folder) = &self.coat_folder else {
            return;
        };
        match folder.names() {
            Ok(names) => self.coats = names,
            Err(error) => cx.notify(UserError::of(&error)),
        }
    }

    fn save_coat(&mut self, cx: &mut ShellContext<'_>) {
        let Some(written) = &self.naming else { return };
        let Some(folder) = &self.coat_folder else {
            cx.notify(Notice::look(
                text!("paint-no-coat-folder"),
                text!("paint-no-coat-folder-advice"),
            ));
            return;
        };
        let name = match PartName::new(written.trim()) {
            Ok(name) => name,
            Err(error) => {
                cx.notify(Notice::look(error.to_string(), error.advice()));
                return;
            }
        };
        let coat = RecipeFile {
            name,
            notes: self.design.kept.notes.clone(),
            recipe: self.design.coat,
        };
        // What is kept under the name that the coat has is what is being changed.
        let replace = if coat.name == self.design.kept.name {
            Replace::Yes
        } else {
            Replace::No
        };
        match folder.save(&coat, replace) {
            Ok(()) => {
                let name = coat.name.to_string();
                cx.notify(Notice::done(text!("paint-saved-coat", coat = name)));
                self.naming = None;
                self.change(|design| design.kept = coat);
                self.list_coats(cx);
            }
            Err(error) => cx.notify(UserError::of(&error)),
        }
    }

    /// Areas to be painted are one region together; others stand for themselves.
    fn add(&mut self, regions: Vec<KeepOut>) {
        self.change(|design| {
            for region in regions {
                let former = design.regions.iter_mut().find_map(|former| match former {
                    KeepOut::Outside { areas } => Some(areas),
                    KeepOut::Sphere { .. } | KeepOut::Polygon { .. } => None,
                });
                match (region, former) {
                    (KeepOut::Outside { areas }, Some(former)) => former.extend(areas),
                    (region, _) => design.regions.push(region),
                }
            }
        });
    }

    /// Takes the last step back, or does it again.
    fn step(&mut self, way: Way, cx: &ShellContext<'_>) {
        if self.is_storing() {
            return;
        }
        let from = match way {
            Way::Back | Way::First => &mut self.done,
            Way::Again => &mut self.undone,
        };
        match from.pop() {
            None => {}
            Some(Step::Design(other)) => {
                let now = std::mem::replace(&mut self.design, *other);
                let to = match way {
                    Way::Back | Way::First => &mut self.undone,
                    Way::Again => &mut self.done,
                };
                to.push(Step::Design(Box::new(now)));
                self.shown_path = ShownPath::Planned;
            }
            Some(Step::Stored(part, former)) => self.store(way, part, former, cx),
        }
    }

    fn store_shown(&mut self, cx: &ShellContext<'_>) {
        let Some(planned) = self.planned.as_ref().filter(|_| !self.is_old(cx.session)) else {
            return;
        };
        let (part, path) = (planned.part.clone(), planned.path.clone());
        self.store(Way::First, part, Some(path), cx);
    }

    fn store(&mut self, way: Way, part: PartName, path: Option<SprayPath>, cx: &ShellContext<'_>) {
        if self.is_storing() {
            return;
        }
        self.way = way;
        let library_cache = cx.services.library_cache.clone();
        self.storing.start(text!("paint-storing"), move |_| {
            Ok(work::store(&part, path.as_ref(), &library_cache)?)
        });
    }

    fn write_table(&mut self, file: PathBuf) {
        let Some(planned) = self.planned.clone() else {
            return;
        };
        let title = text!("paint-writing", file = file_name(&file));
        self.writing
            .start(title, move |_| Ok(work::write(file, &planned.path)?));
    }

    /// The whole path, seconds.
    pub fn duration(&self) -> f64 {
        let planned = self.planned.as_ref();
        planned.map_or(0.0, |planned| planned.course.duration())
    }

    fn go_to(&mut self, time: f64) {
        self.time = time.clamp(0.0, self.duration());
    }

    /// To the beginning of a stroke before or behind.
    fn go_by(&mut self, strokes: i32) {
        let Some(planned) = &self.planned else { return };
        let course = &planned.course;
        let begins = course.strokes.iter().map(|stroke| course.times(*stroke)[0]);
        let begins: Vec<f64> = begins.collect();
        // Just begun, the one before is meant.
        let now = begins.partition_point(|begin| *begin <= self.time + 1e-6) as i32 - 1;
        let wanted = usize::try_from(now + strokes).unwrap_or(0);
        let time = begins.get(wanted).copied().unwrap_or(course.duration());
        self.go_to(time);
    }

    fn toggle_play(&mut self) {
        self.playback = match self.playback {
            Playback::Paused if self.duration() > 0.0 => {
                if self.time >= self.duration() {
                    self.time = 0.0;
                }
                Playback::Playing
            }
            Playback::Playing | Playback::Paused => Playback::Paused,
        };
    }

    /// What is asked for now, if there is a part.
    fn request(&self, session: &Session) -> Option<Request> {
        let library = session.library.as_ref()?;
        let part = self.part(session)?.clone();
        let place = library.place_of(part.as_str())?;
        Some(Request {
            part,
            library: library.identity.clone(),
            stored: library.parts.get(place)?.spray.clone(),
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
        self.task.start(title, move |context| {
            work::planned(&request, is_proposal, &library_cache, context)
        });
    }

    /// Takes in what the tasks and the dialog report, and plans what is not planned yet.
    pub fn update(&mut self, cx: &mut ShellContext<'_>) {
        while let Some(event) = self.task.poll() {
            match event {
                TaskEvent::Partial(result) | TaskEvent::Done(result) => self.receive(result, cx),
                TaskEvent::Failed(error) => self.failed = Some(error),
            }
        }
        match self.storing.poll() {
            Some(TaskEvent::Done(result) | TaskEvent::Partial(result)) => self.receive(result, cx),
            Some(TaskEvent::Failed(error)) => cx.notify(error),
            None => {}
        }
        match self.writing.poll() {
            Some(TaskEvent::Done(path)) => {
                let path = path.display().to_string();
                cx.notify(Notice::done(text!("paint-wrote", path = path)));
            }
            Some(TaskEvent::Failed(error)) => cx.notify(error),
            Some(TaskEvent::Partial(_)) | None => {}
        }
        match self.dialog.poll() {
            Some((file, Ok(path))) => self.apply(PaintAction::Chosen(file, path), cx),
            Some((_, Err(notice))) => cx.notify(notice),
            None => {}
        }
        if self.shown_path == ShownPath::Stored && self.stored(cx.session).is_none() {
            self.shown_path = ShownPath::Planned;
        }
        let is_front = cx.session.workspace == WorkspaceKind::Paint;
        if is_front && self.request(cx.session) != self.asked {
            self.plan(false, cx);
        }
    }

    /// Handles an event of the shell.
    pub(super) fn on_event(&mut self, event: &Event, cx: &ShellContext<'_>) {
        if matches!(event, Event::Escape) && cx.session.workspace == WorkspaceKind::Paint {
            self.tool = PaintTool::Look;
        }
    }

    fn show(&mut self, planned: Arc<Planned>) {
        self.failed = None;
        self.planned = Some(planned);
        self.go_to(self.time);
    }

    fn receive(&mut self, result: PaintResult, cx: &mut ShellContext<'_>) {
        match result {
            PaintResult::Planned(planned) => self.show(planned),
            PaintResult::Proposed(planned) => {
                // A design that was changed meanwhile is planned as it is.
                if self.request(cx.session) == self.asked {
                    self.change(|design| {
                        design.coat = planned.coat;
                        design.edits.clear();
                    });
                    self.asked = self.request(cx.session);
                    self.show(planned);
                }
            }
            PaintResult::Stored {
                part,
                former,
                num_points,
                library,
            } => {
                let title = library.title_of(part.as_str()).to_owned();
                let what = match num_points {
                    Some(count) => text!("paint-stored", count = count, part = title),
                    None => text!("paint-path-removed", part = title),
                };
                let step = Step::Stored(part, former);
                match self.way {
                    Way::Back => self.undone.push(step),
                    Way::Again => self.done.push(step),
                    Way::First => {
                        self.undone.clear();
                        self.done.push(step);
                    }
                }
                cx.notify(Notice::done(what));
                let saved = None;
                cx.send(Message::LibraryChanged { library, saved });
            }
        }
    }
}

impl Design {
    /// True if the same path is planned of both, before corrections by hand.
    fn is_same_path(&self, other: &Self) -> bool {
        (&self.part, &self.coat, &self.regions) == (&other.part, &other.coat, &other.regions)
    }

    /// True if the coat differs from what is kept under its name.
    pub fn is_coat_changed(&self) -> bool {
        self.coat != self.kept.recipe
    }
}

/// True if two coats differ by this parameter alone.
fn differs_by(a: &Coat, b: &Coat, parameter: &Parameter<Coat>) -> bool {
    let mut same = *a;
    parameter.copy(b, &mut same);
    a != b && same == *b
}

#[cfg(test)]
mod tests;
