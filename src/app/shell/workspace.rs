//! A workspace, as the shell sees it.

use std::{any::Any, path::Path};

use egui::Ui;

use super::{
    context::ShellContext,
    key_binding::KeyBinding,
    message::Event,
    session::{Session, WorkspaceKind},
};
use crate::app::{inspection::inspected::SceneOrScan, task::Running};

/// A workspace: it owns its state and its tasks, and draws itself.
pub trait Workspace: Any {
    /// Its place on the rail.
    fn kind(&self) -> WorkspaceKind;

    /// Draws it, and does what a person caused.
    fn ui(&mut self, ui: &mut Ui, cx: &mut ShellContext<'_>);

    /// Polls its tasks and dialogs. Called in every frame, in front or not.
    fn update(&mut self, cx: &mut ShellContext<'_>);

    /// Handles an event of the shell.
    fn on_event(&mut self, _event: &Event, _cx: &mut ShellContext<'_>) {}

    /// Takes what is captured or opened while it is in front.
    fn take_scene(&mut self, _scene: SceneOrScan, _title: String, _cx: &mut ShellContext<'_>) {}

    /// Takes a file that is dropped, if it waits for one like it.
    fn take_file(&mut self, _path: &Path, _cx: &mut ShellContext<'_>) -> bool {
        false
    }

    /// The window closes: hands over what is still being written.
    fn close(&mut self) {}

    /// Its own keys; they come before the window's.
    fn key_bindings(&self) -> Vec<KeyBinding> {
        Vec::new()
    }

    /// The key at this place of [`key_bindings`](Self::key_bindings) was pressed.
    fn press(&mut self, _place: usize, _cx: &mut ShellContext<'_>) {}

    /// The run that the top bar shows, with a button to cancel it.
    fn running(&self) -> Option<&Running> {
        None
    }

    /// Cancels that run.
    fn cancel(&mut self) {}

    /// A file being written, which the top bar shows while nothing else runs; it cannot be cancelled.
    fn writing(&self) -> Option<&Running> {
        None
    }

    /// What would be lost if the window closed now, in words.
    fn unsaved(&self) -> Option<String> {
        None
    }

    /// True while keys go to one of its 3-D views.
    fn has_key_focus(&self) -> bool {
        false
    }

    /// True while nothing is at work or waits to be.
    fn is_idle(&self, _session: &Session) -> bool {
        self.running().is_none()
    }
}
