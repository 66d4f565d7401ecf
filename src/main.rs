//! Partsight: the window, or a command.

use std::process::ExitCode;

use clap::Parser as _;
use mimalloc::MiMalloc;
use partsight::cli::{self, Cli};

/// Frames of megabytes come and go thirty times a second on several threads. glibc keeps what they leave behind, more
/// with every minute; this one gives it back or uses it again.
#[global_allocator]
static ALLOCATOR: MiMalloc = MiMalloc;

fn main() -> ExitCode {
    cli::run(Cli::parse()).into()
}
