//! A simulated cell in which a whole run of servoing can be tried: an arm that carries a camera, the part, and what may go
//! wrong.
//!
//! Time is simulated too, and everything is drawn from seeds: the same setup gives the same run.

mod arm;
mod cell;
mod controller;
mod part;
mod run;
mod single_moves;

pub use self::{
    arm::{ArmDynamics, SimulatedArm},
    cell::{
        ARM, CellCamera, CellSetup, Disturbance, HandEyeError, SimulatedCell, SimulatedCellError,
        SimulatedTarget,
    },
    controller::{SimulatedController, StreamProtocol},
    part::{CellPart, ScannedPart},
    run::{RunResult, Sample, run},
    single_moves::run_in_single_moves,
};
