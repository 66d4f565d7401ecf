//! Experiments: recognition rate, pose error and run time, on simulated frames and on the paper's own protocol. [`cli`] is
//! the program `partsight-bench`, which shows them.
//!
//! Speed is reported here only: as medians on the present machine, next to the budgets of the design. Tests never
//! assert it.

pub mod bounds;
pub mod calibration;
pub mod cli;
pub mod history;
pub mod line;
pub mod live_cost;
pub mod paint;
pub mod process_usage;
pub mod processor_time;
pub mod registration;
pub mod servo;
pub mod speed;
pub mod suites;
pub mod surface;
pub mod systems;
pub mod table1;
pub mod window_cost;
