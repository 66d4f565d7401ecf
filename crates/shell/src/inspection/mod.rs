//! A scene, its inspection, and the data drawn for both, prepared in a task: no egui, no session.

pub mod camera;
pub mod figures;
pub mod folder_watch;
pub mod inspected;
pub mod library_cache;
pub mod report_files;
pub mod scan;
pub mod scene_figure;
pub mod source;
