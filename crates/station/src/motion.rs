//! Whether anything moves before a running source, watched between the inspected frames too.
//!
//! A trigger is answered from one frame, and one frame does not show whether the part swings. A thread of its own
//! therefore passes every frame to a [`MotionDetector`]: a trigger finds out without waiting whether the scene was
//! still until then. What begins to move just then shows only afterwards, so
//! [`Camera::refuse_if_moving`](super::Camera::refuse_if_moving) compares the trigger's frame with a later one.
//!
//! Who follows a camera inspects only some of its frames, on a slow computer two of thirty. For an inspected frame,
//! [`MotionWatch::motion_of`] gives what was known after it, by the frames in between too.

use std::{
    collections::VecDeque,
    sync::{
        Arc, Condvar, Mutex, MutexGuard, PoisonError,
        atomic::{AtomicBool, Ordering},
    },
    thread::{self, JoinHandle},
    time::{Duration, Instant, SystemTime},
};

use jiff::Timestamp;

use capture::{BackpressurePolicy, CaptureError, Captured, Feed, FeedItem, SourceSpec};
use geometry::{
    clock,
    error::{guarded, lock},
};
use inspection::pipeline::live::{MotionDetector, MotionState, SceneMotion, SteadyParams};
use stages::scene::{SceneCloud, scene_from_image};

/// How long the thread waits for a frame, and others for the thread, before they check whether to end.
const POLL_INTERVAL: Duration = Duration::from_millis(100);
/// Frames that follow sooner are not looked at: a faster camera shows no more of a motion.
const MIN_FRAME_INTERVAL: Duration = Duration::from_millis(25);
/// Maximum time until the thread has seen a frame that has arrived: usually milliseconds, but more on a busy computer.
const MAX_LAG: Duration = Duration::from_secs(3);
/// Frames whose state is remembered: more than arrive while one waits to be inspected.
const MAX_REMEMBERED: usize = 128;

/// Watches a source until it is dropped.
pub struct MotionWatch {
    seen: Arc<Seen>,
    /// It sees what arrives from then on.
    began: Instant,
    is_ending: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

#[derive(Default)]
struct Seen {
    last: Mutex<LastSeen>,
    changed: Condvar,
}

#[derive(Default)]
struct LastSeen {
    frames: SeenFrames,
    is_over: bool,
}

/// What was known after each of the last frames, by their own times.
#[derive(Debug, Default)]
struct SeenFrames(VecDeque<(Duration, SceneMotion)>);

impl SeenFrames {
    fn add(&mut self, at: Duration, motion: SceneMotion) {
        if self.at().is_some_and(|last| at < last) {
            // A clock was set back.
            self.0.clear();
        }
        if self.0.len() == MAX_REMEMBERED {
            self.0.pop_front();
        }
        self.0.push_back((at, motion));
    }

    /// Time of the last frame.
    fn at(&self) -> Option<Duration> {
        self.0.back().map(|(at, _)| *at)
    }

    fn last(&self) -> SceneMotion {
        self.0
            .back()
            .map_or_else(SceneMotion::default, |(_, motion)| *motion)
    }

    /// What was known after the frame of this time or, if that was passed over, after the next one; nothing, if there is none.
    fn motion_at(&self, at: Duration) -> SceneMotion {
        let mut frames = self.0.iter();
        let seen = frames.find(|(seen, _)| *seen >= at);
        seen.map_or_else(SceneMotion::default, |(_, motion)| *motion)
    }
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
    /// Watches the source of a feed of which frames are dropped while others are inspected; `None` where every frame is inspected,
    /// or each stands for itself.
    pub fn of_source(spec: &SourceSpec, feed: &Feed) -> Result<Option<Self>, CaptureError> {
        let is_dropping = BackpressurePolicy::for_source(spec) == BackpressurePolicy::Newest;
        let is_needed = is_dropping && spec.is_followed();
        is_needed.then(|| Self::start(feed)).transpose()
    }

    /// Watches the source of this feed, from which it takes nothing.
    pub(super) fn start(feed: &Feed) -> Result<Self, CaptureError> {
        let (seen, is_ending) = (Arc::<Seen>::default(), Arc::<AtomicBool>::default());
        let (theirs, ends, tap) = (Arc::clone(&seen), Arc::clone(&is_ending), feed.tap());
        let began = Instant::now();
        let thread = thread::Builder::new()
            .name("motion".into())
            .spawn(move || theirs.follow(&tap, &ends))
            .map_err(|source| CaptureError::NoThread { source })?;
        Ok(Self {
            seen,
            began,
            is_ending,
            thread: Some(thread),
        })
    }

    /// Whether the scene moves, by the frames up to that of this time at least.
    pub(super) fn state_at(&self, at: Duration) -> MotionState {
        let last = self.seen.up_to(at, || false);
        match last.frames.last().state {
            // It cannot be told of a frame that was not seen.
            MotionState::Steady { .. } if last.frames.at() < Some(at) => MotionState::Watching,
            state => state,
        }
    }

    /// What was known of the scene after the frame that was taken and arrived then, by all frames up to it; nothing if they
    /// were not seen in time or before `is_ending`. Build the frame's own scene first: the watch sees it meanwhile.
    pub fn motion_of(
        &self,
        taken_at: Timestamp,
        arrived: Instant,
        is_ending: impl Fn() -> bool,
    ) -> SceneMotion {
        if arrived < self.began {
            return SceneMotion::default();
        }
        let at = since_epoch(taken_at);
        self.seen.up_to(at, is_ending).frames.motion_at(at)
    }
}

impl Seen {
    /// Waits until a frame of this time was seen, or `is_ending`.
    fn up_to(&self, at: Duration, is_ending: impl Fn() -> bool) -> MutexGuard<'_, LastSeen> {
        let asked = Instant::now();
        let mut last = lock(&self.last);
        while !last.is_over
            && last.frames.at() < Some(at)
            && asked.elapsed() < MAX_LAG
            && !is_ending()
        {
            let waited = self.changed.wait_timeout(last, POLL_INTERVAL);
            (last, _) = waited.unwrap_or_else(PoisonError::into_inner);
        }
        last
    }

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
                        look(&mut detector, || scene_from_image(captured.image), at);
                    }
                    let mut last = lock(&self.last);
                    last.frames.add(at, detector.motion());
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

/// Passes a frame to the detector. After a panic it starts anew, so that frames never wait for a dead thread.
fn look(detector: &mut MotionDetector, scene: impl FnOnce() -> SceneCloud, at: Duration) {
    if guarded(|| detector.see(&scene(), at)).is_err() {
        detector.restart();
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

#[cfg(test)]
mod tests {
    use std::cell::Cell;

    use super::*;
    use geometry::rigid::RigidTransform;
    use simulate::{PartKind, SensorNoise, fixtures::HangingPart};
    use stages::scene::scene_from_frame;

    #[test]
    fn a_wait_for_the_watch_ends_when_live_does() {
        let seen = Seen::default();
        let num_asked = Cell::new(0);
        let last = seen.up_to(Duration::from_secs(1), || {
            num_asked.set(num_asked.get() + 1);
            num_asked.get() == 2
        });
        assert!(!last.is_over && last.frames.at().is_none());
        assert_eq!(num_asked.get(), 2);
    }

    #[test]
    fn after_a_panic_the_watch_goes_on_with_another_run() {
        let part = HangingPart::new(PartKind::Fender, 3);
        let mut detector = MotionDetector::new(SteadyParams::default());
        let mut see = |number: u64, fails: bool| {
            let scene = || {
                assert!(!fails, "no scene");
                let noise = SensorNoise::kinect(number);
                scene_from_frame(&part.frame(noise, &RigidTransform::identity()))
            };
            look(&mut detector, scene, Duration::from_secs(number) / 10);
            detector.motion()
        };
        let before = (0..20).fold(SceneMotion::default(), |_, number| see(number, false));
        assert!(before.state.is_steady());
        let failed = see(20, true);
        assert_eq!(failed.state, MotionState::Watching);
        assert_ne!(failed.run, before.run);
        let after = (21..41).fold(failed, |_, number| see(number, false));
        assert!(after.state.is_steady() && after.run != before.run);
    }

    #[test]
    fn a_frame_has_the_state_after_it_and_one_passed_over_that_after_the_next() {
        let seconds = Duration::from_secs_f64;
        let known = |run, state| SceneMotion { state, run };
        let mut frames = SeenFrames::default();
        assert_eq!(frames.motion_at(seconds(0.0)), SceneMotion::default());
        let since = seconds(1.0);
        let still = known(
            1,
            MotionState::Steady {
                since,
                lasting: seconds(1.0),
            },
        );
        let moving = known(2, MotionState::Moving);
        frames.add(seconds(2.0), still);
        frames.add(seconds(2.1), moving);
        // What moves later does not change what was known at that time, and what moved between two frames counts.
        assert_eq!(frames.motion_at(seconds(2.0)), still);
        assert_eq!(frames.motion_at(seconds(2.05)), moving);
        assert_eq!(frames.motion_at(seconds(2.2)), SceneMotion::default());
        assert_eq!(frames.last(), moving);
        // After a clock was set back, nothing from before is taken for a later frame.
        frames.add(seconds(1.9), known(3, MotionState::Watching));
        assert_eq!(frames.motion_at(seconds(1.8)).run, 3);
        assert_eq!(frames.motion_at(seconds(2.0)), SceneMotion::default());
        for number in 0..2 * MAX_REMEMBERED {
            frames.add(seconds(3.0 + number as f64), still);
        }
        assert_eq!(frames.0.len(), MAX_REMEMBERED);
    }
}
