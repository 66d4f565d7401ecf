//! What an inspection leaves behind: a line of JSON for machines, pictures of its stages and the pose report for people.

mod canvas;
mod chart;
mod evaluation;
mod film;
mod folder;
mod lettering;
mod line;
mod pictures;
pub mod pose_report;
mod runner_up_picture;
mod scaling;
mod score_plots;

pub use self::{
    evaluation::evaluation_picture,
    film::{FilmPicture, film_picture},
    folder::{ReportError, ReportFolder},
    line::{CaptureLine, InspectionLine, SCHEMA, ScanLine, TimingsLine},
    pictures::{Picture, binary_picture, segmentation_picture, stage_pictures, strip, write_png},
    runner_up_picture::runner_up_picture,
    scaling::{TimeCurve, scaling_picture, stacked},
};
