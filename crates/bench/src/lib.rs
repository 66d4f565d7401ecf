//! Experiments: recognition rate, pose error and run time, on simulated frames and on the paper's own protocol.
//!
//! Speed is reported here only: as medians on the present machine, next to the budgets of the design. Tests never
//! assert it. The window, which shows some of these figures, is measured separately.

pub mod bounds;
pub mod calibration;
mod evaluation;
mod history;
pub mod line;
pub mod paint;
mod process_usage;
mod processor_time;
pub mod registration;
pub mod scaling;
pub mod servo;
mod speed;
pub mod suites;
pub mod systems;
pub mod table1;

pub use self::{
    evaluation::EvaluationReport,
    history::{HistoryTime, history_times},
    process_usage::ProcessUsage,
    processor_time::{ProcessorWatch, cpu_wait_seconds, process_seconds},
    speed::{SetTimes, StageTimes, stage_times},
};
