//! A workspace as the shell sees it, and what the shell lends to it while it draws or handles results.

use std::{
    any::Any,
    path::{Path, PathBuf},
};

use egui::{Rect, Ui};

use crate::{
    action::{Action, Event},
    file_dialog::{DialogLock, FileDialog},
    inspection::{library_cache::LibraryCache, source::SceneOrScan},
    notice::Notice,
    session::{Session, WorkspaceKind},
};
use ui::{
    key_binding::KeyBinding,
    task::{Running, Task},
};

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

/// Data shared by tasks. Clones go into jobs.
#[derive(Clone, Debug)]
#[cfg_attr(any(test, feature = "fixtures"), derive(Default))]
pub struct Services {
    /// The library, the camera, the recording and the history in use.
    pub library_cache: LibraryCache,
    /// Allows only one file dialog at a time.
    pub dialogs: DialogLock,
}

/// What the shell lends to a workspace.
pub struct ShellContext<'a> {
    /// Context of egui.
    pub egui: &'a egui::Context,
    /// State shared by the workspaces.
    pub session: &'a Session,
    /// Data shared by tasks.
    pub services: &'a Services,
    sent: &'a mut Vec<Action>,
}

impl<'a> ShellContext<'a> {
    /// Makes a context; sent actions are added to `sent`.
    pub fn new(
        egui: &'a egui::Context,
        session: &'a Session,
        services: &'a Services,
        sent: &'a mut Vec<Action>,
    ) -> Self {
        Self {
            egui,
            session,
            services,
            sent,
        }
    }

    /// Sends an action to the shell, which carries it out before the next frame.
    pub fn send(&mut self, action: Action) {
        self.sent.push(action);
    }

    /// Shows a notice.
    pub fn notify(&mut self, notice: impl Into<Notice>) {
        self.send(Action::Notify(notice.into()));
    }

    /// Shows the result of a task, which describes what was written, or its error.
    pub fn notify_written(&mut self, task: &mut Task<Notice>) {
        match task.poll() {
            Some(Ok(written)) => self.notify(written),
            Some(Err(error)) => self.notify(error),
            None => {}
        }
    }

    /// The path chosen in a dialog, and what it is for; shows why a path cannot be used.
    pub fn chosen<K: Copy>(&mut self, dialog: &mut FileDialog<K>) -> Option<(K, PathBuf)> {
        let (asked, path) = dialog.poll()?;
        match path {
            Ok(path) => Some((asked, path)),
            Err(notice) => {
                self.notify(notice);
                None
            }
        }
    }
}

/// A shell for testing a workspace without a window.
#[cfg(any(test, feature = "fixtures"))]
#[derive(Default)]
pub struct TestShell {
    pub egui: egui::Context,
    pub session: Session,
    pub services: Services,
    /// Actions sent so far.
    pub sent: Vec<Action>,
}

#[cfg(any(test, feature = "fixtures"))]
impl TestShell {
    pub fn context(&mut self) -> ShellContext<'_> {
        ShellContext::new(&self.egui, &self.session, &self.services, &mut self.sent)
    }

    /// Texts of the notices that were sent.
    pub fn notices(&self) -> Vec<&str> {
        let notices = self.sent.iter().filter_map(|action| match action {
            Action::Notify(notice) => Some(notice.what.as_str()),
            _ => None,
        });
        notices.collect()
    }
}
