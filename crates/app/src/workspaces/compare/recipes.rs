//! The recipe on trial: changing it, using it, and undo; and actions on the kept recipes: opening one to try it, saving the recipe
//! on trial, renaming, deleting, importing and exporting.

use std::{mem, path::PathBuf, sync::Arc};

use crate::workspaces::compare::{
    action::RecipeAction,
    kept_recipes::{Changed, Naming, NamingPurpose, RecipeChange, RecipeDone, free_name, of_name},
    schedule::StudyNeed,
    state::{CompareState, Undo},
};
use inspection::{
    library::PartName,
    pipeline::{
        BUILT_IN_RECIPES, NamedRecipe, Recipe, RecipeError, RecipeFile, RecipeLabel, RecipeList,
        Replace, parameters::num_changed,
    },
};
use shell::{
    action::Action, language::recipe_label, notice::Notice, session::UserRole,
    workspace::ShellContext,
};
use ui::{language::text, undo_stack::UndoDirection, user_error::UserError};

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
            RecipeAction::Save if self.recipes.changed_elsewhere.as_deref() == Some(name) => {
                self.recipes.is_asking = true;
                Ok(())
            }
            RecipeAction::Save => self.save_recipe(name, Replace::Yes, cx),
            RecipeAction::Replace(may_replace) => {
                self.recipes.is_asking = false;
                if may_replace {
                    self.save_recipe(name, Replace::Yes, cx)
                } else {
                    Ok(())
                }
            }
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
            RecipeAction::Delete => {
                self.with_name(name, |name| RecipeChange::Remove(name, None), cx)
            }
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
        // The name of a built-in recipe stays with its parameters.
        let name = match of_file {
            Some(of_file) if BUILT_IN_RECIPES.contains(&name.as_str()) => of_file,
            _ => PartName::new(name)?,
        };
        let file = self.file_of(tried, name);
        self.recipes.start(RecipeChange::Export(file, path), cx);
        Ok(())
    }

    /// Puts a kept recipe on trial.
    fn open_recipe(&mut self, name: &str, cx: &mut ShellContext<'_>) {
        let Some(parameters) = self.recipes.recipe(name) else {
            return;
        };
        let before = Arc::clone(self.tried_recipe(cx.session));
        let recipe = self.recipes.named(name, Arc::new(parameters));
        if recipe == *before {
            return;
        }
        if *recipe != **before {
            self.due = StudyNeed::Now;
        }
        if before.label.is_changed {
            self.undo.push(Undo::Trial(before));
        }
        self.recipes.naming = None;
        self.recipes
            .changed_elsewhere
            .take_if(|changed| changed == name);
        self.put_on_trial(recipe, cx);
    }

    /// Puts this recipe on trial, unless it is the one in use.
    fn put_on_trial(&mut self, recipe: NamedRecipe, cx: &ShellContext<'_>) {
        self.tried = (recipe != *cx.session.recipe).then(|| Arc::new(recipe));
    }

    /// Keeps the changed recipe on trial for the next window.
    pub(super) fn keep_trial(&self) {
        let changed = self.tried.as_ref().filter(|tried| tried.label.is_changed);
        let file = changed.and_then(|tried| {
            let name = PartName::new(&tried.label.name).ok()?;
            Some(self.file_of(tried, name))
        });
        self.recipes.keep_trial(file.as_deref());
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
        let known_list = mem::replace(&mut self.recipes.list, list);
        let is_listed = matches!(done, RecipeDone::Listed);
        if is_listed {
            let known = &known_list;
            let known: Vec<String> = known.problems.iter().map(ToString::to_string).collect();
            for problem in &self.recipes.list.problems {
                if !known.contains(&problem.to_string()) {
                    cx.notify(UserError::of(problem));
                }
            }
        }
        // Recipe on trial and recipe in use may have another name now, or differ from their files.
        let in_use = Arc::clone(&cx.session.recipe);
        let tried = Arc::clone(self.tried_recipe(cx.session));
        let mut names = [&tried, &in_use].map(|recipe| recipe.label.name.clone());
        match &done {
            // A recipe saved under another name is on trial; the one in use keeps its name until another one is used.
            RecipeDone::Saved(name) => {
                names[0] = name.to_string();
                let changed = &mut self.recipes.changed_elsewhere;
                changed.take_if(|changed| changed == name.as_str());
            }
            RecipeDone::Renamed(from, to) => {
                let all = names.iter_mut().chain(&mut self.recipes.changed_elsewhere);
                for name in all.filter(|name| *name == from.as_str()) {
                    *name = to.to_string();
                }
            }
            _ => {}
        }
        let now = self
            .recipes
            .named(&names[1], Arc::clone(&in_use.parameters));
        let tried_now = self.recipes.named(&names[0], Arc::clone(&tried.parameters));
        if is_listed {
            let in_use = [&in_use.label, &now.label];
            let tried = [&tried.label, &tried_now.label];
            self.report_changes_elsewhere(&known_list, in_use, tried, cx);
        }
        self.tried = (tried_now != now).then(|| Arc::new(tried_now));
        if now.label != in_use.label {
            cx.send(Action::UseRecipe(Arc::new(now)));
        }
        let what = match done {
            RecipeDone::Listed => return,
            RecipeDone::Resumed(file) => return self.resume(file, cx),
            RecipeDone::Saved(name) => text!("compare-saved-recipe", name = name.as_str()),
            RecipeDone::Restored(name) => {
                let what = text!("compare-restored-recipe", name = name.as_str());
                let undone = Some(UndoDirection::Undo);
                self.undo.add_inverse(undone, Undo::RemoveRecipe(name));
                what
            }
            RecipeDone::Renamed(from, to) => {
                let [before, now] = [&from, &to].map(PartName::as_str);
                text!("compare-renamed-recipe", before = before, now = now)
            }
            RecipeDone::Removed {
                file,
                was_default,
                way,
            } => {
                let what = text!("compare-removed-recipe", name = file.name.as_str());
                let inverse = Undo::Recipe { file, was_default };
                self.undo.add_inverse(way, inverse);
                what
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
        self.say(what, cx);
    }

    /// Puts the recipe on trial again that was when the last window was closed.
    fn resume(&mut self, file: Option<Box<RecipeFile>>, cx: &ShellContext<'_>) {
        if let (Some(file), None) = (&file, &self.tried) {
            let parameters = Arc::new(file.recipe.clone());
            let recipe = self.recipes.named(file.name.as_str(), parameters);
            self.put_on_trial(recipe, cx);
            self.due = StudyNeed::Now;
        }
        self.recipes.resumed = file;
    }

    /// Reports that another program changed, renamed or deleted the recipe in use or on trial. Each is given by its label
    /// before and now.
    fn report_changes_elsewhere(
        &mut self,
        known: &RecipeList,
        in_use: [&RecipeLabel; 2],
        tried: [&RecipeLabel; 2],
        cx: &mut ShellContext<'_>,
    ) {
        let list = &self.recipes.list;
        let is_other = |[before, now]: [&RecipeLabel; 2]| {
            let [was, is] = [known, list].map(|list| of_name(list, &now.name));
            let is_replaced = was.is_some_and(|was| Some(&was.recipe) != is.map(|is| &is.recipe));
            !BUILT_IN_RECIPES.contains(&now.name.as_str())
                && now.is_changed
                && (!before.is_changed || is_replaced)
        };
        let [is_other_in_use, is_other_tried] = [in_use, tried].map(is_other);
        let name = match (is_other_in_use, is_other_tried) {
            (false, false) => return,
            (true, _) => &in_use[1].name,
            (false, true) => &tried[1].name,
        };
        let is_kept = self.recipes.has(name);
        if is_other_tried {
            let name = &tried[1].name;
            self.recipes.changed_elsewhere = self.recipes.has(name).then(|| name.clone());
        }
        if cx.session.role != UserRole::Engineer {
            return;
        }
        let changed = text!("compare-recipe-changed-elsewhere", name = name);
        let (what, advice) = match (is_kept, is_other_in_use) {
            (false, _) => (
                text!("compare-recipe-gone", name = name),
                text!("compare-recipe-gone-advice"),
            ),
            (true, true) => (changed, text!("compare-recipe-changed-elsewhere-advice")),
            (true, false) => (changed, text!("compare-tried-changed-elsewhere-advice")),
        };
        cx.notify(Notice::look(what, advice));
    }
}

impl CompareState {
    /// Puts other parameters on trial under the same name, and studies the case in front with them at once.
    pub(super) fn change_recipe(&mut self, parameters: Recipe, cx: &ShellContext<'_>) {
        let before = self.tried_recipe(cx.session);
        if parameters != ***before {
            let name = &before.label.name;
            let recipe = self.recipes.named(name, Arc::new(parameters));
            self.put_on_trial(recipe, cx);
            self.due = StudyNeed::Now;
        }
    }

    /// Makes the recipe on trial the one in use.
    pub(super) fn use_recipe(&mut self, cx: &mut ShellContext<'_>) {
        let Some(tried) = self.tried.take() else {
            return;
        };
        self.undo.push(Undo::Use(Arc::clone(&cx.session.recipe)));
        self.inspect_with(tried, cx);
    }

    /// Undoes the last change, or redoes the one undone last.
    pub(super) fn undo_or_redo(&mut self, way: UndoDirection, cx: &mut ShellContext<'_>) {
        let Some(step) = self.undo.from(way).pop() else {
            return;
        };
        let way = Some(way);
        match step {
            Undo::Cases(folder, change) => {
                let shown = self.cases.as_ref().map(|cases| &cases.folder);
                if shown != Some(&folder) {
                    self.use_folder(folder.path().to_owned());
                }
                self.change_cases(change, way);
                self.start_next(cx);
            }
            Undo::Recipe { file, was_default } => {
                let change = RecipeChange::Restore { file, was_default };
                self.recipes.start(change, cx);
            }
            Undo::RemoveRecipe(name) => self.recipes.start(RecipeChange::Remove(name, way), cx),
            Undo::Trial(other) => {
                let now = Arc::clone(self.tried_recipe(cx.session));
                self.undo.add_inverse(way, Undo::Trial(now));
                self.put_on_trial(NamedRecipe::clone(&other), cx);
                self.due = StudyNeed::Now;
                self.start_next(cx);
            }
            Undo::Use(other) => {
                let now = Arc::clone(&cx.session.recipe);
                // The recipe that was in use stays on trial.
                let tried = self.tried.take().unwrap_or_else(|| Arc::clone(&now));
                self.tried = (tried != other).then_some(tried);
                self.undo.add_inverse(way, Undo::Use(now));
                self.inspect_with(other, cx);
            }
        }
    }

    /// Uses this recipe, and inspects the scene of the Inspect workspace with it.
    fn inspect_with(&mut self, recipe: Arc<NamedRecipe>, cx: &mut ShellContext<'_>) {
        let num = num_changed::<Recipe>(&recipe);
        let label = recipe_label(&recipe.label);
        let text = text!("compare-recipe-used", recipe = label, count = num);
        self.say(text, cx);
        cx.send(Action::UseRecipe(recipe));
        cx.send(Action::InspectShown {
            title: text!("compare-inspecting"),
        });
    }
}
