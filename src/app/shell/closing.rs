//! The question before the window closes with unsaved data.

use egui::{Button, Context, RichText};

use super::{action::Action, state::State, top_bar::labelled};
use crate::app::language::text;
use crate::app::ui::{
    theme::{Theme, font, space},
    widgets,
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
pub(in crate::app) fn dialog(
    ctx: &Context,
    state: &State,
    theme: &Theme,
    actions: &mut Vec<Action>,
) {
    let Closing::Asked(what) = &state.closing else {
        return;
    };
    let modal = widgets::dialog(ctx, "closing", |ui| {
        ui.set_max_width(420.0);
        let title = RichText::new(text!("shell-close-without-saving")).font(font::verdict());
        ui.label(title.color(theme.text));
        ui.label(RichText::new(what).color(theme.weak_text));
        ui.add_space(space::MEDIUM);
        ui.horizontal(|ui| {
            if widgets::default_button(ui, &text!("shell-keep-open"), true, theme) {
                actions.push(Action::StayOpen);
            }
            let close = text!("shell-close-anyway");
            if labelled(ui, Button::new(&*close), &close).clicked() {
                actions.push(Action::CloseAnyway);
            }
        });
    });
    if modal.should_close() {
        actions.push(Action::StayOpen);
    }
}
