//! The source behind the server: a frame captured after a trigger, and how the camera is in between.
//!
//! The source runs all the time, so that a trigger need not wait for it to be opened; frames that nobody asked for are
//! dropped. A frame that arrives just after a trigger may have been exposed before it, so of a camera the second one that
//! arrives is taken: it was exposed after the first. That costs one frame more, 33 ms of a Kinect. Of a watched folder it is a
//! file that was written after the trigger.

use std::{
    sync::{Arc, Mutex},
    time::{Duration, Instant},
};

use jiff::Timestamp;
use thiserror::Error;

use super::{
    answer::{CameraState, CameraStatus, Trouble},
    server::Asked,
};
use crate::{
    capture::{
        BackpressurePolicy, CaptureError, Captured, Feed, FeedItem, FeedState, FeedStatus,
        SourceSpec,
    },
    error::{Advice, lock},
};

/// A trigger looks this often whether the service is to end.
const TURN: Duration = Duration::from_millis(100);

/// A source that goes on while nobody asks for frames.
pub struct Camera {
    start: Box<dyn Fn() -> Result<(Feed, NewFrame), CaptureError> + Send + Sync>,
    opened: Mutex<Opened>,
}

/// A source at work, and which of its frames are new.
#[derive(Clone)]
struct Opened {
    feed: Arc<Feed>,
    rule: NewFrame,
}

impl From<(Feed, NewFrame)> for Opened {
    fn from((feed, rule): (Feed, NewFrame)) -> Self {
        Self {
            feed: Arc::new(feed),
            rule,
        }
    }
}

/// By what a frame is known to have been captured after a trigger.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NewFrame {
    /// It is the second one that arrived since then.
    SecondArrived,
    /// It was written after that by the clock.
    WrittenAfter,
}

impl NewFrame {
    /// What suits a source.
    pub fn of_source(spec: &SourceSpec) -> Self {
        match spec {
            SourceSpec::Watched(_) => Self::WrittenAfter,
            SourceSpec::Simulated(_)
            | SourceSpec::Recording(_)
            | SourceSpec::Kinect(_)
            | SourceSpec::Genicam(_)
            | SourceSpec::OpenNi(_)
            | SourceSpec::Realsense(_) => Self::SecondArrived,
        }
    }
}

impl NewFrame {
    /// When a frame was captured, for its age.
    pub fn captured_at(self, captured: &Captured) -> Instant {
        match self {
            Self::SecondArrived => captured.arrived,
            Self::WrittenAfter => {
                let age = Timestamp::now().duration_since(captured.taken_at);
                let age = Duration::try_from(age).unwrap_or_default();
                Instant::now().checked_sub(age).unwrap_or(captured.arrived)
            }
        }
    }
}

/// Why no frame came.
#[derive(Clone, Debug, Error)]
pub enum NoFrame {
    /// The camera is gone, and looked for by itself.
    #[error("{error}")]
    Lost {
        /// Why.
        error: Arc<CaptureError>,
    },
    /// The camera cannot be used until somebody has done something about it.
    #[error("{error}")]
    Failed {
        /// Why.
        error: Arc<CaptureError>,
    },
    /// The source has no more.
    #[error("the source has ended")]
    Ended,
    /// Nothing came in time.
    #[error("no frame came within {} s of the trigger", waited.as_secs_f64())]
    Late {
        /// How long it was waited for.
        waited: Duration,
    },
    /// Something came that cannot be read.
    #[error("{name}: {error}")]
    Unreadable {
        /// What a person calls it.
        name: String,
        /// Why not.
        error: Arc<CaptureError>,
    },
    /// The service ends.
    #[error("the service ends")]
    Stopping,
}

impl NoFrame {
    /// The word for it in an answer.
    pub fn reason(&self) -> &'static str {
        match self {
            Self::Lost { .. } => "camera_lost",
            Self::Failed { .. } => "camera_failed",
            Self::Ended => "source_ended",
            Self::Late { .. } => "no_frame",
            Self::Unreadable { .. } => "unreadable",
            Self::Stopping => "stopping",
        }
    }
}

impl Advice for NoFrame {
    fn advice(&self) -> String {
        match self {
            Self::Lost { error } | Self::Failed { error } | Self::Unreadable { error, .. } => {
                error.advice()
            }
            Self::Ended => "TRIGGER again: the source is opened anew".into(),
            Self::Late { .. } => {
                "Check that the camera gives frames; a slow one needs a longer --frame-timeout"
                    .into()
            }
            Self::Stopping => "Connect again once the service is running".into(),
        }
    }
}

/// How a source is, for a client.
impl From<&FeedState> for CameraStatus {
    fn from(state: &FeedState) -> Self {
        let gone = |reason: &str, error: &Arc<CaptureError>| Some(Trouble::of(reason, &**error));
        let (state, trouble) = match state {
            FeedState::Opening => (CameraState::Opening, None),
            FeedState::Running => (CameraState::Running, None),
            FeedState::Lost { error } => (CameraState::Lost, gone("camera_lost", error)),
            FeedState::Failed(error) => (CameraState::Over, gone("camera_failed", error)),
            FeedState::Ended | FeedState::Stopped => {
                let ended = NoFrame::Ended;
                let trouble = Trouble::of(ended.reason(), &ended);
                (CameraState::Over, Some(trouble))
            }
        };
        Self { state, trouble }
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

    /// As [`Self::start`], with another way to start the source; its feed has to drop what nobody takes.
    pub fn start_with(
        start: impl Fn() -> Result<(Feed, NewFrame), CaptureError> + Send + Sync + 'static,
    ) -> Result<Self, CaptureError> {
        let opened = Mutex::new(start()?.into());
        Ok(Self {
            start: Box::new(start),
            opened,
        })
    }

    fn opened(&self) -> Opened {
        lock(&self.opened).clone()
    }

    /// How the source is, in full.
    pub fn feed_status(&self) -> FeedStatus {
        self.opened().feed.status()
    }

    /// Starts the source anew, whatever it does: it may be another one by now.
    pub fn restart(&self) -> Result<(), NoFrame> {
        self.start_again(&mut lock(&self.opened))
    }

    /// How the source is, for a client.
    pub fn status(&self) -> CameraStatus {
        CameraStatus::from(&self.feed_status().state)
    }

    /// The next frame that was captured after a trigger. A source that is over is opened again first; one that is lost is
    /// looked for by itself, and that is the answer meanwhile.
    pub fn frame_after(
        &self,
        asked: &Asked,
        at_most: Duration,
        is_ending: impl Fn() -> bool,
    ) -> Result<Captured, NoFrame> {
        self.restart_if_over()?;
        let Opened { feed, rule } = self.opened();
        let until = Instant::now() + at_most;
        let mut num_arrived = 0;
        let mut unreadable = None;
        while !is_ending() {
            // Asked before: what was put there before the end is taken yet.
            let status = feed.status();
            match feed.wait(TURN) {
                Some(FeedItem::Captured(captured)) => {
                    num_arrived += usize::from(captured.arrived > asked.at);
                    let is_new = match rule {
                        NewFrame::SecondArrived => num_arrived >= 2,
                        NewFrame::WrittenAfter => captured.taken_at >= asked.by_clock,
                    };
                    if is_new {
                        return Ok(captured);
                    }
                }
                Some(FeedItem::Skipped(skipped)) => {
                    unreadable = Some(NoFrame::Unreadable {
                        name: skipped.name,
                        error: skipped.error,
                    });
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
                return Err(unreadable.unwrap_or(NoFrame::Late { waited: at_most }));
            }
        }
        Err(NoFrame::Stopping)
    }

    /// When the frame was captured, for its age.
    pub fn captured_at(&self, captured: &Captured) -> Instant {
        self.opened().rule.captured_at(captured)
    }

    fn restart_if_over(&self) -> Result<(), NoFrame> {
        let mut opened = lock(&self.opened);
        if opened.feed.status().state.is_over() {
            self.start_again(&mut opened)?;
        }
        Ok(())
    }

    fn start_again(&self, opened: &mut Opened) -> Result<(), NoFrame> {
        let started = (self.start)().map_err(|error| NoFrame::Failed {
            error: Arc::new(error),
        })?;
        *opened = started.into();
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use std::{
        collections::VecDeque,
        sync::atomic::{AtomicBool, AtomicUsize, Ordering},
    };

    use jiff::SignedDuration;

    use super::*;
    use crate::{
        capture::{DepthSource, NextCapture, SkippedCapture},
        kit::captured,
    };

    /// Long enough for a machine at work with other things; what is waited for comes at once.
    const PATIENCE: Duration = Duration::from_mins(1);

    fn gone() -> CaptureError {
        CaptureError::FolderGone {
            path: "share".into(),
            may_come: true,
        }
    }

    /// A camera that gives a frame at a time, as fast as it is asked.
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

    /// Gives what it was told to give, then the end.
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
            // Every step counts here, however the threads run.
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
            // One lies between it and what had been captured before.
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
        // What is on its way arrives yet.
        let why = loop {
            if let Err(why) = frame() {
                break why;
            }
        };
        assert_eq!(why.reason(), "camera_lost");
        assert!(why.to_string().contains("not there") && !why.advice().is_empty());
        let status = camera.status();
        assert_eq!(status.state, CameraState::Lost);
        assert!(status.trouble.expect("why").message.contains("to do"));
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
        assert!(camera.captured_at(&frame) <= Instant::now());
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
        let why = camera.frame_after(&Asked::now(), PATIENCE, || true);
        assert_eq!(why.expect_err("ending").reason(), "stopping");
    }
}
