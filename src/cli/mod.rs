//! The command line, one file per subcommand.
//!
//! Results go to standard output, everything else to standard error. The exit code is part of the interface: see
//! [`Outcome`]. `partsight-bench` uses what is public here.

mod align;
mod calibrate;
mod capture;
mod cell;
pub mod console;
mod enrol;
mod evaluate;
mod expect;
mod first_look;
mod follow;
mod history;
pub mod input;
mod inspect;
mod interrupt;
mod library;
mod numbers;
mod output;
mod path;
mod plant;
mod program;
mod rack;
pub mod recipe;
mod recipes;
mod record;
mod report;
mod robot_file;
mod scan;
mod serve;
mod servo;
mod servo_choice;
mod simulate;
mod surface;
mod trace;
mod verdict;

use std::{
    panic::resume_unwind,
    path::{Path, PathBuf},
    process::ExitCode,
    thread,
};

use clap::{Args, Parser, Subcommand};
use serde::Serialize;

use self::console::{Advised as _, Console, advised_error};
#[cfg(feature = "window")]
use app;
use files::write_atomically;
use inspection::library::{
    LibraryFolder, LibraryLoad, LibraryPlace, PartName, StoredPart, open_library,
};
use stages::reference::ReferenceParams;

/// Recognises car body parts in depth-camera point clouds and says where they are.
#[derive(Debug, Parser)]
#[command(
    version,
    after_help = "\
Without a command: opens the window. Without a display: inspects one frame of a simulated cell in the terminal.

Examples:
  partsight simulate --part fender --out fender.pcd
  partsight inspect fender.pcd
  partsight inspect --source simulated
  partsight --open fender.pcd
  partsight inspect captures/*.pcd --json > verdicts.jsonl
  partsight enrol door.pcd --name front_door

Exit codes: 0 every input accepted, 1 something was not accepted, 2 could not run."
)]
pub struct Cli {
    #[command(subcommand)]
    command: Option<Command>,
    /// Without a command: folder of the library; default: your own, which starts with the shipped parts
    // Named apart from the commands' own: that one is global to them, and would come up here.
    #[arg(id = "bare_library", long = "library", value_name = "DIR")]
    library: Option<PathBuf>,
    /// Without a command: open this captured scene, or the scan in this folder, in the window
    #[arg(long, value_name = "FILE")]
    open: Option<PathBuf>,
}

#[derive(Debug, Subcommand)]
#[allow(
    clippy::large_enum_variant,
    reason = "there is one, made of the arguments; with the feature plant the variants are alike"
)]
enum Command {
    Inspect(inspect::InspectArgs),
    Report(report::ReportArgs),
    Capture(capture::CaptureArgs),
    Scan(scan::ScanArgs),
    Enrol(enrol::EnrolArgs),
    Library(library::LibraryArgs),
    Path(path::PathArgs),
    Recipe(recipes::RecipeArgs),
    Align(align::AlignArgs),
    Calibrate(calibrate::CalibrateArgs),
    Cell(cell::CellArgs),
    Rack(rack::RackArgs),
    Serve(serve::ServeArgs),
    Servo(servo::ServoArgs),
    Simulate(simulate::SimulateArgs),
    Evaluate(evaluate::EvaluateArgs),
    History(history::HistoryArgs),
}

/// Result of a call, and its exit code.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Outcome {
    /// 0: every input was accepted.
    Accepted,
    /// 1: the call ran, but something was not accepted.
    NotAccepted,
    /// 2: the call, or one of its inputs, could not run.
    CouldNotRun,
}

impl Outcome {
    /// Returns the outcome of a call that ran.
    pub fn accepted_if(is_accepted: bool) -> Self {
        if is_accepted {
            Self::Accepted
        } else {
            Self::NotAccepted
        }
    }
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

/// Runs the command, or opens the window.
pub fn run(cli: Cli) -> Outcome {
    let Cli {
        command,
        library,
        open,
    } = cli;
    match command {
        None => answered(|console| window(&LibraryChoice { library }, open, console)),
        Some(_) if library.is_some() => answered(|_| {
            Err(advised_error(
                "--library must come after the command",
                "Put it after the command, for example partsight inspect FILE --library DIR",
            ))
        }),
        Some(_) if open.is_some() => answered(|_| {
            Err(advised_error(
                "--open is for the window, not for a command",
                "Leave the command out to open the window, or --open to run the command",
            ))
        }),
        Some(command) => run_command(|console| command.run(console)),
    }
}

impl Command {
    fn run(self, console: &mut Console) -> anyhow::Result<Outcome> {
        match self {
            Self::Inspect(args) => inspect::run(args, console),
            Self::Report(args) => report::run(&args, console),
            Self::Capture(args) => capture::run(&args, console),
            Self::Scan(args) => scan::run(&args, console),
            Self::Enrol(args) => enrol::run(args, console),
            Self::Library(args) => library::run(&args, console),
            Self::Path(args) => path::run(&args, console),
            Self::Recipe(args) => recipes::run(&args, console),
            Self::Align(args) => align::run(&args, console),
            Self::Calibrate(args) => calibrate::run(&args, console),
            Self::Cell(args) => cell::run(&args, console),
            Self::Rack(args) => rack::run(&args, console),
            Self::Serve(args) => serve::run(&args, console),
            Self::Servo(args) => servo::run(&args, console),
            Self::Simulate(args) => simulate::run(&args, console),
            Self::Evaluate(args) => evaluate::run(&args, console),
            Self::History(args) => history::run(&args, console),
        }
    }
}

/// Runs a command; shows that it works, if it takes long, and an error with its advice.
pub fn run_command(
    command: impl FnOnce(&mut Console) -> anyhow::Result<Outcome> + Send,
) -> Outcome {
    let work = || {
        answered(|console| {
            console.start_waiting();
            command(console)
        })
    };
    // MinGW's mathematical functions compute with the x87, and Windows gives the first thread another precision than all
    // others: a command that shared its work among several would depend on which of them did what. The window computes
    // nothing on the first thread, and its event loop needs it.
    if cfg!(all(windows, target_env = "gnu")) {
        let ended = thread::scope(|scope| scope.spawn(work).join());
        return ended.unwrap_or_else(|panic| resume_unwind(panic));
    }
    work()
}

/// Shows an error with its advice.
fn answered(work: impl FnOnce(&mut Console) -> anyhow::Result<Outcome>) -> Outcome {
    let mut console = Console::new();
    let outcome = work(&mut console).unwrap_or_else(|error| {
        console.error(&error);
        Outcome::CouldNotRun
    });
    if console.finish() {
        outcome
    } else {
        Outcome::CouldNotRun
    }
}

/// Returns advice for opening a scene, or the folder of a scan, without a window.
fn in_the_terminal(path: &Path) -> String {
    let option = if path.is_dir() { "--scan " } else { "" };
    format!(
        "Inspect it in the terminal: partsight inspect {option}{}",
        path.display()
    )
}

/// Runs the first look in the terminal, since this build has no window.
#[cfg(not(feature = "window"))]
fn window(
    library: &LibraryChoice,
    scene: Option<PathBuf>,
    console: &mut Console,
) -> anyhow::Result<Outcome> {
    match scene {
        Some(file) => Err(advised_error(
            "this build has no window",
            in_the_terminal(&file),
        )),
        None => first_look::run(library, console),
    }
}

/// Opens the window; if that fails, warns and runs the first look in the terminal instead.
#[cfg(feature = "window")]
fn window(
    library: &LibraryChoice,
    scene: Option<PathBuf>,
    console: &mut Console,
) -> anyhow::Result<Outcome> {
    let opened = scene.clone();
    let options = app::WindowOptions {
        library: library.library.clone(),
        settings: shell::settings::users_file(),
        // Without such a folder the window keeps the history in memory.
        history: records::history::users_folder().ok(),
        recipes: inspection::pipeline::RecipeFolder::of_user()
            .ok()
            .map(|folder| folder.path().to_owned()),
        cell: robot::calibration::default_path().ok(),
        cell_checks: robot::cell_check::CellCheckFolder::of_user()
            .ok()
            .map(|folder| folder.path().to_owned()),
        scene,
        taken_version: Some(plant::version_of),
        ..app::WindowOptions::default()
    };
    match (app::run(options), opened) {
        (Ok(()), _) => Ok(Outcome::Accepted),
        (Err(error), Some(file)) => Err(advised_error(
            format!("no window to open {} in: {error}", file.display()),
            in_the_terminal(&file),
        )),
        (Err(error), None) => {
            console.warn(&format_args!("no window: {error}"), &error);
            first_look::run(library, console)
        }
    }
}

/// Which library.
#[derive(Debug, Args)]
pub struct LibraryChoice {
    /// Folder of the library; default: your own, which starts with the shipped parts
    #[arg(long, value_name = "DIR", global = true)]
    library: Option<PathBuf>,
}

impl LibraryChoice {
    /// Opens the library; warns if only the parts inside the program are available.
    fn open(&self, console: &Console) -> anyhow::Result<LibraryPlace> {
        let place = open_library(self.library.as_deref()).advised()?;
        if let LibraryPlace::Program(reason) = &place {
            console.warn(
                &format_args!("{reason}; the shipped parts inside the program are used"),
                reason,
            );
        }
        Ok(place)
    }

    /// Opens the library for changes.
    fn open_to_change(&self) -> anyhow::Result<LibraryFolder> {
        open_library(self.library.as_deref())
            .and_then(LibraryPlace::into_folder)
            .advised()
    }

    /// As [`Self::open_to_change`]; a named folder is created if it is missing.
    fn open_or_create(&self) -> anyhow::Result<LibraryFolder> {
        match &self.library {
            Some(path) => LibraryFolder::open_or_create(path).advised(),
            None => self.open_to_change(),
        }
    }

    /// Loads the library, prepared with these parameters; warns of the parts that could not be loaded.
    fn load(
        &self,
        params: &ReferenceParams,
        console: &mut Console,
    ) -> anyhow::Result<(LibraryPlace, LibraryLoad)> {
        let place = self.open(console)?;
        let load = place.load(params).advised()?;
        for problem in &load.problems {
            console.warn(&format_args!("set aside {problem}"), problem);
        }
        for warning in &load.warnings {
            console.warn(warning, warning);
        }
        Ok((place, load))
    }

    /// Loads the library; one without parts is an error.
    pub fn load_some(
        &self,
        params: &ReferenceParams,
        console: &mut Console,
    ) -> anyhow::Result<LibraryLoad> {
        self.load_placed(params, console).map(|(_, load)| load)
    }

    /// As [`Self::load`], but a library without parts is an error.
    fn load_placed(
        &self,
        params: &ReferenceParams,
        console: &mut Console,
    ) -> anyhow::Result<(LibraryPlace, LibraryLoad)> {
        let (place, load) = self.load(params, console)?;
        if load.parts.is_empty() {
            let advice = place
                .folder()
                .and_then(hint)
                .unwrap_or_else(|| "Enrol a part: partsight enrol FILE --name NAME".into());
            return Err(advised_error(
                format!("the library {} has no part to recognise", place.location()),
                advice,
            ));
        }
        Ok((place, load))
    }
}

fn read_part(place: &LibraryPlace, name: &PartName) -> anyhow::Result<StoredPart> {
    let part = place.read(name.as_str(), &ReferenceParams::default());
    part.advised()?.advised()
}

/// Writes a file of indented JSON.
pub fn write_json(path: &Path, content: &impl Serialize) -> anyhow::Result<()> {
    write_atomically(path, |writer| {
        serde_json::to_writer_pretty(&mut *writer, content)?;
        writeln!(writer)
    })
    .advised()
}

/// Returns advice on a folder without parts, if it looks like the wrong one.
fn hint(folder: &LibraryFolder) -> Option<String> {
    let meant = folder.probably_meant()?;
    let meant = meant.display();
    Some(if folder.is_itself_a_part() {
        let path = folder.path().display();
        format!("{path} is a part, not a library: give the folder that holds it, --library {meant}")
    } else {
        format!("Give the folder that holds the parts: --library {meant}")
    })
}
