//! The window: five-second answers for the operator, every step for the engineer.
//!
//! ```text
//! a frame   Workspace::update (tasks, dialogs) ─► Workspace::ui ─► Message ─► Window ─► Event ─► every workspace
//! a task    Task::start ─► a thread with its TaskContext ─► Task::poll ─► the state of the workspace that started it
//! ```
//!
//! [`shell`] is what a workspace stands on: the session that all of them share, tasks, messages, file dialogs. A
//! workspace is a folder with its state, its panels and the work of its tasks; none imports another, and the window
//! knows it as a [`shell::workspace::Workspace`]: [`inspect`], [`enrol`], [`compare`], [`align`] and [`history`]. Above them
//! stand the [`shell::inspector`], which captures and inspects, [`live`], which follows a source, [`roles`], and the dialog
//! of [`robot`]. What is pressed there is an [`action`], which changes the window's [`state`].
//!
//! [`theme`] holds every colour, distance and type size. Panels draw the last result, always, and never compute.

pub mod action;
pub mod align;
mod bars;
pub mod camera;
pub mod compare;
mod deviation;
mod dialog;
pub mod enrol;
pub mod figures;
pub mod fitted;
pub mod headless;
pub mod history;
pub mod inspect;
mod keys;
pub mod live;
mod memory;
mod notices;
mod rail;
pub mod recording;
pub mod robot;
pub mod roles;
pub mod settings;
pub mod shelf;
pub mod shell;
pub mod shots;
pub mod source;
mod source_menu;
mod start;
pub mod state;
pub mod theme;
pub mod unit_system;
pub mod user_error;
pub mod viewport;
mod widgets;
mod window;
mod writing;

pub use self::{
    start::{WindowError, run},
    window::{Window, WindowOptions},
};
