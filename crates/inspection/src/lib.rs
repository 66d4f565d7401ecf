//! The enrolled parts, and the inspection of a scene with them: recipe, run, verdict, live.

#![cfg_attr(test, allow(clippy::disallowed_methods, reason = "tests change files"))]

#[cfg(any(test, feature = "fixtures"))]
pub mod fixtures;
pub mod library;
pub mod pipeline;
pub mod rack;
