//! Why a spray path cannot be read.

use std::path::PathBuf;

use super::{MAX_PATH_POINTS, MAX_SPEED};
use crate::{
    error::Advice,
    files::{FileError, shortened},
    library::LibraryError,
    units::Metres,
};

/// Why a spray path cannot be read.
#[derive(Debug, thiserror::Error)]
pub enum SprayPathError {
    /// The file cannot be read.
    #[error(transparent)]
    File(#[from] FileError),
    /// Nothing says what the numbers are.
    #[error("{}: no heading that names the columns", path.display())]
    NoHeading {
        /// The file.
        path: PathBuf,
    },
    /// The heading does not name all that a point needs.
    #[error("{}: the heading {found:?} does not name all columns of a path", path.display())]
    MissingColumns {
        /// The file.
        path: PathBuf,
        /// The heading.
        found: String,
    },
    /// A line that is no point.
    #[error("{}, line {line}: {problem}", path.display())]
    Line {
        /// The file.
        path: PathBuf,
        /// The line, from 1.
        line: usize,
        /// What is wrong with it.
        problem: PathLineProblem,
    },
    /// A heading and nothing else.
    #[error("{}: the path has no points", path.display())]
    NoPoints {
        /// The file.
        path: PathBuf,
    },
    /// More points than are read.
    #[error("{}: more than {MAX_PATH_POINTS} points", path.display())]
    TooMany {
        /// The file.
        path: PathBuf,
    },
    /// The part cannot be looked at.
    #[error(transparent)]
    Library(#[from] Box<LibraryError>),
    /// The stored path is not the one that was stored.
    #[error("{}: the spray path is damaged or was changed: its checksum is {found}, part.toml says {expected}", path.display())]
    Changed {
        /// The file.
        path: PathBuf,
        /// Its checksum.
        found: String,
        /// The one that was stored.
        expected: String,
    },
}

/// What is wrong with one line.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PathLineProblem {
    /// A word where a number is needed.
    #[error("{:?} in column {column} is not a number", shortened(cell))]
    NoNumber {
        /// The column, from 1.
        column: usize,
        /// What is there.
        cell: String,
    },
    /// Fewer cells than the heading names.
    #[error("fewer numbers than the heading names columns")]
    TooShort,
    /// A position that no arm reaches.
    #[error("{:.0} m from the part's origin", distance.0)]
    FarAway {
        /// How far.
        distance: Metres,
    },
    /// A distance of the nozzle that is none.
    #[error("a stand-off of {distance}, expected 0 to 1000 mm")]
    StandOff {
        /// What it says.
        distance: Metres,
    },
    /// A mark of the gun that is neither 1 nor 0.
    #[error("{:?} under gun_on, expected 1 or 0", shortened(cell))]
    GunOn {
        /// What is there.
        cell: String,
    },
    /// A speed that is none, or that no robot reaches.
    #[error("a speed of {:.0} mm/s, expected more than 0 and at most {:.0}", speed * 1000.0, MAX_SPEED * 1000.0)]
    Speed {
        /// What it says, m/s.
        speed: f64,
    },
    /// A long side of the fan that is not across the jet.
    #[error("the fan's long side is not at right angles to the direction")]
    Fan,
    /// A direction of no length.
    #[error("the direction has no length")]
    NoDirection,
}

impl Advice for SprayPathError {
    fn advice(&self) -> String {
        match self {
            Self::File(error) => error.advice(),
            Self::Library(error) => error.advice(),
            Self::NoHeading { .. } | Self::MissingColumns { .. } => {
                "Begin with nozzle_x_mm,nozzle_y_mm,nozzle_z_mm,direction_x,direction_y,direction_z or with x_mm,y_mm,z_mm,normal_x,normal_y,normal_z,stand_off_mm".into()
            }
            Self::Line { problem, .. } => match problem {
                PathLineProblem::FarAway { .. } | PathLineProblem::StandOff { .. } => {
                    "Check the unit in the heading: _mm or _m".into()
                }
                PathLineProblem::GunOn { .. } => {
                    "Write 1 where the gun sprays from this point to the next, and 0 where it does not"
                        .into()
                }
                PathLineProblem::Fan => {
                    "Let fan_x, fan_y, fan_z point along the long side of the jet, or leave them empty for a round one".into()
                }
                PathLineProblem::Speed { .. } => {
                    "Check the unit in the heading: speed_mm_s or speed_m_s".into()
                }
                _ => "Correct this line in a text editor or a spreadsheet".into(),
            },
            Self::NoPoints { .. } => "Write one line for each point of the path".into(),
            Self::TooMany { .. } => "Thin the path out: a point every 10 mm is plenty".into(),
            Self::Changed { .. } => {
                "Store the path again: partsight library path NAME path.csv".into()
            }
        }
    }
}
