//! The inspections of `partsight serve`: takes, inspects, shows and records frames.

use std::{
    ops::ControlFlow,
    sync::{Arc, mpsc::Receiver},
    time::Duration,
};

use super::show_numbers;
use crate::cli::{
    Outcome,
    console::{Console, advised_error},
    input::scene_of,
    interrupt::Interrupt,
    output::OutputFormat,
    plant::{Services, TakenLibrary},
    record::HistoryRecorder,
};
use capture::{FeedState, SourceSpec};
use geometry::error::{Advice as _, guarded};
use inspection::{
    library::Library,
    pipeline::{MirrorTally, NamedRecipe},
};
use records::{
    history::{HungId, NewEntry, Traceability},
    orders::OrdersFile,
    report::{InspectionLine, SCHEMA},
};
use serde_json::json;
use serve::{
    Answer, Asked, ClientEvent, ClientNews, ExpectedNumbers, Found, FrameParts, InspectionRecord,
    Inspector, Problem, ServoRequest, VerdictCode,
};
use station::{
    Answered, Answering, Camera, CameraScenes, Inspected, LineFollower, NoFrame, PartFinder,
    Subject,
    servoing::{CarriedCamera, RestWatch, ServoParts, SetupError, SingleMoves},
    traced,
};

/// The inspections of a service, on the thread that runs its server.
pub(super) struct ServeSession<'a> {
    pub(super) camera: Arc<Camera>,
    pub(super) interrupt: Interrupt,
    pub(super) events: Receiver<ClientEvent>,
    pub(super) library: Library,
    pub(super) recipe: NamedRecipe,
    pub(super) finder: PartFinder,
    /// Robots that servo, or why they are not answered.
    pub(super) servoing: Result<SingleMoves, SetupError>,
    /// The camera on a simulated arm, if that is the camera.
    pub(super) carried: Option<CarriedCamera>,
    /// The table of orders that triggers may name.
    pub(super) orders: Option<OrdersFile>,
    /// What triggers are traced by that name no order, and what the last one is.
    pub(super) trace: Traceability,
    pub(super) traced: Traceability,
    pub(super) scenes: CameraScenes,
    pub(super) source: SourceSpec,
    /// The line that carries the parts, and what is recorded of each.
    pub(super) line: Option<LineFollower<Option<NewEntry>>>,
    pub(super) frame_timeout: Duration,
    pub(super) format: OutputFormat,
    pub(super) recording: Option<HistoryRecorder>,
    pub(super) mirrored: MirrorTally,
    pub(super) console: &'a mut Console,
    /// The inspection that is being answered.
    pub(super) last: Option<Answered>,
    /// The error of the camera that was shown last.
    pub(super) problem: Option<String>,
    /// True once the camera has run.
    pub(super) has_run: bool,
    /// True once the warning about a closed standard output was shown.
    pub(super) has_told_closed: bool,
    /// Why the service must end.
    pub(super) failure: Option<anyhow::Error>,
    pub(super) num_inspected: u64,
    pub(super) services: Services<'a>,
}

impl Inspector for ServeSession<'_> {
    fn inspect(&mut self, asked: &Asked) -> FrameParts {
        self.traced = traced(&asked.order, &self.trace);
        let recipe = match self.recipe_for(asked) {
            Ok(recipe) => recipe,
            Err(why) => return self.without_frame(&why),
        };
        if let Some(mut line) = self.line.take() {
            let found = self.inspect_on_line(asked, &recipe, &mut line);
            self.line = Some(line);
            return found;
        }
        let interrupt = &self.interrupt;
        let camera = &self.camera;
        let captured = camera.frame_without_line(asked, self.frame_timeout, || interrupt.came());
        let captured = match captured {
            Ok(captured) => captured,
            Err(why) => return self.without_frame(&why),
        };
        let num_dropped = self.camera.feed_status().num_dropped;
        let subject = Subject::of_capture(&captured, &self.source, num_dropped);
        let is_ending = || interrupt.came();
        let answering = Answering {
            camera: &self.camera,
            finder: &self.finder,
            library: &self.library,
            recipe: &recipe,
            expected: asked.expected,
            at_most: self.frame_timeout,
            is_ending: &is_ending,
        };
        let (scenes, console) = (&mut self.scenes, &*self.console);
        let scene_of = |captured| Arc::new(scene_of(captured, scenes, console));
        match answering.answer(captured, subject, &self.traced, scene_of) {
            Ok(answered) => self.last.insert(answered).found.clone(),
            Err(why) => self.without_frame(&why),
        }
    }

    fn servo(&mut self, request: &ServoRequest, client: u64, asked: &Asked) -> Found {
        let found = self.next_move(request, client, asked);
        self.show_move(&found);
        self.record_runs();
        found
    }

    fn recorded(&mut self, record: InspectionRecord) {
        let answer = record.answer();
        if answer.verdict == VerdictCode::Error && matches!(self.format, OutputFormat::Json) {
            let Problem { reason, message } = &answer.problem;
            let source = self.source.to_string();
            let mut line = InspectionLine::failed(&source, reason, message);
            line.trace = Some(&self.traced);
            self.console.line(&line.to_json());
        }
        self.services.inspected(record, &self.traced);
    }

    fn answered(&mut self) {
        let Some(answered) = self.last.take() else {
            return;
        };
        if let Err(fault) = guarded(|| self.show(&answered)) {
            let scene = &answered.subject.scene;
            self.console.warn(&format_args!("{scene}: {fault}"), &fault);
        }
    }

    fn turn(&mut self) -> ControlFlow<()> {
        for event in self.events.try_iter() {
            show_event(&event, self.console);
        }
        self.look_at_camera();
        self.look_at_output();
        self.follow_line();
        if let Some(recording) = &self.recording {
            recording.tell(self.console);
        }
        self.services.turn(self.camera.status(), self.console);
        self.use_taken_library();
        if self.interrupt.came() || self.failure.is_some() {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    }
}

/// The entry of a part on the line for the history, if there is one. No trigger has named it yet.
fn entry_of(
    recording: Option<&HistoryRecorder>,
    part: &Inspected<'_>,
    hung: HungId,
) -> Option<NewEntry> {
    recording.map(|recording| recording.entry(part, hung))
}

impl ServeSession<'_> {
    /// The recipe with what is expected after a trigger, unless it names parts by their numbers. The table of orders may have
    /// changed since the last one.
    fn recipe_for(&mut self, asked: &Asked) -> Result<NamedRecipe, NoFrame> {
        let recipe = &self.recipe;
        if asked.expected.iter().any(|one| one.is_given()) {
            return Ok(recipe.clone());
        }
        let Some(orders) = &mut self.orders else {
            let is_plain = !asked.order.is_given();
            return is_plain.then(|| recipe.clone()).ok_or(NoFrame::NoOrders);
        };
        let is_enrolled = |name: &str| self.library.has_part(name);
        let table = orders.table().map_err(NoFrame::Orders)?;
        let expected = table.expected(&self.traced, Some(&recipe.rack), is_enrolled)?;
        Ok(recipe.expecting(expected))
    }

    fn next_move(&mut self, request: &ServoRequest, client: u64, asked: &Asked) -> Found {
        let servoing = match &mut self.servoing {
            Ok(servoing) => servoing,
            Err(why) => return Found::error(Problem::of(why.kind(), why)),
        };
        let stands = (self.carried.as_ref())
            .map(|carried| carried.stand(&request.robot_from_flange, asked))
            .transpose();
        let asked = match &stands {
            Ok(stands) => stands.as_ref().unwrap_or(asked),
            Err(why) => {
                return Found {
                    verdict: VerdictCode::Stay,
                    marks: Answer::SIMULATED,
                    problem: Problem::of(why.kind(), why),
                    ..Found::default()
                };
            }
        };
        let parts = ServoParts {
            finder: &self.finder,
            library: &self.library,
            recipe: &self.recipe,
        };
        let interrupt = &self.interrupt;
        let watch = RestWatch {
            camera: &self.camera,
            library: &self.library,
            at_most: self.frame_timeout,
            is_ending: &|| interrupt.came(),
        };
        let (scenes, console) = (&mut self.scenes, &*self.console);
        servoing.answer(request, client, asked, parts, |prepared, asked, num| {
            watch.looks(prepared, asked, num, |captured| {
                Arc::new(scene_of(captured, scenes, console))
            })
        })
    }

    /// Adds the runs of servoing that have ended to the history.
    fn record_runs(&mut self) {
        let (Ok(servoing), Some(recording)) = (&mut self.servoing, &self.recording) else {
            return;
        };
        for mut record in servoing.take_ended() {
            record.run.title = recording.title_of(&record.run.part);
            recording.add_servo_run(record);
        }
    }

    /// Shows what a robot that servoes is told.
    fn show_move(&mut self, found: &Found) {
        let error = found.servo_error.map(|error| error.error);
        let Problem { reason, message } = &found.problem;
        let verdict = found.verdict.name();
        if matches!(self.format, OutputFormat::Json) {
            self.console.line(&json!({
                "schema": SCHEMA,
                "servo": verdict,
                "part": found.part,
                "error_m": error.map(|error| error.shift.0),
                "error_rad": error.map(|error| error.rotation.0),
                "reason_kind": Some(reason).filter(|reason| !reason.is_empty()),
                "reason": Some(message).filter(|message| !message.is_empty()),
            }));
        } else if let Some(error) = error {
            let (mm, degrees) = (error.shift.mm(), error.rotation.degrees());
            self.console.note(&format_args!(
                "SERVO {}: {verdict}, {mm:.1} mm and {degrees:.2}° are left",
                found.part
            ));
        } else {
            self.console
                .note(&format_args!("SERVO {}: {verdict}, {message}", found.part));
        }
    }

    /// The answer to a trigger about the parts on a line.
    fn inspect_on_line(
        &mut self,
        asked: &Asked,
        recipe: &NamedRecipe,
        line: &mut LineFollower<Option<NewEntry>>,
    ) -> FrameParts {
        let interrupt = &self.interrupt;
        let is_ending = || interrupt.came();
        let answering = Answering {
            camera: &self.camera,
            finder: &self.finder,
            library: &self.library,
            recipe,
            expected: asked.expected,
            at_most: self.frame_timeout,
            is_ending: &is_ending,
        };
        let (camera, source, at_most) = (&self.camera, &self.source, self.frame_timeout);
        let next = || {
            let captured = camera.frame_after(asked, at_most, is_ending)?;
            let num_dropped = camera.feed_status().num_dropped;
            let subject = Subject::of_capture(&captured, source, num_dropped);
            Ok((captured, subject))
        };
        let (scenes, console) = (&mut self.scenes, &*self.console);
        let scene_of = |captured| Arc::new(scene_of(captured, scenes, console));
        let recording = self.recording.as_ref();
        // What the trigger names is only of the part that the answer begins with, which mostly was recorded before.
        let entry = |part: &Inspected<'_>, hung| entry_of(recording, part, hung);
        let (answered, recorded, named) =
            answering.answer_on_line(asked, line, &self.traced, next, scene_of, entry);
        self.record(recorded);
        if let (Some(recording), Some(hung)) = (&self.recording, named) {
            recording.trace(hung, self.traced.clone());
        }
        match answered {
            Ok(answered) => self.last.insert(answered).found.clone(),
            Err(why) => self.without_frame(&why),
        }
    }

    /// Follows the parts on the line between the triggers, so that none is missed and a trigger need not wait.
    fn follow_line(&mut self) {
        let Some(line) = &mut self.line else { return };
        let Some(captured) = self.camera.newest() else {
            return;
        };
        let subject = Subject::of_capture(&captured, &self.source, 0);
        let answering = Answering {
            camera: &self.camera,
            finder: &self.finder,
            library: &self.library,
            recipe: &self.recipe,
            expected: ExpectedNumbers::default(),
            at_most: self.frame_timeout,
            is_ending: &|| false,
        };
        let (scenes, console) = (&mut self.scenes, &*self.console);
        let scene_of = |captured| Arc::new(scene_of(captured, scenes, console));
        let recording = self.recording.as_ref();
        let entry = |part: &Inspected<'_>, hung| entry_of(recording, part, hung);
        let followed = guarded(|| {
            answering
                .follow(captured, subject, line, scene_of, entry)
                .map(|seen| seen.1)
        });
        match followed {
            Ok(Ok(recorded)) => self.record(recorded),
            Ok(Err(why)) => {
                self.without_frame(&why);
            }
            Err(fault) => self.console.warn(&fault, &fault),
        }
    }

    fn record(&mut self, entries: Vec<Option<NewEntry>>) {
        if let Some(recording) = &mut self.recording {
            for entry in entries.into_iter().flatten() {
                recording.add(entry, self.console);
            }
        }
    }

    /// The result of a trigger after which nothing can be inspected; shows why.
    fn without_frame(&self, why: &NoFrame) -> FrameParts {
        self.console
            .advise(&format_args!("error: {why}"), &why.advice());
        Found::error(why.into()).into()
    }

    /// Shows an inspection and adds it to the history.
    fn show(&mut self, answered: &Answered) {
        let Answered { subject, found, .. } = answered;
        // Only the answer marks a replayed frame as well.
        if self.num_inspected == 0 && subject.is_simulated {
            self.console.note(&"Simulated: no camera is read.");
        }
        self.num_inspected += 1;
        let parts = answered.parts(&self.finder.robot);
        let (name, line) = (&subject.scene, &found.first.report);
        self.format
            .inspected(name, line, &parts, &self.library, self.console);
        for part in &parts {
            self.mirrored.add(&part.inspection.verdict);
            // Parts on a line are recorded as they pass, whether anything triggers or not.
            if let (Some(recording), None) = (&mut self.recording, &self.line) {
                // Only the client knows whether it is the same part again.
                let entry = recording.traced_entry(part, HungId::new(), &self.traced);
                recording.add(entry, self.console);
            }
        }
    }

    /// Uses a version of the library that was taken meanwhile.
    fn use_taken_library(&mut self) {
        let Some(TakenLibrary { load, parts }) = self.services.taken_library(self.console) else {
            return;
        };
        show_numbers(&parts, &load, self.console);
        if let Some(recording) = &mut self.recording {
            recording.use_library(&load);
        }
        self.finder.parts = parts;
        self.library = load.library;
        if let Ok(servoing) = &mut self.servoing {
            servoing.end_run();
        }
    }

    /// Reports each cause of a missing camera once, and when the camera is back. A camera that fails before it ever ran
    /// ends the service.
    fn look_at_camera(&mut self) {
        let (error, is_failed) = match self.camera.feed_status().state {
            FeedState::Running => {
                self.has_run = true;
                if self.problem.take().is_some() {
                    self.console.note(&"The camera is back");
                }
                return;
            }
            FeedState::Lost { error } => (error, false),
            FeedState::Failed(error) => (error, true),
            FeedState::Opening | FeedState::Ended | FeedState::Stopped => return,
        };
        let words = error.to_string();
        if is_failed && !self.has_run {
            self.failure = Some(advised_error(words, error.advice()));
            return;
        }
        if self.problem.as_ref() != Some(&words) {
            self.console.warn(&words, &*error);
            self.problem = Some(words);
        }
    }

    /// Warns once that standard output was closed. A closed pipe cannot be reopened, so no line is tried again.
    fn look_at_output(&mut self) {
        if !self.has_told_closed && !self.console.is_read() {
            self.has_told_closed = true;
            self.console.advise(
                &"warning: the reader of the standard output has closed it; the service goes on without it",
                &"Check the program that reads it, then start the service again together with it",
            );
        }
    }

    /// Writes what is left. Returns why the service had to end, if it had to.
    pub(super) fn finish(mut self) -> anyhow::Result<Outcome> {
        let left = self.line.take().map(LineFollower::end);
        self.record(left.unwrap_or_default());
        if let Ok(servoing) = &mut self.servoing {
            servoing.end_run();
        }
        self.record_runs();
        let console = self.console;
        if let Some(suspicion) = self.mirrored.suspicion() {
            console.warn(&suspicion, &suspicion);
        }
        // Before the services, which may wait for a broker.
        if let Some(recording) = self.recording {
            recording.finish(console);
        }
        self.services.end(console);
        if let Some(error) = self.failure {
            return Err(error);
        }
        console.note(&format_args!("{} inspected", self.num_inspected));
        Ok(Outcome::Accepted)
    }
}

fn show_event(event: &ClientEvent, console: &Console) {
    let (peer, protocol) = (event.peer, event.protocol);
    match &event.news {
        ClientNews::Connected => console.note(&format_args!("{peer} connected: {protocol}")),
        ClientNews::Left => console.note(&format_args!("{peer} left")),
        ClientNews::TurnedAway => console.advise(
            &format_args!(
                "warning: {peer} was refused: the maximum number of clients is connected"
            ),
            &"Close a connection that is not used, or raise --max-clients",
        ),
        ClientNews::BadRequest(why) => {
            console.warn(
                &format_args!("{peer}: {why}; the connection was closed"),
                why,
            );
        }
        ClientNews::WrongToken => console.advise(
            &format_args!("warning: {peer} sent no token or a wrong one: {protocol}"),
            &"Give the client a token of --http-token-file; if you do not know the client, find out who it is",
        ),
    }
}
