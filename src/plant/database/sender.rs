//! The thread that keeps the database up to date with a history's file.

use std::{
    collections::VecDeque,
    io,
    path::PathBuf,
    sync::{Arc, Condvar, Mutex, PoisonError},
    thread::{self, JoinHandle},
    time::{Duration, Instant},
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
use crate::{
    error::{Advice, guarded, lock},
    files::crc32,
    history::{History, SetAside},
};

/// How often the history is looked at for what is not sent.
const TURN: Duration = Duration::from_secs(1);
/// Before the second attempt after a failure; each further pause is twice as long, up to the longest. Of each a random
/// part is left out, so that the cells of a plant do not all come at once when the server is back.
const FIRST_PAUSE: Duration = Duration::from_millis(500);
const LONGEST_PAUSE: Duration = Duration::from_secs(30);
/// At the end of the program what is not sent has so long to go out.
const END_TIMEOUT: Duration = Duration::from_secs(3);

/// What happened, for the person at the screen.
#[derive(Clone, Debug, PartialEq)]
pub enum SendNews {
    /// The database is there, for the first time or again.
    Connected {
        /// Inspections that waited for it.
        num_waiting: usize,
    },
    /// Sending does not work; once for each cause until it works again.
    Failed(SendTrouble),
    /// The history was damaged; it was set aside and a new one begun, which has another identity.
    SetAside(SetAside),
}

/// Why nothing is sent now.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("{what}")]
pub struct SendTrouble {
    what: String,
    advice: String,
}

impl Advice for SendTrouble {
    fn advice(&self) -> String {
        self.advice.clone()
    }
}

/// Why there is no sender.
#[derive(Debug, Error)]
pub enum SenderError {
    /// The system gives no thread.
    #[error("the thread that sends the history cannot be started: {source}")]
    NoThread {
        /// What the system says.
        source: io::Error,
    },
}

impl Advice for SenderError {
    fn advice(&self) -> String {
        match self {
            Self::NoThread { .. } => "Close other programs and start again".into(),
        }
    }
}

/// At the end of the program some inspections were not sent.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("{num} inspections are not in the plant's database yet")]
pub struct Unsent {
    num: usize,
}

impl Advice for Unsent {
    fn advice(&self) -> String {
        "Nothing is lost: they are sent by the next start, or now by partsight history send".into()
    }
}

/// Keeps a database up to date with the history in a folder. Dropped, it is ended as by [`Self::end`].
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
    /// What the person at the screen was told last, while nothing is sent.
    told: Option<SendTrouble>,
    /// True once the person was told of a connection.
    is_connected: bool,
    news: VecDeque<SendNews>,
}

impl HistorySender {
    /// Sends on a thread of its own what is not sent, and what changes from now on.
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
            .map_err(|source| SenderError::NoThread { source })?;
        Ok(Self {
            shared,
            thread: Some(thread),
        })
    }

    /// The oldest news that was not taken yet.
    pub fn news(&self) -> Option<SendNews> {
        lock(&self.shared.state).news.pop_front()
    }

    /// Inspections that were not sent when that was looked at last.
    pub fn num_waiting(&self) -> usize {
        lock(&self.shared.state).num_waiting
    }

    /// Sends what is not sent, for a few seconds at most, and nothing any more afterwards.
    pub fn end(&mut self) -> Result<(), Unsent> {
        let Some(thread) = self.thread.take() else {
            return Ok(());
        };
        let shared = &self.shared;
        let until = Instant::now() + END_TIMEOUT;
        let mut state = lock(&shared.state);
        state.is_ending = true;
        shared.changed.notify_all();
        while !state.has_ended && Instant::now() < until {
            let left = until.saturating_duration_since(Instant::now());
            let waited = shared.changed.wait_timeout(state, left);
            state = waited.unwrap_or_else(PoisonError::into_inner).0;
        }
        let (num, has_ended) = (state.num_waiting, state.has_ended);
        drop(state);
        if has_ended {
            // A fault of the thread has been told.
            let _ = thread.join();
        }
        // Else it waits for the network, which nobody can interrupt; it ends with the program, and sends the rest again.
        if num > 0 {
            return Err(Unsent { num });
        }
        Ok(())
    }
}

impl Drop for HistorySender {
    fn drop(&mut self) {
        // Nobody is left to be told.
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
                    TURN
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

    /// Waits before the next turn; not when the program ends.
    fn wait(&self, at_most: Duration) {
        let until = Instant::now() + at_most;
        let mut state = lock(&self.state);
        while !state.is_ending && Instant::now() < until {
            let left = until.saturating_duration_since(Instant::now());
            let waited = self.changed.wait_timeout(state, left);
            state = waited.unwrap_or_else(PoisonError::into_inner).0;
        }
    }

    /// Sends all that is not sent.
    fn turn(&self, database: &mut Option<Database>) -> Result<(), TransferError> {
        let whose = self.look()?;
        if database.is_some() && lock(&self.state).num_waiting == 0 {
            return Ok(());
        }
        if let Some(open) = database {
            match self.send(open, &whose) {
                // It may have gone while nothing was sent: that alone is no news.
                Err(TransferError::Database(DatabaseError::Unreachable { .. })) => {}
                sent => return sent,
            }
        }
        let open = database.insert(Database::open(&self.access)?);
        self.send(open, &whose)
    }

    /// Counts what is not sent.
    fn look(&self) -> Result<CellHistory, TransferError> {
        // Opened for each look, so that a file that is found damaged can be set aside in between.
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

    /// Batch after batch, also one that is empty: it claims the cell's name.
    fn send(&self, database: &mut Database, whose: &CellHistory) -> Result<(), TransferError> {
        loop {
            let mut history = self.history()?;
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
        if !state.is_connected || state.told.is_some() {
            state.is_connected = true;
            state.told = None;
            let num_waiting = state.num_waiting;
            state.news.push_back(SendNews::Connected { num_waiting });
        }
    }

    fn failed(&self, error: &TransferError) {
        let trouble = SendTrouble {
            what: error.to_string(),
            advice: error.advice(),
        };
        let mut state = lock(&self.state);
        if state.told.as_ref() != Some(&trouble) {
            state.told = Some(trouble.clone());
            state.news.push_back(SendNews::Failed(trouble));
        }
    }
}
