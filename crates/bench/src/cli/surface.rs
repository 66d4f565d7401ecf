//! `partsight-bench surface`: dents in simulated parts.

use clap::Args;

use super::{FrameChoice, write_results};
use crate::{
    bounds::BoundsLibrary,
    suites::MEASURING_SEED,
    surface::{
        DentCase, LEAST_TIMES, NUM_ENROLLED_FRAMES, SurfaceCase, SurfaceSetup, libraries,
        surface_cases,
    },
};
use geometry::statistics::quantile;
use partsight::cli::{
    Outcome,
    console::{Advised as _, Console, Table},
};

/// Default number of poses of each part: with eight parts, enrolled in three ways, 408 dents.
const NUM_POSES: u64 = 17;

#[derive(Debug, Args)]
pub(super) struct SurfaceArgs {
    #[command(flatten)]
    frames: FrameChoice,
    /// Frames of the standing part that are averaged
    #[arg(long, value_name = "N", default_value_t = 8, value_parser = clap::value_parser!(u64).range(1..=64))]
    average: u64,
    /// Noise, as a multiple of a Kinect's
    #[arg(long, value_name = "X", default_value_t = 1.0)]
    noise: f64,
}

pub(super) fn run(args: &SurfaceArgs, console: &mut Console) -> anyhow::Result<Outcome> {
    let setup = SurfaceSetup {
        num_poses: args.frames.poses.unwrap_or(NUM_POSES),
        first_seed: args.frames.seed.unwrap_or(MEASURING_SEED),
        num_frames: args.average,
        noise: args.noise.clamp(0.0, 5.0),
    };
    let libraries = libraries().advised()?;
    let num_parts: usize = libraries.iter().map(|library| library.subjects.len()).sum();
    console.start_progress(2 * num_parts * setup.num_poses as usize);
    let of_library = |library: &BoundsLibrary| surface_cases(library, &setup, || console.done());
    let cases: Vec<Vec<SurfaceCase>> = libraries.iter().map(of_library).collect();
    console.end_progress();
    console.line(&format_args!(
        "Simulated: ±30°, any roll, 0.9 to 1.8 m, noise × {}, {} frames averaged; dents and bumps of 20 to 80 mm width and 1 to 6 mm depth. A dent counts if the average over a patch shows more than {LEAST_TIMES} times its noise of it. Enrolled from meshes, from {NUM_ENROLLED_FRAMES} averaged captures and from one. Good parts are the same ones without a dent.",
        setup.noise, setup.num_frames
    ));
    console.line(&"");
    let mut table = Table::new(&[
        "enrolled from",
        "accepted",
        "not judged",
        "dents",
        "that count",
        "found of them",
        "found of the others",
        "false beside dents",
        "good parts",
        "with a region",
        "regions a part",
        "noise mm",
        "between frames mm",
        "limit × noise",
        "found in 95 %: 20, 40, 80 mm",
        "judged",
    ]);
    for (library, cases) in libraries.iter().zip(&cases) {
        table.row(row(&library.title, &cases.iter().collect::<Vec<_>>()));
    }
    let all: Vec<&SurfaceCase> = cases.iter().flatten().collect();
    table.row(row("all", &all));
    console.table(&table);
    if let Some(path) = &args.frames.file.json {
        write_results(path, "cases", &all)?;
    }
    Ok(Outcome::Accepted)
}

fn row(title: &str, cases: &[&SurfaceCase]) -> [String; 16] {
    let judged: Vec<&&SurfaceCase> = (cases.iter())
        .filter(|case| case.limit_factor.is_some())
        .collect();
    let num_accepted = cases.iter().filter(|case| case.accepted).count();
    let dents: Vec<DentCase> = judged.iter().filter_map(|case| case.dent).collect();
    let (count, others): (Vec<DentCase>, Vec<DentCase>) =
        dents.iter().partition(|dent| dent.must_be_found());
    let good: Vec<&&&SurfaceCase> = judged.iter().filter(|case| case.dent.is_none()).collect();
    let num_false: usize = good.iter().map(|case| case.num_false()).sum();
    let num_with = good.iter().filter(|case| case.num_false() > 0).count();
    let dented = judged.iter().filter(|case| case.dent.is_some());
    let num_beside: usize = dented.map(|case| case.num_false()).sum();
    let share = |part: usize, of: usize| {
        format!(
            "{part}/{of} ({:.1} %)",
            100.0 * part as f64 / of.max(1) as f64
        )
    };
    let found = |dents: &[DentCase]| {
        let num = dents.iter().filter(|dent| dent.found).count();
        share(num, dents.len())
    };
    let middle = |value: &dyn Fn(&SurfaceCase) -> Option<f64>, decimals: usize| {
        let values = judged.iter().filter_map(|case| value(case));
        quantile(values, 0.5).map_or_else(|| "-".to_owned(), |value| format!("{value:.decimals$}"))
    };
    let smallest = [0, 1, 2].map(|width| {
        let of_width = |case: &SurfaceCase| case.smallest_mm.map(|depths| depths[width]);
        middle(&of_width, 1)
    });
    let seen = middle(&|case: &SurfaceCase| case.seen.map(|seen| 100.0 * seen), 0);
    [
        title.to_owned(),
        share(num_accepted, cases.len()),
        (num_accepted - judged.len()).to_string(),
        dents.len().to_string(),
        count.len().to_string(),
        found(&count),
        found(&others),
        num_beside.to_string(),
        good.len().to_string(),
        share(num_with, good.len()),
        format!("{:.3}", num_false as f64 / good.len().max(1) as f64),
        middle(&|case: &SurfaceCase| case.noise_mm, 2),
        middle(&|case: &SurfaceCase| case.noise_between_mm, 2),
        middle(&|case: &SurfaceCase| case.limit_factor, 2),
        smallest.join(", "),
        format!("{seen} %"),
    ]
}
