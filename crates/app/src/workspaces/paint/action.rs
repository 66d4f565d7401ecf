//! Actions of the workspace, and the files that it asks for.

use std::path::PathBuf;

use super::region::PaintTool;
use inspection::library::{PartName, Side};
use robot::paint::{KeepOut, PathEdit};
use shell::{
    cell::{ProgramSetup, program_file_name},
    file_dialog::{FileChoice, FileRequest, all_files, program_files},
    session::Session,
};
use ui::{language::text, parameter_control::ParameterChange};

/// An action in the workspace.
#[derive(Clone, Debug, PartialEq)]
pub enum PaintAction {
    /// Paint this enrolled part.
    ChoosePart(PartName),
    /// Paint the part from this side from now on.
    ChooseSide(Side),
    /// Use the coat of this name.
    ChooseCoat(String),
    /// Change the parameter with this key.
    Change(&'static str, ParameterChange),
    /// Reset every parameter to the saved coat.
    ResetCoat,
    /// Set the name being entered for the coat; `None` closes the field.
    Name(Option<String>),
    /// Save the coat under the entered name.
    SaveCoat,
    /// Choose the path to show.
    Show(ShownPath),
    /// Choose what a left drag in the view does.
    Use(PaintTool),
    /// Add these regions; new areas to be painted join the earlier ones.
    Add(Vec<KeepOut>),
    /// Correct the path by hand.
    Edit(PathEdit),
    /// Remove all regions and corrections by hand.
    Clear,
    /// Undo the last step.
    Undo,
    /// Redo the step undone last.
    Redo,
    /// Propose row spacing and speed.
    Propose,
    /// Store the path with the part.
    Store,
    /// Switch between colours by film and plain shape.
    ToggleFilm,
    /// Set arm and gun for robot programs.
    SetUp(ProgramSetup),
    /// Move to the next point that the arm does not reach.
    ShowUnreached,
    /// Ask for a file.
    Ask(PaintFile),
    /// A file was chosen.
    Chosen(PaintFile, PathBuf),
    /// Move to this time on the path, seconds.
    Scrub(f64),
    /// Move by this many strokes.
    Step(i32),
    /// Play or pause.
    TogglePlay,
    /// Advance playback by this many seconds.
    Advance(f64),
}

/// The path shown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ShownPath {
    /// The path planned with the coat.
    #[default]
    Planned,
    /// The path stored with the part.
    Stored,
}

/// A file that a person is asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PaintFile {
    /// The table that the path is written to.
    Table,
    /// The robot program that the path is written to.
    Program,
    /// The arm, a TOML file.
    Arm,
    /// The cell's boxes and floor, a TOML file.
    Obstacles,
}

impl PaintFile {
    /// The dialog to open. A new file is named after the part, a program as usual for the robot.
    pub(super) fn request(self, part: Option<&PartName>, session: &Session) -> FileRequest {
        let part = part.map_or("part", PartName::as_str);
        match self {
            Self::Program => FileRequest {
                title: text!("paint-program-title"),
                filters: vec![program_files()],
                choice: FileChoice::NewFile(program_file_name(
                    part,
                    &session.program,
                    session.convention,
                )),
            },
            Self::Arm => FileRequest {
                title: text!("paint-arm-title"),
                filters: vec![("TOML".into(), &["toml"]), all_files()],
                choice: FileChoice::File,
            },
            Self::Obstacles => FileRequest {
                title: text!("paint-obstacles-title"),
                filters: vec![("TOML".into(), &["toml"]), all_files()],
                choice: FileChoice::File,
            },
            Self::Table => FileRequest {
                title: text!("paint-export-title"),
                filters: vec![(text!("shell-csv-files"), &["csv"])],
                choice: FileChoice::NewFile(format!("{part}-path.csv")),
            },
        }
    }
}
