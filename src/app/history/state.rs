//! What the workspace knows, and what changes it.

use crate::app::{action::Effect, state::State};

/// What the workspace knows.
#[derive(Debug, Default)]
pub struct HistoryState {}

/// Something that happened in the workspace.
#[derive(Debug)]
pub enum HistoryAction {}

/// Makes it so.
pub fn apply(_state: &mut State, action: HistoryAction) -> Option<Effect> {
    match action {}
}
