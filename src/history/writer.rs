//! The thread that writes the history, so that no inspection waits for the disk.

use std::{
    io,
    sync::{
        Arc,
        atomic::{AtomicUsize, Ordering},
        mpsc::{Receiver, RecvTimeoutError, Sender, SyncSender, channel, sync_channel},
    },
    thread::{self, JoinHandle},
    time::Instant,
};

use super::{buffer::HistoryBuffer, entry::NewEntry, retention::Retention};
use crate::library::Truth;

/// Inspections whose scenes wait for the thread at most, 4 MB each; beyond that their frames are not kept.
const MAX_SCENES: usize = 8;
/// Inspections that wait for the thread at most; beyond that they are lost, and counted.
const MAX_INSPECTIONS: usize = 4096;

/// Something to be written.
#[derive(Debug)]
enum Job {
    Add(u64, Box<NewEntry>),
    Remark(i64, String),
    Label(i64, Option<Truth>),
    Retention(Retention),
    /// Answers once all before it is done.
    Answer(SyncSender<()>),
}

/// The thread. Dropping it waits until all is written that was handed over.
#[derive(Debug)]
pub struct Writer {
    /// `None` while it is dropped: the thread ends once it has done all that was sent.
    jobs: Option<Sender<Job>>,
    counts: Arc<Counts>,
    thread: Option<JoinHandle<()>>,
}

#[derive(Debug, Default)]
struct Counts {
    /// Inspections that wait for the thread.
    waiting: AtomicUsize,
    /// Those of them whose scene waits with them.
    scenes: AtomicUsize,
    /// Inspections whose frame was not kept, because the disk is too slow.
    bare: AtomicUsize,
    /// Inspections that were lost for the same reason.
    lost: AtomicUsize,
}

impl Writer {
    /// Starts the thread, which opens the history; `on_news` is called from it whenever the keeper may have news.
    pub fn start(
        keeper: Arc<HistoryBuffer>,
        on_news: impl Fn() + Send + 'static,
    ) -> io::Result<Self> {
        let (jobs, received) = channel();
        let counts = Arc::<Counts>::default();
        let of_thread = Arc::clone(&counts);
        let thread = thread::Builder::new()
            .name("history".into())
            .spawn(move || {
                keeper.open(Instant::now());
                on_news();
                loop {
                    match next(&received, &keeper) {
                        Ok(job) => work(&keeper, job, &of_thread),
                        Err(RecvTimeoutError::Timeout) => keeper.retry(Instant::now()),
                        Err(RecvTimeoutError::Disconnected) => break,
                    }
                    on_news();
                }
            })?;
        Ok(Self {
            jobs: Some(jobs),
            counts,
            thread: Some(thread),
        })
    }

    /// Has an inspection written. Never waits.
    pub fn add(&self, ticket: u64, mut entry: NewEntry) {
        let counts = &self.counts;
        if entry.scene.is_some() && counts.scenes.load(Ordering::Relaxed) >= MAX_SCENES {
            entry.drop_frames();
            counts.bare.fetch_add(1, Ordering::Relaxed);
        }
        if counts.waiting.load(Ordering::Relaxed) >= MAX_INSPECTIONS {
            counts.lost.fetch_add(1, Ordering::Relaxed);
            return;
        }
        counts.waiting.fetch_add(1, Ordering::Relaxed);
        let num_scenes = usize::from(entry.scene.is_some());
        counts.scenes.fetch_add(num_scenes, Ordering::Relaxed);
        self.post(Job::Add(ticket, Box::new(entry)));
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
        if let Some(jobs) = &self.jobs {
            // Only a thread that panicked does not receive it.
            let _ = jobs.send(job);
        }
    }

    /// Waits until all is written that was handed over.
    pub fn finish(&self) {
        let (answer, answered) = sync_channel(1);
        self.post(Job::Answer(answer));
        let _ = answered.recv();
    }

    /// How many inspections' frames were not kept, and how many inspections were lost, because the disk was too slow;
    /// counted since this was asked last.
    pub fn take_dropped(&self) -> [usize; 2] {
        let Counts { bare, lost, .. } = self.counts.as_ref();
        [bare, lost].map(|count| count.swap(0, Ordering::Relaxed))
    }
}

impl Drop for Writer {
    fn drop(&mut self) {
        self.jobs = None;
        if let Some(thread) = self.thread.take() {
            // What it panicked with was said on its own thread.
            let _ = thread.join();
        }
    }
}

/// Waits for a job, at most until what failed is to be tried again.
fn next(received: &Receiver<Job>, keeper: &HistoryBuffer) -> Result<Job, RecvTimeoutError> {
    match keeper.next_try() {
        Some(at) => received.recv_timeout(at.saturating_duration_since(Instant::now())),
        None => Ok(received.recv()?),
    }
}

fn work(keeper: &HistoryBuffer, job: Job, counts: &Counts) {
    match job {
        Job::Add(ticket, entry) => {
            let num_scenes = usize::from(entry.scene.is_some());
            counts.waiting.fetch_sub(1, Ordering::Relaxed);
            counts.scenes.fetch_sub(num_scenes, Ordering::Relaxed);
            keeper.add(ticket, *entry, Instant::now());
        }
        Job::Remark(number, remark) => keeper.set_remark(number, &remark),
        Job::Label(number, label) => keeper.set_label(number, label.as_ref()),
        Job::Retention(retention) => keeper.set_retention(retention),
        // Whoever asked may have gone.
        Job::Answer(answer) => drop(answer.send(())),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        history::{Filter, StoredVerdict},
        kit::{history_entry, small_scene},
    };

    #[test]
    fn what_waits_is_written_and_what_is_too_much_without_its_frame() {
        let keeper = Arc::new(HistoryBuffer::new(None));
        let (go_on, is_held) = channel::<()>();
        // The thread stops here once it has opened the history: until then everything waits.
        let hold = move || {
            let _ = is_held.recv();
        };
        let writer = Writer::start(Arc::clone(&keeper), hold).expect("a thread");
        for ticket in 1..=10 {
            let mut waiting = history_entry(ticket as i64, StoredVerdict::NotAccepted, "fender");
            waiting.scene = Some(small_scene(1));
            writer.add(ticket, waiting);
        }
        drop(go_on);
        writer.finish();
        assert_eq!(writer.take_dropped(), [2, 0]);
        assert_eq!(writer.take_dropped(), [0, 0]);
        let page = keeper.page(&Filter::default(), 0, 100).expect("asked");
        assert_eq!(page.rows.len(), 10);
    }
}
