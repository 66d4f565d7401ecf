//! The window: five-second answers for the operator, every step for the engineer.
//!
//! ```text
//! panels ─► Action ─► apply(State) ─► Effect ─► Worker (one thread) ─► News ─► Action ...
//! ```
//!
//! [`state`] is plain data, [`action`] the only thing that changes it, [`worker`] the thread and [`work`] what it does;
//! [`theme`] holds every colour, distance and type size. Panels draw the last result, always, and never compute.

pub mod action;
mod bars;
mod deviation;
mod dialog;
pub mod figures;
mod inspect;
mod start;
pub mod state;
pub mod theme;
pub mod viewport;
mod widgets;
mod window;
pub mod work;
pub mod worker;

pub use self::{
    start::{WindowError, run},
    window::Window,
};
