//! `partsight-bench line`: simulated lines whose parts pass the camera.

use clap::Args;

use super::{JsonFile, write_results};
use crate::{
    line::{LATER_S, LaterPose, LineCase, LinePartCase, PARTS_PER_LINE, line_cases},
    suites::MEASURING_SEED,
};
use geometry::statistics::quantile;
use inspection::library::{EnrolParams, enrol_standard_parts};
use partsight::cli::{
    Outcome,
    console::{Advised as _, Console, Table},
};

/// Default number of lines.
const NUM_LINES: u64 = 20;

#[derive(Debug, Args)]
pub(super) struct LineArgs {
    /// Lines, each with ten parts: of five speeds in turn, with an even encoder, one that slips, or none
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=10_000))]
    runs: Option<u64>,
    /// Seed of the first line
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=1_000_000_000))]
    seed: Option<u64>,
    #[command(flatten)]
    file: JsonFile,
}

pub(super) fn run(args: &LineArgs, console: &mut Console) -> anyhow::Result<Outcome> {
    let first_seed = args.seed.unwrap_or(MEASURING_SEED);
    let num_lines = args.runs.unwrap_or(NUM_LINES) as usize;
    let library = enrol_standard_parts(&EnrolParams::default()).advised()?;
    console.start_progress(num_lines);
    let cases = line_cases(num_lines, first_seed, &library, || console.done());
    console.end_progress();
    show(&cases, console);
    if let Some(path) = &args.file.json {
        write_results(path, "lines", &cases)?;
    }
    Ok(Outcome::Accepted)
}

fn show(cases: &[LineCase], console: &mut Console) {
    console.line(&format_args!(
        "Simulated: lines of {PARTS_PER_LINE} parts, 10 to 30 frames a second, each line calibrated from its first part; one part in \
         five swings. Errors are those of the part's middle, where it is {} and {} s after it had its number.",
        LATER_S[0], LATER_S[1]
    ));
    console.line(&"");
    let mut table = Table::new(&[
        "speed mm/s",
        "encoder",
        "parts",
        "once",
        "twice",
        "lost",
        "misnamed",
        "swinging",
        "refused",
        "within the bound",
        "1 s: median, 95 % mm",
        "3 s: median, 95 % mm",
        "bound mm",
        "time: median, most s",
    ]);
    let mut all: Vec<&LineCase> = Vec::new();
    for (name, encoder, group) in groups(cases) {
        table.row(row(&name, encoder, &group));
        all.extend(group.into_iter().filter(|case| case.is_counted));
    }
    table.row(row("all", "any", &all));
    console.table(&table);
    console.line(&"");
    for case in cases {
        if let Some(why) = &case.not_calibrated {
            console.line(&format_args!(
                "not calibrated at {:.0} mm/s: {why}",
                1000.0 * case.setup.speed
            ));
        }
    }
    let sum = |of: fn(&LineCase) -> usize| cases.iter().map(of).sum::<usize>();
    let most =
        |of: fn(&LineCase) -> f64| cases.iter().map(|case| of(case).abs()).fold(0.0, f64::max);
    console.line(&format_args!(
        "{} frames inspected; records of no part {}; calibration off by {:.2}° and {:.2} % at most",
        sum(|case| case.num_inspected),
        sum(|case| case.num_surplus),
        most(|case| case.direction_off),
        100.0 * most(|case| case.scale_off),
    ));
}

/// Speed, encoder and lines of each row.
type Group<'a> = (String, &'static str, Vec<&'a LineCase>);

fn groups(cases: &[LineCase]) -> Vec<Group<'_>> {
    let mut groups: Vec<Group<'_>> = Vec::new();
    for case in cases {
        let speed = format!("{:.0}", 1000.0 * case.setup.speed);
        let encoder = match case.setup.encoder.slip {
            _ if !case.is_counted => "none",
            slip if slip > 0.0 => "slips",
            _ => "even",
        };
        let known = (groups.iter()).position(|group| group.0 == speed && group.1 == encoder);
        let index = known.unwrap_or_else(|| {
            groups.push((speed, encoder, Vec::new()));
            groups.len() - 1
        });
        groups[index].2.push(case);
    }
    groups.sort_by_key(|(speed, encoder, _)| (speed.parse::<u32>().ok(), *encoder));
    groups
}

fn row(speed: &str, encoder: &str, cases: &[&LineCase]) -> [String; 14] {
    let parts: Vec<&LinePartCase> = cases.iter().flat_map(|case| &case.parts).collect();
    let carried: Vec<&&LinePartCase> = parts.iter().filter(|part| !part.swings).collect();
    let swinging: Vec<&&LinePartCase> = parts.iter().filter(|part| part.swings).collect();
    let count = |is: fn(&LinePartCase) -> bool| carried.iter().filter(|part| is(part)).count();
    let later: Vec<&LaterPose> = carried.iter().flat_map(|part| &part.later).collect();
    let num_held = later.iter().filter(|later| later.holds()).count();
    let share = 100.0 * num_held as f64 / later.len().max(1) as f64;
    let at = |values: Vec<f64>, share: f64| {
        let value = quantile(values.into_iter(), share);
        value.map_or_else(|| "-".to_owned(), |value| format!("{value:.1}"))
    };
    let errors = |seconds: f64| -> Vec<f64> {
        let these = later
            .iter()
            .filter(|later| (later.seconds - seconds).abs() < 1e-9);
        these.map(|later| later.off_mm).collect()
    };
    let both = |seconds: f64| {
        [0.5, 0.95]
            .map(|share| at(errors(seconds), share))
            .join(", ")
    };
    let took: Vec<f64> = carried.iter().filter_map(|part| part.took_s).collect();
    [
        speed.to_owned(),
        encoder.to_owned(),
        carried.len().to_string(),
        count(|part| part.num_numbers == 1 && part.num_refused == 0).to_string(),
        count(|part| part.num_numbers + part.num_refused > 1).to_string(),
        count(|part| part.num_numbers == 0).to_string(),
        count(|part| part.is_misnamed).to_string(),
        swinging.len().to_string(),
        swinging
            .iter()
            .filter(|part| part.num_numbers == 0)
            .count()
            .to_string(),
        format!("{share:.1} %"),
        both(LATER_S[0]),
        both(LATER_S[1]),
        at(later.iter().map(|later| later.bound_mm).collect(), 0.5),
        format!("{}, {}", at(took.clone(), 0.5), at(took, 1.0)),
    ]
}
