//! Actions on the kept recipes: opening one to try it, saving the recipe on trial, renaming, deleting, importing and
//! exporting.

use std::{path::PathBuf, sync::Arc};

use super::{
    action::RecipeAction,
    kept_recipes::{Changed, Naming, NamingPurpose, RecipeChange, RecipeDone},
    schedule::StudyNeed,
    state::{CompareState, Undo},
};
use crate::{
    app::{
        language::text,
        shell::{context::ShellContext, message::Message, notice::Notice, session::UserRole},
        task::TaskEvent,
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
            RecipeAction::Duplicate => self
                .recipes
                .free_name(name)
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

    /// Saves the recipe on trial under this name, with its notes.
    fn save_recipe(
        &mut self,
        name: &str,
        replace: Replace,
        cx: &mut ShellContext<'_>,
    ) -> Result<(), RecipeError> {
        let tried = self.tried_recipe(cx.session);
        let from = self.recipes.of_name(&tried.label.name);
        let file = RecipeFile {
            name: PartName::new(name)?,
            notes: from.map(|file| file.notes.clone()).unwrap_or_default(),
            recipe: Recipe::clone(tried),
        };
        self.recipes
            .start(RecipeChange::Save(Box::new(file), replace), cx);
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
        let file = RecipeFile {
            // The name of the built-in recipe stays with its parameters.
            name: match of_file {
                Some(of_file) if name == BUILT_IN => of_file,
                _ => PartName::new(name)?,
            },
            notes: self
                .recipes
                .of_name(name)
                .map(|file| file.notes.clone())
                .unwrap_or_default(),
            recipe: Recipe::clone(tried),
        };
        self.recipes
            .start(RecipeChange::Export(Box::new(file), path), cx);
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

    /// Puts these parameters on trial under the same name as before.
    pub(super) fn try_parameters(&mut self, parameters: Recipe, cx: &ShellContext<'_>) {
        let name = &self.tried_recipe(cx.session).label.name;
        let recipe = self.recipes.named(name, Arc::new(parameters));
        self.put_on_trial(recipe, cx);
    }

    /// Takes in the results of the task.
    pub(super) fn update_recipes(&mut self, cx: &mut ShellContext<'_>) {
        while let Some(event) = self.recipes.task.poll() {
            match event {
                TaskEvent::Partial(changed) | TaskEvent::Done(changed) => {
                    self.on_changed(changed, cx);
                }
                TaskEvent::Failed(error) => cx.notify(error),
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
        match done {
            RecipeDone::Listed => {}
            RecipeDone::Saved(name) => {
                self.say(text!("compare-saved-recipe", name = name.as_str()), cx);
            }
            RecipeDone::Restored(name) => {
                self.say(text!("compare-restored-recipe", name = name.as_str()), cx);
            }
            RecipeDone::Renamed(from, to) => {
                let [before, now] = [&from, &to].map(PartName::as_str);
                self.say(
                    text!("compare-renamed-recipe", before = before, now = now),
                    cx,
                );
            }
            RecipeDone::Removed { file, was_default } => {
                self.say(
                    text!("compare-removed-recipe", name = file.name.as_str()),
                    cx,
                );
                self.undo = Some(Undo::Recipe { file, was_default });
            }
            RecipeDone::Default(name) => {
                self.say(text!("compare-default-recipe", name = name.as_str()), cx);
            }
            RecipeDone::Imported(name) => {
                self.say(text!("compare-imported-recipe", name = name.as_str()), cx);
                self.open_recipe(name.as_str(), cx);
            }
            RecipeDone::Exported(path) => {
                let path = path.display().to_string();
                self.say(text!("compare-exported-recipe", path = path), cx);
            }
        }
    }

    /// Saves a removed recipe again.
    pub(super) fn put_recipe_back(
        &mut self,
        file: Box<RecipeFile>,
        was_default: bool,
        cx: &mut ShellContext<'_>,
    ) {
        let change = RecipeChange::Restore { file, was_default };
        self.recipes.start(change, cx);
    }
}
