//! Whether anything moves before a running source, watched between the triggers too.
//!
//! A trigger is answered from one frame, and one frame does not show whether the part swings. A thread of its own
//! therefore passes every frame to a [`MotionDetector`], as Live does: at a trigger it is known whether the scene was
//! still until then, and nobody waits for it. What begins to move just then shows only afterwards, so
//! [`Camera::refuse_if_moving`](super::Camera::refuse_if_moving) compares the trigger's frame with a later one.

use std::{
    sync::{
        Arc, Condvar, Mutex, PoisonError,
        atomic::{AtomicBool, Ordering},
    },
    thread::{self, JoinHandle},
    time::{Duration, SystemTime},
};

use jiff::Timestamp;

use capture::{CaptureError, Captured, Feed, FeedItem};
use geometry::{clock, error::lock};
use inspection::pipeline::live::{MotionDetector, MotionState, SteadyParams};
use stages::scene::scene_from_image;

/// How long the thread waits for a frame before it checks whether to end.
const POLL_INTERVAL: Duration = Duration::from_millis(100);
/// Frames that follow sooner are not looked at: a faster camera shows no more of a motion.
const MIN_FRAME_INTERVAL: Duration = Duration::from_millis(25);
/// Maximum time until the thread has seen a frame that has arrived: usually milliseconds, but more on a busy computer.
const MAX_LAG: Duration = Duration::from_secs(3);

/// Watches a source until it is dropped.
pub(super) struct MotionWatch {
    seen: Arc<Seen>,
    is_ending: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

#[derive(Default)]
struct Seen {
    last: Mutex<LastSeen>,
    changed: Condvar,
}

#[derive(Clone, Copy, Default)]
struct LastSeen {
    /// Time of the last frame.
    at: Option<Duration>,
    state: MotionState,
    is_over: bool,
}

/// A frame's own time: the camera's or, of a recording, that of its camera.
pub(super) fn time_of(captured: &Captured) -> Duration {
    since_epoch(captured.taken_at)
}

/// A time as that of frames.
pub(super) fn since_epoch(at: Timestamp) -> Duration {
    Duration::try_from(at.as_duration()).unwrap_or_default()
}

/// The time of frames as one of the calendar.
pub(super) fn timestamp(at: Duration) -> Timestamp {
    clock::timestamp(SystemTime::UNIX_EPOCH + at)
}

impl MotionWatch {
    /// Watches the source of this feed, from which it takes nothing.
    pub(super) fn start(feed: &Feed) -> Result<Self, CaptureError> {
        let (seen, is_ending) = (Arc::<Seen>::default(), Arc::<AtomicBool>::default());
        let (theirs, ends, tap) = (Arc::clone(&seen), Arc::clone(&is_ending), feed.tap());
        let thread = thread::Builder::new()
            .name("motion".into())
            .spawn(move || theirs.follow(&tap, &ends))
            .map_err(|source| CaptureError::NoThread { source })?;
        Ok(Self {
            seen,
            is_ending,
            thread: Some(thread),
        })
    }

    /// Whether the scene moves, by the frames up to that of this time at least.
    pub(super) fn state_at(&self, at: Duration) -> MotionState {
        let last = lock(&self.seen.last);
        let is_behind = |last: &mut LastSeen| !last.is_over && last.at < Some(at);
        let waited = self
            .seen
            .changed
            .wait_timeout_while(last, MAX_LAG, is_behind);
        let (last, _) = waited.unwrap_or_else(PoisonError::into_inner);
        match last.state {
            // It cannot be told of a frame that was not seen.
            MotionState::Steady { .. } if last.at < Some(at) => MotionState::Watching,
            state => state,
        }
    }
}

impl Seen {
    fn follow(&self, feed: &Feed, is_ending: &AtomicBool) {
        let mut detector = MotionDetector::new(SteadyParams::default());
        let mut looked_at: Option<Duration> = None;
        while !is_ending.load(Ordering::Relaxed) {
            match feed.wait(POLL_INTERVAL) {
                Some(FeedItem::Captured(captured)) => {
                    let at = time_of(&captured);
                    let since = looked_at.and_then(|looked_at| at.checked_sub(looked_at));
                    if since.is_none_or(|since| since >= MIN_FRAME_INTERVAL) {
                        looked_at = Some(at);
                        detector.see(&scene_from_image(captured.image), at);
                    }
                    let mut last = lock(&self.last);
                    (last.at, last.state) = (Some(at), detector.stillness());
                    drop(last);
                    self.changed.notify_all();
                }
                None if feed.status().state.is_over() => break,
                Some(FeedItem::Skipped(_)) | None => {}
            }
        }
        lock(&self.last).is_over = true;
        self.changed.notify_all();
    }
}

impl Drop for MotionWatch {
    fn drop(&mut self) {
        self.is_ending.store(true, Ordering::Relaxed);
        if let Some(thread) = self.thread.take() {
            // If it panicked, triggers have relied on two frames alone.
            let _ = thread.join();
        }
    }
}
