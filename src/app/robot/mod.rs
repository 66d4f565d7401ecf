//! The robot's cell in the window: which calibration is in use, and the dialog in which another one is made.

mod by_hand;
mod dialog;
mod from_pairs;
mod in_use;
pub mod state;
pub mod work;

pub(super) use self::{
    dialog::ui,
    state::{apply, calibration_path, hear, start},
};
pub use self::{
    state::{RememberedCell, RobotAction, RobotDialog, RobotPage, RobotState},
    work::{CellInUse, RobotAnswer, RobotRequest, SolvedPairs},
};
