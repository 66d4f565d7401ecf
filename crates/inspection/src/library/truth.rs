//! True label of a scene.

use serde::{Deserialize, Serialize};

/// What hung in front of the camera, as a person states it.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(tag = "is", content = "part", rename_all = "snake_case")]
pub enum Truth {
    /// The enrolled part of this name.
    Part(String),
    /// An object that is not enrolled.
    NotEnrolled,
    /// No object: an empty cell.
    Nothing,
}

impl Truth {
    /// Returns the name of the part, if it is one.
    pub fn part(&self) -> Option<&str> {
        match self {
            Self::Part(name) => Some(name),
            Self::NotEnrolled | Self::Nothing => None,
        }
    }

    /// Returns the name used in reports: the part's name, `not_enrolled` or `nothing`.
    pub fn name(&self) -> &str {
        match self {
            Self::Part(name) => name,
            Self::NotEnrolled => "not_enrolled",
            Self::Nothing => "nothing",
        }
    }
}
