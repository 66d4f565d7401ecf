//! Runs an experiment.

use std::process::ExitCode;

use bench::cli::{self, Cli};
use clap::Parser as _;
use mimalloc::MiMalloc;

/// As the program's, whose memory and times are measured here.
#[global_allocator]
static ALLOCATOR: MiMalloc = MiMalloc;

fn main() -> ExitCode {
    cli::run(&Cli::parse()).into()
}
