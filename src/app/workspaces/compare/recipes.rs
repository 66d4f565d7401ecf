//! Actions on the kept recipes: opening one to try it, saving the recipe on trial, renaming, deleting, importing and
//! exporting.

use std::{path::PathBuf, sync::Arc};

use super::{
    action::RecipeAction,
    kept_recipes::{Changed, Naming, NamingPurpose, RecipeChange, RecipeDone, free_name},
    schedule::StudyNeed,
    state::{CompareState, Undo},
};
use crate::{
    app::{
        language::text,
        shell::{context::ShellContext, message::Message, notice::Notice, session::UserRole},
        user_error::UserError,
    },
    library::PartName,
    pipeline::{BUILT_IN, NamedRecipe, Recipe, RecipeError, RecipeFile, Replace},
};

impl CompareState {
    /// Carries out an action on the kept recipes.
    pub(super) fn apply_to_recipes(&mut self, action: RecipeAction, cx: &mut ShellContext<'_>) {
        let tried = Arc::clone(self.tried_recipe(cx.session));
        let name = tried.label.name.as_str();
        let done = match action {
            RecipeAction::Open(name) => {
                self.open_recipe(&name, cx);
                Ok(())
            }
            RecipeAction::Save => self.save_recipe(name, Replace::Yes, cx),
            RecipeAction::Duplicate => free_name(&self.recipes.list, name)
                .and_then(|copy| self.save_recipe(copy.as_str(), Replace::No, cx)),
            RecipeAction::Name(purpose) => {
                let text = match purpose {
                    NamingPurpose::SaveAs => String::new(),
                    NamingPurpose::Rename => name.to_owned(),
                };
                self.recipes.naming = Some(Naming {
                    purpose,
                    text,
                    is_new: true,
                });
                Ok(())
            }
            RecipeAction::Write(text) => {
                if let Some(naming) = &mut self.recipes.naming {
                    naming.text = text;
                    naming.is_new = false;
                }
                Ok(())
            }
            RecipeAction::CancelName => {
                self.recipes.naming = None;
                Ok(())
            }
            RecipeAction::TakeName => self.take_name(name, cx),
            RecipeAction::Delete => self.with_name(name, RecipeChange::Remove, cx),
            RecipeAction::MakeDefault => self.with_name(name, RecipeChange::MakeDefault, cx),
            RecipeAction::Import(path) => {
                self.recipes.start(RecipeChange::Import(path), cx);
                Ok(())
            }
            RecipeAction::Export(path) => self.export(&tried, path, cx),
            RecipeAction::ListChanges => {
                self.recipes.is_listing_changes ^= true;
                Ok(())
            }
        };
        if let Err(error) = done {
            cx.notify(UserError::of(&error));
        }
    }

    fn with_name(
        &mut self,
        name: &str,
        change: fn(PartName) -> RecipeChange,
        cx: &mut ShellContext<'_>,
    ) -> Result<(), RecipeError> {
        self.recipes.start(change(PartName::new(name)?), cx);
        Ok(())
    }

    /// The file of a recipe under this name, with the notes that it has so far.
    fn file_of(&self, recipe: &NamedRecipe, name: PartName) -> Box<RecipeFile> {
        let kept = self.recipes.of_name(&recipe.label.name);
        Box::new(RecipeFile {
            name,
            notes: kept.map(|file| file.notes.clone()).unwrap_or_default(),
            recipe: Recipe::clone(recipe),
        })
    }

    /// Saves the recipe on trial under this name.
    fn save_recipe(
        &mut self,
        name: &str,
        replace: Replace,
        cx: &mut ShellContext<'_>,
    ) -> Result<(), RecipeError> {
        let file = self.file_of(self.tried_recipe(cx.session), PartName::new(name)?);
        self.recipes.start(RecipeChange::Save(file, replace), cx);
        Ok(())
    }

    fn take_name(&mut self, from: &str, cx: &mut ShellContext<'_>) -> Result<(), RecipeError> {
        let Some(Naming { purpose, text, .. }) = self.recipes.naming.clone() else {
            return Ok(());
        };
        let to = PartName::new(text.trim())?;
        match purpose {
            NamingPurpose::SaveAs => self.save_recipe(to.as_str(), Replace::No, cx)?,
            NamingPurpose::Rename if to.as_str() == from => {}
            NamingPurpose::Rename => {
                let change = RecipeChange::Rename(PartName::new(from)?, to);
                self.recipes.start(change, cx);
            }
        }
        self.recipes.naming = None;
        Ok(())
    }

    fn export(
        &mut self,
        tried: &NamedRecipe,
        path: PathBuf,
        cx: &mut ShellContext<'_>,
    ) -> Result<(), RecipeError> {
        let name = &tried.label.name;
        let stem = path.file_stem().map(|stem| stem.to_string_lossy());
        let of_file = stem.and_then(|stem| PartName::proposed(&stem));
        // The name of the built-in recipe stays with its parameters.
        let name = match of_file {
            Some(of_file) if name == BUILT_IN => of_file,
            _ => PartName::new(name)?,
        };
        let file = self.file_of(tried, name);
        self.recipes.start(RecipeChange::Export(file, path), cx);
        Ok(())
    }

    /// Puts a kept recipe on trial.
    fn open_recipe(&mut self, name: &str, cx: &mut ShellContext<'_>) {
        let parameters = match self.recipes.of_name(name) {
            Some(file) => Arc::new(file.recipe.clone()),
            None if name == BUILT_IN => Arc::default(),
            None => return,
        };
        let before = Arc::clone(self.tried_recipe(cx.session));
        let recipe = self.recipes.named(name, parameters);
        if recipe == *before {
            return;
        }
        if *recipe != **before {
            self.due = StudyNeed::Now;
        }
        if before.label.is_changed {
            self.undo = Some(Undo::Trial(before));
        }
        self.recipes.naming = None;
        self.put_on_trial(recipe, cx);
    }

    /// Puts this recipe on trial, unless it is the one in use.
    pub(super) fn put_on_trial(&mut self, recipe: NamedRecipe, cx: &ShellContext<'_>) {
        self.tried = (recipe != *cx.session.recipe).then(|| Arc::new(recipe));
    }

    /// Takes in the results of the task.
    pub(super) fn update_recipes(&mut self, cx: &mut ShellContext<'_>) {
        while let Some(event) = self.recipes.task.poll() {
            match event {
                Ok(changed) => self.on_changed(changed, cx),
                Err(error) => cx.notify(error),
            }
            // An imported recipe is tried.
            self.start_next(cx);
        }
        self.recipes.watch();
        self.recipes.start_next();
    }

    fn on_changed(&mut self, changed: Changed, cx: &mut ShellContext<'_>) {
        let Changed { list, done } = changed;
        let known = std::mem::replace(&mut self.recipes.list, list);
        if matches!(done, RecipeDone::Listed) {
            let known: Vec<String> = known.problems.iter().map(ToString::to_string).collect();
            for problem in &self.recipes.list.problems {
                if !known.contains(&problem.to_string()) {
                    cx.notify(UserError::of(problem));
                }
            }
        }
        // Recipe on trial and recipe in use may have another name now, or differ from their files.
        let in_use = Arc::clone(&cx.session.recipe);
        let mut names = [self.tried.as_ref(), Some(&in_use)].map(|recipe| {
            let recipe = recipe.unwrap_or(&in_use);
            recipe.label.name.clone()
        });
        match &done {
            // A recipe saved under another name is on trial; the one in use keeps its name until another one is used.
            RecipeDone::Saved(name) => names[0] = name.to_string(),
            RecipeDone::Renamed(from, to) => {
                for name in names.iter_mut().filter(|name| *name == from.as_str()) {
                    *name = to.to_string();
                }
            }
            _ => {}
        }
        let now = self
            .recipes
            .named(&names[1], Arc::clone(&in_use.parameters));
        let tried = self.tried.as_ref().unwrap_or(&in_use);
        let tried = self.recipes.named(&names[0], Arc::clone(&tried.parameters));
        self.tried = (tried != now).then(|| Arc::new(tried));
        if now.label != in_use.label {
            let is_listed = matches!(done, RecipeDone::Listed);
            if is_listed && now.label.is_changed && cx.session.role == UserRole::Engineer {
                cx.notify(Notice::look(
                    text!("compare-recipe-changed-elsewhere", name = &now.label.name),
                    text!("compare-recipe-changed-elsewhere-advice"),
                ));
            }
            cx.send(Message::UseRecipe(Arc::new(now)));
        }
        let said = match done {
            RecipeDone::Listed => return,
            RecipeDone::Saved(name) => text!("compare-saved-recipe", name = name.as_str()),
            RecipeDone::Restored(name) => text!("compare-restored-recipe", name = name.as_str()),
            RecipeDone::Renamed(from, to) => {
                let [before, now] = [&from, &to].map(PartName::as_str);
                text!("compare-renamed-recipe", before = before, now = now)
            }
            RecipeDone::Removed { file, was_default } => {
                let said = text!("compare-removed-recipe", name = file.name.as_str());
                self.undo = Some(Undo::Recipe { file, was_default });
                said
            }
            RecipeDone::Default(name) => text!("compare-default-recipe", name = name.as_str()),
            RecipeDone::Imported(name) => {
                self.open_recipe(name.as_str(), cx);
                text!("compare-imported-recipe", name = name.as_str())
            }
            RecipeDone::Exported(path) => {
                let path = path.display().to_string();
                text!("shell-wrote", path = path)
            }
        };
        self.say(said, cx);
    }
}
