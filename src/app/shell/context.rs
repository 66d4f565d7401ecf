//! What the shell lends a workspace while it draws or takes in a result.

use super::{file_dialog::DialogLock, message::Message, notice::Notice, session::Session};
use crate::app::{inspection::library_cache::LibraryCache, ui::theme::Theme};

/// What tasks share. Clones go into jobs.
#[derive(Clone, Debug)]
#[cfg_attr(test, derive(Default))]
pub struct Services {
    /// The library, the camera, the recording and the history in use.
    pub library_cache: LibraryCache,
    /// Keeps a second file dialog from opening behind the first.
    pub dialogs: DialogLock,
}

/// What the shell lends a workspace.
pub struct ShellContext<'a> {
    /// egui's.
    pub egui: &'a egui::Context,
    /// What the workspaces share.
    pub session: &'a Session,
    /// Colours.
    pub theme: &'static Theme,
    /// What tasks share.
    pub services: &'a Services,
    messages: &'a mut Vec<Message>,
}

impl<'a> ShellContext<'a> {
    /// `messages` takes what is sent.
    pub fn new(
        egui: &'a egui::Context,
        session: &'a Session,
        services: &'a Services,
        messages: &'a mut Vec<Message>,
    ) -> Self {
        Self {
            egui,
            session,
            theme: Theme::of(session.theme),
            services,
            messages,
        }
    }

    /// Asks something of the shell; it is done before the next frame.
    pub fn send(&mut self, message: Message) {
        self.messages.push(message);
    }

    /// Has a notice shown.
    pub fn notify(&mut self, notice: impl Into<Notice>) {
        self.send(Message::Notify(notice.into()));
    }
}

/// A shell for tests of a workspace without a window.
#[cfg(test)]
#[derive(Default)]
pub(in crate::app) struct TestShell {
    pub(in crate::app) egui: egui::Context,
    pub(in crate::app) session: Session,
    pub(in crate::app) services: Services,
    /// What was sent.
    pub(in crate::app) messages: Vec<Message>,
}

#[cfg(test)]
impl TestShell {
    pub(in crate::app) fn context(&mut self) -> ShellContext<'_> {
        ShellContext::new(
            &self.egui,
            &self.session,
            &self.services,
            &mut self.messages,
        )
    }

    /// What the notices say that were sent.
    pub(in crate::app) fn notices(&self) -> Vec<&str> {
        let notices = self.messages.iter().filter_map(|message| match message {
            Message::Notify(notice) => Some(notice.what.as_str()),
            _ => None,
        });
        notices.collect()
    }
}
