//! What the shell lends to a workspace while it draws or handles results.

use std::path::PathBuf;

use super::{
    file_dialog::{DialogLock, FileDialog},
    message::Message,
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
    messages: &'a mut Vec<Message>,
}

impl<'a> ShellContext<'a> {
    /// Makes a context; sent messages are added to `messages`.
    pub fn new(
        egui: &'a egui::Context,
        session: &'a Session,
        services: &'a Services,
        messages: &'a mut Vec<Message>,
    ) -> Self {
        Self {
            egui,
            session,
            services,
            messages,
        }
    }

    /// Sends a request to the shell, which carries it out before the next frame.
    pub fn send(&mut self, message: Message) {
        self.messages.push(message);
    }

    /// Shows a notice.
    pub fn notify(&mut self, notice: impl Into<Notice>) {
        self.send(Message::Notify(notice.into()));
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
    /// Messages sent so far.
    pub messages: Vec<Message>,
}

#[cfg(any(test, feature = "fixtures"))]
impl TestShell {
    pub fn context(&mut self) -> ShellContext<'_> {
        ShellContext::new(
            &self.egui,
            &self.session,
            &self.services,
            &mut self.messages,
        )
    }

    /// Texts of the notices that were sent.
    pub fn notices(&self) -> Vec<&str> {
        let notices = self.messages.iter().filter_map(|message| match message {
            Message::Notify(notice) => Some(notice.what.as_str()),
            _ => None,
        });
        notices.collect()
    }
}
