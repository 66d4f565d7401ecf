//! The robot's task: reads and writes calibrations, and calculates them from pairs.

use std::{path::PathBuf, sync::Arc};

use robot::{
    Convention, RobotFrame,
    calibration::{CellCalibration, ReadCalibration},
    hand_eye::{HandEye, Mount, Target, solve},
    pairs::{PairConventions, read_pairs},
};
use ui::user_error::UserError;

/// Result of the task.
#[derive(Clone, Debug)]
pub enum RobotResult {
    /// This calibration is now in use; the second is where the former one was kept, if there was one.
    InUse(Arc<CellInUse>, Option<PathBuf>),
    /// The hand-eye calibration from the pairs.
    Solved(Arc<SolvedPairs>),
}

/// A calibration in use.
#[derive(Clone, Debug, PartialEq)]
pub struct CellInUse {
    /// Its file.
    pub path: PathBuf,
    /// The calibration.
    pub calibration: CellCalibration,
    /// True if the file was edited and not confirmed.
    pub is_edited: bool,
}

impl CellInUse {
    /// The robot's frame; `None` if the file was edited and not confirmed, or if the camera is on the flange and the arm's
    /// pose is unknown.
    pub fn frame(&self) -> Option<Arc<RobotFrame>> {
        if self.is_edited {
            return None;
        }
        self.calibration.frame(None).ok().map(Arc::new)
    }
}

/// A hand-eye calibration that the user can choose to use.
#[derive(Clone, Debug, PartialEq)]
pub struct SolvedPairs {
    /// The file of pairs.
    pub path: PathBuf,
    /// Names of all pairs, in file order.
    pub names: Vec<String>,
    /// Names of the pairs left out.
    pub left_out: Vec<String>,
    /// Conventions in which robot and camera poses were read.
    pub conventions: [Convention; 2],
    /// The calculated calibration.
    pub solved: HandEye,
}

/// Saves a calibration to be used, keeping the former file.
pub(super) fn save(path: PathBuf, calibration: &CellCalibration) -> Result<RobotResult, UserError> {
    let former = calibration.save_keeping_former(&path);
    let former = former.map_err(|error| UserError::of(&error))?;
    load(path, former)
}

/// Confirms the edited numbers of a calibration to be used, keeping the former file.
pub(super) fn confirm(path: PathBuf) -> Result<RobotResult, UserError> {
    let former = CellCalibration::confirm(&path);
    let former = former.map_err(|error| UserError::of(&error))?;
    load(path, former)
}

/// Calculates the camera's pose from a file of pairs, leaving out the pairs of the given names.
pub(super) fn solve_pairs(
    path: PathBuf,
    mount: Mount,
    left_out: Vec<String>,
) -> Result<RobotResult, UserError> {
    let read = read_pairs(&path, PairConventions::default());
    let read = read.map_err(|error| UserError::of(&error))?;
    let names = read.pairs.iter().map(|pair| pair.name.clone()).collect();
    let mut pairs = read.pairs;
    pairs.retain(|pair| !left_out.contains(&pair.name));
    let solved = solve(&pairs, mount, Target::Marker).map_err(|error| UserError::of(&error))?;
    Ok(RobotResult::Solved(Arc::new(SolvedPairs {
        path,
        names,
        left_out,
        conventions: [read.robot, read.camera],
        solved,
    })))
}

/// Reads a calibration to be used; `former` is where the former one was kept, if there was one.
pub(super) fn load(path: PathBuf, former: Option<PathBuf>) -> Result<RobotResult, UserError> {
    let ReadCalibration {
        calibration,
        is_edited,
    } = CellCalibration::read(&path).map_err(|error| UserError::of(&error))?;
    let in_use = Arc::new(CellInUse {
        path,
        calibration,
        is_edited,
    });
    Ok(RobotResult::InUse(in_use, former))
}
