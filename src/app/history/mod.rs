//! History: every inspection since the window was opened, to be looked at again.

mod details;
mod list;
mod state;

use egui::{CentralPanel, Frame, Key, Margin, Modifiers, Panel, RichText, Ui};

use self::details::Details;
pub use self::state::{
    Direction, HistoryAction, HistoryFilter, HistoryState, PastInspection, PastVerdict, apply, csv,
    export, keep, take_in,
};
use super::{
    action::Action,
    keys::Shortcut,
    state::State,
    theme::{Theme, font, space},
};

/// Width of the details, logical pixels, and in a narrow window.
const DETAILS: [f32; 2] = [340.0, 300.0];

/// Keys of this workspace.
pub(super) const SHORTCUTS: [Shortcut; 3] = [
    Shortcut {
        modifiers: Modifiers::NONE,
        key: Key::ArrowUp,
        keys: "Up",
        does: "The newer inspection",
        action: || Action::History(HistoryAction::Step(Direction::Up)),
    },
    Shortcut {
        modifiers: Modifiers::NONE,
        key: Key::ArrowDown,
        keys: "Down",
        does: "The older inspection",
        action: || Action::History(HistoryAction::Step(Direction::Down)),
    },
    Shortcut {
        modifiers: Modifiers::NONE,
        key: Key::Enter,
        keys: "Enter",
        does: "Open it with all its stages",
        action: || Action::History(HistoryAction::OpenSelected),
    },
];

/// What the workspace keeps between frames.
pub(super) struct HistoryPanel {
    details: Details,
}

impl HistoryPanel {
    pub(super) fn new() -> Self {
        Self {
            details: Details::default(),
        }
    }

    pub(super) fn ui(
        &mut self,
        ui: &mut Ui,
        state: &State,
        theme: &Theme,
        actions: &mut Vec<Action>,
    ) {
        if state.history.is_empty() {
            empty(ui, theme);
            return;
        }
        let width = ui.available_width();
        Panel::right("details")
            .exact_size(if width > 1100.0 {
                DETAILS[0]
            } else {
                DETAILS[1]
            })
            .resizable(false)
            .frame(
                Frame::new()
                    .fill(theme.panel)
                    .inner_margin(Margin::symmetric(18, 14)),
            )
            .show(ui, |ui| self.details.ui(ui, state, theme, actions));
        let frame = Frame::new().inner_margin(Margin::same(14));
        CentralPanel::default()
            .frame(frame)
            .show(ui, |ui| list::ui(ui, &state.history, theme, actions));
    }
}

/// Before the first inspection.
fn empty(ui: &mut Ui, theme: &Theme) {
    ui.vertical_centered(|ui| {
        ui.add_space(ui.available_height() * 0.4);
        ui.label(
            RichText::new("Nothing inspected yet")
                .font(font::verdict())
                .color(theme.text),
        );
        ui.add_space(space::SMALL);
        let advice = "Press Capture: every inspection is listed here until the window closes";
        ui.label(RichText::new(advice).color(theme.weak_text));
    });
}
