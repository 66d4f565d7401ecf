//! The command line: one file a subcommand.
//!
//! What was asked for goes to standard output, everything else to standard error. The exit code is part of the
//! interface: see [`Outcome`].

mod align;
mod bench;
mod console;
mod enrol;
mod first_look;
mod input;
mod inspect;
mod library;
mod report_folder;
mod simulate;
mod verdict;

use std::{path::PathBuf, process::ExitCode};

use anyhow::bail;
use clap::{Args, Parser, Subcommand, ValueEnum};

use self::console::{Advised as _, Console};
use crate::{
    app,
    library::{LibraryLoad, LibraryPlace, open_library},
    stages::{pose::PoseMethod, reference::ReferenceParams},
};

/// Recognises car body parts in depth-camera point clouds and says where they are.
#[derive(Debug, Parser)]
#[command(
    version,
    after_help = "\
Without a command: opens the window. Without a display: inspects one frame of a simulated cell in the terminal.

Examples:
  partsight simulate --part fender --out fender.pcd
  partsight inspect fender.pcd
  partsight inspect captures/*.pcd --json > verdicts.jsonl
  partsight enrol door.pcd --name front_door

Exit codes: 0 every input accepted, 1 something was not accepted, 2 could not run."
)]
pub struct Cli {
    #[command(subcommand)]
    command: Option<Command>,
}

#[derive(Debug, Subcommand)]
enum Command {
    Inspect(inspect::InspectArgs),
    Enrol(enrol::EnrolArgs),
    Library(library::LibraryArgs),
    Align(align::AlignArgs),
    Simulate(simulate::SimulateArgs),
    Bench(bench::BenchArgs),
}

/// What a call came to; its exit code.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Outcome {
    /// 0: every input was accepted.
    Accepted,
    /// 1: it ran, but something was not accepted.
    NotAccepted,
    /// 2: it, or one of its inputs, could not run.
    CouldNotRun,
}

impl From<Outcome> for ExitCode {
    fn from(outcome: Outcome) -> Self {
        match outcome {
            Outcome::Accepted => Self::SUCCESS,
            Outcome::NotAccepted => Self::from(1),
            Outcome::CouldNotRun => Self::from(2),
        }
    }
}

/// Runs the command, and shows an error with its advice.
pub fn run(cli: Cli) -> Outcome {
    let mut console = Console::new();
    let ran = match cli.command {
        None => window(&mut console),
        Some(Command::Inspect(args)) => inspect::run(&args, &mut console),
        Some(Command::Enrol(args)) => enrol::run(&args, &mut console),
        Some(Command::Library(args)) => library::run(&args, &mut console),
        Some(Command::Align(args)) => align::run(&args, &mut console),
        Some(Command::Simulate(args)) => simulate::run(&args, &mut console),
        Some(Command::Bench(args)) => bench::run(&args, &mut console),
    };
    let outcome = ran.unwrap_or_else(|error| {
        console.error(&error);
        Outcome::CouldNotRun
    });
    match console.finish() {
        Ok(()) => outcome,
        Err(error) => {
            console.error(&anyhow::Error::new(error).context("the output could not be written"));
            Outcome::CouldNotRun
        }
    }
}

/// Opens the window; where there can be none, says why and takes the first look in the terminal instead.
fn window(console: &mut Console) -> anyhow::Result<Outcome> {
    match app::run(None) {
        Ok(()) => Ok(Outcome::Accepted),
        Err(error) => {
            console.warn(&format_args!("no window: {error}"), &error);
            first_look::run(console)
        }
    }
}

/// Which library.
#[derive(Debug, Args)]
struct LibraryChoice {
    /// The library's folder; without it `reference_parts` in the working directory, else your own
    #[arg(long, value_name = "DIR", global = true)]
    library: Option<PathBuf>,
}

impl LibraryChoice {
    fn open(&self) -> anyhow::Result<LibraryPlace> {
        open_library(self.library.as_deref()).advised()
    }

    /// Loads the library and names what had to be set aside.
    fn load(&self, console: &mut Console) -> anyhow::Result<(LibraryPlace, LibraryLoad)> {
        let place = self.open()?;
        let load = place.folder().load(&ReferenceParams::default()).advised()?;
        for problem in &load.problems {
            console.warn(&format_args!("set aside {problem}"), problem);
        }
        for warning in &load.warnings {
            console.warn(warning, warning);
        }
        Ok((place, load))
    }

    /// As [`Self::load`]; a library without parts is an error.
    fn load_some(&self, console: &mut Console) -> anyhow::Result<LibraryLoad> {
        let (place, load) = self.load(console)?;
        if load.parts.is_empty() {
            bail!(
                "the library {} has no part to recognise; enrol one with `partsight enrol FILE --name NAME`",
                place.folder().path().display()
            );
        }
        Ok(load)
    }
}

/// A method of `align`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum MethodChoice {
    /// From any start: many are tried, the best is refined
    Global,
    /// The paper's iterative closest point, from one start
    Icp,
}

impl From<MethodChoice> for PoseMethod {
    fn from(choice: MethodChoice) -> Self {
        match choice {
            MethodChoice::Global => Self::Global,
            MethodChoice::Icp => Self::Icp,
        }
    }
}
