//! The source of scenes: the inspector that takes one at a time, Live that follows it, and the menu that chooses it.

pub mod inspector;
pub mod library_loader;
pub mod live;
pub mod source_menu;
