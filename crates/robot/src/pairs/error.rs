//! Why a file of poses cannot be read.

use std::path::PathBuf;

use crate::{Convention, ConventionError};
use files::{FileError, shortened};
use geometry::error::Advice;

/// Why a file of poses cannot be read.
#[derive(Debug, thiserror::Error, Advice)]
pub enum PairsError {
    /// The file cannot be read.
    #[error(transparent)]
    #[advice(transparent)]
    File(#[from] FileError),
    /// Neither the caller nor the file names the convention of the robot's poses.
    #[error("{}: the convention of the robot's poses is not given", path.display())]
    #[advice(
        "Begin the file with a line such as # robot: kuka, or name it with --robot-convention: {}",
        names()
    )]
    NoConvention {
        /// The file.
        path: PathBuf,
    },
    /// A line or pair cannot be read.
    #[error("{}, {place}: {problem}", path.display())]
    #[advice(problem.advice())]
    Line {
        /// The file.
        path: PathBuf,
        /// The line or pair.
        place: String,
        /// What is wrong with it.
        problem: LineProblem,
    },
    /// Not JSON of pairs.
    #[error("{}: not a JSON file of pairs: {found}", path.display())]
    #[advice = r#"Write {{"robot": "kuka", "camera": "matrix", "pairs": [{{"name": "p1", "robot": [...], "camera": [...]}}]}}"#]
    BadJson {
        /// The file.
        path: PathBuf,
        /// The first error in it.
        found: String,
    },
    /// The file has no counts.
    #[error("{}: no counts", path.display())]
    #[advice = "Write one line for each frame; partsight calibrate line --help shows how"]
    NoCounts {
        /// The file.
        path: PathBuf,
    },
    /// The file has no poses.
    #[error("{}: no poses", path.display())]
    #[advice = "Write one line for each pose; partsight calibrate hand-eye --help shows how"]
    NoPoses {
        /// The file.
        path: PathBuf,
    },
}

/// What is wrong with one line.
#[derive(Clone, Debug, PartialEq, thiserror::Error, Advice)]
#[advice = "Correct this line in a text editor; a name may stand in its first cell, and a comment begins with #"]
pub enum LineProblem {
    /// A cell is not a number.
    #[error("{:?} in column {column} is not a number", shortened(cell))]
    NoNumber {
        /// The column, from 1.
        column: usize,
        /// Content of the cell.
        cell: String,
    },
    /// Too few numbers, or too many.
    #[error("{found} numbers, expected {needed}: {expected}")]
    Count {
        /// Numbers in the line.
        found: usize,
        /// Numbers needed.
        needed: usize,
        /// What the numbers are, for the message.
        expected: String,
    },
    /// A count is not a whole number.
    #[error("{found} is no count of an encoder")]
    #[advice = "Write the count as the controller shows it: a whole number of at most 32 bits"]
    NotWhole {
        /// The number in the line.
        found: f64,
    },
    /// The numbers are not a pose in their convention.
    #[error(transparent)]
    #[advice(transparent)]
    Pose(#[from] ConventionError),
    /// No convention has this name.
    #[error("no convention is named {:?}", shortened(name))]
    #[advice("Use one of {}", names())]
    NoSuchConvention {
        /// The name in the file.
        name: String,
    },
}

/// The names of all conventions.
fn names() -> String {
    Convention::ALL.map(Convention::name).join(", ")
}
