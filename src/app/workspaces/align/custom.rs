//! A start that a person enters: six numbers, with or without units.

use crate::geometry::written_pose::parse_pose;

/// A start as entered by a person.
#[derive(Debug, Default)]
pub struct CustomStart {
    /// Whether its form is open.
    pub form: Form,
    /// The text entered.
    pub text: String,
    /// Errors and doubts found in the text.
    pub remarks: Vec<String>,
}

/// Whether a form is open.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Form {
    /// Not open.
    #[default]
    Closed,
    /// Open.
    Open,
}

impl CustomStart {
    pub(super) fn write(&mut self, text: String) {
        self.remarks = match parse_pose(&text) {
            Ok(given) => given.doubts.iter().map(ToString::to_string).collect(),
            Err(problem) => vec![problem],
        };
        self.text = text;
    }

    /// True if the text can be read as a start.
    pub fn is_start(&self) -> bool {
        parse_pose(&self.text).is_ok()
    }
}
