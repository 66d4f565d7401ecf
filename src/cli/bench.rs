//! `partsight bench`: how often right, how far off, how long, on simulated frames.

mod calibration;
mod live;
mod registration;
mod scaling;
mod suites;
mod systems;
mod table1;

use std::path::{Path, PathBuf};

use anyhow::Context as _;
use clap::{Args, ValueEnum};
use serde::Serialize;

use super::{
    LibraryChoice, Outcome,
    console::{Advised as _, Console, Table, advised_error},
};
use crate::{
    app::WindowOptions,
    bench::{
        Recognition, RecognitionSetup, StageTimes, WindowCost, enrol_standard_parts, recognise_all,
        stage_times, window_cost,
    },
    files::write_atomically,
    library::EnrolParams,
    pipeline::{Recipe, Timings, Unwatched},
    simulate::Placement,
    stages::rank::Matcher,
};

/// Measure recognition, pose and speed on simulated frames with known truth
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  partsight bench
  partsight bench recognition --poses 50 --model 3
  partsight bench recognition --suite all --json suites.json
  partsight bench recognition --suite hard --poses 20 --seed 3000000 --pictures why/
  partsight bench calibration
  partsight bench table1 --csv table1.csv
  partsight bench table1 --part fender --part grille
  partsight bench registration --poses 125
  partsight bench systems --placement hard
  partsight bench scaling --plot scaling.png
  partsight bench window
  partsight bench live --minutes 10

Each part is enrolled from one frontal capture of the standard car, then seen at drawn poses. Without a name: a few
frames of each part, to time the stages. table1 needs no frames: each part of the library is put where T1..T5 of the
paper put it, and found again by ICP, ICP-GA and the global method. Times are those of this machine, at what else it is doing now.")]
pub(super) struct BenchArgs {
    /// What to measure
    #[arg(value_enum, default_value_t = Bench::Speed)]
    bench: Bench,
    /// Poses of each part
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=10_000))]
    poses: Option<u64>,
    /// Seed of the first frame. Parameters are chosen on frames from 3000000 on, and measured on those from 9000000 on
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=1_000_000_000))]
    seed: Option<u64>,
    /// Model of the car that is seen; the enrolled one is 0
    #[arg(long, default_value_t = 0)]
    model: u64,
    /// How far from square-on the poses are drawn
    #[arg(long, value_enum, default_value_t = super::simulate::PlacementChoice::Placed)]
    placement: super::simulate::PlacementChoice,
    /// Of recognition: these sets of frames instead; may be given several times
    #[arg(long, value_enum, value_name = "NAME")]
    suite: Vec<suites::SuiteChoice>,
    /// Of the sets of frames: draw the stages of what went wrong into this folder, the first of each subject
    #[arg(long, value_name = "DIR", requires = "suite")]
    pictures: Option<PathBuf>,
    /// Write every case to this file as JSON
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Of table1: write every attempt to this file as comma-separated values
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
    /// Of scaling: draw the times into this file
    #[arg(long, value_name = "PNG")]
    plot: Option<PathBuf>,
    /// Of scaling: references at most; ten thousand take below 3 GB
    #[arg(long, value_name = "N", default_value_t = crate::bench::scaling::MOST as u64, value_parser = clap::value_parser!(u64).range(8..=100_000))]
    most: u64,
    /// Of live: how long
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u64).range(1..=1440))]
    minutes: u64,
    /// Of table1: only this part; may be given several times
    #[arg(long, value_name = "NAME")]
    part: Vec<String>,
    #[command(flatten)]
    library: LibraryChoice,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Bench {
    /// The time of each stage beside its budget
    Speed,
    /// Right, accepted and well placed, by the default matcher and by the paper's
    Recognition,
    /// Fits the score to simulated frames, and says what each piece of evidence is worth
    Calibration,
    /// The paper's Table I: what is left of E from T1..T5, by ICP, ICP-GA and the global method
    Table1,
    /// Poses of clouds that share no point: whole, single views, hidden, noisy, with stray points, and what the genetic algorithm adds
    Registration,
    /// The left half of that table: time and right answers, ours beside FPFH, SHOT, spin images and VFH
    Systems,
    /// Ranking by 1, 2, 4 and 8 workers over a growing number of references: from where do several pay?
    Scaling,
    /// Processor time of a frame of the window, at rest, turning and live; needs no display
    Window,
    /// The simulated line followed for minutes: rate, latency, the window's thread, memory; needs no display
    Live,
}

/// Poses of each part, unless asked for otherwise.
const NUM_POSES: u64 = 25;
/// Seed of the first frame, unless asked for otherwise.
const FIRST_SEED: u64 = 1_000_000;
/// Frames of each kind that are measured.
const NUM_FRAMES: usize = 120;

/// What `--json` writes of the window.
#[derive(Debug, Serialize)]
struct WindowFile {
    schema: u32,
    simulated: bool,
    window: WindowCost,
}

/// What `--json` writes.
#[derive(Debug, Serialize)]
struct BenchFile<'a> {
    schema: u32,
    simulated: bool,
    runs: Vec<RunLine<'a>>,
}

#[derive(Debug, Serialize)]
struct RunLine<'a> {
    matcher: Matcher,
    num_frames: usize,
    num_right: usize,
    num_right_accepted: usize,
    num_wrong_accepted: usize,
    num_well_placed: usize,
    stages: Vec<StageTimes>,
    cases: Vec<CaseLine<'a>>,
}

#[derive(Debug, Serialize)]
struct CaseLine<'a> {
    truth: &'static str,
    seed: u64,
    found: Option<&'a str>,
    score: f64,
    accepted: bool,
    rotation_error_deg: Option<f64>,
    shift_error_mm: Option<f64>,
    total_ms: f64,
}

pub(super) fn run(args: &BenchArgs, console: &mut Console) -> anyhow::Result<Outcome> {
    if args.bench == Bench::Window {
        return frames(args, console);
    }
    let matchers: &[Matcher] = match args.bench {
        Bench::Scaling => return scaling::run(args, console),
        Bench::Live => return live::run(args, console),
        Bench::Speed | Bench::Window => &[Matcher::Default],
        Bench::Recognition => &[Matcher::Default, Matcher::Paper],
        Bench::Table1 => return table1::run(args, console),
        Bench::Registration => return registration::run(args, console),
        Bench::Systems => return systems::run(args, console),
        Bench::Calibration => return calibration::run(args, console),
    };
    if args.csv.is_some() || !args.part.is_empty() {
        return Err(advised_error(
            "--csv and --part go with table1",
            "Ask for it: partsight bench table1 --csv FILE",
        ));
    }
    if !args.suite.is_empty() {
        if args.bench != Bench::Recognition {
            return Err(advised_error(
                "--suite goes with recognition",
                "Ask for it: partsight bench recognition --suite all",
            ));
        }
        return suites::run(args, console);
    }
    let num_poses = args.poses.unwrap_or(NUM_POSES);
    let enrolled = enrol_standard_parts(&EnrolParams::default()).advised()?;
    let setup = RecognitionSetup {
        num_poses,
        first_seed: args.seed.unwrap_or(FIRST_SEED),
        model_seed: args.model,
        placement: Placement::from(args.placement),
    };
    let num_frames = num_poses as usize * enrolled.library.references.len();
    console.start_progress(num_frames * matchers.len());
    let mut runs: Vec<(Matcher, Recognition)> = Vec::new();
    for &matcher in matchers {
        let mut recipe = Recipe::default();
        recipe.rank.matcher = matcher;
        let recognition = recognise_all(&setup, &enrolled, &recipe, &Unwatched, |_, _| {
            console.done();
        })?;
        runs.push((matcher, recognition));
    }
    console.end_progress();
    console.line(&format_args!(
        "Simulated: {num_frames} frames, {} of each part, car model {} against the enrolled model 0, one core.",
        num_poses, args.model
    ));
    if args.bench == Bench::Recognition {
        console.line(&"");
        show_recognition(&runs, console);
    }
    for (matcher, recognition) in &runs {
        console.line(&"");
        console.line(&format_args!(
            "Time per stage, {} matcher:",
            name_of(*matcher)
        ));
        show_times(&times_of(recognition), console);
    }
    if let Some(path) = &args.json {
        let file = BenchFile {
            schema: 1,
            simulated: true,
            runs: runs
                .iter()
                .map(|(matcher, recognition)| run_line(*matcher, recognition))
                .collect(),
        };
        write_json(path, &file)?;
    }
    Ok(Outcome::Accepted)
}

fn write_json(path: &Path, file: &impl Serialize) -> anyhow::Result<()> {
    write_atomically(path, |writer| {
        serde_json::to_writer_pretty(&mut *writer, file)?;
        writeln!(writer)
    })
    .advised()
    .with_context(|| format!("{} was not written", path.display()))
}

/// Frames of the window's first result, without a display.
fn frames(args: &BenchArgs, console: &mut Console) -> anyhow::Result<Outcome> {
    let cost = window_cost(NUM_FRAMES, WindowOptions::default()).advised()?;
    let [width, height] = cost.size;
    console.line(&format_args!(
        "A window of {width} × {height} with a scene of {} points; processor time of the window's own thread, without \
         the drawing itself; a software driver's drawing is in that of all threads.",
        cost.num_points
    ));
    console.line(&"");
    let mut table = Table::new(&[
        "a frame",
        "median",
        "95 %",
        "budget",
        "all threads",
        "from frame to frame",
        "points drawn",
    ]);
    for frame in &cost.frames {
        let known = |ms: Option<f64>| ms.map_or_else(|| "-".to_owned(), |ms| format!("{ms:.0} ms"));
        table.row([
            frame.what.to_owned(),
            format!("{:.2} ms", frame.busy_p50_ms),
            format!("{:.2} ms", frame.busy_p95_ms),
            "4.0 ms".to_owned(),
            known(frame.all_threads_mean_ms),
            known(frame.paced_p50_ms),
            frame
                .detail
                .map_or_else(|| "-".to_owned(), |share| format!("{:.0} %", share * 100.0)),
        ]);
    }
    table.show(console);
    if let Some(path) = &args.json {
        let file = WindowFile {
            schema: 1,
            simulated: true,
            window: cost,
        };
        write_json(path, &file)?;
    }
    Ok(Outcome::Accepted)
}

fn name_of(matcher: Matcher) -> &'static str {
    match matcher {
        Matcher::Default => "default",
        Matcher::Paper => "paper's",
    }
}

fn times_of(recognition: &Recognition) -> Vec<StageTimes> {
    let timings: Vec<Timings> = recognition.cases.iter().map(|c| c.timings).collect();
    stage_times(&timings)
}

fn show_recognition(runs: &[(Matcher, Recognition)], console: &mut Console) {
    let mut table = Table::new(&[
        "matcher",
        "right",
        "right and accepted",
        "wrong and accepted",
        "pose within 2° and 10 mm",
        "median error",
        "95 % of errors below",
    ]);
    for (matcher, recognition) in runs {
        let total = recognition.cases.len();
        let share = |num: usize, of: usize| {
            format!(
                "{num}/{of} ({:.1} %)",
                100.0 * num as f64 / of.max(1) as f64
            )
        };
        let error = |quantile| {
            recognition.pose_error_quantile(quantile).map_or_else(
                || "-".to_owned(),
                |e| format!("{}, {}", e.rotation, e.shift),
            )
        };
        table.row([
            name_of(*matcher).to_owned(),
            share(recognition.num_right(), total),
            share(recognition.num_right_accepted(), total),
            share(recognition.num_wrong_accepted(), total),
            share(recognition.num_well_placed(), recognition.num_right()),
            error(0.5),
            error(0.95),
        ]);
    }
    table.show(console);
    for (matcher, recognition) in runs {
        for (truth, found, num) in recognition.confusions() {
            console.line(&format_args!(
                "  {} matcher: {truth} taken for {found}, {num}×",
                name_of(*matcher)
            ));
        }
    }
}

fn show_times(times: &[StageTimes], console: &mut Console) {
    let mut table = Table::new(&["stage", "median", "95 %", "budget"]);
    for t in times {
        table.row([
            t.stage.to_owned(),
            format!("{:.2} ms", t.median_ms),
            format!("{:.2} ms", t.p95_ms),
            format!("{:.1} ms", t.budget_ms),
        ]);
    }
    table.show(console);
}

fn run_line(matcher: Matcher, recognition: &Recognition) -> RunLine<'_> {
    RunLine {
        matcher,
        num_frames: recognition.cases.len(),
        num_right: recognition.num_right(),
        num_right_accepted: recognition.num_right_accepted(),
        num_wrong_accepted: recognition.num_wrong_accepted(),
        num_well_placed: recognition.num_well_placed(),
        stages: times_of(recognition),
        cases: recognition
            .cases
            .iter()
            .map(|c| CaseLine {
                truth: c.truth.name(),
                seed: c.seed,
                found: c.found.as_deref(),
                score: c.score,
                accepted: c.is_accepted,
                rotation_error_deg: c.pose_error.map(|e| e.rotation.degrees()),
                shift_error_mm: c.pose_error.map(|e| e.shift.mm()),
                total_ms: c.timings.total.as_secs_f64() * 1e3,
            })
            .collect(),
    }
}
