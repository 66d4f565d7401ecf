//! What an inspection leaves behind for people: pictures of its stages.

mod canvas;
mod pictures;

pub use self::pictures::{Picture, stage_pictures, strip};
