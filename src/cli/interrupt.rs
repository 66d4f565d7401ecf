//! Ctrl-C: the first ends the work with what there is, the second ends the program at once.

use std::{
    process,
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
    },
};

use anyhow::Context as _;

/// Whether Ctrl-C was pressed.
pub(super) struct Interrupt {
    came: Arc<AtomicBool>,
}

/// What shells give a program that Ctrl-C ended: 128 and the signal's number.
const ENDED_AT_ONCE: i32 = 130;

impl Interrupt {
    /// From now on Ctrl-C does not end the program by itself. At most once in a program.
    pub(super) fn listen() -> anyhow::Result<Self> {
        let came = Arc::new(AtomicBool::new(false));
        let theirs = Arc::clone(&came);
        ctrlc::set_handler(move || {
            if theirs.swap(true, Ordering::SeqCst) {
                process::exit(ENDED_AT_ONCE);
            }
        })
        .context("the system does not let Ctrl-C be waited for")?;
        Ok(Self { came })
    }

    /// True once it was pressed.
    pub(super) fn came(&self) -> bool {
        self.came.load(Ordering::SeqCst)
    }
}
