//! Results of an inspection: a line of JSON for machines, pictures of its stages and the pose report for people.
//!
//! The line, text tables and the text of `evaluate` are always available; pictures and pose reports need the feature `cli`.

#[cfg(feature = "cli")]
mod canvas;
#[cfg(feature = "cli")]
mod chart;
#[cfg(feature = "cli")]
mod curves;
#[cfg(feature = "cli")]
mod evaluation;
mod evaluation_report;
#[cfg(feature = "cli")]
mod film;
#[cfg(feature = "cli")]
mod folder;
#[cfg(feature = "cli")]
mod lettering;
mod line;
#[cfg(feature = "cli")]
mod pictures;
#[cfg(feature = "cli")]
pub mod pose_report;
mod problem;
#[cfg(feature = "cli")]
mod runner_up_picture;
mod surface_line;
mod text_table;

#[cfg(feature = "cli")]
pub use self::{
    curves::{SizeCurve, curves_picture, stacked},
    evaluation::evaluation_picture,
    film::{FilmPicture, film_picture},
    folder::{ReportError, ReportFolder, WrittenPose},
    pictures::{
        Picture, binary_picture, frame_pictures, segmentation_picture, stage_pictures, write_png,
    },
    runner_up_picture::runner_up_picture,
};
pub use self::{
    evaluation_report::EvaluationReport,
    line::{CaptureLine, InspectionLine, SCHEMA, ScanLine, TimingsLine},
    problem::{ProblemReport, SETTINGS_FILE, compared_entries},
    surface_line::{MeasuredLine, RegionLine, SurfaceLine},
    text_table::TextTable,
};
