//! What the task does: takes the newest frame, inspects it, tells how things stand.

use std::{
    collections::VecDeque,
    path::{Path, PathBuf},
    sync::{Arc, Mutex, MutexGuard, PoisonError},
    time::{Duration, Instant},
};

use crate::{
    app::{
        inspection::{
            inspected::{FinishedInspection, Inspected, LiveFrameContext},
            library_cache::LibraryCache,
            recording::Recorded,
            source::Captured as SceneOrigin,
        },
        shell::current_trace::CurrentTrace,
        task::{TaskContext, TaskError},
        user_error::UserError,
    },
    capture::{Captured, Feed, FeedItem, FeedState, FrameRate, SourceSpec},
    error::{Fault, guarded},
    history::{HungRows, NewEntry, StoredVerdict, Traceability},
    pipeline::{
        self, NamedRecipe, ProgressObserver,
        live::{FrameRole, HungFrame, LiveParams, LiveTracker, LiveVerdict, MotionState},
    },
    stages::scene::EmptyCell,
};

/// Which source to follow, and how.
#[derive(Clone, Debug)]
pub(super) struct LiveStart {
    /// The source.
    pub(super) spec: SourceSpec,
    /// All parameters.
    pub(super) recipe: Arc<NamedRecipe>,
    /// When a verdict counts.
    pub(super) params: LiveParams,
    /// What its camera saw without a part.
    pub(super) empty_cell: Option<Arc<EmptyCell>>,
    /// The folder that it is recorded in, if it is.
    pub(super) record: Option<PathBuf>,
    /// What the next part is traced by.
    pub(super) trace: CurrentTrace,
    /// The part that hangs there: it outlives this, when the same source is followed with other settings.
    pub(super) hung: Arc<Mutex<FollowedParts>>,
}

/// The parts that hang before a source one after the other.
#[derive(Debug, Default)]
pub(super) struct FollowedParts {
    source: String,
    rows: HungRows,
    /// Of the part whose verdict counted last.
    trace: Traceability,
}

impl FollowedParts {
    /// Those before this source: before another one nothing is known yet.
    fn before(&mut self, source: &SourceSpec) -> &mut HungRows {
        let source = source.to_string();
        if self.source != source {
            *self = Self {
                source,
                ..Self::default()
            };
        }
        &mut self.rows
    }
}

/// What the task hands over.
#[derive(Clone, Debug)]
pub enum LiveAnswer {
    /// How things stand.
    Stands(Box<LiveStatusUpdate>),
    /// A verdict that counts, and was not told before.
    Counts(Arc<Inspected>),
    /// A part left before its verdict counted.
    Left(Box<NewEntry>),
    /// It is not recorded any more.
    NotRecorded(UserError),
    /// Something of the source that cannot be read.
    Skipped(UserError),
    /// The source has no more frames.
    AtItsEnd,
    /// The camera rests.
    Rests,
}

/// How things stand.
#[derive(Clone, Debug)]
pub struct LiveStatusUpdate {
    /// In figures.
    pub status: LiveStatus,
    /// The last frame that everything was made of that the panels draw.
    pub inspected: Option<Arc<Inspected>>,
}

/// How things stand, in figures.
#[derive(Clone, Debug, PartialEq)]
pub struct LiveStatus {
    /// Whether frames come.
    pub source: SourceState,
    /// Whether the scene moves; `None` of a source whose captures stand for themselves.
    pub stillness: Option<MotionState>,
    /// What counts.
    pub standing: LiveVerdict,
    /// Frames a second that come, and of those the ones that were inspected.
    pub rates: [Option<f64>; 2],
    /// From a frame's arrival to its verdict, the median of the last ones.
    pub latency: Option<Duration>,
    /// Frames inspected since it began.
    pub num_inspected: u64,
    /// Frames dropped for a newer one since it began.
    pub num_dropped: u64,
    /// Frames that depth is averaged over.
    pub num_averaged: usize,
    /// What was recorded so far, while it is.
    pub recorded: Option<Recorded>,
}

/// Whether frames come.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum SourceState {
    /// It is being opened.
    Opening,
    /// They come, or are waited for.
    Running,
    /// Not now; it is looked for again by itself.
    Lost(UserError),
}

/// How long one look for a frame takes, before it is looked whether it is still wanted.
const TURN: Duration = Duration::from_millis(50);
/// Times that the latency is the median of.
const NUM_LATENCIES: usize = 15;

/// Follows a source until it ends, or something else is asked for.
pub(super) fn follow(
    request: &LiveStart,
    library_cache: &LibraryCache,
    context: &TaskContext<LiveAnswer>,
) -> Result<LiveAnswer, TaskError> {
    // It stays open behind this: whoever asks next may follow the same one.
    let feed = library_cache.camera().feed(&request.spec);
    let feed = feed.map_err(|error| UserError::of(&error))?;
    LiveSession::new(request, library_cache, context).follow(&feed)
}

/// Lets the camera rest.
pub(super) fn rest(library_cache: &LibraryCache) -> LiveAnswer {
    library_cache.recording().end();
    library_cache.camera().rest();
    LiveAnswer::Rests
}

struct LiveSession<'a> {
    library_cache: &'a LibraryCache,
    context: &'a TaskContext<LiveAnswer>,
    spec: &'a SourceSpec,
    /// Where it is recorded; not any more after a failure.
    record: Option<&'a Path>,
    recorded: Option<Recorded>,
    recipe: &'a Arc<NamedRecipe>,
    recipe_identity: String,
    trace: &'a CurrentTrace,
    hung: &'a Mutex<FollowedParts>,
    empty_cell: Option<&'a Arc<EmptyCell>>,
    /// `None` of a source whose captures stand for themselves.
    watch: Option<LiveTracker>,
    rate: FrameRate,
    latencies: VecDeque<Duration>,
    standing: LiveVerdict,
    stillness: Option<MotionState>,
    num_inspected: u64,
    /// Frames that the source had dropped before.
    dropped_before: u64,
    inspected: Option<Arc<Inspected>>,
    told: Option<LiveStatus>,
}

/// Stages are not told one by one: frames come faster than anybody reads.
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
        let watch = (!stands_for_itself).then(|| LiveTracker::new(&request.params));
        Self {
            library_cache,
            context,
            spec: &request.spec,
            record: request.record.as_deref(),
            recorded: None,
            recipe: &request.recipe,
            recipe_identity: request.recipe.identity(),
            trace: &request.trace,
            hung: &request.hung,
            empty_cell: request.empty_cell.as_ref(),
            stillness: watch.as_ref().map(LiveTracker::stillness),
            watch,
            rate: FrameRate::default(),
            latencies: VecDeque::new(),
            standing: LiveVerdict::Open,
            num_inspected: 0,
            dropped_before: 0,
            inspected: None,
            told: None,
        }
    }

    fn follow(mut self, feed: &Feed) -> Result<LiveAnswer, TaskError> {
        self.dropped_before = feed.status().num_dropped;
        loop {
            self.context.check()?;
            match feed.wait(TURN) {
                Some(FeedItem::Captured(captured)) => {
                    self.write(&captured, feed);
                    let name = captured.name.clone();
                    match guarded(|| self.take(captured)) {
                        Ok(taken) => taken?,
                        Err(fault) => self.skip(&name, &fault),
                    }
                }
                Some(FeedItem::Skipped(skipped)) => {
                    let error = UserError::of(&*skipped.error);
                    self.context.partial(LiveAnswer::Skipped(error));
                }
                None => match feed.status().state {
                    FeedState::Ended | FeedState::Stopped => {
                        let left = lock(self.hung).before(self.spec).end();
                        self.tell_left(left);
                        return Ok(LiveAnswer::AtItsEnd);
                    }
                    FeedState::Failed(error) => return Err(UserError::of(&*error).into()),
                    FeedState::Opening | FeedState::Running | FeedState::Lost { .. } => {}
                },
            }
            self.publish_status(feed);
        }
    }

    /// Records the frame before anything else is done with it, if it is to be.
    fn write(&mut self, captured: &Captured, feed: &Feed) {
        let recording = self.library_cache.recording();
        match recording.write(self.record, captured, self.spec, &feed.status()) {
            Ok(recorded) => self.recorded = recorded,
            Err(error) => {
                self.record = None;
                self.recorded = None;
                let error = UserError::of(&error);
                self.context.partial(LiveAnswer::NotRecorded(error));
            }
        }
    }

    /// Names a frame at which the program failed, and goes on to the next.
    fn skip(&mut self, name: &str, fault: &Fault) {
        self.standing = LiveVerdict::Open;
        let UserError { what, advice } = UserError::of(fault);
        let what = format!("{name}: {what}");
        let error = UserError { what, advice };
        self.context.partial(LiveAnswer::Skipped(error));
    }

    /// Inspects a frame.
    fn take(&mut self, captured: Captured) -> Result<(), TaskError> {
        let shelved = self.library_cache.get();
        let watching = SilentContext(self.context);
        let fitted = shelved.fitting(self.recipe, &watching);
        let fitted = fitted.ok_or(TaskError::Cancelled)?;
        let (arrived, at) = (captured.arrived, seconds(&captured));
        let SceneOrigin {
            mut scene,
            origin,
            warnings,
        } = captured.into();
        if let Some(cell) = self.empty_cell {
            Arc::make_mut(&mut scene).empty_cell = Some(Arc::clone(cell));
        }
        if let Some(watch) = &mut self.watch {
            scene = watch.look(scene, at);
        }
        let mut inspection = pipeline::run(&scene, &fitted, self.recipe, &watching)?;
        let mut followed = None;
        // Of a source whose captures stand for themselves each is a part of its own.
        let mut role = FrameRole::First;
        if let Some(watch) = &mut self.watch {
            let middle = FinishedInspection::middle(&inspection, &fitted);
            self.standing = watch.judge(&mut inspection, middle, &self.recipe.accept);
            self.stillness = Some(watch.stillness());
            followed = Some(LiveFrameContext {
                stillness: watch.stillness(),
                standing: self.standing.clone(),
            });
            let frame = HungFrame {
                scene: &scene,
                at,
                inspection: &inspection,
                verdict: &self.standing,
                middle,
                inputs: &format!("{} {}", self.recipe_identity, shelved.shown.identity),
            };
            let (left, of_frame) = lock(self.hung).before(self.spec).see(&frame);
            role = of_frame;
            self.tell_left(left);
        }
        self.num_inspected += 1;
        self.rate.came(Instant::now());
        self.latencies.push_front(arrived.elapsed());
        self.latencies.truncate(NUM_LATENCIES);

        if role == FrameRole::Nothing && !self.context.is_latest_read() {
            // The window has not even shown the one before.
            return Ok(());
        }
        let found = FinishedInspection {
            scan: None,
            scene,
            origin,
            warnings,
            recipe: Arc::clone(self.recipe),
            inspection,
            followed,
            source: self.spec.to_string(),
        };
        let mut inspected = found.prepared(&fitted, &shelved.shown);
        let summary = &mut inspected.entry.record.summary;
        match role {
            FrameRole::First => {
                summary.trace = self.trace.take(summary.verdict != StoredVerdict::NoPart);
                lock(self.hung).trace = summary.trace.clone();
            }
            FrameRole::Again => summary.trace = lock(self.hung).trace.clone(),
            FrameRole::Nothing | FrameRole::Best => {}
        }
        if self.watch.is_some() {
            let mut hung = lock(self.hung);
            let rows = hung.before(self.spec);
            inspected.entry.record.summary.hung = rows.id().clone();
            if role == FrameRole::Best {
                rows.hold(inspected.entry.clone());
            }
        }
        let inspected = Arc::new(inspected);
        self.inspected = Some(Arc::clone(&inspected));
        if matches!(role, FrameRole::First | FrameRole::Again) {
            self.context.partial(LiveAnswer::Counts(inspected));
        }
        Ok(())
    }

    /// Hands over the inspection of a part that left before its verdict counted.
    fn tell_left(&self, left: Option<NewEntry>) {
        if let Some(mut left) = left {
            left.record.summary.trace = self.trace.take(true);
            self.context.partial(LiveAnswer::Left(Box::new(left)));
        }
    }

    /// Says how things stand, unless nothing has changed.
    fn publish_status(&mut self, feed: &Feed) {
        let feed = feed.status();
        let source = match feed.state {
            FeedState::Opening => SourceState::Opening,
            FeedState::Lost { error, .. } => SourceState::Lost(UserError::of(&*error)),
            _ => SourceState::Running,
        };
        if matches!(source, SourceState::Lost(_)) {
            // What hangs there when it comes back was not seen to hang still.
            self.standing = LiveVerdict::Open;
        }
        let mut latencies: Vec<Duration> = self.latencies.iter().copied().collect();
        latencies.sort_unstable();
        let status = LiveStatus {
            source,
            stillness: self.stillness,
            standing: self.standing.clone(),
            rates: [feed.rate, self.rate.per_second(Instant::now())],
            latency: latencies.get(latencies.len() / 2).copied(),
            num_inspected: self.num_inspected,
            num_dropped: feed.num_dropped.saturating_sub(self.dropped_before),
            num_averaged: self.watch.as_ref().map_or(1, LiveTracker::num_averaged),
            recorded: self.recorded.clone(),
        };
        let is_news = self.told.as_ref().is_none_or(|told| {
            told.num_inspected != status.num_inspected || told.source != status.source
        });
        if is_news {
            self.told = Some(status.clone());
            let told = LiveStatusUpdate {
                status,
                inspected: self.inspected.clone(),
            };
            self.context.latest(LiveAnswer::Stands(Box::new(told)));
        }
    }
}

fn lock(hung: &Mutex<FollowedParts>) -> MutexGuard<'_, FollowedParts> {
    // After a panic at most one part is reported twice.
    hung.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The camera's time, from whenever it counts.
fn seconds(captured: &Captured) -> Duration {
    Duration::try_from(captured.taken_at.as_duration()).unwrap_or_default()
}
