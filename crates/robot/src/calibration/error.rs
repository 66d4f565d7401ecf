//! Errors of calibration files.

use std::path::PathBuf;

use crate::MAX_POSE_DISTANCE_M;
use files::FileError;
use geometry::{error::Advice, units::Metres};

/// Why a calibration file cannot be read or written.
#[derive(Debug, thiserror::Error, Advice)]
pub enum CalibrationError {
    /// The file cannot be read or written.
    #[error(transparent)]
    #[advice(match _0 {
        FileError::NotFound { .. } => {
            "Check the path, or make a calibration: partsight calibrate hand-eye, or partsight calibrate set".into()
        }
        FileError::Newer { .. } => "Update Partsight, or calibrate again with this version".into(),
        other => other.advice(),
    })]
    File(#[from] FileError),
    /// The file has unexpected content.
    #[error("{}: not a calibration: {found}", path.display())]
    #[advice = "Correct the file in a text editor, or calibrate again; partsight calibrate set --help shows how"]
    Bad {
        /// The file.
        path: PathBuf,
        /// The first error in it.
        found: String,
    },
    /// A matrix is not a rigid transform.
    #[error("{}: {key} is not a rigid transform: it stretches, mirrors, is not finite or does not end in 0 0 0 1", path.display())]
    #[advice = "Enter the matrix again with at least four digits after the decimal point: rows of a rotation, then the shift in metres, then 0 0 0 1"]
    NotRigid {
        /// The file.
        path: PathBuf,
        /// Name of the matrix.
        key: &'static str,
    },
    /// No cell is this large: the unit is wrong.
    #[error("{}: {key} shifts by {:.0} m, expected at most {} m", path.display(), distance.0, MAX_POSE_DISTANCE_M)]
    #[advice = "Give the shift in metres: the first three numbers of the matrix's last column"]
    TooFar {
        /// The file.
        path: PathBuf,
        /// Name of the matrix.
        key: &'static str,
        /// Length of its shift.
        distance: Metres,
    },
    /// The numbers are not those that the program wrote.
    #[error("{}: the numbers were changed after the calibration: its checksum is missing or does not match", path.display())]
    #[advice("Check the numbers. If they are right, confirm them: partsight calibrate confirm --calibration {}, or Robot… in the window; else calibrate again", path.display())]
    Edited {
        /// The file.
        path: PathBuf,
    },
    /// The numbers would change in the file, so it was not written.
    #[error("{}: not written: the file would not give back the same numbers", path.display())]
    #[advice = "Check the numbers and their convention: a camera sits within metres of the robot"]
    NotKept {
        /// The file.
        path: PathBuf,
    },
}
