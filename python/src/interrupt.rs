//! Handling of Ctrl-C while a call computes.

use std::{
    cell::{Cell, RefCell},
    time::{Duration, Instant},
};

use partsight::ProgressObserver;
use pyo3::{PyErr, Python};

/// Interval at which Python's signal handlers run; to take the interpreter's lock may mean to wait for another
/// thread.
const INTERVAL: Duration = Duration::from_millis(100);

/// Runs Python's signal handlers between the steps of a computation, and ends it once one raises an exception.
pub(crate) struct SignalWatch {
    asked: Cell<Instant>,
    raised: RefCell<Option<PyErr>>,
}

impl SignalWatch {
    pub(crate) fn new() -> Self {
        Self {
            asked: Cell::new(Instant::now()),
            raised: RefCell::new(None),
        }
    }

    /// The exception that ended the computation, such as `KeyboardInterrupt`.
    pub(crate) fn into_raised(self) -> Option<PyErr> {
        self.raised.into_inner()
    }
}

impl ProgressObserver for SignalWatch {
    fn is_cancelled(&self) -> bool {
        if self.raised.borrow().is_some() {
            return true;
        }
        if self.asked.get().elapsed() < INTERVAL {
            return false;
        }
        let ask = |py: Python<'_>| py.check_signals();
        let raised = Python::attach(ask).err();
        self.asked.set(Instant::now());
        self.raised.replace(raised);
        self.raised.borrow().is_some()
    }
}
