//! The basis of the workspaces (the session that they share, messages, file dialogs, notices and keys) and everything around
//! them (the bars, the inspector, the followed source, the robot's cell, and the roles).
//!
//! A control outside the workspaces causes an [`action`], which changes the window's [`state`].

pub mod action;
pub mod closing;
pub mod context;
pub mod current_trace;
pub(in crate::app) mod dialogs;
pub mod file_dialog;
pub mod inspector;
pub mod key_binding;
pub(in crate::app) mod keys;
pub mod library_loader;
pub mod live;
pub mod message;
pub mod notice;
pub(in crate::app) mod notices;
pub(in crate::app) mod operator_bars;
pub(in crate::app) mod path_entry;
pub mod program_setup;
pub(in crate::app) mod rail;
pub mod robot;
pub mod roles;
pub(in crate::app) mod scanner;
pub mod session;
pub mod settings;
pub(in crate::app) mod settings_file;
pub mod shift;
mod source_menu;
mod standing;
pub mod state;
pub(in crate::app) mod top_bar;
pub(in crate::app) mod truth_menu;
pub mod undo_stack;
pub mod workspace;
