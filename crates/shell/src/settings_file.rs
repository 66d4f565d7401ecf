//! Keeps the settings file up to date without making the window wait for the disk.

use std::{
    path::PathBuf,
    sync::{Arc, Mutex},
};

use super::{
    notice::Notice,
    settings::{Settings, save},
    state::State,
};
use geometry::error::lock;
use ui::{
    language::text,
    task::{Task, TaskRunner},
};

/// Writes the settings whenever they change, in a task.
pub struct Memory {
    path: Option<PathBuf>,
    writing: Task<()>,
    /// Prevents an older write from finishing after a newer one.
    turn: Arc<Mutex<()>>,
    kept: Settings,
    has_changed: bool,
}

impl Memory {
    /// Without a path nothing is kept.
    pub fn new(path: Option<PathBuf>, kept: Settings, runner: &TaskRunner) -> Self {
        Self {
            path,
            writing: Task::new("settings", runner),
            turn: Arc::default(),
            kept,
            has_changed: false,
        }
    }

    /// Writes changed settings; returns a notice if writing failed.
    pub fn keep(&mut self, state: &State, ctx: &egui::Context) -> Option<Notice> {
        let path = self.path.as_ref()?;
        let window = ctx.input(|input| input.viewport().inner_rect.map(|rect| rect.size()));
        let window = window.map_or(self.kept.window, |size| Some([size.x, size.y]));
        let settings = Settings::of(state, window);
        if settings != self.kept {
            self.kept = settings.clone();
            self.has_changed = true;
            let path = path.clone();
            let turn = Arc::clone(&self.turn);
            self.writing
                .start(text!("shell-writing-settings"), move |context| {
                    let _turn = lock(&turn);
                    context.check()?;
                    save(&path, &settings).map_err(Into::into)
                });
        }
        self.writing.poll()?.err().map(Notice::from)
    }

    /// Writes what may not have been written yet.
    pub fn finish(&mut self) {
        if let Some(path) = &self.path
            && self.has_changed
        {
            self.writing.cancel();
            let _turn = lock(&self.turn);
            // The window is closing, so that an error can no longer be shown.
            let _ = save(path, &self.kept);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::load;

    #[test]
    fn an_older_write_does_not_replace_what_was_written_at_the_end() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("settings.toml");
        let runner = TaskRunner::without_threads();
        let mut memory = Memory::new(Some(path.clone()), Settings::default(), &runner);
        let mut state = State::default();
        state.session.live.params.average = 2;
        let none = memory.keep(&state, &egui::Context::default());
        assert!(none.is_none() && memory.writing.running().is_some());
        memory.kept.average = 5;
        memory.finish();
        // The job of the older settings comes to its turn only now.
        memory.writing.run_waiting();
        assert_eq!(load(&path).0.average, 5);
    }
}
