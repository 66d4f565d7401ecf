//! `partsight-bench table1`: the right half of the paper's Table I.

use std::{fmt::Write as _, path::PathBuf};

use anyhow::Context as _;
use clap::Args;
use serde::Serialize;

use super::{JsonFile, write_json};
use crate::table1::{Attempt, Row, table1};
use files::write_text;
use geometry::statistics::quantile;
use inspection::library::Library;
use partsight::cli::{
    LibraryChoice, Outcome,
    console::{Advised as _, Console, Table, advised_error},
};
use stages::{
    pose::{PoseMethod, displacements::DISPLACEMENTS},
    reference::ReferenceParams,
};
use texts::Message;

/// The file that `--json` writes.
#[derive(Debug, Serialize)]
struct Table1File {
    schema: u32,
    /// T1..T5, `[θx θy θz x y z]`, radians and metres.
    transforms: [[f64; 6]; 5],
    euler_order: &'static str,
    attempts: Vec<AttemptLine>,
}

/// A line of `--csv` and an entry of `--json`.
#[derive(Debug, Serialize)]
struct AttemptLine {
    part: String,
    num_points: usize,
    transform: String,
    method: &'static str,
    e_m2: Option<f64>,
    rotation_error_deg: Option<f64>,
    shift_error_mm: Option<f64>,
    time_ms: f64,
    iterations: Option<usize>,
    stopped: Option<&'static str>,
    reason: Option<String>,
}

#[derive(Debug, Args)]
pub(super) struct Table1Args {
    #[command(flatten)]
    file: JsonFile,
    /// Write every attempt to this file as comma-separated values
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
    /// Only this part; may be given several times
    #[arg(long, value_name = "NAME")]
    part: Vec<String>,
    #[command(flatten)]
    library: LibraryChoice,
}

pub(super) fn run(args: &Table1Args, console: &mut Console) -> anyhow::Result<Outcome> {
    let mut library = args
        .library
        .load_some(&ReferenceParams::default(), console)?
        .library;
    keep_asked_for(&mut library, &args.part)?;
    console.start_progress(library.references.len() * DISPLACEMENTS.len());
    let rows = table1(&library, || console.done());
    console.end_progress();
    show(&rows, console);
    let lines = || rows.iter().flat_map(attempt_lines);
    if let Some(path) = &args.file.json {
        let file = Table1File {
            schema: 1,
            transforms: DISPLACEMENTS,
            euler_order: "Rz·Ry·Rx",
            attempts: lines().collect(),
        };
        write_json(path, &file)?;
    }
    if let Some(path) = &args.csv {
        let text = csv(lines());
        write_text(path, &text)
            .advised()
            .with_context(|| format!("{} was not written", path.display()))?;
    }
    Ok(Outcome::Accepted)
}

fn keep_asked_for(library: &mut Library, names: &[String]) -> anyhow::Result<()> {
    let missing = names
        .iter()
        .find(|name| library.references.iter().all(|r| r.name != **name));
    if let Some(name) = missing {
        let known: Vec<&str> = library.references.iter().map(|r| r.name.as_str()).collect();
        return Err(advised_error(
            Message::new("no-such-part")
                .with("name", name.as_str())
                .to_string(),
            format!("Choose from: {}", known.join(", ")),
        ));
    }
    if !names.is_empty() {
        library.references.retain(|r| names.contains(&r.name));
    }
    Ok(())
}

fn show(rows: &[Row], console: &mut Console) {
    console.line(
        &"E in m² (eq. 12) and the true error, from T1..T5 (eq. 15) as R = Rz·Ry·Rx applied to the same points.",
    );
    console.line(&"");
    let mut table = Table::new(&[
        "part",
        "T",
        "ICP: E",
        "error",
        "time",
        "ICP-GA: E",
        "error",
        "time",
        "ended",
        "global: E",
        "error",
        "time",
    ]);
    for row in rows {
        let mut cells = vec![row.part.clone(), format!("T{}", row.transform)];
        for attempt in &row.attempts {
            let (e, error, stopped) = match &attempt.found {
                Ok(found) => (
                    format!("{:.1e}", found.e_m2),
                    format!(
                        "{:.3}° {:.3} mm",
                        found.error.rotation.degrees(),
                        found.error.shift.mm()
                    ),
                    found.stopped.to_string(),
                ),
                Err(_) => ("no pose".into(), String::new(), String::new()),
            };
            cells.extend([e, error, format!("{:.0} ms", time_ms(attempt))]);
            if attempt.method == PoseMethod::IcpGa {
                cells.push(stopped);
            }
        }
        table.row(cells);
    }
    console.table(&table);
    console.line(&"");
    let mut table = Table::new(&[
        "method",
        "E < 1e-6 m²",
        "within 0.01° and 0.1 mm",
        "median time",
        "95 %",
    ]);
    for (i, method) in PoseMethod::ALL.iter().enumerate() {
        let attempts = || rows.iter().map(|row| &row.attempts[i]);
        let count = |is: fn(&Attempt) -> bool| {
            format!("{}/{}", attempts().filter(|a| is(a)).count(), rows.len())
        };
        let time = |share| {
            let time = quantile(attempts().map(time_ms), share);
            time.map_or_else(String::new, |ms| format!("{ms:.0} ms"))
        };
        table.row([
            method.name().to_owned(),
            count(Attempt::is_below_target),
            count(Attempt::is_exact),
            time(0.5),
            time(0.95),
        ]);
    }
    console.table(&table);
    let preparations = rows.iter().map(|row| row.preparation.as_secs_f64() * 1e3);
    if let Some(ms) = quantile(preparations, 0.5) {
        console.line(&format_args!(
            "Preparing a target, once per part: {ms:.0} ms (median), not in the times above."
        ));
    }
}

fn time_ms(attempt: &Attempt) -> f64 {
    attempt.time.as_secs_f64() * 1e3
}

fn attempt_lines(row: &Row) -> impl Iterator<Item = AttemptLine> {
    row.attempts.iter().map(|attempt| {
        let found = attempt.found.as_ref().ok();
        AttemptLine {
            part: row.part.clone(),
            num_points: row.num_points,
            transform: format!("T{}", row.transform),
            method: attempt.method.name(),
            e_m2: found.map(|f| f.e_m2),
            rotation_error_deg: found.map(|f| f.error.rotation.degrees()),
            shift_error_mm: found.map(|f| f.error.shift.mm()),
            time_ms: time_ms(attempt),
            iterations: found.map(|f| f.num_iterations),
            stopped: found.map(|f| f.stopped.name()),
            reason: attempt.found.as_ref().err().map(ToString::to_string),
        }
    })
}

fn csv(lines: impl Iterator<Item = AttemptLine>) -> String {
    let mut text = String::from(
        "part,num_points,transform,method,e_m2,rotation_error_deg,shift_error_mm,time_ms,iterations,stopped,reason\n",
    );
    let number = |x: Option<f64>| x.map_or_else(String::new, |x| format!("{x:e}"));
    for line in lines {
        let iterations = line.iterations.map_or_else(String::new, |n| n.to_string());
        let stopped = line.stopped.unwrap_or_default();
        // The only cell that may contain a comma; quotes within it are doubled.
        let reason = line
            .reason
            .map_or_else(String::new, |r| format!("\"{}\"", r.replace('"', "\"\"")));
        let AttemptLine {
            part,
            num_points,
            transform,
            method,
            time_ms,
            ..
        } = line;
        let [e, rotation, shift] =
            [line.e_m2, line.rotation_error_deg, line.shift_error_mm].map(number);
        // Writing to a string cannot fail.
        let _ = writeln!(
            text,
            "{part},{num_points},{transform},{method},{e},{rotation},{shift},{time_ms:.3},{iterations},{stopped},{reason}"
        );
    }
    text
}
