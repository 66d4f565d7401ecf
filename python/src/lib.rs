//! The Python package `partsight`: numpy arrays and files in, typed results out.
//!
//! Every class is immutable or locks its mutable state, so that objects may be shared between threads. Whatever takes
//! longer than a copy runs without the interpreter's lock; see `interrupt.rs` for how Ctrl-C stops it. Types are in
//! `package/partsight/_partsight.pyi`; the doc comments here are the texts of `help()`.

#![warn(missing_docs)]
#![expect(
    clippy::needless_pass_by_value,
    reason = "Python hands every argument over as a value of its own"
)]

mod alignment;
mod arrays;
mod error;
mod evaluation;
mod inspection;
mod interrupt;
mod library;
mod recipe;
mod scene;

/// Recognises car body parts in depth captures and estimates their pose.
#[pyo3::pymodule]
mod _partsight {
    #[pymodule_export]
    use crate::{
        alignment::{Alignment, align, read_points},
        error::PartsightError,
        evaluation::{KeptCases, evaluation_report, judge_cases},
        inspection::{Inspection, Pose, inspect, inspect_all},
        library::Library,
        recipe::Recipe,
        scene::{Scene, SimulatedFrame, simulate_frame},
    };
}
