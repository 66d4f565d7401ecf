//! A source for triggers: captures a frame after each, and reports the camera's state in between.
//!
//! The source runs all the time, so that no trigger waits for it to open; frames that nobody requested are dropped. A frame
//! that arrives just after a trigger may have been exposed before it. From a camera, the second frame to arrive is
//! therefore used: it was exposed after the first one. This costs one more frame, 33 ms with a Kinect. From a watched
//! folder, a file is used that was first seen after the trigger and, by its time of modification, written after it.
//!
//! An accepted part is then looked for again in a later frame, unless the scene has moved already (`motion.rs`): one that
//! moves is refused.

use std::{
    sync::{Arc, Mutex},
    time::{Duration, Instant},
};

use jiff::SignedDuration;
use nalgebra::Point3;
use thiserror::Error;

use super::motion::{MotionWatch, since_epoch, time_of};
use capture::{
    BackpressurePolicy, CaptureError, Captured, Feed, FeedItem, FeedState, FeedStatus,
    SkippedCapture, SourceSpec,
};
use geometry::{
    clock,
    error::{Advice, lock},
};
use inspection::pipeline::{
    ExpectedError, Inspection,
    live::{MotionState, SteadyParams, refuse_moving, refuse_unless_again},
};
use records::orders::{OrderError, OrdersError};
use serve::{Asked, CameraState, CameraStatus, Problem, Unanswered};

/// Least time between the two frames that must agree, if the scene was still until the first one. More would show slower
/// motion and let robots wait longer.
const MIN_FRAME_INTERVAL: Duration = Duration::from_millis(150);

/// How often a waiting trigger checks whether the service is ending.
const POLL_INTERVAL: Duration = Duration::from_millis(100);

/// Least difference between two clocks that counts: clocks that are set from one time server differ by less. It must be
/// short, because a file from before a trigger may pass for a new one if its clock is fast by this much.
const CLOCK_TOLERANCE: Duration = Duration::from_millis(50);

/// A source that keeps running while nobody requests frames.
pub struct Camera {
    start: Box<dyn Fn() -> Result<Opened, CaptureError> + Send + Sync>,
    opened: Mutex<Opened>,
}

/// A running source and the rule for its new frames.
#[derive(Clone)]
struct Opened {
    feed: Arc<Feed>,
    rule: NewFrame,
    /// `None` for a source that does not show motion.
    motion: Option<Arc<MotionWatch>>,
}

/// How a frame is known to have been captured after a trigger.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NewFrame {
    /// It is the second frame to arrive after the trigger.
    SecondArrived,
    /// It is the second frame to be replayed after the trigger. It was captured earlier, so its answer is marked.
    SecondReplayed,
    /// The same, of a folder of independent captures, which do not show whether a part moves.
    SecondOfMany,
    /// Its file was first seen after the trigger, and was written after it by the wall clock.
    WrittenAfter,
}

impl NewFrame {
    /// The rule for a source.
    pub fn of_source(spec: &SourceSpec) -> Self {
        match spec {
            SourceSpec::Watched(_) => Self::WrittenAfter,
            _ if !spec.is_followed() => Self::SecondOfMany,
            _ if spec.is_replayed() => Self::SecondReplayed,
            _ => Self::SecondArrived,
        }
    }

    /// True if successive frames show whether the part moves. One file written for each trigger does not.
    pub(super) fn shows_motion(self) -> bool {
        matches!(self, Self::SecondArrived | Self::SecondReplayed)
    }

    /// The time of capture, from which the frame's age is computed; of a replayed frame, when it was replayed.
    pub fn captured_at(self, captured: &Captured) -> Instant {
        match self {
            Self::SecondArrived | Self::SecondReplayed | Self::SecondOfMany => captured.arrived,
            // Never later than it was first seen, even if the file's clock is fast.
            Self::WrittenAfter => {
                let age = clock::now().duration_since(captured.taken_at);
                let age = Duration::try_from(age).unwrap_or_default();
                let written = Instant::now().checked_sub(age);
                written.map_or(captured.arrived, |at| at.min(captured.arrived))
            }
        }
    }

    /// When a trigger came, by the clock of the frames: this computer's or, of a replayed frame, that of the recording.
    fn asked_at(self, asked: &Asked, captured: &Captured) -> Duration {
        match self {
            Self::SecondArrived | Self::WrittenAfter => since_epoch(asked.by_clock),
            Self::SecondReplayed | Self::SecondOfMany => {
                let before = captured.arrived.saturating_duration_since(asked.at);
                time_of(captured).saturating_sub(before)
            }
        }
    }

    /// Whether a frame was captured after the trigger; it is the `num_arrived`-th to arrive since.
    fn is_new(self, captured: &Captured, asked: &Asked, num_arrived: usize) -> bool {
        match self {
            Self::SecondArrived | Self::SecondReplayed | Self::SecondOfMany => num_arrived >= 2,
            Self::WrittenAfter => captured.arrived > asked.at && is_dated_after(captured, asked),
        }
    }

    /// Returns by how much at least the clock of a file is ahead of this computer's, if the file is dated after the
    /// trigger and later than it was first seen.
    fn clock_ahead(self, captured: &Captured, asked: &Asked) -> Option<Duration> {
        if self != Self::WrittenAfter || !is_dated_after(captured, asked) {
            return None;
        }
        let age = clock::now().duration_since(captured.taken_at);
        let here = captured.arrived.elapsed();
        let here = SignedDuration::try_from(here).unwrap_or(SignedDuration::MAX);
        let ahead = Duration::try_from(here.saturating_sub(age)).ok();
        ahead.filter(|ahead| *ahead > CLOCK_TOLERANCE)
    }
}

/// True if a file was written after the trigger, by the clock of its disk; beyond the last time, nobody can tell.
fn is_dated_after(captured: &Captured, asked: &Asked) -> bool {
    captured.taken_at >= asked.by_clock && asked.by_clock < clock::LAST
}

/// Why a trigger got no frame.
#[derive(Clone, Debug, Error, Advice)]
pub enum NoFrame {
    /// The camera is lost; reconnecting is automatic.
    #[error("{error}")]
    #[advice(transparent)]
    Lost {
        /// The underlying error.
        error: Arc<CaptureError>,
    },
    /// The camera cannot be used until somebody intervenes.
    #[error("{error}")]
    #[advice(transparent)]
    Failed {
        /// The underlying error.
        error: Arc<CaptureError>,
    },
    /// The source has no more frames.
    #[error("the source has ended")]
    #[advice = "TRIGGER again: the source is being reopened"]
    Ended,
    /// No frame arrived in time.
    #[error("no frame arrived within {} s of the trigger", waited.as_secs_f64())]
    #[advice(match rule {
        NewFrame::WrittenAfter => {
            "Have a new file written to the watched folder after each trigger; if that takes longer, raise --frame-timeout"
        }
        _ => "Check that the camera delivers frames; a slow one needs a longer --frame-timeout",
    })]
    Late {
        /// How long the trigger waited.
        waited: Duration,
        /// The rule for a new frame.
        rule: NewFrame,
    },
    /// A frame arrived that cannot be read.
    #[error("{0}")]
    #[advice(_0.error.advice())]
    Unreadable(SkippedCapture),
    /// A file was seen before it was written, by the clock of its disk.
    #[error("{name}: the clock of the disk is at least {:.1} s ahead of this computer's", ahead.as_secs_f64())]
    #[advice = "Set both clocks from the same time server: otherwise the age of a file is not known"]
    ClockAhead {
        /// Name of the file.
        name: String,
        /// Lower bound of the difference between the clocks.
        ahead: Duration,
    },
    /// A count was sent, but no line is followed.
    #[error("a count was sent, but no line is followed")]
    #[advice = "Start partsight serve with --line, or TRIGGER without a count"]
    NoLine,
    /// A part is expected by a number that no part has.
    #[error("no part has the number {number}")]
    #[advice = "TRIGGER with numbers that partsight library list shows"]
    UnknownNumber {
        /// The number.
        number: u32,
    },
    /// A part is expected at a place by a number that no place has.
    #[error("the rack has {num_places} places, and none has the number {number}")]
    #[advice = "TRIGGER with numbers of places by their order in the rack file, from 1; serve takes that with --rack"]
    UnknownPlace {
        /// The number.
        number: u32,
        /// Number of places.
        num_places: usize,
    },
    /// The parts cannot be expected: two are at a place.
    #[error(transparent)]
    #[advice(transparent)]
    Expected(#[from] ExpectedError),
    /// The table of orders does not say what is expected.
    #[error(transparent)]
    #[advice(transparent)]
    Order(#[from] OrderError),
    /// The table of orders cannot be read.
    #[error(transparent)]
    #[advice(transparent)]
    Orders(Arc<OrdersError>),
    /// An order is named, and there is no table of orders.
    #[error("an order is named, and there is no table of orders")]
    #[advice = "Start serve with --orders, or open the table in the window; or TRIGGER with the numbers of the expected parts"]
    NoOrders,
    /// The service is ending.
    #[error(transparent)]
    #[advice(transparent)]
    Unanswered(#[from] Unanswered),
}

impl NoFrame {
    /// The reason word in an answer.
    pub fn reason(&self) -> &'static str {
        match self {
            Self::Lost { .. } => "camera_lost",
            Self::Failed { .. } => "camera_failed",
            Self::Ended => "source_ended",
            Self::Late { .. } => "no_frame",
            Self::Unreadable(_) => "unreadable",
            Self::ClockAhead { .. } => "clock_ahead",
            Self::NoLine => "no_line",
            Self::UnknownNumber { .. } => "unknown_number",
            Self::UnknownPlace { .. } => "unknown_place",
            Self::Expected(_) => "place_twice",
            Self::Order(_) | Self::Orders(_) | Self::NoOrders => "not_known",
            Self::Unanswered(why) => why.reason(),
        }
    }
}

/// Converts a source's state into the answer for a client.
pub fn camera_status(state: &FeedState) -> CameraStatus {
    let gone = |reason: &str, error: &Arc<CaptureError>| Some(Problem::of(reason, &**error));
    let (state, problem) = match state {
        FeedState::Opening => (CameraState::Opening, None),
        FeedState::Running => (CameraState::Running, None),
        FeedState::Lost { error } => (CameraState::Lost, gone("camera_lost", error)),
        FeedState::Failed(error) => (CameraState::Over, gone("camera_failed", error)),
        FeedState::Ended | FeedState::Stopped => {
            (CameraState::Over, Some((&NoFrame::Ended).into()))
        }
    };
    CameraStatus { state, problem }
}

impl From<&NoFrame> for Problem {
    fn from(why: &NoFrame) -> Self {
        Self::of(why.reason(), why)
    }
}

impl Camera {
    /// Opens a source on a thread of its own.
    pub fn start(spec: &SourceSpec) -> Result<Self, CaptureError> {
        let rule = NewFrame::of_source(spec);
        let spec = spec.clone();
        Self::start_with(move || {
            let feed = Feed::start(spec.clone(), BackpressurePolicy::Newest, || ());
            feed.map(|feed| (feed, rule))
        })
    }

    /// As [`Self::start`], with a custom way to start the source. The feed must drop frames that nobody takes.
    pub fn start_with(
        start: impl Fn() -> Result<(Feed, NewFrame), CaptureError> + Send + Sync + 'static,
    ) -> Result<Self, CaptureError> {
        let start = move || -> Result<Opened, CaptureError> {
            let (feed, rule) = start()?;
            let motion = rule.shows_motion().then(|| MotionWatch::start(&feed));
            Ok(Opened {
                motion: motion.transpose()?.map(Arc::new),
                feed: Arc::new(feed),
                rule,
            })
        };
        let opened = Mutex::new(start()?);
        Ok(Self {
            start: Box::new(start),
            opened,
        })
    }

    fn opened(&self) -> Opened {
        lock(&self.opened).clone()
    }

    /// The full status of the source.
    pub fn feed_status(&self) -> FeedStatus {
        self.opened().feed.status()
    }

    /// Starts the source again even if it is running: `start` may yield another source by now.
    pub fn restart(&self) -> Result<(), NoFrame> {
        self.start_again(&mut lock(&self.opened))
    }

    /// The source's status for a client.
    pub fn status(&self) -> CameraStatus {
        camera_status(&self.feed_status().state)
    }

    /// Returns the next frame captured after a trigger. A source that is over is opened again first; a lost one is an error
    /// until it has reconnected by itself.
    pub fn frame_after(
        &self,
        asked: &Asked,
        at_most: Duration,
        is_ending: impl Fn() -> bool,
    ) -> Result<Captured, NoFrame> {
        self.restart_if_over()?;
        let opened = self.opened();
        let mut num_arrived = 0;
        opened.wait(at_most, is_ending, |captured| {
            num_arrived += usize::from(captured.arrived > asked.at);
            if let Some(ahead) = opened.rule.clock_ahead(captured, asked) {
                let name = captured.name.clone();
                return Err(NoFrame::ClockAhead { name, ahead });
            }
            Ok(opened.rule.is_new(captured, asked, num_arrived))
        })
    }

    /// As [`Self::frame_after`], where no line is followed: a trigger with a count would get a pose at another one.
    pub fn frame_without_line(
        &self,
        asked: &Asked,
        at_most: Duration,
        is_ending: impl Fn() -> bool,
    ) -> Result<Captured, NoFrame> {
        if asked.count.is_some() {
            return Err(NoFrame::NoLine);
        }
        self.frame_after(asked, at_most, is_ending)
    }

    /// The newest frame that nobody has taken, if there is one. Does not wait.
    pub fn newest(&self) -> Option<Captured> {
        match self.opened().feed.wait(Duration::ZERO) {
            Some(FeedItem::Captured(captured)) => Some(captured),
            Some(FeedItem::Skipped(_)) | None => None,
        }
    }

    /// Passes on as many successive frames as are wanted, all captured after a request; one alone if the source does not show
    /// motion, in which case it returns false.
    pub fn frames_after(
        &self,
        asked: &Asked,
        num: usize,
        at_most: Duration,
        is_ending: impl Fn() -> bool,
        mut each: impl FnMut(Captured),
    ) -> Result<bool, NoFrame> {
        let first = self.frame_after(asked, at_most, &is_ending)?;
        let mut last = first.arrived;
        each(first);
        let opened = self.opened();
        if opened.motion.is_none() {
            return Ok(false);
        }
        for _ in 1..num {
            let next = opened.wait(at_most, &is_ending, |captured| Ok(captured.arrived > last))?;
            last = next.arrived;
            each(next);
        }
        Ok(true)
    }

    /// Refuses the accepted parts of a frame that move. `at` is the camera's time of the frame. If the scene was still until
    /// then, a frame at least 150 ms later must show each part in the same place; if that is not known, because the source
    /// has just begun or is slow, one at least 900 ms later. `again` inspects that frame, `middle_of` is the middle of a
    /// part, part space, metres. Returns false if the source does not show it, or ends before. An error leaves the parts
    /// unchecked and must be answered instead of them.
    pub fn refuse_if_moving(
        &self,
        at: Duration,
        inspections: &mut [Inspection],
        middle_of: impl Fn(&Inspection) -> Option<Point3<f64>>,
        at_most: Duration,
        is_ending: impl Fn() -> bool,
        again: impl FnOnce(Captured) -> Vec<Inspection>,
    ) -> Result<bool, NoFrame> {
        let opened = self.opened();
        let Some(motion) = &opened.motion else {
            return Ok(false);
        };
        if !inspections.iter().any(|part| part.verdict.is_accepted()) {
            return Ok(true);
        }
        let apart = match motion.state_at(at) {
            MotionState::Moving => {
                refuse_all(inspections);
                return Ok(true);
            }
            MotionState::Steady { .. } => MIN_FRAME_INTERVAL,
            MotionState::Watching => SteadyParams::default().settle,
        };
        let later = opened.wait(at_most, is_ending, |captured| {
            Ok(time_of(captured) >= at + apart)
        });
        let later = match later {
            // The file ends here.
            Err(NoFrame::Ended) if opened.rule == NewFrame::SecondReplayed => return Ok(false),
            later => later?,
        };
        let at = time_of(&later);
        let again = again(later);
        if motion.state_at(at) == MotionState::Moving {
            refuse_all(inspections);
        } else {
            for inspection in inspections {
                let middle = middle_of(inspection);
                refuse_unless_again(inspection, &again, middle);
            }
        }
        Ok(true)
    }

    /// The time of capture, from which the frame's age is computed.
    pub fn captured_at(&self, captured: &Captured) -> Instant {
        self.opened().rule.captured_at(captured)
    }

    /// When a trigger came, by the clock of this frame, which was captured after it.
    pub(super) fn asked_at(&self, asked: &Asked, captured: &Captured) -> Duration {
        self.opened().rule.asked_at(asked, captured)
    }

    fn restart_if_over(&self) -> Result<(), NoFrame> {
        let mut opened = lock(&self.opened);
        if opened.feed.status().state.is_over() {
            self.start_again(&mut opened)?;
        }
        Ok(())
    }

    fn start_again(&self, opened: &mut Opened) -> Result<(), NoFrame> {
        *opened = (self.start)().map_err(|error| NoFrame::Failed {
            error: Arc::new(error),
        })?;
        Ok(())
    }
}

fn refuse_all(inspections: &mut [Inspection]) {
    for inspection in inspections {
        refuse_moving(inspection);
    }
}

impl Opened {
    /// Waits for a frame that is wanted. An error about a frame is returned if no other comes in time.
    fn wait(
        &self,
        at_most: Duration,
        is_ending: impl Fn() -> bool,
        mut is_wanted: impl FnMut(&Captured) -> Result<bool, NoFrame>,
    ) -> Result<Captured, NoFrame> {
        let until = Instant::now() + at_most;
        let mut unreadable = None;
        while !is_ending() {
            // Read the status first, so that frames delivered just before the end are still taken.
            let status = self.feed.status();
            match self.feed.wait(POLL_INTERVAL) {
                Some(FeedItem::Captured(captured)) => match is_wanted(&captured) {
                    Ok(true) => return Ok(captured),
                    Ok(false) => {}
                    Err(why) => unreadable = Some(why),
                },
                Some(FeedItem::Skipped(skipped)) => {
                    unreadable = Some(NoFrame::Unreadable(skipped));
                }
                None => match status.state {
                    FeedState::Lost { error } => return Err(NoFrame::Lost { error }),
                    FeedState::Failed(error) => return Err(NoFrame::Failed { error }),
                    FeedState::Ended | FeedState::Stopped => {
                        return Err(unreadable.unwrap_or(NoFrame::Ended));
                    }
                    FeedState::Opening | FeedState::Running => {}
                },
            }
            if Instant::now() >= until {
                return Err(unreadable.unwrap_or(NoFrame::Late {
                    waited: at_most,
                    rule: self.rule,
                }));
            }
        }
        Err(Unanswered::Stopping.into())
    }
}

#[cfg(test)]
mod tests {
    use std::{
        collections::VecDeque,
        slice,
        sync::atomic::{AtomicBool, AtomicUsize, Ordering},
    };

    use jiff::Timestamp;

    use super::*;
    use capture::{
        CellScene, DepthSource, NextCapture, SimulatedCell, SimulatedSpec, fixtures::captured,
    };
    use files::FileError;
    use geometry::rigid::RigidTransform;
    use inspection::{
        fixtures::shipped_library,
        pipeline::{Recipe, Unwatched, run},
    };
    use stages::scene::scene_from_image;

    /// Long enough for a busy machine; normally what is waited for comes at once.
    const PATIENCE: Duration = Duration::from_mins(1);

    fn gone() -> CaptureError {
        CaptureError::FolderGone {
            path: "share".into(),
            may_come: true,
        }
    }

    /// A camera that delivers one frame per call, as fast as it is asked.
    struct Endless {
        number: u64,
        is_plugged_in: Arc<AtomicBool>,
    }

    impl DepthSource for Endless {
        fn title(&self) -> String {
            "endless".into()
        }

        fn is_simulated(&self) -> bool {
            false
        }

        fn next(&mut self, _: Duration) -> Result<NextCapture, CaptureError> {
            if !self.is_plugged_in.load(Ordering::SeqCst) {
                return Err(gone());
            }
            self.number += 1;
            let frame = captured(self.number, Timestamp::UNIX_EPOCH);
            Ok(NextCapture::Captured(frame))
        }
    }

    /// Delivers the given steps, then the end.
    struct Script(VecDeque<NextCapture>);

    impl DepthSource for Script {
        fn title(&self) -> String {
            "script".into()
        }

        fn is_simulated(&self) -> bool {
            false
        }

        fn next(&mut self, _: Duration) -> Result<NextCapture, CaptureError> {
            Ok(self.0.pop_front().unwrap_or(NextCapture::End))
        }
    }

    fn endless(is_plugged_in: &Arc<AtomicBool>) -> Camera {
        let is_plugged_in = Arc::clone(is_plugged_in);
        let start = move || {
            let is_plugged_in = Arc::clone(&is_plugged_in);
            let open = move || {
                let is_plugged_in = Arc::clone(&is_plugged_in);
                let source: Box<dyn DepthSource> = Box::new(Endless {
                    number: 0,
                    is_plugged_in,
                });
                Ok(source)
            };
            let feed = Feed::start_with(open, BackpressurePolicy::Newest, || ());
            feed.map(|feed| (feed, NewFrame::SecondArrived))
        };
        Camera::start_with(start).expect("started")
    }

    fn scripted(
        rule: NewFrame,
        steps: impl Fn() -> Vec<NextCapture> + Send + Sync + 'static,
    ) -> Camera {
        let steps = Arc::new(steps);
        let start = move || {
            let steps = Arc::clone(&steps);
            let open = move || {
                let source: Box<dyn DepthSource> = Box::new(Script(steps().into()));
                Ok(source)
            };
            // Deliver every step, however the threads are scheduled.
            let feed = Feed::start_with(open, BackpressurePolicy::Every, || ());
            feed.map(|feed| (feed, rule))
        };
        Camera::start_with(start).expect("started")
    }

    #[test]
    fn a_frame_arrived_after_the_trigger_behind_another_that_did() {
        let camera = endless(&Arc::new(AtomicBool::new(true)));
        let mut last = 0;
        for _ in 0..50 {
            let asked = Asked::now();
            let frame = camera
                .frame_after(&asked, PATIENCE, || false)
                .expect("a frame");
            assert!(frame.arrived > asked.at);
            // At least one frame lies between it and the previous one.
            assert!(frame.number > last + 1, "{} after {last}", frame.number);
            last = frame.number;
        }
        assert_eq!(camera.status().state, CameraState::Running);
    }

    #[test]
    fn a_camera_that_is_unplugged_is_an_error_until_it_is_back() {
        let is_plugged_in = Arc::new(AtomicBool::new(true));
        let camera = endless(&is_plugged_in);
        let frame = || camera.frame_after(&Asked::now(), PATIENCE, || false);
        frame().expect("plugged in");
        is_plugged_in.store(false, Ordering::SeqCst);
        // Frames already on their way still arrive.
        let why = loop {
            if let Err(why) = frame() {
                break why;
            }
        };
        assert_eq!(why.reason(), "camera_lost");
        assert!(why.to_string().contains("does not exist") && !why.advice().is_empty());
        let status = camera.status();
        assert_eq!(status.state, CameraState::Lost);
        assert!(status.problem.expect("why").message.contains("to do"));
        is_plugged_in.store(true, Ordering::SeqCst);
        while frame().is_err() {}
        assert_eq!(camera.status().state, CameraState::Running);
    }

    #[test]
    fn a_source_that_is_over_is_opened_again_by_the_next_trigger() {
        let opened = Arc::new(AtomicUsize::new(0));
        let theirs = Arc::clone(&opened);
        let camera = scripted(NewFrame::SecondArrived, move || {
            theirs.fetch_add(1, Ordering::SeqCst);
            Vec::new()
        });
        for _ in 0..3 {
            let why = camera.frame_after(&Asked::now(), PATIENCE, || false);
            assert_eq!(why.expect_err("over").reason(), "source_ended");
        }
        assert!(opened.load(Ordering::SeqCst) >= 3);
        assert_eq!(camera.status().state, CameraState::Over);
    }

    #[test]
    fn of_a_folder_a_file_counts_that_was_written_after_the_trigger() {
        let asked = Asked::now();
        let by_clock = asked.by_clock;
        let camera = scripted(NewFrame::WrittenAfter, move || {
            [-3600, -1, 0, 1]
                .into_iter()
                .zip(1..)
                .map(|(seconds, number)| {
                    let at = by_clock + SignedDuration::from_secs(seconds);
                    NextCapture::Captured(captured(number, at))
                })
                .collect()
        });
        let frame = camera
            .frame_after(&asked, PATIENCE, || false)
            .expect("written after");
        assert_eq!(frame.number, 3);
        assert!(camera.captured_at(&frame) <= frame.arrived);
    }

    #[test]
    fn a_file_of_a_clock_that_is_ahead_is_refused_and_never_younger_than_its_arrival() {
        let asked = Asked::now();
        let by_clock = asked.by_clock;
        let ahead = SignedDuration::from_secs(5);
        let camera = scripted(NewFrame::WrittenAfter, move || {
            let file = captured(1, by_clock + ahead);
            vec![NextCapture::Captured(file)]
        });
        let why = camera.frame_after(&asked, PATIENCE, || false);
        let why = why.expect_err("nobody knows when it was written");
        assert_eq!(why.reason(), "clock_ahead");
        assert!(why.to_string().contains("5.0 s ahead"), "{why}");
        let file = captured(1, clock::now() + ahead);
        assert_eq!(NewFrame::WrittenAfter.captured_at(&file), file.arrived);
        // A file that waited in the feed was written before the trigger, even if its clock is fast.
        assert!(!NewFrame::WrittenAfter.is_new(&file, &Asked::now(), 0));
    }

    #[test]
    fn a_file_first_seen_before_the_trigger_is_refused_though_it_is_dated_after_it() {
        let asked = Asked::now();
        let frame_after = |ahead_ms: i64| {
            let (at, by_clock) = (asked.at, asked.by_clock);
            let camera = scripted(NewFrame::WrittenAfter, move || {
                let new_but_dated_before = captured(1, by_clock - SignedDuration::from_hours(1));
                let seen_before = Captured {
                    arrived: at
                        .checked_sub(Duration::from_millis(10))
                        .expect("up longer"),
                    ..captured(2, by_clock + SignedDuration::from_millis(ahead_ms))
                };
                let files = [new_but_dated_before, seen_before];
                files.map(NextCapture::Captured).into()
            });
            let why = camera.frame_after(&asked, PATIENCE, || false);
            why.expect_err("written before the trigger")
        };
        // Too little to prove that the clock is fast.
        assert_eq!(frame_after(20).reason(), "source_ended");
        let why = frame_after(290);
        assert_eq!(why.reason(), "clock_ahead");
        assert!(why.to_string().contains("at least 0.3 s ahead"), "{why}");
    }

    #[test]
    fn without_a_frame_the_answer_comes_in_time_and_names_what_could_not_be_read() {
        let quiet = || (0..10_000).map(|_| NextCapture::NotYet).collect();
        let camera = scripted(NewFrame::SecondArrived, quiet);
        let why = camera.frame_after(&Asked::now(), Duration::ZERO, || false);
        let why = why.expect_err("nothing");
        assert!(matches!(why.reason(), "no_frame" | "source_ended"), "{why}");
        let camera = scripted(NewFrame::SecondArrived, || {
            vec![NextCapture::Skipped(SkippedCapture {
                name: "broken.pcd".into(),
                error: Arc::new(gone()),
            })]
        });
        let why = camera.frame_after(&Asked::now(), PATIENCE, || false);
        let why = why.expect_err("unreadable");
        assert_eq!(why.reason(), "unreadable");
        assert!(why.to_string().contains("broken.pcd"), "{why}");
        assert!(why.to_string().starts_with("broken.pcd: "), "{why}");
        let of_file = NoFrame::Unreadable(SkippedCapture {
            name: "broken.pcd".into(),
            error: Arc::new(CaptureError::File(FileError::Empty {
                path: "scans/broken.pcd".into(),
            })),
        });
        assert_eq!(of_file.to_string(), "scans/broken.pcd: the file is empty");
        let why = camera.frame_after(&Asked::now(), PATIENCE, || true);
        assert_eq!(why.expect_err("ending").reason(), "stopping");
    }

    /// Frames per second of the line.
    const FRAME_RATE_HZ: f64 = 15.0;
    /// Seconds from one of its parts to the next.
    const PART_INTERVAL_S: f64 = 6.0;
    /// Long enough for all of its frames on a busy machine.
    const LINE_PATIENCE: Duration = Duration::from_mins(30);

    /// The simulated line as a camera that is read as fast as it is asked, 15 frames a second by its own clock.
    struct Line {
        cell: SimulatedCell,
        number: u64,
    }

    impl Line {
        fn new() -> Self {
            let spec = SimulatedSpec {
                scene: CellScene::Line {
                    every: PART_INTERVAL_S,
                },
                frames_per_second: FRAME_RATE_HZ,
                ..SimulatedSpec::default()
            };
            Self {
                cell: SimulatedCell::new(spec),
                number: 0,
            }
        }
    }

    impl DepthSource for Line {
        fn title(&self) -> String {
            "line".into()
        }

        fn is_simulated(&self) -> bool {
            true
        }

        fn next(&mut self, _: Duration) -> Result<NextCapture, CaptureError> {
            self.number += 1;
            let since = SignedDuration::from_secs_f64((self.number - 1) as f64 / FRAME_RATE_HZ);
            let (image, truth) = self.cell.frame(self.number);
            Ok(NextCapture::Captured(Captured {
                image,
                truth: truth.map(Arc::new),
                ..captured(self.number, Timestamp::UNIX_EPOCH + since)
            }))
        }
    }

    /// How far the part has moved at this point between two poses, metres.
    fn moved(from: &RigidTransform, to: &RigidTransform, at: Point3<f64>) -> f64 {
        (to * from.inverse() * at - at).norm()
    }

    #[test]
    fn a_part_that_swings_in_or_leaves_is_never_accepted_off_its_place_and_once_it_rests_it_is() {
        let start = || {
            let open = || Ok(Box::new(Line::new()) as Box<dyn DepthSource>);
            let feed = Feed::start_with(open, BackpressurePolicy::Every, || ());
            feed.map(|feed| (feed, NewFrame::SecondArrived))
        };
        let camera = Camera::start_with(start).expect("started");
        let (library, recipe) = (shipped_library(), Recipe::default());
        let inspect = |captured: Captured| {
            let scene = scene_from_image(captured.image);
            vec![run(&scene, &library, &recipe, &Unwatched).expect("not cancelled")]
        };
        let mut resting = Line::new().cell;
        let opened = camera.opened();
        let watch = opened.motion.as_ref().expect("watched");
        let (mut num_accepted, mut num_moving) = (0, 0);
        // Every half second of one part, which comes in, rests from about 2 to 5.2 s, and leaves.
        let (_, truth) = resting.frame((4.0 * FRAME_RATE_HZ) as u64);
        let rest = truth.expect("of one part").camera_from_part;
        for trigger in 0..12 {
            let due = Duration::from_millis(500 * trigger);
            let passing = opened.wait(
                LINE_PATIENCE,
                || false,
                |captured| {
                    let at = time_of(captured);
                    // Nothing outruns the watch, as it would not at its own rate.
                    watch.state_at(at);
                    Ok(at >= due)
                },
            );
            passing.expect("a frame");
            let frame = camera.frame_after(&Asked::now(), LINE_PATIENCE, || false);
            let frame = frame.expect("a frame");
            let taken_at = time_of(&frame);
            let truth = Arc::clone(frame.truth.as_ref().expect("known"));
            let mut inspection = inspect(frame).remove(0);
            let was_accepted = inspection.verdict.is_accepted();
            let middle = inspection.middle(&library);
            let checked = camera.refuse_if_moving(
                taken_at,
                slice::from_mut(&mut inspection),
                |_| middle,
                LINE_PATIENCE,
                || false,
                inspect,
            );
            assert!(checked.expect("a second frame"));
            num_moving += usize::from(was_accepted && !inspection.verdict.is_accepted());
            if !inspection.verdict.is_accepted() {
                continue;
            }
            let pose = inspection.found_pose().expect("accepted");
            let at = pose.camera_from_part() * middle.expect("points");
            let off = moved(&rest, &truth.camera_from_part, at);
            let bound = pose.bounds().expect("bounds").shift;
            assert!(
                off <= bound.0,
                "{off} m off at {taken_at:?}, beyond {bound}"
            );
            num_accepted += 1;
        }
        assert!(
            num_moving >= 2 && num_accepted >= 2,
            "{num_moving}, {num_accepted}"
        );
    }
}
