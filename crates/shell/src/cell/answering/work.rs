//! The server's task: runs the server, and inspects a frame of the window's source for each trigger.

use std::{
    io,
    ops::ControlFlow,
    sync::{
        Arc, Mutex,
        atomic::{AtomicBool, Ordering},
        mpsc::{self, Receiver},
    },
    time::Duration,
};

use jiff::Timestamp;

use super::{
    rows::{AnsweredScene, TriggerRows},
    servoing::{ServoInputs, Servoing},
};
use crate::{
    inspection::{
        inspected::entry_of,
        library_cache::{LibraryCache, LibraryView, LoadedLibrary},
        source::{Captured, Origin},
    },
    session::Session,
    source::live::FollowedParts,
    trace::{current_trace::CurrentTrace, orders::NotKnown},
};
use capture::{self, CaptureError, Feed, SourceSpec};
use geometry::error::{Advice as _, guarded, lock};
use inspection::{
    library::{GivenNumbers, Library, LibraryPlace, PartNumbers, Truth},
    pipeline::{Expected, Inspection, NamedRecipe, ProgressObserver as _, Unwatched},
};
use records::{
    history::{HungId, SpotIds, Traceability, Writer},
    orders::Orders,
    report::segmentation_picture,
};
use robot::RobotFrame;
use serve::{
    Answer, Asked, CameraState, ClientEvent, Found, FrameParts, InspectionRecord, Inspector,
    ListenAddress, Listener, PoseKind, Problem, ServeError, Server, ServerHandle, ServerSettings,
    ServoRequest, VerdictCode,
};
use servo::StopReason;
use stages::scene::{EmptyCell, SceneCloud};
use station::{
    Answered, Answering, Camera, NewFrame, NoFrame, NumberedPart, PartFinder, Subject,
    servoing::{RestFrames, RestWatch, ServoParts},
    traced,
};
use ui::{
    language::{Message, described, text},
    task::{TaskContext, TaskError},
    user_error::UserError,
    widgets::sentence,
};

/// How long a trigger waits for its frame, as in `partsight serve`.
const FRAME_TIMEOUT: Duration = Duration::from_secs(5);
/// Capacity for client events that the task has not read yet; further ones are dropped.
const MAX_EVENTS: usize = 64;

/// Status of the server.
#[derive(Clone, Debug, PartialEq)]
pub struct AnsweringStatus {
    /// Address of the listener, with the port that the system chose.
    pub at: ListenAddress,
    /// Number of connections.
    pub num_clients: usize,
    /// The last event of any connection.
    pub client: Option<ClientEvent>,
    /// The answer to the last trigger.
    pub last: Option<LastAnswer>,
    /// Why the last inspection was not kept, which does not affect its answer, why the parts have no stored numbers, or why robots
    /// cannot servo.
    pub problem: Option<UserError>,
}

/// The last trigger and its answer.
#[derive(Clone, Debug, PartialEq)]
pub struct LastAnswer {
    /// When the trigger arrived.
    pub at: Timestamp,
    /// The answer; the default until it is given.
    pub answer: Answer,
}

/// The inputs for answering a trigger. The window replaces them while the server runs.
#[derive(Clone, Debug)]
pub(super) struct AnswerInputs {
    /// The source, while Live follows one.
    followed: Option<SourceSpec>,
    pub(super) recipe: Arc<NamedRecipe>,
    /// What should hang there, unless the trigger says it.
    expected: Result<Expected, NotKnown>,
    /// The table of the orders that triggers may name.
    orders: Result<Option<Arc<Orders>>, NotKnown>,
    empty_cell: Option<Arc<EmptyCell>>,
    pub(super) robot: Arc<RobotFrame>,
    pub(super) servo: ServoInputs,
    pose: PoseKind,
    trace: CurrentTrace,
}

impl AnswerInputs {
    pub(super) fn of(session: &Session, robot: Arc<RobotFrame>) -> Self {
        let followed = session.is_live().then(|| session.source.followed());
        Self {
            followed: followed.flatten(),
            recipe: session.recipe_in_rack(session.rack.in_camera(), Expected::default()),
            expected: session.expected_now(),
            orders: session.orders(),
            empty_cell: session.empty_cell.clone(),
            robot,
            servo: ServoInputs::of(session),
            pose: session.answering.pose,
            trace: session.trace.clone(),
        }
    }
}

impl AnswerInputs {
    /// What should hang there after a trigger: what its order says, else what the window does. Of one that numbers parts, these
    /// count later.
    fn expected_by(
        &self,
        asked: &Asked,
        trace: &Traceability,
        is_enrolled: impl Fn(&str) -> bool,
    ) -> Result<Expected, Problem> {
        let not_known = |why: &NotKnown| {
            let UserError { what, advice } = why.in_english();
            Problem::new("not_known", &what, &advice)
        };
        if asked.order.is_given() {
            let orders = self.orders.as_ref().map_err(not_known)?;
            let orders = orders.as_ref().ok_or(&NoFrame::NoOrders)?;
            let expected = orders.expected(trace, Some(&self.recipe.rack), is_enrolled);
            return expected.map_err(|error| not_known(&NotKnown::Order(error)));
        }
        match &self.expected {
            Err(why) if !asked.expected.iter().any(|one| one.is_given()) => Err(not_known(why)),
            expected => Ok(expected.clone().unwrap_or_default()),
        }
    }
}

/// What the server's task needs.
pub(super) struct AnswerRequest {
    pub(super) listener: Listener,
    pub(super) inputs: Arc<Mutex<AnswerInputs>>,
    pub(super) is_ending: Arc<AtomicBool>,
    pub(super) library_cache: LibraryCache,
    /// The parts that Live sees.
    pub(super) parts: Arc<Mutex<FollowedParts>>,
    /// Called when the history may have changed.
    pub(super) on_history: Box<dyn Fn() + Send>,
}

/// Runs the server until `is_ending` is set or the task is cancelled. On return, all answered inspections are in the history.
pub(super) fn answer(
    request: AnswerRequest,
    context: &TaskContext<AnsweringStatus>,
) -> Result<AnsweringStatus, TaskError> {
    let AnswerRequest {
        listener,
        inputs,
        is_ending,
        library_cache,
        parts,
        on_history,
    } = request;
    let followed = Arc::<Mutex<Option<SourceSpec>>>::default();
    let camera = {
        let (followed, library_cache) = (Arc::clone(&followed), library_cache.clone());
        Camera::start_with(move || {
            let followed = lock(&followed).clone();
            Ok(followed_feed(followed.as_ref(), &library_cache))
        })
    };
    let camera = Arc::new(camera.map_err(|error| UserError::of(&error))?);
    let (tell, events) = mpsc::sync_channel(MAX_EVENTS);
    let of_server = Arc::clone(&camera);
    let server = Server::start(
        &[listener],
        ServerSettings::default(),
        move || of_server.status(),
        move |event| {
            // Dropped if the channel is full: only the last one is shown anyway.
            let _ = tell.try_send(event);
        },
    );
    let mut server = server.map_err(|error| in_words(&error))?;
    let writer = Writer::start(Arc::clone(library_cache.history()), on_history);
    let writer = writer.map_err(|error| UserError {
        what: text!("shell-no-thread", error = error.to_string()),
        advice: text!("shell-no-thread-advice"),
    })?;
    let now = lock(&inputs).clone();
    let mut session = AnsweringSession {
        context,
        is_ending: &is_ending,
        inputs: &inputs,
        library_cache: &library_cache,
        parts: &parts,
        followed,
        finder: PartFinder {
            parts: Vec::new(),
            robot: (*now.robot).clone(),
            kind: now.pose,
        },
        library: None,
        unkept: None,
        unnumbered: None,
        camera,
        events,
        handle: server.handle(),
        rows: TriggerRows::new(writer, Arc::clone(&parts)),
        servoing: Servoing::default(),
        last: None,
        answered_parts: None,
        status: AnsweringStatus {
            at: server.addresses().first().copied().unwrap_or(listener.at),
            num_clients: 0,
            client: None,
            last: None,
            problem: None,
        },
        sent: None,
    };
    server.run(&mut session);
    Ok(session.finish())
}

/// Explains why the server does not listen, and what to do in the window.
fn in_words(error: &ServeError) -> UserError {
    match error {
        ServeError::Bind { at, source, .. } if source.kind() == io::ErrorKind::AddrInUse => {
            UserError {
                what: text!("robot-port-in-use", at = at),
                advice: text!("robot-port-in-use-advice"),
            }
        }
        ServeError::Bind { .. } => UserError {
            what: error.to_string(),
            advice: text!("robot-cannot-listen-advice"),
        },
        ServeError::NoThread { .. } => UserError::of(error),
    }
}

/// Returns a feed of the source that the window follows, and the rule for which of its frames are new.
fn followed_feed(followed: Option<&SourceSpec>, library_cache: &LibraryCache) -> (Feed, NewFrame) {
    match followed {
        Some(spec) => (library_cache.camera().tap(spec), NewFrame::of_source(spec)),
        None => (
            Feed::failed(CaptureError::NotFollowed),
            NewFrame::SecondArrived,
        ),
    }
}

/// Answers triggers on the thread that runs the server.
struct AnsweringSession<'a> {
    context: &'a TaskContext<AnsweringStatus>,
    is_ending: &'a AtomicBool,
    inputs: &'a Mutex<AnswerInputs>,
    library_cache: &'a LibraryCache,
    parts: &'a Mutex<FollowedParts>,
    camera: Arc<Camera>,
    /// The source that the camera is started with.
    followed: Arc<Mutex<Option<SourceSpec>>>,
    finder: PartFinder,
    /// The library whose parts `finder` has.
    library: Option<Arc<LoadedLibrary>>,
    /// Why the last inspection was not kept.
    unkept: Option<UserError>,
    /// Why the parts have no stored numbers.
    unnumbered: Option<UserError>,
    events: Receiver<ClientEvent>,
    handle: ServerHandle,
    rows: TriggerRows,
    servoing: Servoing,
    /// The inspection whose answer is on its way.
    last: Option<AnsweredFrame>,
    /// The parts of the last answer.
    answered_parts: Option<AnsweredParts>,
    status: AnsweringStatus,
    sent: Option<AnsweringStatus>,
}

/// An inspection to be kept in the history.
struct AnsweredFrame {
    origin: Origin,
    subject: Subject,
    frame: Arc<AnsweredScene>,
    /// What each part really is, if a person has reported it as wrong.
    reported_as: Vec<Option<Truth>>,
    library: Arc<LibraryView>,
    trace: Traceability,
    /// Tells which parts they are.
    part: Receiver<SpotIds>,
}

/// The parts of the frame that was answered last.
struct AnsweredParts {
    frame: Arc<AnsweredScene>,
    /// Which hung parts they are: as far as was known when the frame came, then also as Live saw it.
    hung: Vec<Vec<HungId>>,
    /// Tells what Live saw.
    hung_reports: Receiver<SpotIds>,
}

impl AnsweredParts {
    /// What each of them really is, if it was accepted and a person has reported it as wrong.
    fn reported_as(&mut self, parts: &Mutex<FollowedParts>) -> Vec<Option<Truth>> {
        let reports = self.hung_reports.try_recv().ok();
        self.hung.extend(reports.map(|ids| self.frame.hung(&ids)));
        let parts = lock(parts);
        let all = self.frame.inspections.iter().enumerate();
        let reported_as = all.map(|(index, inspection)| {
            let verdict = &inspection.verdict;
            let name = verdict.guess().filter(|_| verdict.is_accepted())?;
            let mut hung = self.hung.iter();
            hung.find_map(|hung| parts.reported_as(&hung[index], name))
        });
        reported_as.collect()
    }
}

impl Inspector for AnsweringSession<'_> {
    fn inspect(&mut self, asked: &Asked) -> FrameParts {
        self.status.last = Some(LastAnswer {
            at: asked.by_clock,
            answer: Answer::default(),
        });
        let inputs = self.follow();
        let trace = traced(&asked.order, &inputs.trace.remembered());
        let loaded = self.library_cache.get();
        let is_enrolled = |name: &str| {
            let mut parts = loaded.shown.parts.iter();
            parts.any(|part| part.part_name().as_str() == name)
        };
        let expected = match inputs.expected_by(asked, &trace, is_enrolled) {
            Ok(expected) => expected,
            Err(problem) => return Found::error(problem).into(),
        };
        let is_ending = || self.is_ending();
        let captured = match self
            .camera
            .frame_without_line(asked, FRAME_TIMEOUT, is_ending)
        {
            Ok(captured) => captured,
            Err(why) => return Found::error((&why).into()).into(),
        };
        let Some(spec) = &inputs.followed else {
            return Found::error((&NoFrame::Ended).into()).into();
        };
        let source = spec.to_string();
        // At once: by the end of the inspection another part may hang there.
        let mut parts = lock(self.parts);
        let hung = parts.ids_now(&source, true);
        let [part, hung_reports] =
            [(); 2].map(|()| parts.parts_of_frame(source.clone(), captured.arrived));
        drop(parts);
        let num_dropped = self.camera.feed_status().num_dropped;
        let origin = Origin::of_capture(&captured, spec, num_dropped);
        let subject = origin.subject(source);
        self.know(&loaded, &inputs);
        let recipe = &inputs.recipe.expecting(expected);
        let fitted = loaded.fitting(recipe, &Unwatched);
        let answering = Answering {
            camera: &self.camera,
            finder: &self.finder,
            library: &fitted.expect("not cancelled"),
            recipe,
            expected: asked.expected,
            at_most: FRAME_TIMEOUT,
            is_ending: &|| self.is_ending(),
        };
        let scene_of = |captured| self.scene_of(captured, &inputs);
        let answered = match answering.answer(captured, subject, &trace, scene_of) {
            Ok(answered) => answered,
            Err(why) => return Found::error((&why).into()).into(),
        };
        let Answered {
            subject,
            mut found,
            scene,
            inspections,
            recipe,
        } = answered;
        let frame = Arc::new(AnsweredScene {
            scene,
            inspections,
            recipe,
        });
        let mut answered_parts = AnsweredParts {
            frame: Arc::clone(&frame),
            hung: hung.iter().map(|ids| frame.hung(ids)).collect(),
            hung_reports,
        };
        let mut reported_as = answered_parts.reported_as(self.parts);
        for (part, actual) in found.iter_mut().zip(&mut reported_as) {
            if part.verdict != VerdictCode::Accepted {
                *actual = None;
            } else if actual.is_some() {
                part.refuse(Problem::reported_wrong());
            }
        }
        self.answered_parts = Some(answered_parts);
        self.last = Some(AnsweredFrame {
            origin,
            subject,
            frame,
            reported_as,
            library: Arc::clone(&loaded.shown),
            trace,
            part,
        });
        found
    }

    fn servo(&mut self, request: &ServoRequest, client: u64, asked: &Asked) -> Found {
        let found = self.next_move(request, client, asked);
        self.status.last = Some(LastAnswer {
            at: asked.by_clock,
            answer: Answer {
                verdict: found.verdict,
                part: found.part.clone(),
                marks: found.marks,
                problem: found.problem.clone(),
                ..Answer::default()
            },
        });
        found
    }

    fn recorded(&mut self, record: InspectionRecord) {
        let answer = record.answer();
        if let Some(last) = self.status.last.as_mut().filter(|_| answer.index <= 1) {
            last.answer = answer;
        }
    }

    fn answered(&mut self) {
        if let Some(last) = self.last.take() {
            self.unkept = None;
            if let Err(fault) = guarded(|| self.keep(last)) {
                self.unkept = Some(UserError::of(&fault));
            }
        }
        self.publish();
    }

    fn turn(&mut self) -> ControlFlow<()> {
        self.status.client = self.events.try_iter().last().or(self.status.client.take());
        let inputs = self.follow();
        self.rows.update(inputs.followed.is_some());
        let parts = self.parts;
        let is_reported = |parts_of_frame: &mut AnsweredParts| {
            parts_of_frame
                .reported_as(parts)
                .iter()
                .any(Option::is_some)
        };
        if self.answered_parts.take_if(is_reported).is_some() {
            // Or LAST, PATH and PART would still give its pose.
            self.handle.refuse_last(&Problem::reported_wrong());
        }
        let loaded = self.library_cache.get();
        if loaded.shown.unloaded.is_none() {
            // Before the first trigger, so that the numbers can be looked up for the robots' programs.
            self.know(&loaded, &inputs);
        }
        self.tell_dropped();
        self.publish();
        if self.is_ending() {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    }
}

impl AnsweringSession<'_> {
    fn is_ending(&self) -> bool {
        self.context.is_cancelled() || self.is_ending.load(Ordering::Relaxed)
    }

    /// Where a robot that servoes should go next.
    fn next_move(&mut self, request: &ServoRequest, client: u64, asked: &Asked) -> Found {
        let inputs = self.follow();
        let loaded = self.library_cache.get();
        self.know(&loaded, &inputs);
        let Some(source) = inputs.followed.clone() else {
            let error = Arc::new(CaptureError::NotFollowed);
            return Found::error((&NoFrame::Failed { error }).into());
        };
        let history = self.library_cache.history();
        let asker = (request, client);
        let moves = (self.servoing).moves(asker, &inputs, &source, &loaded, history);
        let mut moves = match moves {
            Ok(moves) => moves,
            Err(problem) => return Found::error(problem),
        };
        let fitted = loaded.fitting(&inputs.recipe, &Unwatched);
        let library: &Library = &fitted.expect("not cancelled");
        let parts = ServoParts {
            finder: &self.finder,
            library,
            recipe: &inputs.recipe,
        };
        let watch = RestWatch {
            camera: &self.camera,
            library,
            at_most: FRAME_TIMEOUT,
            is_ending: &|| self.is_ending(),
        };
        let mut reported = None;
        let mut found = moves.answer(request, client, asked, parts, |prepared, asked, num| {
            let scene_of = |captured| self.scene_of(captured, &inputs);
            let mut frames = watch.looks(prepared, asked, num, scene_of)?;
            if let Some(actual) = self.reported_as(&source, &frames, &prepared.recipe) {
                let another = StopReason::AnotherPart {
                    part: prepared.task.part.clone(),
                    other: actual.name().to_owned(),
                };
                reported = Some(another.kind());
                for (_, seen) in &mut frames.looks {
                    *seen = Err(another.clone());
                }
            }
            Ok(frames)
        });
        if reported.is_some_and(|kind| found.problem.reason == kind) {
            found.problem = Problem::reported_wrong();
        }
        self.servoing.keep(moves, inputs, source, loaded, history);
        found
    }

    /// What the part in the last of these frames really is, if it was accepted and a person has reported it as wrong.
    fn reported_as(
        &self,
        source: &SourceSpec,
        frames: &RestFrames,
        recipe: &NamedRecipe,
    ) -> Option<Truth> {
        let (scene, inspection) = frames.last.as_ref()?;
        let verdict = &inspection.verdict;
        let name = verdict.guess().filter(|_| verdict.is_accepted())?;
        let frame = AnsweredScene {
            scene: Arc::clone(scene),
            inspections: vec![inspection.clone()],
            recipe: recipe.clone(),
        };
        let parts = lock(self.parts);
        let ids = parts.ids_now(&source.to_string(), true)?;
        let mut hung = frame.hung(&ids).into_iter();
        hung.find_map(|hung| parts.reported_as(&hung, name))
    }

    /// Returns the current inputs. Restarts the camera if the window follows another source, or follows its source again.
    fn follow(&mut self) -> AnswerInputs {
        let inputs = lock(self.inputs).clone();
        let before = std::mem::replace(&mut *lock(&self.followed), inputs.followed.clone());
        let is_over = || self.camera.status().state == CameraState::Over;
        if inputs.followed != before || inputs.followed.is_some() && is_over() {
            // Starting cannot fail: a missing source is a feed that has failed.
            let _ = self.camera.restart();
        }
        inputs
    }

    /// The scene to inspect of a frame.
    fn scene_of(&self, captured: capture::Captured, inputs: &AnswerInputs) -> Arc<SceneCloud> {
        let Captured { mut scene, .. } = captured.into();
        if let Some(cell) = &inputs.empty_cell {
            Arc::make_mut(&mut scene).empty_cell = Some(Arc::clone(cell));
        }
        if let Some(spec) = &inputs.followed {
            self.library_cache.camera().share_view(spec, &mut scene);
        }
        scene
    }

    /// Updates the finder with the library, the calibration and the kind of pose. If poses mean something else than before,
    /// robots learn it from the boot number; another convention starts another server.
    fn know(&mut self, loaded: &Arc<LoadedLibrary>, inputs: &AnswerInputs) {
        if self.finder.robot != *inputs.robot || self.finder.kind != inputs.pose {
            self.finder.robot.clone_from(&inputs.robot);
            self.finder.kind = inputs.pose;
            self.handle.renew();
        }
        let is_it = |known: &Arc<LoadedLibrary>| Arc::ptr_eq(known, loaded);
        if !self.library.as_ref().is_some_and(is_it) {
            self.library = Some(Arc::clone(loaded));
            let numbers = self.numbers_of(loaded);
            self.library_cache.note_numbers(&numbers);
            let shown = &loaded.shown;
            let parts = shown.parts.iter().zip(&shown.spray_paths);
            let parts = parts.map(|(part, stored)| NumberedPart {
                number: numbers.number_of(&part.name).unwrap_or(0),
                path: stored.as_ref().map(|stored| stored.path.clone()),
                off: stored.as_ref().and_then(|stored| stored.off),
                is_simulated: part.simulated,
            });
            self.finder.parts = parts.collect();
        }
    }

    /// The numbers of the parts; none if they cannot be read.
    fn numbers_of(&mut self, loaded: &LoadedLibrary) -> PartNumbers {
        let given = loaded.place.as_ref().map(LibraryPlace::give_numbers);
        let (numbers, problem) = match given.transpose() {
            Ok(None) => (PartNumbers::default(), None),
            Ok(Some(GivenNumbers { numbers, unstored })) => {
                let problem = unstored.map(|error| {
                    let what = Message::new("numbers-not-stored");
                    UserError {
                        what: sentence(&described(&what.with("reason", &*error.to_string()))),
                        advice: error.advice(),
                    }
                });
                (numbers, problem)
            }
            Err(error) => (PartNumbers::default(), Some(UserError::of(&error))),
        };
        self.unnumbered = problem;
        numbers
    }

    /// Hands an inspection to the history, as one of the part that hangs there.
    fn keep(&mut self, last: AnsweredFrame) {
        let AnsweredFrame {
            origin,
            subject,
            frame,
            reported_as,
            library,
            trace,
            part,
        } = last;
        let entry = |(inspection, actual): (&Inspection, &Option<Truth>)| {
            let subject = Subject {
                reported_as: actual.as_ref().map(|actual| actual.name().to_owned()),
                ..subject.clone()
            };
            let inspected = station::Inspected {
                subject: &subject,
                scene: &frame.scene,
                inspection,
                recipe: &frame.recipe,
                robot: Some(&self.finder.robot),
                is_forced: false,
                on_line: None,
            };
            let picture = segmentation_picture(&frame.scene, &inspection.segmentation);
            entry_of(
                &inspected,
                &origin,
                &library,
                trace.clone(),
                picture.as_ref(),
            )
        };
        let parts = frame.inspections.iter().zip(&reported_as);
        let entries = parts.map(entry).collect();
        self.rows.add(entries, frame, part);
        self.tell_dropped();
    }

    fn tell_dropped(&mut self) {
        if self.rows.take_dropped() != [0; 2] {
            self.unkept = Some(UserError {
                what: text!("history-crowded"),
                advice: text!("history-crowded-advice"),
            });
        }
    }

    /// Publishes the status if it has changed.
    fn publish(&mut self) {
        self.status.num_clients = self.handle.num_clients();
        let problems = [&self.unkept, &self.unnumbered, &self.servoing.problem];
        let problem = problems.into_iter().find_map(Option::as_ref);
        self.status.problem = problem.cloned();
        if self.sent.as_ref() != Some(&self.status) {
            self.sent = Some(self.status.clone());
            self.context.latest(self.status.clone());
        }
    }

    /// Waits until the history has written everything handed over.
    fn finish(mut self) -> AnsweringStatus {
        self.servoing.end(self.library_cache.history());
        drop(self.rows);
        self.status
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::inspection::{
        inspected::{InspectRequest, Inspected, inspect_all},
        source::SceneSource,
    };
    use geometry::rigid::RigidTransform;
    use inspection::pipeline::Recipe;
    use simulate::{RackKind, RackSetup, SensorNoise, StandingRack};
    use stages::scene::scene_from_frame;

    #[test]
    fn a_label_withdraws_only_the_part_that_it_is_of() {
        let setup = RackSetup::drawn(RackKind::Apart, 3, 0, 1).expect("in range");
        let rack = StandingRack::arrange(&setup).expect("in range");
        let frame = rack.frame(
            |_| Some(RigidTransform::identity()),
            &SensorNoise::kinect(1),
        );
        let mut recipe = Recipe::default();
        recipe.segment.max_parts = 3;
        let origin = Origin::File {
            path: "rack.png".into(),
            is_simulated: true,
        };
        let request = InspectRequest {
            source: SceneSource::AtHand(Arc::new(scene_from_frame(&frame)), origin),
            recipe: Arc::new(NamedRecipe::from(recipe)),
        };
        let seen = inspect_all(&request, &LibraryCache::default(), &Unwatched);
        let seen: Vec<Inspected> = seen.expect("inspected");
        let scene = &seen[0].scene;
        let hung: Vec<_> = seen
            .iter()
            .map(|part| (&part.inspection, part.hung()))
            .collect();
        let live = SpotIds::of_frame(scene, &hung);
        // The answer has them in another order than Live.
        let answered: Vec<&Inspected> = seen.iter().rev().collect();
        let frame = AnsweredScene {
            scene: Arc::clone(scene),
            inspections: answered
                .iter()
                .map(|part| part.inspection.clone())
                .collect(),
            recipe: (*request.recipe).clone(),
        };
        let is_accepted = |part: &&Inspected| part.inspection.verdict.is_accepted();
        let labelled = answered.iter().position(is_accepted).expect("accepted");
        assert!(answered.iter().filter(|part| is_accepted(part)).count() > 1);
        let parts = Mutex::<FollowedParts>::default();
        lock(&parts).label(answered[labelled].hung(), Some(&Truth::NotEnrolled));
        let (tell, hung_reports) = mpsc::channel();
        let mut answered_parts = AnsweredParts {
            frame: Arc::new(frame),
            hung: Vec::new(),
            hung_reports,
        };
        let mut expected = vec![None; answered.len()];
        assert_eq!(answered_parts.reported_as(&parts), expected);
        tell.send(live).expect("waited for");
        expected[labelled] = Some(Truth::NotEnrolled);
        assert_eq!(answered_parts.reported_as(&parts), expected);
    }
}
