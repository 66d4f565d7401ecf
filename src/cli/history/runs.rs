//! `partsight history runs` and `run`: past runs of visual servoing.

use std::path::PathBuf;

use clap::Args;
use serde::Serialize;

use super::{
    here,
    moments::{parse_since, parse_until},
    show::SCHEMA,
};
use crate::cli::{
    Outcome,
    console::{Advised as _, Console, Table, marked_simulated},
};
use geometry::{
    error::Advice,
    units::{Metres, Radians, counted},
};
use jiff::Timestamp;
use records::history::{Filter, History, ServoRun, ServoSample, write_servo_table};
use servo::StopReason;

/// Which runs, and how they are shown.
#[derive(Debug, Args)]
pub(in crate::cli) struct RunsArgs {
    /// From this time on: a day (2026-11-20), a moment (2026-11-20T14:00), `today`, or a number of days back (`7d`)
    #[arg(long, value_name = "DATE", value_parser = parse_since)]
    since: Option<Timestamp>,
    /// Up to and including this day or moment
    #[arg(long, value_name = "DATE", value_parser = parse_until)]
    until: Option<Timestamp>,
    /// To this part
    #[arg(long, value_name = "NAME")]
    part: Option<String>,
    /// With these words in the name of part, robot or source, or in the kind of reason
    #[arg(long, value_name = "TEXT")]
    text: Option<String>,
    /// Only simulated runs (true), or only those of a robot (false)
    #[arg(long, value_name = "BOOL")]
    simulated: Option<bool>,
    /// Maximum number, newest first; 0 for all
    #[arg(long, value_name = "N", default_value_t = 50)]
    limit: usize,
    /// Write them to a table, the oldest first
    #[arg(long, value_name = "FILE", conflicts_with = "json")]
    csv: Option<PathBuf>,
    /// Write one line of JSON per run, and nothing else, to standard output
    #[arg(long)]
    json: bool,
}

/// A run as `--json` writes it.
#[derive(Serialize)]
struct RunLine<'a> {
    schema: u32,
    #[serde(flatten)]
    run: &'a ServoRun,
    arrived: bool,
    message: Option<String>,
    advice: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    curve: Option<&'a [ServoSample]>,
}

fn line_of(run: &ServoRun, curve: Option<&[ServoSample]>) -> String {
    let stopped = run.stopped.as_ref();
    let line = RunLine {
        schema: SCHEMA,
        run,
        arrived: stopped.is_none(),
        message: stopped.map(ToString::to_string),
        advice: stopped.map(Advice::advice),
        curve,
    };
    serde_json::to_string(&line).expect("numbers and text have a JSON form")
}

pub(super) fn list(
    history: &History,
    asked: &RunsArgs,
    console: &mut Console,
) -> anyhow::Result<Outcome> {
    let filter = Filter {
        since: asked.since,
        until: asked.until,
        part: asked.part.clone(),
        is_simulated: asked.simulated,
        text: asked.text.clone().unwrap_or_default(),
        ..Filter::default()
    };
    let is_limited = asked.limit > 0 && asked.csv.is_none();
    let most = if is_limited {
        asked.limit
    } else {
        i64::MAX as usize
    };
    let page = history.servo_runs(&filter, 0, most).advised()?;
    if let Some(path) = &asked.csv {
        let num = write_servo_table(path, page.rows.iter().rev()).advised()?;
        let runs = counted(num, "run", "runs");
        console.line(&format_args!("Wrote {runs} to {}", path.display()));
        return Ok(Outcome::Accepted);
    }
    if asked.json {
        for run in &page.rows {
            console.line(&line_of(run, None));
        }
        return Ok(Outcome::Accepted);
    }
    let mut table = Table::new(&["NUMBER", "TIME", "PART", "END", "ERROR", "TOOK", "ROBOT"]);
    for run in &page.rows {
        table.row([
            run.number.to_string(),
            here(run.at),
            run.part.clone(),
            (run.stopped.as_ref())
                .map_or("arrived", StopReason::kind)
                .to_owned(),
            both(run.error_m, run.error_rad).unwrap_or_default(),
            format!("{:.1} s", run.took_s),
            marked_simulated(&run.robot, run.is_simulated),
        ]);
    }
    console.table(&table);
    let num = page.rows.len();
    console.note(&format_args!(
        "{num} shown, {} match, {} in all",
        page.num_matching, page.num_all
    ));
    Ok(Outcome::Accepted)
}

pub(super) fn show(
    history: &History,
    number: i64,
    is_json: bool,
    console: &mut Console,
) -> anyhow::Result<Outcome> {
    let record = history.servo_run(number).advised()?;
    let run = &record.run;
    if is_json {
        console.line(&line_of(run, Some(&record.curve)));
        return Ok(Outcome::Accepted);
    }
    let mut table = Table::default();
    let mut row = |what: &str, text: String| {
        if !text.is_empty() {
            table.row([what.to_owned(), text]);
        }
    };
    row("servo run", run.number.to_string());
    row(
        "time",
        format!("{} local time, {} UTC", here(run.at), run.at),
    );
    row("part", run.part.clone());
    row("target", run.target.name().replace('_', " "));
    row("robot", marked_simulated(&run.robot, run.is_simulated));
    row("source", run.source.clone());
    match &run.stopped {
        None if run.is_approximate => row(
            "end",
            "arrived, approximate: it may be another model".into(),
        ),
        None => row("end", "arrived".into()),
        Some(reason) => {
            row("end", format!("stopped ({})", reason.kind()));
            row("why", reason.to_string());
            row("to do", reason.advice());
        }
    }
    row(
        "error",
        both(run.error_m, run.error_rad).unwrap_or_default(),
    );
    let bounds = both(run.bounds_m, run.bounds_rad);
    row("bounds, 95 %", bounds.unwrap_or_default());
    let tolerance = both(Some(run.tolerance_m), Some(run.tolerance_rad));
    row("tolerance", tolerance.unwrap_or_default());
    let speed = run.speed_m_s;
    let speed = speed.map(|speed| format!("up to {:.0} mm/s", 1000.0 * speed));
    row("speed", speed.unwrap_or_default());
    row(
        "took",
        format!("{:.1} s, {} frames", run.took_s, run.num_looks),
    );
    row("program", run.program.clone());
    console.table(&table);
    Ok(Outcome::Accepted)
}

/// A shift and an angle as people read them.
fn both(shift_m: Option<f64>, turn_rad: Option<f64>) -> Option<String> {
    let (shift, turn) = (Metres(shift_m?), Radians(turn_rad?));
    Some(format!("{:.2} mm, {:.3}°", shift.mm(), turn.degrees()))
}
