//! The coat: chosen by name, changed by parameter, saved under a name.

use super::state::PaintState;
use inspection::{
    library::PartName,
    pipeline::{RecipeFile, Replace, parameters::Parameter},
};
use robot::paint::{Coat, built_in_coat};
use shell::{
    action::Action,
    notice::{Notice, NoticeTopic},
    workspace::ShellContext,
};
use ui::{language::text, parameter_control::ParameterChange, user_error::UserError};

impl PaintState {
    pub(super) fn change_parameter(
        &mut self,
        key: &'static str,
        change: ParameterChange,
        cx: &mut ShellContext<'_>,
    ) {
        let Some(parameter) = Parameter::<Coat>::of_key(key) else {
            return;
        };
        let mut coat = self.design.coat;
        match change {
            ParameterChange::Reset => parameter.copy(&self.design.kept.recipe, &mut coat),
            ParameterChange::Set(value) => {
                if let Err(error) = parameter.set(&mut coat, value) {
                    cx.notify(UserError::of(&error));
                    return;
                }
            }
        }
        // Dragging a slider is one step.
        let is_dragged = cx.egui.input(|input| input.pointer.any_down());
        if is_dragged && self.is_last_change_of(parameter) {
            self.design.coat = coat;
        } else {
            self.change(|design| design.coat = coat);
        }
    }

    pub(super) fn choose_coat(&mut self, name: &str, cx: &mut ShellContext<'_>) {
        let found = match (built_in_coat(name), &self.coat_folder) {
            (Some(own), _) => Ok(own),
            (None, Some(folder)) => folder.open(name),
            (None, None) => return,
        };
        match found {
            Ok(kept) => self.change(|design| {
                design.coat = kept.recipe;
                design.kept = kept;
            }),
            Err(error) => cx.notify(UserError::of(&error)),
        }
    }

    /// Lists the coats again, as files may have been added.
    pub(super) fn list_coats(&mut self, cx: &mut ShellContext<'_>) {
        let Some(folder) = &self.coat_folder else {
            return;
        };
        match folder.names() {
            Ok(names) => self.coats = names,
            Err(error) => cx.notify(UserError::of(&error)),
        }
    }

    pub(super) fn save_coat(&mut self, cx: &mut ShellContext<'_>) {
        let Some(written) = &self.naming else { return };
        let Some(folder) = &self.coat_folder else {
            cx.notify(Notice::look(
                text!("paint-no-coat-folder"),
                text!("paint-no-coat-folder-advice"),
            ));
            return;
        };
        let about_name = |error: UserError| Notice::from(error).about(NoticeTopic::CoatName);
        let name = match PartName::new(written.trim()) {
            Ok(name) => name,
            Err(error) => return cx.notify(about_name(UserError::of(&error))),
        };
        let coat = RecipeFile {
            name,
            notes: self.design.kept.notes.clone(),
            recipe: self.design.coat,
        };
        // Saving under the coat's own name replaces it.
        let replace = if coat.name == self.design.kept.name {
            Replace::Yes
        } else {
            Replace::No
        };
        match folder.save(&coat, replace) {
            Ok(()) => {
                cx.send(Action::RemoveNotices(NoticeTopic::CoatName));
                let name = coat.name.to_string();
                cx.notify(Notice::done(text!("paint-saved-coat", coat = name)));
                self.naming = None;
                self.change(|design| design.kept = coat);
                self.list_coats(cx);
            }
            Err(error) => cx.notify(about_name(UserError::of(&error))),
        }
    }
}
