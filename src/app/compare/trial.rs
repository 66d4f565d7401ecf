//! The recipe on trial, and what becomes of it.

use std::sync::Arc;

use super::{
    errands::{Due, change_cases, next},
    parameters::num_changed,
    state::{Undo, say},
    work::CaseChange,
};
use crate::{
    app::{
        action::{Effect, notify},
        inspect::work::InspectRequest,
        job::{Request, Trouble},
        source::SceneSource,
        state::State,
    },
    pipeline::Recipe,
};

/// Tries another recipe on the case in front at once.
pub(super) fn change_recipe(
    state: &mut State,
    change: impl FnOnce(&mut Recipe) -> Result<(), Trouble>,
) {
    let mut recipe = Recipe::clone(state.tried_recipe());
    match change(&mut recipe) {
        Ok(()) if recipe == **state.tried_recipe() => {}
        Ok(()) => {
            let is_in_use = recipe == *state.recipe;
            state.compare.tried = (!is_in_use).then(|| Arc::new(recipe));
            state.compare.due = Due::Now;
        }
        Err(trouble) => notify(state, trouble.into()),
    }
}

pub(super) fn use_recipe(state: &mut State) -> Option<Effect> {
    let tried = state.compare.tried.take()?;
    let num = num_changed(&tried);
    let text = match num {
        0 => "Scenes are inspected with the default recipe now".to_owned(),
        1 => "Scenes are inspected with this recipe now: 1 changed from default".to_owned(),
        _ => format!("Scenes are inspected with this recipe now: {num} changed from default"),
    };
    say(state, text);
    let before = std::mem::replace(&mut state.recipe, tried);
    state.compare.undo = Some(Undo::Use(before));
    inspect_again(state)
}

pub(super) fn undo(state: &mut State) -> Option<Effect> {
    match state.compare.undo.take()? {
        Undo::Removal { name, trash } => {
            let change = CaseChange::Restore { name, from: trash };
            change_cases(state, "Putting the case back", change);
            next(state)
        }
        Undo::Use(before) => {
            // What was in use stays on trial.
            let tried = std::mem::replace(&mut state.recipe, before);
            state.compare.tried.get_or_insert(tried);
            say(
                state,
                "Scenes are inspected with the recipe before again".into(),
            );
            inspect_again(state)
        }
    }
}

/// The scene in front of the Inspect workspace, with the recipe now in use.
fn inspect_again(state: &mut State) -> Option<Effect> {
    let Some(shown) = &state.shown else {
        return next(state);
    };
    let inspected = &shown.inspected;
    let source = SceneSource::AtHand(Arc::clone(&inspected.scene), inspected.origin.clone());
    let recipe = Arc::clone(&state.recipe);
    let request = Request::Inspect(InspectRequest { source, recipe });
    Some(state.begin("Inspecting with another recipe", request))
}
