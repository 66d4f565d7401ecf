//! The command line from end to end: the built program, run in folders of its own.

mod align_and_bench;
mod calibrate;
mod evaluate;
mod history;
mod inspect;
mod library;
mod report;
mod simulate_and_say;
mod sources;
mod workplace;
