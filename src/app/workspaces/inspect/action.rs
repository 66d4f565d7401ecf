//! Everything that can happen in the workspace.

use std::path::PathBuf;

use super::state::ViewPart;
use crate::{
    app::{
        inspection::figures::StagePanel,
        language::text,
        shell::{
            file_dialog::{FileChoice, FileRequest},
            program_setup::program_files,
        },
        shots::{ShotsAction, ShotsFile},
        ui::viewport::Colouring,
    },
    robot::Convention,
};

/// Something that happened in the workspace.
#[derive(Clone, Debug)]
pub enum InspectAction {
    /// Show this in the view, or no longer.
    Toggle(ViewPart),
    /// Colour the points by this.
    Colour(Colouring),
    /// Fill the middle with a stage.
    Enlarge(StagePanel),
    /// Show the view there again.
    CloseEnlarged,
    /// Compare contour and signature with the part at this place of the ranking.
    Candidate(usize),
    /// Tell the robot poses in these numbers.
    UseConvention(Convention),
    /// The next of the conventions.
    NextConvention,
    /// Put the pose on the clipboard, in the convention that was chosen.
    CopyPose,
    /// See in Compare why it was recognised as this part.
    Compare,
    /// Record the source that is followed, or no longer.
    ToggleRecording,
    /// Of the shots of the scan that is shown.
    Shots(ShotsAction),
    /// Have a person choose a file.
    Ask(InspectFile),
    /// A person chose it.
    Chosen(InspectFile, PathBuf),
}

/// What a person is asked to choose.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InspectFile {
    /// The folder that the report of the inspection goes to.
    Report,
    /// Where a picture of the view goes.
    Picture,
    /// Where the spray path goes.
    SprayPath,
    /// A file of the scan.
    Shots(ShotsFile),
}

impl InspectFile {
    pub(super) fn request(self) -> FileRequest {
        match self {
            Self::Report => FileRequest {
                title: text!("inspect-report-folder"),
                filters: Vec::new(),
                choice: FileChoice::FolderToWrite,
            },
            Self::Picture => FileRequest {
                title: text!("inspect-save-picture"),
                filters: vec![(text!("inspect-pictures"), &["png"])],
                choice: FileChoice::NewFile("view.png"),
            },
            Self::SprayPath => FileRequest {
                title: text!("inspect-export-path-title"),
                filters: vec![
                    (text!("inspect-csv"), &["csv"]),
                    ("JSON".into(), &["json"]),
                    program_files(),
                ],
                choice: FileChoice::NewFile("spray-path.csv"),
            },
            Self::Shots(file) => file.request(),
        }
    }
}
