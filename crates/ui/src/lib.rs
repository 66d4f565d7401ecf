//! Building blocks of the window that know nothing of sessions and workspaces: theme and widgets, parameter controls, plots,
//! the 3-D view, background tasks, steps to undo, and the texts in every language.

#![cfg_attr(test, allow(clippy::disallowed_methods, reason = "tests change files"))]

pub mod key_binding;
pub mod language;
pub mod parameter_control;
pub mod plot;
pub mod scrubber;
pub mod task;
pub mod theme;
pub mod tool_row;
pub mod undo_stack;
pub mod user_error;
pub mod viewport;
pub mod widgets;
