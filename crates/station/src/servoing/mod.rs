//! Servoing a real robot: the sockets, the clock and the threads around a [`Drive`].
//!
//! ```text
//! thread "looks":  frame ─► inspection ─► Look ──┐
//! this thread:     report of the robot ──► Drive ┴─► answer to the robot
//! ```
//!
//! Reports and frames are dated when they arrive, by one clock. Robots that ask for single moves come through the server instead
//! (`single_moves.rs`); the task of a part is the same for both (`setup.rs`). A simulated robot is driven in the same program
//! (`simulated_robot.rs`) or by another one, which dates everything by its clock (`robot_service.rs`, `run_clock.rs`).

mod carried_camera;
mod robot_link;
mod robot_service;
mod run;
mod run_clock;
mod setup;
mod simulated_robot;
mod single_moves;
mod trial;

pub use self::{
    carried_camera::CarriedCamera,
    robot_link::{LinkError, RobotAddress, RobotLink},
    robot_service::{RobotOutcome, serve_robot},
    run::{RealRobot, ServoJob, ServoOutcome, ServoRunError, servo_real, servo_simulated},
    setup::{PreparedTask, ServoSetup, ServoTarget, SetupError, check_source, reference_of},
    simulated_robot::{ProgramEnd, SimulatedRobot},
    single_moves::{RestFrames, RestWatch, ServoParts, SingleMoves},
    trial::SimulatedTrial,
};

use std::{
    net::SocketAddr,
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
        mpsc,
    },
    thread,
    time::{Duration, Instant},
};

use capture::CaptureError;
use geometry::rigid::PoseDelta;
use servo::{
    Look, Standing, Step, StopReason, Task,
    stream::{Drive, StreamError},
};

/// What happens on the way.
#[derive(Clone, Debug)]
#[expect(
    clippy::large_enum_variant,
    reason = "nearly all are looks, each passed on once"
)]
pub enum ServoNews {
    /// A frame of the target shows no pose to move by.
    TargetFrame {
        /// Its name.
        name: String,
        /// Why not.
        reason: StopReason,
    },
    /// This is what is moved where; the robot is waited for.
    Begins {
        /// What is moved where.
        task: Arc<Task>,
        /// Where this computer listens, or the robot does.
        robot: RobotAddress,
    },
    /// The camera is lost, or cannot be used.
    Camera(Arc<CaptureError>),
    /// The robot reports for the first time, from this address.
    Connected(SocketAddr),
    /// A frame was inspected.
    Looked {
        /// What it says about the part.
        look: Look,
        /// The error at the pose that was last commanded; `None` until enough looks agree.
        error: Option<PoseDelta>,
        /// Why the robot is held, if it is.
        held: Option<StopReason>,
        /// Where the run stands; `None` before the robot follows.
        standing: Option<Standing>,
        /// Time from the frame to its look.
        delay: Duration,
        /// When the frame was taken, from the robot's first report on; `None` before it.
        at: Option<Duration>,
    },
    /// Bytes came that are no report.
    Problem(StreamError),
}

/// What a person or a program wants.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ServoOrder {
    /// Go on.
    GoOn,
    /// Make the step that waits.
    Step,
    /// Brake, and stop for good.
    Stop,
}

impl ServoOrder {
    /// Passes it on; returns true if the robot stops.
    fn give(self, drive: &mut Drive) -> bool {
        match self {
            Self::GoOn => {}
            Self::Step => drive.allow_step(),
            Self::Stop => drive.stop(StopReason::ByPerson),
        }
        self == Self::Stop
    }
}

/// Without a report for this long, a robot that has begun to move is taken for stopped.
const MAX_SILENCE: Duration = Duration::from_secs(5);
/// Without a report for this long after the target is reached, its program has ended.
const MAX_SILENCE_AT_END: Duration = Duration::from_secs(1);
/// How long answers go on after the target is reached, so that the robot's program ends by itself.
const ANSWER_TIME_AT_END: Duration = Duration::from_secs(10);
/// How long a turn waits for the robot.
const POLL_INTERVAL: Duration = Duration::from_millis(20);

/// Drives a robot until it arrives or stops. `now` is the time by which looks are dated. `next_look` takes a frame and inspects it,
/// on a thread of its own; it returns `None` at the latest soon after the flag is set. `on_news` is asked every few milliseconds.
pub fn servo(
    link: &mut RobotLink,
    drive: &mut Drive,
    now: &impl Fn() -> Duration,
    mut next_look: impl FnMut(&AtomicBool) -> Option<Look> + Send,
    mut on_news: impl FnMut(Option<ServoNews>) -> ServoOrder,
) -> Result<Step, LinkError> {
    let is_over = AtomicBool::new(false);
    let (send, looks) = mpsc::channel();
    thread::scope(|scope| {
        scope.spawn(|| {
            while !is_over.load(Ordering::SeqCst) {
                // The receiver outlives this thread.
                let sent = next_look(&is_over).map(|look| send.send(look));
                if sent.is_none() {
                    break;
                }
            }
        });
        let end = exchange(link, drive, now, &looks, &mut on_news);
        is_over.store(true, Ordering::SeqCst);
        end
    })
}

fn exchange(
    link: &mut RobotLink,
    drive: &mut Drive,
    now: &impl Fn() -> Duration,
    looks: &mpsc::Receiver<Look>,
    on_news: &mut impl FnMut(Option<ServoNews>) -> ServoOrder,
) -> Result<Step, LinkError> {
    link.send(&drive.opening())?;
    let mut last_report: Option<Instant> = None;
    let mut began: Option<Duration> = None;
    let mut done: Option<(Instant, Step)> = None;
    loop {
        let mut stops = on_news(None).give(drive);
        for look in looks.try_iter() {
            let news = ServoNews::Looked {
                look: look.clone(),
                error: drive.servo().error().map(|error| error.size()),
                held: drive.servo().held().cloned(),
                standing: drive.servo().standing(),
                delay: now().saturating_sub(look.taken_at),
                at: began.map(|began| look.taken_at.saturating_sub(began)),
            };
            drive.look(look);
            stops |= on_news(Some(news)).give(drive);
        }
        if stops && last_report.is_none() {
            return Ok(Step::Stop(StopReason::ByPerson));
        }
        if let Some((since, end)) = &done
            && since.elapsed() > ANSWER_TIME_AT_END
        {
            return Ok(end.clone());
        }
        let received = match (link.receive(POLL_INTERVAL), &done) {
            // The robot's program has ended.
            (Err(LinkError::Lost { .. }), Some((_, end))) => return Ok(end.clone()),
            (received, _) => received?,
        };
        let Some(bytes) = received else {
            let silent = last_report.map_or(Duration::ZERO, |at| at.elapsed());
            match &done {
                Some((_, end)) if silent > MAX_SILENCE_AT_END => return Ok(end.clone()),
                None if silent > MAX_SILENCE => {
                    let gap_s = silent.as_secs_f64();
                    return Ok(Step::Stop(StopReason::ArmTimes { gap_s }));
                }
                _ => continue,
            }
        };
        let driven = drive.take(&bytes, now());
        match (link.send(&driven.send), &done) {
            (Err(LinkError::Lost { .. }), Some((_, end))) => return Ok(end.clone()),
            (sent, _) => sent?,
        }
        if let Some(problem) = driven.problem {
            link.refused(&problem)?;
            on_news(Some(ServoNews::Problem(problem))).give(drive);
            continue;
        }
        let Some(step) = driven.step else {
            continue;
        };
        if last_report.replace(Instant::now()).is_none() {
            let robot = link.reported()?;
            began = Some(now());
            on_news(Some(ServoNews::Connected(robot))).give(drive);
        }
        match step {
            Step::Command(_) => {}
            Step::Stop(_) => return Ok(step),
            Step::Done(_) => {
                done.get_or_insert((Instant::now(), step));
            }
        }
    }
}

#[cfg(test)]
mod tests;
