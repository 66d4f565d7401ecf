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
    block_size_signal();
    cli::run(Cli::parse()).into()
}

/// Makes a write beyond a limit on the size of files (`ulimit -f`) fail with an error, as on a full disk. Its signal would
/// end the program. Threads started later inherit this.
fn block_size_signal() {
    #[cfg(unix)]
    {
        use nix::sys::signal::{SigSet, Signal};

        // It fails for unknown signals only.
        let _ = SigSet::from(Signal::SIGXFSZ).thread_block();
    }
}
