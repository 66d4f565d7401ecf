//! The run, on the task's thread: reads what it needs, servoes the robot, and writes the row of the history.

use std::{
    path::PathBuf,
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
    },
    time::{Duration, Instant},
};

use nalgebra::Point3;

use capture::SourceSpec;
use geometry::{
    oriented_box::OrientedBox,
    rigid::PoseDelta,
    units::{Metres, Radians},
};
use inspection::{
    library::Library,
    pipeline::{NamedRecipe, ProgressObserver as _},
};
use records::history::{ServoRecord, ServoSample};
use robot::calibration::CameraPlace;
use servo::{Standing, StopReason, Task, simulated::StreamProtocol};
use shell::{
    cell::{ProgramSetup, ServoSettings, servo_setup},
    inspection::library_cache::{LibraryCache, LoadedLibrary},
};
use stages::scene::EmptyCell;
use station::servoing::{
    RealRobot, RobotAddress, ServoJob, ServoNews, ServoOrder, ServoOutcome, ServoSetup,
    SimulatedTrial, servo_real, servo_simulated,
};
use ui::{
    language::what_and_advice,
    task::{TaskContext, TaskError},
    user_error::UserError,
    viewport::{PointSet, Role},
};

/// The longest step where each waits until it is allowed.
const LONGEST_STEP: PoseDelta = PoseDelta {
    shift: Metres(0.05),
    rotation: Radians(0.09),
};

/// What a person orders while the robot is servoed.
#[derive(Debug, Default)]
pub(super) struct Orders {
    pub(super) stops: AtomicBool,
    pub(super) allows_step: AtomicBool,
}

/// A real robot with its camera.
pub(super) struct RealCell {
    pub(super) address: RobotAddress,
    pub(super) source: SourceSpec,
    /// File of the calibration.
    pub(super) calibration: PathBuf,
}

/// What a run needs.
pub(super) struct RunRequest {
    pub(super) settings: ServoSettings,
    pub(super) part: String,
    pub(super) program: ProgramSetup,
    /// A real robot; none for a simulated one.
    pub(super) real: Option<RealCell>,
    pub(super) recipe: Arc<NamedRecipe>,
    pub(super) empty_cell: Option<Arc<EmptyCell>>,
    pub(super) library_cache: LibraryCache,
    pub(super) orders: Arc<Orders>,
    /// Seed of the simulated start.
    pub(super) seed: u64,
}

/// A run as it is shown.
#[derive(Clone, Debug, Default)]
pub struct RunView {
    /// Title of the part.
    pub title: String,
    /// What is moved where, once it begins.
    pub task: Option<Arc<Task>>,
    /// Where the robot is, or this computer listens.
    pub robot: Option<RobotAddress>,
    /// The nozzle's mouth on the flange, if there is a nozzle.
    pub nozzle: Option<Point3<f64>>,
    /// The box of the base frame that is never left, if there is one.
    pub volume: Option<OrientedBox>,
    /// The part's points, in its own space.
    pub points: Option<PointSet>,
    /// What was left of the error.
    pub curve: Vec<ServoSample>,
    /// Positions of camera or flange so far, base frame.
    pub trail: Vec<[f32; 3]>,
    /// Where the run stands, once the robot follows.
    pub standing: Option<Standing>,
    /// Why the robot is held, if it is.
    pub held: Option<StopReason>,
    /// Number of looks.
    pub num_looks: usize,
    /// Number of those with a pose to move by.
    pub num_accepted: usize,
    /// Time from the last frame to its look.
    pub delay: Option<Duration>,
    /// What is wrong with camera or connection.
    pub problem: Option<UserError>,
    /// How it ended.
    pub record: Option<ServoRecord>,
}

impl RunView {
    fn note(&mut self, news: &ServoNews, library: &Library) {
        self.curve.extend(news.sample());
        match news {
            ServoNews::TargetFrame { name, reason } => {
                let [what, advice] = what_and_advice(reason);
                self.problem = Some(UserError {
                    what: format!("{name}: {what}"),
                    advice,
                });
            }
            ServoNews::Begins { task, robot } => {
                let mut references = library.references.iter();
                let reference = references.find(|one| one.name == task.reference);
                self.points = reference.map(|reference| {
                    let points = reference.cloud.points.iter().map(|p| [p.x, p.y, p.z]);
                    PointSet::new(points.collect::<Vec<_>>(), Role::Part).packed()
                });
                (self.task, self.robot) = (Some(Arc::clone(task)), Some(*robot));
            }
            ServoNews::Camera(error) => self.problem = Some(UserError::of(&**error)),
            ServoNews::Problem(error) => self.problem = Some(UserError::of(error)),
            ServoNews::Connected(_) => self.problem = None,
            ServoNews::Looked {
                look,
                held,
                standing,
                delay,
                ..
            } => {
                self.num_looks += 1;
                self.num_accepted += usize::from(look.seen.is_ok());
                self.held = look.seen.as_ref().err().or(held.as_ref()).cloned();
                self.delay = Some(*delay);
                self.standing = *standing;
                if let (Some(task), Some(standing)) = (&self.task, standing) {
                    let flange = standing.robot_from_flange;
                    let moved = match &task.camera {
                        CameraPlace::OnFlange {
                            flange_from_camera, ..
                        } => flange * flange_from_camera,
                        CameraPlace::Fixed { .. } => flange,
                    };
                    let at = moved.translation.vector.cast::<f32>();
                    self.trail.push(at.into());
                }
            }
        }
    }
}

/// Servoes until the robot has arrived or stopped. The row is in the history on return, also if the task was cancelled.
pub(super) fn run(
    request: &RunRequest,
    context: &TaskContext<Box<RunView>>,
) -> Result<Box<RunView>, TaskError> {
    let loaded = request.library_cache.get();
    let fitted;
    let library: &Library = if request.real.is_some() {
        fitted = loaded.fitting(&request.recipe, context);
        fitted.as_ref().ok_or(TaskError::Cancelled)?
    } else {
        // The simulated cell inspects with the default recipe.
        &loaded.library
    };
    let title = loaded.shown.title_of(&request.part).to_owned();
    let target = request.program.target();
    let nozzle = target.as_ref().ok().and_then(|target| {
        let pose = target.settings.flange_from_nozzle?;
        Some(Point3::from(pose.translation.vector))
    });
    let mut view = RunView {
        title: title.clone(),
        nozzle: nozzle.filter(|_| request.real.is_some()),
        volume: (request.settings.volume).filter(|_| request.real.is_some()),
        ..RunView::default()
    };
    let params = request.settings.params();
    let params = params.map_err(|error| UserError::of(&error))?;
    let job = ServoJob {
        part: &request.part,
        title: &title,
        library,
        longest_step: request.settings.in_steps.then_some(LONGEST_STEP),
    };
    let orders = Arc::clone(&request.orders);
    let on_news = |news: Option<ServoNews>| {
        if let Some(news) = &news {
            view.note(news, library);
            context.latest(Box::new(view.clone()));
        }
        if context.is_cancelled() || orders.stops.load(Ordering::Relaxed) {
            ServoOrder::Stop
        } else if orders.allows_step.swap(false, Ordering::Relaxed) {
            ServoOrder::Step
        } else {
            ServoOrder::GoOn
        }
    };
    let outcome = match &request.real {
        None => {
            let protocol = StreamProtocol::Egm;
            let trial = SimulatedTrial {
                seed: request.seed,
                ..SimulatedTrial::default()
            };
            servo_simulated(&job, &params, protocol, &trial, on_news)
                .map_err(|error| UserError::of(&error))?
        }
        Some(cell) => {
            let setup = servo_setup(&request.settings, &target?, &cell.calibration)?;
            real(request, cell, &job, &setup, &loaded, on_news)?
        }
    };
    let ServoOutcome { end, record, .. } = outcome;
    if let Some(record) = &record {
        let history = request.library_cache.history();
        history.add_servo_run(record.clone(), Instant::now());
    }
    view.problem = None;
    if let Err(error) = end {
        let error = UserError::of(&error);
        if record.is_none() {
            return Err(error.into());
        }
        view.problem = Some(error);
    }
    view.record = record;
    Ok(Box::new(view))
}

fn real(
    request: &RunRequest,
    cell: &RealCell,
    job: &ServoJob<'_>,
    setup: &ServoSetup,
    loaded: &LoadedLibrary,
    on_news: impl FnMut(Option<ServoNews>) -> ServoOrder,
) -> Result<ServoOutcome, UserError> {
    let cameras = request.library_cache.camera();
    // It stays open for as long as this is held.
    let feed = cameras.feed(&cell.source);
    let feed = feed.map_err(|error| UserError::of(&error))?;
    let shown = &loaded.shown;
    let index = shown.index_of(&request.part);
    let path = index.and_then(|index| shown.spray_paths.get(index)?.as_ref());
    let robot = RealRobot {
        address: cell.address,
        source: &cell.source,
        feed: feed.tap(),
        setup,
        path: path.map(|stored| &stored.path),
        empty_cell: request.empty_cell.clone(),
        recipe: &request.recipe,
    };
    let outcome = servo_real(job, robot, on_news);
    drop(feed);
    cameras.rest();
    outcome.map_err(|error| UserError::of(&error))
}
