//! `partsight-bench servo`: simulated runs of visual servoing.

use std::collections::BTreeMap;

use clap::Args;

use super::{JsonFile, write_results};
use crate::{
    servo::{ServoCase, ServoRun, ServoSuite, servo_cases, servo_params},
    suites::MEASURING_SEED,
};
use geometry::statistics::quantile;
use inspection::library::{EnrolParams, enrol_standard_parts};
use partsight::cli::{
    Outcome,
    console::{Advised as _, Console, Table},
};

/// Default number of undisturbed runs.
const NUM_RUNS: u64 = 64;

#[derive(Debug, Args)]
pub(super) struct ServoArgs {
    /// Runs to camera poses; half as many more are disturbed, an eighth as many go to the start of a path; half of those to camera
    /// poses and of the disturbed ones are repeated in single moves
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=10_000))]
    runs: Option<u64>,
    /// Seed of the first frame
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=1_000_000_000))]
    seed: Option<u64>,
    #[command(flatten)]
    file: JsonFile,
}

pub(super) fn run(args: &ServoArgs, console: &mut Console) -> anyhow::Result<Outcome> {
    let first_seed = args.seed.unwrap_or(MEASURING_SEED);
    let num_runs = args.runs.unwrap_or(NUM_RUNS) as usize;
    let library = enrol_standard_parts(&EnrolParams::default()).advised()?;
    let total = ServoSuite::ALL.map(|suite| suite.num_runs(num_runs));
    console.start_progress(total.iter().sum());
    let mut cases = Vec::new();
    for suite in ServoSuite::ALL {
        let num = suite.num_runs(num_runs);
        cases.extend(servo_cases(suite, num, first_seed, &library, || {
            console.done();
        }));
    }
    console.end_progress();
    show(&cases, console);
    if let Some(path) = &args.file.json {
        write_results(path, "cases", &cases)?;
    }
    Ok(Outcome::Accepted)
}

fn show(cases: &[ServoCase], console: &mut Console) {
    console.line(&format_args!(
        "Simulated: an arm carries the camera; starts up to ±250 mm along each axis and 25° from the standard position or a recorded \
         pose, the whole part in the picture; verdicts 30 to 200 ms late. Errors are true ones, at the part's middle or the nozzle's \
         mouth."
    ));
    console.line(&"");
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
    console.line(&"");
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
        for reason in runs.iter().filter_map(|run| run.stopped) {
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
    let num = |is: fn(&ServoRun) -> bool| all.iter().filter(|run| is(run)).count();
    let most = |of: fn(&ServoRun) -> f64| all.iter().map(|run| of(run)).fold(0.0, f64::max);
    console.line(&format_args!(
        "of {} runs: beyond a limit of speed, acceleration or volume {}, diverged {}, touching the part {}, faster on a frame not \
         accepted {}, with commands out of reach {}, no start {}",
        all.len(),
        num(ServoRun::is_beyond),
        num(ServoRun::has_diverged),
        num(ServoRun::touches),
        num(|run| run.num_blind > 0),
        num(|run| run.num_unreachable > 0),
        cases.len() - all.len(),
    ));
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
        quantile(values, share).map_or_else(|| "-".to_owned(), |x| format!("{x:.decimals$}"))
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
