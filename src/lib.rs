//! Partsight recognises a car body part in a depth frame and says where it is.

pub mod capture;
pub mod error;
pub mod files;
pub mod geometry;
pub mod library;
pub mod pipeline;
pub mod simulate;
pub mod stages;
pub mod units;
