//! The command line from end to end: the built program, run in folders of its own.

mod calibrate;
mod enrol_and_inspect;
mod evaluate;
mod history;
mod report;
mod sources;
mod workplace;
