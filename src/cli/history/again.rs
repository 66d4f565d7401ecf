//! `partsight history show --again`: inspects a kept frame with the current recipe and library.

use serde::Serialize;

use super::ShowArgs;
use crate::cli::console::{Advised as _, Console, Table, advised_error};
use geometry::units::{Metres, Radians};
use inspection::pipeline::{Unwatched, run_all, scan::run_scan};
use records::history::{Differences, History, InspectionSummary, ParameterChange, Record};
use stages::scan::{ScanParams, assemble};

pub(super) fn run(
    history: &History,
    record: &Record,
    asked: &ShowArgs,
    console: &mut Console,
) -> anyhow::Result<Differences> {
    let scene = history.scene(record).advised()?;
    let shots = history.shots(record).advised()?;
    let Some(scene) = scene else {
        return Err(advised_error(
            format!("the frame of inspection {} is not kept", asked.number),
            "Keep more frames from now on: partsight history keep all",
        ));
    };
    let recipe = record.detail.again_with(&asked.recipe.recipe()?);
    let load = (asked.library).load_some(&recipe.reference_params(), console)?;
    let library = &load.library;
    let before = InspectionSummary::from(record);
    let inspection = match shots {
        None => {
            let mut found = run_all(&scene, library, &recipe, &Unwatched)?;
            found.swap_remove(before.index_in(found.iter()))
        }
        Some(shots) => {
            let params = ScanParams {
                segment: recipe.segment.clone(),
                ..ScanParams::default()
            };
            let scan = assemble(&shots, &params, &Unwatched).advised()?;
            run_scan(&scan, library, &recipe, &Unwatched)?.inspection
        }
    };
    let now = InspectionSummary::of(&inspection, &recipe.parameters, &load.identity());
    Ok(Differences::between(
        before,
        now,
        inspection.middle(library),
    ))
}

/// Changes, as `--json` writes them.
#[derive(Debug, Serialize)]
pub(super) struct AgainLine {
    same: bool,
    verdict: &'static str,
    nearest: Option<String>,
    score: Option<f64>,
    margin: Option<f64>,
    pose_shift_m: Option<f64>,
    pose_turn_rad: Option<f64>,
    changed: Vec<&'static str>,
    parameters: Vec<ParameterLine>,
}

/// A changed parameter, as `--json` writes it.
#[derive(Debug, Serialize)]
struct ParameterLine {
    key: &'static str,
    before: String,
    now: String,
}

impl AgainLine {
    pub(super) fn of(found: &Differences) -> Self {
        let now = &found.now;
        let parameters = found.changed_parameters().into_iter();
        let line = |change: ParameterChange| ParameterLine {
            key: change.key,
            before: change.before,
            now: change.now,
        };
        Self {
            same: found.is_same(),
            verdict: now.verdict.name(),
            nearest: now.nearest.clone(),
            score: now.score.map(|[score, _]| score),
            margin: now.score.map(|[_, margin]| margin),
            pose_shift_m: found.pose.map(|off| off.shift.0),
            pose_turn_rad: found.pose.map(|off| off.rotation.0),
            changed: found.changed_inputs(),
            parameters: parameters.map(line).collect(),
        }
    }
}

/// Shows both inspections in a table with these headings.
pub(super) fn show(found: &Differences, names: [&str; 2], console: &mut Console) {
    let Differences { before, now, pose } = found;
    let mut table = Table::new(&["", names[0], names[1]]);
    let mut row = |what: &str, of: &dyn Fn(&InspectionSummary) -> String| {
        let (then, today) = (of(before), of(now));
        let sign = if then == today { "" } else { "changed" };
        table.row([what.to_owned(), then, today, sign.to_owned()]);
    };
    row("verdict", &|of| of.verdict.to_string().to_lowercase());
    row("best guess", &|of| {
        of.nearest.clone().unwrap_or_else(|| "-".into())
    });
    row("score", &|of| {
        of.score
            .map_or_else(|| "-".into(), |[score, _]| format!("{score:.3}"))
    });
    row("margin", &|of| {
        of.score
            .map_or_else(|| "-".into(), |[_, margin]| format!("{margin:.3}"))
    });
    row("recipe", &|of| of.recipe.clone());
    row("library", &|of| of.library.clone());
    row("program", &|of| of.program.clone());
    for change in found.changed_parameters() {
        let ParameterChange {
            key, before, now, ..
        } = change;
        table.row([key.to_owned(), before, now, "changed".to_owned()]);
    }
    console.table(&table);
    if let Some(off) = pose {
        let (Metres(shift), Radians(turn)) = (off.shift, off.rotation);
        console.line(&format_args!(
            "The pose differs by {:.3} mm at the part's middle and {:.4} degrees.",
            shift * 1e3,
            turn.to_degrees()
        ));
    }
    if found.is_same() {
        console.line(&"Nothing changed.");
    }
}
