//! The source of scenes: what takes one at a time and inspects it, Live that follows it, and the menu that chooses it.

pub mod inspect;
pub mod inspector;
pub mod live;
pub mod source_menu;
