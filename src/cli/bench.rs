//! `partsight bench`: measures recognition rate, pose error and speed on simulated frames.

mod bounds;
mod calibration;
mod confusions;
mod history;
#[cfg(feature = "window")]
mod live;
mod paint;
mod recognition;
mod registration;
mod scaling;
mod serve;
mod servo;
mod soak;
mod speed;
mod systems;
mod table1;
#[cfg(feature = "window")]
mod window;

use std::{
    collections::BTreeMap,
    path::{Path, PathBuf},
};

use anyhow::Context as _;
use clap::{Args, ValueEnum};
use serde::Serialize;

use super::{
    LibraryChoice, Outcome,
    console::{Console, advised_error},
    recipe::RecipeSource,
};
use bench::registration::Condition;
use stages::rank::Matcher;

/// Measure recognition, pose and speed on simulated frames with known truth
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  partsight bench
  partsight bench speed --suite all --json before.json
  partsight bench speed --suite all --compare before.json
  partsight bench speed --files frames/*.png
  partsight bench recognition --json recognition.json
  partsight bench recognition --suite placed --poses 50
  partsight bench recognition --only-ours --set accept.min_score=0.95
  partsight bench recognition --suite rack --poses 50 --only-ours
  partsight bench recognition --suite hard --poses 20 --seed 3000000 --only-ours --pictures why/
  partsight bench calibration
  partsight bench table1 --csv table1.csv
  partsight bench table1 --part fender --part grille
  partsight bench registration --poses 125
  partsight bench registration --condition resampled --condition outside --mesh car.gltf#Door_FL
  partsight bench bounds --poses 10
  partsight bench bounds --mesh car.gltf#Door_FL --mesh car.gltf#Trunk_Lid
  partsight bench scaling --plot scaling.png
  partsight bench window
  partsight bench live --minutes 10
  partsight bench history
  partsight bench paint --plots films
  partsight bench paint --coat primer
  partsight bench serve --json serve.json
  partsight bench servo --runs 200 --json servo.json
  partsight bench soak --frames 1000000 --plot soak.png

Each part is enrolled from one frontal capture of the standard car, then seen in sets of simulated frames. Without a
name: a few frames of each part, to time the stages. table1 needs no frames: each part of the library is put where T1..T5
of the paper put it, and found again by ICP, ICP-GA and the global method. Times are those of this machine under its
present load.")]
pub(super) struct BenchArgs {
    /// What to measure
    #[arg(value_enum, default_value_t = Bench::Speed)]
    bench: Bench,
    /// Poses of each part, or of what else hangs there; or racks of each kind
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=10_000))]
    poses: Option<u64>,
    /// For servo: runs to camera poses; half as many more are disturbed, and an eighth as many go to the start of a path
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=10_000))]
    runs: Option<u64>,
    /// Seed of the first frame. Parameters are chosen on frames from 3000000 on, and measured on those from 9000000 on
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=1_000_000_000))]
    seed: Option<u64>,
    /// For recognition and speed: these sets of frames; may be given several times
    #[arg(long, value_enum, value_name = "NAME")]
    suite: Vec<recognition::SuiteChoice>,
    /// For speed: inspect these scenes with the library instead of simulated frames. For paint: enrol a part from each and paint it too
    #[arg(long, value_name = "FILE", num_args = 1.., conflicts_with_all = ["suite", "poses", "seed"])]
    files: Vec<PathBuf>,
    /// For speed: show how many times as long each set took as in this file, which --json wrote
    #[arg(long, value_name = "JSON")]
    compare: Option<PathBuf>,
    /// For recognition: leave out the other systems of the paper's Table I, which take most of the time
    #[arg(long)]
    only_ours: bool,
    /// For recognition: draw into this folder what went wrong, the first of each subject, and of each part the frame in which another came nearest
    #[arg(long, value_name = "DIR")]
    pictures: Option<PathBuf>,
    /// Write every case to this file as JSON
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// For table1: write every attempt to this file as comma-separated values
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
    /// For bounds and registration: take this mesh instead of the simulated parts, with its outside towards the camera; may be given several times
    #[arg(long, value_name = "FILE#NAME")]
    mesh: Vec<PathBuf>,
    /// For registration: only sources of this kind; may be given several times
    #[arg(long, value_enum, value_name = "NAME")]
    condition: Vec<Condition>,
    /// For scaling and soak: draw the figures into this file
    #[arg(long, value_name = "PNG")]
    plot: Option<PathBuf>,
    /// For scaling: maximum number of references; ten thousand take less than 3 GB
    #[arg(long, value_name = "N", default_value_t = bench::scaling::MOST as u64, value_parser = clap::value_parser!(u64).range(8..=100_000))]
    most: u64,
    /// For paint: the coat, by name or file, instead of the default one
    #[arg(long, value_name = "NAME|FILE")]
    coat: Option<String>,
    /// For paint: draw the film of each part into this folder
    #[arg(long, value_name = "DIR")]
    plots: Option<PathBuf>,
    /// For live: duration in minutes
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u64).range(1..=1440))]
    minutes: u64,
    /// For soak: number of frames, at least 100000, so that every part hangs there and the history's cache fills in the first fifth, the warm-up. A library with few parts makes it quicker
    #[arg(long, value_name = "N", default_value_t = 100_000, value_parser = clap::value_parser!(u64).range(100_000..=1_000_000_000))]
    frames: u64,
    /// For table1: only this part; may be given several times
    #[arg(long, value_name = "NAME")]
    part: Vec<String>,
    #[command(flatten)]
    recipe: RecipeSource,
    #[command(flatten)]
    library: LibraryChoice,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Bench {
    /// The time of each stage beside its budget
    Speed,
    /// Right, accepted and well placed, and the left half of the paper's Table I: time and right answers of the paper's matcher, FPFH, SHOT, spin images and VFH on the same frames
    Recognition,
    /// Fits the score to simulated frames, and says what each piece of evidence is worth
    Calibration,
    /// The right half of that table: what is left of E from T1..T5, by ICP, ICP-GA and the global method
    Table1,
    /// Poses of clouds that share no point: whole, single views, hidden, noisy, with stray points, sampled otherwise, and what the genetic algorithm adds
    Registration,
    /// Whether poses are as exact as their bounds say: whole and cut views of parts of other car models, enrolled themselves, or of meshes
    Bounds,
    /// Panels from 0.5 to 30 mm, enrolled as closed solids, inside out, as open surfaces and as clouds: found and placed alike?
    Sheets,
    /// Ranking by 1, 2, 4 and 8 workers over a growing number of references: from how many on do several pay off?
    Scaling,
    #[cfg(feature = "window")]
    /// Processor time of a frame of the window, at rest, turning and live; needs no display
    Window,
    #[cfg(feature = "window")]
    /// The simulated line followed for minutes: rate, latency, the window's thread, memory; needs no display
    Live,
    /// A history of 100 000 inspections: how long a page of any filter takes, and writing one more
    History,
    /// Spray paths planned over each part, beside plain ones with the same gun: film, time and paint, the part hung elsewhere, and what an error of its pose costs
    Paint,
    /// The server that robots ask, on this computer: status requests of each protocol beside bare exchanges of as many bytes over TCP, and triggers beside the same inspections called directly
    Serve,
    /// Simulated runs of visual servoing: where they end, how long they take, why they stop, and whether limits are kept
    Servo,
    /// Small frames, one after the other, through all that inspect --source does: latency, memory, threads and open files; exit code 1 if the memory grows by more than 2 % after the warm-up
    Soak,
}

/// Default number of poses per part.
const NUM_POSES: u64 = 25;

pub(super) fn run(args: &BenchArgs, console: &mut Console) -> anyhow::Result<Outcome> {
    check(args)?;
    match args.bench {
        Bench::Speed => speed::run(args, console),
        Bench::Recognition => recognition::run(args, console),
        Bench::Calibration => calibration::run(args, console),
        Bench::Table1 => table1::run(args, console),
        Bench::Registration => registration::run(args, console),
        Bench::Bounds => bounds::run(args, console),
        Bench::Sheets => bounds::run_sheets(args, console),
        Bench::Scaling => scaling::run(args, console),
        #[cfg(feature = "window")]
        Bench::Window => window::run(args, console),
        #[cfg(feature = "window")]
        Bench::Live => live::run(args, console),
        Bench::History => history::run(args, console),
        Bench::Paint => paint::run(args, console),
        Bench::Serve => serve::run(args, console),
        Bench::Servo => servo::run(args, console),
        Bench::Soak => soak::run(args, console),
    }
}

/// Refuses options that the chosen experiment would ignore.
fn check(args: &BenchArgs) -> anyhow::Result<()> {
    let bench = args.bench;
    if bench != Bench::Table1 && (args.csv.is_some() || !args.part.is_empty()) {
        return Err(advised_error(
            "--csv and --part are for table1",
            "Use it like this: partsight bench table1 --csv FILE",
        ));
    }
    if bench != Bench::Servo && args.runs.is_some() {
        return Err(advised_error(
            "--runs is for servo",
            "Use it like this: partsight bench servo --runs N",
        ));
    }
    if !args.suite.is_empty() && !matches!(bench, Bench::Recognition | Bench::Speed) {
        return Err(advised_error(
            "--suite is for recognition and speed",
            "Use it like this: partsight bench recognition --suite all",
        ));
    }
    if !args.mesh.is_empty() && !matches!(bench, Bench::Bounds | Bench::Registration) {
        return Err(advised_error(
            "--mesh is for bounds and registration",
            "Use it like this: partsight bench bounds --mesh FILE#NAME",
        ));
    }
    if !matches!(bench, Bench::Scaling | Bench::Soak) && args.plot.is_some() {
        return Err(advised_error(
            "--plot is for scaling and soak",
            "Use it like this: partsight bench soak --plot PNG",
        ));
    }
    if bench != Bench::Paint && args.plots.is_some() {
        return Err(advised_error(
            "--plots is for paint",
            "Use it like this: partsight bench paint --plots DIR",
        ));
    }
    let takes_files = matches!(bench, Bench::Speed | Bench::Paint);
    if (bench != Bench::Speed && args.compare.is_some()) || (!takes_files && !args.files.is_empty())
    {
        return Err(advised_error(
            "--compare is for speed, --files for speed and paint",
            "Use it like this: partsight bench speed --files FILE --compare before.json",
        ));
    }
    if bench != Bench::Registration && !args.condition.is_empty() {
        return Err(advised_error(
            "--condition is for registration",
            "Use it like this: partsight bench registration --condition outside",
        ));
    }
    if bench != Bench::Recognition && args.recipe.is_given() {
        return Err(advised_error(
            "--recipe and --set are for recognition",
            "Use it like this: partsight bench recognition --set NAME=VALUE",
        ));
    }
    if bench != Bench::Recognition && (args.only_ours || args.pictures.is_some()) {
        return Err(advised_error(
            "--only-ours and --pictures are for recognition",
            "Use it like this: partsight bench recognition --pictures DIR",
        ));
    }
    Ok(())
}

fn write_json(path: &Path, file: &impl Serialize) -> anyhow::Result<()> {
    super::write_json(path, file).with_context(|| format!("{} was not written", path.display()))
}

/// Writes results on simulated parts to a file, under this name.
fn write_results(path: &Path, name: &str, results: &impl Serialize) -> anyhow::Result<()> {
    #[derive(Serialize)]
    struct ResultsFile<'a, T> {
        schema: u32,
        simulated: bool,
        #[serde(flatten)]
        results: BTreeMap<&'a str, &'a T>,
    }
    let file = ResultsFile {
        schema: 1,
        simulated: true,
        results: BTreeMap::from([(name, results)]),
    };
    write_json(path, &file)
}

fn name_of(matcher: Matcher) -> &'static str {
    match matcher {
        Matcher::Default => "default",
        Matcher::Paper => "paper's",
    }
}
