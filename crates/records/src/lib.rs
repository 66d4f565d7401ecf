//! What is kept of inspections: the history, cases, and the reports made of them.

pub mod cases;
#[cfg(any(test, feature = "fixtures"))]
pub mod fixtures;
pub mod history;
pub mod report;
