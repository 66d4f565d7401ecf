//! What every workspace stands on.

pub mod task;
