//! The window: five-second answers for the operator, every step for the engineer.
//!
//! ```text
//! a frame   Workspace::update (tasks, dialogs) ─► Workspace::ui ─► Action ─► Window ─► Event ─► every workspace
//! a task    Task::start ─► a thread with its TaskContext ─► Task::poll ─► the state of the workspace that started it
//! ```
//!
//! [`workspaces`]: each owns its state, its panels and its tasks; the window knows it as a
//! [`Workspace`](shell::workspace::Workspace), and none imports another. [`shots`] is the list that Inspect and Enrol share;
//! `shared` is what several draw.
//! The session and the bars around the workspaces are the crate `shell`; widgets, tasks and texts are the crate `ui`.
//!
//! Panels only draw the last result and never compute.

#![cfg_attr(test, allow(clippy::disallowed_methods, reason = "tests change files"))]

pub mod headless;
mod shared;
pub mod shots;
mod start;
mod window;
pub mod workspaces;

pub use self::{
    start::{WindowError, run},
    window::{Window, WindowOptions},
};
