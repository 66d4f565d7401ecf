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
}

impl From<[String; 2]> for UserError {
    fn from([what, advice]: [String; 2]) -> Self {
        Self { what, advice }
    }
}
