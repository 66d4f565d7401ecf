//! What every error of the product can do beside naming itself: say what to do next.

/// One imperative sentence for the person at the machine, kept apart from the error's own message.
///
/// The message says what was found and what was expected; the advice says what to do about it,
/// for example "Clear the table and capture again".
pub trait Advice {
    /// What to do next, as one sentence without a line break.
    fn advice(&self) -> String;
}
