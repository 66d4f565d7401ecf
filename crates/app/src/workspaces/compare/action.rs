//! The actions of the workspace, and its file dialogs.

use std::path::PathBuf;

use super::kept_recipes::NamingPurpose;
use records::cases::{Cell, Truth};
use shell::file_dialog::{FileChoice, FileFilter, FileRequest};
use ui::language::text;

/// An action of a person in the workspace.
#[derive(Clone, Debug)]
pub enum CompareAction {
    /// Do what is due: the workspace came to the front, or another scene did.
    Follow,
    /// Bring the scene that was inspected last to the front.
    FrontScene,
    /// Bring the kept case of this name to the front.
    OpenCase(String),
    /// Set the truth of the case in front; that of a kept case is saved.
    SetTruth(Truth),
    /// Compare with the reference of this entry; without one it follows from truth and verdict.
    Against(Option<String>),
    /// Set the remark that the case is kept with.
    Remark(String),
    /// Keep the scene in front as a case.
    Keep,
    /// Run all kept cases with the recipe on trial.
    RunAll,
    /// Open a file dialog.
    Ask(CompareFile),
    /// Use this folder of cases.
    Folder(PathBuf),
    /// List the cases of this cell of the matrix; `None` shows the matrix.
    ShowCell(Option<Cell>),
    /// Measure from how many references on several workers are faster.
    MeasureScaling,
    /// List the changes since the run that wrote this file.
    Earlier(PathBuf),
    /// Remove the kept case of this name.
    Remove(String),
    /// Give the parameter of this key a value, as [`Parameter::set`](inspection::pipeline::parameters::Parameter::set) takes it.
    Set(&'static str, f64),
    /// Give the parameter of this key its default.
    Reset(&'static str),
    /// Give every parameter its default.
    ResetAll,
    /// Inspect with the recipe on trial from now on.
    Use,
    /// Change the kept recipes.
    Recipe(RecipeAction),
    /// Undo the last change that can be undone.
    Undo,
    /// Redo the change that was undone last.
    Redo,
}

/// An action on the kept recipes; one without a name applies to the recipe on trial.
#[derive(Clone, Debug)]
pub enum RecipeAction {
    /// Try the recipe of this name.
    Open(String),
    /// Save it under its name; ask first if that would replace the recipe of another program.
    Save,
    /// Answer whether saving may replace the recipe of another program.
    Replace(bool),
    /// Save a copy under the next free name, and put the copy on trial.
    Duplicate,
    /// Start to enter a name.
    Name(NamingPurpose),
    /// Set the name as entered so far.
    Write(String),
    /// Use the entered name.
    TakeName,
    /// Give up entering a name.
    CancelName,
    /// Delete it.
    Delete,
    /// Make it the default recipe.
    MakeDefault,
    /// Save the recipe in this file, and put it on trial.
    Import(PathBuf),
    /// Write it to this file.
    Export(PathBuf),
    /// Show or hide the parameters that differ from their defaults.
    ListChanges,
}

/// What a file dialog asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CompareFile {
    /// A folder of kept cases.
    Cases,
    /// The file of an earlier run over all cases.
    EarlierRun,
    /// A recipe to save.
    ImportRecipe,
    /// The file that the recipe on trial is exported to.
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
                choice: FileChoice::NewFile("recipe.toml".into()),
            },
        }
    }
}
