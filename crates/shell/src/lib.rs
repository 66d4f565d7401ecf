//! The window around its workspaces: the session that they share, actions and notices, and what stands around them.
//!
//! - [`frame`]: the bars above, below and beside the work, the notices, the keys, and the question before the window closes.
//! - [`help`]: the list of keys, the guide, the program and this computer, and problem reports.
//! - [`source`]: takes scenes from the source, once or continuously, and inspects them.
//! - [`cell`]: the robot's cell, its calibration and its check, and the answers to robots.
//! - [`rack`]: where parts may hang, and the window in which that is edited.
//! - [`roles`]: the operator's and the engineer's view. [`trace`]: serial numbers and orders, typed or scanned.
//! - [`inspection`]: a scene, its result and the data drawn for both; no session. [`language`]: the texts of results.
//!
//! A control outside the workspaces causes an [`action`], which changes the window's [`state`]. Workspaces are above: the shell
//! knows each as a [`workspace::Workspace`].

#![cfg_attr(test, allow(clippy::disallowed_methods, reason = "tests change files"))]

pub mod action;
pub mod apply;
pub mod cell;
pub mod file_dialog;
pub mod frame;
pub mod help;
pub mod inspection;
pub mod language;
pub mod notice;
pub mod rack;
pub mod roles;
pub mod session;
pub mod settings;
pub mod shift;
pub mod source;
pub mod state;
pub mod trace;
pub mod workspace;
