//! What every error of the product can do beside naming itself: say what to do next. And the error of the program itself.

use std::{
    any::Any,
    panic::{AssertUnwindSafe, catch_unwind},
    sync::{Mutex, MutexGuard, PoisonError},
};

/// One imperative sentence for the person at the machine, kept apart from the error's own message.
///
/// The message says what was found and what was expected; the advice says what to do about it,
/// for example "Clear the table and capture again".
pub trait Advice {
    /// What to do next, as one sentence without a line break.
    fn advice(&self) -> String;
}

/// A panic: a mistake in the program, met while it worked on one input.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error, serde::Serialize, serde::Deserialize)]
#[error("the program itself failed here: {message}")]
pub struct Fault {
    /// The message of the panic.
    message: String,
}

impl Fault {
    fn of(panic: &(dyn Any + Send)) -> Self {
        let text = panic.downcast_ref::<&str>().map(ToString::to_string);
        let text = text.or_else(|| panic.downcast_ref::<String>().cloned());
        Self {
            message: text.unwrap_or_else(|| "no message".into()),
        }
    }
}

impl Advice for Fault {
    fn advice(&self) -> String {
        "Keep the file or frame and report it with this message; what comes after it is not affected"
            .into()
    }
}

/// Runs `work`, and turns a panic in it into an error, so that one input never ends what goes on to the next.
///
/// What `work` shares with others must still be of use after it broke off: frames and libraries are only ever read or
/// replaced whole.
pub(crate) fn guarded<T>(work: impl FnOnce() -> T) -> Result<T, Fault> {
    catch_unwind(AssertUnwindSafe(work)).map_err(|panic| Fault::of(panic.as_ref()))
}

/// A lock whose value is whole whatever panicked while it was held: it is only ever replaced whole or added to.
pub(crate) fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
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
