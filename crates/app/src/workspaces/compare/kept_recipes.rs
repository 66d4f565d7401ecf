//! The recipes that are saved as files, and the task that makes their changes one after the other.

use std::{
    collections::VecDeque,
    path::{Path, PathBuf},
    sync::Arc,
};

use files::{FileError, disk};
use inspection::{
    library::PartName,
    pipeline::{
        BUILT_IN, BUILT_IN_RECIPES, NamedRecipe, Recipe, RecipeError, RecipeFile, RecipeFolder,
        RecipeLabel, RecipeList, Replace, built_in_recipe,
    },
};
use shell::{inspection::folder_watch::FolderWatch, settings::set_aside, workspace::ShellContext};
use ui::{
    language::text,
    task::{Task, TaskRunner},
    undo_stack::UndoDirection,
    user_error::UserError,
};

/// The changed recipe on trial when the window was closed, in the folder of recipes; hidden, as it is none of them.
const TRIAL: &str = ".trial.recipe";

/// The kept recipes, and the changes that wait for the task.
#[derive(Debug)]
pub struct KeptRecipes {
    /// Their folder; without one no recipe can be saved.
    folder: Option<RecipeFolder>,
    /// The recipes, once listed.
    pub list: RecipeList,
    /// The name that is being entered.
    pub naming: Option<Naming>,
    /// True while the parameters that differ from their defaults are shown.
    pub is_listing_changes: bool,
    /// Name of the recipe that another program changed while it was on trial.
    pub(super) changed_elsewhere: Option<String>,
    /// True while it is asked whether saving may replace that recipe.
    pub is_asking: bool,
    /// The recipe on trial as the last window left it.
    pub(super) resumed: Option<Box<RecipeFile>>,
    waiting: VecDeque<RecipeChange>,
    pub(super) task: Task<Changed>,
    /// Watches for changes by commands.
    watch: FolderWatch,
}

/// A name that is being entered.
#[derive(Clone, Debug)]
pub struct Naming {
    /// What it is for.
    pub purpose: NamingPurpose,
    /// As entered so far.
    pub text: String,
    /// True until its field was shown once and took the keyboard focus.
    pub is_new: bool,
}

/// What an entered name is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NamingPurpose {
    /// Save the recipe on trial under it.
    SaveAs,
    /// Rename the recipe on trial.
    Rename,
}

/// A change of the files.
#[derive(Debug)]
pub(super) enum RecipeChange {
    List,
    /// Reads the recipe on trial as the last window left it.
    Resume,
    Save(Box<RecipeFile>, Replace),
    /// Saves a removed recipe again.
    Restore {
        file: Box<RecipeFile>,
        was_default: bool,
    },
    Rename(PartName, PartName),
    /// With the direction, if it undoes or redoes another change.
    Remove(PartName, Option<UndoDirection>),
    MakeDefault(PartName),
    /// Under its own name, or the next free one.
    Import(PathBuf),
    Export(Box<RecipeFile>, PathBuf),
}

/// A change that was made, and the recipes after it.
#[derive(Debug)]
pub(super) struct Changed {
    pub(super) list: RecipeList,
    pub(super) done: RecipeDone,
}

#[derive(Debug)]
pub(super) enum RecipeDone {
    Listed,
    Resumed(Option<Box<RecipeFile>>),
    /// The recipe on trial has this name now.
    Saved(PartName),
    Restored(PartName),
    Renamed(PartName, PartName),
    Removed {
        file: Box<RecipeFile>,
        was_default: bool,
        way: Option<UndoDirection>,
    },
    Default(PartName),
    Imported(PartName),
    Exported(PathBuf),
}

impl KeptRecipes {
    pub(super) fn new(folder: Option<PathBuf>, runner: &TaskRunner) -> Self {
        Self {
            folder: folder.map(RecipeFolder::at),
            list: RecipeList {
                default: BUILT_IN.into(),
                ..RecipeList::default()
            },
            naming: None,
            is_listing_changes: false,
            changed_elsewhere: None,
            is_asking: false,
            resumed: None,
            // Listed in the first frame: the recipe in use may differ from its file by now.
            waiting: VecDeque::from([RecipeChange::List, RecipeChange::Resume]),
            task: Task::new("recipes", runner),
            watch: FolderWatch::new("recipe-watch", runner),
        }
    }

    pub(super) fn is_idle(&self) -> bool {
        self.task.running().is_none() && (self.folder.is_none() || self.waiting.is_empty())
    }

    pub(super) fn of_name(&self, name: &str) -> Option<&RecipeFile> {
        of_name(&self.list, name)
    }

    /// The parameters of the built-in or saved recipe of this name.
    pub(super) fn recipe(&self, name: &str) -> Option<Recipe> {
        built_in_recipe(name).or_else(|| self.of_name(name).map(|file| file.recipe.clone()))
    }

    /// True if there is a recipe of this name.
    pub(super) fn has(&self, name: &str) -> bool {
        is_taken(&self.list, name)
    }

    /// Names parameters, and marks them as changed if the recipe of this name has others.
    pub(super) fn named(&self, name: &str, parameters: Arc<Recipe>) -> NamedRecipe {
        let is_kept = self
            .recipe(name)
            .is_some_and(|recipe| recipe == *parameters);
        NamedRecipe {
            label: RecipeLabel {
                name: name.to_owned(),
                is_changed: !is_kept,
            },
            parameters,
        }
    }

    pub(super) fn start(&mut self, change: RecipeChange, cx: &mut ShellContext<'_>) {
        if self.folder.is_none() {
            return cx.notify(UserError::of(&FileError::NoUserFolder));
        }
        self.waiting.push_back(change);
        self.start_next();
    }

    /// Lists the recipes again once another program has changed them.
    pub(super) fn watch(&mut self) {
        let Some(folder) = &self.folder else {
            return;
        };
        self.watch.watch(folder.path());
        if self.watch.has_changed() {
            self.waiting.push_back(RecipeChange::List);
        }
    }

    /// Writes the recipe on trial for the next window; `None` removes that of the last one. A second window that changed
    /// nothing leaves what the first one wrote.
    pub(super) fn keep_trial(&self, trial: Option<&RecipeFile>) {
        let Some(folder) = &self.folder else {
            return;
        };
        if trial == self.resumed.as_deref() {
            return;
        }
        let path = folder.path().join(TRIAL);
        // The window is closing, so an error could not be shown.
        if let Some(trial) = trial {
            let _ = disk::create_dir_all(folder.path());
            let _ = trial.write(&path);
        } else {
            let _ = disk::remove_file(&path);
        }
    }

    /// Starts the next waiting change; a change is never cancelled for the next.
    pub(super) fn start_next(&mut self) {
        if let (None, Some(folder)) = (self.task.running(), &self.folder)
            && let Some(change) = self.waiting.pop_front()
        {
            let folder = folder.clone();
            self.task
                .start(text!("compare-changing-recipes"), move |_| {
                    carry_out(&folder, change).map_err(|error| UserError::of(&error).into())
                });
        }
    }
}

pub(super) fn of_name<'a>(list: &'a RecipeList, name: &str) -> Option<&'a RecipeFile> {
    let mut recipes = list.recipes.iter();
    recipes.find(|file| file.name.as_str() == name)
}

fn is_taken(list: &RecipeList, name: &str) -> bool {
    BUILT_IN_RECIPES.contains(&name) || of_name(list, name).is_some()
}

/// The first free name of `name_2`, `name_3` and so on; a long name is shortened for it.
pub(super) fn free_name(list: &RecipeList, name: &str) -> Result<PartName, RecipeError> {
    let mut copies = (2..10_000).map(|number| {
        let ending = format!("_{number}");
        let room = PartName::MAX_LENGTH - ending.len();
        let kept: String = name.chars().take(room).collect();
        kept + &ending
    });
    let free = copies.find(|copy| !is_taken(list, copy));
    Ok(PartName::new(free.as_deref().unwrap_or(name))?)
}

/// Reads the recipe on trial as the last window left it. A file that cannot be read is set aside.
fn read_trial(path: &Path) -> Result<Option<Box<RecipeFile>>, RecipeError> {
    if !path.exists() {
        return Ok(None);
    }
    let read = RecipeFile::read(path);
    if read.is_err() {
        // If this fails, the next start reports the file again.
        let _ = set_aside(path);
    }
    Ok(Some(Box::new(read?)))
}

fn carry_out(folder: &RecipeFolder, change: RecipeChange) -> Result<Changed, RecipeError> {
    let done = match change {
        RecipeChange::List => RecipeDone::Listed,
        RecipeChange::Resume => RecipeDone::Resumed(read_trial(&folder.path().join(TRIAL))?),
        RecipeChange::Save(file, replace) => RecipeDone::Saved(folder.save(&file, replace)?.name),
        RecipeChange::Restore { file, was_default } => {
            let name = folder.save(&file, Replace::No)?.name;
            if was_default {
                folder.set_default(&name)?;
            }
            RecipeDone::Restored(name)
        }
        RecipeChange::Rename(from, to) => {
            folder.rename(&from, &to)?;
            RecipeDone::Renamed(from, to)
        }
        RecipeChange::Remove(name, way) => {
            let file = Box::new(folder.read(&name)?);
            let was_default = folder.is_default(&name);
            folder.remove(&name)?;
            RecipeDone::Removed {
                file,
                was_default,
                way,
            }
        }
        RecipeChange::MakeDefault(name) => {
            folder.set_default(&name)?;
            RecipeDone::Default(name)
        }
        RecipeChange::Import(path) => {
            let mut file = RecipeFile::read(&path)?;
            let list = folder.list()?;
            let name = file.name.as_str();
            if is_taken(&list, name) && !list.recipes.contains(&file) {
                file.name = free_name(&list, name)?;
            }
            RecipeDone::Imported(folder.save(&file, Replace::Yes)?.name)
        }
        RecipeChange::Export(file, path) => {
            file.write(&path)?;
            RecipeDone::Exported(path)
        }
    };
    let list = folder.list()?;
    Ok(Changed { list, done })
}
