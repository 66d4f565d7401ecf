//! Partsight: the window, or a command.

use std::process::ExitCode;

use clap::Parser as _;
use partsight::cli::{self, Cli};

fn main() -> ExitCode {
    cli::run(Cli::parse()).into()
}
