//! `partsight path`: what can be done with a part's spray path.

mod check;

use clap::{Args, Subcommand};

use super::{LibraryChoice, Outcome, console::Console};

/// Check a part's stored spray path against an arm
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  partsight path check front_door --arm irb4600 --nozzle \"kuka 0 0 250 0 45 0\" --calibration cell.toml

Exit codes: 0 every point is reached, 1 some are not, 2 could not run.")]
pub(super) struct PathArgs {
    #[command(flatten)]
    library: LibraryChoice,
    #[command(subcommand)]
    command: PathCommand,
}

#[derive(Debug, Subcommand)]
enum PathCommand {
    Check(check::CheckArgs),
}

pub(super) fn run(args: &PathArgs, console: &mut Console) -> anyhow::Result<Outcome> {
    match &args.command {
        PathCommand::Check(check) => check::run(&args.library, check, console),
    }
}
