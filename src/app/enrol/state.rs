//! What the workspace knows, and what changes it.

use super::EnrolAnswer;
use crate::app::{action::Effect, job::Trouble, state::State};

/// What the workspace knows.
#[derive(Debug, Default)]
pub struct EnrolState {}

/// Something that happened in the workspace.
#[derive(Debug)]
pub enum EnrolAction {}

/// Makes it so.
pub fn apply(_state: &mut State, action: EnrolAction) -> Option<Effect> {
    match action {}
}

/// Takes in what the thread answers; a partial answer comes with `is_whole` unset.
pub fn hear(_state: &mut State, outcome: Result<EnrolAnswer, Trouble>) -> Option<Effect> {
    match outcome {
        Ok(answer) => match answer {},
        Err(_) => None,
    }
}
