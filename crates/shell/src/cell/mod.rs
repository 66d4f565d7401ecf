//! The robot's cell in the window: the calibration in use, the dialog that makes another one, the check of whether the cell
//! still stands as it was calibrated, and the server that robots ask.

mod answer_page;
pub mod answering;
mod by_hand;
pub mod cell_check;
mod check_page;
mod controls;
mod dialog;
mod dialog_state;
mod from_pairs;
mod in_use;
mod setup;
pub mod state;
pub mod work;

pub(crate) use self::answer_page::chip;
pub use self::{
    answering::{Answering, AnsweringStatus, LastAnswer},
    cell_check::{CellChecks, CheckFolderContent},
    dialog_state::{CheckAction, RobotAction, RobotDialog, RobotFile, RobotPage},
    setup::{AnswerSetup, ProgramSetup, ServoSettings, program_file_name},
    state::RobotCell,
    work::{CellInUse, RobotResult, SolvedPairs},
};
