//! The window: five-second answers for the operator, every step for the engineer.
//!
//! ```text
//! a frame   Workspace::update (tasks, dialogs) ─► Workspace::ui ─► Message ─► Window ─► Event ─► every workspace
//! a task    Task::start ─► a thread with its TaskContext ─► Task::poll ─► the state of the workspace that started it
//! ```
//!
//! Imports run down, from folder to folder:
//!
//! - [`workspaces`]: each owns its state, its panels and its tasks; the window knows it as a
//!   [`Workspace`](shell::workspace::Workspace), and none imports another. [`shots`] is the list that Inspect and Enrol share.
//! - [`shell`]: the session and the services that workspaces use, and the bars and tasks around them.
//! - [`inspection`]: a scene, its result and the data drawn for them; no egui, no session.
//! - [`ui`]: colours, widgets, the 3-D view. [`task`]: jobs on background threads. [`language`]: the texts.
//!
//! Panels only draw the last result and never compute.

#![cfg_attr(test, allow(clippy::disallowed_methods, reason = "tests change files"))]

pub mod headless;
pub mod inspection;
pub mod language;
pub mod shell;
pub mod shots;
mod start;
pub mod task;
pub mod ui;
pub mod user_error;
mod window;
pub mod workspaces;

pub use self::{
    start::{WindowError, run},
    window::{Window, WindowOptions},
};
