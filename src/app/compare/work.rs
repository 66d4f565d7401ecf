//! What the workspace's thread does.

use crate::app::{job::Outcome, shelf::Shelf, worker::Desk};

/// What the workspace asks for.
#[derive(Clone, Debug)]
pub enum CompareRequest {}

/// What comes back.
#[derive(Clone, Debug)]
pub enum CompareAnswer {}

/// Does what is asked.
pub(in crate::app) fn answer(
    request: CompareRequest,
    _shelf: &Shelf,
    _desk: &dyn Desk<Outcome>,
) -> Option<Outcome> {
    match request {}
}
