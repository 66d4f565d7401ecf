//! Keeping the settings file up to date, without the window waiting for the disk.

use std::{io, path::PathBuf};

use super::{
    job::Trouble,
    settings::{Settings, save},
    state::{Notice, State},
    worker::{News, Worker},
};

/// Writes the settings whenever they have changed, on a thread of its own.
pub(super) struct Memory {
    path: Option<PathBuf>,
    writer: Worker<Settings, Result<(), Trouble>>,
    kept: Settings,
    generation: u64,
}

impl Memory {
    /// Without a path nothing is remembered.
    pub(super) fn start(path: Option<PathBuf>, kept: Settings) -> io::Result<Self> {
        let to = path.clone();
        let writer = Worker::start(
            "settings",
            move |settings, _| to.as_deref().map(|path| save(path, &settings)),
            || {},
        )?;
        Ok(Self {
            path,
            writer,
            kept,
            generation: 0,
        })
    }

    /// Has what changed written down, and says what went wrong. Costs a comparison in a frame without a change.
    pub(super) fn keep(&mut self, state: &State, ctx: &egui::Context) -> Option<Notice> {
        self.path.as_ref()?;
        let window = ctx.input(|input| input.viewport().inner_rect.map(|rect| rect.size()));
        let window = window.map_or(self.kept.window, |size| Some([size.x, size.y]));
        if !self.kept.is_of(state, window) {
            self.kept = Settings::of(state, window);
            self.generation += 1;
            self.writer.request(self.generation, self.kept.clone());
        }
        match self.writer.try_next()? {
            News::Done {
                outcome: Err(trouble),
                ..
            } => Some(trouble.into()),
            _ => None,
        }
    }

    /// Writes down what may still wait to be written.
    pub(super) fn finish(&self) {
        if let Some(path) = &self.path
            && self.generation > 0
        {
            // The window is closing: nobody is left to read why it failed.
            let _ = save(path, &self.kept);
        }
    }
}
