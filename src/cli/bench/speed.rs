//! `partsight bench`: the time of each stage beside its budget.

use serde::Serialize;

use super::{BenchArgs, recognition::Frames, write_json};
use crate::{
    bench::{StageTimes, stage_times, suites::Suite},
    cli::{
        Outcome,
        console::{Console, Table},
    },
    pipeline::Timings,
};

/// What `--json` writes.
#[derive(Debug, Serialize)]
struct SpeedFile {
    schema: u32,
    simulated: bool,
    num_frames: usize,
    stages: Vec<StageTimes>,
}

/// Poses of each subject, unless asked for otherwise.
const NUM_POSES: u64 = 25;

pub(super) fn run(args: &BenchArgs, console: &mut Console) -> anyhow::Result<Outcome> {
    let frames = Frames::of(args, &[Suite::Placed], NUM_POSES);
    let results = frames.inspect(console)?;
    let cases = results.iter().flat_map(|result| &result.cases);
    let timings: Vec<Timings> = cases.map(|case| case.timings).collect();
    let stages = stage_times(&timings);
    console.line(&format_args!(
        "Simulated: {} frames, {}; one core, at what else it is doing now.",
        timings.len(),
        frames.words()
    ));
    console.line(&"");
    show(&stages, console);
    if let Some(path) = &args.json {
        let file = SpeedFile {
            schema: 1,
            simulated: true,
            num_frames: timings.len(),
            stages,
        };
        write_json(path, &file)?;
    }
    Ok(Outcome::Accepted)
}

fn show(times: &[StageTimes], console: &mut Console) {
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
