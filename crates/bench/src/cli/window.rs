//! `partsight-bench window`: processor time of a frame of the window.

use super::{JsonFile, write_results};
use crate::window_cost::window_cost;
use app::WindowOptions;
use partsight::cli::{
    Outcome,
    console::{Advised as _, Console, Table},
};

/// Number of frames measured of each kind.
const NUM_FRAMES: usize = 120;

/// Times frames of the window's first result, without a display.
pub(super) fn run(args: &JsonFile, console: &mut Console) -> anyhow::Result<Outcome> {
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
    console.table(&table);
    if let Some(path) = &args.json {
        write_results(path, "window", &cost)?;
    }
    Ok(Outcome::Accepted)
}
