//! `partsight path`: commands on a part's spray path.

mod check;
mod export;
mod fit;
mod paint;

use clap::{Args, Subcommand};

use super::{
    LibraryChoice, Outcome,
    console::{Advised as _, Console, advised_error, store_a_path},
};
use inspection::library::{LibraryPlace, PartName, SprayPath};

/// Plan a part's spray path, simulate its film, check it against an arm, and export it to a controller
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  partsight path plan front_door --coat primer --propose --output path.csv
  partsight path simulate front_door --coat primer --path path.csv
  partsight path check front_door --arm irb4600 --nozzle \"kuka 0 0 250 0 45 0\" --calibration cell.toml
  partsight path export front_door --as krl --calibration cell.toml --output paint.src
  partsight path fit stripe.csv --coat primer --output my_primer.toml

Exit codes: 0 every point is reached, or 90 % of the film is within its tolerance; 1 otherwise; 2 could not run.")]
pub(super) struct PathArgs {
    #[command(flatten)]
    library: LibraryChoice,
    #[command(subcommand)]
    command: PathCommand,
}

#[derive(Debug, Subcommand)]
enum PathCommand {
    Plan(paint::PlanArgs),
    Simulate(paint::SimulateArgs),
    Check(check::CheckArgs),
    Export(export::ExportArgs),
    Fit(fit::FitArgs),
}

pub(super) fn run(args: &PathArgs, console: &mut Console) -> anyhow::Result<Outcome> {
    match &args.command {
        PathCommand::Plan(plan) => paint::run_plan(&args.library, plan, console),
        PathCommand::Simulate(simulate) => paint::run_simulate(&args.library, simulate, console),
        PathCommand::Check(check) => check::run(&args.library, check, console),
        PathCommand::Export(export) => export::run(&args.library, export, console),
        PathCommand::Fit(fit) => fit::run(fit, console),
    }
}

/// Returns the stored path of a part, which must have one.
fn stored_path(place: &LibraryPlace, name: &PartName) -> anyhow::Result<SprayPath> {
    let stored = place.spray_path(name.as_str()).advised()?;
    stored.ok_or_else(|| no_path(name.as_str()))
}

/// The error of what needs the path of a part that has none.
pub(super) fn no_path(part: &str) -> anyhow::Error {
    advised_error(format!("{part} has no spray path"), store_a_path(part))
}
