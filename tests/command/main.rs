//! The command line from end to end: the built program, run in folders of its own.

#![allow(clippy::disallowed_methods, reason = "tests change files")]

mod align;
mod calibrate;
mod cell;
mod docs;
mod errors_and_help;
mod evaluate;
mod examples;
mod fuzz_targets;
#[cfg(target_os = "linux")]
mod genicam;
mod history;
mod inspect;
mod kill;
#[path = "../kit/mod.rs"]
mod kit;
mod library;
mod line;
mod packaging;
mod paint;
mod program;
#[cfg(all(feature = "window", target_os = "linux"))]
mod real_window;
mod recipe;
mod report;
mod scan;
mod serve;
mod servo;
mod simulate;
mod sources;
mod system;
mod workplace;

/// The tested program.
const PROGRAM: &str = env!("CARGO_BIN_EXE_partsight");
