//! The question before the window closes with unsaved data.

use egui::Context;

use super::{action::Action, state::State};
use crate::app::language::text;
use crate::app::ui::{
    theme::space,
    widgets::{self, text_button},
};

/// Whether the window may close.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum Closing {
    /// No close was requested.
    #[default]
    No,
    /// The user is asked; the text says what would be lost.
    Asked(String),
    /// The window closes, whatever is lost.
    Confirmed,
}

/// Draws the question while it is open.
pub(in crate::app) fn dialog(ctx: &Context, state: &State, actions: &mut Vec<Action>) {
    let Closing::Asked(what) = &state.closing else {
        return;
    };
    let modal = widgets::dialog(ctx, "closing", |ui| {
        ui.set_max_width(420.0);
        ui.heading(text!("shell-close-without-saving"));
        ui.weak(what);
        ui.add_space(space::MEDIUM);
        ui.horizontal(|ui| {
            if widgets::default_button(ui, &text!("shell-keep-open"), true) {
                actions.push(Action::StayOpen);
            }
            if text_button(ui, &text!("shell-close-anyway")).clicked() {
                actions.push(Action::CloseAnyway);
            }
        });
    });
    if modal.should_close() {
        actions.push(Action::StayOpen);
    }
}
