//! Errors of arms and their checks.

use std::path::PathBuf;

use super::ARM_NAMES;
use files::FileError;
use geometry::{error::Advice, units::Metres};
use texts::{Described, Message};

/// An arm that does not reach all of a path, or collides on it.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error, serde::Serialize)]
pub struct NotReached {
    /// Name of the arm.
    pub arm: String,
    /// Number of points that it reaches without a collision.
    pub num_reached: usize,
    /// Number of points at which it collides.
    pub num_collisions: usize,
    /// Number of all points.
    pub num_points: usize,
}

impl Described for NotReached {
    fn message(&self) -> Message {
        let message = Message::new("doubt-not-reached").with_fields(self);
        message.with("num_missed", (self.num_points - self.num_reached) as f64)
    }
}

texts::display!(NotReached);

/// Why an arm cannot be used, or a path not be checked.
#[derive(Debug, thiserror::Error)]
pub enum ArmError {
    /// The arm's file cannot be read.
    #[error(transparent)]
    File(#[from] FileError),
    /// No arm has this name.
    #[error("no arm is named {name:?}")]
    Unknown {
        /// The name given.
        name: String,
    },
    /// The axes of the arm's wrist do not meet.
    #[error(
        "{name}: Universal Robots' arms have no spherical wrist, so their reach cannot be checked here"
    )]
    NoSphericalWrist {
        /// The name given.
        name: String,
    },
    /// The file does not describe an arm.
    #[error("{}: {}", path.display(), message.trim_end())]
    Text {
        /// The file.
        path: PathBuf,
        /// The error in it.
        message: String,
    },
    /// The file does not describe the obstacles of a cell.
    #[error("{}: {}", path.display(), message.trim_end())]
    Obstacles {
        /// The file.
        path: PathBuf,
        /// The error in it.
        message: String,
    },
    /// A joint's limits are not in order, or too large.
    #[error("joint {joint} is limited to {low:.1} to {high:.1} degrees")]
    Limits {
        /// The joint, from 1.
        joint: usize,
        /// Lower limit, degrees.
        low: f64,
        /// Upper limit, degrees.
        high: f64,
    },
    /// The rail is too short or too long.
    #[error("the rail runs from {low:.0} to {high:.0} mm")]
    Rail {
        /// First position, millimetres.
        low: f64,
        /// Last position, millimetres.
        high: f64,
    },
    /// A rail that stands still does not include the place where the cell was calibrated.
    #[error(
        "the rail runs from {low:.0} to {high:.0} mm and stands still, but not at 0, where the cell was calibrated"
    )]
    Standing {
        /// First position, millimetres.
        low: f64,
        /// Last position, millimetres.
        high: f64,
    },
    /// The floor is above the arm's foot.
    #[error("the floor is {above} above the foot of the arm")]
    Floor {
        /// By how much.
        above: Metres,
    },
    /// The text does not describe a rail.
    #[error("{text:?} is not a rail")]
    NoRail {
        /// The text given.
        text: String,
    },
    /// A number of the arm or of the check is out of its range.
    #[error("{what} is {value}")]
    Value {
        /// Name of the number.
        what: String,
        /// Its value.
        value: f64,
    },
    /// A length of the check is out of its range.
    #[error("{what} is {value}, expected {:.0} to {:.0} mm", low.mm(), high.mm())]
    Length {
        /// Name of the length.
        what: &'static str,
        /// Its value.
        value: Metres,
        /// Least value.
        low: Metres,
        /// Greatest value.
        high: Metres,
    },
    /// The caller cancelled.
    #[error("the check of the arm was cancelled")]
    Cancelled,
    /// The path has no points.
    #[error("the path has no points")]
    NoPoints,
    /// A number is not finite, or the speed of a point is out of its range.
    #[error("{what} is infinite or not a number")]
    NotFinite {
        /// What it belongs to.
        what: String,
    },
}

impl Advice for ArmError {
    fn advice(&self) -> String {
        match self {
            Self::File(error) => error.advice(),
            Self::Unknown { .. } => format!(
                "Name one of {}, or a TOML file with the arm's lengths and limits",
                ARM_NAMES.join(", ")
            ),
            Self::NoSphericalWrist { .. } => {
                "Check the path in the maker's simulator before the arm runs it".into()
            }
            Self::Text { .. } => {
                "Give name, lengths_mm, offsets_deg, signs, limits_deg, speeds_deg_s and, if needed, accelerations_deg_s2, base_height_mm, radii_mm and rail".into()
            }
            Self::Obstacles { .. } => {
                "Give each [[box]] a name, centre_mm, size_mm above 0 and, if it is turned, angles_deg; and floor_mm if there is a floor. All lengths are in millimetres".into()
            }
            Self::Limits { .. } => "Give the lower limit first, then the upper one, in degrees".into(),
            Self::Rail { .. } => {
                "Give start and end in millimetres: the end 100 mm or more above the start, both within 100000 mm of where the cell was calibrated".into()
            }
            Self::Standing { .. } => {
                "Measure its positions from where the cell was calibrated, or give its top speed if it moves along the path".into()
            }
            Self::Floor { .. } => {
                "Give floor_mm in the frame of the calibration, and the place of the arm's base there".into()
            }
            Self::NoRail { .. } => {
                "Give x, y or z, where it begins and ends in mm and, if it moves along the path, its top speed in mm/s and its acceleration in mm/s²: y,-2000,2000,1000,2000".into()
            }
            Self::Value { .. } => {
                "Correct it: lengths in millimetres, angles in degrees, speeds and accelerations above 0, a rail's from 1 to 10000 mm/s and from 1 to 100000 mm/s², signs 1 or -1, turns about the nozzle from 1 to 72, its tilt from 0 to 30 degrees".into()
            }
            Self::Length { .. } => "Give a length in millimetres within this range".into(),
            Self::Cancelled => "Check it again".into(),
            Self::NoPoints => "Give a path with at least one point".into(),
            Self::NotFinite { .. } => "Check the numbers of base, tool, path and approach".into(),
        }
    }
}
