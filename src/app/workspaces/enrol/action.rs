//! Everything that can happen in the workspace.

use std::path::PathBuf;

use super::{
    draft::Field,
    selection::{Edit, OutlineMode},
    subject::InitialSelection,
};
use crate::{
    app::{
        language::text,
        shell::file_dialog::{FileChoice, FileRequest, all_files},
        shots::{ShotsAction, ShotsFile},
        ui::viewport::DrawnShape,
    },
    library::PartName,
};

/// Something that happened in the workspace.
#[derive(Debug)]
pub enum EnrolAction {
    /// Take the scene in front as the draft.
    TakeShown,
    /// Correct what is kept.
    Correct(Edit),
    /// Start from other points.
    TakeAs(InitialSelection),
    /// Take all corrections away.
    Reset,
    /// Draw this by dragging in the 3-D view, or turn the view by it.
    Draw(Option<DrawnShape>),
    /// Draw a box, or a lasso instead of a box.
    DrawNext,
    /// Have a box or a lasso do something else.
    OutlineMode(OutlineMode),
    /// Show other panes.
    Panes(DraftPanes),
    /// Write a line about the draft.
    Write(Field),
    /// Look at the draft again, after it was cancelled.
    LookAgain,
    /// Save the draft.
    Save,
    /// Put the draft away.
    Discard,
    /// Take the last step back.
    Undo,
    /// Do again what was taken back last.
    Redo,
    /// Look at an enrolled part.
    Open(PartName),
    /// Look at the draft again.
    Close,
    /// Write a line about the enrolled part that is looked at.
    WriteOpen(Field),
    /// Call it so.
    Rename,
    /// Move a part to the trash.
    Remove(PartName),
    /// Enrol this part anew: the draft, or the next one, replaces it.
    Replace(PartName),
    /// Replace none: the draft becomes a new part.
    ReplaceNone,
    /// Take the spray path of a part away.
    RemovePath(PartName),
    /// Have a person choose the folder of a scan to open.
    OpenScan,
    /// Have a person choose a file.
    Ask(EnrolFile),
    /// A person chose it: the spray path of the enrolled part that is looked at.
    Chosen(EnrolFile, PathBuf),
    /// Of the shots of the draft.
    Shots(ShotsAction),
}

/// What a person is asked to choose.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EnrolFile {
    /// The spray path of the enrolled part that is looked at.
    SprayPath,
    /// Something of the scan that the draft is.
    Scan(ShotsFile),
}

impl EnrolFile {
    pub(super) fn request(self) -> FileRequest {
        match self {
            Self::SprayPath => FileRequest {
                title: text!("enrol-path-file-title"),
                filters: vec![(text!("enrol-path-files"), &["csv", "txt"]), all_files()],
                choice: FileChoice::File,
            },
            Self::Scan(file) => file.request(),
        }
    }
}

/// What is shown of the draft.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum DraftPanes {
    /// The picture and the 3-D view.
    #[default]
    Both,
    /// The picture alone.
    Picture,
    /// The 3-D view alone.
    View,
}

impl DraftPanes {
    /// Every choice.
    pub const ALL: [Self; 3] = [Self::Both, Self::Picture, Self::View];

    /// What a person calls it.
    pub fn title(self) -> String {
        match self {
            Self::Both => text!("enrol-both"),
            Self::Picture => text!("enrol-picture-pane"),
            Self::View => text!("enrol-view-pane"),
        }
    }

    /// What choosing it does.
    pub(super) fn label(self) -> String {
        match self {
            Self::Both => text!("enrol-show-both"),
            Self::Picture => text!("enrol-show-picture"),
            Self::View => text!("enrol-show-view"),
        }
    }
}
