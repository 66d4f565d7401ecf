//! State shared by the camera's thread and the feed: items not yet taken, and the status.

use std::{
    collections::VecDeque,
    sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError, Weak},
    thread,
    time::{Duration, Instant},
};

use super::{BackpressurePolicy, FeedItem, FeedState, FeedStatus};
use crate::{error::CaptureError, rate::FrameRate};
use geometry::error::lock;

/// Maximum number of waiting notes about unreadable things; the oldest are dropped first.
const MAX_SKIPPED: usize = 64;

pub(super) struct Slot {
    delivery: BackpressurePolicy,
    on_news: Box<dyn Fn() + Send + Sync>,
    inner: Mutex<Inner>,
    /// Signals that an item was put or taken, or the state changed.
    changed: Condvar,
}

#[derive(Default)]
struct Inner {
    /// At most one capture, and notes about unreadable things.
    waiting: VecDeque<FeedItem>,
    is_stopping: bool,
    status: FeedStatus,
    rate: FrameRate,
    /// Slots that receive everything this one receives.
    taps: Vec<Weak<Slot>>,
}

impl Inner {
    fn taps(&self) -> impl Iterator<Item = Arc<Slot>> {
        self.taps.iter().filter_map(Weak::upgrade)
    }
}

impl Slot {
    pub(super) fn new(delivery: BackpressurePolicy, on_news: Box<dyn Fn() + Send + Sync>) -> Self {
        Self {
            delivery,
            on_news,
            inner: Mutex::default(),
            changed: Condvar::new(),
        }
    }

    /// Nothing panics while the lock is held, so the data are consistent even if it is poisoned.
    fn lock(&self) -> MutexGuard<'_, Inner> {
        lock(&self.inner)
    }

    fn tell(&self) {
        self.changed.notify_all();
        (self.on_news)();
    }

    // Calls of the feed's owner.

    pub(super) fn take(&self, at_most: Duration) -> Option<FeedItem> {
        let inner = self.lock();
        let (mut inner, _) = self
            .changed
            .wait_timeout_while(inner, at_most, |inner| {
                inner.waiting.is_empty() && !inner.status.state.is_over()
            })
            .unwrap_or_else(PoisonError::into_inner);
        let item = inner.waiting.pop_front();
        self.changed.notify_all();
        item
    }

    pub(super) fn status(&self) -> FeedStatus {
        let inner = self.lock();
        FeedStatus {
            rate: inner.rate.per_second(Instant::now()),
            ..inner.status.clone()
        }
    }

    pub(super) fn stop(&self) {
        self.lock().is_stopping = true;
        self.changed.notify_all();
    }

    /// Returns another slot, which receives what this one receives from now on and keeps the newest.
    pub(super) fn tap(&self) -> Arc<Self> {
        let tap = Arc::new(Self::new(BackpressurePolicy::Newest, Box::new(|| ())));
        let mut inner = self.lock();
        {
            // This lock cannot block: no other thread has the tap yet.
            let mut theirs = tap.lock();
            theirs.status.state = inner.status.state.clone();
            theirs.status.title.clone_from(&inner.status.title);
            theirs.status.is_simulated = inner.status.is_simulated;
        }
        inner.taps.retain(|known| known.strong_count() > 0);
        inner.taps.push(Arc::downgrade(&tap));
        drop(inner);
        tap
    }

    // Calls of the camera's thread. A slot is locked before its taps.

    pub(super) fn is_stopping(&self) -> bool {
        self.lock().is_stopping
    }

    pub(super) fn opened(&self, title: String, is_simulated: bool) {
        let mut inner = self.lock();
        for tap in inner.taps() {
            tap.opened(title.clone(), is_simulated);
        }
        inner.status.title = Some(title);
        inner.status.is_simulated = Some(is_simulated);
    }

    pub(super) fn set_running(&self) {
        if !matches!(self.lock().status.state, FeedState::Running) {
            self.set_state(FeedState::Running);
        }
    }

    pub(super) fn set_state(&self, state: FeedState) {
        let mut inner = self.lock();
        for tap in inner.taps() {
            tap.set_state(state.clone());
        }
        inner.status.state = state;
        drop(inner);
        self.tell();
    }

    /// Delivers an item. With [`BackpressurePolicy::Every`], waits until the previous one was taken or the feed is
    /// stopping.
    pub(super) fn put(&self, item: FeedItem) {
        let mut inner = self.lock();
        for tap in inner.taps() {
            tap.put(item.clone());
        }
        match &item {
            FeedItem::Captured(captured) => {
                inner.rate.came(captured.arrived);
                if self.delivery == BackpressurePolicy::Newest {
                    let before = inner.waiting.len();
                    inner
                        .waiting
                        .retain(|item| matches!(item, FeedItem::Skipped(_)));
                    inner.status.num_dropped += (before - inner.waiting.len()) as u64;
                }
            }
            FeedItem::Skipped(_) => inner.status.num_skipped += 1,
        }
        match self.delivery {
            BackpressurePolicy::Newest if inner.waiting.len() > MAX_SKIPPED => {
                inner.waiting.pop_front();
            }
            BackpressurePolicy::Newest => {}
            BackpressurePolicy::Every => {
                inner = self
                    .changed
                    .wait_while(inner, |inner| {
                        !inner.waiting.is_empty() && !inner.is_stopping
                    })
                    .unwrap_or_else(PoisonError::into_inner);
            }
        }
        if !inner.is_stopping {
            inner.waiting.push_back(item);
        }
        drop(inner);
        self.tell();
    }

    /// Waits for a time, or until a stop is requested.
    pub(super) fn sleep(&self, time: Duration) {
        let inner = self.lock();
        drop(
            self.changed
                .wait_timeout_while(inner, time, |inner| !inner.is_stopping),
        );
    }

    /// Returns a guard that, dropped by a panic of the thread, reports it as the state.
    pub(super) fn guard(&self) -> Guard<'_> {
        Guard { slot: self }
    }
}

pub(super) struct Guard<'a> {
    slot: &'a Slot,
}

impl Drop for Guard<'_> {
    fn drop(&mut self) {
        if thread::panicking() {
            self.slot
                .set_state(FeedState::Failed(Arc::new(CaptureError::Crashed)));
        }
    }
}
