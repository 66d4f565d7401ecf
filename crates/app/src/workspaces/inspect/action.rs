//! Actions of the workspace, and the files that it asks for.

use std::path::PathBuf;

use super::state::ViewPart;
use crate::shots::{ShotsAction, ShotsFile};
use shell::{
    action::Action,
    file_dialog::{FileChoice, FileRequest, program_files},
    inspection::figures::StagePanel,
    session::Session,
};
use ui::{language::text, viewport::Colouring};

/// An action in the workspace.
#[derive(Clone, Debug)]
pub enum InspectAction {
    /// Show or hide this in the view.
    Toggle(ViewPart),
    /// Choose what colours the points.
    Colour(Colouring),
    /// Enlarge a stage to fill the middle; `None` shows the view again.
    Enlarge(Option<StagePanel>),
    /// Show the part that many places further in the frame, in a circle.
    NextPart(isize),
    /// Compare contour and signature with the part at this index of the ranking.
    Candidate(usize),
    /// Copy the pose to the clipboard, in the chosen convention.
    CopyPose,
    /// Make the scene in front the draft of Enrol, and go there.
    Enrol,
    /// An action of the shell.
    Act(Action),
    /// An action on the shots of the scan shown.
    Shots(ShotsAction),
    /// Ask for a file.
    Ask(InspectFile),
    /// A file was chosen.
    Chosen(InspectFile, PathBuf),
}

/// A file or folder that a person is asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InspectFile {
    /// The folder that the report of the inspection is written to.
    Report,
    /// The file that a picture of the view is written to.
    Picture,
    /// The file that the spray path is written to.
    SprayPath,
    /// A file of the scan.
    Shots(ShotsFile),
}

impl InspectFile {
    /// The dialog to open; a new file is named after the part that was inspected last.
    pub(super) fn request(self, session: &Session) -> FileRequest {
        let shown = session.shown.as_ref();
        let verdict = shown.map(|shown| &shown.inspected.inspection.verdict);
        let verdict = verdict.filter(|verdict| !verdict.is_unknown());
        let part = verdict.and_then(|verdict| verdict.guess());
        let part = part.unwrap_or("scene");
        match self {
            Self::Report => FileRequest {
                title: text!("inspect-report-folder"),
                filters: Vec::new(),
                choice: FileChoice::FolderToWrite,
            },
            Self::Picture => FileRequest {
                title: text!("inspect-save-picture"),
                filters: vec![(text!("inspect-pictures"), &["png"])],
                choice: FileChoice::NewFile(format!("{part}.png")),
            },
            Self::SprayPath => FileRequest {
                title: text!("inspect-export-path-title"),
                filters: vec![
                    (text!("shell-csv-files"), &["csv"]),
                    ("JSON".into(), &["json"]),
                    program_files(),
                ],
                choice: FileChoice::NewFile(format!("{part}-path.csv")),
            },
            Self::Shots(file) => file.request(),
        }
    }
}
