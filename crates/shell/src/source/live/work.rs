//! The task of Live: takes the newest frame, inspects it and publishes the status; and what is kept of the followed source.

use std::{
    collections::VecDeque,
    path::{Path, PathBuf},
    sync::{
        Arc, Mutex,
        mpsc::{Receiver, SyncSender, sync_channel},
    },
    time::{Duration, Instant},
};

use crate::{
    inspection::{
        camera::Recorded,
        inspected::{FinishedInspection, InspectRequest, Inspected, LiveFrameContext, inspect_all},
        library_cache::LibraryCache,
        source::{Captured as SceneOrigin, Origin, SceneSource},
    },
    notice::Notice,
    source::live::parts::{FollowedParts, assign_as_before},
    trace::current_trace::CurrentTrace,
};
use capture::{Captured, Feed, FeedItem, FeedState, FrameRate, SimulatedSpec, SourceSpec};
use geometry::error::{Fault, guarded, lock};
use inspection::{
    library::Library,
    pipeline::{
        self, Inspection, NamedRecipe, ProgressObserver, Verdict,
        live::{
            FrameRole, InspectionRate, LiveParams, LiveTracker, LiveVerdict, MAX_AVERAGED,
            MotionState,
        },
    },
};
use records::history::{NewEntry, Traceability};
use stages::scene::EmptyCell;
use station::{MotionWatch, SeenFrame, SeenPart};
use ui::{
    task::{Task, TaskContext, TaskError, TaskRunner},
    user_error::UserError,
};

/// Which source to follow, and how.
#[derive(Clone, Debug)]
pub(super) struct LiveStart {
    /// The source to follow.
    pub(super) spec: SourceSpec,
    /// All parameters of the inspection.
    pub(super) recipe: Arc<NamedRecipe>,
    /// When a verdict counts.
    pub(super) params: LiveParams,
    /// The empty cell of the source, if known.
    pub(super) empty_cell: Option<Arc<EmptyCell>>,
    /// The folder to record into, if any.
    pub(super) record: Option<PathBuf>,
    /// Traceability of the next part.
    pub(super) trace: CurrentTrace,
    /// The parts that hang there: they outlive this, when the same source is followed with other settings.
    pub(super) parts: Arc<Mutex<FollowedParts>>,
    /// Where the inspections to be recorded go.
    pub(super) recorder: SyncSender<LiveRecord>,
    /// Number of the run, for [`LiveRecord`].
    pub(super) run: u64,
    /// The parts of the newest capture, if it is to be inspected again before the next ones.
    pub(super) again: Vec<Arc<Inspected>>,
}

impl LiveStart {
    /// Records parts that left before their verdicts counted.
    fn record_left(&self, left: Vec<Arc<Inspected>>) {
        record_left(left, &self.recorder, || self.trace.take(true));
    }
}

/// An inspection to be recorded, or a frame without one, in the order of the frames. It has a channel of its own, so that it is
/// recorded even if its job was replaced meanwhile.
#[derive(Debug)]
pub(super) enum LiveRecord {
    /// Verdicts that count and were not reported before.
    Counts {
        /// The inspections that they stand on.
        counted: Vec<Arc<Inspected>>,
        /// All parts of their frame.
        parts: Vec<Arc<Inspected>>,
        /// The run that it belongs to.
        run: u64,
    },
    /// A part left before its verdict counted, or following stopped before.
    Left(Box<NewEntry>),
    /// A frame of the source could not be read or inspected.
    Skipped {
        /// Name of the frame, or of its file.
        name: String,
        /// Why, and what to do.
        error: UserError,
        /// True if the program failed at it, although it could be read.
        is_fault: bool,
        /// The run that it belongs to.
        run: u64,
    },
}

/// Maximum number of unread records, whose points and pictures take up to 15 MB each; the job waits beyond that.
const MAX_UNREAD: usize = 32;

fn send(recorder: &SyncSender<LiveRecord>, record: LiveRecord) {
    // Fails only if the window is gone.
    let _ = recorder.send(record);
}

/// Records parts whose verdicts did not count, each with the next traceability.
fn record_left(
    left: Vec<Arc<Inspected>>,
    recorder: &SyncSender<LiveRecord>,
    trace: impl Fn() -> Traceability,
) {
    for left in left {
        let entry = left.entry_of(trace());
        send(recorder, LiveRecord::Left(Box::new(entry)));
    }
}

/// A result of the task.
#[derive(Clone, Debug)]
pub enum LiveAnswer {
    /// The latest status.
    Stands(Box<LiveStatusUpdate>),
    /// The recording has failed and ended.
    NotRecorded(UserError),
    /// The source has no more frames.
    AtItsEnd,
    /// The camera is closed.
    Rests,
}

/// The status, with the inspections to show.
#[derive(Clone, Debug)]
pub struct LiveStatusUpdate {
    /// Status in figures.
    pub status: LiveStatus,
    /// The parts of the last frame that was prepared for the panels; none if there is no such frame since the source was lost.
    pub parts: Vec<Arc<Inspected>>,
}

/// Status of following a source, in figures.
#[derive(Clone, Debug, PartialEq)]
pub struct LiveStatus {
    /// Whether frames arrive.
    pub source: SourceState,
    /// Whether the scene moves; `None` for a source whose captures are independent.
    pub stillness: Option<MotionState>,
    /// The verdict so far, of the first part.
    pub standing: LiveVerdict,
    /// Frames per second that arrive, and that are inspected.
    pub rates: [Option<f64>; 2],
    /// Median time from a frame's arrival to its verdict, over the last frames.
    pub latency: Option<Duration>,
    /// How many of the camera's frames are inspected, once two were.
    pub inspection_rate: Option<InspectionRate>,
    /// The rate, if a verdict has waited two seconds or longer because fewer than half of the camera's frames are inspected.
    pub held_up_by: Option<InspectionRate>,
    /// Frames inspected since the start.
    pub num_inspected: u64,
    /// Frames dropped for a newer one since the start.
    pub num_dropped: u64,
    /// Number of frames that depth is averaged over.
    pub num_averaged: usize,
    /// What has been recorded so far, while recording.
    pub recorded: Option<Recorded>,
}

/// Whether frames arrive.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum SourceState {
    /// The source is being opened.
    Opening,
    /// Frames arrive or are awaited.
    Running,
    /// The source is lost; opening it again is tried automatically.
    Lost(UserError),
}

/// Time to wait for a frame before checking for cancellation again.
const POLL_INTERVAL: Duration = Duration::from_millis(50);
/// Number of latencies that the median is taken of.
const NUM_LATENCIES: usize = 15;

/// Follows a source until it ends or the task is cancelled.
pub(super) fn follow(
    request: &LiveStart,
    library_cache: &LibraryCache,
    context: &TaskContext<LiveAnswer>,
) -> Result<LiveAnswer, TaskError> {
    let left = lock(&request.parts).begin(&request.spec);
    request.record_left(left);
    // The camera stays open afterwards: the next job may follow the same source.
    let feed = library_cache.camera().feed(&request.spec);
    let followed = feed
        .map_err(|error| TaskError::from(UserError::of(&error)))
        .and_then(|feed| LiveSession::new(request, library_cache, context).follow(&feed));
    let left = match &followed {
        Ok(_) => lock(&request.parts).end(),
        // The part may still hang there when the source is followed again.
        Err(TaskError::Failed(_)) => lock(&request.parts).spots.take_best(),
        // The next job goes on with the part.
        Err(TaskError::Cancelled) => Vec::new(),
    };
    request.record_left(left);
    followed
}

/// Ends the recording and closes the camera. Parts that hang there without a verdict that counts are recorded with this
/// traceability.
pub(super) fn rest(
    library_cache: &LibraryCache,
    parts: &Mutex<FollowedParts>,
    recorder: &SyncSender<LiveRecord>,
    trace: impl Fn() -> Traceability,
) -> LiveAnswer {
    let left = lock(parts).spots.take_best();
    record_left(left, recorder, trace);
    library_cache.recording().end();
    library_cache.camera().rest();
    LiveAnswer::Rests
}

struct LiveSession<'a> {
    library_cache: &'a LibraryCache,
    context: &'a TaskContext<LiveAnswer>,
    request: &'a LiveStart,
    /// The folder to record into; `None` after a failure.
    record: Option<&'a Path>,
    recorded: Option<Recorded>,
    recipe_identity: String,
    /// `None` for a source whose captures are independent.
    tracker: Option<LiveTracker>,
    /// Sees the frames that are dropped while others are inspected.
    motion_watch: Option<MotionWatch>,
    rate: FrameRate,
    latencies: VecDeque<Duration>,
    standing: LiveVerdict,
    stillness: Option<MotionState>,
    num_inspected: u64,
    /// Frames that the source had dropped before the start.
    dropped_before: u64,
    /// The parts of the last frame to be shown.
    parts: Vec<Arc<Inspected>>,
    sent: Option<LiveStatus>,
}

/// Passes cancellation on but no stages: frames come too fast to read them.
struct SilentContext<'a>(&'a TaskContext<LiveAnswer>);

impl ProgressObserver for SilentContext<'_> {
    fn is_cancelled(&self) -> bool {
        self.0.is_cancelled()
    }
}

impl<'a> LiveSession<'a> {
    fn new(
        request: &'a LiveStart,
        library_cache: &'a LibraryCache,
        context: &'a TaskContext<LiveAnswer>,
    ) -> Self {
        let stands_for_itself = matches!(request.spec, SourceSpec::Watched(_));
        let tracker = (!stands_for_itself).then(|| LiveTracker::new(&request.params));
        Self {
            library_cache,
            context,
            request,
            record: request.record.as_deref(),
            recorded: None,
            recipe_identity: request.recipe.identity(),
            stillness: tracker.as_ref().map(LiveTracker::stillness),
            tracker,
            motion_watch: None,
            rate: FrameRate::default(),
            latencies: VecDeque::new(),
            standing: LiveVerdict::Open,
            num_inspected: 0,
            dropped_before: 0,
            parts: Vec::new(),
            sent: None,
        }
    }

    fn follow(mut self, feed: &Feed) -> Result<LiveAnswer, TaskError> {
        self.dropped_before = feed.status().num_dropped;
        let motion_watch = MotionWatch::of_source(&self.request.spec, feed);
        self.motion_watch = motion_watch.map_err(|error| TaskError::from(UserError::of(&error)))?;
        if let Some(first) = self.request.again.first() {
            match guarded(|| self.inspect_again(first)) {
                Ok(inspected) => inspected?,
                Err(fault) => self.fails_at(first.origin.title(), &fault),
            }
            self.publish_status(feed);
        }
        loop {
            self.context.check()?;
            match feed.wait(POLL_INTERVAL) {
                Some(FeedItem::Captured(captured)) => {
                    self.write(&captured, feed);
                    let name = captured.name.clone();
                    let num_dropped = feed.status().num_dropped;
                    match guarded(|| self.take(captured, num_dropped)) {
                        Ok(taken) => taken?,
                        Err(fault) => self.fails_at(name, &fault),
                    }
                }
                Some(FeedItem::Skipped(skipped)) => {
                    let error = UserError::of(&*skipped.error);
                    self.skip(skipped.name, error, false);
                }
                None => match feed.status().state {
                    FeedState::Ended | FeedState::Stopped => return Ok(LiveAnswer::AtItsEnd),
                    FeedState::Failed(error) => return Err(UserError::of(&*error).into()),
                    FeedState::Opening | FeedState::Running | FeedState::Lost { .. } => {}
                },
            }
            self.publish_status(feed);
        }
    }

    /// Records the frame, if recording, before anything else is done with it.
    fn write(&mut self, captured: &Captured, feed: &Feed) {
        let recording = self.library_cache.recording();
        match recording.write(self.record, captured, &self.request.spec, &feed.status()) {
            Ok(recorded) => self.recorded = recorded,
            Err(error) => {
                self.record = None;
                self.recorded = None;
                let error = UserError::of(&error);
                self.context.partial(LiveAnswer::NotRecorded(error));
            }
        }
    }

    /// Reports a frame at which the program failed; the next one is inspected as usual.
    fn fails_at(&mut self, name: String, fault: &Fault) {
        self.standing = LiveVerdict::Open;
        let UserError { what, advice } = UserError::of(fault);
        let what = format!("{name}: {what}");
        self.skip(name, UserError { what, advice }, true);
    }

    fn skip(&mut self, name: String, error: UserError, is_fault: bool) {
        let record = LiveRecord::Skipped {
            name,
            error,
            is_fault,
            run: self.request.run,
        };
        send(&self.request.recorder, record);
        // The next status is published, which wakes the window.
        self.sent = None;
    }

    /// Inspects a capture again, as another inspection of its parts.
    fn inspect_again(&mut self, before: &Inspected) -> Result<(), TaskError> {
        let mut scene = Arc::clone(&before.scene);
        let cell = &self.request.empty_cell;
        if scene.empty_cell.as_ref().map(Arc::as_ptr) != cell.as_ref().map(Arc::as_ptr) {
            Arc::make_mut(&mut scene).empty_cell.clone_from(cell);
        }
        let request = InspectRequest {
            source: SceneSource::AtHand(scene, before.origin.clone()),
            recipe: Arc::clone(&self.request.recipe),
        };
        let silent = SilentContext(self.context);
        let mut parts = inspect_all(&request, self.library_cache, &silent)?;
        for part in &mut parts {
            part.set_captured_at(before.captured_at);
            part.entry.record.summary.source = self.request.spec.to_string();
        }
        assign_as_before(&mut parts, self.request.again.clone());
        self.num_inspected += 1;
        let parts: Vec<Arc<Inspected>> = parts.into_iter().map(Arc::new).collect();
        self.show(parts.clone(), parts);
        Ok(())
    }

    /// Inspects a frame.
    fn take(&mut self, captured: Captured, num_dropped: u64) -> Result<(), TaskError> {
        let loaded = self.library_cache.get();
        let silent = SilentContext(self.context);
        let recipe = &self.request.recipe;
        let fitted = loaded.fitting(recipe, &silent);
        let fitted = fitted.ok_or(TaskError::Cancelled)?;
        let (arrived, at, number) = (captured.arrived, seconds(&captured), captured.number);
        let taken_at = captured.taken_at;
        let origin = Origin::of_capture(&captured, &self.request.spec, num_dropped);
        let SceneOrigin {
            mut scene,
            warnings,
            ..
        } = captured.into();
        if let Some(cell) = &self.request.empty_cell {
            Arc::make_mut(&mut scene).empty_cell = Some(Arc::clone(cell));
        }
        let is_ending = || self.context.is_cancelled();
        let motion_watch = self.motion_watch.as_ref();
        let motion = motion_watch.map(|watch| watch.motion_of(taken_at, arrived, is_ending));
        if let Some(tracker) = &mut self.tracker {
            scene = tracker.look(scene, at, motion);
        }
        let found = pipeline::run_all(&scene, &fitted, recipe, &silent)?;
        let inputs = format!("{} {}", self.recipe_identity, loaded.shown.identity);
        let frame = SeenFrame {
            scene: &scene,
            at,
            number,
            inputs: &inputs,
        };
        let parts = self.judged(found, &frame, &fitted);
        let is_news = parts.iter().any(|part| part.role != FrameRole::Nothing);
        self.num_inspected += 1;
        self.rate.came(Instant::now());
        self.latencies.push_front(arrived.elapsed());
        self.latencies.truncate(NUM_LATENCIES);

        if !is_news && !self.context.is_latest_read() {
            // The window has not even shown the previous one.
            self.seen(arrived);
            return Ok(());
        }
        let mut shown = Vec::with_capacity(parts.len());
        for part in &parts {
            let found = FinishedInspection {
                scan: None,
                scene: Arc::clone(&scene),
                origin: origin.clone(),
                warnings: warnings.clone(),
                recipe: Arc::clone(recipe),
                inspection: part.inspection.clone(),
                followed: self.tracker.as_ref().map(|tracker| LiveFrameContext {
                    stillness: tracker.stillness(),
                    standing: part.verdict.clone(),
                }),
                source: self.request.spec.to_string(),
                robot: self.library_cache.robot(),
            };
            shown.push(found.prepared(&fitted, &loaded.shown));
        }
        // Not before: after a panic on the way here, the next frame shall be recorded in place of this one.
        for part in parts.iter().filter(|part| part.role != FrameRole::Nothing) {
            self.see(part, &frame);
        }
        self.seen(arrived);
        self.keep(shown, &parts, arrived);
        Ok(())
    }

    /// Judges the parts of a frame. What has no role is taken in at once.
    fn judged(
        &mut self,
        found: Vec<Inspection>,
        frame: &SeenFrame<'_>,
        library: &Library,
    ) -> Vec<SeenPart> {
        let recipe = &self.request.recipe;
        let middle = |part: &Inspection| part.middle(library);
        let Some(tracker) = &mut self.tracker else {
            // Captures are independent, and what each shows are hung parts of their own.
            let alone = |inspection| SeenPart {
                role: FrameRole::First,
                ..SeenPart::alone(inspection, None)
            };
            return found.into_iter().map(alone).collect();
        };
        let mut followed = lock(&self.request.parts);
        let (parts, absent) = frame.judge(found, tracker, &mut followed.spots, recipe, middle);
        drop(followed);
        self.standing = parts
            .first()
            .map_or(LiveVerdict::Open, |part| part.verdict.clone());
        self.stillness = Some(tracker.stillness());
        for part in parts.iter().chain(&absent) {
            if part.role == FrameRole::Nothing {
                self.see(part, frame);
            }
        }
        parts
    }

    /// Takes in a part of a frame, and records the part that left before it.
    fn see(&self, part: &SeenPart, frame: &SeenFrame<'_>) {
        let Some(spot) = part.spot else { return };
        let (left, _) = lock(&self.request.parts).spots.see(spot, &frame.of(part));
        // Recording may wait for the window.
        self.request.record_left(left.into_iter().collect());
    }

    /// Every part of a frame is taken in.
    fn seen(&self, arrived: Instant) {
        if self.tracker.is_some() {
            lock(&self.request.parts).seen(arrived);
        }
    }

    /// Keeps the inspections of a frame to be shown, and records those that are the first or further ones of their parts.
    fn keep(&mut self, mut shown: Vec<Inspected>, parts: &[SeenPart], arrived: Instant) {
        let mut followed = lock(&self.request.parts);
        let mut of_capture = None;
        for (inspected, part) in shown.iter_mut().zip(parts) {
            // What a trigger found out about the part before lies below.
            inspected.entry.stands_for_part =
                matches!(part.role, FrameRole::First | FrameRole::Best);
            let hung = match part.spot {
                Some(spot) => followed.spots.at(spot).id().clone(),
                None => inspected.hung().clone(),
            };
            let trace = match (part.role, part.spot) {
                (FrameRole::First, Some(_)) => Some(self.request.trace.take(shows_part(part))),
                (FrameRole::First, None) => {
                    let shows_any = parts.iter().any(shows_part);
                    let take = || self.request.trace.take(shows_any);
                    Some(of_capture.get_or_insert_with(take).clone())
                }
                (FrameRole::Again, _) => followed.trace_of(&hung).cloned(),
                (FrameRole::Nothing, Some(spot)) => followed.trace_of_hanging(spot).cloned(),
                (FrameRole::Nothing, None) | (FrameRole::Best, _) => None,
            };
            if let (FrameRole::First, Some(trace)) = (part.role, &trace) {
                followed.counts(hung.clone(), trace.clone());
            }
            inspected.set_part(hung, trace.unwrap_or_default());
        }
        let shown: Vec<Arc<Inspected>> = shown.into_iter().map(Arc::new).collect();
        if self.tracker.is_none() {
            followed.seen_alone(arrived, &shown);
        }
        let mut counted = Vec::new();
        for (inspected, part) in shown.iter().zip(parts) {
            match (part.role, part.spot) {
                (FrameRole::First | FrameRole::Again, _) => counted.push(Arc::clone(inspected)),
                (FrameRole::Best, Some(spot)) => {
                    followed.spots.at(spot).hold(Arc::clone(inspected));
                }
                (FrameRole::Best, None) | (FrameRole::Nothing, _) => {}
            }
        }
        drop(followed);
        self.show(shown, counted);
    }

    /// Keeps the parts of a frame to be shown, and records those that count.
    fn show(&mut self, parts: Vec<Arc<Inspected>>, counted: Vec<Arc<Inspected>>) {
        self.parts.clone_from(&parts);
        if !counted.is_empty() {
            let run = self.request.run;
            let record = LiveRecord::Counts {
                counted,
                parts,
                run,
            };
            send(&self.request.recorder, record);
        }
    }

    /// Publishes the status if another frame was inspected or the state of the source has changed.
    fn publish_status(&mut self, feed: &Feed) {
        let feed = feed.status();
        let source = match feed.state {
            FeedState::Opening => SourceState::Opening,
            FeedState::Lost { error, .. } => SourceState::Lost(UserError::of(&*error)),
            _ => SourceState::Running,
        };
        if matches!(source, SourceState::Lost(_)) {
            // After the source returns, a part must be seen hanging still again, and a folder needs a new capture.
            self.standing = LiveVerdict::Open;
            self.parts.clear();
        }
        let mut latencies: Vec<Duration> = self.latencies.iter().copied().collect();
        latencies.sort_unstable();
        let status = LiveStatus {
            source,
            stillness: self.stillness,
            standing: self.standing.clone(),
            rates: [feed.rate, self.rate.per_second(Instant::now())],
            latency: latencies.get(latencies.len() / 2).copied(),
            inspection_rate: (self.tracker.as_ref()).and_then(LiveTracker::inspection_rate),
            held_up_by: self.tracker.as_ref().and_then(LiveTracker::held_up_by),
            num_inspected: self.num_inspected,
            num_dropped: feed.num_dropped.saturating_sub(self.dropped_before),
            num_averaged: self.tracker.as_ref().map_or(1, LiveTracker::num_averaged),
            recorded: self.recorded.clone(),
        };
        let is_news = self.sent.as_ref().is_none_or(|sent| {
            sent.num_inspected != status.num_inspected || sent.source != status.source
        });
        if is_news {
            self.sent = Some(status.clone());
            let update = LiveStatusUpdate {
                status,
                parts: self.parts.clone(),
            };
            self.context.latest(LiveAnswer::Stands(Box::new(update)));
        }
    }
}

fn shows_part(part: &SeenPart) -> bool {
    matches!(part.inspection.verdict, Verdict::Part { .. })
}

/// Time of the camera's clock, from an arbitrary origin.
fn seconds(captured: &Captured) -> Duration {
    Duration::try_from(captured.taken_at.as_duration()).unwrap_or_default()
}

/// State of the followed source.
#[derive(Debug, Default)]
pub struct LiveState {
    /// True while a source is followed; otherwise frames are captured one by one on demand.
    pub is_on: bool,
    /// The latest status, once there is one.
    pub status: Option<LiveStatus>,
    /// When a verdict counts, and over how many frames depth is averaged.
    pub params: LiveParams,
    /// The folder that the source is being recorded into, if it is.
    pub recording: Option<PathBuf>,
    /// Settings of the simulated cell while its dialog is open.
    pub setup: Option<SimulatedSpec>,
    /// The parts that hang before it.
    pub(crate) parts: Arc<Mutex<FollowedParts>>,
    /// The parts of the latest frame, if another workspace was in front and nothing newer has been shown since.
    pub unseen: Vec<Arc<Inspected>>,
}

/// Actions on the followed source.
#[derive(Clone, Debug)]
pub enum LiveAction {
    /// Start or stop following the source.
    Toggle,
    /// Use this source from now on.
    Use(SourceSpec),
    /// Average depth over this many frames.
    Average(usize),
    /// Record the source into a new folder inside this one.
    Record(PathBuf),
    /// Ask where to record, or stop recording.
    ToggleRecording,
    /// Open the dialog that sets up the simulated cell with these settings, or close it.
    SetUp(Option<SimulatedSpec>),
}

impl LiveState {
    /// Starts without following anything; depth will be averaged over `num_frames` frames.
    pub fn averaging(num_frames: usize) -> Self {
        let mut own = Self::default();
        own.params.average = num_frames.clamp(1, MAX_AVERAGED);
        own
    }
}

/// Follows the source.
#[derive(Debug)]
pub struct Follower {
    /// The inspections to be recorded, of every job. Dropped before the task, whose job may wait until they are read.
    pub(super) records: Receiver<LiveRecord>,
    pub(super) recorder: SyncSender<LiveRecord>,
    pub(super) task: Task<LiveAnswer>,
    pub(super) library_cache: LibraryCache,
    /// Incremented when following starts with another view; within one session the 3-D view keeps its camera.
    pub(super) session: u64,
    /// Incremented when following starts over: what came before is only recorded.
    pub(super) run: u64,
    /// The notice shown while the source is lost.
    pub(super) lost: Option<Notice>,
    /// The parts of the newest capture of a watched folder, to be inspected again.
    pub(super) again: Vec<Arc<Inspected>>,
}

impl Follower {
    /// Starts without following anything.
    pub fn new(runner: &TaskRunner, library_cache: &LibraryCache) -> Self {
        let (recorder, records) = sync_channel(MAX_UNREAD);
        Self {
            records,
            recorder,
            task: Task::new("live", runner),
            library_cache: library_cache.clone(),
            session: 0,
            run: 0,
            lost: None,
            again: Vec::new(),
        }
    }

    /// True while nothing is followed and the camera is closed.
    pub fn is_idle(&self) -> bool {
        self.task.running().is_none()
    }
}
