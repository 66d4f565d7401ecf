//! The window as eframe drives it: polls tasks, draws the last results, applies the user's actions.

use std::{
    io,
    path::{Path, PathBuf},
    sync::Arc,
    time::Duration,
};

use eframe::egui_wgpu::RenderState;
use egui::{CentralPanel, Frame, LayerId, Ui};

use super::workspaces::{
    align::AlignWorkspace,
    compare::CompareWorkspace,
    enrol::EnrolWorkspace,
    history::HistoryWorkspace,
    inspect::{InspectWorkspace, WorkCounts},
    paint::PaintWorkspace,
    servo::ServoWorkspace,
};
use files::{FileLock, disk, file_of};
use inspection::pipeline::{RecipeFolder, open_recipe};
use records::{
    cases::CaseFolder,
    history::{HistoryBuffer, Writer},
};
use robot::{cell_check::CellCheckFolder, frame_poses::FRAME_POSES};
use shell::{
    action::{Action, DialogRequest, Event},
    apply::apply,
    cell::RobotCell,
    file_dialog::{self, DialogLock, FileDialog},
    frame::{bars, keys, notices, rail, status_bar},
    help::{self, Installation},
    inspection::{
        camera::Camera,
        inspected::Inspected,
        library_cache::{LibraryCache, LoadedLibrary, ReadTakenVersion},
    },
    notice::{Notice, NoticeTopic},
    rack,
    roles::{self, RoleAction},
    session::{Source, ThemeChoice, UserRole, WorkspaceKind},
    settings::{self, Memory},
    source::{
        inspect,
        live::{self, LiveAction},
        source_menu,
    },
    state::{Closing, State, notify, remove_notices},
    trace::{
        entry::{self, KeyTarget},
        expecting,
    },
    workspace::{Services, Workspace},
};
use ui::{
    language::{Language, text},
    task::TaskRunner,
    theme::Theme,
    user_error::UserError,
    viewport::{ViewError, ViewportGpu},
};

mod hosting;

/// Options for opening the window.
#[derive(Clone, Debug, Default)]
pub struct WindowOptions {
    /// The library's folder; `None` for the one chosen last, else the one that the command line would find.
    pub library: Option<PathBuf>,
    /// A captured scene, or the folder of a scan, to open first; `None` to capture from the source.
    pub scene: Option<PathBuf>,
    /// File of the settings, beside which the draft of Enrol is kept; `None` to keep nothing.
    pub settings: Option<PathBuf>,
    /// Folder of kept cases; `None` for the user's own.
    pub cases: Option<PathBuf>,
    /// Folder of the user's recipes; `None` to keep none.
    pub recipes: Option<PathBuf>,
    /// Folder of the history; `None` to keep inspections only in memory.
    pub history: Option<PathBuf>,
    /// File of the user's own calibration of the robot's cell; `None` to use none.
    pub cell: Option<PathBuf>,
    /// Folder of the cell's baseline and checks; `None` to keep none.
    pub cell_checks: Option<PathBuf>,
    /// Opens cameras.
    pub camera: Camera,
    /// Language unless one was chosen in the window; `None` for English.
    pub language: Option<Language>,
    /// Reads from which published version a library was taken; `None` in a build that takes none.
    pub taken_version: Option<ReadTakenVersion>,
    /// A library loaded before, from which the parts that have not changed are taken.
    pub former_library: Option<Arc<LoadedLibrary>>,
}

/// The window.
pub struct Window {
    state: State,
    memory: Memory,
    dialog: FileDialog<DialogRequest>,
    services: Services,
    robot: RobotCell,
    workspaces: Vec<Box<dyn Workspace>>,
    /// Actions that a workspace sent, which are carried out next.
    sent: Vec<Action>,
    installed: Option<ThemeChoice>,
    gpu: Result<ViewportGpu, ViewError>,
    /// Time of the last input, seconds of egui's clock.
    touched: f64,
    /// Tells a second window that this one is open.
    data_lock: DataLock,
}

impl Window {
    /// Starts the threads and requests the first frame. Without a `render_state` the 3-D view shows an error text.
    pub fn new(
        ctx: &egui::Context,
        render_state: Option<&RenderState>,
        options: WindowOptions,
    ) -> io::Result<Self> {
        Theme::install_fonts(ctx);
        let installation = installation(&options);
        let WindowOptions {
            library,
            scene,
            settings,
            cases,
            recipes,
            history,
            cell,
            cell_checks,
            camera,
            language,
            taken_version,
            former_library,
        } = options;
        let is_first_start = settings.as_ref().is_some_and(|path| !path.exists());
        language.unwrap_or_default().make_current();
        let (remembered, problem) = settings.as_deref().map(settings::load).unwrap_or_default();
        let data_lock = DataLock::take(history.as_deref());
        // The other window keeps its settings and its draft there.
        let settings = settings.filter(|_| !data_lock.is_taken);
        let kept = Arc::new(HistoryBuffer::new(history));
        let repaint = ctx.clone();
        let runner = TaskRunner::new(move || repaint.request_repaint());
        let repaint = ctx.clone();
        let history_writer = Writer::start(Arc::clone(&kept), move || repaint.request_repaint())?;
        let library_cache =
            LibraryCache::new(library.or_else(|| remembered.library.clone()), camera)
                .with_history(Arc::clone(&kept))
                .with_versions(taken_version)
                .with_former(former_library);
        let gpu = render_state
            .map(ViewportGpu::of_window)
            .ok_or_else(|| ViewError::NoDevice {
                reason: "the window draws without one".into(),
            });
        // Coats are kept beside the recipes.
        let coats = recipes.as_ref().map(|path| path.with_file_name("coats"));
        let draft = (settings.as_ref()).map(|path| path.with_file_name("draft.json"));
        let remembered_live = remembered.live;
        let mut window = Self {
            memory: Memory::new(settings, remembered.clone(), &runner),
            state: remembered.into_state(&runner, &library_cache),
            dialog: FileDialog::default(),
            services: Services {
                library_cache,
                dialogs: DialogLock::default(),
            },
            robot: RobotCell::new(cell_checks.map(CellCheckFolder::at), &runner),
            workspaces: vec![
                Box::new(InspectWorkspace::new(&gpu, &runner)),
                Box::new(EnrolWorkspace::new(gpu.clone(), draft, &runner)),
                Box::new(CompareWorkspace::new(cases, recipes.clone(), &runner)),
                Box::new(AlignWorkspace::new(&gpu, &runner)),
                Box::new(PaintWorkspace::new(&gpu, coats, &runner)),
                Box::new(ServoWorkspace::new(&gpu, &runner)),
                Box::new(HistoryWorkspace::new(history_writer, kept, &runner)),
            ],
            sent: Vec::new(),
            installed: None,
            gpu: gpu.clone(),
            touched: ctx.input(|input| input.time),
            data_lock,
        };
        let language = window.state.session.chosen_language.or(language);
        window.state.session.language = language.unwrap_or_default();
        window.state.session.language.make_current();
        window.state.installation = Installation {
            graphics: described_gpu(&gpu),
            ..installation
        };
        let second = window.data_lock.is_taken.then(second_window);
        for notice in problem.map(Notice::from).into_iter().chain(second) {
            notify(&mut window.state, notice);
        }
        if let (true, Some(recipes)) = (is_first_start, recipes) {
            window.use_default_recipe(recipes);
        }
        window.forget_a_vanished_file();
        window.state.session.usual_cell = cell;
        window.with_robot(ctx, RobotCell::load_remembered);
        let is_opened = scene.is_some();
        let first = window.first_action(scene, remembered_live);
        window.state.inspector.loader.load();
        // The first scene is inspected even if Enrol is in front; one that the user names is shown with its result.
        let front = std::mem::take(&mut window.state.session.workspace);
        window.state.inspector.is_start = true;
        if let Some(first) = first {
            window.act(first, ctx);
        }
        window.state.inspector.is_start = false;
        if !is_opened {
            window.state.session.workspace = front;
        }
        Ok(window)
    }

    /// Opens the scene that was named, else follows the source or captures from it.
    fn first_action(&self, scene: Option<PathBuf>, was_live: bool) -> Option<Action> {
        let session = &self.state.session;
        let is_second = self.data_lock.is_taken;
        // If robots were answered before, follow the source: answering them takes frames.
        let follows = (was_live || session.answering.is_on) && !is_second;
        match scene {
            Some(path) => Some(Action::Open(path)),
            None if follows && session.source.followed().is_some() => {
                Some(Action::Live(LiveAction::Toggle))
            }
            // It has no frame yet.
            None if session.source.is_watched() => None,
            // Both windows would count the part that hangs there.
            None if is_second && matches!(session.source, Source::Camera(_)) => None,
            None => Some(Action::Capture),
        }
    }

    /// Uses the user's default recipe, if no recipe is remembered.
    fn use_default_recipe(&mut self, recipes: PathBuf) {
        match open_recipe(Ok(RecipeFolder::at(recipes)), None) {
            Ok(file) => self.state.session.recipe = Arc::new(file.into()),
            Err(error) => notify(&mut self.state, UserError::of(&error).into()),
        }
    }

    /// State of the window outside the workspaces.
    pub fn state(&self) -> &State {
        &self.state
    }

    /// Carries out an action that the user could cause.
    pub fn act(&mut self, action: Action, ctx: &egui::Context) {
        let Some(action) = apply(&mut self.state, action) else {
            return;
        };
        match action {
            Action::Ask(ask) => {
                let lock = &self.services.dialogs;
                self.dialog.open(ask, &notices::request(ask), lock, ctx);
            }
            Action::Press(kind, index) => {
                self.lend(kind, ctx, |workspace, cx| workspace.press(index, cx));
            }
            Action::CancelTask(kind) => {
                self.lend(kind, ctx, |workspace, _| workspace.cancel());
            }
            Action::Take(scene, title) => {
                let front = self.state.session.workspace;
                self.lend(front, ctx, |workspace, cx| {
                    workspace.take_scene(scene, title, cx);
                });
            }
            Action::TakeFile(path) => self.take_file(path, ctx),
            Action::Robot(action) => self.with_robot(ctx, |robot, cx| robot.apply(action, cx)),
            Action::Tell(event) => self.tell(&event, ctx),
            Action::AskEngineer(kind) => {
                self.lend(kind, ctx, |workspace, cx| {
                    workspace.on_event(&Event::EngineerIn, cx);
                });
            }
            Action::Close if self.may_close() => {
                ctx.send_viewport_cmd(egui::ViewportCommand::Close);
            }
            Action::CopyText(text) => ctx.copy_text(text),
            // The user is asked first.
            Action::Close => {}
            other => debug_assert!(
                false,
                "the shell returns what it does not carry out: {other:?}"
            ),
        }
    }

    /// Shows a result made elsewhere as a new inspection; cancels a running one.
    pub fn show_result(&mut self, inspected: Arc<Inspected>, ctx: &egui::Context) {
        let event = inspect::show_made(&mut self.state, inspected);
        self.tell(&event, ctx);
    }

    /// True if nothing would be lost and no robot is answered, or the user has agreed; otherwise asks the user.
    fn may_close(&mut self) -> bool {
        if self.state.closing == Closing::Confirmed {
            return true;
        }
        let all = self.workspaces.iter();
        let mut lost: Vec<String> = all.filter_map(|workspace| workspace.unsaved()).collect();
        lost.extend(self.not_written());
        let is_unsaved = !lost.is_empty();
        let answering = self.robot.answering().status();
        lost.extend(answering.map(|status| {
            let at = status.at.address.to_string();
            text!("shell-robots-without-answer", at = at)
        }));
        let may_close = lost.is_empty();
        self.state.closing = if may_close {
            Closing::No
        } else {
            Closing::Asked {
                what: lost.join("\n"),
                is_unsaved,
            }
        };
        may_close
    }

    /// Describes the inspections that the history cannot write, if any.
    fn not_written(&self) -> Option<String> {
        let history = self.services.library_cache.history();
        // Without a failure, those that wait are about to be written.
        let num = history.next_try().map_or(0, |_| history.num_waiting());
        (num > 0).then(|| text!("shell-not-written", num = num))
    }

    /// Sends an event to every workspace.
    fn tell(&mut self, event: &Event, ctx: &egui::Context) {
        for kind in WorkspaceKind::ALL {
            self.lend(kind, ctx, |workspace, cx| workspace.on_event(event, cx));
        }
    }

    /// The device that the views draw with, which also draws the window.
    pub(super) fn gpu(&self) -> &Result<ViewportGpu, ViewError> {
        &self.gpu
    }

    /// True if the device is lost and nothing can be drawn any more.
    fn is_lost(&self) -> bool {
        self.gpu.as_ref().is_ok_and(ViewportGpu::is_lost)
    }

    /// Work done by the frames of Inspect so far.
    pub fn counts(&self) -> WorkCounts {
        let inspect = self.workspace::<InspectWorkspace>();
        inspect.map_or_else(WorkCounts::default, InspectWorkspace::counts)
    }

    /// Share of the points that the view of Inspect drew in the last frame, 0..1.
    pub fn detail_of_view(&self) -> f32 {
        let inspect = self.workspace::<InspectWorkspace>();
        inspect.map_or(1.0, InspectWorkspace::detail)
    }

    /// Shows a notice that the window was reopened after its device was lost.
    pub(super) fn tell_of_lost_device(&mut self) {
        let lost = UserError {
            what: text!("shell-device-lost"),
            advice: text!("shell-device-lost-advice"),
        };
        notify(&mut self.state, lost.into());
    }

    /// Replaces a source whose file is gone by the simulated cell.
    fn forget_a_vanished_file(&mut self) {
        let session = &mut self.state.session;
        let path = match &session.source {
            Source::File(path) => Some(path),
            Source::Scan(files) => files.frames.first(),
            Source::Cell(_) | Source::Camera(_) => None,
        };
        if let Some(path) = path
            && !file_of(path).exists()
        {
            let gone = UserError {
                what: text!("shell-gone", path = path.display().to_string()),
                advice: text!("shell-gone-advice"),
            };
            session.recent.retain(|known| known != path);
            session.source = Source::default();
            notify(&mut self.state, gone.into());
        }
    }

    fn install_theme(&mut self, ctx: &egui::Context) {
        if self.installed != Some(self.state.session.theme) {
            Theme::install(self.state.session.theme, ctx);
            self.installed = Some(self.state.session.theme);
        }
    }

    /// Opens the first of the files dropped onto the window; a folder is a scan if it contains poses, else it is played as a
    /// recording.
    fn take_drops(&mut self, ctx: &egui::Context) {
        let dropped = ctx.input(|input| {
            let first = input.raw.dropped_files.first();
            first.map(|file| file.path().to_owned())
        });
        if let Some(path) = dropped {
            self.take_file(path, ctx);
        }
    }

    /// Enrols the file if Enrol is in front, else inspects it.
    fn take_file(&mut self, path: PathBuf, ctx: &egui::Context) {
        let is_scan = path.join(FRAME_POSES).is_file();
        let taker = match self.state.session.workspace {
            WorkspaceKind::Enrol => WorkspaceKind::Enrol,
            _ => WorkspaceKind::Inspect,
        };
        let is_taken = self.lend(taker, ctx, |workspace, cx| workspace.take_file(&path, cx));
        if is_taken == Some(true) {
            return;
        }
        let opened = if path.is_dir() && !is_scan {
            Action::Chosen(DialogRequest::Recording, path)
        } else {
            Action::Open(path)
        };
        self.act(opened, ctx);
    }

    /// Handles the results of tasks, the dialog, and input from the desktop.
    pub(super) fn fetch(&mut self, ctx: &egui::Context) {
        self.state.session.language.make_current();
        self.install_theme(ctx);
        if self.is_lost() {
            ctx.send_viewport_cmd(egui::ViewportCommand::Close);
        }
        let is_closed = ctx.input(|input| input.viewport().close_requested());
        if is_closed && !self.is_lost() && !self.may_close() {
            ctx.send_viewport_cmd(egui::ViewportCommand::CancelClose);
        }
        let is_enrolling = self.state.session.workspace == WorkspaceKind::Enrol;
        let enrol = self.hosted(WorkspaceKind::Enrol);
        let has_draft = enrol.is_some_and(|enrol| enrol.unsaved().is_some());
        self.state.inspector.loader.may_reload = !(is_enrolling && has_draft);
        let inspected = inspect::update(&mut self.state);
        let counted = live::update(&mut self.state);
        let traced = entry::update(&self.state.session, ctx);
        expecting::update(&mut self.state);
        rack::update(&mut self.state);
        help::report::update(&mut self.state);
        for event in inspected.into_iter().chain(counted).chain(traced) {
            self.tell(&event, ctx);
        }
        for kind in WorkspaceKind::ALL {
            self.lend(kind, ctx, Workspace::update);
        }
        let history = self.workspace::<HistoryWorkspace>();
        let is_failing = history.is_some_and(|history| history.state.problem.is_some());
        self.state.session.is_history_failing = is_failing;
        let history = self.services.library_cache.history();
        self.state
            .shift_watch
            .update(&mut self.state.session, history, ctx);
        if let Some(action) = self.with_robot(ctx, RobotCell::update) {
            self.act(Action::Robot(action), ctx);
        }
        match self.dialog.poll() {
            Some((ask, Ok(path))) => self.act(Action::Chosen(ask, path), ctx),
            Some((_, Err(notice))) => self.act(Action::Notify(notice), ctx),
            None => {}
        }
        self.take_drops(ctx);
        if let Some(notice) = self.memory.keep(&self.state, ctx) {
            self.act(Action::Notify(notice), ctx);
        }
    }

    /// Draws everything and carries out the user's actions.
    pub(super) fn show(&mut self, ui: &mut Ui) {
        // egui aborts on a lost device, unless there is nothing to draw.
        if self.is_lost() {
            return;
        }
        self.state.session.language.make_current();
        let ctx = ui.ctx().clone();
        let mut actions = Vec::new();
        let key_target = if self.is_behind_dialog(&ctx) {
            KeyTarget::Dialog
        } else {
            KeyTarget::Page
        };
        if self.state.session.role == UserRole::Operator
            && let Some(code) = entry::listen(&ctx, key_target)
        {
            if self.state.roles.may_be_pin(&code) {
                let digits = code.chars().map(RoleAction::Digit);
                actions.extend(digits.chain([RoleAction::Enter]).map(Action::Role));
            } else {
                let now = ctx.input(|input| input.time);
                remove_notices(&mut self.state, NoticeTopic::Serial);
                let notice = self.state.session.enter_scanned(&code, now);
                actions.extend(notice.map(Action::Notify));
            }
        }
        if self.services.dialogs.takes_keys() {
            let is_typed = |event: &egui::Event| {
                matches!(
                    event,
                    egui::Event::Key { .. }
                        | egui::Event::Text(_)
                        | egui::Event::Paste(_)
                        | egui::Event::Ime(_)
                )
            };
            ctx.input_mut(|input| input.events.retain(|event| !is_typed(event)));
        }
        let work = self.work();
        status_bar::ui(ui, &self.state, &self.robot, &mut actions);
        if self.state.session.is_operator_view() {
            bars::operators(ui, &self.state, work, &mut actions);
        } else {
            bars::top(ui, &self.state, work, &mut actions);
            rail::ui(ui, &self.state, &mut actions);
        }
        let front = self.state.session.workspace;
        let canvas = match front {
            // Its view covers everything, and a software driver would still paint what is below.
            WorkspaceKind::Inspect => Frame::new(),
            _ => Frame::new().fill(Theme::of(ui).canvas),
        };
        let drawn = CentralPanel::default().frame(canvas).show(ui, |ui| {
            self.lend(front, &ctx, |workspace, cx| workspace.ui(ui, cx))
        });
        let room = drawn.inner.unwrap_or(drawn.response.rect);
        let hosted = self.hosted(front);
        let view_has_focus = hosted.is_some_and(Workspace::has_key_focus);
        let keys = hosted.map_or_else(Vec::new, Workspace::key_bindings);
        source_menu::set_up(&ctx, &self.state, &mut actions);
        rack::window(&ctx, &self.state, &mut actions);
        roles::dialog(&ctx, &self.state, &mut actions);
        notices::closing(&ctx, &self.state, &mut actions);
        let of_robot = self.robot.ui(&ctx, &self.state.session);
        actions.extend(of_robot.into_iter().map(Action::Robot));
        file_dialog::ui(&ctx, &self.services.dialogs);
        help::ui(&ctx, &self.state, &keys, &mut actions);
        notices::ui(&ctx, room, &self.state, &mut actions);
        let is_behind_dialog = self.is_behind_dialog(&ctx);
        let of_keys = keys::shortcuts(&ctx, &self.state, &keys, view_has_focus, is_behind_dialog);
        for action in actions {
            self.act(action, &ctx);
        }
        for action in of_keys {
            // What was pressed after a key that opened a dialog was meant for the dialog.
            if self.is_behind_dialog(&ctx) {
                break;
            }
            self.act(action, &ctx);
        }
        self.lock_untouched(&ctx);
    }

    /// True while any dialog is on top of the workspaces, including the system's.
    fn is_behind_dialog(&self, ctx: &egui::Context) -> bool {
        let state = &self.state;
        let is_own = state.help.is_some()
            || state.session.live.setup.is_some()
            || state.roles.asked.is_some()
            || matches!(state.closing, Closing::Asked { .. })
            || self.robot.dialog().is_some();
        let is_beneath =
            |memory: &egui::Memory| !memory.is_above_modal_layer(LayerId::background());
        is_own || self.services.dialogs.is_open() || ctx.memory(is_beneath)
    }

    /// Locks the engineer's view after a long time without input.
    fn lock_untouched(&mut self, ctx: &egui::Context) {
        let (now, is_touched) = ctx.input(|input| (input.time, !input.events.is_empty()));
        if is_touched {
            self.touched = now;
        }
        let Some(after) = self.state.roles.lock_timeout(self.state.session.role) else {
            return;
        };
        let left = self.touched + after - now;
        if left > 0.0 {
            ctx.request_repaint_after(Duration::from_secs_f64(left));
        } else {
            self.act(Action::Role(RoleAction::Lock), ctx);
        }
    }
}

/// Where the window's files are; those of the user where the options name none.
fn installation(options: &WindowOptions) -> Installation {
    let cases = options.cases.clone();
    let users = || Some(CaseFolder::of_user().ok()?.path().to_owned());
    Installation {
        settings: options.settings.clone(),
        history: options.history.clone(),
        cases: cases.or_else(users),
        recipes: options.recipes.clone(),
        ..Installation::default()
    }
}

/// The graphics adapter, or why there is none.
fn described_gpu(gpu: &Result<ViewportGpu, ViewError>) -> String {
    match gpu {
        Ok(gpu) => gpu.adapter(),
        Err(error) => error.to_string(),
    }
}

/// Tells that another window is open with the same data folder.
fn second_window() -> Notice {
    let advice = text!("shell-second-window-advice");
    let notice = Notice::look(text!("shell-second-window"), advice);
    notice.about(NoticeTopic::SecondWindow)
}

impl eframe::App for Window {
    fn logic(&mut self, ctx: &egui::Context, _frame: &mut eframe::Frame) {
        self.fetch(ctx);
    }

    fn ui(&mut self, ui: &mut Ui, _frame: &mut eframe::Frame) {
        self.show(ui);
    }

    fn on_exit(&mut self) {
        // Nothing is drawn any more.
        let ctx = egui::Context::default();
        let mut events = live::close(&mut self.state);
        events.extend(entry::settle(&self.state.session, f64::INFINITY));
        for event in events {
            self.lend(WorkspaceKind::History, &ctx, |history, cx| {
                history.on_event(&event, cx);
            });
        }
        for workspace in &mut self.workspaces {
            workspace.close();
        }
        self.memory.finish();
    }
}

/// Name of the lock file in the folder of the history.
const WINDOW_LOCK: &str = "window.lock";

/// Held while a window is open, so that a second one notices that another is open with the same data folder.
struct DataLock {
    /// True if another window holds the lock.
    is_taken: bool,
    _lock: Option<FileLock>,
}

impl DataLock {
    /// Tries to take the lock. If that fails for another reason, for example on a network file system without locks, it counts
    /// as free.
    fn take(folder: Option<&Path>) -> Self {
        let taken = folder.and_then(|folder| {
            disk::create_dir_all(folder).ok()?;
            FileLock::try_exclusive(&folder.join(WINDOW_LOCK)).ok()
        });
        Self {
            is_taken: matches!(taken, Some(None)),
            _lock: taken.flatten(),
        }
    }
}
