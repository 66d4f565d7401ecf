//! `partsight history show`: shows everything about one inspection.

use std::path::Path;

use serde::Serialize;
use serde_json::Value;

use super::{ShowArgs, again, here};
use crate::cli::{
    Outcome,
    console::{Advised as _, Console, Table, in_columns, marked_simulated},
};
use inspection::{
    library::Truth,
    pipeline::{ExpectedPart, RefusalKind},
};
use records::history::{
    Differences, FrameLoss, FrameRecord, History, InspectionDetail, InspectionSummary, Record,
    Summary, Traceability,
};
use texts::Language;

/// Version of the JSON lines.
pub(super) const SCHEMA: u32 = 1;

/// A row as `--json` writes it.
#[derive(Debug, Serialize)]
struct RowLine<'a> {
    schema: u32,
    number: i64,
    at: String,
    scene: String,
    source: &'a str,
    simulated: bool,
    verdict: &'static str,
    part: Option<&'a str>,
    score: Option<f64>,
    margin: Option<f64>,
    total_ms: f64,
    label: Option<&'a str>,
    remark: &'a str,
    frame_kept: bool,
    /// Number of the inspection that stands for the same part; null if this one does.
    parent: Option<i64>,
    /// Number of re-inspections below this one.
    reinspections: usize,
    /// Title of the part of which it is the mirror image; null if it is none.
    mirror_of: Option<&'a str>,
    /// Why a robot must not act on the pose.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    robot_doubts: Vec<String>,
    /// `serial`, `order` and `operator`, as far as known.
    #[serde(flatten)]
    trace: &'a Traceability,
    /// Name of the rack, if it hung in one that has a name.
    #[serde(skip_serializing_if = "Option::is_none")]
    rack: Option<&'a str>,
    /// Name of the cell, if there are several cells.
    #[serde(skip_serializing_if = "Option::is_none")]
    cell: Option<&'a str>,
}

impl<'a> RowLine<'a> {
    fn of(row: &'a Summary, cell: Option<&'a str>) -> Self {
        Self {
            schema: SCHEMA,
            number: row.number,
            at: row.at.to_string(),
            scene: row.scene.to_string(),
            source: &row.source,
            simulated: row.is_simulated,
            verdict: row.verdict.name(),
            part: row.part.as_deref(),
            score: row.score.map(|[score, _]| score),
            margin: row.score.map(|[_, margin]| margin),
            total_ms: row.total_ms,
            label: row.label.as_ref().map(Truth::name),
            remark: &row.remark,
            frame_kept: row.frame_bytes.is_some(),
            parent: row.parent,
            reinspections: row.num_below,
            mirror_of: row.mirror_of(),
            robot_doubts: row.robot_marks().robot_doubts,
            trace: &row.trace,
            rack: row.rack.as_deref(),
            cell,
        }
    }
}

/// Returns a row as one line of JSON, with the name of its cell if there are several.
pub(super) fn line_of(row: &Summary, cell: Option<&str>) -> String {
    json(&RowLine::of(row, cell))
}

fn json(line: &impl Serialize) -> String {
    serde_json::to_string(line).expect("numbers and text have a JSON form")
}

/// An inspection as `--json` writes it.
#[derive(Serialize)]
struct RecordLine<'a> {
    #[serde(flatten)]
    row: RowLine<'a>,
    nearest: Option<&'a str>,
    reason: Option<String>,
    reason_kind: Option<&'a RefusalKind>,
    advice: Option<String>,
    camera_from_part: Option<[f64; 16]>,
    #[serde(flatten)]
    used: UsedLine<'a>,
    frame: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    frame_loss: Option<FrameLoss>,
    /// Files of a scan's shots.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    shots: Vec<String>,
    /// Re-inspections of the same part, oldest first, each compared with this one.
    below: Vec<BelowLine<'a>>,
    /// The line written at the inspection.
    #[serde(skip_serializing_if = "Option::is_none")]
    line: Option<Value>,
    #[serde(skip_serializing_if = "Option::is_none")]
    again: Option<again::AgainLine>,
}

/// A re-inspection of the same part, as `--json` writes it.
#[derive(Serialize)]
struct BelowLine<'a> {
    #[serde(flatten)]
    row: RowLine<'a>,
    #[serde(flatten)]
    used: UsedLine<'a>,
    differs: again::AgainLine,
}

/// Recipe, library and program of an inspection, as `--json` writes them.
#[derive(Serialize)]
struct UsedLine<'a> {
    recipe: &'a str,
    recipe_name: &'a str,
    recipe_changed: bool,
    library: &'a str,
    program: &'a str,
}

impl<'a> UsedLine<'a> {
    fn of(detail: &'a InspectionDetail) -> Self {
        Self {
            recipe: &detail.recipe_identity,
            recipe_name: &detail.recipe_label.name,
            recipe_changed: detail.recipe_label.is_changed,
            library: &detail.library_identity,
            program: &detail.program,
        }
    }
}

/// Compares an inspection with another one of the same part.
fn differences(record: &Record, other: &Record) -> Differences {
    Differences::between(
        InspectionSummary::from(record),
        InspectionSummary::from(other),
        None,
    )
}

/// Where an inspection was read.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ReadFrom<'a> {
    /// Name of the cell, in the plant's database.
    pub(crate) cell: Option<&'a str>,
    /// Folder of the kept frames; `None` in the plant's database, as they stay at their cell.
    pub(crate) frames: Option<&'a Path>,
}

impl ReadFrom<'_> {
    fn path(self, frame: &FrameRecord) -> Option<String> {
        let path = self.frames?.join(&frame.file);
        Some(path.display().to_string())
    }
}

pub(super) fn run(
    history: &History,
    asked: &ShowArgs,
    console: &mut Console,
) -> anyhow::Result<Outcome> {
    let record = history.known(asked.number).advised()?;
    let again = asked
        .again
        .then(|| again::run(history, &record, asked, console))
        .transpose()?;
    let below = history.below(asked.number).advised()?;
    let from = ReadFrom {
        cell: None,
        frames: Some(history.frames_folder()),
    };
    if asked.json {
        console.line(&record_line(from, &record, &below, again.as_ref()));
        return Ok(Outcome::Accepted);
    }
    card(from, &record, &below, console);
    if let Some(differences) = &again {
        console.line(&"");
        again::show(differences, ["THEN", "TODAY"], console);
    }
    Ok(Outcome::Accepted)
}

/// Returns an inspection with the re-inspections below it as one line of JSON.
pub(crate) fn record_line(
    from: ReadFrom<'_>,
    record: &Record,
    below: &[Record],
    again: Option<&Differences>,
) -> String {
    let below = below.iter().map(|other| BelowLine {
        row: RowLine::of(&other.summary, None),
        used: UsedLine::of(&other.detail),
        differs: again::AgainLine::of(&differences(record, other)),
    });
    let detail = &record.detail;
    let refusal = record.titled_refusal(str::to_owned);
    let frame = detail.frame.as_ref();
    json(&RecordLine {
        row: RowLine::of(&record.summary, from.cell),
        nearest: detail.nearest.as_deref(),
        reason: refusal.as_ref().map(|why| why.text(Language::English)),
        reason_kind: record.summary.reason.as_ref(),
        advice: refusal.map(|why| why.command_advice()),
        camera_from_part: record.matrix(),
        used: UsedLine::of(detail),
        frame: frame.and_then(|frame| from.path(frame)),
        frame_loss: detail.frame_loss,
        shots: shot_paths(from, record),
        below: below.collect(),
        line: serde_json::from_str(&detail.line).ok(),
        again: again.map(again::AgainLine::of),
    })
}

fn shot_paths(from: ReadFrom<'_>, record: &Record) -> Vec<String> {
    let frame = record.detail.frame.as_ref();
    let shots = frame.map_or(&[][..], |frame| &frame.shots);
    let paths = shots.iter().filter_map(|shot| from.path(&shot.frame));
    paths.collect()
}

/// Shows an inspection, and how the re-inspections below it differ.
pub(crate) fn card(from: ReadFrom<'_>, record: &Record, below: &[Record], console: &mut Console) {
    console.table(&record_table(from, record));
    let number = |record: &Record| format!("NUMBER {}", record.summary.number);
    for other in below {
        console.line(&"");
        console.line(&format_args!(
            "The same part was inspected again at {}.",
            here(other.summary.at)
        ));
        let names = [number(record), number(other)];
        let names = [&*names[0], &*names[1]];
        again::show(&differences(record, other), names, console);
    }
}

fn record_table(from: ReadFrom<'_>, record: &Record) -> Table {
    let Record { summary, detail } = record;
    let mut table = Table::default();
    let mut row = |what: &str, text: String| {
        if !text.is_empty() {
            table.row([what.to_owned(), text]);
        }
    };
    row("inspection", summary.number.to_string());
    row("cell", from.cell.unwrap_or_default().to_owned());
    row(
        "time",
        format!("{} local time, {} UTC", here(summary.at), summary.at),
    );
    row(
        "scene",
        marked_simulated(&summary.scene.to_string(), summary.is_simulated),
    );
    row("source", summary.source.clone());
    for (name, text) in summary.trace.known() {
        row(name, text.to_owned());
    }
    row("verdict", summary.verdict.to_string().to_lowercase());
    if let Some(part) = &detail.nearest {
        row("part", summary.identification().in_english(part));
    }
    row("place", detail.place().unwrap_or_default());
    row("rack", summary.rack.clone().unwrap_or_default());
    let words = |parts: &[ExpectedPart]| {
        let parts = parts.iter().map(ToString::to_string);
        parts.collect::<Vec<_>>().join(", ")
    };
    row("expected", words(detail.expected().parts()));
    row("missing", words(&detail.missing().unwrap_or_default()));
    if let Some([score, margin]) = summary.score {
        row("score", format!("{score:.3}, margin {margin:.3}"));
    }
    if let Some(why) = record.titled_refusal(str::to_owned) {
        row("why not", why.text(Language::English));
        row("to do", why.command_advice());
    } else if let Some(kind) = &summary.reason {
        row("why not", kind.to_string());
    }
    if let Some(numbers) = record.matrix() {
        for (i, line) in numbers.chunks(4).enumerate() {
            let name = if i == 0 { "camera_from_part, m" } else { "" };
            row(name, in_columns(line));
        }
    }
    let marks = summary.robot_marks();
    if let Some(doubts) = marks.past_doubts(Language::English) {
        row("robot", doubts);
    }
    if marks.motion_checked == Some(false) {
        row(
            "motion",
            "no other frame shows whether the part hung still".into(),
        );
    }
    let times = record.timings().into_iter();
    let times: Vec<String> = times
        .map(|(stage, ms)| format!("{stage} {ms:.1}"))
        .collect();
    row("times, ms", times.join("  "));
    row("recipe", detail.recipe_text());
    row("library", detail.library_identity.clone());
    row("program", detail.program.clone());
    row(
        "true label",
        summary.label.as_ref().map_or("", Truth::name).to_owned(),
    );
    row("remark", summary.remark.clone());
    let frame = match (&detail.frame, detail.frame_loss) {
        (Some(frame), _) => from
            .path(frame)
            .unwrap_or_else(|| "kept at the cell".into()),
        (None, Some(why)) => format!("not kept: {why}"),
        (None, None) => "not kept".into(),
    };
    row("frame", frame);
    for shot in shot_paths(from, record) {
        row("shot", shot);
    }
    if let Some(parent) = summary.parent {
        row("of a part", format!("inspection {parent} stands for it"));
    }
    table
}
