//! `partsight-bench history`: times queries of a long history.

use serde::Serialize;

use super::{JsonFile, write_json};
use crate::history::{HistoryTime, history_times};
use partsight::cli::{
    Outcome,
    console::{Advised as _, Console, Table},
};

/// Number of rows of the history.
const NUM_ROWS: usize = 100_000;

/// The file that `--json` writes.
#[derive(Debug, Serialize)]
struct HistoryFile {
    schema: u32,
    num_rows: usize,
    times: Vec<HistoryTime>,
}

/// Times queries of a long history.
pub(super) fn run(args: &JsonFile, console: &mut Console) -> anyhow::Result<Outcome> {
    console.line(&format_args!(
        "A history of {NUM_ROWS} inspections: a page of 50 and the number of all, first, middle and last page."
    ));
    let times = history_times(NUM_ROWS).advised()?;
    console.line(&"");
    let mut table = Table::new(&["", "rows or bytes", "median", "longest", "budget"]);
    for time in &times {
        table.row([
            time.what.to_owned(),
            time.num.to_string(),
            format!("{:.1} ms", time.median_ms),
            format!("{:.1} ms", time.longest_ms),
            format!("{:.0} ms", time.budget_ms),
        ]);
    }
    console.table(&table);
    if let Some(path) = &args.json {
        let file = HistoryFile {
            schema: 1,
            num_rows: NUM_ROWS,
            times,
        };
        write_json(path, &file)?;
    }
    Ok(Outcome::Accepted)
}
