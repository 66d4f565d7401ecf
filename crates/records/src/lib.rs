//! What is kept of inspections: the history, cases, and the reports made of them; and the table of the orders that they are for.

#![cfg_attr(test, allow(clippy::disallowed_methods, reason = "tests change files"))]

pub mod cases;
#[cfg(any(test, feature = "fixtures"))]
pub mod fixtures;
pub mod history;
pub mod orders;
pub mod report;
