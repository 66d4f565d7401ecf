//! What every workspace stands on, and no workspace.

pub mod context;
pub mod file_dialog;
pub mod inspector;
pub mod key_binding;
pub mod message;
pub mod notice;
pub mod session;
pub mod task;
pub mod workspace;
