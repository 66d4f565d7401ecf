//! What an inspection leaves behind: a line of JSON for machines, pictures of its stages and the pose report for people.

mod canvas;
mod chart;
mod contenders;
mod evaluation;
mod folder;
mod lettering;
mod line;
mod pictures;
pub mod pose_report;
mod scaling;
mod score_plots;

pub use self::{
    contenders::contenders_picture,
    evaluation::evaluation_picture,
    folder::{ReportError, ReportFolder},
    line::{CaptureLine, InspectionLine, SCHEMA, ScanLine, TimingsLine},
    pictures::{Picture, segmentation_picture, stage_pictures, strip, write_png},
    scaling::{TimeCurve, scaling_picture, stacked},
};
