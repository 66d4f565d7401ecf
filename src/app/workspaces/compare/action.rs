//! What can happen in the workspace, and what a person is asked to choose.

use std::path::PathBuf;

use super::kept_recipes::NamingPurpose;
use crate::{
    app::{
        language::text,
        shell::file_dialog::{FileChoice, FileFilter, FileRequest},
    },
    cases::{Cell, Truth},
};

/// Something that happened in the workspace.
#[derive(Clone, Debug)]
pub enum CompareAction {
    /// Look whether there is something to do: the workspace came to the front, or another scene did.
    Follow,
    /// The case in front is the scene that was inspected last.
    FrontScene,
    /// The kept case of this name comes to the front.
    OpenCase(String),
    /// This is what it truly is.
    SetTruth(Truth),
    /// Compare with this part; without one the part follows from truth and verdict.
    Against(Option<String>),
    /// The remark that the case is kept with.
    Remark(String),
    /// Keep the case in front.
    Keep,
    /// Run all kept cases with the recipe on trial.
    RunAll,
    /// Have a person choose a file or folder.
    Ask(CompareFile),
    /// Use this folder of cases.
    Folder(PathBuf),
    /// List the cases of this cell of the matrix, or show the matrix.
    ShowCell(Option<Cell>),
    /// Measure from how many references on several workers pay.
    MeasureScaling,
    /// List what changed since the run that has written this file.
    Earlier(PathBuf),
    /// Remove the kept case of this name.
    Remove(String),
    /// Give the parameter of this key a value, as [`Parameter::set`](crate::pipeline::parameters::Parameter::set) takes it.
    Set(&'static str, f64),
    /// Give the parameter of this key its default.
    Reset(&'static str),
    /// Give every parameter its default.
    ResetAll,
    /// Inspect with the recipe on trial from now on.
    Use,
    /// Do something with the kept recipes.
    Recipe(RecipeAction),
    /// Take back what was done last.
    Undo,
}

/// What can be done with the kept recipes. Without a name it is about the recipe on trial.
#[derive(Clone, Debug)]
pub enum RecipeAction {
    /// Try the recipe of this name.
    Open(String),
    /// Keep it under its name.
    Save,
    /// Keep a copy of it under the next free name, which is then on trial.
    Duplicate,
    /// Begin to write a name.
    Name(NamingPurpose),
    /// This is written so far.
    Write(String),
    /// The name is written: do what it is for.
    TakeName,
    /// Leave the name.
    CancelName,
    /// Remove it.
    Delete,
    /// Use it where no recipe is named.
    MakeDefault,
    /// Keep the recipe in this file, and try it.
    Import(PathBuf),
    /// Write it to this file.
    Export(PathBuf),
    /// List the parameters that differ from their defaults, or no longer.
    ListChanges,
}

/// What a person is asked to choose.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CompareFile {
    /// A folder of kept cases.
    Cases,
    /// What an earlier run of all cases has written.
    EarlierRun,
    /// A recipe to keep.
    ImportRecipe,
    /// Where the recipe on trial is written to.
    ExportRecipe,
}

fn recipes() -> FileFilter {
    (text!("compare-recipe-files"), &["toml"])
}

impl CompareFile {
    pub(super) fn request(self) -> FileRequest {
        match self {
            Self::Cases => FileRequest {
                title: text!("compare-cases-title"),
                filters: Vec::new(),
                choice: FileChoice::Folder,
            },
            Self::EarlierRun => FileRequest {
                title: text!("compare-earlier-title"),
                filters: vec![(text!("compare-evaluation-files"), &["json"])],
                choice: FileChoice::File,
            },
            Self::ImportRecipe => FileRequest {
                title: text!("compare-import-title"),
                filters: vec![recipes()],
                choice: FileChoice::File,
            },
            Self::ExportRecipe => FileRequest {
                title: text!("compare-export-title"),
                filters: vec![recipes()],
                choice: FileChoice::NewFile("recipe.toml"),
            },
        }
    }
}
