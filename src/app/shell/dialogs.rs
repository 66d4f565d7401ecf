//! What the whole window asks in the system's file dialogs.

use super::{
    action::DialogRequest,
    file_dialog::{ALL_FILES, FileChoice, FileRequest, POINTS},
};
use crate::files::SCENE_ENDINGS;

/// The dialog that asks this.
pub(in crate::app) fn request(ask: DialogRequest) -> FileRequest {
    let (title, choice): (_, FileChoice) = match ask {
        DialogRequest::Scene => ("Open a captured scene", FileChoice::File),
        DialogRequest::Scan => (
            "Folder of a scan: its frames and their poses",
            FileChoice::Folder,
        ),
        DialogRequest::Library => ("Use another library", FileChoice::Folder),
        DialogRequest::Recording => ("Play a recording", FileChoice::Folder),
        DialogRequest::RecordTo => ("Folder to record the source in", FileChoice::FolderToWrite),
        DialogRequest::WatchedFolder => ("Folder that captures are saved to", FileChoice::Folder),
        DialogRequest::Part => ("Open a scene, a cloud or a mesh to enrol", FileChoice::File),
    };
    FileRequest {
        title,
        filters: filters(ask),
        choice,
    }
}

fn filters(ask: DialogRequest) -> &'static [(&'static str, &'static [&'static str])] {
    match ask {
        DialogRequest::Scene => &[("Captured scenes", SCENE_ENDINGS), ALL_FILES],
        DialogRequest::Part => &[POINTS, ALL_FILES],
        DialogRequest::Scan
        | DialogRequest::Library
        | DialogRequest::Recording
        | DialogRequest::RecordTo
        | DialogRequest::WatchedFolder => &[],
    }
}
