//! The window, by what a person reads and presses. No graphics adapter is needed, but for the pictures: the 3-D view
//! says in words that there is none.

mod align;
mod answering;
mod cell_check;
mod compare;
mod enrol;
mod history;
mod inspect;
#[path = "../kit/mod.rs"]
mod kit;
mod language;
mod live;
mod operator;
mod paint;
mod pictures;
pub(crate) mod robot;
mod roles;
mod set_up;
mod shots;
mod view;
