//! Opens the Partsight window, or runs a command.

use std::process::ExitCode;

use clap::Parser as _;
use mimalloc::MiMalloc;
use partsight::cli::{self, Cli};

/// Frames of several megabytes are allocated and freed thirty times a second on several threads. glibc retains ever
/// more of the freed memory; mimalloc reuses or returns it.
#[global_allocator]
static ALLOCATOR: MiMalloc = MiMalloc;

fn main() -> ExitCode {
    cli::run(Cli::parse()).into()
}
