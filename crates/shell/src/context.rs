//! What the shell lends to a workspace while it draws or handles results.

use std::path::PathBuf;

use super::{
    action::Action,
    file_dialog::{DialogLock, FileDialog},
    notice::Notice,
    session::Session,
};
use crate::inspection::library_cache::LibraryCache;
use ui::task::Task;

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
