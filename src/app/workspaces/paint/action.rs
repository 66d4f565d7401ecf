//! What can happen in the workspace, and what a person is asked to choose.

use std::path::PathBuf;

use super::region::PaintTool;
use crate::{
    app::{
        language::text,
        shell::{
            file_dialog::{FileChoice, FileRequest, all_files},
            program_setup::{ProgramSetup, program_file_name, program_files},
        },
        ui::parameter_control::ParameterChange,
    },
    library::PartName,
    paint::{KeepOut, PathEdit},
    robot::Convention,
};

/// Something that happened in the workspace.
#[derive(Clone, Debug, PartialEq)]
pub enum PaintAction {
    /// Paint this enrolled part.
    ChoosePart(PartName),
    /// Use the coat of this name.
    ChooseCoat(String),
    /// Change the parameter of this key.
    Change(&'static str, ParameterChange),
    /// Every parameter as the coat has it.
    ResetCoat,
    /// Write a name for the coat, or stop.
    Name(Option<String>),
    /// Keep the coat under the name that was written.
    SaveCoat,
    /// Show this path.
    Show(ShownPath),
    /// What a left drag in the view does.
    Use(PaintTool),
    /// Add these regions; areas to be painted replace none.
    Add(Vec<KeepOut>),
    /// Correct the path by hand.
    Edit(PathEdit),
    /// Forget all regions, and what was corrected by hand.
    Clear,
    /// Take the last step back.
    Undo,
    /// Do it again.
    Redo,
    /// Find spacing and speed.
    Propose,
    /// Store the path with the part.
    Store,
    /// Colour the part by the film, or by its shape alone.
    ToggleFilm,
    /// Write robot programs for this arm and gun.
    SetUp(ProgramSetup),
    /// To the next point that the arm does not reach.
    ShowUnreached,
    /// Have a person choose a file.
    Ask(PaintFile),
    /// A person chose it.
    Chosen(PaintFile, PathBuf),
    /// Show the gun after this many seconds of the path.
    Scrub(f64),
    /// To the next or the last stroke.
    Step(i32),
    /// Play or pause.
    TogglePlay,
    /// Seconds that have passed while playing.
    Advance(f64),
}

/// Which path is shown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ShownPath {
    /// The one that the coat gives.
    #[default]
    Planned,
    /// The one that is stored with the part.
    Stored,
}

/// What a person is asked to choose.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PaintFile {
    /// Where the path is written to as a table.
    Table,
    /// Where it is written to as a robot program.
    Program,
    /// The arm, as a TOML file.
    Arm,
    /// Boxes and floor of the cell, as a TOML file.
    Obstacles,
}

impl PaintFile {
    /// What is asked; a program is called as the robot of `convention` has its files.
    pub(super) fn request(self, convention: Convention) -> FileRequest {
        match self {
            Self::Program => FileRequest {
                title: text!("paint-program-title"),
                filters: vec![program_files()],
                choice: FileChoice::NewFile(program_file_name(convention)),
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
                filters: vec![(text!("paint-csv-files"), &["csv"])],
                choice: FileChoice::NewFile("path.csv"),
            },
        }
    }
}
