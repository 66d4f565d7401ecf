//! The command line from end to end: the built program, run in folders of its own.

mod align;
mod bench;
mod calibrate;
mod cell;
mod docs;
mod errors_and_help;
mod evaluate;
mod history;
mod inspect;
#[path = "../kit/mod.rs"]
mod kit;
mod library;
mod paint;
mod program;
mod recipe;
mod report;
mod scan;
mod serve;
mod simulate;
mod sources;
mod system;
mod workplace;
