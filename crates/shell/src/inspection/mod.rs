//! A scene, its inspection, and the data drawn for both, prepared in a task: no egui, no session.

pub mod camera;
pub mod figures;
pub mod fitted;
pub mod folder_watch;
pub mod fuse;
pub mod inspected;
pub mod library_cache;
pub mod recording;
pub mod report_files;
pub mod scan_choice;
pub mod scan_figure;
pub mod scene_figure;
pub mod source;
pub mod unit_system;
