//! The [`Advice`] that every error gives, panics as errors, and locks.

use std::{
    any::Any,
    panic::{AssertUnwindSafe, catch_unwind},
    sync::{Mutex, MutexGuard, PoisonError},
};

pub use derive::Advice;
use texts::{Described, Message};

/// Tells the user what to do about an error; kept apart from the error's message.
///
/// The message states what was found and what was expected; the advice is one imperative sentence,
/// for example "Clear the table and capture again". It stands beside the message: `#[derive(Advice)]`.
pub trait Advice {
    /// Returns what to do next, as one sentence without a line break.
    fn advice(&self) -> String;
}

impl<T: Described> Advice for T {
    fn advice(&self) -> String {
        self.message().command_advice()
    }
}

/// A panic, which is a bug in the program, while working on one input.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error, serde::Serialize, serde::Deserialize)]
pub struct Fault {
    /// The message of the panic.
    message: String,
}

impl Fault {
    fn from_panic(panic: &(dyn Any + Send)) -> Self {
        let text = panic.downcast_ref::<&str>().map(ToString::to_string);
        let text = text.or_else(|| panic.downcast_ref::<String>().cloned());
        Self {
            message: text.unwrap_or_else(|| "no message".into()),
        }
    }
}

impl Described for Fault {
    fn message(&self) -> Message {
        Message::new("refusal-fault").with_fields(self)
    }
}

texts::display!(Fault);

/// Runs `work` and turns a panic in it into an error, so that one bad input does not stop the following ones.
///
/// Anything that `work` shares with others must stay usable if it breaks off half-way: frames and libraries are only
/// ever read or replaced whole.
pub fn guarded<T>(work: impl FnOnce() -> T) -> Result<T, Fault> {
    catch_unwind(AssertUnwindSafe(work)).map_err(|panic| Fault::from_panic(panic.as_ref()))
}

/// Locks a mutex and ignores poisoning. Use it only for values that are replaced whole or appended to: these stay valid
/// if a thread panics while it holds the lock.
pub fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_becomes_an_error_with_its_message() {
        assert_eq!(guarded(|| 7), Ok(7));
        let empty: [u8; 0] = [];
        let found = guarded(|| empty[std::hint::black_box(0)]).expect_err("a panic");
        assert!(found.to_string().contains("index out of bounds"), "{found}");
        let found = guarded(|| panic!("no ray at all")).expect_err("a panic");
        assert!(found.to_string().contains("no ray at all"), "{found}");
        assert!(found.advice().contains("report"));
    }
}
