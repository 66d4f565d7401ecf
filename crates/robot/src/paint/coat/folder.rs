//! Coats by name: the built-in ones, and the user's, each in a file beside the recipes of inspections.

use std::path::{Path, PathBuf};

use super::Coat;
use files::{FileError, nearest_name};
use geometry::error::Advice;
use inspection::{
    library::PartName,
    pipeline::{RecipeError, RecipeFile, RecipeFolder, Replace},
};

/// Names and files of the built-in coats.
const FILES: [(&str, &str); 3] = [
    (
        "primer",
        include_str!("../../../../../assets/coats/primer.toml"),
    ),
    (
        "base_coat",
        include_str!("../../../../../assets/coats/base_coat.toml"),
    ),
    (
        "clear_coat",
        include_str!("../../../../../assets/coats/clear_coat.toml"),
    ),
];

/// Names of the built-in coats, in the order in which they are sprayed.
pub const BUILT_IN_COATS: [&str; 3] = [FILES[0].0, FILES[1].0, FILES[2].0];

/// Returns the built-in coat of this name.
pub fn built_in_coat(name: &str) -> Option<RecipeFile<Coat>> {
    let (_, text) = FILES.iter().find(|(own, _)| *own == name)?;
    Some(RecipeFile::parse(Path::new(name), text).expect("a test reads every built-in coat"))
}

/// A folder of coats; it need not exist.
#[derive(Clone, Debug)]
pub struct CoatFolder {
    files: RecipeFolder,
}

/// Why a coat cannot be read or written.
#[derive(Debug, thiserror::Error, Advice)]
pub enum CoatError {
    /// The file cannot be read or written.
    #[error(transparent)]
    #[advice(match _0 {
        RecipeError::BadParameter { .. } => {
            "Correct the file (none of it was used); docs/guide/paint.md lists names, units and ranges".into()
        }
        other => other.advice(),
    })]
    File(#[from] RecipeError),
    /// No coat has this name.
    #[error("there is no coat named {name}")]
    #[advice(match nearest_name(available.iter().map(String::as_str), name) {
        Some(nearest) => {
            format!("The nearest name is {nearest}; partsight path plan --help names the coats of the program")
        }
        None => format!("Give one of {}, or a file", available.join(", ")),
    })]
    NotFound {
        /// The name given.
        name: String,
        /// Names of all coats.
        available: Vec<String>,
    },
    /// The name belongs to a built-in coat, or to one that must not be replaced.
    #[error("there is a coat named {name} already")]
    #[advice = "Choose another name"]
    Exists {
        /// The name.
        name: String,
    },
}

impl CoatFolder {
    /// The folder at this path.
    pub fn at(path: impl Into<PathBuf>) -> Self {
        Self {
            files: RecipeFolder::at(path),
        }
    }

    /// The user's own folder, beside the recipes.
    pub fn of_user() -> Result<Self, CoatError> {
        Ok(Self::at(
            RecipeFolder::of_user()?.path().with_file_name("coats"),
        ))
    }

    /// Names of all coats, the built-in ones first.
    pub fn names(&self) -> Result<Vec<String>, CoatError> {
        let own = self.files.file_names()?.into_iter().map(String::from);
        let own = own.filter(|name| !BUILT_IN_COATS.contains(&name.as_str()));
        Ok(BUILT_IN_COATS
            .map(String::from)
            .into_iter()
            .chain(own)
            .collect())
    }

    /// Opens the coat of a name, or in a file: anything that cannot be a name is a path.
    pub fn open(&self, given: &str) -> Result<RecipeFile<Coat>, CoatError> {
        let Ok(name) = PartName::new(given) else {
            return Ok(RecipeFile::read(Path::new(given))?);
        };
        if let Some(own) = built_in_coat(given) {
            return Ok(own);
        }
        match RecipeFile::read(&self.files.file(&name)) {
            // The file's name counts: the file may have been copied.
            Ok(file) => Ok(RecipeFile { name, ..file }),
            Err(RecipeError::File(FileError::NotFound { .. })) => Err(CoatError::NotFound {
                name: given.to_owned(),
                available: self.names()?,
            }),
            Err(error) => Err(error.into()),
        }
    }

    /// Saves a coat under its name, which must not be that of a built-in one.
    pub fn save(&self, coat: &RecipeFile<Coat>, replace: Replace) -> Result<(), CoatError> {
        let path = self.files.file(&coat.name);
        let is_there = || replace == Replace::No && path.symlink_metadata().is_ok();
        if built_in_coat(coat.name.as_str()).is_some() || is_there() {
            let name = coat.name.to_string();
            return Err(CoatError::Exists { name });
        }
        self.files.make()?;
        coat.write(&path)?;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_coat_is_opened_by_name_and_by_file() {
        let data = tempfile::tempdir().expect("a folder");
        let folder = CoatFolder::at(data.path().join("coats"));
        assert_eq!(folder.names().expect("names"), BUILT_IN_COATS);
        let mut coat = folder.open("primer").expect("built in");
        for replace in [Replace::No, Replace::Yes] {
            let refused = folder.save(&coat, replace).expect_err("the program's own");
            assert!(matches!(refused, CoatError::Exists { .. }));
        }
        coat.name = PartName::new("my_primer").expect("a name");
        coat.recipe.spacing = 0.05;
        folder.save(&coat, Replace::No).expect("saved");
        let file = data.path().join("coats/my_primer.toml");
        assert_eq!(folder.open("my_primer").expect("opened"), coat);
        assert_eq!(
            folder.open(&file.display().to_string()).expect("opened"),
            coat
        );
        assert_eq!(folder.names().expect("names").len(), 4);
        let refused = folder.save(&coat, Replace::No).expect_err("there is one");
        assert!(matches!(refused, CoatError::Exists { .. }));
        coat.recipe.spacing = 0.06;
        folder.save(&coat, Replace::Yes).expect("replaced");
        assert_eq!(folder.open("my_primer").expect("opened"), coat);
        let missing = folder.open("my_premier").expect_err("no such coat");
        assert!(
            missing.advice().contains("my_primer"),
            "{}",
            missing.advice()
        );
        std::fs::write(
            &file,
            "schema = 1\nname = \"my_primer\"\n[parameters]\nspacing = \"0 mm\"\n",
        )
        .expect("written");
        let refused = folder.open("my_primer").expect_err("spacing 0");
        assert!(
            refused.to_string().contains("from 5 to 500 mm"),
            "{refused}"
        );
        assert!(refused.advice().contains("paint.md"));
    }

    #[test]
    fn every_built_in_coat_is_read_under_its_name_and_nearly_reaches_its_target() {
        for name in BUILT_IN_COATS {
            let coat = built_in_coat(name).expect("built in");
            assert_eq!(coat.name.as_str(), name);
            assert!(coat.notes.len() > 20);
            let film = coat.recipe.flat_thickness() / coat.recipe.target;
            assert!((film - 1.0).abs() < 0.1, "{name}: {film}");
        }
    }
}
