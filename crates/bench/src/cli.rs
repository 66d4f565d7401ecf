//! The command line of `partsight-bench`, one file per experiment.

mod bounds;
mod calibration;
mod confusions;
mod history;
mod line;
mod live;
mod paint;
mod recognition;
mod registration;
mod scaling;
mod serve;
mod servo;
mod soak;
mod speed;
mod surface;
mod systems;
mod table1;
mod window;

use std::{
    collections::BTreeMap,
    path::{Path, PathBuf},
};

use anyhow::Context as _;
use clap::{Args, Parser, Subcommand};
use serde::Serialize;

use partsight::cli::{self, Outcome, console::Console, run_command};
use stages::rank::Matcher;

/// Measures recognition, pose and speed on simulated frames with known truth.
#[derive(Debug, Parser)]
#[command(
    name = "partsight-bench",
    version,
    after_help = "\
Examples:
  partsight-bench
  partsight-bench speed --suite all --json before.json
  partsight-bench speed --suite all --compare before.json
  partsight-bench speed --files frames/*.png
  partsight-bench recognition --json recognition.json
  partsight-bench recognition --suite placed --poses 50
  partsight-bench recognition --only-ours --set accept.min_score=0.95
  partsight-bench recognition --suite rack --poses 50 --only-ours
  partsight-bench recognition --suite hard --poses 20 --seed 3000000 --only-ours --pictures why/
  partsight-bench calibration
  partsight-bench table1 --csv table1.csv
  partsight-bench table1 --part fender --part grille
  partsight-bench registration --poses 125
  partsight-bench registration --condition resampled --condition outside --mesh car.gltf#Door_FL
  partsight-bench bounds --poses 10
  partsight-bench bounds --mesh car.gltf#Door_FL --mesh car.gltf#Trunk_Lid
  partsight-bench scaling --plot scaling.png
  partsight-bench window
  partsight-bench live --minutes 10
  partsight-bench history
  partsight-bench paint --plots films
  partsight-bench paint --coat primer
  partsight-bench serve --json serve.json
  partsight-bench servo --runs 200 --json servo.json
  partsight-bench servo --runs 500 --first 500 --reference fender.png --reference door.png --json second.json
  partsight-bench servo --read first.json second.json
  partsight-bench line --runs 50 --json line.json
  partsight-bench surface --average 8 --json surface.json
  partsight-bench soak --frames 1000000 --plot soak.png

Each part is enrolled from one frontal capture of the standard car, then seen in sets of simulated frames. Without a
name: a few frames of each part, to time the stages. table1 needs no frames: each part of the library is put where T1..T5
of the paper put it, and found again by ICP, ICP-GA and the global method. Times are those of this machine under its
present load."
)]
#[command(args_conflicts_with_subcommands = true)]
pub struct Cli {
    #[command(subcommand)]
    experiment: Option<Experiment>,
    #[command(flatten)]
    speed: speed::SpeedArgs,
}

/// The file of an experiment.
#[derive(Debug, Args)]
struct JsonFile {
    /// Write every case to this file as JSON
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
}

/// The frames of an experiment, and its file.
#[derive(Debug, Args)]
struct FrameChoice {
    /// Poses of each part, or of what else hangs there; or racks of each kind
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=10_000))]
    poses: Option<u64>,
    /// Seed of the first frame. Parameters are chosen on frames from 3000000 on, and measured on those from 9000000 on
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=1_000_000_000))]
    seed: Option<u64>,
    #[command(flatten)]
    file: JsonFile,
}

#[derive(Debug, Subcommand)]
enum Experiment {
    /// The time of each stage beside its budget
    Speed(speed::SpeedArgs),
    /// Right, accepted and well placed, and the left half of the paper's Table I: time and right answers of the paper's matcher, FPFH, SHOT, spin images and VFH on the same frames
    Recognition(recognition::RecognitionArgs),
    /// Fits the score to simulated frames, and says what each piece of evidence is worth
    Calibration(FrameChoice),
    /// The right half of that table: what is left of E from T1..T5, by ICP, ICP-GA and the global method
    Table1(table1::Table1Args),
    /// Poses of clouds that share no point: whole, single views, hidden, noisy, with stray points, sampled otherwise, and what the genetic algorithm adds
    Registration(registration::RegistrationArgs),
    /// Whether poses are as exact as their bounds say: whole and cut views of parts of other car models, enrolled themselves, or of meshes
    Bounds(bounds::BoundsArgs),
    /// Panels from 0.5 to 30 mm, enrolled as closed solids, inside out, as open surfaces and as clouds: found and placed alike?
    Sheets(FrameChoice),
    /// Ranking by 1, 2, 4 and 8 workers over a growing number of references: from how many on do several pay off?
    Scaling(scaling::ScalingArgs),
    /// Processor time of a frame of the window, at rest, turning and live; needs no display
    Window(JsonFile),
    /// The simulated line followed for minutes: rate, latency, the window's thread, memory; needs no display
    Live(live::LiveArgs),
    /// A history of 100 000 inspections: how long a page of any filter takes, and writing one more
    History(JsonFile),
    /// Spray paths planned over each part, beside plain ones with the same gun: film, time and paint, the part hung elsewhere, and what an error of its pose costs
    Paint(paint::PaintArgs),
    /// The server that robots ask, on this computer: status requests of each protocol beside bare exchanges of as many bytes over TCP, and triggers beside the same inspections called directly
    Serve(FrameChoice),
    /// Simulated runs of visual servoing: where they end, how long they take, why they stop, and whether limits are kept; exit code 1 if one was not
    Servo(servo::ServoArgs),
    /// Simulated lines whose parts pass the camera: whether each is found once and in time, and the errors of poses at later counts
    Line(line::LineArgs),
    /// Dents pressed into parts: which are found by their surface, averaged over several frames, and what is found on good parts
    Surface(surface::SurfaceArgs),
    /// Small frames, one after the other, through all that inspect --source does: latency, memory, threads and open files; exit code 1 if the memory grows by more than 2 % after the warm-up
    Soak(soak::SoakArgs),
}

/// Default number of poses per part.
const NUM_POSES: u64 = 25;

/// Runs the experiment; without a name: times the stages.
pub fn run(cli: &Cli) -> Outcome {
    run_command(|console| match &cli.experiment {
        None => speed::run(&cli.speed, console),
        Some(experiment) => experiment.run(console),
    })
}

impl Experiment {
    fn run(&self, console: &mut Console) -> anyhow::Result<Outcome> {
        match self {
            Self::Speed(args) => speed::run(args, console),
            Self::Recognition(args) => recognition::run(args, console),
            Self::Calibration(args) => calibration::run(args, console),
            Self::Table1(args) => table1::run(args, console),
            Self::Registration(args) => registration::run(args, console),
            Self::Bounds(args) => bounds::run(args, console),
            Self::Sheets(args) => bounds::run_sheets(args, console),
            Self::Scaling(args) => scaling::run(args, console),
            Self::Window(args) => window::run(args, console),
            Self::Live(args) => live::run(args, console),
            Self::History(args) => history::run(args, console),
            Self::Paint(args) => paint::run(args, console),
            Self::Serve(args) => serve::run(args, console),
            Self::Servo(args) => servo::run(args, console),
            Self::Line(args) => line::run(args, console),
            Self::Surface(args) => surface::run(args, console),
            Self::Soak(args) => soak::run(args, console),
        }
    }
}

/// Writes results to a file.
fn write_json(path: &Path, file: &impl Serialize) -> anyhow::Result<()> {
    cli::write_json(path, file).with_context(|| format!("{} was not written", path.display()))
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
