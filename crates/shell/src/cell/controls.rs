//! Controls that the pages of the dialog share.

use egui::{Button, Ui, vec2};

use crate::cell::dialog_state::RobotDialog;
use robot::hand_eye::Mount;
use ui::{
    language::text,
    theme::space,
    user_error::UserError,
    widgets::{self, Mark, line_mark, sentence},
};

/// Draws a button that chooses one of several values.
pub(super) fn choice<T: PartialEq>(ui: &mut Ui, value: &mut T, this: T, text: String) {
    let is_chosen = *value == this;
    let button = Button::selectable(is_chosen, text)
        .frame_when_inactive(true)
        .min_size(vec2(space::TARGET, space::TARGET));
    if ui.add(button).clicked() {
        *value = this;
    }
}

/// Draws the choice of what the camera is fixed to.
pub(super) fn mounts(ui: &mut Ui, dialog: &mut RobotDialog) {
    ui.horizontal(|ui| {
        for (mount, text) in [
            (Mount::EyeToHand, text!("robot-camera-in-cell")),
            (Mount::EyeInHand, text!("robot-camera-on-flange")),
        ] {
            choice(ui, &mut dialog.mount, mount, text);
        }
    });
}

/// Draws the field for the name of a new calibration.
pub(super) fn name(ui: &mut Ui, dialog: &mut RobotDialog) {
    ui.horizontal(|ui| {
        let label = ui.label(text!("robot-name-of-cell"));
        ui.add(egui::TextEdit::singleline(&mut dialog.name).desired_width(280.0))
            .labelled_by(label.id);
    });
}

/// Draws the button that uses the calibration of the page.
pub(super) fn use_it(ui: &mut Ui, is_there: bool) -> bool {
    widgets::default_button(ui, &text!("robot-use-it"), is_there)
}

/// Draws an error or a doubt, with a sign before it and the advice below.
pub(super) fn error_row(ui: &mut Ui, sign: Mark, error: &UserError) {
    ui.horizontal_top(|ui| {
        line_mark(ui, 18.0, 7.0, sign);
        ui.vertical(|ui| {
            ui.label(sentence(&error.what));
            ui.weak(&error.advice);
        });
    });
}
