//! The requests of the window's own file dialogs, and the question before the window closes with unsaved data, or while it
//! answers robots.

use egui::Context;

use crate::{
    action::{Action, DialogRequest},
    file_dialog::{FileChoice, FileFilter, FileRequest, all_files, points},
    state::{Closing, State},
};
use files::SCENE_ENDINGS;
use ui::{
    language::text,
    theme::space,
    widgets::{self, text_button},
};

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

/// Draws the question while it is open.
pub fn closing(ctx: &Context, state: &State, actions: &mut Vec<Action>) {
    let Closing::Asked { what, is_unsaved } = &state.closing else {
        return;
    };
    let (question, close) = if *is_unsaved {
        (
            text!("shell-close-without-saving"),
            text!("shell-close-anyway"),
        )
    } else {
        (
            text!("shell-stop-answering"),
            text!("shell-close-and-stop-answering"),
        )
    };
    let modal = widgets::dialog(ctx, "closing", |ui| {
        ui.set_max_width(420.0);
        ui.heading(question);
        ui.weak(what);
        ui.add_space(space::MEDIUM);
        ui.horizontal(|ui| {
            if widgets::default_button(ui, &text!("shell-keep-open"), true) {
                actions.push(Action::StayOpen);
            }
            if text_button(ui, &close).clicked() {
                actions.push(Action::CloseAnyway);
            }
        });
    });
    if modal.should_close() {
        actions.push(Action::StayOpen);
    }
}
