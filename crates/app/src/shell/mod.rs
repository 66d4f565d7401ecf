//! The basis of the workspaces (the session that they share, messages, file dialogs, notices and keys) and everything around
//! them (the bars, the inspector, the followed source, the robot's cell, and the roles).
//!
//! A control outside the workspaces causes an [`action`], which changes the window's [`state`].

pub mod action;
pub mod closing;
pub mod context;
pub mod current_trace;
pub(crate) mod dialogs;
pub mod file_dialog;
pub mod inspector;
pub mod key_binding;
pub(crate) mod keys;
pub mod library_loader;
pub mod live;
pub mod message;
pub mod notice;
pub(crate) mod notices;
pub(crate) mod operator_bars;
pub(crate) mod path_entry;
pub mod program_setup;
pub(crate) mod rail;
pub mod robot;
pub mod roles;
pub(crate) mod scanner;
pub mod session;
pub mod settings;
pub(crate) mod settings_file;
pub mod shift;
mod source_menu;
mod standing;
pub mod state;
pub(crate) mod top_bar;
pub(crate) mod truth_menu;
pub mod undo_stack;
pub mod workspace;
