//! What an inspection leaves behind: a line of JSON for machines, pictures of its stages and the nozzle's stand-off for
//! people.

mod canvas;
mod chart;
mod evaluation;
mod folder;
mod lettering;
mod line;
mod pictures;
mod scaling;
pub mod stand_off;

pub use self::{
    evaluation::evaluation_picture,
    folder::{ReportError, ReportFolder},
    line::{CaptureLine, InspectionLine, SCHEMA},
    pictures::{Picture, stage_pictures, strip, write_png},
    scaling::{TimeCurve, scaling_picture, stacked},
};
