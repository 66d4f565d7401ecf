//! History: every inspection, to be found, looked at again and labelled.

mod apply;
mod bar;
mod details;
mod differences;
mod export;
mod filter;
mod keeping;
mod label;
mod list;
mod reopen;
mod state;
mod work;

use egui::{CentralPanel, Frame, Key, Margin, Modifiers, Panel, RichText, Ui};

pub use self::{
    apply::{Direction, HistoryAction, HistoryJob, apply, export, keep, take},
    filter::{Days, ListFilter},
    reopen::{TakenIn, take_in},
    state::HistoryState,
    work::{LookRequest, Looked, LookedAt},
};
use self::{details::Details, list::List};
pub(in crate::app) use self::{
    export::write as write_past, keeping::ui as keeping_ui, work::answer,
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
pub(super) const SHORTCUTS: [Shortcut; 4] = [
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
    Shortcut {
        modifiers: Modifiers::NONE,
        key: Key::A,
        keys: "A",
        does: "Inspect it again, with today's recipe and library",
        action: || Action::History(HistoryAction::AgainSelected),
    },
];

/// What the workspace keeps between frames.
pub(super) struct HistoryPanel {
    details: Details,
    list: List,
}

impl HistoryPanel {
    pub(super) fn new() -> Self {
        Self {
            details: Details::default(),
            list: List::default(),
        }
    }

    /// What is left to do when the window closes: a remark may still be in its field.
    pub(super) fn finish(&mut self) -> Vec<Action> {
        let mut actions = Vec::new();
        self.details.remark.keep(&mut actions, None);
        actions
    }

    pub(super) fn ui(
        &mut self,
        ui: &mut Ui,
        state: &State,
        theme: &Theme,
        actions: &mut Vec<Action>,
    ) {
        if state.history.is_empty() && state.history.trouble.is_none() {
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
                    .inner_margin(Margin::same(16)),
            )
            .show(ui, |ui| self.details.ui(ui, state, theme, actions));
        CentralPanel::default()
            .frame(Frame::new().inner_margin(Margin::same(16)))
            .show(ui, |ui| self.list.ui(ui, state, theme, actions));
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
        let advice =
            "Press Capture: every inspection is listed here, also after the window was closed";
        ui.label(RichText::new(advice).color(theme.weak_text));
    });
}
