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
#[derive(Debug, thiserror::Error, Advice)]
pub enum ArmError {
    /// The arm's file cannot be read.
    #[error(transparent)]
    #[advice(transparent)]
    File(#[from] FileError),
    /// No arm has this name.
    #[error("no arm is named {name:?}")]
    #[advice("Name one of {}, or a TOML file with the arm's lengths and limits", ARM_NAMES.join(", "))]
    Unknown {
        /// The name given.
        name: String,
    },
    /// The axes of the arm's wrist do not meet.
    #[error(
        "{name}: Universal Robots' arms have no spherical wrist, so their reach cannot be checked here"
    )]
    #[advice = "Check the path in the maker's simulator before the arm runs it"]
    NoSphericalWrist {
        /// The name given.
        name: String,
    },
    /// The file does not describe an arm.
    #[error("{}: {}", path.display(), message.trim_end())]
    #[advice = "Give name, lengths_mm, offsets_deg, signs, limits_deg, speeds_deg_s and, if needed, accelerations_deg_s2, base_height_mm, radii_mm and rail"]
    Text {
        /// The file.
        path: PathBuf,
        /// The error in it.
        message: String,
    },
    /// The file does not describe the obstacles of a cell.
    #[error("{}: {}", path.display(), message.trim_end())]
    #[advice = "Give each [[box]] a name, centre_mm, size_mm above 0 and, if it is turned, angles_deg; and floor_mm if there is a floor. All lengths are in millimetres"]
    Obstacles {
        /// The file.
        path: PathBuf,
        /// The error in it.
        message: String,
    },
    /// A joint's limits are not in order, or too large.
    #[error("joint {joint} is limited to {low:.1} to {high:.1} degrees")]
    #[advice = "Give the lower limit first, then the upper one, in degrees"]
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
    #[advice = "Give start and end in millimetres: the end 100 mm or more above the start, both within 100000 mm of where the cell was calibrated"]
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
    #[advice = "Measure its positions from where the cell was calibrated, or give its top speed if it moves along the path"]
    Standing {
        /// First position, millimetres.
        low: f64,
        /// Last position, millimetres.
        high: f64,
    },
    /// The floor is above the arm's foot.
    #[error("the floor is {above} above the foot of the arm")]
    #[advice = "Give floor_mm in the frame of the calibration, and the place of the arm's base there"]
    Floor {
        /// By how much.
        above: Metres,
    },
    /// The text does not describe a rail.
    #[error("{text:?} is not a rail")]
    #[advice = "Give x, y or z, where it begins and ends in mm and, if it moves along the path, its top speed in mm/s and its acceleration in mm/s²: y,-2000,2000,1000,2000"]
    NoRail {
        /// The text given.
        text: String,
    },
    /// A number of the arm or of the check is out of its range.
    #[error("{what} is {value}")]
    #[advice = "Correct it: lengths in millimetres, angles in degrees, speeds and accelerations above 0, a rail's from 1 to 10000 mm/s and \
               from 1 to 100000 mm/s², signs 1 or -1, turns about the nozzle from 1 to 72, its tilt from 0 to 30 degrees"]
    Value {
        /// Name of the number.
        what: String,
        /// Its value.
        value: f64,
    },
    /// A length of the check is out of its range.
    #[error("{what} is {value}, expected {:.0} to {:.0} mm", low.mm(), high.mm())]
    #[advice = "Give a length in millimetres within this range"]
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
    #[advice = "Check it again"]
    Cancelled,
    /// The path has no points.
    #[error("the path has no points")]
    #[advice = "Give a path with at least one point"]
    NoPoints,
    /// A number is not finite, or the speed of a point is out of its range.
    #[error("{what} is infinite or not a number")]
    #[advice = "Check the numbers of base, tool, path and approach"]
    NotFinite {
        /// What it belongs to.
        what: String,
    },
}
