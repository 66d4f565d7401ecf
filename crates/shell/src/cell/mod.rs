//! The robot's cell in the window: the calibration in use, the dialog that makes another one, the check of whether the cell
//! still stands as it was calibrated, and the server that robots ask.

pub mod answering;
pub mod cell_check;
mod check_page;
mod dialog;
mod dialog_state;
mod servo_setup;
mod setup;
pub mod state;

pub use self::{
    answering::{Answering, AnsweringStatus, LastAnswer, operators_warning},
    cell_check::{CellChecks, CheckFolderContent},
    dialog_state::{
        CellInUse, CheckAction, RobotAction, RobotDialog, RobotFile, RobotPage, RobotResult,
        SolvedPairs,
    },
    servo_setup::{not_calibrated, servo_setup},
    setup::{AnswerSetup, ProgramSetup, ServoSettings, program_file_name},
    state::RobotCell,
};
