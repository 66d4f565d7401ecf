//! Actions of the workspace, and the files that it asks for.

use std::path::PathBuf;

use super::{
    draft::Field,
    selection::{Edit, OutlineMode},
    subject::InitialSelection,
};
use crate::shots::{ShotsAction, ShotsFile};
use inspection::library::PartName;
use shell::file_dialog::{FileChoice, FileRequest, all_files};
use ui::{language::text, viewport::DrawnShape};

/// Something that happened in the workspace.
#[derive(Debug)]
pub enum EnrolAction {
    /// Make the scene that Inspect shows the draft.
    TakeShown,
    /// Go to Inspect, which shows the part that was just saved.
    SeeInspected,
    /// Correct which points are kept.
    Correct(Edit),
    /// Start the corrections from another selection.
    TakeAs(InitialSelection),
    /// Remove all corrections.
    Reset,
    /// Draw this shape by dragging in the 3-D view; `None` turns the view instead.
    Draw(Option<DrawnShape>),
    /// Choose the box, or the lasso if the box was chosen.
    DrawNext,
    /// Choose what a drawn box or lasso does.
    OutlineMode(OutlineMode),
    /// Choose the panes.
    Panes(DraftPanes),
    /// Fill in a field of the draft's form.
    Write(Field),
    /// Examine the draft again, after it was cancelled.
    LookAgain,
    /// Save the draft; with the card of an enrolled part open, store that part's form.
    Save,
    /// Discard the draft.
    Discard,
    /// Undo the last step of the draft; without a draft, the last step of all.
    Undo,
    /// Undo the last step of all, as a notice offers after a change of the library.
    UndoChange,
    /// Redo the step undone last.
    Redo,
    /// Open the card of an enrolled part.
    Open(PartName),
    /// Close that card and return to the draft.
    Close,
    /// Fill in a field of the open part's form.
    WriteOpen(Field),
    /// Store the open part's form: name, title and notes.
    Rename,
    /// Move a part to the trash.
    Remove(PartName),
    /// Replace this enrolled part by the draft or the next one.
    Replace(PartName),
    /// Replace no part: the draft becomes a new one, with the form that it had before.
    ReplaceNone,
    /// Remove the spray path of a part.
    RemovePath(PartName),
    /// Ask for the folder of a scan to open.
    OpenScan,
    /// Ask for a file.
    Ask(EnrolFile),
    /// A file was chosen.
    Chosen(EnrolFile, PathBuf),
    /// An action on the shots of the draft.
    Shots(ShotsAction),
}

/// A file that a person is asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EnrolFile {
    /// The spray path of the open part.
    SprayPath,
    /// A file of the scan that the draft was made of.
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

/// The panes that show the draft.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum DraftPanes {
    /// The picture and the 3-D view.
    #[default]
    Both,
    /// Only the picture.
    Picture,
    /// Only the 3-D view.
    View,
}

impl DraftPanes {
    /// Every choice, in the order of the buttons.
    pub const ALL: [Self; 3] = [Self::Both, Self::Picture, Self::View];

    /// Name for a person.
    pub fn title(self) -> String {
        match self {
            Self::Both => text!("enrol-both"),
            Self::Picture => text!("enrol-picture-pane"),
            Self::View => text!("enrol-view-pane"),
        }
    }

    /// Describes what choosing it does.
    pub(super) fn label(self) -> String {
        match self {
            Self::Both => text!("enrol-show-both"),
            Self::Picture => text!("enrol-show-picture"),
            Self::View => text!("enrol-show-view"),
        }
    }
}
