//! The robot's cell in the window: which calibration is in use, and the dialog in which another one is made.

mod by_hand;
mod dialog;
mod from_pairs;
mod in_use;
pub mod state;
pub mod work;

pub use self::{
    state::{RobotAction, RobotCell, RobotDialog, RobotFile, RobotPage},
    work::{CellInUse, RobotResult, SolvedPairs},
};
