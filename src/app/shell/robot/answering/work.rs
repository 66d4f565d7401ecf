//! What the task does: runs the server, and inspects a frame of the window's source for each trigger.

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

use crate::{
    app::{
        inspection::{
            library_cache::{LibraryCache, LibraryView, LoadedLibrary},
            source::{Captured, Origin},
        },
        language::text,
        shell::{current_trace::CurrentTrace, session::Session},
        task::{TaskContext, TaskError},
        user_error::UserError,
    },
    capture::{CaptureError, Feed, SourceSpec},
    error::{guarded, lock},
    history::{HungId, InspectionContext, NewEntry, Traceability, Writer},
    pipeline::{self, Inspection, NamedRecipe, ProgressObserver as _, Unwatched},
    report::{CaptureLine, InspectionLine, segmentation_picture},
    robot::RobotFrame,
    serve::{
        Answer, Asked, Camera, CameraState, ClientEvent, Found, FrameOrigin, InspectionRecord,
        Inspector, ListenAddress, Listener, NewFrame, NumberedPart, PartFinder, PoseKind,
        ServeError, Server, ServerHandle, ServerSettings, Trouble,
    },
    stages::scene::{EmptyCell, SceneCloud},
};

/// How long a trigger waits for its frame, as the command does.
const FRAME_TIMEOUT: Duration = Duration::from_secs(5);
/// Events of clients that wait to be shown; more of them at once are left out.
const MAX_EVENTS: usize = 64;
/// Inspections are handed to the history with numbers from here on, beyond those of the window's own.
const FIRST_TICKET: u64 = 1 << 63;

/// How the server stands.
#[derive(Clone, Debug, PartialEq)]
pub struct AnsweringStatus {
    /// Where it listens, with the port that the system chose.
    pub at: ListenAddress,
    /// Connections.
    pub num_clients: usize,
    /// What happened to one of them last.
    pub client: Option<ClientEvent>,
    /// The answer to the last trigger.
    pub last: Option<LastAnswer>,
    /// What went wrong behind an answer; the answer is not affected.
    pub trouble: Option<UserError>,
}

/// What a trigger was answered.
#[derive(Clone, Debug, PartialEq)]
pub struct LastAnswer {
    /// When the trigger came.
    pub at: Timestamp,
    /// The answer, when it was given.
    pub answer: Answer,
}

/// What triggers are answered by. The window replaces it while the server runs.
#[derive(Clone, Debug)]
pub(super) struct AnswerInputs {
    /// The source, while it is followed.
    followed: Option<SourceSpec>,
    recipe: Arc<NamedRecipe>,
    empty_cell: Option<Arc<EmptyCell>>,
    robot: Arc<RobotFrame>,
    pose: PoseKind,
    trace: CurrentTrace,
}

impl AnswerInputs {
    pub(super) fn of(session: &Session, robot: Arc<RobotFrame>) -> Self {
        let followed = session.is_live().then(|| session.source.followed());
        Self {
            followed: followed.flatten(),
            recipe: Arc::clone(&session.recipe),
            empty_cell: session.empty_cell.clone(),
            robot,
            pose: session.answering.pose,
            trace: session.trace.clone(),
        }
    }
}

/// What to answer, and until when.
pub(super) struct AnswerRequest {
    pub(super) listener: Listener,
    pub(super) inputs: Arc<Mutex<AnswerInputs>>,
    pub(super) is_ending: Arc<AtomicBool>,
    pub(super) library_cache: LibraryCache,
    /// Called when the history may have news.
    pub(super) on_history: Box<dyn Fn() + Send>,
}

/// Runs the server until it is told to end, or the task is cancelled. All that was answered is in the history then.
pub(super) fn answer(
    request: AnswerRequest,
    context: &TaskContext<AnsweringStatus>,
) -> Result<AnsweringStatus, TaskError> {
    let AnswerRequest {
        listener,
        inputs,
        is_ending,
        library_cache,
        on_history,
    } = request;
    let camera = {
        let (inputs, library_cache) = (Arc::clone(&inputs), library_cache.clone());
        Camera::start_with(move || {
            // The window does not wait for its camera: the lock is not held meanwhile.
            let followed = lock(&inputs).followed.clone();
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
            // With so many at once nobody reads them all.
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
        followed: None,
        finder: PartFinder {
            parts: Vec::new(),
            robot: (*now.robot).clone(),
            kind: now.pose,
        },
        library: None,
        camera,
        events,
        handle: server.handle(),
        writer,
        num_written: 0,
        last: None,
        status: AnsweringStatus {
            at: server.addresses().first().copied().unwrap_or(listener.at),
            num_clients: 0,
            client: None,
            last: None,
            trouble: None,
        },
        told: None,
    };
    server.run(&mut session);
    Ok(session.finish())
}

/// Why the server does not listen, and what to do in the window.
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

/// What the window follows, and which of its frames are new.
fn followed_feed(followed: Option<&SourceSpec>, library_cache: &LibraryCache) -> (Feed, NewFrame) {
    match followed {
        Some(spec) => (library_cache.camera().tap(spec), NewFrame::of_source(spec)),
        None => (
            Feed::failed(CaptureError::NotFollowed),
            NewFrame::SecondArrived,
        ),
    }
}

/// The inspections, on the thread that runs the server.
struct AnsweringSession<'a> {
    context: &'a TaskContext<AnsweringStatus>,
    is_ending: &'a AtomicBool,
    inputs: &'a Mutex<AnswerInputs>,
    library_cache: &'a LibraryCache,
    camera: Arc<Camera>,
    /// The source that the camera was started with.
    followed: Option<SourceSpec>,
    finder: PartFinder,
    /// The library whose parts the finder knows.
    library: Option<Arc<LoadedLibrary>>,
    events: Receiver<ClientEvent>,
    handle: ServerHandle,
    writer: Writer,
    num_written: u64,
    /// The inspection whose answer is on its way.
    last: Option<AnsweredFrame>,
    status: AnsweringStatus,
    told: Option<AnsweringStatus>,
}

/// An inspection that is to be kept.
struct AnsweredFrame {
    origin: Origin,
    source: String,
    scene: Arc<SceneCloud>,
    inspection: Inspection,
    recipe: Arc<NamedRecipe>,
    library: Arc<LibraryView>,
    trace: Traceability,
    /// The line of JSON.
    line: String,
}

impl Inspector for AnsweringSession<'_> {
    fn inspect(&mut self, asked: &Asked) -> Found {
        self.status.last = Some(LastAnswer {
            at: asked.by_clock,
            answer: Answer::default(),
        });
        let inputs = self.follow();
        let is_ending = || self.is_ending();
        let captured = match self.camera.frame_after(asked, FRAME_TIMEOUT, is_ending) {
            Ok(captured) => captured,
            Err(why) => return Found::error(Trouble::of(why.reason(), &why)),
        };
        let origin = FrameOrigin {
            captured: self.camera.captured_at(&captured),
            is_simulated: captured.is_simulated,
        };
        let source = inputs.followed.as_ref();
        let source = source.map_or_else(String::new, ToString::to_string);
        let num_dropped = self.camera.feed_status().num_dropped;
        let capture = CaptureLine::of(&source, &captured, num_dropped);
        let Captured {
            mut scene,
            origin: seen,
            ..
        } = captured.into();
        if let Some(cell) = &inputs.empty_cell {
            Arc::make_mut(&mut scene).empty_cell = Some(Arc::clone(cell));
        }
        if let Some(spec) = &inputs.followed {
            self.library_cache.camera().share_view(spec, &mut scene);
        }
        let loaded = self.library_cache.get();
        self.know(&loaded, &inputs);
        let recipe = &inputs.recipe;
        let fitted = loaded.fitting(recipe, &Unwatched);
        let fitted = fitted.expect("nobody cancels");
        let inspection =
            pipeline::run(&scene, &fitted, recipe, &Unwatched).expect("nobody cancels");
        let mut found = self.finder.found(&inspection, recipe, origin);
        let trace = inputs.trace.remembered();
        let line = InspectionLine::of(&seen.title(), &inspection)
            .by(recipe)
            .traced(&trace)
            .captured(Some(capture))
            .in_robot(Some(&self.finder.robot), &inspection)
            .to_json();
        found.report.clone_from(&line);
        self.last = Some(AnsweredFrame {
            origin: seen,
            source,
            scene,
            inspection,
            recipe: Arc::clone(recipe),
            library: Arc::clone(&loaded.shown),
            trace,
            line,
        });
        found
    }

    fn recorded(&mut self, record: InspectionRecord) {
        if let Some(last) = &mut self.status.last {
            last.answer = record.answer();
        }
    }

    fn answered(&mut self) {
        if let Some(last) = self.last.take()
            && let Err(fault) = guarded(|| self.keep(&last))
        {
            self.status.trouble = Some(UserError::of(&fault));
        }
        self.publish();
    }

    fn turn(&mut self) -> ControlFlow<()> {
        self.status.client = self.events.try_iter().last().or(self.status.client.take());
        self.follow();
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

    /// What holds now. The camera is started anew where the window follows another source, or its source again.
    fn follow(&mut self) -> AnswerInputs {
        let inputs = lock(self.inputs).clone();
        let is_over = || self.camera.status().state == CameraState::Over;
        if inputs.followed != self.followed || inputs.followed.is_some() && is_over() {
            self.followed.clone_from(&inputs.followed);
            // It never fails to start: a source without frames is a feed that has failed.
            let _ = self.camera.restart();
        }
        inputs
    }

    /// Has the finder know this library, and where the camera stands.
    fn know(&mut self, loaded: &Arc<LoadedLibrary>, inputs: &AnswerInputs) {
        self.finder.robot.clone_from(&inputs.robot);
        self.finder.kind = inputs.pose;
        let is_it = |known: &Arc<LoadedLibrary>| Arc::ptr_eq(known, loaded);
        if !self.library.as_ref().is_some_and(is_it) {
            self.library = Some(Arc::clone(loaded));
            let shown = &loaded.shown;
            let parts = (1..).zip(shown.parts.iter().zip(&shown.spray_paths));
            let parts = parts.map(|(number, (part, path))| NumberedPart {
                number,
                path: path.clone(),
                is_simulated: part.simulated,
            });
            self.finder.parts = parts.collect();
        }
    }

    /// Hands an inspection to the history, as one of its own: nobody but who asks knows whether it is the same part again.
    fn keep(&mut self, last: &AnsweredFrame) {
        let AnsweredFrame {
            origin,
            source,
            scene,
            inspection,
            recipe,
            library,
            trace,
            line,
        } = last;
        let picture = segmentation_picture(scene, &inspection.segmentation);
        let about = InspectionContext {
            at: Timestamp::now(),
            scene: origin.title(),
            source: source.clone(),
            is_simulated: origin.is_simulated(),
            title_of: &|name| library.title_of(name).to_owned(),
            line: line.clone(),
            library: library.identity.clone(),
            // What has no JSON form cannot be had again either.
            origin: serde_json::to_string(origin).ok(),
            picture: picture.as_ref(),
            hung: HungId::new(),
        };
        let mut entry = NewEntry::of(about, scene, inspection, recipe);
        entry.record.summary.trace = trace.clone();
        self.writer.add(FIRST_TICKET + self.num_written, entry);
        self.num_written += 1;
        if self.writer.take_dropped() != [0; 2] {
            self.status.trouble = Some(UserError {
                what: text!("history-crowded"),
                advice: text!("history-crowded-advice"),
            });
        }
    }

    /// Tells the window how the server stands, unless nothing has changed.
    fn publish(&mut self) {
        self.status.num_clients = self.handle.num_clients();
        if self.told.as_ref() != Some(&self.status) {
            self.told = Some(self.status.clone());
            self.context.latest(self.status.clone());
        }
    }

    /// Waits until all is written.
    fn finish(self) -> AnsweringStatus {
        self.writer.finish();
        self.status
    }
}
