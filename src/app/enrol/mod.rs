//! Enrol.

mod state;
mod work;

use egui::Ui;

pub(super) use self::work::answer;
pub use self::{
    state::{EnrolAction, EnrolState, apply, hear},
    work::{EnrolAnswer, EnrolRequest},
};
use super::{
    action::Action,
    state::State,
    theme::Theme,
    viewport::{ViewError, ViewportGpu},
};

/// What the workspace keeps between frames.
pub(super) struct EnrolPanel;

impl EnrolPanel {
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
