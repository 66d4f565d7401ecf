//! `partsight history`: lists, shows and exports past inspections.

mod again;
pub(super) mod drift;
mod export;
mod moments;
mod runs;
pub(super) mod show;

use std::{
    collections::BTreeSet,
    path::{Path, PathBuf},
};

use clap::{Args, Subcommand};
use jiff::{Timestamp, tz::TimeZone};

use self::moments::{parse_since, parse_until};
use super::{
    LibraryChoice, Outcome,
    console::{Advised as _, Console, Table, advised_error, marked_simulated},
    input::{Choice, choice, within},
    plant,
    record::HistoryChoice,
    verdict::in_column,
};
use inspection::library::Truth;
use records::history::{
    ACCEPTED_KEPT, FILE, Filter, History, HistoryError, KeepFrames, Retention, StoredVerdict,
    Summary, Traceability, VerdictFilter,
};
use stages::reference::ReferenceParams;

/// List, show and export past inspections, made here or in the window
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  partsight history list --since today
  partsight history list --since 7d --verdict not-accepted
  partsight history list --part front_door --text \"frame 12\" --json
  partsight history show 57
  partsight history show 57 --again              # what today's recipe and library make of its frame
  partsight history label 57 back_door           # what it truly is; - if nothing enrolled, none if nothing hung there
  partsight history remark 57 \"hook in front of it\"
  partsight history export --since 2026-03-01 --csv march.csv
  partsight history export --verdict not-accepted --cases tried && partsight evaluate tried
  partsight history keep all --days 30 --gigabytes 50
  partsight history drift --since 30d             # mean, 3σ and trend of each part; exit code 1 if a trend will refuse parts
  partsight history runs --since today            # runs of visual servoing; run 3 --json has the curve of one

Each row is one hung part; for a followed source, with the verdict that counted. A part that was inspected again while it \
hung there, with another recipe or library or because its verdict changed, stays one row, with its re-inspections below it \
(history show NUMBER, or --reinspections). An acceptance replaces a refusal of the same part, never the reverse.
Times are shown in local time, in files and JSON in UTC. A frame that is no longer kept can neither be inspected again nor \
become a case; `partsight history keep` shows which are kept.")]
pub(super) struct HistoryArgs {
    #[command(flatten)]
    place: HistoryChoice,
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
pub(super) enum Command {
    /// Show inspections, the newest first
    List(ListArgs),
    /// Show everything about one inspection
    Show(ShowArgs),
    /// Write inspections to a table, or as cases for `partsight evaluate`
    Export(ExportArgs),
    /// Show how score, fit and position of each accepted part drift, and which parts a trend will refuse
    Drift(drift::DriftArgs),
    /// Set a remark; an empty one removes it
    Remark {
        /// Number of the inspection
        number: i64,
        /// The remark
        text: String,
    },
    /// Set which part it actually is
    Label {
        /// Number of the inspection
        number: i64,
        /// An enrolled name, `-` or `not_enrolled` for something that is not enrolled, `none` or `nothing` for nothing,
        /// `?` to remove the label
        part: String,
        #[command(flatten)]
        library: LibraryChoice,
    },
    /// Show or change which frames are kept, and for how long
    Keep(KeepArgs),
    /// Show runs of visual servoing, the newest first
    Runs(runs::RunsArgs),
    /// Show everything about one run of visual servoing
    Run {
        /// Number of the run
        number: i64,
        /// Write one line of JSON with its curve, and nothing else, to standard output
        #[arg(long)]
        json: bool,
    },
    #[command(flatten)]
    Plant(plant::HistoryCommand),
}

/// Which inspections.
#[derive(Debug, Args)]
pub(super) struct FilterArgs {
    /// From this time on: a day (2026-11-20), a moment (2026-11-20T14:00), `today`, or a number of days back (`7d`)
    #[arg(long, value_name = "DATE", value_parser = parse_since)]
    since: Option<Timestamp>,
    /// Up to and including this day or moment
    #[arg(long, value_name = "DATE", value_parser = parse_until)]
    until: Option<Timestamp>,
    /// Recognised as this part, accepted or not
    #[arg(long, value_name = "NAME")]
    part: Option<String>,
    /// With this verdict
    #[arg(long, value_parser = choice(&VERDICTS), value_name = "VERDICT")]
    verdict: Option<VerdictFilter>,
    /// In the rack of this name
    #[arg(long, value_name = "NAME")]
    rack: Option<String>,
    /// Of this production order
    #[arg(long, value_name = "TEXT")]
    order: Option<String>,
    /// With this serial number
    #[arg(long, value_name = "TEXT")]
    serial: Option<String>,
    /// With these words in the name of part, scene, source or rack, in the remark, the true label or the traceability
    #[arg(long, value_name = "TEXT")]
    text: Option<String>,
    /// Only simulated inspections (true), or only those of a camera (false)
    #[arg(long, value_name = "BOOL")]
    simulated: Option<bool>,
    /// Also re-inspections, which otherwise lie below the inspection that stands for their part
    #[arg(long)]
    reinspections: bool,
}

#[rustfmt::skip]
const VERDICTS: [Choice<VerdictFilter>; 5] = [
    ("accepted", "A part, accepted", VerdictFilter::Only(StoredVerdict::Accepted)),
    ("not-accepted", "Everything that was not accepted: rejected, unknown and no-part", VerdictFilter::NotAccepted),
    ("rejected", "An enrolled part was the best match, and was not accepted", VerdictFilter::Only(StoredVerdict::Rejected)),
    ("unknown", "Something that is not enrolled, or only the mirror image of an enrolled part", VerdictFilter::Only(StoredVerdict::Unknown)),
    ("no-part", "No part", VerdictFilter::Only(StoredVerdict::NoPart)),
];

impl FilterArgs {
    pub(super) fn filter(&self) -> Filter {
        Filter {
            since: self.since,
            until: self.until,
            part: self.part.clone(),
            verdict: self.verdict,
            is_simulated: self.simulated,
            rack: self.rack.clone(),
            order: self.order.as_deref().map(Traceability::cleaned),
            serial: self.serial.as_deref().map(Traceability::cleaned),
            with_below: self.reinspections,
            text: self.text.clone().unwrap_or_default(),
            ..Filter::default()
        }
    }
}

#[derive(Debug, Args)]
pub(super) struct ListArgs {
    #[command(flatten)]
    pub(super) filter: FilterArgs,
    /// Maximum number, newest first; 0 for all
    #[arg(long, value_name = "N", default_value_t = 50)]
    limit: usize,
    /// Write one line of JSON per inspection, and nothing else, to standard output
    #[arg(long)]
    pub(super) json: bool,
    #[command(flatten)]
    pub(super) from: plant::FromChoice,
}

#[derive(Debug, Args)]
pub(super) struct ShowArgs {
    /// Number of the inspection
    pub(super) number: i64,
    /// Write one line of JSON, and nothing else, to standard output
    #[arg(long)]
    pub(super) json: bool,
    /// Inspect its frame again with the current recipe and library, and show what changed
    #[arg(long)]
    pub(super) again: bool,
    #[command(flatten)]
    library: LibraryChoice,
    #[command(flatten)]
    recipe: super::recipe::RecipeChoice,
    #[command(flatten)]
    pub(super) from: plant::FromChoice,
}

#[derive(Debug, Args)]
#[command(group(clap::ArgGroup::new("export").required(true).multiple(true).args(["csv", "cases"])))]
pub(super) struct ExportArgs {
    #[command(flatten)]
    pub(super) filter: FilterArgs,
    /// Write a table to this file, the oldest first
    #[arg(long, value_name = "FILE")]
    pub(super) csv: Option<PathBuf>,
    /// Write those with a kept frame and a true label as cases into this folder; those that are cases there already only
    /// get their present label
    #[arg(long, value_name = "DIR")]
    pub(super) cases: Option<PathBuf>,
    /// With --cases: use the accepted part where no true label is set
    #[arg(long, requires = "cases")]
    accepted_as_truth: bool,
    #[command(flatten)]
    pub(super) from: plant::FromChoice,
}

#[derive(Debug, Args)]
pub(super) struct KeepArgs {
    /// Inspections whose frames are kept
    #[arg(value_parser = choice(&KEPT))]
    keep: Option<KeepFrames>,
    /// Days after which frames are removed
    #[arg(long, value_name = "N", value_parser = days)]
    days: Option<u32>,
    /// Size beyond which the oldest frames are removed; those with a remark or a true label are kept
    #[arg(long, value_name = "N", value_parser = gigabytes)]
    gigabytes: Option<f64>,
}

fn days(text: &str) -> Result<u32, String> {
    let [least, most] = [Retention::DAYS.start(), Retention::DAYS.end()];
    let days = text
        .parse()
        .ok()
        .filter(|days| Retention::DAYS.contains(days));
    days.ok_or_else(|| format!("expected a number from {least} to {most}"))
}

fn gigabytes(text: &str) -> Result<f64, String> {
    within(text, &Retention::GIGABYTES)
}

#[rustfmt::skip]
const KEPT: [Choice<KeepFrames>; 3] = [
    ("all", "All inspections", KeepFrames::All),
    ("not-accepted", "Those that were not accepted and the newest 200 accepted ones", KeepFrames::NotAccepted),
    ("none", "None", KeepFrames::None),
];

pub(super) fn run(args: &HistoryArgs, console: &mut Console) -> anyhow::Result<Outcome> {
    if let Some(outcome) = plant::overview(&args.command, console)? {
        return Ok(outcome);
    }
    let folder = args.place.folder().advised()?;
    match &args.command {
        Command::List(asked) => list(&open_to_read(&folder, console)?, asked, console),
        Command::Show(asked) => show::run(&open_to_read(&folder, console)?, asked, console),
        Command::Export(asked) => export::run(&open_to_read(&folder, console)?, asked, console),
        Command::Drift(asked) => drift::run(&open_to_read(&folder, console)?, asked, console),
        Command::Remark { number, text } => {
            open(&folder, console)?
                .set_remark(*number, text)
                .advised()?;
            Ok(Outcome::Accepted)
        }
        Command::Label {
            number,
            part,
            library,
        } => {
            let label = match part.trim() {
                "" => {
                    return Err(advised_error(
                        "the label is empty",
                        "Give ? to remove the label, or none if nothing hung there",
                    ));
                }
                "?" => None,
                // Lists show the words of `Truth::name`.
                "-" | "not_enrolled" => Some(Truth::NotEnrolled),
                "none" | "nothing" => Some(Truth::Nothing),
                part => Some(Truth::Part(part.to_owned())),
            };
            open(&folder, console)?
                .set_label(*number, label.as_ref())
                .advised()?;
            if let Some(part) = label.as_ref().and_then(Truth::part) {
                note_if_unknown(part, library, console);
            }
            Ok(Outcome::Accepted)
        }
        Command::Runs(asked) => runs::list(&open_to_read(&folder, console)?, asked, console),
        Command::Run { number, json } => {
            runs::show(&open_to_read(&folder, console)?, *number, *json, console)
        }
        Command::Keep(asked) => keep(&mut open(&folder, console)?, asked, console),
        Command::Plant(command) => plant::history(command, &mut open(&folder, console)?, console),
    }
}

/// Warns about a name that is not enrolled: it may be right, but is more often mistyped.
fn note_if_unknown(part: &str, library: &LibraryChoice, console: &mut Console) {
    let Ok((place, load)) = library.load_placed(&ReferenceParams::default(), console) else {
        return;
    };
    let enrolled: BTreeSet<&str> = load
        .parts
        .iter()
        .map(|meta| meta.part_name().as_str())
        .collect();
    if !enrolled.contains(part) {
        let enrolled: Vec<&str> = enrolled.into_iter().collect();
        console.note(&format_args!(
            "no part in the library {} is named {part}; the label was set anyway; enrolled there: {}",
            place.location(),
            enrolled.join(", ")
        ));
    }
}

fn open_to_read(folder: &Path, console: &Console) -> anyhow::Result<History> {
    opened(folder, History::open_to_read(folder), console)
}

fn open(folder: &Path, console: &Console) -> anyhow::Result<History> {
    // A wrong path must not create a history.
    if !folder.join(FILE).is_file() {
        return open_to_read(folder, console);
    }
    opened(folder, History::open(folder), console)
}

fn opened(
    folder: &Path,
    opened: Result<records::history::OpenedHistory, HistoryError>,
    console: &Console,
) -> anyhow::Result<History> {
    let opened = opened.advised()?;
    if let Some(aside) = opened.set_aside {
        let file = folder.join(FILE);
        let file = file.display();
        console.note(&format_args!("warning: {file}: {}", aside.what));
        let place = aside.aside.display();
        console.advise(
            &format_args!("  it was set aside as {place}"),
            &format_args!(
                "If you have a copy with more inspections, restore {file} and the folder history-frames from it"
            ),
        );
    }
    if let Some(only_read) = opened.only_read {
        let lacks = if only_read.lacks_newest {
            ", and the newest inspections are missing"
        } else {
            ""
        };
        let error = &only_read.error;
        console.warn(
            &format_args!("{error}; it is opened for reading only{lacks}"),
            error,
        );
    }
    Ok(opened.history)
}

/// Formats a time in the local time zone.
pub(super) fn here(at: Timestamp) -> String {
    let at = at.to_zoned(TimeZone::system());
    at.strftime("%Y-%m-%d %H:%M:%S").to_string()
}

fn list(history: &History, asked: &ListArgs, console: &mut Console) -> anyhow::Result<Outcome> {
    let page = history
        .page(&asked.filter.filter(), 0, asked.most())
        .advised()?;
    let rows: Vec<CellRow<'_>> = page.rows.iter().map(|row| (None, row)).collect();
    show_rows(&rows, asked, console);
    if !asked.json {
        note_counts(&rows, [page.num_matching, page.num_all], asked, console);
    }
    Ok(Outcome::Accepted)
}

impl ListArgs {
    /// Returns the maximum number of rows.
    pub(super) fn most(&self) -> usize {
        if self.limit == 0 {
            i64::MAX as usize
        } else {
            self.limit
        }
    }
}

/// A row, and the name of its cell if there are several cells.
pub(super) type CellRow<'a> = (Option<&'a str>, &'a Summary);

pub(super) fn show_rows(rows: &[CellRow<'_>], asked: &ListArgs, console: &mut Console) {
    if asked.json {
        for (cell, row) in rows {
            console.line(&show::line_of(row, *cell));
        }
        return;
    }
    let mut heading = vec![
        "NUMBER", "TIME", "VERDICT", "PART", "SCORE", "AGAIN", "SCENE", "FRAME", "LABEL", "REMARK",
    ];
    let is_traced = |(_, row): &CellRow<'_>| row.trace.known().next().is_some();
    let has_traces = rows.iter().any(is_traced);
    if has_traces {
        heading.extend(["SERIAL", "ORDER", "OPERATOR"]);
    }
    let doubts = |row: &Summary| row.robot_marks().robot_doubts;
    let has_doubts = rows.iter().any(|(_, row)| !doubts(row).is_empty());
    if has_doubts {
        heading.push("NOT FOR ROBOTS");
    }
    let has_cells = rows.iter().any(|(cell, _)| cell.is_some());
    if has_cells {
        heading.insert(0, "CELL");
    }
    let mut table = Table::new(&heading);
    for (cell, row) in rows {
        let Traceability {
            serial,
            order,
            operator,
        } = row.trace.clone();
        let trace = has_traces.then_some([serial, order, operator]);
        let cell = cell.map(str::to_owned).into_iter();
        let trace = trace.into_iter().flatten();
        let doubts = has_doubts.then(|| doubts(row).join(", "));
        table.row(cell.chain(cells(row)).chain(trace).chain(doubts));
    }
    console.table(&table);
}

/// Notes how many rows are shown, how many match, and how many parts there are.
pub(super) fn note_counts(
    rows: &[CellRow<'_>],
    [num_matching, num_all]: [usize; 2],
    asked: &ListArgs,
    console: &Console,
) {
    let num = rows.len();
    console.note(&format_args!(
        "{num} of {num_matching} {} shown, {num_all} parts in all",
        if asked.filter.reinspections {
            "inspections"
        } else {
            "parts"
        },
    ));
}

fn cells(row: &Summary) -> [String; 10] {
    [
        row.number.to_string(),
        here(row.at),
        row.verdict.to_string().to_lowercase(),
        in_column(
            row.identification(),
            row.part.as_deref().unwrap_or(&row.title),
        ),
        row.score
            .map_or_else(|| "-".into(), |[score, _]| format!("{score:.2}")),
        match (row.parent, row.num_below) {
            (Some(parent), _) => format!("of {parent}"),
            (None, 0) => "-".into(),
            (None, num) => num.to_string(),
        },
        marked_simulated(&row.scene.to_string(), row.is_simulated),
        row.frame_bytes.map_or("-", |_| "kept").to_owned(),
        row.label.as_ref().map_or("-", Truth::name).to_owned(),
        row.remark.clone(),
    ]
}

fn keep(history: &mut History, asked: &KeepArgs, console: &mut Console) -> anyhow::Result<Outcome> {
    let before = history.retention().advised()?;
    let rule = Retention {
        keep: asked.keep.unwrap_or(before.keep),
        max_days: asked.days.unwrap_or(before.max_days),
        max_gigabytes: asked.gigabytes.unwrap_or(before.max_gigabytes),
    }
    .clamped();
    if rule != before {
        history.set_retention(&rule).advised()?;
        let swept = history.sweep(&rule, geometry::clock::now()).advised()?;
        if swept.num_frames > 0 {
            console.note(&format_args!("{} frames were removed", swept.num_frames));
        }
    }
    let usage = history.usage().advised()?;
    let gigabytes = |bytes: u64| bytes as f64 / 1e9;
    let kept = match rule.keep {
        KeepFrames::NotAccepted => {
            format!("not accepted, and the newest {ACCEPTED_KEPT} accepted")
        }
        keep => keep.to_string().to_lowercase(),
    };
    console.line(&format_args!(
        "frames kept: {kept}, at most {} days and {} GB",
        rule.max_days, rule.max_gigabytes
    ));
    console.line(&format_args!(
        "now: {} frames, {:.3} GB, of which {:.3} GB stay because of a remark or a true label",
        usage.num_frames,
        gigabytes(usage.num_bytes),
        gigabytes(usage.num_bytes_marked)
    ));
    Ok(Outcome::Accepted)
}
