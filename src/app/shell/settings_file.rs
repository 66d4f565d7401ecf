//! Keeping the settings file up to date, without the window waiting for the disk.

use std::path::PathBuf;

use super::{
    notice::Notice,
    settings::{Settings, save},
    state::State,
};
use crate::app::{
    language::text,
    task::{Task, TaskEvent, TaskRunner},
};

/// Writes the settings whenever they have changed, on a thread of its own.
pub(in crate::app) struct Memory {
    path: Option<PathBuf>,
    writing: Task<()>,
    kept: Settings,
    has_changed: bool,
}

impl Memory {
    /// Without a path nothing is remembered.
    pub(in crate::app) fn new(path: Option<PathBuf>, kept: Settings, runner: &TaskRunner) -> Self {
        Self {
            path,
            writing: Task::new("settings", runner),
            kept,
            has_changed: false,
        }
    }

    /// Has what changed written down, and says what went wrong. Costs a comparison in a frame without a change.
    pub(in crate::app) fn keep(&mut self, state: &State, ctx: &egui::Context) -> Option<Notice> {
        let path = self.path.as_ref()?;
        let window = ctx.input(|input| input.viewport().inner_rect.map(|rect| rect.size()));
        let window = window.map_or(self.kept.window, |size| Some([size.x, size.y]));
        if !self.kept.is_of(state, window) {
            self.kept = Settings::of(state, window);
            self.has_changed = true;
            let (path, settings) = (path.clone(), self.kept.clone());
            self.writing
                .start(text!("shell-writing-settings"), move |_| {
                    save(&path, &settings).map_err(Into::into)
                });
        }
        match self.writing.poll()? {
            TaskEvent::Failed(error) => Some(error.into()),
            TaskEvent::Partial(()) | TaskEvent::Done(()) => None,
        }
    }

    /// Writes down what may still wait to be written.
    pub(in crate::app) fn finish(&self) {
        if let Some(path) = &self.path
            && self.has_changed
        {
            // The window is closing: nobody is left to read why it failed.
            let _ = save(path, &self.kept);
        }
    }
}
