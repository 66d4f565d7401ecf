//! The camera's thread: opens a source, takes its captures, recovers it when it is lost, and stops on request.

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

/// A source running on a thread of its own. Dropping it stops the thread and joins it.
pub struct Feed {
    slot: Arc<Slot>,
    thread: Option<JoinHandle<()>>,
}

/// What happens to a capture that nobody has taken when the next one arrives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BackpressurePolicy {
    /// It is dropped and counted: nobody gets a capture older than the camera's last frame.
    Newest,
    /// The next one waits: every capture is delivered, in order.
    Every,
}

impl BackpressurePolicy {
    /// The policy for a source: a live camera's frames may be dropped, those of recordings and files may not.
    pub fn for_source(spec: &SourceSpec) -> Self {
        if spec.is_live() {
            Self::Newest
        } else {
            Self::Every
        }
    }
}

/// An item delivered by a feed.
#[derive(Clone, Debug)]
#[expect(
    clippy::large_enum_variant,
    reason = "nearly all are captures, each moved once"
)]
pub enum FeedItem {
    /// A capture.
    Captured(Captured),
    /// Something that should have been a capture and cannot be read.
    Skipped(SkippedCapture),
}

/// Status of a feed.
#[derive(Clone, Debug, Default)]
pub struct FeedStatus {
    /// What the feed is doing.
    pub state: FeedState,
    /// Title of the source, once it is open.
    pub title: Option<String>,
    /// Whether its captures are simulated, once it is open.
    pub is_simulated: Option<bool>,
    /// Number of captures that were dropped for a newer one.
    pub num_dropped: u64,
    /// Number of things that could not be read.
    pub num_skipped: u64,
    /// Captures per second at present.
    pub rate: Option<f64>,
}

/// State of a feed.
#[derive(Clone, Debug, Default)]
pub enum FeedState {
    /// The source is being opened.
    #[default]
    Opening,
    /// Captures arrive.
    Running,
    /// The source was lost, or is not there yet; recovery is automatic.
    Lost {
        /// The underlying error.
        error: Arc<CaptureError>,
    },
    /// The source has no more captures.
    Ended,
    /// The source cannot be used until a person intervenes.
    Failed(Arc<CaptureError>),
    /// The feed has stopped on request.
    Stopped,
}

impl FeedState {
    /// True once the thread will do nothing more. Earlier captures can still be taken.
    pub fn is_over(&self) -> bool {
        matches!(self, Self::Ended | Self::Failed(_) | Self::Stopped)
    }
}

/// How long the thread waits for a capture before it checks whether to stop.
const MAX_WAIT: Duration = Duration::from_millis(50);
/// Pause before the first retry; each further pause is twice as long.
const MIN_RETRY_PAUSE: Duration = Duration::from_millis(250);
/// The longest pause: a camera that is plugged in again is back within this time.
const MAX_RETRY_PAUSE: Duration = Duration::from_secs(4);

impl Feed {
    /// Opens a source on a thread of its own. `on_news` is called on that thread after every change of state and every
    /// capture; it should do little, such as requesting a repaint.
    pub fn start(
        spec: SourceSpec,
        delivery: BackpressurePolicy,
        on_news: impl Fn() + Send + Sync + 'static,
    ) -> Result<Self, CaptureError> {
        Self::start_with(move || open::open(&spec), delivery, on_news)
    }

    /// As [`Feed::start`], with a custom way to open the source.
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
                    retry: MIN_RETRY_PAUSE,
                }
                .run(&mut open);
            })
            .map_err(|source| CaptureError::NoThread { source })?;
        Ok(Self {
            slot,
            thread: Some(thread),
        })
    }

    /// Returns another feed of the same source that takes nothing from this one: it keeps the newest of the captures from
    /// now on. It does not keep the source open, and ends with this feed.
    #[must_use]
    pub fn tap(&self) -> Self {
        Self {
            slot: self.slot.tap(),
            thread: None,
        }
    }

    /// A feed that has failed with this error.
    pub fn failed(error: CaptureError) -> Self {
        let slot = Slot::new(BackpressurePolicy::Newest, Box::new(|| ()));
        slot.set_state(FeedState::Failed(Arc::new(error)));
        Self {
            slot: Arc::new(slot),
            thread: None,
        }
    }

    /// Waits for the next item; `None` after `at_most`, or as soon as nothing more will come.
    pub fn wait(&self, at_most: Duration) -> Option<FeedItem> {
        self.slot.take(at_most)
    }

    /// The present status.
    pub fn status(&self) -> FeedStatus {
        self.slot.status()
    }

    /// Tells the feed to stop and returns at once. [`FeedState::Stopped`] follows when the camera is closed; after that,
    /// dropping the feed does not block.
    pub fn stop(&self) {
        self.slot.stop();
    }
}

impl Drop for Feed {
    fn drop(&mut self) {
        self.slot.stop();
        if let Some(thread) = self.thread.take() {
            // A panic of the thread is already reported as the state.
            let _ = thread.join();
        }
    }
}

/// The state of the thread.
struct Camera<'a> {
    slot: &'a Slot,
    retry: Duration,
}

/// Why the thread leaves a source.
enum StopReason {
    /// The feed ends in this state.
    Over(FeedState),
    /// The source has to be opened again.
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

    /// Delivers captures of the source until it is lost, ends or is to stop.
    fn follow(&mut self, source: &mut dyn DepthSource) -> Option<StopReason> {
        while !self.slot.is_stopping() {
            match source.next(MAX_WAIT) {
                Ok(NextCapture::NotYet) => self.slot.set_running(),
                Ok(NextCapture::End) => return Some(StopReason::Over(FeedState::Ended)),
                Ok(NextCapture::Captured(captured)) => {
                    self.retry = MIN_RETRY_PAUSE;
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

    /// Waits until it is time to retry; `None` if the same source can be queried again.
    fn pause(&mut self, error: CaptureError) -> Option<StopReason> {
        let recovery = error.recovery();
        let error = Arc::new(error);
        if recovery == Recovery::None {
            return Some(StopReason::Over(FeedState::Failed(error)));
        }
        self.slot.set_state(FeedState::Lost { error });
        self.slot.sleep(self.retry);
        self.retry = (2 * self.retry).min(MAX_RETRY_PAUSE);
        (recovery == Recovery::Reopen).then_some(StopReason::ToReopen)
    }
}
