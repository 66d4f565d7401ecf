//! The thread that keeps the database up to date with a history's file.

use std::{
    collections::VecDeque,
    io,
    path::PathBuf,
    sync::{Arc, Condvar, Mutex, PoisonError},
    thread::{self, JoinHandle},
    time::Duration,
};

use rand::{RngExt as _, SeedableRng as _};
use rand_pcg::Pcg64;
use thiserror::Error;

use super::{
    access::DatabaseAccess,
    cell::{CellHistory, CellName},
    client::Database,
    error::{DatabaseError, TransferError},
    send::BATCH,
};
use files::crc32;
use geometry::error::{Advice, guarded, lock};
use records::history::{History, SetAside};

/// How often the history is checked for unsent rows.
const POLL_INTERVAL: Duration = Duration::from_secs(1);
/// Pause after the first failure; each further pause is twice as long, up to the longest. A random factor of 0.5 to 1 keeps
/// the cells of a plant from reconnecting all at once.
const FIRST_PAUSE: Duration = Duration::from_millis(500);
const LONGEST_PAUSE: Duration = Duration::from_secs(30);
/// How long unsent rows may still be sent at the end of the program.
const END_TIMEOUT: Duration = Duration::from_secs(3);

/// Events to be shown to the operator.
#[derive(Clone, Debug, PartialEq)]
pub enum SendNews {
    /// Connected to the database, for the first time or again.
    Connected {
        /// Inspections that were not sent yet.
        num_waiting: usize,
    },
    /// Sending fails; reported once for each cause until it succeeds again.
    Failed(SendProblem),
    /// The history was damaged: it was set aside, and a new one with another identity was begun.
    SetAside(SetAside),
}

/// Why sending fails at present.
#[derive(Clone, Debug, PartialEq, Eq, Error, Advice)]
#[error("{what}")]
#[advice = "{advice}"]
pub struct SendProblem {
    what: String,
    advice: String,
}

/// The system refuses a thread for a sender.
#[derive(Debug, Error, Advice)]
#[error("the thread that sends the history cannot be started: {source}")]
#[advice = "Close other programs and start again"]
pub struct SenderError {
    source: io::Error,
}

/// Some inspections were still unsent at the end of the program.
#[derive(Clone, Debug, PartialEq, Eq, Error, Advice)]
#[error("{num} inspections are not in the plant's database yet")]
#[advice = "Nothing is lost: they are sent at the next start, or now by partsight history send"]
pub struct Unsent {
    num: usize,
}

/// Keeps a database up to date with the history in a folder. Dropping it is the same as [`Self::end`].
pub struct HistorySender {
    shared: Arc<Shared>,
    thread: Option<JoinHandle<()>>,
}

struct Shared {
    folder: PathBuf,
    access: DatabaseAccess,
    cell: CellName,
    state: Mutex<State>,
    changed: Condvar,
}

#[derive(Default)]
struct State {
    is_ending: bool,
    has_ended: bool,
    num_waiting: usize,
    /// The problem last reported, until sending succeeds again.
    notified: Option<SendProblem>,
    /// True once a connection was reported.
    is_connected: bool,
    news: VecDeque<SendNews>,
}

impl HistorySender {
    /// Starts a thread that sends what is unsent now, and later changes.
    pub fn start(
        folder: PathBuf,
        access: DatabaseAccess,
        cell: CellName,
    ) -> Result<Self, SenderError> {
        let shared = Arc::new(Shared {
            folder,
            access,
            cell,
            state: Mutex::default(),
            changed: Condvar::new(),
        });
        let theirs = Arc::clone(&shared);
        let thread = thread::Builder::new()
            .name("history sender".into())
            .spawn(move || theirs.run())
            .map_err(|source| SenderError { source })?;
        Ok(Self {
            shared,
            thread: Some(thread),
        })
    }

    /// Takes the oldest event that was not taken yet.
    pub fn news(&self) -> Option<SendNews> {
        lock(&self.shared.state).news.pop_front()
    }

    /// Number of unsent inspections at the last check.
    pub fn num_waiting(&self) -> usize {
        lock(&self.shared.state).num_waiting
    }

    /// Sends what is unsent, for at most 3 s, then stops for good.
    pub fn end(&mut self) -> Result<(), Unsent> {
        let Some(thread) = self.thread.take() else {
            return Ok(());
        };
        let shared = &self.shared;
        let mut state = lock(&shared.state);
        state.is_ending = true;
        shared.changed.notify_all();
        let waited =
            (shared.changed).wait_timeout_while(state, END_TIMEOUT, |state| !state.has_ended);
        let state = waited.unwrap_or_else(PoisonError::into_inner).0;
        let (num, has_ended) = (state.num_waiting, state.has_ended);
        drop(state);
        if has_ended {
            // A panic of the thread has been reported.
            let _ = thread.join();
        }
        // Otherwise it waits for the network, which cannot be interrupted; it ends with the program, and the next start
        // sends the rest again.
        if num > 0 {
            return Err(Unsent { num });
        }
        Ok(())
    }
}

impl Drop for HistorySender {
    fn drop(&mut self) {
        // The receiver is gone.
        let _ = self.end();
    }
}

impl Shared {
    fn run(&self) {
        let mut random = Pcg64::seed_from_u64(u64::from(crc32(self.cell.as_str().as_bytes())));
        let mut pause = FIRST_PAUSE;
        let mut database = None;
        loop {
            let is_last = lock(&self.state).is_ending;
            let sent = guarded(|| self.turn(&mut database));
            let wait = match sent.unwrap_or_else(|fault| Err(fault.into())) {
                Ok(()) => {
                    pause = FIRST_PAUSE;
                    POLL_INTERVAL
                }
                Err(error) => {
                    database = None;
                    self.failed(&error);
                    let wait = pause.mul_f64(random.random_range(0.5..1.0));
                    pause = (pause * 2).min(LONGEST_PAUSE);
                    wait
                }
            };
            if is_last {
                break;
            }
            self.wait(wait);
        }
        lock(&self.state).has_ended = true;
        self.changed.notify_all();
    }

    /// Waits before the next turn, until the program ends at the latest.
    fn wait(&self, at_most: Duration) {
        let state = lock(&self.state);
        drop((self.changed).wait_timeout_while(state, at_most, |state| !state.is_ending));
    }

    /// Sends everything that is unsent.
    fn turn(&self, database: &mut Option<Database>) -> Result<(), TransferError> {
        let whose = self.look()?;
        if database.is_some() && lock(&self.state).num_waiting == 0 {
            return Ok(());
        }
        if let Some(open) = database {
            match self.send(open, &whose) {
                // The connection may have ended while idle: reconnect without a report.
                Err(TransferError::Database(DatabaseError::Unreachable { .. })) => {}
                sent => return sent,
            }
        }
        let open = database.insert(Database::open(&self.access)?);
        self.send(open, &whose)
    }

    /// Counts the unsent inspections and identifies the history.
    fn look(&self) -> Result<CellHistory, TransferError> {
        // Open it for each check, so that a damaged file can be set aside in between.
        let mut history = self.history()?;
        let identity = history.note_changes()?;
        lock(&self.state).num_waiting = history.num_unsent()?;
        Ok(CellHistory {
            cell: self.cell.clone(),
            history: identity,
        })
    }

    fn history(&self) -> Result<History, TransferError> {
        let opened = History::open(&self.folder)?;
        if let Some(aside) = opened.set_aside {
            let mut state = lock(&self.state);
            state.news.push_back(SendNews::SetAside(aside));
        }
        Ok(opened.history)
    }

    /// Sends batch after batch. Even an empty batch is sent, because it claims the cell's name.
    fn send(&self, database: &mut Database, whose: &CellHistory) -> Result<(), TransferError> {
        loop {
            let mut history = self.history()?;
            // Another file may have taken its place: the next turn sends that one under its own identity.
            if history.note_changes()? != whose.history {
                return Ok(());
            }
            let rows = database.send(whose, || Ok(history.unsent(BATCH)?))?;
            self.works();
            history.note_sent(&rows)?;
            lock(&self.state).num_waiting = history.num_unsent()?;
            if rows.num() < BATCH {
                return Ok(());
            }
        }
    }

    fn works(&self) {
        let mut state = lock(&self.state);
        if !state.is_connected || state.notified.is_some() {
            state.is_connected = true;
            state.notified = None;
            let num_waiting = state.num_waiting;
            state.news.push_back(SendNews::Connected { num_waiting });
        }
    }

    fn failed(&self, error: &TransferError) {
        let problem = SendProblem {
            what: error.to_string(),
            advice: error.advice(),
        };
        let mut state = lock(&self.state);
        if state.notified.as_ref() != Some(&problem) {
            state.notified = Some(problem.clone());
            state.news.push_back(SendNews::Failed(problem));
        }
    }
}
