//! Experiments: how often right, how far off, how long. On simulated frames, and on the paper's own protocol.
//!
//! Speed is reported here and nowhere else: as medians on the machine at hand, beside the budgets that the design
//! names, never asserted by a test.

pub mod calibration;
mod live;
mod recognition;
pub mod registration;
pub mod scaling;
mod speed;
pub mod suites;
pub mod systems;
pub mod table1;
mod window;

pub use self::{
    live::{LiveStretch, live_stretches},
    recognition::{
        Case, EnrolledStandard, Recognition, RecognitionSetup, enrol_standard_parts, recognise_all,
    },
    speed::{StageTimes, quantile, stage_times},
    window::{FrameCost, WindowCost, window_cost},
};
