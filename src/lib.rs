//! Partsight recognises a car body part in a depth frame and says where it is.
pub mod capture;
pub mod error;
pub mod files;
pub mod geometry;
pub mod units;
