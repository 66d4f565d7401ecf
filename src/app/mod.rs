//! The window: five-second answers for the operator, every step for the engineer.
//!
//! ```text
//! panels ─► Action ─► apply(State) ─► Effect ─► Request ─► a thread per lane ─► Answer ─► Action ...
//! ```
//!
//! [`state`] is plain data, [`action`] the only thing that changes it. [`job`] says what can be asked for; [`worker`] is
//! a thread, [`lane`] which one. Each workspace is a folder: its panel, its part of the state, and what its thread does.
//! [`theme`] holds every colour, distance and type size. Panels draw the last result, always, and never compute.

pub mod action;
pub mod align;
mod answers;
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
pub mod job;
mod keys;
pub mod lane;
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
pub mod worker;
pub mod writing;

pub use self::{
    start::{WindowError, run},
    window::{Window, WindowOptions},
};
