//! An error as shown to the user.

use std::fmt::Display;

use geometry::error::Advice;

/// What went wrong, and what to do about it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UserError {
    /// What went wrong.
    pub what: String,
    /// What to do; may be empty.
    pub advice: String,
}

impl UserError {
    /// Converts an error that has advice.
    pub fn of<E: Display + Advice>(error: &E) -> Self {
        Self {
            what: error.to_string(),
            advice: error.advice(),
        }
    }

    /// Converts several errors to one that tells all of them, and each advice once.
    pub fn of_all<E: Display + Advice>(errors: &[E]) -> Self {
        let what: Vec<String> = errors.iter().map(ToString::to_string).collect();
        let mut advice: Vec<String> = errors.iter().map(Advice::advice).collect();
        advice.dedup();
        Self {
            what: what.join("\n"),
            advice: advice.join("\n"),
        }
    }
}

impl From<[String; 2]> for UserError {
    fn from([what, advice]: [String; 2]) -> Self {
        Self { what, advice }
    }
}
