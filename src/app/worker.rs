//! The one thread that works for the window: the newest request wins, and giving up is immediate.
//!
//! A request waits in a slot of one; a newer one replaces it and cancels the one at work. Every request has a
//! generation number that comes back with its news, so that what belongs to an older one is thrown away on arrival.

use std::{
    any::Any,
    panic::{AssertUnwindSafe, catch_unwind},
    sync::{
        Arc, Condvar, Mutex, MutexGuard, PoisonError,
        atomic::{AtomicU64, Ordering},
        mpsc::{Receiver, SyncSender, sync_channel},
    },
    thread::{self, JoinHandle},
};

use crate::pipeline::{ProgressObserver, Stage};

/// Where the work looks whether it is still wanted, and tells how far it is.
pub trait JobContext<T>: ProgressObserver {
    /// So many of so many are done.
    fn progress(&self, done: usize, total: usize);
    /// Hands over what there is so far; the outcome still follows.
    fn publish_partial(&self, outcome: T);
    /// Hands over how things stand now, in the place of what was handed over so before and not fetched yet.
    fn stands(&self, outcome: T);
    /// True if nothing that [`stands`](Self::stands) handed over waits to be fetched: more would be looked at.
    fn wants_more(&self) -> bool;
}

/// What the thread tells the window.
#[derive(Debug)]
pub enum TaskEvent<T> {
    /// A stage begins.
    Begins {
        /// Of which request.
        generation: u64,
        /// The stage.
        stage: Stage,
    },
    /// So many of so many are done.
    Progress {
        /// Of which request.
        generation: u64,
        /// Done.
        done: usize,
        /// In all.
        total: usize,
    },
    /// What there is so far; the work goes on.
    Partly {
        /// Of which request.
        generation: u64,
        /// What there is.
        outcome: T,
    },
    /// The work is done.
    Done {
        /// Of which request.
        generation: u64,
        /// What came out.
        outcome: T,
    },
    /// The work panicked; the thread goes on with the next request.
    Panicked {
        /// Of which request.
        generation: u64,
        /// What the panic said.
        message: String,
    },
}

impl<T> TaskEvent<T> {
    /// Which request it is about.
    pub fn generation(&self) -> u64 {
        match self {
            Self::Begins { generation, .. }
            | Self::Progress { generation, .. }
            | Self::Partly { generation, .. }
            | Self::Done { generation, .. }
            | Self::Panicked { generation, .. } => *generation,
        }
    }
}

/// News that the window has not fetched yet; beyond this many a stage's beginning is not told.
const MAX_NEWS: usize = 32;

/// The thread, its slot and its news. Dropping it cancels the work and waits for the thread.
pub struct Worker<R, T> {
    shared: Arc<Shared<R>>,
    news: Option<Receiver<TaskEvent<T>>>,
    standing: Arc<LatestResult<T>>,
    thread: Option<JoinHandle<()>>,
}

/// How things stand, for whoever fetches it: the newest alone.
type LatestResult<T> = Mutex<Option<(u64, T)>>;

struct Shared<R> {
    slot: Mutex<Slot<R>>,
    filled: Condvar,
    /// Generation of the newest request; a cancelled one is no longer the newest.
    newest: AtomicU64,
}

struct Slot<R> {
    waiting: Option<(u64, R)>,
    is_closed: bool,
}

impl<R: Send + 'static, T: Send + 'static> Worker<R, T> {
    /// Starts the thread. `work` answers a request, or `None` when it was cancelled; `on_news` is called from the
    /// thread whenever there is something to fetch.
    pub fn start(
        name: &str,
        mut work: impl FnMut(R, &dyn JobContext<T>) -> Option<T> + Send + 'static,
        on_news: impl Fn() + Send + 'static,
    ) -> std::io::Result<Self> {
        let shared = Arc::new(Shared {
            slot: Mutex::new(Slot {
                waiting: None,
                is_closed: false,
            }),
            filled: Condvar::new(),
            newest: AtomicU64::new(0),
        });
        let (sender, news) = sync_channel(MAX_NEWS);
        let of_thread = Arc::clone(&shared);
        let standing = Arc::new(Mutex::new(None));
        let told_standing = Arc::clone(&standing);
        let thread = thread::Builder::new().name(name.into()).spawn(move || {
            while let Some((generation, request)) = of_thread.next() {
                let desk = RequestContext {
                    generation,
                    newest: &of_thread.newest,
                    news: &sender,
                    standing: &told_standing,
                    on_news: &on_news,
                };
                // What `work` holds (a loaded library) is only ever replaced whole.
                let answer = catch_unwind(AssertUnwindSafe(|| work(request, &desk)));
                let told = match answer {
                    Ok(Some(outcome)) => TaskEvent::Done {
                        generation,
                        outcome,
                    },
                    Ok(None) => continue,
                    Err(panic) => TaskEvent::Panicked {
                        generation,
                        message: message_of(panic.as_ref()),
                    },
                };
                if sender.send(told).is_err() {
                    return;
                }
                on_news();
            }
        })?;
        Ok(Self {
            shared,
            news: Some(news),
            standing,
            thread: Some(thread),
        })
    }

    /// Asks for work; whatever was asked for before is cancelled. Generations only grow.
    pub fn request(&self, generation: u64, request: R) {
        self.shared.newest.store(generation, Ordering::Relaxed);
        self.shared.slot().waiting = Some((generation, request));
        self.shared.filled.notify_one();
    }

    /// Gives up whatever is waiting or at work.
    pub fn cancel(&self) {
        self.shared.newest.store(0, Ordering::Relaxed);
        self.shared.slot().waiting = None;
    }

    /// The next news, without waiting; `None` when there are none.
    pub fn try_next(&self) -> Option<TaskEvent<T>> {
        // In this order: what stands now is newer than what was told step by step.
        self.news.as_ref()?.try_recv().ok().or_else(|| {
            let (generation, outcome) = held(&self.standing).take()?;
            Some(TaskEvent::Partly {
                generation,
                outcome,
            })
        })
    }
}

impl<R, T> Drop for Worker<R, T> {
    fn drop(&mut self) {
        self.shared.newest.store(0, Ordering::Relaxed);
        self.shared.slot().is_closed = true;
        self.shared.filled.notify_one();
        // A thread that is about to tell something must not wait for a reader.
        self.news = None;
        if let Some(thread) = self.thread.take() {
            // It catches its own panics.
            let _ = thread.join();
        }
    }
}

impl<R> Shared<R> {
    fn slot(&self) -> MutexGuard<'_, Slot<R>> {
        self.slot.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Waits for a request; `None` when the worker closes.
    fn next(&self) -> Option<(u64, R)> {
        let mut slot = self.slot();
        loop {
            if slot.is_closed {
                return None;
            }
            if let Some(job) = slot.waiting.take() {
                return Some(job);
            }
            slot = self
                .filled
                .wait(slot)
                .unwrap_or_else(PoisonError::into_inner);
        }
    }
}

/// Follows one request.
struct RequestContext<'a, T> {
    generation: u64,
    newest: &'a AtomicU64,
    news: &'a SyncSender<TaskEvent<T>>,
    standing: &'a LatestResult<T>,
    on_news: &'a dyn Fn(),
}

impl<T> RequestContext<'_, T> {
    /// A window that is behind misses how far the work is, not what came out.
    fn send_if_room(&self, news: TaskEvent<T>) {
        if self.news.try_send(news).is_ok() {
            (self.on_news)();
        }
    }
}

impl<T> ProgressObserver for RequestContext<'_, T> {
    fn begins(&self, stage: Stage) {
        let generation = self.generation;
        self.send_if_room(TaskEvent::Begins { generation, stage });
    }

    fn is_cancelled(&self) -> bool {
        self.newest.load(Ordering::Relaxed) != self.generation
    }
}

impl<T> JobContext<T> for RequestContext<'_, T> {
    fn progress(&self, done: usize, total: usize) {
        self.send_if_room(TaskEvent::Progress {
            generation: self.generation,
            done,
            total,
        });
    }

    fn publish_partial(&self, outcome: T) {
        let generation = self.generation;
        // Without a reader the window is closing.
        let _ = self.news.send(TaskEvent::Partly {
            generation,
            outcome,
        });
        (self.on_news)();
    }

    fn stands(&self, outcome: T) {
        *held(self.standing) = Some((self.generation, outcome));
        (self.on_news)();
    }

    fn wants_more(&self) -> bool {
        held(self.standing).is_none()
    }
}

fn held<T>(standing: &LatestResult<T>) -> MutexGuard<'_, Option<(u64, T)>> {
    standing.lock().unwrap_or_else(PoisonError::into_inner)
}

fn message_of(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().map(ToString::to_string);
    text.or_else(|| panic.downcast_ref::<String>().cloned())
        .unwrap_or_else(|| "no message".into())
}

#[cfg(test)]
mod tests {
    use std::time::{Duration, Instant};

    use super::*;

    fn wait_for<R: Send + 'static, T: Send + 'static>(worker: &Worker<R, T>) -> TaskEvent<T> {
        let until = Instant::now() + Duration::from_secs(10);
        while Instant::now() < until {
            if let Some(news) = worker.try_next() {
                return news;
            }
            thread::sleep(Duration::from_millis(1));
        }
        panic!("no news within ten seconds");
    }

    #[test]
    fn a_newer_request_cancels_the_one_at_work() {
        let work = |seconds: u64, desk: &dyn JobContext<_>| {
            let until = Instant::now() + Duration::from_secs(seconds);
            while Instant::now() < until {
                if desk.is_cancelled() {
                    return None;
                }
                thread::sleep(Duration::from_millis(1));
            }
            Some(seconds)
        };
        let worker = Worker::start("test", work, || {}).expect("started");
        worker.request(1, 60);
        thread::sleep(Duration::from_millis(20));
        worker.request(2, 60);
        worker.request(3, 0);
        assert!(matches!(
            wait_for(&worker),
            TaskEvent::Done {
                generation: 3,
                outcome: 0
            }
        ));
    }

    #[test]
    fn a_cancelled_request_says_nothing_and_closing_does_not_wait_for_it() {
        let work = |(), desk: &dyn JobContext<_>| {
            while !desk.is_cancelled() {
                thread::sleep(Duration::from_millis(1));
            }
            None::<()>
        };
        let worker = Worker::start("test", work, || {}).expect("started");
        worker.request(1, ());
        thread::sleep(Duration::from_millis(20));
        worker.cancel();
        worker.request(2, ());
        let begun = Instant::now();
        drop(worker);
        assert!(begun.elapsed() < Duration::from_secs(5));
    }

    #[test]
    fn of_how_things_stand_only_the_newest_waits() {
        let (told_all, waits) = (sync_channel::<bool>(1), sync_channel::<()>(1));
        let (tell, go_on) = (told_all.0, waits.1);
        let work = move |num: u32, desk: &dyn JobContext<u32>| {
            (1..=num).for_each(|number| desk.stands(number));
            tell.send(desk.wants_more()).ok()?;
            go_on.recv().ok()?;
            tell.send(desk.wants_more()).ok()?;
            Some(0)
        };
        let worker = Worker::start("test", work, || {}).expect("started");
        worker.request(1, 100);
        assert!(!told_all.1.recv().expect("told"), "nobody has fetched it");
        let stands = wait_for(&worker);
        assert!(matches!(
            stands,
            TaskEvent::Partly {
                generation: 1,
                outcome: 100
            }
        ));
        waits.0.send(()).expect("it waits");
        assert!(told_all.1.recv().expect("told"), "it was fetched");
        assert!(matches!(
            wait_for(&worker),
            TaskEvent::Done { outcome: 0, .. }
        ));
    }

    #[test]
    fn a_panic_is_told_and_the_next_request_is_answered() {
        let work = |number: u32, desk: &dyn JobContext<_>| {
            desk.begins(Stage::Segment);
            assert!(number != 7, "seven is too much");
            Some(number)
        };
        let worker = Worker::start("test", work, || {}).expect("started");
        worker.request(1, 7);
        assert!(matches!(
            wait_for(&worker),
            TaskEvent::Begins { generation: 1, .. }
        ));
        let TaskEvent::Panicked { message, .. } = wait_for(&worker) else {
            panic!("the panic was not told");
        };
        assert!(message.contains("seven"));
        worker.request(2, 8);
        assert!(matches!(
            wait_for(&worker),
            TaskEvent::Begins { generation: 2, .. }
        ));
        assert!(matches!(
            wait_for(&worker),
            TaskEvent::Done {
                generation: 2,
                outcome: 8
            }
        ));
    }
}
