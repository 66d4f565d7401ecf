//! State of the window outside the workspaces: the session that they share, and the parts that change it.

use std::{collections::VecDeque, path::PathBuf};

use super::{
    notice::{Notice, NoticeTopic},
    rack::ReadRack,
    roles::RoleState,
    session::Session,
    shift::ShiftWatch,
};
use crate::{
    help::{Help, Installation},
    inspection::library_cache::LibraryCache,
    source::{inspector::Inspector, live::Follower},
    trace::orders::OrdersWatch,
};
use geometry::clock;
use ui::task::{Task, TaskRunner};

/// State of the window outside the workspaces. [`apply`](crate::apply::apply) changes it.
#[derive(Debug)]
pub struct State {
    /// State shared by the workspaces.
    pub session: Session,
    /// Captures, opens and inspects scenes.
    pub inspector: Inspector,
    /// Follows the source.
    pub follower: Follower,
    /// Notices, oldest first.
    pub notices: Vec<Notice>,
    /// All notices of late with their times, oldest first; for problem reports.
    pub log: VecDeque<String>,
    /// Help, while it is open.
    pub help: Option<Help>,
    /// What the window runs on, and where its files are.
    pub installation: Installation,
    /// Whether the window may close.
    pub closing: Closing,
    /// The last generation number given to a result.
    pub generation: u64,
    /// PIN, lock and open question of the roles.
    pub roles: RoleState,
    /// Counts the parts of this shift.
    pub shift_watch: ShiftWatch,
    /// Watches the table of orders in use.
    pub orders_watch: OrdersWatch,
    /// Reads the file of a rack.
    pub rack_reading: Task<ReadRack>,
    /// Writes the file of a rack.
    pub rack_saving: Task<PathBuf>,
    /// Writes a problem report.
    pub report_writing: Task<PathBuf>,
}

/// Whether the window may close.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum Closing {
    /// No close was requested.
    #[default]
    No,
    /// The user is asked.
    Asked {
        /// What would be lost, and which robots would get no answer: one line each.
        what: String,
        /// True if data would be lost.
        is_unsaved: bool,
    },
    /// The window closes, whatever is lost.
    Confirmed,
}

#[cfg(any(test, feature = "fixtures"))]
impl Default for State {
    fn default() -> Self {
        Self::new(&TaskRunner::without_threads(), &LibraryCache::default())
    }
}

impl State {
    /// Makes the state before the first capture.
    pub fn new(runner: &TaskRunner, library_cache: &LibraryCache) -> Self {
        Self {
            session: Session::default(),
            inspector: Inspector::new(runner, library_cache),
            follower: Follower::new(runner, library_cache),
            notices: Vec::new(),
            log: VecDeque::new(),
            help: None,
            installation: Installation::default(),
            closing: Closing::default(),
            generation: 0,
            roles: RoleState::default(),
            shift_watch: ShiftWatch::new(runner),
            orders_watch: OrdersWatch::new(runner),
            rack_reading: Task::new("rack-reading", runner),
            rack_saving: Task::new("rack-saving", runner),
            report_writing: Task::new("problem-report", runner),
        }
    }
}

/// Maximum number of notices; the oldest is dropped for another.
const MAX_NOTICES: usize = 4;
/// Maximum number of notices in the log.
const MAX_LOGGED: usize = 500;

/// Removes the notices about this.
pub fn remove_notices(state: &mut State, topic: NoticeTopic) {
    state.notices.retain(|notice| notice.topic != topic);
}

/// Shows a notice.
pub fn notify(state: &mut State, mut notice: Notice) {
    log(state, &notice);
    let covered = state.notices.iter();
    let num_covered: usize = covered.map(|known| known.num_covered_by(&notice)).sum();
    notice.num_more += num_covered;
    state.notices.retain(|known| !known.gives_way_to(&notice));
    state.notices.push(notice);
    let num_over = state.notices.len().saturating_sub(MAX_NOTICES);
    state.notices.drain(..num_over);
}

/// Adds a notice to the log, unless its last line says the same.
fn log(state: &mut State, notice: &Notice) {
    let says = format!("{} {}", notice.what, notice.advice);
    let says = says.trim().replace('\n', " ");
    if state.log.back().is_some_and(|last| last.ends_with(&says)) {
        return;
    }
    let at = clock::now();
    state.log.push_back(format!("{at:.0} {says}"));
    if state.log.len() > MAX_LOGGED {
        state.log.pop_front();
    }
}
