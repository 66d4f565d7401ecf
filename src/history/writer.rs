//! The thread that writes the history, so that no inspection waits for the disk.

use std::{
    collections::VecDeque,
    io,
    sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError},
    thread::{self, JoinHandle},
    time::Instant,
};

use super::{buffer::HistoryBuffer, entry::NewEntry, retention::Retention};
use crate::library::Truth;

/// Inspections whose scenes wait for the thread at most, 4 MB each; beyond that their frames are not kept.
const MAX_SCENES: usize = 8;
/// Inspections that wait for the thread at most; beyond that they are lost, and counted.
const MAX_JOBS: usize = 4096;

/// Something to be written.
#[derive(Debug)]
enum Job {
    Add(u64, Box<NewEntry>),
    Remark(i64, String),
    Label(i64, Option<Truth>),
    Retention(Retention),
}

/// The thread. Dropping it waits until all is written that was handed over.
#[derive(Debug)]
pub struct Writer {
    queue: Arc<Queue>,
    thread: Option<JoinHandle<()>>,
}

#[derive(Debug, Default)]
struct Queue {
    jobs: Mutex<Jobs>,
    filled: Condvar,
    emptied: Condvar,
}

#[derive(Debug, Default)]
struct Jobs {
    waiting: VecDeque<Job>,
    is_busy: bool,
    is_closed: bool,
    /// Inspections whose frame was not kept, and that were lost: the disk is too slow.
    num_crowded: [usize; 2],
}

impl Writer {
    /// Starts the thread, which opens the history; `on_news` is called from it whenever the keeper may have news.
    pub fn start(
        keeper: Arc<HistoryBuffer>,
        on_news: impl Fn() + Send + 'static,
    ) -> io::Result<Self> {
        let queue = Arc::<Queue>::default();
        // Busy from the beginning: whoever waits for it waits until it is open.
        queue.lock().is_busy = true;
        let of_thread = Arc::clone(&queue);
        let thread = thread::Builder::new()
            .name("history".into())
            .spawn(move || {
                keeper.open(Instant::now());
                on_news();
                while let Some(job) = of_thread.next(&keeper, &on_news) {
                    work(&keeper, job);
                    on_news();
                }
            })?;
        Ok(Self {
            queue,
            thread: Some(thread),
        })
    }

    /// Has an inspection written. Never waits.
    pub fn add(&self, ticket: u64, mut entry: NewEntry) {
        let mut jobs = self.queue.lock();
        let has_scene = |job: &&Job| matches!(job, Job::Add(_, entry) if entry.scene.is_some());
        if jobs.waiting.iter().filter(has_scene).count() >= MAX_SCENES {
            entry.drop_frames();
            jobs.num_crowded[0] += 1;
        }
        if jobs.waiting.len() >= MAX_JOBS {
            jobs.num_crowded[1] += 1;
            return;
        }
        jobs.waiting.push_back(Job::Add(ticket, Box::new(entry)));
        self.queue.filled.notify_one();
    }

    /// Has written down what a person remarks.
    pub fn remark(&self, number: i64, remark: String) {
        self.post(Job::Remark(number, remark));
    }

    /// Has written down what it truly is, or that nobody knows.
    pub fn label(&self, number: i64, label: Option<Truth>) {
        self.post(Job::Label(number, label));
    }

    /// Keeps frames by this rule from now on.
    pub fn retention(&self, retention: Retention) {
        self.post(Job::Retention(retention));
    }

    fn post(&self, job: Job) {
        self.queue.lock().waiting.push_back(job);
        self.queue.filled.notify_one();
    }

    /// Waits until all is written that was handed over.
    pub fn finish(&self) {
        let mut jobs = self.queue.lock();
        while jobs.is_busy || !jobs.waiting.is_empty() {
            jobs = self
                .queue
                .emptied
                .wait(jobs)
                .unwrap_or_else(PoisonError::into_inner);
        }
    }

    /// How many inspections' frames were not kept, and how many inspections were lost, because the disk was too slow;
    /// counted since this was asked last.
    pub fn take_dropped(&self) -> [usize; 2] {
        std::mem::take(&mut self.queue.lock().num_crowded)
    }
}

impl Drop for Writer {
    fn drop(&mut self) {
        self.queue.lock().is_closed = true;
        self.queue.filled.notify_one();
        if let Some(thread) = self.thread.take() {
            // What it panicked with was said on its own thread.
            let _ = thread.join();
        }
    }
}

impl Queue {
    fn lock(&self) -> MutexGuard<'_, Jobs> {
        self.jobs.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Waits for a job, and meanwhile tries again what failed; `None` once it is closed and all is done.
    fn next(&self, keeper: &HistoryBuffer, on_news: &dyn Fn()) -> Option<Job> {
        let mut jobs = self.lock();
        jobs.is_busy = false;
        loop {
            if let Some(job) = jobs.waiting.pop_front() {
                jobs.is_busy = true;
                return Some(job);
            }
            self.emptied.notify_all();
            if jobs.is_closed {
                return None;
            }
            drop(jobs);
            // Not under the lock of the queue: whoever hands something over never waits for the disk.
            let next_try = keeper.next_try();
            jobs = self.lock();
            if !jobs.waiting.is_empty() || jobs.is_closed {
                continue;
            }
            let Some(at) = next_try else {
                jobs = self
                    .filled
                    .wait(jobs)
                    .unwrap_or_else(PoisonError::into_inner);
                continue;
            };
            let left = at.saturating_duration_since(Instant::now());
            let waited = self.filled.wait_timeout(jobs, left);
            let (guard, over) = waited.unwrap_or_else(PoisonError::into_inner);
            if over.timed_out() {
                drop(guard);
                keeper.retry(Instant::now());
                on_news();
                jobs = self.lock();
            } else {
                jobs = guard;
            }
        }
    }
}

fn work(keeper: &HistoryBuffer, job: Job) {
    match job {
        Job::Add(ticket, entry) => keeper.add(ticket, *entry, Instant::now()),
        Job::Remark(number, remark) => keeper.set_remark(number, &remark),
        Job::Label(number, label) => keeper.set_label(number, label.as_ref()),
        Job::Retention(retention) => keeper.set_retention(retention),
    }
}
