//! The frame of the dialog: its pages, and the last error.

use egui::{Button, Context, ScrollArea, Ui, vec2};

use super::{
    answer_page, by_hand, check_page, from_pairs, in_use,
    state::{RobotAction, RobotCell, RobotDialog, RobotPage},
};
use crate::session::Session;
use robot::hand_eye::Mount;
use ui::{
    language::text,
    theme::space,
    user_error::UserError,
    widgets::{self, Mark, line_mark, sentence, text_button},
};

/// Width of the dialog, logical pixels.
const WIDTH: f32 = 640.0;
/// Part of the window's height that the pages leave free, for heading, buttons, edges, and a notice above the dialog, logical
/// pixels.
const MARGIN: f32 = 220.0;

/// Room above the dialog, for a notice, logical pixels.
const TOP: f32 = 48.0;

impl RobotCell {
    /// Draws the dialog while it is open; returns the user's actions.
    pub fn ui(&self, ctx: &Context, session: &Session) -> Vec<RobotAction> {
        let Some(known) = self.dialog() else {
            return Vec::new();
        };
        let mut dialog = known.clone();
        let mut caused = Vec::new();
        let modal = widgets::dialog_below(ctx, "robot", TOP, |ui| {
            ui.set_width(WIDTH.min(ctx.content_rect().width() - 80.0));
            ui.heading(text!("robot-title"));
            ui.add_space(space::SMALL);
            ui.horizontal_wrapped(|ui| {
                for page in RobotPage::ALL {
                    choice(ui, &mut dialog.page, page, page.title());
                }
            });
            ui.separator();
            let room = ctx.content_rect().height() - MARGIN;
            ScrollArea::vertical()
                .max_height(room)
                .min_scrolled_height(room)
                .auto_shrink([false, true])
                .show(ui, |ui| {
                    self.page(ui, session, &mut dialog, &mut caused);
                });
            ui.separator();
            if text_button(ui, &text!("shell-close")).clicked() {
                caused.push(RobotAction::Close);
            }
        });
        if modal.should_close() && caused.is_empty() {
            caused.push(RobotAction::Close);
        }
        if dialog != *known {
            caused.insert(0, RobotAction::Edit(Box::new(dialog)));
        }
        caused
    }

    /// Draws the page in front and the last error.
    fn page(
        &self,
        ui: &mut Ui,
        session: &Session,
        dialog: &mut RobotDialog,
        caused: &mut Vec<RobotAction>,
    ) {
        match dialog.page {
            RobotPage::InUse => in_use::ui(ui, self, session, dialog, caused),
            RobotPage::ByHand => by_hand::ui(ui, dialog, caused),
            RobotPage::FromPairs => {
                from_pairs::ui(ui, self, session.convention, dialog, caused);
            }
            // This page shows the error itself, above its list.
            RobotPage::Check => return check_page::ui(ui, self, session, dialog, caused),
            RobotPage::Answer => answer_page::ui(ui, self, session, dialog, caused),
        }
        if let Some(trouble) = &dialog.trouble {
            ui.add_space(space::SMALL);
            told(ui, Mark::Bad, trouble);
        }
    }
}

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
pub(super) fn told(ui: &mut Ui, sign: Mark, trouble: &UserError) {
    ui.horizontal_top(|ui| {
        line_mark(ui, 18.0, 7.0, sign);
        ui.vertical(|ui| {
            ui.label(sentence(&trouble.what));
            ui.weak(&trouble.advice);
        });
    });
}
