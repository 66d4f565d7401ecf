//! `partsight-bench scaling`: serial and parallel ranking, the paper's Fig. 7(a) and (b).

use std::path::PathBuf;

use anyhow::Context as _;
use clap::Args;

use super::{JsonFile, name_of, write_results};
use app::workspaces::compare::scaling::{MOST, Scaling, scaling, sizes};
use inspection::pipeline::Unwatched;
use partsight::cli::{
    Outcome,
    console::{Advised as _, Console, Table},
};
use records::report::{SizeCurve, curves_picture, stacked, write_png};
use stages::rank::{Matcher, RankParams};

#[derive(Debug, Args)]
pub(super) struct ScalingArgs {
    #[command(flatten)]
    file: JsonFile,
    /// Draw the figures into this file
    #[arg(long, value_name = "PNG")]
    plot: Option<PathBuf>,
    /// Maximum number of references; ten thousand take less than 3 GB
    #[arg(long, value_name = "N", default_value_t = MOST as u64, value_parser = clap::value_parser!(u64).range(8..=100_000))]
    most: u64,
}

pub(super) fn run(args: &ScalingArgs, console: &mut Console) -> anyhow::Result<Outcome> {
    let most = args.most as usize;
    let matchers = [Matcher::Default, Matcher::Paper];
    console.start_progress(matchers.len() * sizes(most).len());
    let mut scalings = Vec::new();
    for matcher in matchers {
        scalings.push(scaling(matcher, most, &Unwatched, &mut |_| console.done()).advised()?);
    }
    console.end_progress();
    for scaling in &scalings {
        show(scaling, console);
    }
    console.line(&format_args!(
        "By default all cores rank from {} references on.",
        RankParams::default().parallel_from
    ));
    if let Some(path) = &args.plot {
        let pictures: Vec<_> = scalings.iter().map(picture).collect();
        write_png(path, &stacked(&pictures))
            .advised()
            .with_context(|| format!("{} was not written", path.display()))?;
    }
    if let Some(path) = &args.file.json {
        write_results(path, "scalings", &scalings)?;
    }
    Ok(Outcome::Accepted)
}

fn show(scaling: &Scaling, console: &mut Console) {
    let num_cores = scaling.num_cores;
    console.line(&format_args!(
        "Ranking one simulated front door, {} matcher; the first 64 references are enrolled, the rest perturbed signatures.",
        name_of(scaling.matcher)
    ));
    let shared = match scaling.workers.iter().filter(|w| **w > num_cores).min() {
        Some(least) => format!("; {least} workers and more share them"),
        None => String::new(),
    };
    console.line(&format_args!(
        "This machine has {num_cores} cores{shared}. The quickest ranking of each, in parentheses the median."
    ));
    let mut table = Table::new(&["references", "1 worker", "2", "4", "8", "quickest"]);
    for row in &scaling.rows {
        let times = row.least_ms.iter().zip(row.median_ms);
        let times = times.map(|(least, median)| format!("{least:.3} ms ({median:.3})"));
        let quickest = row.least_ms.iter().zip(scaling.workers);
        let quickest = quickest.min_by(|a, b| a.0.total_cmp(b.0));
        let quickest = quickest.map_or_else(String::new, |(ms, workers)| {
            let gain = row.least_ms[0] / ms;
            match workers {
                1 => "1 worker".into(),
                workers => format!("{workers} workers, {gain:.2}×"),
            }
        });
        let first = row.num_references.to_string();
        table.row([first].into_iter().chain(times).chain([quickest]));
    }
    console.table(&table);
    for (workers, from) in scaling.workers.iter().zip(scaling.crossovers).skip(1) {
        let from = from.map_or_else(
            || "nowhere".into(),
            |size| format!("from {size} references on"),
        );
        console.line(&format_args!("{workers} workers pay {from}"));
    }
    let same = if scaling.is_identical {
        "Every ranking was the same to the last bit."
    } else {
        "RANKINGS DIFFERED from the serial one."
    };
    console.line(&same);
    if let Some([num_same, num_frames]) = scaling.same_first {
        console.line(&format_args!(
            "The first is that of an exhaustive ranking in {num_same} of {num_frames} frames."
        ));
    }
    console.line(&"");
}

fn picture(scaling: &Scaling) -> image::RgbImage {
    let curves: Vec<SizeCurve> = scaling
        .workers
        .iter()
        .enumerate()
        .map(|(index, workers)| SizeCurve {
            name: match workers {
                1 => "1 worker".into(),
                workers => format!("{workers} workers"),
            },
            points: scaling
                .rows
                .iter()
                .map(|row| [row.num_references as f64, row.least_ms[index]])
                .collect(),
        })
        .collect();
    let num_cores = scaling.num_cores;
    let title = format!(
        "Ranking, {} matcher, {num_cores} cores",
        name_of(scaling.matcher)
    );
    let crossover = scaling.crossover();
    let words = crossover.map(|from| format!("{num_cores} cores pay from {from}"));
    let mark = crossover.map(|from| from as f64).zip(words.as_deref());
    let axes = ["references", "time of a ranking, ms"];
    curves_picture(&title, axes, &curves, mark)
}
