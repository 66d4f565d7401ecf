//! The robot's cell in the window: the calibration in use, the dialog that makes another one, the check of whether the cell
//! still stands as it was calibrated, and the server that robots ask.

mod answer_page;
mod answer_setup;
pub mod answering;
mod by_hand;
pub mod cell_check;
mod check_page;
mod controls;
mod dialog;
mod dialog_state;
mod from_pairs;
mod in_use;
pub mod program_setup;
mod servo_settings;
pub mod state;
pub mod work;

pub(crate) use self::answer_page::chip;
pub use self::{
    answer_setup::AnswerSetup,
    answering::{Answering, AnsweringStatus, LastAnswer},
    cell_check::{CellChecks, CheckFolderContent},
    dialog_state::{CheckAction, RobotAction, RobotDialog, RobotFile, RobotPage},
    servo_settings::ServoSettings,
    state::RobotCell,
    work::{CellInUse, RobotResult, SolvedPairs},
};
