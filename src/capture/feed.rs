//! The camera's thread: opens a source, takes its captures, finds it again when it is lost, stops when told to.

mod slot;
#[cfg(test)]
mod tests;

use std::{
    sync::Arc,
    thread::{self, JoinHandle},
    time::Duration,
};

use self::slot::Slot;
use super::{
    error::{CaptureError, Recovery},
    open,
    source::{Captured, DepthSource, NextCapture, SkippedCapture},
    spec::SourceSpec,
};

/// A source at work on a thread of its own. Dropped, it stops and waits for the thread.
pub struct Feed {
    slot: Arc<Slot>,
    thread: Option<JoinHandle<()>>,
}

/// What becomes of a capture that nobody has taken when the next one comes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BackpressurePolicy {
    /// It is dropped and counted: what is looked at is never older than the camera's last frame.
    Newest,
    /// The next one waits: every capture is looked at, in order.
    Every,
}

impl BackpressurePolicy {
    /// What suits a source: a live camera's frames are dropped, those of recordings and files are not.
    pub fn for_source(spec: &SourceSpec) -> Self {
        if spec.is_live() {
            Self::Newest
        } else {
            Self::Every
        }
    }
}

/// What a feed hands over.
#[derive(Clone, Debug)]
#[expect(
    clippy::large_enum_variant,
    reason = "nearly all are captures, each moved once"
)]
pub enum FeedItem {
    /// A capture.
    Captured(Captured),
    /// Something that was meant to be a capture and cannot be read.
    Skipped(SkippedCapture),
}

/// How a feed is.
#[derive(Clone, Debug)]
pub struct FeedStatus {
    /// What it does.
    pub state: FeedState,
    /// What a person calls the source, once it is open.
    pub title: Option<String>,
    /// Whether what it gives is simulated, once it is open.
    pub is_simulated: Option<bool>,
    /// Captures that the source has given.
    pub num_captured: u64,
    /// Captures among them that were dropped for a newer one.
    pub num_dropped: u64,
    /// Things that could not be read.
    pub num_skipped: u64,
    /// Captures a second that the source gives now.
    pub rate: Option<f64>,
}

/// What a feed does.
#[derive(Clone, Debug)]
pub enum FeedState {
    /// The source is being opened.
    Opening,
    /// Captures come.
    Running,
    /// The source was there, or may come; it is looked for again by itself.
    Lost {
        /// Why there is nothing.
        error: Arc<CaptureError>,
    },
    /// The source has no more.
    Ended,
    /// The source cannot be used until somebody has done something about it.
    Failed(Arc<CaptureError>),
    /// It was told to stop, and has.
    Stopped,
}

impl FeedState {
    /// True once the thread will do nothing more. What was captured before can still be taken.
    pub fn is_over(&self) -> bool {
        matches!(self, Self::Ended | Self::Failed(_) | Self::Stopped)
    }
}

/// A source waits so long for a capture before it is looked whether to stop.
const TURN: Duration = Duration::from_millis(50);
/// The pause before the first retry; each following one is twice as long.
const FIRST_RETRY: Duration = Duration::from_millis(250);
/// The longest pause: a camera that is plugged in again is there within this time.
const LONGEST_RETRY: Duration = Duration::from_secs(4);

impl Feed {
    /// Opens a source on a thread of its own. `on_news` is called from there after every change of state and every
    /// capture; it should do little, such as asking a window to draw.
    pub fn start(
        spec: SourceSpec,
        delivery: BackpressurePolicy,
        on_news: impl Fn() + Send + Sync + 'static,
    ) -> Result<Self, CaptureError> {
        Self::start_with(move || open::open(&spec), delivery, on_news)
    }

    /// As [`Feed::start`], with another way to open the source.
    pub fn start_with(
        mut open: impl FnMut() -> Result<Box<dyn DepthSource>, CaptureError> + Send + 'static,
        delivery: BackpressurePolicy,
        on_news: impl Fn() + Send + Sync + 'static,
    ) -> Result<Self, CaptureError> {
        let slot = Arc::new(Slot::new(delivery, Box::new(on_news)));
        let theirs = Arc::clone(&slot);
        let thread = thread::Builder::new()
            .name("camera".into())
            .spawn(move || {
                Camera {
                    slot: &theirs,
                    retry: FIRST_RETRY,
                }
                .run(&mut open);
            })
            .map_err(|source| CaptureError::NoThread { source })?;
        Ok(Self {
            slot,
            thread: Some(thread),
        })
    }

    /// Another feed of the same source, which takes nothing away from this one: of what comes from now on it keeps the
    /// newest. It does not keep the source open, and is over once this one is.
    #[must_use]
    pub fn tap(&self) -> Self {
        Self {
            slot: self.slot.tap(),
            thread: None,
        }
    }

    /// A feed that has failed for this reason.
    pub fn failed(error: CaptureError) -> Self {
        let slot = Slot::new(BackpressurePolicy::Newest, Box::new(|| ()));
        slot.set_state(FeedState::Failed(Arc::new(error)));
        Self {
            slot: Arc::new(slot),
            thread: None,
        }
    }

    /// What came since it was asked last, waiting for it; `None` after `at_most`, or as soon as nothing will come any
    /// more.
    pub fn wait(&self, at_most: Duration) -> Option<FeedItem> {
        self.slot.take(at_most)
    }

    /// How it is.
    pub fn status(&self) -> FeedStatus {
        self.slot.status()
    }

    /// Tells it to stop; returns at once. [`FeedState::Stopped`] follows when the camera is closed, and dropping the
    /// feed does not wait any more then.
    pub fn stop(&self) {
        self.slot.stop();
    }
}

impl Drop for Feed {
    fn drop(&mut self) {
        self.slot.stop();
        if let Some(thread) = self.thread.take() {
            // A fault of the thread has been reported as the state already.
            let _ = thread.join();
        }
    }
}

/// What runs on the thread.
struct Camera<'a> {
    slot: &'a Slot,
    retry: Duration,
}

/// Why the thread leaves a source.
enum StopReason {
    /// For good.
    Over(FeedState),
    /// To open it anew.
    ToReopen,
}

impl Camera<'_> {
    fn run(mut self, open: &mut dyn FnMut() -> Result<Box<dyn DepthSource>, CaptureError>) {
        let _guard = self.slot.guard();
        loop {
            if self.slot.is_stopping() {
                return self.slot.set_state(FeedState::Stopped);
            }
            let left = match open() {
                Ok(mut source) => {
                    self.slot.opened(source.title(), source.is_simulated());
                    self.follow(source.as_mut())
                }
                Err(error) => self.pause(error),
            };
            match left {
                Some(StopReason::Over(state)) => return self.slot.set_state(state),
                Some(StopReason::ToReopen) | None => {}
            }
        }
    }

    /// Takes what the source gives until it is lost, over, or no longer wanted.
    fn follow(&mut self, source: &mut dyn DepthSource) -> Option<StopReason> {
        while !self.slot.is_stopping() {
            match source.next(TURN) {
                Ok(NextCapture::NotYet) => self.slot.set_running(),
                Ok(NextCapture::End) => return Some(StopReason::Over(FeedState::Ended)),
                Ok(NextCapture::Captured(captured)) => {
                    self.retry = FIRST_RETRY;
                    self.slot.set_running();
                    self.slot.put(FeedItem::Captured(captured));
                }
                Ok(NextCapture::Skipped(skipped)) => {
                    self.slot.set_running();
                    self.slot.put(FeedItem::Skipped(skipped));
                }
                Err(error) => {
                    if let Some(left) = self.pause(error) {
                        return Some(left);
                    }
                }
            }
        }
        None
    }

    /// Waits until it is time to try again; `None` if the same source can be asked.
    fn pause(&mut self, error: CaptureError) -> Option<StopReason> {
        let recovery = error.recovery();
        let error = Arc::new(error);
        if recovery == Recovery::None {
            return Some(StopReason::Over(FeedState::Failed(error)));
        }
        self.slot.lost(error);
        self.slot.sleep(self.retry);
        self.retry = (2 * self.retry).min(LONGEST_RETRY);
        (recovery == Recovery::Reopen).then_some(StopReason::ToReopen)
    }
}
