//! Compare.

pub mod comparison;
pub mod matrix;
pub mod parameters;
mod state;
pub mod study;
mod work;

use egui::Ui;

pub(super) use self::work::answer;
pub use self::{
    state::{Cases, CompareAction, CompareState, Front, Undo, apply, hear},
    work::{CaseChange, CaseDone, CaseRun, CompareAnswer, CompareRequest},
};
use super::{
    action::Action,
    state::State,
    theme::Theme,
    viewport::{ViewError, ViewportGpu},
};

/// What the workspace keeps between frames.
pub(super) struct ComparePanel;

impl ComparePanel {
    pub(super) fn new(_gpu: Result<ViewportGpu, ViewError>) -> Self {
        Self
    }

    /// True while keys go to a 3-D view.
    pub(super) fn view_has_focus(&self) -> bool {
        false
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
