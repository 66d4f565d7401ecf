//! Answers robots from the window: runs the server of `partsight serve` with the source that the window follows as its camera,
//! and with the window's library, recipe and calibration; and the page of the dialog about that.

mod rows;
mod servoing;
mod work;

use std::{
    sync::{
        Arc, Mutex,
        atomic::{AtomicBool, Ordering},
    },
    time::{Duration, Instant},
};

use egui::{Label, RichText, TextEdit, Ui};
use jiff::{Timestamp, tz::TimeZone};

use crate::{
    action::Action,
    cell::{
        answering::work::{AnswerInputs, AnswerRequest, answer},
        dialog_state::{RobotAction, RobotDialog, RobotQuestion},
        setup::AnswerSetup,
        state::RobotCell,
    },
    notice::{Notice, NoticeTopic},
    session::Session,
    workspace::ShellContext,
};
use geometry::error::{Advice as _, lock};
use robot::{Convention, RobotFrame};
use serve::{
    Answer, ClientEvent, ClientNews, ListenAddress, Listener, PoseKind, Protocol, parse_address,
};
use ui::{
    language::{described, text, what_and_advice},
    task::{Task, TaskRunner},
    theme::space,
    user_error::UserError,
    widgets::{self, Mark, drop_down, error_row, heading, row, text_button, value_button},
};

pub use self::work::{AnsweringStatus, LastAnswer};

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

    /// What to do so that robots are answered with poses, while answering is on; empty if nothing.
    pub fn advice(&self, session: &Session) -> String {
        let is_followed = session.source.followed().is_some();
        match &self.failed {
            _ if session.robot.is_none() => text!("robot-calibrate-first"),
            Some(failed) => failed.problem.advice.clone(),
            None if session.is_live() => String::new(),
            None if is_followed => text!("robot-answers-without-frames-advice"),
            None => text!("live-cannot-advice"),
        }
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

/// Why robots that are to be answered get no pose or no frames, and what an operator does about it; `None` if they get both.
pub fn operators_warning(session: &Session) -> Option<String> {
    if !session.answering.is_on || session.robot.is_some() && session.is_live() {
        return None;
    }
    Some(if session.robot.is_none() {
        text!("operator-robots-without-pose")
    } else if session.source.followed().is_some() {
        text!("operator-robots-without-frames")
    } else {
        text!("operator-robots-without-source")
    })
}

/// Returns where a server is to listen, and the robot frame; `None` if there is to be none. Without a calibration no pose can
/// be given in the robot's frame.
fn wanted(session: &Session) -> Option<(Listener, Arc<RobotFrame>)> {
    let setup = session.answering;
    let robot = session.robot.as_ref().filter(|_| setup.is_on)?;
    let listener = setup.listener().ok()?;
    Some((listener, Arc::clone(robot)))
}

/// Draws the page of the dialog.
pub(super) fn page(
    ui: &mut Ui,
    robot: &RobotCell,
    session: &Session,
    dialog: &mut RobotDialog,
    caused: &mut Vec<RobotAction>,
) {
    let says = RichText::new(text!("robot-answer-says")).small();
    ui.label(says.weak());
    ui.add_space(space::SMALL);
    fields(ui, dialog);
    let typed = typed(dialog);
    let listener = typed.as_ref().map(|setup| (setup, setup.listener()));
    match &listener {
        Ok((_, Ok(listener))) => {
            if let Some(open) = listener.doubt() {
                error_row(ui, Mark::Look, &what_and_advice(&open).into());
            }
        }
        Ok((_, Err(error))) => {
            let problem = UserError {
                what: error.to_string(),
                advice: text!("robot-other-convention"),
            };
            error_row(ui, Mark::Bad, &problem);
        }
        Err(problem) => error_row(ui, Mark::Bad, problem),
    }
    ui.add_space(space::SMALL);
    let wanted = listener
        .ok()
        .and_then(|(setup, listener)| listener.is_ok().then_some(*setup));
    buttons(ui, session, wanted, dialog, caused);
    state(ui, robot, session);
    numbers(ui, session);
}

/// Draws the fields for protocol, address and pose.
fn fields(ui: &mut Ui, dialog: &mut RobotDialog) {
    ui.horizontal_wrapped(|ui| {
        ui.label(text!("robot-protocol"));
        for protocol in Protocol::ALL {
            value_button(ui, &mut dialog.protocol, protocol, protocol.name().into());
        }
    });
    ui.horizontal(|ui| {
        let label = ui.label(text!("robot-port"));
        ui.add(TextEdit::singleline(&mut dialog.address).desired_width(200.0))
            .labelled_by(label.id);
    });
    ui.horizontal_wrapped(|ui| {
        ui.label(text!("shell-pose"));
        for (pose, text) in [
            (PoseKind::RobotFromPart, text!("robot-pose-of-part")),
            (PoseKind::RobotOffset, text!("robot-pose-offset")),
        ] {
            value_button(ui, &mut dialog.pose, pose, text);
        }
    });
    ui.horizontal(|ui| {
        ui.label(text!("robot-poses-as"));
        if let Some(own) = dialog.protocol.own_convention() {
            ui.label(described(&own));
            return;
        }
        let title = described(&dialog.answered_in);
        let label = text!("robot-answered-in", convention = &title);
        drop_down(ui, &label, &title, 240.0, |ui| {
            for other in Convention::ALL {
                let title = described(&other);
                ui.selectable_value(&mut dialog.answered_in, other, title);
            }
        });
    });
}

/// Returns the settings as they were typed and chosen, with answering on.
fn typed(dialog: &RobotDialog) -> Result<AnswerSetup, UserError> {
    let text = dialog.address.trim();
    let address = parse_address(text).map_err(|_no_address| UserError {
        what: text!("robot-no-address", text = text),
        advice: text!("robot-no-address-advice"),
    })?;
    let at = ListenAddress {
        protocol: dialog.protocol,
        address,
    };
    Ok(AnswerSetup {
        is_on: true,
        at,
        pose: dialog.pose,
        convention: dialog.answered_in,
    })
}

fn buttons(
    ui: &mut Ui,
    session: &Session,
    wanted: Option<AnswerSetup>,
    dialog: &mut RobotDialog,
    caused: &mut Vec<RobotAction>,
) {
    let now = session.answering;
    let changed = wanted.filter(|setup| now.is_on && *setup != now);
    let changes_poses = changed.is_some_and(|setup| setup.changes_poses(&now));
    let is_changing = dialog.question == Some(RobotQuestion::ChangeAnswers);
    if is_changing && !changes_poses {
        dialog.question = None;
    }
    let is_changing = is_changing && changes_poses;
    if is_changing {
        let asked = UserError {
            what: text!("robot-change-poses"),
            advice: text!("robot-change-poses-advice"),
        };
        error_row(ui, Mark::Look, &asked);
    }
    let mut act = |setup| caused.push(RobotAction::Answer(setup));
    ui.horizontal(|ui| {
        if !now.is_on {
            let can = wanted.is_some() && session.robot.is_some();
            let is_pressed = widgets::default_button(ui, &text!("robot-turn-on"), can);
            if let (true, Some(setup)) = (is_pressed, wanted) {
                act(setup);
            }
            return;
        }
        match changed {
            Some(setup) if is_changing => {
                if text_button(ui, &text!("robot-change-poses-do")).clicked() {
                    dialog.question = None;
                    act(setup);
                }
                if widgets::default_button(ui, &text!("robot-change-poses-not"), true) {
                    dialog.question = None;
                    dialog.protocol = now.at.protocol;
                    dialog.pose = now.pose;
                    dialog.answered_in = now.convention;
                }
            }
            Some(setup) if widgets::default_button(ui, &text!("robot-use-it"), true) => {
                if changes_poses {
                    dialog.question = Some(RobotQuestion::ChangeAnswers);
                } else {
                    act(setup);
                }
            }
            _ => {}
        }
        if text_button(ui, &text!("robot-turn-off")).clicked() {
            act(AnswerSetup {
                is_on: false,
                ..now
            });
        }
    });
}

/// Draws whether robots are answered, and if not, why.
fn state(ui: &mut Ui, robot: &RobotCell, session: &Session) {
    let answering = robot.answering();
    ui.add_space(space::SMALL);
    if session.robot.is_none() {
        let nowhere = UserError {
            what: text!("robot-not-calibrated"),
            advice: text!("robot-calibrate-first"),
        };
        error_row(ui, Mark::Look, &nowhere);
    }
    let Some((sign, what)) = answering.words(session) else {
        return;
    };
    if let Some(problem) = answering.problem() {
        error_row(ui, Mark::Bad, problem);
    } else {
        // Without a calibration, the advice is above.
        let advice = match &session.robot {
            Some(_) => answering.advice(session),
            None => String::new(),
        };
        error_row(ui, sign, &UserError { what, advice });
    }
    if let Some(status) = answering.status() {
        figures(ui, status);
    }
}

/// Draws the address, the connections and the last answer.
fn figures(ui: &mut Ui, status: &AnsweringStatus) {
    row(ui, &text!("robot-listens-at"), &status.at.to_string());
    let clients = status.num_clients.to_string();
    row(ui, &text!("robot-clients"), &clients);
    if let Some(event) = &status.client {
        client(ui, event);
    }
    let last = match &status.last {
        Some(last) => in_words(last),
        None => text!("robot-no-trigger"),
    };
    row(ui, &text!("robot-last-trigger"), &last);
    if let Some(problem) = &status.problem {
        error_row(ui, Mark::Bad, problem);
    }
}

/// Draws the last event of a connection.
fn client(ui: &mut Ui, event: &ClientEvent) {
    let peer = event.peer.to_string();
    let name = text!("robot-last-client");
    match &event.news {
        ClientNews::Connected => row(ui, &name, &text!("robot-client-connected", peer = peer)),
        ClientNews::Left => row(ui, &name, &text!("robot-client-left", peer = peer)),
        ClientNews::TurnedAway => {
            let full = UserError {
                what: text!("robot-client-turned-away", peer = peer),
                advice: text!("robot-client-turned-away-advice"),
            };
            error_row(ui, Mark::Look, &full);
        }
        ClientNews::BadRequest(why) => {
            let bad = UserError {
                what: format!("{peer}: {why}"),
                advice: why.advice(),
            };
            error_row(ui, Mark::Look, &bad);
        }
        // Only HTTP has tokens.
        ClientNews::WrongToken => {}
    }
}

/// Describes the last trigger and its answer in the terms of the protocol.
pub(crate) fn in_words(last: &LastAnswer) -> String {
    let LastAnswer { at, answer } = last;
    let at = clock(*at);
    let verdict = match answer.problem.reason.as_str() {
        "" => answer.verdict.name().to_owned(),
        reason => format!("{} ({reason})", answer.verdict.name()),
    };
    let part = (!answer.part.is_empty()).then(|| answer.part.clone());
    // Answers to SERVO are numbered too, but the window does not receive their numbers.
    let number =
        (answer.sequence > 0).then(|| text!("robot-answer-number", number = answer.sequence));
    let age = answer
        .age_ms
        .map(|age| text!("robot-answer-age", age = age));
    let is_unchecked = answer.flags() & Answer::MOTION_UNCHECKED != 0;
    let unchecked = is_unchecked.then(|| text!("robot-answer-motion-unchecked"));
    let all = [Some(at), Some(verdict), unchecked, part, number, age];
    let all: Vec<String> = all.into_iter().flatten().collect();
    all.join(" · ")
}

/// Formats a moment as local time of day.
pub(crate) fn clock(at: Timestamp) -> String {
    let at = at.to_zoned(TimeZone::system());
    at.strftime("%H:%M:%S").to_string()
}

/// Draws the numbers by which robots know the parts.
fn numbers(ui: &mut Ui, session: &Session) {
    let Some(library) = &session.library else {
        return;
    };
    heading(ui, &text!("robot-part-numbers"));
    let parts = library.parts.iter().map(|part| {
        let number = library.numbers.number_of(&part.name);
        let number = number.map_or_else(|| "–".into(), |number| number.to_string());
        format!("{number} {}", part.name)
    });
    let parts: Vec<String> = parts.collect();
    let small = RichText::new(parts.join(" · ")).small();
    ui.add(Label::new(small).wrap());
}
