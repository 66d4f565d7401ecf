//! The recipe on trial: changing it, using it, and undo.

use std::sync::Arc;

use super::{
    kept_recipes::RecipeChange,
    schedule::StudyNeed,
    state::{CompareState, Undo},
};
use inspection::pipeline::{NamedRecipe, Recipe, parameters::num_changed};
use shell::{action::Action, language::recipe_label, workspace::ShellContext};
use ui::{language::text, undo_stack::UndoDirection};

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
