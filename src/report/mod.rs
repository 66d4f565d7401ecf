//! What an inspection leaves behind: a line of JSON for machines, pictures of its stages and the nozzle's stand-off for
//! people.

mod canvas;
mod folder;
mod line;
mod pictures;
pub mod stand_off;

pub use self::{
    folder::{ReportError, ReportFolder},
    line::{InspectionLine, SCHEMA},
    pictures::{Picture, stage_pictures, strip},
};
