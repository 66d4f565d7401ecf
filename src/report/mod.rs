//! What an inspection leaves behind: a line of JSON for machines, pictures of its stages for people.

mod canvas;
mod folder;
mod line;
mod pictures;

pub use self::{
    folder::{ReportError, ReportFolder},
    line::{InspectionLine, SCHEMA},
    pictures::{Picture, stage_pictures, strip},
};
