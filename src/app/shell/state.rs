//! The state of the window outside the workspaces: the session that they share, and what changes it.

use super::{
    closing::Closing, inspector::Inspector, live::Follower, notice::Notice, roles::RoleState,
    session::Session, shift::ShiftWatch,
};
use crate::app::{inspection::library_cache::LibraryCache, task::TaskRunner};

/// The state of the window outside the workspaces. [`apply`](super::action::apply) changes it.
#[derive(Debug)]
pub struct State {
    /// What the workspaces share.
    pub session: Session,
    /// Captures, opens and inspects; meanwhile the result shown is old.
    pub inspector: Inspector,
    /// Follows the source.
    pub follower: Follower,
    /// What a person should know, oldest first.
    pub notices: Vec<Notice>,
    /// Whether the list of shortcuts is open.
    pub help: HelpPage,
    /// Whether the window may close.
    pub closing: Closing,
    /// Counts runs of the inspector and results shown.
    pub generation: u64,
    /// Whose window it is.
    pub roles: RoleState,
    /// Counts the parts of this shift.
    pub shift_watch: ShiftWatch,
}

#[cfg(test)]
impl Default for State {
    fn default() -> Self {
        Self::new(&TaskRunner::without_threads(), &LibraryCache::default())
    }
}

impl State {
    /// Before the first capture.
    pub fn new(runner: &TaskRunner, library_cache: &LibraryCache) -> Self {
        Self {
            session: Session::default(),
            inspector: Inspector::new(runner, library_cache),
            follower: Follower::new(runner, library_cache),
            notices: Vec::new(),
            help: HelpPage::default(),
            closing: Closing::default(),
            generation: 0,
            roles: RoleState::default(),
            shift_watch: ShiftWatch::new(runner),
        }
    }
}

/// Whether the list of shortcuts is open.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum HelpPage {
    /// Not open.
    #[default]
    Closed,
    /// Open.
    Open,
}
