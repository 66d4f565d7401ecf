//! Ctrl-C: the first one ends the work with the results so far, the second one ends the program at once.

use std::{
    process,
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
    },
};

use anyhow::Context as _;

/// Whether Ctrl-C was pressed.
#[derive(Clone)]
pub(super) struct Interrupt {
    came: Arc<AtomicBool>,
}

/// Exit code that shells use for a program ended by Ctrl-C: 128 plus the signal's number.
const ENDED_AT_ONCE: i32 = 130;

impl Interrupt {
    /// Intercepts Ctrl-C from now on. Call it at most once per process.
    pub(super) fn listen() -> anyhow::Result<Self> {
        let came = Arc::new(AtomicBool::new(false));
        let theirs = Arc::clone(&came);
        ctrlc::set_handler(move || {
            if theirs.swap(true, Ordering::SeqCst) {
                process::exit(ENDED_AT_ONCE);
            }
        })
        .context("the system does not allow Ctrl-C to be handled")?;
        Ok(Self { came })
    }

    /// Returns whether Ctrl-C was pressed.
    pub(super) fn came(&self) -> bool {
        self.came.load(Ordering::SeqCst)
    }
}
