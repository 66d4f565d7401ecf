//! The question before the window closes with unsaved data, or while it answers robots.

use egui::Context;

use crate::{
    action::Action,
    state::{Closing, State},
};
use ui::{
    language::text,
    theme::space,
    widgets::{self, text_button},
};

/// Draws the question while it is open.
pub fn dialog(ctx: &Context, state: &State, actions: &mut Vec<Action>) {
    let Closing::Asked { what, is_unsaved } = &state.closing else {
        return;
    };
    let (question, close) = if *is_unsaved {
        (
            text!("shell-close-without-saving"),
            text!("shell-close-anyway"),
        )
    } else {
        (
            text!("shell-stop-answering"),
            text!("shell-close-and-stop-answering"),
        )
    };
    let modal = widgets::dialog(ctx, "closing", |ui| {
        ui.set_max_width(420.0);
        ui.heading(question);
        ui.weak(what);
        ui.add_space(space::MEDIUM);
        ui.horizontal(|ui| {
            if widgets::default_button(ui, &text!("shell-keep-open"), true) {
                actions.push(Action::StayOpen);
            }
            if text_button(ui, &close).clicked() {
                actions.push(Action::CloseAnyway);
            }
        });
    });
    if modal.should_close() {
        actions.push(Action::StayOpen);
    }
}
