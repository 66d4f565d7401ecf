//! State of the window outside the workspaces: the session that they share, and the parts that change it.

use super::{notice::Notice, roles::RoleState, session::Session, shift::ShiftWatch};
use crate::{
    frame::closing::Closing,
    inspection::library_cache::LibraryCache,
    source::{inspector::Inspector, live::Follower},
};
use ui::task::TaskRunner;

/// State of the window outside the workspaces. [`apply`](super::action::apply) changes it.
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
    /// True while the list of shortcuts is open.
    pub is_help_open: bool,
    /// Whether the window may close.
    pub closing: Closing,
    /// The last generation number given to a result.
    pub generation: u64,
    /// PIN, lock and open question of the roles.
    pub roles: RoleState,
    /// Counts the parts of this shift.
    pub shift_watch: ShiftWatch,
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
            is_help_open: false,
            closing: Closing::default(),
            generation: 0,
            roles: RoleState::default(),
            shift_watch: ShiftWatch::new(runner),
        }
    }
}
