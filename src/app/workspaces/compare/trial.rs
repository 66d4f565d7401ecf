//! The recipe on trial: changing it, using it, and undo.

use std::sync::Arc;

use super::{
    kept_recipes::RecipeChange,
    schedule::StudyNeed,
    state::{CompareState, Undo},
    work::CaseEdit,
};
use crate::{
    app::{
        language::{results::recipe_label, text},
        shell::{context::ShellContext, message::Message},
    },
    pipeline::{NamedRecipe, Recipe, parameters::num_changed},
};

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
        let num = num_changed::<Recipe>(&tried);
        let recipe = recipe_label(&tried.label);
        let text = text!("compare-recipe-used", recipe = recipe, count = num);
        self.say(text, cx);
        self.undo = Some(Undo::Use(Arc::clone(&cx.session.recipe)));
        inspect_with(tried, cx);
    }

    pub(super) fn take_back(&mut self, cx: &mut ShellContext<'_>) {
        match self.undo.take() {
            None => {}
            Some(Undo::Keep(name)) => {
                self.change_cases(text!("compare-removing-case"), CaseEdit::Remove(name));
                self.start_next(cx);
            }
            Some(Undo::Removal { name, trash }) => {
                let change = CaseEdit::Restore { name, from: trash };
                self.change_cases(text!("compare-restoring-case"), change);
                self.start_next(cx);
            }
            Some(Undo::Recipe { file, was_default }) => {
                let change = RecipeChange::Restore { file, was_default };
                self.recipes.start(change, cx);
            }
            Some(Undo::Trial(before)) => {
                self.put_on_trial(NamedRecipe::clone(&before), cx);
                self.due = StudyNeed::Now;
                self.start_next(cx);
            }
            Some(Undo::Use(before)) => {
                // The recipe that was in use stays on trial.
                self.tried
                    .get_or_insert_with(|| Arc::clone(&cx.session.recipe));
                self.say(text!("compare-recipe-used-before"), cx);
                inspect_with(before, cx);
            }
        }
    }
}

/// Uses this recipe, and inspects the scene of the Inspect workspace with it.
fn inspect_with(recipe: Arc<NamedRecipe>, cx: &mut ShellContext<'_>) {
    cx.send(Message::UseRecipe(recipe));
    cx.send(Message::InspectShown {
        title: text!("compare-inspecting"),
    });
}
