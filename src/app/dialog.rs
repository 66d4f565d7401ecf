//! What the whole window asks in the system's file dialogs.

use super::{
    action::Ask,
    shell::file_dialog::{ALL_FILES, FileChoice, FileRequest, POINTS},
};

/// The dialog that asks this.
pub(super) fn request(ask: Ask) -> FileRequest {
    let (title, choice): (_, FileChoice) = match ask {
        Ask::Scene => ("Open a captured scene", FileChoice::File),
        Ask::Scan => (
            "Folder of a scan: its frames and their poses",
            FileChoice::Folder,
        ),
        Ask::ScanPoses => ("File of the poses of the shots", FileChoice::File),
        Ask::Shot => ("Add a frame to the scan", FileChoice::File),
        Ask::ReportFolder => (
            "Folder for the report of this inspection",
            FileChoice::FolderToWrite,
        ),
        Ask::Library => ("Use another library", FileChoice::Folder),
        Ask::Picture => (
            "Save a picture of the view",
            FileChoice::NewFile("view.png"),
        ),
        Ask::Recording => ("Play a recording", FileChoice::Folder),
        Ask::RecordTo => ("Folder to record the source in", FileChoice::FolderToWrite),
        Ask::WatchedFolder => ("Folder that captures are saved to", FileChoice::Folder),
        Ask::Part => ("Open a scene, a cloud or a mesh to enrol", FileChoice::File),
        Ask::Calibration => ("Load the calibration of the robot's cell", FileChoice::File),
        Ask::SprayPath => (
            "Export the spray path for the robot",
            FileChoice::NewFile("spray-path.csv"),
        ),
        Ask::PartPath => ("The nozzle's path over this part", FileChoice::File),
        Ask::Pairs => ("Pairs of robot and camera poses", FileChoice::File),
    };
    FileRequest {
        title,
        filters: filters(ask),
        choice,
    }
}

fn filters(ask: Ask) -> &'static [(&'static str, &'static [&'static str])] {
    match ask {
        Ask::Scene => &[
            (
                "Captured scenes",
                &["pcd", "ply", "xyz", "txt", "csv", "png"],
            ),
            ALL_FILES,
        ],
        Ask::ScanPoses => &[("Poses", &["json"]), ALL_FILES],
        Ask::Shot => &[("Captured scenes", &["png", "pcd", "ply"]), ALL_FILES],
        Ask::Picture => &[("Pictures", &["png"])],
        Ask::Part => &[POINTS, ALL_FILES],
        Ask::Calibration => &[("Calibrations", &["toml"]), ALL_FILES],
        Ask::SprayPath => &[("Comma-separated values", &["csv"]), ("JSON", &["json"])],
        Ask::PartPath => &[("Tables", &["csv", "txt"]), ALL_FILES],
        Ask::Pairs => &[("Tables and JSON", &["csv", "txt", "json"]), ALL_FILES],
        Ask::Scan
        | Ask::ReportFolder
        | Ask::Library
        | Ask::Recording
        | Ask::RecordTo
        | Ask::WatchedFolder => &[],
    }
}
