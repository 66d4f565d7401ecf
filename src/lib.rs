//! Partsight recognises a car body part in a depth frame and says where it is.

#[cfg(feature = "window")]
pub mod app;
pub mod bench;
pub mod capture;
pub mod cases;
#[cfg(feature = "cli")]
pub mod cli;
pub mod error;
pub mod files;
pub mod geometry;
pub mod history;
pub mod library;
pub mod pipeline;
#[cfg(feature = "cli")]
pub mod report;
pub mod robot;
pub mod scan;
pub mod simulate;
pub mod stages;
pub mod units;
