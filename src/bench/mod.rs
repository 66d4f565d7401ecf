//! Experiments on simulated frames: how often right, how far off, how long.
//!
//! Speed is reported here and nowhere else: as medians on the machine at hand, beside the budgets that the design
//! names, never asserted by a test.

mod recognition;
mod speed;
mod window;

pub use self::{
    recognition::{
        Case, EnrolledStandard, Recognition, RecognitionSetup, enrol_standard_parts, recognise_all,
    },
    speed::{StageTimes, stage_times},
    window::{FrameCost, WindowCost, window_cost},
};
