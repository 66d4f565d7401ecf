//! The folder of named recipes: one file for each, and one that names the default recipe.

use std::{
    fs, io,
    path::{Path, PathBuf},
};

use super::{
    named_recipe::{BUILT_IN, BUILT_IN_RECIPES, RecipeFile},
    recipe_error::RecipeError,
};
use crate::library::PartName;
use files::{FileError, disk, folder_of, read_text, sync_folder, user_data, write_text};

const ENDING: &str = "toml";
/// The file that names the default recipe.
const DEFAULT: &str = "default";

/// A folder of recipes; it need not exist before the first recipe is saved.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RecipeFolder {
    path: PathBuf,
}

/// The contents of a folder of recipes.
#[derive(Debug, Default)]
pub struct RecipeList {
    /// The recipes in the order of their names, without the built-in ones.
    pub recipes: Vec<RecipeFile>,
    /// Name of the default recipe; empty if it cannot be read.
    pub default: String,
    /// Errors of the recipes that cannot be read, of files with other names, and of the default.
    pub problems: Vec<RecipeError>,
}

/// Whether saving may replace a recipe of the same name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Replace {
    /// An existing recipe is an error.
    No,
    /// An existing recipe is replaced.
    Yes,
}

impl RecipeFolder {
    /// The folder at this path.
    pub fn at(path: impl Into<PathBuf>) -> Self {
        Self { path: path.into() }
    }

    /// The user's own folder, beside the library in the system's folder for user data.
    pub fn of_user() -> Result<Self, RecipeError> {
        let folder = user_data()?;
        Ok(Self::at(folder.join("recipes")))
    }

    /// Path of the folder.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Path of the file of the recipe of this name.
    pub fn file(&self, name: &PartName) -> PathBuf {
        self.path.join(format!("{name}.{ENDING}"))
    }

    /// Reads all recipes. A damaged one becomes a problem of the list and does not affect the others.
    pub fn list(&self) -> Result<RecipeList, RecipeError> {
        let mut list = RecipeList::default();
        match self.default_name() {
            Ok(name) => list.default = name,
            Err(problem) => list.problems.push(problem),
        }
        for file in self.files()? {
            let read = match name_of(&file) {
                Some(name) if !is_built_in(&name) => self.read(&name),
                _ => Err(RecipeError::BadFileName {
                    path: self.path.join(file),
                }),
            };
            match read {
                Ok(recipe) => list.recipes.push(recipe),
                Err(problem) => list.problems.push(problem),
            }
        }
        Ok(list)
    }

    /// The sorted names, without the built-in ones.
    fn names(&self) -> Result<Vec<PartName>, RecipeError> {
        let mut names = self.file_names()?;
        names.retain(|name| !is_built_in(name));
        Ok(names)
    }

    /// The sorted names of the files, without those that no recipe may have; none if the folder does not exist.
    pub fn file_names(&self) -> Result<Vec<PartName>, RecipeError> {
        let files = self.files()?;
        Ok(files.iter().filter_map(|file| name_of(file)).collect())
    }

    /// The files in the order of their names, without the path of the folder; none if it does not exist.
    fn files(&self) -> Result<Vec<PathBuf>, RecipeError> {
        let reading = |error| FileError::reading(&self.path, error);
        let entries = match fs::read_dir(&self.path) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(Vec::new()),
            entries => entries.map_err(reading)?,
        };
        let mut files = Vec::new();
        for entry in entries {
            let file = PathBuf::from(entry.map_err(reading)?.file_name());
            if file.extension().is_some_and(|ending| ending == ENDING) {
                files.push(file);
            }
        }
        files.sort_by(|a, b| a.file_stem().cmp(&b.file_stem()));
        Ok(files)
    }

    /// Reads the recipe of this name. The file name counts, not the name inside, because the file may have been
    /// copied.
    pub fn read(&self, name: &PartName) -> Result<RecipeFile, RecipeError> {
        if let Some(built_in) = RecipeFile::built_in_named(name) {
            return Ok(built_in);
        }
        match RecipeFile::read(&self.file(name)) {
            Ok(file) => Ok(RecipeFile {
                name: name.clone(),
                ..file
            }),
            Err(RecipeError::File(FileError::NotFound { .. })) => {
                let available = self.names()?.into_iter().map(String::from);
                Err(RecipeError::NotFound {
                    name: name.to_string(),
                    available: available.collect(),
                })
            }
            Err(error) => Err(error),
        }
    }

    /// Saves a recipe under its name, and returns it as its file holds it.
    pub fn save(&self, recipe: &RecipeFile, replace: Replace) -> Result<RecipeFile, RecipeError> {
        let path = self.changeable(&recipe.name)?;
        if replace == Replace::No && path.symlink_metadata().is_ok() {
            let name = recipe.name.to_string();
            return Err(RecipeError::Exists { name });
        }
        self.make()?;
        recipe.write(&path)
    }

    /// Removes a recipe; if it was the default, the built-in recipe becomes the default.
    pub fn remove(&self, name: &PartName) -> Result<(), RecipeError> {
        let path = self.changeable(name)?;
        match disk::remove_file(&path) {
            Ok(()) => {}
            // The error of `read` names the recipes that exist.
            Err(error) if error.kind() == io::ErrorKind::NotFound => {
                self.read(name)?;
            }
            Err(error) => return Err(FileError::writing(&path, error).into()),
        }
        sync_folder(&self.path).map_err(|error| FileError::writing(&path, error))?;
        if self.is_default(name) {
            self.set_default(&RecipeFile::built_in().name)?;
        }
        Ok(())
    }

    /// Renames a recipe; if it was the default, it stays the default.
    pub fn rename(&self, from: &PartName, to: &PartName) -> Result<RecipeFile, RecipeError> {
        self.changeable(from)?;
        let was_default = self.is_default(from);
        let renamed = RecipeFile {
            name: to.clone(),
            ..self.read(from)?
        };
        let renamed = self.save(&renamed, Replace::No)?;
        if was_default {
            self.set_default(to)?;
        }
        self.remove(from)?;
        Ok(renamed)
    }

    /// Name of the default recipe.
    pub fn default_name(&self) -> Result<String, RecipeError> {
        match read_text(&self.path.join(DEFAULT), 1000) {
            Ok(text) => Ok(text.trim().to_owned()),
            Err(FileError::NotFound { .. }) => Ok(BUILT_IN.into()),
            // A file is in place of a parent folder.
            Err(FileError::Read { source, .. })
                if source.kind() == io::ErrorKind::NotADirectory =>
            {
                Ok(BUILT_IN.into())
            }
            Err(error) => Err(RecipeError::BadDefault(error)),
        }
    }

    /// True if this recipe is the default; while the default cannot be read, none is.
    pub fn is_default(&self, name: &PartName) -> bool {
        self.default_name()
            .is_ok_and(|default| default == name.as_str())
    }

    /// Makes this recipe the default.
    pub fn set_default(&self, name: &PartName) -> Result<(), RecipeError> {
        self.read(name)?;
        self.make()?;
        write_text(&self.path.join(DEFAULT), &format!("{name}\n"))?;
        Ok(())
    }

    /// Reads the default recipe.
    fn read_default(&self) -> Result<RecipeFile, RecipeError> {
        let name = self.default_name()?;
        let recipe = PartName::new(&name)
            .map_err(RecipeError::from)
            .and_then(|name| self.read(&name));
        recipe.map_err(|error| RecipeError::NoDefault {
            name,
            reason: error.to_string(),
        })
    }

    /// Path of the file of a recipe, unless it is a built-in one, which cannot be changed.
    fn changeable(&self, name: &PartName) -> Result<PathBuf, RecipeError> {
        if is_built_in(name) {
            let name = name.to_string();
            return Err(RecipeError::BuiltIn { name });
        }
        Ok(self.file(name))
    }

    /// Makes the folder unless it exists.
    pub fn make(&self) -> Result<(), RecipeError> {
        let made = disk::create_dir_all(&self.path);
        let made = made.and_then(|()| sync_folder(folder_of(&self.path)));
        made.map_err(|error| FileError::writing(&self.path, error).into())
    }
}

/// The name of the recipe in a file, if it is one that a recipe can have.
fn name_of(file: &Path) -> Option<PartName> {
    PartName::new(file.file_stem()?.to_str()?).ok()
}

fn is_built_in(name: &PartName) -> bool {
    BUILT_IN_RECIPES.contains(&name.as_str())
}

/// Opens the recipe of this name in the folder, or the recipe file at this path; a text that cannot be a name is a
/// path. Without either it opens the default recipe, or the built-in one if there is no folder.
pub fn open_recipe(
    folder: Result<RecipeFolder, RecipeError>,
    given: Option<&str>,
) -> Result<RecipeFile, RecipeError> {
    let Some(given) = given else {
        return match folder {
            Ok(folder) => folder.read_default(),
            Err(_) => Ok(RecipeFile::built_in()),
        };
    };
    match PartName::new(given) {
        Ok(name) => match RecipeFile::built_in_named(&name) {
            Some(built_in) => Ok(built_in),
            None => folder?.read(&name),
        },
        Err(_) => RecipeFile::read(Path::new(given)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pipeline::{Recipe, built_in_recipe};
    use geometry::error::Advice as _;

    fn name(text: &str) -> PartName {
        PartName::new(text).expect("a name")
    }

    fn recipe(text: &str, min_score: f64) -> RecipeFile {
        let mut recipe = Recipe::default();
        recipe.accept.min_score = min_score;
        RecipeFile {
            name: name(text),
            notes: String::new(),
            recipe,
        }
    }

    fn folder() -> (tempfile::TempDir, RecipeFolder) {
        let data = tempfile::tempdir().expect("a folder");
        let folder = RecipeFolder::at(data.path().join("new").join("recipes"));
        (data, folder)
    }

    fn names(folder: &RecipeFolder) -> Vec<String> {
        let list = folder.list().expect("listed");
        list.recipes.iter().map(|r| r.name.to_string()).collect()
    }

    #[test]
    fn recipes_are_saved_renamed_and_removed() {
        let (_data, folder) = folder();
        assert!(names(&folder).is_empty());
        let glossy = recipe("glossy", 0.8);
        let save = |recipe: &RecipeFile, replace| folder.save(recipe, replace);
        assert_eq!(save(&glossy, Replace::No).expect("saved"), glossy);
        save(&recipe("matt", 0.95), Replace::No).expect("saved");
        let again = save(&recipe("glossy", 0.7), Replace::No);
        assert!(matches!(again, Err(RecipeError::Exists { .. })));
        assert_eq!(folder.read(&name("glossy")).expect("kept"), glossy);
        save(&recipe("glossy", 0.7), Replace::Yes).expect("replaced");
        folder
            .rename(&name("glossy"), &name("shiny"))
            .expect("renamed");
        assert!(folder.rename(&name("shiny"), &name("matt")).is_err());
        assert_eq!(names(&folder), ["matt", "shiny"]);
        assert_eq!(
            folder.read(&name("shiny")).expect("kept").recipe,
            recipe("x", 0.7).recipe
        );
        folder.remove(&name("matt")).expect("removed");
        assert_eq!(names(&folder), ["shiny"]);
        let missing = folder.remove(&name("shine")).expect_err("none");
        assert!(missing.advice().contains("shiny"), "{}", missing.advice());
    }

    #[test]
    fn the_programs_own_recipe_is_read_and_never_changed() {
        let (_data, folder) = folder();
        let saved = folder.save(&recipe("x", 0.5), Replace::No);
        saved.expect("saved");
        for own in BUILT_IN_RECIPES {
            let changed = folder.save(&recipe(own, 0.5), Replace::Yes);
            assert!(matches!(changed, Err(RecipeError::BuiltIn { name }) if name == own));
            let own = name(own);
            let read = folder.read(&own).expect("there");
            assert_eq!(Some(read.recipe), built_in_recipe(own.as_str()));
            assert!(folder.remove(&own).is_err());
            assert!(folder.rename(&own, &name("y")).is_err());
            assert!(folder.rename(&name("x"), &own).is_err());
        }
        assert_eq!(built_in_recipe(BUILT_IN), Some(Recipe::default()));
        assert_eq!(names(&folder), ["x"]);
    }

    #[test]
    fn where_a_file_lies_in_place_of_the_folder_the_programs_own_recipe_is_used() {
        let data = tempfile::tempdir().expect("a folder");
        fs::write(data.path().join("data"), "x").expect("written");
        let folder = RecipeFolder::at(data.path().join("data").join("recipes"));
        let opened = open_recipe(Ok(folder.clone()), None).expect("opened");
        assert_eq!(opened, RecipeFile::built_in());
        let refused = folder.save(&recipe("glossy", 0.8), Replace::No);
        assert!(matches!(refused, Err(RecipeError::File(_))));
    }

    #[test]
    fn the_default_is_chosen_follows_its_name_and_ends_with_the_recipe() {
        let (_data, folder) = folder();
        let default = || {
            let opened = open_recipe(Ok(folder.clone()), None).expect("opened");
            opened.name.to_string()
        };
        assert_eq!(default(), BUILT_IN);
        assert!(folder.set_default(&name("glossy")).is_err());
        folder
            .save(&recipe("glossy", 0.8), Replace::No)
            .expect("saved");
        folder.set_default(&name("glossy")).expect("chosen");
        assert_eq!(default(), "glossy");
        folder
            .rename(&name("glossy"), &name("shiny"))
            .expect("renamed");
        assert_eq!(default(), "shiny");
        folder.remove(&name("shiny")).expect("removed");
        assert_eq!(default(), BUILT_IN);
        // If the default was removed by hand or is damaged, no other recipe is used in its place.
        for contents in ["glossy\n", "../glossy", "\u{0}"] {
            fs::write(folder.path().join(DEFAULT), contents).expect("written");
            let error = open_recipe(Ok(folder.clone()), None).expect_err(contents);
            assert!(matches!(error, RecipeError::NoDefault { .. }), "{error}");
            let named = open_recipe(Ok(folder.clone()), Some(BUILT_IN));
            assert!(named.is_ok());
        }
    }

    #[test]
    fn a_damaged_recipe_is_named_and_the_others_are_there() {
        let (_data, folder) = folder();
        folder
            .save(&recipe("glossy", 0.8), Replace::No)
            .expect("saved");
        fs::copy(folder.file(&name("glossy")), folder.file(&name("copy"))).expect("copied");
        fs::write(folder.file(&name("bad")), "schema = 7").expect("written");
        for other in ["note.txt", "No Name.toml", "built-in.toml"] {
            fs::write(folder.path().join(other), "x").expect("written");
        }
        let list = folder.list().expect("listed");
        assert_eq!(names(&folder), ["copy", "glossy"]);
        let problems: Vec<String> = list.problems.iter().map(ToString::to_string).collect();
        assert_eq!(problems.len(), 3, "{problems:?}");
        for (problem, file) in problems
            .iter()
            .zip(["No Name.toml", "bad.toml", "built-in.toml"])
        {
            assert!(problem.contains(file), "{problem}");
        }
    }

    #[test]
    fn while_the_default_cannot_be_read_only_what_uses_it_is_refused() {
        let (_data, folder) = folder();
        for name in ["glossy", "matt"] {
            folder.save(&recipe(name, 0.8), Replace::No).expect("saved");
        }
        fs::write(folder.path().join(DEFAULT), "").expect("written");
        let list = folder.list().expect("listed");
        assert_eq!((list.recipes.len(), list.default.as_str()), (2, ""));
        assert!(list.problems[0].advice().contains("default built-in"));
        let refused = open_recipe(Ok(folder.clone()), None).expect_err("no default");
        assert!(refused.to_string().contains(DEFAULT), "{refused}");
        assert!(refused.advice().contains("default built-in"));
        folder
            .rename(&name("matt"), &name("silk"))
            .expect("renamed");
        folder.remove(&name("glossy")).expect("removed");
        folder.set_default(&name(BUILT_IN)).expect("chosen");
        assert_eq!(folder.default_name().expect("read"), BUILT_IN);
        assert_eq!(names(&folder), ["silk"]);
    }

    #[test]
    fn whatever_cannot_be_a_name_is_a_file() {
        let (data, folder) = folder();
        let path = data.path().join("other.toml");
        recipe("glossy", 0.8).write(&path).expect("written");
        let given = path.to_str().expect("text");
        let opened = open_recipe(Ok(folder.clone()), Some(given)).expect("opened");
        assert_eq!(opened, recipe("glossy", 0.8));
        let unknown = open_recipe(Ok(folder), Some("glossy")).expect_err("not kept");
        assert!(unknown.advice().contains("./glossy"));
        let nowhere = open_recipe(Err(FileError::NoUserFolder.into()), None);
        assert_eq!(
            nowhere.expect("the program's own").recipe,
            Recipe::default()
        );
    }

    #[cfg(unix)]
    #[test]
    fn whichever_call_fails_no_recipe_is_lost() {
        use files::disk::faults::{Writer, with_advice};

        const TEST: &str = "pipeline::recipe_folder::tests::whichever_call_fails_no_recipe_is_lost";
        type Change = fn(&RecipeFolder) -> Result<(), RecipeError>;
        let changes: [(Change, &[&str]); 3] = [
            (
                |folder| folder.save(&recipe("matt", 0.9), Replace::Yes).map(|_| ()),
                &[],
            ),
            // The recipe exists under both names before the old one is removed.
            (
                |folder| folder.rename(&name("matt"), &name("silk")).map(|_| ()),
                &[
                    "matt 0.5, silk 0.5, default matt",
                    "matt 0.5, silk 0.5, default silk",
                ],
            ),
            // The file is removed before the default changes; the order on disk may differ.
            (
                |folder| folder.remove(&name("matt")),
                &["matt 0.5, default built-in", "default matt"],
            ),
        ];
        let at = |folder: &Path| RecipeFolder::at(folder.join("recipes"));
        for (number, (change, between)) in changes.iter().enumerate() {
            // The process to be killed recognises its change by its folder alone.
            let is_mine = |folder: &Path| folder.join(number.to_string()).exists();
            Writer {
                test: TEST,
                prepare: &|folder| {
                    fs::write(folder.join(number.to_string()), "").expect("written");
                    let folder = at(folder);
                    folder
                        .save(&recipe("matt", 0.5), Replace::No)
                        .expect("saved");
                    folder.set_default(&name("matt")).expect("set");
                },
                write: &|folder| {
                    if !is_mine(folder) {
                        return Ok(());
                    }
                    change(&at(folder)).map_err(|error| with_advice(&error))
                },
                state: &|folder| {
                    let list = at(folder).list().expect("listed");
                    assert!(list.problems.is_empty(), "{:?}", list.problems);
                    let recipes = list.recipes.iter();
                    let recipes = recipes.map(|recipe| {
                        format!("{} {}, ", recipe.name, recipe.recipe.accept.min_score)
                    });
                    format!("{}default {}", recipes.collect::<String>(), list.default)
                },
                between,
            }
            .fails_at_every_call();
        }
    }
}
