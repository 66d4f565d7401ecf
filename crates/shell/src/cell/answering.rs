//! Answers robots from the window: runs the server of `partsight serve` with the source that the window follows as its camera,
//! and with the window's library, recipe and calibration.

mod rows;
mod work;

use std::{
    sync::{
        Arc, Mutex,
        atomic::{AtomicBool, Ordering},
    },
    time::{Duration, Instant},
};

use self::work::{AnswerInputs, AnswerRequest, answer};
pub use self::work::{AnsweringStatus, LastAnswer};
use crate::{
    action::Action,
    notice::{Notice, NoticeTopic},
    session::Session,
    workspace::ShellContext,
};
use geometry::error::lock;
use robot::RobotFrame;
use serve::Listener;
use ui::{
    language::text,
    task::{Task, TaskRunner},
    user_error::UserError,
    widgets::Mark,
};

/// Time after which a server that failed is started again.
const RETRY: Duration = Duration::from_secs(3);

/// The server, while robots are answered.
#[derive(Debug)]
pub struct Answering {
    task: Task<AnsweringStatus>,
    run: Option<AnsweringRun>,
    /// The latest status, once the server listens.
    status: Option<AnsweringStatus>,
    /// The last failure, until a server listens again.
    failed: Option<Failure>,
}

/// A server that could not listen, or stopped doing so.
#[derive(Debug)]
struct Failure {
    listener: Listener,
    problem: UserError,
    at: Instant,
}

/// A running server.
#[derive(Debug)]
struct AnsweringRun {
    listener: Listener,
    inputs: Arc<Mutex<AnswerInputs>>,
    is_ending: Arc<AtomicBool>,
}

impl AnsweringRun {
    /// True if it listens there, in this convention, and goes on. Another kind of pose is taken as it runs.
    fn answers_as(&self, listener: Listener) -> bool {
        self.listener == listener && !self.is_ending()
    }

    fn is_ending(&self) -> bool {
        self.is_ending.load(Ordering::Relaxed)
    }
}

impl Answering {
    pub(super) fn new(runner: &TaskRunner) -> Self {
        Self {
            task: Task::new("robots", runner),
            run: None,
            status: None,
            failed: None,
        }
    }

    /// Status of the server; `None` unless it listens.
    pub fn status(&self) -> Option<&AnsweringStatus> {
        self.status.as_ref()
    }

    /// Why no server listens, if it failed.
    pub fn problem(&self) -> Option<&UserError> {
        self.failed.as_ref().map(|failed| &failed.problem)
    }

    /// True unless a server is being started or stopped.
    pub(super) fn is_settled(&self) -> bool {
        match &self.run {
            Some(run) => self.status.is_some() && !run.is_ending(),
            None => true,
        }
    }

    /// Status text with its mark; `None` while answering is off.
    pub fn words(&self, session: &Session) -> Option<(Mark, String)> {
        if !session.answering.is_on {
            return None;
        }
        Some(match &self.status {
            Some(status) if session.is_live() => {
                let at = status.at.address.to_string();
                (Mark::Good, text!("robot-answers-at", at = at))
            }
            Some(_) => (Mark::Look, text!("robot-answers-without-frames")),
            None if self.run.is_some() && self.failed.is_none() => {
                (Mark::Open, text!("robot-answers-soon"))
            }
            None => (Mark::Bad, text!("robot-not-answered")),
        })
    }

    /// Starts, stops or updates the server as the session requires, and reads its reports.
    pub(super) fn update(&mut self, cx: &mut ShellContext<'_>) {
        while let Some(result) = self.task.poll() {
            match result {
                Ok(status) if self.task.running().is_some() => {
                    self.forget_failure(cx);
                    self.status = Some(status);
                }
                Ok(_) => self.ended(),
                Err(problem) => self.note_failure(problem, cx),
            }
        }
        let Some((listener, robot)) = wanted(cx.session) else {
            self.forget_failure(cx);
            self.end();
            return;
        };
        let is_elsewhere = |failed: &Failure| failed.listener != listener;
        if self.failed.as_ref().is_some_and(is_elsewhere) {
            self.forget_failure(cx);
        }
        match &self.run {
            Some(run) if run.answers_as(listener) => {
                *lock(&run.inputs) = AnswerInputs::of(cx.session, robot);
            }
            // The server first finishes the pending answers; a new one starts once it has ended. Where it listens and what its
            // numbers mean never changes while it runs: a client sees another one by its boot number.
            Some(_) => self.end(),
            None => {
                let failed = self.failed.as_ref();
                let wait = failed.map(|failed| RETRY.saturating_sub(failed.at.elapsed()));
                match wait.filter(|wait| !wait.is_zero()) {
                    Some(wait) => cx.egui.request_repaint_after(wait),
                    None => self.start(listener, robot, cx),
                }
            }
        }
    }

    /// Reports a failure, unless it is the same as at the last attempt.
    fn note_failure(&mut self, problem: UserError, cx: &mut ShellContext<'_>) {
        let is_known = self.problem() == Some(&problem);
        self.failed = self.run.as_ref().map(|run| Failure {
            listener: run.listener,
            problem: problem.clone(),
            at: Instant::now(),
        });
        if !is_known {
            cx.notify(Notice::from(problem).about(NoticeTopic::Answering));
        }
        self.ended();
    }

    /// Forgets the failure and removes its notice.
    fn forget_failure(&mut self, cx: &mut ShellContext<'_>) {
        if self.failed.take().is_some() {
            cx.send(Action::RemoveNotices(NoticeTopic::Answering));
        }
    }

    fn start(&mut self, listener: Listener, robot: Arc<RobotFrame>, cx: &ShellContext<'_>) {
        let inputs = Arc::new(Mutex::new(AnswerInputs::of(cx.session, robot)));
        let is_ending = Arc::new(AtomicBool::new(false));
        let egui = cx.egui.clone();
        let request = AnswerRequest {
            listener,
            inputs: Arc::clone(&inputs),
            is_ending: Arc::clone(&is_ending),
            library_cache: cx.services.library_cache.clone(),
            parts: Arc::clone(&cx.session.live.parts),
            on_history: Box::new(move || egui.request_repaint()),
        };
        self.task
            .start(text!("robot-answers-soon"), move |context| {
                answer(request, context)
            });
        self.run = Some(AnsweringRun {
            listener,
            inputs,
            is_ending,
        });
    }

    fn end(&self) {
        if let Some(run) = &self.run {
            run.is_ending.store(true, Ordering::Relaxed);
        }
    }

    fn ended(&mut self) {
        self.run = None;
        self.status = None;
    }
}

/// Returns where a server is to listen, and the robot frame; `None` if there is to be none. Without a calibration no pose can
/// be given in the robot's frame.
fn wanted(session: &Session) -> Option<(Listener, Arc<RobotFrame>)> {
    let setup = session.answering;
    let robot = session.robot.as_ref().filter(|_| setup.is_on)?;
    let listener = setup.listener().ok()?;
    Some((listener, Arc::clone(robot)))
}
