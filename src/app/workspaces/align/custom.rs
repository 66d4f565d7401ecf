//! A start that a person writes: six numbers, with units or without.

use crate::geometry::written_pose::parse_pose;

/// A start as a person writes it.
#[derive(Debug, Default)]
pub struct CustomStart {
    /// Whether it is being written.
    pub form: Form,
    /// The text.
    pub text: String,
    /// What is wrong with it, and what is odd about it.
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

    /// True if the text is a start.
    pub fn is_start(&self) -> bool {
        parse_pose(&self.text).is_ok()
    }
}
