//! The window, tested by its labels and controls. Only the pictures need a graphics adapter; without one, the 3-D
//! view shows a message.

#![allow(clippy::disallowed_methods, reason = "tests change files")]

mod align;
mod answering;
mod cell_check;
mod compare;
mod enrol;
mod expecting;
mod help;
mod history;
mod inspect;
mod language;
mod live;
mod operator;
mod paint;
mod pictures;
mod rack_editor;
pub(crate) mod robot;
mod roles;
mod servo;
mod set_up;
mod several_parts;
mod shots;
mod view;
mod wrong_part;
