//! The robot's cell in the window: which calibration is in use, the dialog in which another one is made, and the check of
//! whether the cell still stands as it was calibrated.

mod by_hand;
pub mod cell_check;
mod check_page;
mod dialog;
mod from_pairs;
mod in_use;
pub mod state;
pub mod work;

pub use self::{
    cell_check::{CellChecks, CheckAction, CheckFolderContent},
    state::{RobotAction, RobotCell, RobotDialog, RobotFile, RobotPage},
    work::{CellInUse, RobotResult, SolvedPairs},
};
