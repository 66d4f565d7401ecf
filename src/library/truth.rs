//! What truly hangs before a camera, as far as somebody knows.

use serde::{Deserialize, Serialize};

/// What truly hung before the camera.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(tag = "is", content = "part", rename_all = "snake_case")]
pub enum Truth {
    /// The enrolled part of this name.
    Part(String),
    /// Something that is not enrolled.
    NotEnrolled,
    /// Nothing.
    Nothing,
}

impl Truth {
    /// The part's name, if it is one.
    pub fn part(&self) -> Option<&str> {
        match self {
            Self::Part(name) => Some(name),
            Self::NotEnrolled | Self::Nothing => None,
        }
    }

    /// As in reports: the part's name, `not_enrolled` or `nothing`.
    pub fn name(&self) -> &str {
        match self {
            Self::Part(name) => name,
            Self::NotEnrolled => "not_enrolled",
            Self::Nothing => "nothing",
        }
    }
}
