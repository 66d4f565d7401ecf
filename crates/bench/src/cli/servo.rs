//! `partsight-bench servo`: simulated runs of visual servoing.

use std::{
    collections::{BTreeMap, BTreeSet},
    path::{Path, PathBuf},
};

use anyhow::Context as _;
use clap::Args;
use serde::Deserialize;

use super::{JsonFile, write_results};
use crate::{
    servo::{ServoCase, ServoParts, ServoRun, ServoSuite, servo_cases, servo_params},
    suites::MEASURING_SEED,
};
use files::read_limited;
use geometry::statistics::quantile;
use inspection::library::PartName;
use partsight::cli::{
    Outcome,
    console::{Advised as _, Console, Table, advised_error},
    input::open_scene,
};

/// Default number of undisturbed runs.
const NUM_RUNS: u64 = 64;
/// Largest file of runs that is read: those of 100 000 runs.
const MAX_FILE_BYTES: u64 = 1 << 27;

#[derive(Debug, Args)]
pub(super) struct ServoArgs {
    /// Runs to camera poses; half as many more are disturbed, an eighth as many go to the start of a path; half of those to camera
    /// poses and of the disturbed ones are repeated in single moves
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=10_000))]
    runs: Option<u64>,
    /// Number of the first run: several processes share the runs if each has some of their numbers, and --read joins their files
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = clap::value_parser!(u64).range(..=10_000))]
    first: u64,
    /// Seed of the first frame
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=1_000_000_000))]
    seed: Option<u64>,
    /// Capture of a real part, which is enrolled, and whose surface hangs in the simulated cell beside the eight parts in turn; may be
    /// given several times
    #[arg(long, value_name = "FILE")]
    reference: Vec<PathBuf>,
    /// Make no run, and show those of these files together, which --json wrote
    #[arg(long, value_name = "JSON", num_args = 1.., conflicts_with_all = ["runs", "first", "seed", "reference", "json"])]
    read: Vec<PathBuf>,
    #[command(flatten)]
    file: JsonFile,
}

/// Makes the runs, or reads them. The exit code is 1 if something was wrong that must not be.
pub(super) fn run(args: &ServoArgs, console: &mut Console) -> anyhow::Result<Outcome> {
    let cases = if args.read.is_empty() {
        made(args, console)?
    } else {
        read(&args.read)?
    };
    show(&cases, console);
    if let Some(path) = &args.file.json {
        write_results(path, "cases", &cases)?;
    }
    Ok(Outcome::accepted_if(show_acceptance(&cases, console)))
}

fn made(args: &ServoArgs, console: &mut Console) -> anyhow::Result<Vec<ServoCase>> {
    let first_seed = args.seed.unwrap_or(MEASURING_SEED);
    let numbers = args.first..args.first + args.runs.unwrap_or(NUM_RUNS);
    let mut parts = ServoParts::standard().advised()?;
    for (number, path) in (1..).zip(&args.reference) {
        let (scene, _) = open_scene(path).advised()?;
        let stem = path.file_stem().unwrap_or_default().to_string_lossy();
        // The parts that it hangs beside may have the same name.
        let name = format!("captured_{number}_{}", stem.to_lowercase());
        let name = PartName::new(&name).advised()?;
        parts.add_captured(&scene, name).advised()?;
    }
    let of_suites = ServoSuite::ALL.map(|suite| (suite, suite.numbers(&numbers)));
    let total: usize = of_suites
        .iter()
        .map(|(_, numbers)| (numbers.end - numbers.start) as usize)
        .sum();
    console.start_progress(total);
    let mut cases = Vec::with_capacity(total);
    for (suite, numbers) in of_suites {
        cases.extend(servo_cases(suite, numbers, first_seed, &parts, || {
            console.done();
        }));
    }
    console.end_progress();
    Ok(cases)
}

/// The file that `--json` writes.
#[derive(Deserialize)]
struct CasesFile {
    cases: Vec<ServoCase>,
}

/// Reads the runs of several processes. A run that is in two files is an error: it would count twice.
fn read(paths: &[PathBuf]) -> anyhow::Result<Vec<ServoCase>> {
    let mut cases = Vec::new();
    let mut known = BTreeSet::new();
    for path in paths {
        let bytes = read_limited(path, MAX_FILE_BYTES).advised()?;
        let file: CasesFile = serde_json::from_slice(&bytes)
            .with_context(|| format!("{} has no runs of servoing", path.display()))
            .map_err(|error| {
                advised_error(
                    format!("{error:#}"),
                    "Give files that partsight-bench servo --json FILE wrote",
                )
            })?;
        for case in &file.cases {
            if !known.insert((case.suite, case.seed)) {
                return Err(twice(path, case.seed));
            }
        }
        cases.extend(file.cases);
    }
    Ok(cases)
}

fn twice(path: &Path, seed: u64) -> anyhow::Error {
    advised_error(
        format!(
            "{}: the run of seed {seed} is also in another file",
            path.display()
        ),
        "Give each process runs of its own: --first 0 --runs 250, --first 250 --runs 250",
    )
}

fn show(cases: &[ServoCase], console: &mut Console) {
    console.line(&format_args!(
        "Simulated: an arm carries the camera; starts up to ±250 mm along each axis and 25° from the standard position or a recorded \
         pose, the whole part in the picture; verdicts 30 to 200 ms late. Errors are true ones, at the part's middle or the nozzle's \
         mouth."
    ));
    console.line(&"");
    show_groups(cases, console);
    console.line(&"");
    show_parts(cases, console);
    console.line(&"");
    show_stops(cases, console);
}

/// The runs by target and noise, or by what goes wrong.
fn show_groups(cases: &[ServoCase], console: &mut Console) {
    let mut table = Table::new(&[
        "runs",
        "noise",
        "number",
        "at the target",
        "stopped",
        "wrong",
        "error: median, 95 %",
        "bound",
        "turn: median, 95 %",
        "bound",
        "time: median, 95 %",
        "moves: median, 95 %",
    ]);
    for (name, noise, runs) in groups(cases) {
        table.row(row(name, noise, &runs));
    }
    console.table(&table);
}

/// The undisturbed runs to camera poses, by part.
fn show_parts(cases: &[ServoCase], console: &mut Console) {
    let mut table = Table::new(&[
        "part",
        "runs to camera poses",
        "at the target",
        "error × 1: 95 %",
        "turn × 1: 95 %",
    ]);
    let undisturbed = || cases.iter().filter(|case| case.suite == ServoSuite::Camera);
    let parts: BTreeSet<&str> = undisturbed().map(|case| case.part.as_str()).collect();
    for part in parts {
        let of_part: Vec<&ServoCase> = undisturbed().filter(|case| case.part == part).collect();
        let num_done = of_part.iter().filter(|case| case.is_done()).count();
        let [shift, turn] = ends(of_part.iter().copied());
        table.row([
            part.to_owned(),
            of_part.len().to_string(),
            num_done.to_string(),
            in_decimals(shift, 2) + " mm",
            in_decimals(turn, 3) + "°",
        ]);
    }
    console.table(&table);
}

fn show_stops(cases: &[ServoCase], console: &mut Console) {
    for (name, runs) in [
        (
            "undisturbed",
            of_suite(cases, |suite| suite == ServoSuite::Camera),
        ),
        (
            "disturbed",
            of_suite(cases, |suite| suite == ServoSuite::Disturbed),
        ),
        (
            "start of a path",
            of_suite(cases, |suite| suite == ServoSuite::PathStart),
        ),
        (
            "in single moves",
            of_suite(cases, |suite| suite == ServoSuite::SingleMoves),
        ),
        (
            "in single moves, disturbed",
            of_suite(cases, |suite| suite == ServoSuite::DisturbedSingleMoves),
        ),
    ] {
        let mut reasons: BTreeMap<&str, usize> = BTreeMap::new();
        for reason in runs.iter().filter_map(|run| run.stopped.as_deref()) {
            *reasons.entry(reason).or_default() += 1;
        }
        let reasons: Vec<String> = (reasons.iter())
            .map(|(reason, num)| format!("{reason} {num}"))
            .collect();
        let reasons = if reasons.is_empty() {
            "none".to_owned()
        } else {
            reasons.join(", ")
        };
        console.line(&format_args!("stops, {name}: {reasons}"));
    }
    let all = of_suite(cases, |_| true);
    let most = |of: fn(&ServoRun) -> f64| all.iter().map(|run| of(run)).fold(0.0, f64::max);
    console.line(&format_args!(
        "greatest shares of the limits: speed {:.3}, acceleration {:.3}, angular speed {:.3}, angular acceleration {:.3}; least distance \
         from the part {:.0} mm",
        most(|run| run.shares[0]),
        most(|run| run.shares[1]),
        most(|run| run.shares[2]),
        most(|run| run.shares[3]),
        1000.0 * all.iter().map(|run| run.least_distance_m).fold(f64::INFINITY, f64::min),
    ));
}

/// Shows the figures that a change must keep. Returns false if something happened that must not.
fn show_acceptance(cases: &[ServoCase], console: &mut Console) -> bool {
    let undisturbed = || cases.iter().filter(|case| case.suite == ServoSuite::Camera);
    let (num, num_done) = (
        undisturbed().count(),
        undisturbed().filter(|case| case.is_done()).count(),
    );
    let share = 100.0 * num_done as f64 / num.max(1) as f64;
    let [shift, turn] = ends(undisturbed()).map(|end| end.unwrap_or(f64::NAN));
    console.line(&"");
    console.line(&format_args!(
        "undisturbed, to camera poses: {num_done} of {num} at the target, {share:.1} % (wanted 99); true error at the end, 95 %, noise \
         × 1: {shift:.2} mm (1.5), {turn:.3}° (0.15)"
    ));
    let params = servo_params();
    let all = of_suite(cases, |_| true);
    let count = |is: &dyn Fn(&ServoRun) -> bool| all.iter().filter(|run| is(run)).count();
    let musts = [
        (
            "beyond a limit of speed, acceleration or volume",
            count(&ServoRun::is_beyond),
        ),
        ("diverged", count(&ServoRun::has_diverged)),
        ("touching the part", count(&ServoRun::touches)),
        (
            "faster on a frame not accepted",
            count(&|run| run.num_blind > 0),
        ),
        (
            "at the target by mistake",
            count(&|run| run.is_wrong(&params)),
        ),
    ];
    let words: Vec<String> = musts
        .iter()
        .map(|(what, num)| format!("{what} {num}"))
        .collect();
    console.line(&format_args!(
        "of {} runs, wanted 0: {}",
        all.len(),
        words.join(", ")
    ));
    console.line(&format_args!(
        "also: with commands out of reach {}, no start {}",
        count(&|run| run.num_unreachable > 0),
        cases.len() - all.len(),
    ));
    musts.iter().all(|(_, num)| *num == 0)
}

/// Shift and turn of the true error that 95 % of the runs do not exceed that have arrived at noise × 1; none without such runs.
fn ends<'a>(cases: impl Iterator<Item = &'a ServoCase>) -> [Option<f64>; 2] {
    let runs = cases.filter(|case| case.noise <= 1.0);
    let runs = runs.filter_map(|case| case.run.as_ref().filter(|run| run.is_done));
    let runs: Vec<&ServoRun> = runs.collect();
    [0, 1].map(|i| quantile(runs.iter().map(|run| run.end[i]), 0.95))
}

fn in_decimals(number: Option<f64>, decimals: usize) -> String {
    number.map_or_else(|| "-".to_owned(), |number| format!("{number:.decimals$}"))
}

fn of_suite(cases: &[ServoCase], is: impl Fn(ServoSuite) -> bool) -> Vec<&ServoRun> {
    let cases = cases.iter().filter(|case| is(case.suite));
    cases.filter_map(|case| case.run.as_ref()).collect()
}

/// Name, noise and runs of each line of the table: by target and noise, or by what goes wrong.
type Group<'a> = (String, String, Vec<&'a ServoRun>);

fn groups(cases: &[ServoCase]) -> Vec<Group<'_>> {
    let mut groups: Vec<Group<'_>> = Vec::new();
    for case in cases {
        let (name, noise) = match case.suite {
            ServoSuite::Disturbed | ServoSuite::DisturbedSingleMoves => {
                (case.disturbance.name(), "× 1, × 3".to_owned())
            }
            _ => (case.target.name(), format!("× {:.0}", case.noise)),
        };
        let name = if case.suite.is_single() {
            format!("{name}, single moves")
        } else {
            name.to_owned()
        };
        let known = groups
            .iter()
            .position(|group| group.0 == name && group.1 == noise);
        let index = known.unwrap_or_else(|| {
            groups.push((name, noise, Vec::new()));
            groups.len() - 1
        });
        groups[index].2.extend(&case.run);
    }
    groups
}

fn row(name: String, noise: String, runs: &[&ServoRun]) -> [String; 12] {
    let params = servo_params();
    let done: Vec<&&ServoRun> = runs.iter().filter(|run| run.is_done).collect();
    let at = |share: f64, of: &dyn Fn(&ServoRun) -> f64, decimals: usize| {
        let values = done.iter().map(|run| of(run));
        in_decimals(quantile(values, share), decimals)
    };
    let both = |of: &dyn Fn(&ServoRun) -> f64, decimals: usize| {
        [0.5, 0.95].map(|share| at(share, of, decimals)).join(", ")
    };
    let bound =
        |index: usize| move |run: &ServoRun| run.bounds.map_or(f64::NAN, |bounds| bounds[index]);
    [
        name,
        noise,
        runs.len().to_string(),
        done.len().to_string(),
        (runs.len() - done.len()).to_string(),
        runs.iter()
            .filter(|run| run.is_wrong(&params))
            .count()
            .to_string(),
        both(&|run| run.end[0], 2) + " mm",
        at(0.5, &bound(0), 1) + " mm",
        both(&|run| run.end[1], 3) + "°",
        at(0.5, &bound(1), 2) + "°",
        both(&|run| run.took_s, 1) + " s",
        both(&|run| run.num_moves as f64, 0),
    ]
}
