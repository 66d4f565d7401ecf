//! The frame of the dialog: its pages, and the last error.

use egui::{Context, ScrollArea, Ui};

use super::{
    answer_page, by_hand, check_page,
    controls::{choice, error_row},
    from_pairs, in_use,
    state::RobotCell,
};
use crate::{
    cell::dialog_state::{RobotAction, RobotDialog, RobotPage},
    session::Session,
};
use ui::{
    language::text,
    theme::space,
    widgets::{self, Mark, text_button},
};

/// Width of the dialog, logical pixels.
const WIDTH: f32 = 640.0;
/// Part of the window's height that the pages leave free, for heading, buttons, edges, and a notice above the dialog, logical
/// pixels.
const MARGIN: f32 = 220.0;

/// Room above the dialog, for a notice, logical pixels.
const TOP_MARGIN_PX: f32 = 48.0;

impl RobotCell {
    /// Draws the dialog while it is open; returns the user's actions.
    pub fn ui(&self, ctx: &Context, session: &Session) -> Vec<RobotAction> {
        let Some(known) = self.dialog() else {
            return Vec::new();
        };
        let mut dialog = known.clone();
        let mut caused = Vec::new();
        let modal = widgets::dialog_below(ctx, "robot", TOP_MARGIN_PX, |ui| {
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
        if let Some(error) = &dialog.problem {
            ui.add_space(space::SMALL);
            error_row(ui, Mark::Bad, error);
        }
    }
}
