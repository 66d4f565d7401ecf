//! `partsight-bench live`: the window following the simulated line for minutes.

use std::time::Duration;

use clap::Args;

use super::{JsonFile, write_results};
use crate::live_cost::live_stretches;
use partsight::cli::{
    Outcome,
    console::{Advised as _, Console, Table},
};

/// Duration of one line of the table.
const STRETCH: Duration = Duration::from_secs(30);

#[derive(Debug, Args)]
pub(super) struct LiveArgs {
    #[command(flatten)]
    file: JsonFile,
    /// Duration in minutes
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u64).range(1..=1440))]
    minutes: u64,
}

/// Follows the simulated line for the requested time.
pub(super) fn run(args: &LiveArgs, console: &mut Console) -> anyhow::Result<Outcome> {
    let num_stretches = 2 * args.minutes as usize;
    console.line(&format_args!(
        "The window without a display follows the simulated line for {} min; a line per {} s.",
        args.minutes,
        STRETCH.as_secs()
    ));
    console.start_progress(num_stretches);
    let stretches = live_stretches(num_stretches, STRETCH, |_| console.done()).advised()?;
    console.end_progress();
    let mut table = Table::new(&[
        "until",
        "captured",
        "inspected",
        "latency",
        "drawn",
        "window's thread, median",
        "95 %",
        "longest",
        "of it waiting for a core",
        "memory",
    ]);
    for stretch in &stretches {
        table.row([
            format!("{:.0} s", stretch.until_s),
            format!("{:.1} /s", stretch.captured_per_s),
            format!("{:.1} /s", stretch.inspected_per_s),
            format!("{:.0} ms", stretch.latency_ms),
            stretch.num_drawn.to_string(),
            format!("{:.2} ms", stretch.busy_p50_ms),
            format!("{:.2} ms", stretch.busy_p95_ms),
            format!("{:.0} ms", stretch.longest_ms),
            stretch
                .longest_waited_ms
                .map_or_else(|| "-".to_owned(), |ms| format!("{ms:.0} ms")),
            stretch
                .memory_mb
                .map_or_else(|| "-".to_owned(), |mb| format!("{mb:.0} MB")),
        ]);
    }
    console.table(&table);
    if let Some(path) = &args.file.json {
        write_results(path, "stretches", &stretches)?;
    }
    Ok(Outcome::Accepted)
}
