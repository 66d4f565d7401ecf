//! History.

mod state;

use egui::Ui;

pub use self::state::{HistoryAction, HistoryState, apply};
use super::{action::Action, state::State, theme::Theme};

/// What the workspace keeps between frames.
pub(super) struct HistoryPanel;

impl HistoryPanel {
    pub(super) fn new() -> Self {
        Self
    }

    pub(super) fn ui(
        &mut self,
        _ui: &mut Ui,
        _state: &State,
        _theme: &Theme,
        _actions: &mut Vec<Action>,
    ) {
    }
}
