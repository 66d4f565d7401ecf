//! A workspace as the shell sees it.

use std::{any::Any, path::Path};

use egui::{Rect, Ui};

use super::{
    action::Event,
    context::ShellContext,
    session::{Session, WorkspaceKind},
};
use crate::inspection::source::SceneOrScan;
use ui::{key_binding::KeyBinding, task::Running};

/// A workspace: owns its state and its tasks, and draws itself.
pub trait Workspace: Any {
    /// Its kind, which decides its position on the rail.
    fn kind(&self) -> WorkspaceKind;

    /// Draws it and carries out the user's actions. Returns where notices may lie over it: over a view, which has no controls
    /// there.
    fn ui(&mut self, ui: &mut Ui, cx: &mut ShellContext<'_>) -> Rect;

    /// Polls its tasks and dialogs. Called every frame, whether in front or not.
    fn update(&mut self, cx: &mut ShellContext<'_>);

    /// Handles an event of the shell.
    fn on_event(&mut self, _event: &Event, _cx: &mut ShellContext<'_>) {}

    /// Takes a scene captured or opened while the workspace is in front.
    fn take_scene(&mut self, _scene: SceneOrScan, _title: String, _cx: &mut ShellContext<'_>) {}

    /// Takes a dropped file if it is waiting for one; false if not.
    fn take_file(&mut self, _path: &Path, _cx: &mut ShellContext<'_>) -> bool {
        false
    }

    /// Called when the window closes: hands over what is still to be written.
    fn close(&mut self) {}

    /// Its own keys, which take precedence over the window's.
    fn key_bindings(&self) -> Vec<KeyBinding> {
        Vec::new()
    }

    /// The key at this index of [`key_bindings`](Self::key_bindings) was pressed.
    fn press(&mut self, _index: usize, _cx: &mut ShellContext<'_>) {}

    /// The running job for the top bar, which offers to cancel it.
    fn running(&self) -> Option<&Running> {
        None
    }

    /// Cancels the running job.
    fn cancel(&mut self) {}

    /// A file being written, shown in the top bar while nothing else runs; it cannot be cancelled.
    fn writing(&self) -> Option<&Running> {
        None
    }

    /// What would be lost if the window closed now, as text.
    fn unsaved(&self) -> Option<String> {
        None
    }

    /// True while one of its 3-D views takes the keys.
    fn has_key_focus(&self) -> bool {
        false
    }

    /// True while no work is running or waiting.
    fn is_idle(&self, _session: &Session) -> bool {
        self.running().is_none()
    }
}
