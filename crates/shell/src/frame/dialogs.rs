//! The requests of the window's own file dialogs.

use crate::{
    action::DialogRequest,
    file_dialog::{FileChoice, FileFilter, FileRequest, all_files, points},
};
use files::SCENE_ENDINGS;
use ui::language::text;

/// Returns the request for a choice.
pub fn request(ask: DialogRequest) -> FileRequest {
    let (title, choice): (_, FileChoice) = match ask {
        DialogRequest::Scene => (text!("shell-open-scene"), FileChoice::File),
        DialogRequest::Scan => (text!("shell-scan-folder"), FileChoice::Folder),
        DialogRequest::Library => (text!("shell-another-library"), FileChoice::Folder),
        DialogRequest::Recording => (text!("shell-a-recording"), FileChoice::Folder),
        DialogRequest::RecordTo => (text!("shell-record-to"), FileChoice::FolderToWrite),
        DialogRequest::WatchedFolder => (text!("shell-watched-folder"), FileChoice::Folder),
        DialogRequest::Part => (text!("shell-open-part"), FileChoice::File),
        DialogRequest::Rack => (text!("shell-open"), FileChoice::File),
        DialogRequest::SaveRack => (
            text!("shell-save-as"),
            FileChoice::NewFile("rack.toml".into()),
        ),
        DialogRequest::Orders => (text!("expect-table"), FileChoice::File),
    };
    FileRequest {
        title,
        filters: filters(ask),
        choice,
    }
}

fn filters(ask: DialogRequest) -> Vec<FileFilter> {
    match ask {
        DialogRequest::Scene => vec![(text!("shell-captured-scenes"), SCENE_ENDINGS), all_files()],
        DialogRequest::Part => vec![points(), all_files()],
        DialogRequest::Rack | DialogRequest::SaveRack => {
            vec![(text!("rack-files"), &["toml"]), all_files()]
        }
        DialogRequest::Orders => vec![(text!("shell-csv-files"), &["csv"]), all_files()],
        DialogRequest::Scan
        | DialogRequest::Library
        | DialogRequest::Recording
        | DialogRequest::RecordTo
        | DialogRequest::WatchedFolder => Vec::new(),
    }
}
