//! What the robot's task does: reads and writes calibrations, and calculates them from pairs.

use std::{path::PathBuf, sync::Arc};

use crate::{
    app::user_error::UserError,
    robot::{
        Convention, RobotFrame,
        calibration::{CellCalibration, Loaded},
        hand_eye::{HandEye, Mount, solve},
        pairs::{PairConventions, read_pairs},
    },
};

/// What comes back.
#[derive(Clone, Debug)]
pub enum RobotResult {
    /// This calibration is in use now; what was there before is kept in the second.
    InUse(Arc<CellInUse>, Option<PathBuf>),
    /// Where the camera sits by the pairs.
    Solved(Arc<SolvedPairs>),
}

/// A calibration in use.
#[derive(Clone, Debug, PartialEq)]
pub struct CellInUse {
    /// Its file.
    pub path: PathBuf,
    /// The calibration.
    pub calibration: CellCalibration,
    /// True if somebody edited the file.
    pub is_edited: bool,
}

impl CellInUse {
    /// The robot's frame; `None` while nobody says where the flange is that the camera is on.
    pub fn frame(&self) -> Option<Arc<RobotFrame>> {
        self.calibration.frame(None).ok().map(Arc::new)
    }
}

/// A hand-eye calibration that waits to be used.
#[derive(Clone, Debug, PartialEq)]
pub struct SolvedPairs {
    /// The file of the pairs.
    pub path: PathBuf,
    /// Names of all pairs, in the file's order.
    pub names: Vec<String>,
    /// Names of those that were left out.
    pub left_out: Vec<String>,
    /// In which conventions robot and camera poses were read.
    pub conventions: [Convention; 2],
    /// The result.
    pub solved: HandEye,
}

/// Reads the calibration in this file, to be used.
pub(super) fn load(path: PathBuf) -> Result<RobotResult, UserError> {
    in_use(path, None)
}

/// Writes a calibration into this file, to be used.
pub(super) fn save(path: PathBuf, calibration: &CellCalibration) -> Result<RobotResult, UserError> {
    let former = calibration.save_keeping_former(&path);
    let former = former.map_err(|error| UserError::of(&error))?;
    in_use(path, former)
}

/// Calculates where the camera sits from this file of pairs, without those of these names.
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
    let solved = solve(&pairs, mount).map_err(|error| UserError::of(&error))?;
    Ok(RobotResult::Solved(Arc::new(SolvedPairs {
        path,
        names,
        left_out,
        conventions: [read.robot, read.camera],
        solved,
    })))
}

fn in_use(path: PathBuf, former: Option<PathBuf>) -> Result<RobotResult, UserError> {
    let Loaded {
        calibration,
        is_edited,
    } = CellCalibration::load(&path).map_err(|error| UserError::of(&error))?;
    let in_use = Arc::new(CellInUse {
        path,
        calibration,
        is_edited,
    });
    Ok(RobotResult::InUse(in_use, former))
}
