//! Errors of recipes and their files.

use std::path::PathBuf;

use super::{
    named_recipe::{BUILT_IN, MAX_NOTES},
    parameters::SettingError,
};
use crate::library::BadName;
use files::{FileError, nearest_name};
use geometry::error::Advice;
use texts::Message;

/// Why a recipe cannot be read, written or used.
#[derive(Debug, thiserror::Error, Advice)]
pub enum RecipeError {
    /// The file cannot be read or written.
    #[error(transparent)]
    #[advice(transparent)]
    File(#[from] FileError),
    /// Not what a recipe file looks like.
    #[error("{} is not a recipe: {reason}", path.display())]
    #[advice = "Give a file that Partsight exported, or write one as docs/guide/files.md shows"]
    Garbled {
        /// The file.
        path: PathBuf,
        /// What the parser reported.
        reason: String,
    },
    /// A parameter does not exist, or cannot have this value.
    #[error("{}: {source}", path.display())]
    #[advice = "Correct the file (none of it was used); docs/guide/parameters.md lists names, units and ranges"]
    BadParameter {
        /// The file.
        path: PathBuf,
        /// The underlying error.
        source: SettingError,
    },
    /// The name is not valid.
    #[error(transparent)]
    #[advice(transparent)]
    BadName(#[from] BadName),
    /// Notes too long to keep.
    #[error("the notes have {found} characters, but at most {MAX_NOTES} are kept")]
    #[advice = "Shorten the notes"]
    LongNotes {
        /// Characters given.
        found: usize,
    },
    /// No recipe of this name.
    #[error("there is no recipe named {name}")]
    #[advice(recipe_to_name(name, available))]
    NotFound {
        /// The name given.
        name: String,
        /// Names of the recipes that exist.
        available: Vec<String>,
    },
    /// The file that names the default recipe cannot be read.
    #[error("the default recipe is unknown: {0}")]
    #[advice(another_default())]
    BadDefault(FileError),
    /// No recipe of the user can have the name of the file.
    #[error("{} is not used: its name is not one that a recipe can have", path.display())]
    #[advice = "Rename the file: lowercase letters, digits, _ and -, for example glossy.toml"]
    BadFileName {
        /// The file.
        path: PathBuf,
    },
    /// The default recipe is missing or cannot be read.
    #[error("the default recipe {name} cannot be used: {reason}")]
    #[advice(another_default())]
    NoDefault {
        /// Its name.
        name: String,
        /// Why it cannot be used.
        reason: String,
    },
    /// Another recipe has the name.
    #[error("{}", Message::new("recipe-exists").with("name", name.as_str()))]
    #[advice = "Choose another name"]
    Exists {
        /// The name.
        name: String,
    },
    /// A recipe of the program itself cannot be changed.
    #[error("{name} is the program's own recipe and cannot be changed")]
    #[advice = "Choose another name"]
    BuiltIn {
        /// The name.
        name: String,
    },
}

fn recipe_to_name(name: &str, available: &[String]) -> String {
    let nearest = nearest_name(available.iter().map(String::as_str), name);
    let file = format!("to name a file, write ./{name}");
    match nearest {
        Some(nearest) => format!("The nearest name is {nearest}; {file}"),
        None if available.is_empty() => {
            format!("There are no recipes yet: save one, or use {BUILT_IN}; {file}")
        }
        None => format!("Give one that partsight recipe list shows; {file}"),
    }
}

fn another_default() -> String {
    format!("Choose another: partsight recipe default {BUILT_IN}; or name one with --recipe")
}
