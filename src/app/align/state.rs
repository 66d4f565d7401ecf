//! What the workspace knows, and what changes it.

use super::AlignAnswer;
use crate::app::{action::Effect, job::Trouble, state::State};

/// What the workspace knows.
#[derive(Debug, Default)]
pub struct AlignState {}

/// Something that happened in the workspace.
#[derive(Debug)]
pub enum AlignAction {}

/// Makes it so.
pub fn apply(_state: &mut State, action: AlignAction) -> Option<Effect> {
    match action {}
}

/// Takes in what the thread answers; a partial answer comes with `is_whole` unset.
pub fn hear(_state: &mut State, outcome: Result<AlignAnswer, Trouble>) -> Option<Effect> {
    match outcome {
        Ok(answer) => match answer {},
        Err(_) => None,
    }
}
