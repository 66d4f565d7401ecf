//! State of the workspace: the run that is shown, and the one that goes on; and the actions that change it.

use std::{
    path::PathBuf,
    sync::{Arc, atomic::Ordering},
};

use crate::workspaces::servo::work::{self, Orders, RealCell, RunRequest, RunView};
use capture::SourceSpec;
use files::SCENE_ENDINGS;
use records::history::{ServoSample, ServoTargetKind};
use servo::{ServoState, simulated::StreamProtocol};
use shell::{
    action::Action,
    cell::{ServoSettings, not_calibrated},
    file_dialog::{FileChoice, FileDialog, FileRequest, all_files},
    notice::Notice,
    session::{PaintTab, Session, WorkspaceKind},
    workspace::ShellContext,
};
use simulate::PartKind;
use station::servoing::RobotAddress;
use ui::{
    language::{described, text},
    task::{Running, Task, TaskRunner},
    user_error::UserError,
    widgets::sentence,
};

/// State of the workspace.
#[derive(Debug)]
pub struct ServoPageState {
    /// The run in front, the last one or the one that goes on.
    pub shown: Option<Box<RunView>>,
    /// Why the last run could not begin.
    pub failed: Option<UserError>,
    /// Number of runs begun.
    pub(super) num_runs: u64,
    orders: Arc<Orders>,
    task: Task<Box<RunView>>,
    files: FileDialog<ServoFile>,
}

impl ServoPageState {
    pub(super) fn new(runner: &TaskRunner) -> Self {
        Self {
            shown: None,
            failed: None,
            num_runs: 0,
            orders: Arc::default(),
            task: Task::new("servo", runner),
            files: FileDialog::default(),
        }
    }

    /// True while a robot is servoed, or waited for.
    pub fn is_running(&self) -> bool {
        self.task.running().is_some()
    }

    /// True once the robot has been told to stop, until it stands.
    pub fn is_stopping(&self) -> bool {
        self.is_running() && self.orders.stops.load(Ordering::Relaxed)
    }

    pub(super) fn running(&self) -> Option<&Running> {
        self.task.running()
    }

    /// Tells the robot to stop.
    pub(super) fn stop(&self) {
        self.orders.stops.store(true, Ordering::Relaxed);
    }

    /// What the run in front is doing.
    pub fn doing(&self) -> Option<ServoState> {
        Some(self.shown.as_ref()?.standing?.state)
    }

    /// The curve in front.
    pub fn curve(&self) -> &[ServoSample] {
        self.shown.as_ref().map_or(&[], |shown| &shown.curve)
    }

    /// Tolerance of the run in front, metres and radians.
    pub(super) fn tolerance(&self, session: &Session) -> (f64, f64) {
        let record = self.shown.as_ref().and_then(|shown| shown.record.as_ref());
        if let Some(record) = record {
            return (record.run.tolerance_m, record.run.tolerance_rad);
        }
        let params = session.servo.params().unwrap_or_default();
        (params.tolerance.shift.0, params.tolerance.rotation.0)
    }

    /// Carries out an action.
    pub fn apply(&mut self, action: ServoAction, cx: &mut ShellContext<'_>) {
        match action {
            ServoAction::SetUp(setup) => cx.send(Action::UseServoSettings(setup)),
            ServoAction::Ask(file) => {
                let lock = &cx.services.dialogs;
                self.files.open(file, &file.request(), lock, cx.egui);
            }
            ServoAction::SeeAs(path) => {
                let mut setup = cx.session.servo.clone();
                if !setup.seen_as.contains(&path) {
                    setup.seen_as.push(path);
                }
                setup.target = ServoTargetKind::CameraPose;
                cx.send(Action::UseServoSettings(setup));
            }
            ServoAction::GoToRobot => {
                cx.send(Action::ShowPaintTab(PaintTab::Robot));
                cx.send(Action::GoTo(WorkspaceKind::Paint));
            }
            ServoAction::Start => self.start(cx),
            ServoAction::Stop => self.stop(),
            ServoAction::Next => self.orders.allows_step.store(true, Ordering::Relaxed),
        }
    }

    fn start(&mut self, cx: &ShellContext<'_>) {
        let session = cx.session;
        if self.is_running() {
            return;
        }
        let (part, real) = match ready(session) {
            Ok(ready) => ready,
            Err(missing) => {
                self.failed = Some(missing);
                return;
            }
        };
        self.num_runs += 1;
        self.orders = Arc::default();
        (self.failed, self.shown) = (None, None);
        let request = RunRequest {
            settings: session.servo.clone(),
            part,
            program: session.program.clone(),
            real,
            recipe: Arc::clone(&session.recipe),
            empty_cell: session.empty_cell.clone(),
            library_cache: cx.services.library_cache.clone(),
            orders: Arc::clone(&self.orders),
            seed: self.num_runs,
        };
        self.task.start(text!("servoing-running"), move |context| {
            work::run(&request, context)
        });
    }

    /// Polls task and file dialog; stops the robot once the page is left.
    pub(super) fn update(&mut self, cx: &mut ShellContext<'_>) {
        while let Some(result) = self.task.poll() {
            match result {
                Ok(view) => self.shown = Some(view),
                Err(error) => {
                    self.shown = None;
                    self.failed = Some(error);
                }
            }
        }
        let is_front = cx.session.workspace == WorkspaceKind::Servo;
        if !is_front && self.is_running() && !self.is_stopping() {
            self.stop();
            cx.notify(Notice::look(
                text!("servoing-left"),
                text!("servoing-left-advice"),
            ));
        }
        if let Some((ServoFile::SeenAs, path)) = cx.chosen(&mut self.files) {
            self.apply(ServoAction::SeeAs(path), cx);
        }
    }
}

/// The name of the part to servo to: the chosen one, else the first.
pub(super) fn chosen_part(session: &Session) -> Option<&str> {
    let library = session.library.as_ref()?;
    let chosen = session.servo.part.as_deref();
    let chosen = chosen.filter(|name| library.index_of(name).is_some());
    chosen.or_else(|| library.parts.first().map(|part| part.name.as_str()))
}

/// The part and, unless it is simulated, the robot of a run; or what is missing and what to do about it.
pub(super) fn ready(session: &Session) -> Result<(String, Option<RealCell>), UserError> {
    let Some(library) = &session.library else {
        return Err(UserError {
            what: text!("shell-library-loading"),
            advice: String::new(),
        });
    };
    if let Some(problem) = &library.unloaded {
        return Err(problem.clone());
    }
    let Some(part) = chosen_part(session) else {
        return Err(UserError {
            what: text!("servoing-no-part"),
            advice: text!("servoing-no-part-advice"),
        });
    };
    let setup = &session.servo;
    let Some(protocol) = setup.robot else {
        if PartKind::ALL.iter().all(|kind| kind.name() != part) {
            let lacks =
                texts::Message::new("servo-not-simulated").with("part", library.title_of(part));
            return Err(UserError {
                what: sentence(&described(&lacks)),
                advice: text!("servoing-not-simulated-advice"),
            });
        }
        return Ok((part.to_owned(), None));
    };
    let address = format!("{}={}", protocol.name(), setup.address.trim());
    let address = address
        .parse::<RobotAddress>()
        .map_err(|_error| UserError {
            what: text!("servoing-no-address"),
            advice: match protocol {
                StreamProtocol::Egm | StreamProtocol::Rsi => text!("servoing-listen-advice"),
                StreamProtocol::Rtde => text!("servoing-connect-advice"),
            },
        })?;
    let source = session.source.followed();
    let source = source.filter(|spec| {
        let is_camera = !matches!(spec, SourceSpec::Simulated(_) | SourceSpec::Watched(_));
        is_camera && !spec.is_replayed()
    });
    let source = source.ok_or_else(|| UserError {
        what: text!("servoing-no-camera"),
        advice: text!("servoing-no-camera-advice"),
    })?;
    let calibration = session.calibration_path().ok_or_else(not_calibrated)?;
    if let Some(error) = session.program.nozzle_error() {
        return Err(error);
    }
    if protocol == StreamProtocol::Rsi && session.program.arm.is_none() {
        return Err(UserError {
            what: text!("servoing-no-arm"),
            advice: text!("servoing-no-arm-advice"),
        });
    }
    if setup.target == ServoTargetKind::CameraPose && setup.seen_as.is_empty() {
        return Err(UserError {
            what: text!("servoing-no-frames"),
            advice: text!("servoing-no-frames-advice"),
        });
    }
    let cell = RealCell {
        address,
        source,
        calibration,
    };
    Ok((part.to_owned(), Some(cell)))
}

/// An action in the workspace.
#[derive(Clone, Debug)]
pub enum ServoAction {
    /// Use these settings.
    SetUp(ServoSettings),
    /// Ask for a file.
    Ask(ServoFile),
    /// Add a frame of the target.
    SeeAs(PathBuf),
    /// Go where arm, nozzle and least distance are set.
    GoToRobot,
    /// Servo the robot.
    Start,
    /// Stop the robot.
    Stop,
    /// Allow the step that waits.
    Next,
}

/// A file that a person is asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ServoFile {
    /// A frame of the part, taken where the camera should stand.
    SeenAs,
}

impl ServoFile {
    fn request(self) -> FileRequest {
        match self {
            Self::SeenAs => FileRequest {
                title: text!("servoing-frame-title"),
                filters: vec![(text!("shell-captured-scenes"), SCENE_ENDINGS), all_files()],
                choice: FileChoice::File,
            },
        }
    }
}
