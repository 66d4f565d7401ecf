//! The workspaces. Each owns its state, its panels and its tasks; none imports another.

pub mod align;
pub mod compare;
pub mod enrol;
pub mod history;
pub mod inspect;
pub mod paint;
pub mod servo;
