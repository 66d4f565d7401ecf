//! Keeps the settings file up to date without making the window wait for the disk.

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

/// Writes the settings whenever they change, in a task.
pub(in crate::app) struct Memory {
    path: Option<PathBuf>,
    writing: Task<()>,
    kept: Settings,
    has_changed: bool,
}

impl Memory {
    /// Without a path nothing is kept.
    pub(in crate::app) fn new(path: Option<PathBuf>, kept: Settings, runner: &TaskRunner) -> Self {
        Self {
            path,
            writing: Task::new("settings", runner),
            kept,
            has_changed: false,
        }
    }

    /// Writes changed settings; returns a notice if writing failed. Costs only a comparison in a frame without changes.
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

    /// Writes what may not have been written yet.
    pub(in crate::app) fn finish(&self) {
        if let Some(path) = &self.path
            && self.has_changed
        {
            // The window is closing, so that an error can no longer be shown.
            let _ = save(path, &self.kept);
        }
    }
}
