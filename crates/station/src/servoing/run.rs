//! A run of servoing for every front end: what is set up around [`servo()`], and the row of the history that it leaves.

use std::{
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
    },
    time::Duration,
};

use jiff::Timestamp;

use super::{
    LinkError, PreparedTask, RobotAddress, RobotLink, ServoNews, ServoOrder, ServoSetup,
    SetupError, SimulatedRobot, SimulatedTrial, check_source, run_clock::RunClock, servo,
};
use crate::CameraScenes;
use ::servo::{
    Fence, Look, Servo, ServoError, ServoParams, Step, StopReason, Target, Task,
    simulated::{SimulatedCellError, StreamProtocol},
    stream::{Drive, Stream},
};
use capture::{CaptureError, Feed, FeedItem, FeedState, SourceSpec};
use geometry::{error::Advice, rigid::PoseDelta};
use inspection::{
    library::{Library, SprayPath},
    pipeline::{NamedRecipe, Unwatched, run as inspect},
};
use records::history::{ServoRecord, ServoRun, ServoSample, ServoTargetKind};
use simulate::PartKind;
use stages::scene::EmptyCell;
use texts::Message;

/// What every run is told.
pub struct ServoJob<'a> {
    /// The part.
    pub part: &'a str,
    /// Its title.
    pub title: &'a str,
    /// The library.
    pub library: &'a Library,
    /// The longest step, if each waits for [`ServoOrder::Step`].
    pub longest_step: Option<PoseDelta>,
}

/// A real robot with its camera.
pub struct RealRobot<'a> {
    /// How its controller is reached.
    pub address: RobotAddress,
    /// The camera.
    pub source: &'a SourceSpec,
    /// Its frames.
    pub feed: Feed,
    /// Target, limits, and what is kept clear.
    pub setup: &'a ServoSetup,
    /// The part's stored spray path, if there is one.
    pub path: Option<&'a SprayPath>,
    /// The empty cell, if it was captured.
    pub empty_cell: Option<Arc<EmptyCell>>,
    /// The recipe of the inspections.
    pub recipe: &'a NamedRecipe,
}

/// How a run ended.
pub struct ServoOutcome {
    /// [`Step::Done`] or [`Step::Stop`], or why the connection broke.
    pub end: Result<Step, LinkError>,
    /// Its row in the history; `None` if the robot never reported.
    pub record: Option<ServoRecord>,
    /// The true error at the end, in simulation.
    pub true_error: Option<PoseDelta>,
}

/// Why a run cannot begin.
#[derive(Debug, thiserror::Error, Advice)]
pub enum ServoRunError {
    /// The part cannot be servoed to.
    #[error(transparent)]
    #[advice(transparent)]
    Setup(#[from] SetupError),
    /// The simulated cell lacks the part.
    #[error("{}", Message::new("servo-not-simulated").with("part", part.as_str()))]
    #[advice("Choose one of {}", PartKind::ALL.map(PartKind::name).join(", "))]
    NotSimulated {
        /// Its name.
        part: String,
    },
    /// The simulated cell cannot be arranged.
    #[error(transparent)]
    #[advice = "Try another seed or another part, of the library that comes with the program"]
    Cell(#[from] SimulatedCellError),
    /// A parameter is out of its range.
    #[error(transparent)]
    #[advice(transparent)]
    Params(#[from] ServoError),
    /// The robot cannot be reached.
    #[error(transparent)]
    #[advice(transparent)]
    Link(#[from] LinkError),
    /// The simulated robot whose camera it is cannot be reached.
    #[error(transparent)]
    #[advice(transparent)]
    Camera(#[from] CaptureError),
}

/// How long the camera's thread waits for a frame before it looks whether the run is over.
const POLL_INTERVAL: Duration = Duration::from_millis(100);

impl ServoJob<'_> {
    fn drive(
        &self,
        stream: Box<dyn Stream + Send>,
        task: &Task,
        params: &ServoParams,
        fence: Fence,
    ) -> Result<Drive, ServoError> {
        let mut servo = Servo::new(task.clone(), params.clone(), fence)?;
        if let Some(longest) = self.longest_step {
            servo.move_in_steps(longest);
        }
        Ok(Drive::new(stream, servo))
    }

    /// The row without what the run itself knows.
    pub(super) fn row(
        &self,
        task: &Task,
        params: &ServoParams,
        robot: String,
        source: String,
    ) -> ServoRun {
        let target = match task.target {
            Target::Nozzle { .. } => ServoTargetKind::PathStart,
            target if target == Target::standard_position() => ServoTargetKind::StandardPosition,
            Target::SeenAt { .. } => ServoTargetKind::CameraPose,
        };
        let tolerance = &params.tolerance;
        ServoRun {
            number: 0,
            at: Timestamp::UNIX_EPOCH,
            part: self.part.to_owned(),
            title: self.title.to_owned(),
            target,
            robot,
            source,
            is_simulated: false,
            stopped: None,
            error_m: None,
            error_rad: None,
            bounds_m: None,
            bounds_rad: None,
            is_approximate: false,
            took_s: 0.0,
            num_looks: 0,
            speed_m_s: Some(params.limits.speed),
            tolerance_m: tolerance.shift.0,
            tolerance_rad: tolerance.rotation.0,
            program: env!("CARGO_PKG_VERSION").to_owned(),
        }
    }
}

impl ServoNews {
    /// The point of the curve, if this is a look of a run.
    pub fn sample(&self) -> Option<ServoSample> {
        let Self::Looked {
            look,
            error,
            held,
            standing: Some(standing),
            at: Some(at),
            ..
        } = self
        else {
            return None;
        };
        let why = look.seen.as_ref().err().or(held.as_ref());
        Some(ServoSample {
            at_s: at.as_secs_f64(),
            error_m: error.map(|error| error.shift.0),
            error_rad: error.map(|error| error.rotation.0),
            state: standing.state,
            held: why.map(|why| why.kind().to_owned()),
        })
    }
}

/// What a run leaves behind.
#[derive(Default)]
pub(super) struct Log {
    /// When the robot first reported, by both clocks.
    pub(super) began: Option<(Timestamp, Duration)>,
    pub(super) curve: Vec<ServoSample>,
}

impl Log {
    fn note(&mut self, news: &ServoNews, now: Duration) {
        if let ServoNews::Connected(_) = news {
            self.began = Some((geometry::clock::now(), now));
        }
        self.curve.extend(news.sample());
    }

    /// Completes the row; `None` if the robot never reported.
    pub(super) fn record(
        self,
        row: ServoRun,
        end: &Result<Step, LinkError>,
        error: Option<PoseDelta>,
        now: Duration,
    ) -> Option<ServoRecord> {
        let (at, began) = self.began?;
        let micro = at.as_microsecond();
        let arrival = match end {
            Ok(Step::Done(arrival)) => Some(arrival),
            Ok(Step::Stop(_) | Step::Command(_)) | Err(_) => None,
        };
        let error = arrival.map(|arrival| arrival.error).or(error);
        let bounds = arrival.map(|arrival| arrival.bounds);
        let took = arrival.map_or(now.saturating_sub(began), |arrival| arrival.took);
        let run = ServoRun {
            // Rounded as in the file.
            at: Timestamp::from_microsecond(micro).unwrap_or(at),
            stopped: match end {
                Ok(Step::Done(_)) => None,
                Ok(Step::Stop(reason)) => Some(reason.clone()),
                Ok(Step::Command(_)) | Err(_) => Some(StopReason::RobotStopped),
            },
            error_m: error.map(|error| error.shift.0),
            error_rad: error.map(|error| error.rotation.0),
            bounds_m: bounds.map(|bounds| bounds.shift.0),
            bounds_rad: bounds.map(|bounds| bounds.rotation.0),
            is_approximate: arrival.is_some_and(|arrival| arrival.is_approximate),
            took_s: took.as_secs_f64(),
            num_looks: self.curve.len(),
            ..row
        };
        Some(ServoRecord {
            run,
            curve: self.curve,
        })
    }
}

/// Drives a robot, and notes what happens.
fn logged(
    row: ServoRun,
    link: &mut RobotLink,
    drive: &mut Drive,
    now: &impl Fn() -> Duration,
    next_look: impl FnMut(&AtomicBool) -> Option<Look> + Send,
    mut on_news: impl FnMut(Option<ServoNews>) -> ServoOrder,
) -> ServoOutcome {
    let mut log = Log::default();
    let end = servo(link, drive, now, next_look, |news| {
        if let Some(news) = &news {
            log.note(news, now());
        }
        on_news(news)
    });
    let error = drive.servo().error().map(|error| error.size());
    ServoOutcome {
        record: log.record(row, &end, error, now()),
        end,
        true_error: None,
    }
}

/// Servos a real robot until it arrives or stops.
pub fn servo_real(
    job: &ServoJob<'_>,
    robot: RealRobot<'_>,
    mut on_news: impl FnMut(Option<ServoNews>) -> ServoOrder,
) -> Result<ServoOutcome, ServoRunError> {
    check_source(robot.source)?;
    let prepared = robot
        .setup
        .prepare(job.part, robot.path, job.library, robot.recipe)?;
    let PreparedTask {
        task,
        fence,
        recipe,
        refused,
    } = prepared;
    for (name, reason) in refused {
        on_news(Some(ServoNews::TargetFrame { name, reason }));
    }
    let clock = RunClock::of_source(robot.source)?;
    let params = robot.setup.params();
    let stream = robot.address.stream(robot.setup.placed.as_ref())?;
    let mut drive = job.drive(stream, &task, &params, fence)?;
    let mut link = RobotLink::open(&robot.address)?;
    if let SourceSpec::SimulatedRobot(camera) = robot.source {
        link.expect_simulated(camera.ip());
    }
    on_news(Some(ServoNews::Begins {
        task: Arc::new(task.clone()),
        robot: robot.address.at(link.address()),
    }));
    let source = robot.source.to_string();
    let row = job.row(&task, &params, robot.address.to_string(), source);
    let mut scenes = CameraScenes::new(robot.empty_cell);
    let feed = &robot.feed;
    let is_simulated = AtomicBool::new(robot.source.is_simulated());
    let next_look = |is_over: &AtomicBool| loop {
        if is_over.load(Ordering::SeqCst) || feed.status().state.is_over() {
            return None;
        }
        let Some(FeedItem::Captured(captured)) = feed.wait(POLL_INTERVAL) else {
            continue;
        };
        // Also files that another program simulates.
        is_simulated.fetch_or(captured.is_simulated, Ordering::SeqCst);
        let (number, arrived) = (captured.number, captured.arrived);
        let scene = scenes.next(captured.image);
        // It is never cancelled.
        let inspection = inspect(&scene, job.library, &recipe, &Unwatched).ok()?;
        let taken_at = clock.arrived(number, arrived);
        return Some(Look::new(&task, &inspection, taken_at));
    };
    let now = || clock.now();
    let mut lost: Option<Arc<CaptureError>> = None;
    let mut outcome = logged(row, &mut link, &mut drive, &now, next_look, |news| {
        let mut order = ServoOrder::GoOn;
        if let FeedState::Failed(error) | FeedState::Lost { error } = feed.status().state
            && lost
                .as_ref()
                .is_none_or(|known| known.to_string() != error.to_string())
        {
            lost = Some(Arc::clone(&error));
            order = on_news(Some(ServoNews::Camera(error)));
        }
        match on_news(news) {
            ServoOrder::GoOn => order,
            later => later,
        }
    });
    if let Some(record) = &mut outcome.record {
        record.run.is_simulated = is_simulated.into_inner();
    }
    Ok(outcome)
}

/// Servos a simulated robot, in this protocol.
pub fn servo_simulated(
    job: &ServoJob<'_>,
    params: &ServoParams,
    protocol: StreamProtocol,
    trial: &SimulatedTrial,
    mut on_news: impl FnMut(Option<ServoNews>) -> ServoOrder,
) -> Result<ServoOutcome, ServoRunError> {
    let cell = trial.arrange(job.part, job.library)?;
    let stream = cell.stream(protocol);
    let mut drive = job.drive(stream, &cell.task, params, cell.fence.clone())?;
    let (robot, mut link) = SimulatedRobot::start(cell.controller(protocol), protocol)?;
    on_news(Some(ServoNews::Begins {
        task: Arc::new(cell.task.clone()),
        robot: RobotAddress::new(protocol, link.address()),
    }));
    let row = ServoRun {
        is_simulated: true,
        ..job.row(
            &cell.task,
            params,
            protocol.name().into(),
            "simulated".into(),
        )
    };
    let mut number = 0;
    let next_look = |is_over: &AtomicBool| {
        number += 1;
        robot.look(trial.delay, is_over, |flange, at| {
            cell.look(flange, at, number)
        })
    };
    let now = || robot.now().0;
    let mut outcome = logged(row, &mut link, &mut drive, &now, next_look, on_news);
    let (at, flange) = robot.now();
    outcome.true_error = Some(cell.true_error(&flange, at));
    Ok(outcome)
}
