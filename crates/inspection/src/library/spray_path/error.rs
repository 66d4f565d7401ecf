//! Errors of reading a spray path.

use std::path::PathBuf;

use super::{MAX_PATH_POINTS, MAX_SPEED_M_S};
use crate::library::{LibraryError, PartName};
use files::{FileError, shortened};
use geometry::{error::Advice, units::Metres};

/// Why a spray path cannot be read.
#[derive(Debug, thiserror::Error, Advice)]
pub enum SprayPathError {
    /// The file cannot be read.
    #[error(transparent)]
    #[advice(transparent)]
    File(#[from] FileError),
    /// There is no heading with the names of the columns.
    #[error("{}: no heading that names the columns", path.display())]
    #[advice(NAME_COLUMNS)]
    NoHeading {
        /// The file.
        path: PathBuf,
    },
    /// The heading lacks columns that every point needs.
    #[error("{}: the heading {found:?} does not name all columns of a path", path.display())]
    #[advice(NAME_COLUMNS)]
    MissingColumns {
        /// The file.
        path: PathBuf,
        /// The heading.
        found: String,
    },
    /// The heading has two columns for the same number.
    #[error("{}: the heading has a second column for the same number, {:?}", path.display(), shortened(column))]
    #[advice = "Leave out one of the two columns"]
    TwoColumns {
        /// The file.
        path: PathBuf,
        /// Name of the second column.
        column: String,
    },
    /// A line is not a valid point.
    #[error("{}, line {line}: {problem}", path.display())]
    #[advice(problem.advice())]
    Line {
        /// The file.
        path: PathBuf,
        /// Line number, from 1.
        line: usize,
        /// The problem.
        problem: PathLineProblem,
    },
    /// The file has a heading but no points.
    #[error("{}: the path has no points", path.display())]
    #[advice = "Write one line for each point of the path"]
    NoPoints {
        /// The file.
        path: PathBuf,
    },
    /// The path has too many points.
    #[error("{}: more than {MAX_PATH_POINTS} points", path.display())]
    #[advice = "Thin the path out: a point every 10 mm is plenty"]
    TooMany {
        /// The file.
        path: PathBuf,
    },
    /// The path is for another part.
    #[error("{}: a path of {}, not of {part}", path.display(), shortened(named))]
    #[advice = "Give a path of {part}; if this is one, because the part was renamed, correct the line \"# part\" in the file"]
    OtherPart {
        /// The file.
        path: PathBuf,
        /// The part that the file names.
        named: String,
        /// The part that a path was wanted of.
        part: PartName,
    },
    /// The part cannot be read.
    #[error(transparent)]
    #[advice(transparent)]
    Library(#[from] Box<LibraryError>),
    /// The file is not the path that was stored.
    #[error("{}: the spray path is damaged or was changed: its checksum is {found}, part.toml says {expected}", path.display())]
    #[advice = "Store the path again: partsight library path NAME path.csv"]
    Changed {
        /// The file.
        path: PathBuf,
        /// Checksum of the file.
        found: String,
        /// Checksum of the stored path.
        expected: String,
    },
}

/// A problem of one line.
#[derive(Clone, Debug, PartialEq, thiserror::Error, Advice)]
#[advice = "Correct this line in a text editor or a spreadsheet"]
pub enum PathLineProblem {
    /// A cell is not a number.
    #[error("{:?} in column {column} is not a number", shortened(cell))]
    NoNumber {
        /// Column number, from 1.
        column: usize,
        /// Content of the cell.
        cell: String,
    },
    /// The line has fewer cells than the heading names.
    #[error("fewer numbers than the heading has columns")]
    TooShort,
    /// The position is out of reach of any arm.
    #[error("{:.0} m from the part's origin", distance.0)]
    #[advice(CHECK_UNIT)]
    FarAway {
        /// Distance from the part's origin.
        distance: Metres,
    },
    /// The stand-off is not from 20 mm to 1 m.
    #[error("a stand-off of {distance}, expected 20 to 1000 mm")]
    #[advice(CHECK_UNIT)]
    StandOff {
        /// The value.
        distance: Metres,
    },
    /// `gun_on` is neither 1 nor 0.
    #[error("{:?} under gun_on, expected 1 or 0", shortened(cell))]
    #[advice = "Write 1 where the gun sprays from this point to the next, and 0 where it does not"]
    GunOn {
        /// Content of the cell.
        cell: String,
    },
    /// The speed is not positive, or faster than any robot.
    #[error("a speed of {:.0} mm/s, expected more than 0 and at most {:.0}", speed * 1000.0, MAX_SPEED_M_S * 1000.0)]
    #[advice = "Check the unit in the heading: speed_mm_s or speed_m_s"]
    Speed {
        /// The value, m/s.
        speed: f64,
    },
    /// The fan's long side is not perpendicular to the direction.
    #[error("the fan's long side is not at right angles to the direction")]
    #[advice = "Let fan_x, fan_y, fan_z point along the long side of the jet, or leave them empty for a round one"]
    Fan,
    /// The direction is zero.
    #[error("the direction has no length")]
    NoDirection,
}

const NAME_COLUMNS: &str = "Begin with nozzle_x_mm,nozzle_y_mm,nozzle_z_mm,direction_x,direction_y,direction_z or with x_mm,y_mm,z_mm,normal_x,normal_y,normal_z,stand_off_mm";
const CHECK_UNIT: &str = "Check the unit in the heading: _mm or _m";
