//! Experiments: how often right, how far off, how long. On simulated frames, and on the paper's own protocol.
//!
//! Speed is reported here and nowhere else: as medians on the machine at hand, beside the budgets that the design
//! names, never asserted by a test. The window, which shows some of these, is measured beside it.

pub mod bounds;
pub mod calibration;
mod evaluation;
mod history;
pub mod paint;
mod process_usage;
mod processor_time;
pub mod registration;
pub mod scaling;
mod speed;
pub mod suites;
pub mod systems;
pub mod table1;

pub use self::{
    evaluation::EvaluationReport,
    history::{HistoryTime, history_times},
    process_usage::ProcessUsage,
    processor_time::{ProcessorWatch, cpu_wait_seconds, process_seconds},
    speed::{SetTimes, StageTimes, quantile, stage_times},
};
