//! The thread that writes the history, so that no inspection waits for the disk.

use std::{
    io,
    sync::{
        Arc,
        atomic::{AtomicUsize, Ordering},
        mpsc::{Receiver, RecvTimeoutError, Sender, channel, sync_channel},
    },
    thread::{self, JoinHandle},
    time::Instant,
};

use super::{
    buffer::HistoryBuffer,
    entry::{NewEntry, StoredVerdict},
    frames::FrameLoss,
    hung::HungId,
    retention::Retention,
    servo_run::ServoRecord,
    traceability::TraceChange,
};
use inspection::library::Truth;

/// Maximum number of inspections queued with their scenes, 4 MB each; beyond it frames are not kept.
const MAX_SCENES: usize = 8;
/// Maximum number of queued inspections; beyond it they are dropped and counted.
const MAX_INSPECTIONS: usize = 4096;

/// Work for the thread.
type Job = Box<dyn FnOnce(&HistoryBuffer) + Send>;

/// The writing thread. Dropping it waits until everything passed to it is written, or a last attempt has failed.
#[derive(Debug)]
pub struct Writer {
    /// `None` while dropping: the thread ends once it has done all its jobs.
    jobs: Option<Sender<Job>>,
    counts: Arc<Counts>,
    thread: Option<JoinHandle<()>>,
}

#[derive(Debug, Default)]
struct Counts {
    /// Queued inspections.
    waiting: AtomicUsize,
    /// Queued inspections that still have their scene.
    scenes: AtomicUsize,
    /// Inspections whose frame was not kept because the disk is too slow.
    bare: AtomicUsize,
    /// Inspections that were lost because the disk is too slow.
    lost: AtomicUsize,
}

impl Writer {
    /// Starts the thread, which opens the history and calls `on_news` whenever the buffer may have new events.
    pub fn start(
        keeper: Arc<HistoryBuffer>,
        on_news: impl Fn() + Send + 'static,
    ) -> io::Result<Self> {
        let (jobs, received) = channel();
        let counts = Arc::<Counts>::default();
        let thread = thread::Builder::new()
            .name("history".into())
            .spawn(move || {
                keeper.open(Instant::now());
                on_news();
                loop {
                    match next(&received, &keeper) {
                        Ok(job) => job(keeper.as_ref()),
                        Err(RecvTimeoutError::Timeout) => keeper.retry(Instant::now()),
                        Err(RecvTimeoutError::Disconnected) => {
                            keeper.retry_now();
                            break;
                        }
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

    /// Queues an inspection. Never waits.
    pub fn add(&self, ticket: u64, mut entry: NewEntry) {
        let counts = &self.counts;
        // Half of the room is for what is not accepted.
        let is_accepted = entry.record.summary.verdict == StoredVerdict::Accepted;
        let most = if is_accepted {
            MAX_SCENES / 2
        } else {
            MAX_SCENES
        };
        if entry.scene.is_some() && counts.scenes.load(Ordering::Relaxed) >= most {
            entry.drop_frames(Some(FrameLoss::SlowDisk));
            counts.bare.fetch_add(1, Ordering::Relaxed);
        }
        if counts.waiting.load(Ordering::Relaxed) >= MAX_INSPECTIONS {
            counts.lost.fetch_add(1, Ordering::Relaxed);
            return;
        }
        counts.waiting.fetch_add(1, Ordering::Relaxed);
        let num_scenes = usize::from(entry.scene.is_some());
        counts.scenes.fetch_add(num_scenes, Ordering::Relaxed);
        let counts = Arc::clone(counts);
        self.post(move |keeper| {
            counts.waiting.fetch_sub(1, Ordering::Relaxed);
            counts.scenes.fetch_sub(num_scenes, Ordering::Relaxed);
            keeper.add(ticket, entry, Instant::now());
        });
    }

    /// Queues a run of servoing. Never waits.
    pub fn add_servo_run(&self, record: ServoRecord) {
        self.post(move |keeper| keeper.add_servo_run(record, Instant::now()));
    }

    /// Queues a change of a part's traceability after its verdict.
    pub fn trace(&self, hung: HungId, change: TraceChange) {
        self.post(move |keeper| keeper.trace_part(&hung, &change, Instant::now()));
    }

    /// Queues a remark.
    pub fn remark(&self, number: i64, remark: String) {
        self.post(move |keeper| keeper.set_remark(number, &remark));
    }

    /// Queues a true label; `None` clears it.
    pub fn label(&self, number: i64, label: Option<Truth>) {
        self.post(move |keeper| keeper.set_label(number, label.as_ref()));
    }

    /// Queues the true label of a part; `None` clears it.
    pub fn set_part_label(&self, hung: HungId, label: Option<Truth>) {
        self.post(move |keeper| keeper.set_part_label(&hung, label.as_ref()));
    }

    /// Queues a new retention rule.
    pub fn retention(&self, retention: Retention) {
        self.post(move |keeper| keeper.set_retention(retention));
    }

    fn post(&self, job: impl FnOnce(&HistoryBuffer) + Send + 'static) {
        if let Some(jobs) = &self.jobs {
            // Sending fails only if the thread has panicked.
            let _ = jobs.send(Box::new(job));
        }
    }

    /// Waits until everything queued is written. If writing fails, tries once more at once;
    /// [`HistoryBuffer::num_waiting`] then counts what is still not written.
    pub fn finish(&self) {
        let (answer, answered) = sync_channel(1);
        self.post(move |keeper| {
            keeper.retry_now();
            let _ = answer.send(());
        });
        let _ = answered.recv();
    }

    /// Returns how many frames were not kept and how many inspections were lost since the last call, because the disk
    /// was too slow.
    pub fn take_dropped(&self) -> [usize; 2] {
        let Counts { bare, lost, .. } = self.counts.as_ref();
        [bare, lost].map(|count| count.swap(0, Ordering::Relaxed))
    }
}

impl Drop for Writer {
    fn drop(&mut self) {
        self.jobs = None;
        if let Some(thread) = self.thread.take() {
            // A panic has already been reported on its own thread.
            let _ = thread.join();
        }
    }
}

/// Waits for a job, at most until the next retry is due.
fn next(received: &Receiver<Job>, keeper: &HistoryBuffer) -> Result<Job, RecvTimeoutError> {
    match keeper.next_try() {
        Some(at) => received.recv_timeout(at.saturating_duration_since(Instant::now())),
        None => Ok(received.recv()?),
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;
    use crate::{
        fixtures::history_entry,
        history::{Filter, StoredVerdict},
    };
    use stages::fixtures::small_scene;

    #[test]
    fn what_waits_is_written_and_what_is_too_much_without_its_frame() {
        let keeper = Arc::new(HistoryBuffer::new(None));
        let (go_on, is_held) = channel::<()>();
        // The thread stops here after opening the history, so that everything waits.
        let hold = move || {
            let _ = is_held.recv();
        };
        let writer = Writer::start(Arc::clone(&keeper), hold).expect("a thread");
        for ticket in 1..=10 {
            let mut waiting = history_entry(ticket as i64, StoredVerdict::Rejected, "fender");
            waiting.scene = Some(small_scene(1));
            writer.add(ticket, waiting);
        }
        drop(go_on);
        writer.finish();
        assert_eq!(writer.take_dropped(), [2, 0]);
        assert_eq!(writer.take_dropped(), [0, 0]);
        let page = keeper.page(&Filter::default(), 0, 100).expect("asked");
        assert_eq!(page.rows.len(), 10);
        let newest = keeper.row(-10).expect("asked").expect("waits");
        assert_eq!(newest.detail.frame_loss, Some(FrameLoss::SlowDisk));
    }

    #[test]
    fn at_the_end_what_waits_is_tried_once_more_before_its_time() {
        let waiting = || {
            let home = tempfile::tempdir().expect("a folder");
            let place = home.path().join("taken");
            fs::write(&place, "a file").expect("written");
            let keeper = Arc::new(HistoryBuffer::new(Some(place.clone())));
            let writer = Writer::start(Arc::clone(&keeper), || ()).expect("a thread");
            writer.add(1, history_entry(1, StoredVerdict::Rejected, "fender"));
            writer.finish();
            assert_eq!(keeper.num_waiting(), 1);
            fs::remove_file(&place).expect("removed");
            (home, keeper, writer)
        };
        let (_home, keeper, writer) = waiting();
        writer.finish();
        assert_eq!(keeper.num_waiting(), 0);
        let (_home, keeper, writer) = waiting();
        drop(writer);
        assert_eq!(keeper.num_waiting(), 0);
    }
}
