//! What the workspace knows, and what changes it.

use super::CompareAnswer;
use crate::app::{action::Effect, job::Trouble, state::State};

/// What the workspace knows.
#[derive(Debug, Default)]
pub struct CompareState {}

/// Something that happened in the workspace.
#[derive(Debug)]
pub enum CompareAction {}

/// Makes it so.
pub fn apply(_state: &mut State, action: CompareAction) -> Option<Effect> {
    match action {}
}

/// Takes in what the thread answers; a partial answer comes with `is_whole` unset.
pub fn hear(_state: &mut State, outcome: Result<CompareAnswer, Trouble>) -> Option<Effect> {
    match outcome {
        Ok(answer) => match answer {},
        Err(_) => None,
    }
}
