//! Background tasks. A [`Task`] belongs to whoever wants its result; nobody else sees it.
//!
//! Each run has a channel of its own. Replacing or cancelling a run drops the receiver, so whatever the old run still sends is
//! lost and results need no generation numbers. Progress is a value that is overwritten, not an event.

use std::{
    fmt, io,
    sync::{
        Arc, Mutex,
        atomic::{AtomicBool, Ordering},
        mpsc::{Receiver, SyncSender, TryRecvError, TrySendError, sync_channel},
    },
    thread::{self, JoinHandle},
};

use crate::{
    language::{Language, text},
    user_error::UserError,
};
use geometry::error::{guarded, lock};
use inspection::pipeline::{Cancelled, ProgressObserver, Stage};

/// Starts the threads of tasks and wakes the window when there is something to read. Clones share it.
#[derive(Clone)]
pub struct TaskRunner {
    wake: Arc<dyn Fn() + Send + Sync>,
    threads: Threads,
}

/// Where jobs run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Threads {
    /// On a thread per task.
    OnePerTask,
    /// Only in [`Task::run_waiting`].
    #[cfg(any(test, feature = "fixtures"))]
    None,
}

impl TaskRunner {
    /// `wake` is called from the threads and requests another frame of the window.
    pub fn new(wake: impl Fn() + Send + Sync + 'static) -> Self {
        Self {
            wake: Arc::new(wake),
            threads: Threads::OnePerTask,
        }
    }

    /// Makes jobs wait until a test runs them with [`Task::run_waiting`].
    #[cfg(any(test, feature = "fixtures"))]
    pub fn without_threads() -> Self {
        Self {
            threads: Threads::None,
            ..Self::new(|| {})
        }
    }

    /// Maximum number of unread partial results.
    fn max_unread(&self) -> usize {
        match self.threads {
            Threads::OnePerTask => 32,
            // Writer and reader are the same thread, so the writer must never block.
            #[cfg(any(test, feature = "fixtures"))]
            Threads::None => 4096,
        }
    }
}

impl fmt::Debug for TaskRunner {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("TaskRunner").field(&self.threads).finish()
    }
}

/// What a job reports.
#[derive(Debug, PartialEq)]
enum TaskEvent<T> {
    /// A partial result; the run continues.
    Partial(T),
    /// The final result; the run has ended.
    Done(T),
    /// The run failed or panicked.
    Failed(UserError),
}

/// Why a job has no result.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum TaskError {
    /// It was cancelled.
    Cancelled,
    /// It failed.
    Failed(UserError),
}

impl From<UserError> for TaskError {
    fn from(error: UserError) -> Self {
        Self::Failed(error)
    }
}

impl From<Cancelled> for TaskError {
    fn from(_: Cancelled) -> Self {
        Self::Cancelled
    }
}

/// A running job as the top bar shows it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Running {
    /// Description for the user.
    pub title: String,
    /// The pipeline stage begun last.
    pub stage: Option<Stage>,
    /// Steps done, and total steps.
    pub progress: Option<(usize, usize)>,
}

/// Runs one job at a time on a thread that starts with the first job; a new job replaces the current one.
///
/// Dropping the task cancels its job and waits for the thread.
pub struct Task<T> {
    name: &'static str,
    runner: TaskRunner,
    run: Option<Run<T>>,
    queue: JobQueue,
}

/// The current run.
struct Run<T> {
    running: Running,
    shared: Arc<RunShared<T>>,
    events: Receiver<TaskEvent<T>>,
}

/// State shared by a run and its job.
struct RunShared<T> {
    is_cancelled: AtomicBool,
    progress: Mutex<Progress>,
    /// Set by [`TaskContext::latest`], taken by [`Task::poll`].
    latest: Mutex<Option<T>>,
    #[cfg(any(test, feature = "fixtures"))]
    limit: Mutex<Limit<T>>,
}

/// How far a test lets a job run.
#[cfg(any(test, feature = "fixtures"))]
struct Limit<T> {
    /// Partial results that it may still hand over.
    num_left: usize,
    /// Keeps the run open after that, as if the job were still running.
    held: Option<SyncSender<TaskEvent<T>>>,
}

#[derive(Clone, Copy, Default)]
struct Progress {
    stage: Option<Stage>,
    steps: Option<(usize, usize)>,
}

impl<T: Send + 'static> Task<T> {
    /// Makes a task without a job. `name` becomes the name of the thread.
    pub fn new(name: &'static str, runner: &TaskRunner) -> Self {
        Self {
            name,
            runner: runner.clone(),
            run: None,
            queue: JobQueue::default(),
        }
    }

    /// Runs a job in place of the current one, which is cancelled. `title` describes it to the user.
    pub fn start(
        &mut self,
        title: impl Into<String>,
        job: impl FnOnce(&TaskContext<T>) -> Result<T, TaskError> + Send + 'static,
    ) {
        self.cancel();
        let (sender, events) = sync_channel(self.runner.max_unread());
        let shared = Arc::new(RunShared {
            is_cancelled: AtomicBool::new(false),
            progress: Mutex::default(),
            latest: Mutex::new(None),
            #[cfg(any(test, feature = "fixtures"))]
            limit: Mutex::new(Limit {
                num_left: usize::MAX,
                held: None,
            }),
        });
        let running = Running {
            title: title.into(),
            stage: None,
            progress: None,
        };
        let context = TaskContext {
            shared: Arc::clone(&shared),
            events: sender.clone(),
            wake: Arc::clone(&self.runner.wake),
        };
        self.run = Some(Run {
            running,
            shared,
            events,
        });
        let language = Language::current();
        let job = Box::new(move || {
            language.make_current();
            context.run(job);
        });
        if let Err(error) = self.queue.push(job, self.name, self.runner.threads) {
            let failed = UserError {
                what: text!("shell-no-thread", error = error.to_string()),
                advice: text!("shell-no-thread-advice"),
            };
            // The channel is empty and its receiver exists, so this cannot block or fail.
            let _ = sender.send(TaskEvent::Failed(failed));
        }
    }

    /// Cancels the running or waiting job, which reports nothing any more.
    pub fn cancel(&mut self) {
        if let Some(run) = self.run.take() {
            run.shared.is_cancelled.store(true, Ordering::Relaxed);
        }
    }

    /// Returns the next partial or final result, or the error, if there is one, without waiting. The run goes on only
    /// after a partial one.
    pub fn poll(&mut self) -> Option<Result<T, UserError>> {
        Some(match self.event()? {
            TaskEvent::Partial(result) | TaskEvent::Done(result) => Ok(result),
            TaskEvent::Failed(error) => Err(error),
        })
    }

    fn event(&mut self) -> Option<TaskEvent<T>> {
        let run = self.run.as_mut()?;
        let progress = *lock(&run.shared.progress);
        run.running.stage = progress.stage;
        run.running.progress = progress.steps;
        let event = match run.events.try_recv() {
            Ok(event) => event,
            // Checked after the channel: the latest value is newer than the queued ones.
            Err(TryRecvError::Empty) => TaskEvent::Partial(lock(&run.shared.latest).take()?),
            Err(TryRecvError::Disconnected) => {
                self.run = None;
                return None;
            }
        };
        if !matches!(event, TaskEvent::Partial(_)) {
            self.run = None;
        }
        Some(event)
    }

    /// The run that has not ended, as of the last [`poll`](Self::poll).
    pub fn running(&self) -> Option<&Running> {
        self.run.as_ref().map(|run| &run.running)
    }

    /// Runs the waiting job on this thread; false if there is none.
    #[cfg(any(test, feature = "fixtures"))]
    pub fn run_waiting(&self) -> bool {
        let job = lock(&self.queue.waiting).take();
        job.map(|job| job()).is_some()
    }

    /// Runs the waiting job until it has handed over this many partial results; it then counts as still running.
    #[cfg(any(test, feature = "fixtures"))]
    pub fn run_waiting_until(&self, num_parts: usize) -> bool {
        if let Some(run) = &self.run {
            lock(&run.shared.limit).num_left = num_parts;
        }
        self.run_waiting()
    }
}

impl<T> Drop for Task<T> {
    fn drop(&mut self) {
        // Cancel before the queue waits for its thread, which may be blocked until its results are read or dropped.
        if let Some(run) = self.run.take() {
            run.shared.is_cancelled.store(true, Ordering::Relaxed);
        }
    }
}

impl<T> fmt::Debug for Task<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let running = self.run.as_ref().map(|run| &run.running);
        f.debug_tuple(self.name).field(&running).finish()
    }
}

/// The job's side of a run: reports progress, learns of cancellation.
pub struct TaskContext<T> {
    shared: Arc<RunShared<T>>,
    events: SyncSender<TaskEvent<T>>,
    wake: Arc<dyn Fn() + Send + Sync>,
}

impl<T> TaskContext<T> {
    /// Reports the steps done and the total steps.
    pub fn progress(&self, done: usize, total: usize) {
        lock(&self.shared.progress).steps = Some((done, total));
        (self.wake)();
    }

    /// Hands over a partial result. Blocks while too many are unread.
    pub fn partial(&self, part: T) {
        #[cfg(any(test, feature = "fixtures"))]
        {
            let mut limit = lock(&self.shared.limit);
            limit.num_left = limit.num_left.saturating_sub(1);
        }
        // A cancelled run has no receiver.
        let _ = self.events.send(TaskEvent::Partial(part));
        (self.wake)();
    }

    /// Hands over a partial result, replacing the previous one from here if that is still unread.
    pub fn latest(&self, part: T) {
        *lock(&self.shared.latest) = Some(part);
        (self.wake)();
    }

    /// True if the value of the last [`latest`](Self::latest) was read.
    pub fn is_latest_read(&self) -> bool {
        lock(&self.shared.latest).is_none()
    }

    /// Returns an error once the run is cancelled.
    pub fn check(&self) -> Result<(), TaskError> {
        if self.is_cancelled() {
            Err(TaskError::Cancelled)
        } else {
            Ok(())
        }
    }

    fn run(self, job: impl FnOnce(&Self) -> Result<T, TaskError>) {
        if self.is_cancelled() {
            return;
        }
        // Unwind-safe: data shared with others, such as a loaded library, is only ever replaced as a whole.
        let ended = guarded(|| job(&self));
        let event = match ended {
            Ok(Ok(result)) => Some(TaskEvent::Done(result)),
            Ok(Err(TaskError::Failed(error))) => Some(TaskEvent::Failed(error)),
            Ok(Err(TaskError::Cancelled)) => None,
            Err(fault) => Some(TaskEvent::Failed(UserError::of(&fault))),
        };
        let Self {
            events,
            wake,
            shared,
        } = self;
        #[cfg(any(test, feature = "fixtures"))]
        {
            let mut limit = lock(&shared.limit);
            if limit.num_left == 0 {
                limit.held = Some(events);
                return;
            }
        }
        drop(shared);
        if let Some(event) = event {
            let _ = events.send(event);
        }
        drop(events);
        wake();
    }
}

impl<T> ProgressObserver for TaskContext<T> {
    fn begins(&self, stage: Stage) {
        lock(&self.shared.progress).stage = Some(stage);
        (self.wake)();
    }

    fn is_cancelled(&self) -> bool {
        #[cfg(any(test, feature = "fixtures"))]
        if lock(&self.shared.limit).num_left == 0 {
            return true;
        }
        self.shared.is_cancelled.load(Ordering::Relaxed)
    }
}

type Job = Box<dyn FnOnce() + Send>;

/// A thread, and the single job waiting for it.
#[derive(Default)]
struct JobQueue {
    waiting: Arc<Mutex<Option<Job>>>,
    thread: Option<JobThread>,
}

struct JobThread {
    /// Dropping it ends the thread.
    filled: SyncSender<()>,
    handle: JoinHandle<()>,
}

impl JobQueue {
    /// Puts a job in place of the waiting one.
    fn push(&mut self, job: Job, name: &'static str, threads: Threads) -> io::Result<()> {
        *lock(&self.waiting) = Some(job);
        match threads {
            #[cfg(any(test, feature = "fixtures"))]
            Threads::None => return Ok(()),
            Threads::OnePerTask => {}
        }
        let thread = match &self.thread {
            Some(thread) => thread,
            None => self
                .thread
                .insert(JobThread::start(name, Arc::clone(&self.waiting))?),
        };
        match thread.filled.try_send(()) {
            // Full: the thread has not taken the signal yet.
            Ok(()) | Err(TrySendError::Full(())) => Ok(()),
            Err(TrySendError::Disconnected(())) => Err(io::ErrorKind::BrokenPipe.into()),
        }
    }
}

impl JobThread {
    fn start(name: &'static str, waiting: Arc<Mutex<Option<Job>>>) -> io::Result<Self> {
        let (filled, is_filled) = sync_channel(1);
        let handle = thread::Builder::new().name(name.into()).spawn(move || {
            while is_filled.recv().is_ok() {
                let job = lock(&waiting).take();
                // Jobs catch their own panics.
                if let Some(job) = job {
                    job();
                }
            }
        })?;
        Ok(Self { filled, handle })
    }
}

impl Drop for JobQueue {
    fn drop(&mut self) {
        *lock(&self.waiting) = None;
        if let Some(JobThread { filled, handle }) = self.thread.take() {
            drop(filled);
            let _ = handle.join();
        }
    }
}

#[cfg(test)]
mod tests {
    use std::{
        sync::mpsc::channel,
        time::{Duration, Instant},
    };

    use super::*;

    fn task<T: Send + 'static>() -> Task<T> {
        Task::new("test", &TaskRunner::new(|| {}))
    }

    /// Waits for the next event.
    fn next<T: Send + 'static>(task: &mut Task<T>) -> TaskEvent<T> {
        let until = Instant::now() + Duration::from_secs(10);
        while Instant::now() < until {
            if let Some(event) = task.event() {
                return event;
            }
            thread::sleep(Duration::from_millis(1));
        }
        panic!("no event within ten seconds");
    }

    fn until_cancelled<T>(context: &TaskContext<T>) -> Result<T, TaskError> {
        let until = Instant::now() + Duration::from_mins(1);
        while Instant::now() < until {
            context.check()?;
            thread::sleep(Duration::from_millis(1));
        }
        panic!("never cancelled");
    }

    #[test]
    fn the_newest_job_replaces_the_running_and_the_waiting_one() {
        let mut task = task();
        let (began, begins) = channel();
        task.start("first", move |context| {
            began.send(()).expect("waited for");
            until_cancelled(context)
        });
        begins.recv().expect("begun");
        task.start("second", |_| panic!("it was replaced before it began"));
        task.start("third", |_| Ok(3));
        assert_eq!(
            task.running().map(|running| running.title.as_str()),
            Some("third")
        );
        assert_eq!(next(&mut task), TaskEvent::Done(3));
        assert!(task.running().is_none() && task.poll().is_none());
    }

    #[test]
    fn what_a_replaced_job_still_sends_is_never_read() {
        let mut task = task();
        let (sent, sends) = channel();
        task.start("old", move |context| {
            context.partial(1);
            sends.recv().expect("released");
            context.partial(2);
            context.latest(3);
            Ok(4)
        });
        assert_eq!(next(&mut task), TaskEvent::Partial(1));
        task.start("new", |_| Ok(5));
        sent.send(()).expect("it waits");
        assert_eq!(next(&mut task), TaskEvent::Done(5));
    }

    #[test]
    fn a_cancelled_job_reports_nothing_and_the_task_goes_on() {
        let mut task = task();
        task.start("cancelled", until_cancelled);
        task.cancel();
        assert!(task.running().is_none() && task.poll().is_none());
        task.start("next", |_| Ok("done"));
        assert_eq!(next(&mut task), TaskEvent::Done("done"));
    }

    #[test]
    fn dropping_cancels_the_job_and_waits_for_it() {
        let mut task = task::<()>();
        let (began, begins) = channel();
        let (ended, ends) = channel();
        task.start("running", move |context| {
            began.send(()).expect("waited for");
            let result = until_cancelled(context);
            ended.send(()).expect("waited for");
            result
        });
        begins.recv().expect("begun");
        drop(task);
        ends.try_recv().expect("it ended before the drop did");
    }

    #[test]
    fn dropping_does_not_wait_for_parts_to_be_read() {
        let mut task = task();
        let (began, begins) = channel();
        task.start("talkative", move |context| {
            began.send(()).expect("waited for");
            loop {
                context.partial([0; 64]);
                context.check()?;
            }
        });
        begins.recv().expect("begun");
        drop(task);
    }

    #[test]
    fn a_panic_is_a_failure_and_the_next_job_runs() {
        let mut task = task::<u32>();
        task.start("breaks", |_| panic!("seven is too much"));
        let TaskEvent::Failed(error) = next(&mut task) else {
            panic!("the panic was not reported");
        };
        assert!(error.what.contains("seven is too much"), "{}", error.what);
        assert!(!error.advice.is_empty());
        task.start("works", |_| Ok(8));
        assert_eq!(next(&mut task), TaskEvent::Done(8));
    }

    #[test]
    fn a_failure_keeps_its_advice() {
        let mut task = task::<u32>();
        let error = UserError {
            what: "broken".into(),
            advice: "Mend it".into(),
        };
        let given = error.clone();
        task.start("fails", move |_| Err(given.into()));
        assert_eq!(next(&mut task), TaskEvent::Failed(error));
    }

    #[test]
    fn progress_is_what_was_reported_last() {
        let mut task = task();
        let (go_on, waits) = channel::<()>();
        task.start("counting", move |context| {
            context.begins(Stage::Segment);
            context.begins(Stage::Rank);
            context.progress(1, 3);
            context.progress(2, 3);
            context.partial("counted");
            waits.recv().expect("released");
            Ok("done")
        });
        assert_eq!(next(&mut task), TaskEvent::Partial("counted"));
        assert!(task.poll().is_none());
        let running = task.running().expect("it waits");
        assert_eq!(
            (running.stage, running.progress),
            (Some(Stage::Rank), Some((2, 3)))
        );
        go_on.send(()).expect("it waits");
        assert_eq!(next(&mut task), TaskEvent::Done("done"));
    }

    #[test]
    fn of_the_latest_parts_only_the_newest_waits() {
        let mut task = task();
        let (sender, receiver) = channel();
        let (go_on, waits) = channel::<()>();
        task.start("live", move |context| {
            (1..=100).for_each(|number| context.latest(number));
            sender.send(context.is_latest_read()).expect("waited for");
            waits.recv().expect("released");
            sender.send(context.is_latest_read()).expect("waited for");
            Ok(0)
        });
        assert!(!receiver.recv().expect("sent"), "nobody has read it");
        assert_eq!(next(&mut task), TaskEvent::Partial(100));
        go_on.send(()).expect("it waits");
        assert!(receiver.recv().expect("sent"), "it was read");
        assert_eq!(next(&mut task), TaskEvent::Done(0));
    }

    #[test]
    fn without_threads_a_job_runs_when_the_test_says_so() {
        let mut task = Task::new("test", &TaskRunner::without_threads());
        task.start("replaced", |_| Ok(1));
        task.start("waiting", |context| {
            (0..100).for_each(|number| context.partial(number));
            Ok(100)
        });
        assert!(task.running().is_some() && task.poll().is_none());
        assert!(task.run_waiting() && !task.run_waiting());
        for number in 0..100 {
            assert_eq!(task.event(), Some(TaskEvent::Partial(number)));
        }
        assert_eq!(task.event(), Some(TaskEvent::Done(100)));
    }

    #[test]
    fn a_job_stopped_by_a_test_counts_as_at_work() {
        let mut task = Task::new("test", &TaskRunner::without_threads());
        task.start("rows", |context| {
            for row in 0.. {
                context.check()?;
                context.partial(row);
            }
            Ok(0)
        });
        assert!(task.run_waiting_until(2));
        assert_eq!(task.event(), Some(TaskEvent::Partial(0)));
        assert_eq!(task.event(), Some(TaskEvent::Partial(1)));
        assert!(task.poll().is_none() && task.running().is_some());
    }
}
