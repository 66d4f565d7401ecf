//! What an inspection leaves behind for people: pictures of its stages, and the nozzle's stand-off.

mod canvas;
mod pictures;
pub mod stand_off;

pub use self::pictures::{Picture, stage_pictures, strip};
