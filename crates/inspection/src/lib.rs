//! The enrolled parts ([`library`]), and the inspection of a scene with them ([`pipeline`]): recipe, run, verdict, live.

#[cfg(any(test, feature = "fixtures"))]
pub mod fixtures;
pub mod library;
pub mod pipeline;
