//! Writes inspections to the history on a thread of its own, so that no verdict waits for the disk.

use std::{io, path::PathBuf, sync::Arc};

use records::history::{
    HistoryBuffer, HistoryEvent, HungId, NewEntry, ServoRecord, TraceChange, Writer,
};

/// Records inspections.
pub struct Recorder {
    history: Arc<HistoryBuffer>,
    writer: Writer,
    num: u64,
}

/// Numbers of inspections that are not, or not fully, in the history.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Losses {
    /// Not written, because the history could not be written.
    pub num_unwritten: usize,
    /// Not written, because the disk is too slow.
    pub num_slow: usize,
    /// Written without frames, because the disk is too slow.
    pub num_bare: usize,
    /// True if a run of servoing was not written, because the history could not be written.
    pub lacks_servo_run: bool,
}

impl Recorder {
    /// Starts to record into this folder.
    pub fn start(folder: PathBuf) -> io::Result<Self> {
        let history = Arc::new(HistoryBuffer::new(Some(folder)));
        Ok(Self {
            writer: Writer::start(Arc::clone(&history), || ())?,
            history,
            num: 0,
        })
    }

    /// Adds an inspection. Never waits.
    pub fn add(&mut self, entry: NewEntry) {
        self.num += 1;
        self.writer.add(self.num, entry);
    }

    /// Adds a run of servoing. Never waits.
    pub fn add_servo_run(&self, record: ServoRecord) {
        self.writer.add_servo_run(record);
    }

    /// Changes the traceability of a part after its verdict.
    pub fn trace(&self, hung: HungId, change: TraceChange) {
        self.writer.trace(hung, change);
    }

    /// Takes what happened to the history since the last call.
    pub fn take_news(&self) -> Vec<HistoryEvent> {
        self.history.take_news()
    }

    /// Waits until everything is written, or a last attempt has failed.
    pub fn finish(&self) {
        self.writer.finish();
    }

    /// What is missing in the history.
    pub fn losses(&self) -> Losses {
        Losses::new(&self.history, self.writer.take_dropped())
    }
}

impl Losses {
    /// Counts what is missing; `dropped` is [`Writer::take_dropped`].
    pub fn new(history: &HistoryBuffer, dropped: [usize; 2]) -> Self {
        let [num_bare, num_slow] = dropped;
        Self {
            num_unwritten: history.num_waiting() + history.num_lost(),
            num_slow,
            num_bare,
            lacks_servo_run: history.num_servo_runs_waiting() > 0,
        }
    }
}
