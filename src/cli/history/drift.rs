//! `partsight history drift`: mean, spread and trend of parts, and which will be refused.

use clap::Args;
use serde::Serialize;

use super::{FilterArgs, show::SCHEMA};
use crate::cli::{
    LibraryChoice, Outcome,
    console::{Advised as _, Console, Table},
    plant,
};
use geometry::units::Metres;
use records::history::{
    DriftQuantity, Filter, History, LEAST_FOR_SPREAD, Limit, MAX_POSES, PartDrift, PoseRecord,
    QuantityDrift, Trend, accepted_parts,
};
use stages::reference::ReferenceParams;

/// Which inspections, and how they are shown.
#[derive(Debug, Args)]
pub(in crate::cli) struct DriftArgs {
    #[command(flatten)]
    pub(in crate::cli) filter: FilterArgs,
    /// Write one line of JSON per part, and nothing else, to standard output
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    library: LibraryChoice,
    #[command(flatten)]
    pub(in crate::cli) from: plant::FromChoice,
}

/// A part as `--json` writes it.
#[derive(Serialize)]
struct PartLine<'a> {
    schema: u32,
    part: &'a str,
    /// Number of inspections that were compared.
    inspections: usize,
    quantities: Vec<QuantityLine>,
    /// Name of the cell, if there are several cells.
    #[serde(skip_serializing_if = "Option::is_none")]
    cell: Option<&'a str>,
}

#[derive(Serialize)]
struct QuantityLine {
    quantity: DriftQuantity,
    mean: f64,
    /// Three standard deviations below and above the mean.
    low: f64,
    high: f64,
    /// Beyond this, parts are refused; null if they are not.
    limit: Option<f64>,
    /// Null if noise explains what changes.
    trend: Option<Trend>,
}

impl QuantityLine {
    fn of(of: &QuantityDrift) -> Self {
        let [low, high] = of.band;
        Self {
            quantity: of.quantity,
            mean: of.mean,
            low,
            high,
            limit: of.limit.map(Limit::value),
            trend: of.trend,
        }
    }
}

/// The accepted inspections of a part.
pub(in crate::cli) struct PartPoses {
    /// Name of the cell, if there are several cells.
    pub(in crate::cli) cell: Option<String>,
    /// Name of the part.
    pub(in crate::cli) part: String,
    /// The oldest first.
    pub(in crate::cli) poses: Vec<PoseRecord>,
}

impl PartPoses {
    /// Name of the part for a person.
    fn name(&self) -> String {
        match &self.cell {
            Some(cell) => format!("{} at {cell}", self.part),
            None => self.part.clone(),
        }
    }
}

pub(super) fn run(
    history: &History,
    asked: &DriftArgs,
    console: &mut Console,
) -> anyhow::Result<Outcome> {
    let filter = asked.filter.filter();
    let mut all = Vec::new();
    for (part, _) in accepted_parts(&history.outcomes(&filter).advised()?) {
        let of_part = Filter {
            part: Some(part.clone()),
            ..filter.clone()
        };
        let poses = history.poses(&of_part, MAX_POSES).advised()?;
        all.push(PartPoses {
            cell: None,
            part,
            poses,
        });
    }
    Ok(answer(&all, asked, console))
}

/// Shows the drift of these parts.
pub(in crate::cli) fn answer(
    all: &[PartPoses],
    asked: &DriftArgs,
    console: &mut Console,
) -> Outcome {
    // Without its references the position of a part is not known, and the rest is.
    let library = match asked.library.load(&ReferenceParams::default(), console) {
        Ok((_, load)) => Some(load.library),
        Err(error) => {
            console.error(&error);
            console.note(&"the position of the parts is left out");
            None
        }
    };
    let middle_of = |name: &str| library.as_ref()?.middle_of(name);
    let found = all
        .iter()
        .filter_map(|of| Some((of, PartDrift::of(&of.poses, middle_of)?)));
    let found: Vec<(&PartPoses, PartDrift)> = found.collect();
    if asked.json {
        for (of, drift) in &found {
            console.line(&line_of(of, drift));
        }
    } else {
        show(&found, console);
    }
    let warned = found.iter().any(|(_, drift)| drift.warning().is_some());
    Outcome::accepted_if(!warned)
}

fn line_of(of: &PartPoses, drift: &PartDrift) -> String {
    let line = PartLine {
        schema: SCHEMA,
        part: &of.part,
        inspections: drift.at.len(),
        quantities: drift.quantities.iter().map(QuantityLine::of).collect(),
        cell: of.cell.as_deref(),
    };
    serde_json::to_string(&line).expect("numbers and text have a JSON form")
}

fn show(found: &[(&PartPoses, PartDrift)], console: &mut Console) {
    let mut table = Table::new(&[
        "PART", "QUANTITY", "NUMBER", "MEAN", "3σ FROM", "TO", "LIMIT", "TREND",
    ]);
    for (part, drift) in found {
        let name = part.name();
        for of in &drift.quantities {
            let written = |value: f64| written(of.quantity, value);
            let [low, high] = of.band;
            let limit = of.limit.map(|limit| written(limit.value()));
            let trend = of.trend.map(|trend| {
                let Trend { from, to, over, .. } = trend;
                format!("{} to {} in {over}", written(from), written(to))
            });
            table.row([
                name.clone(),
                title(of.quantity).to_owned(),
                drift.at.len().to_string(),
                written(of.mean),
                written(low),
                written(high),
                limit.unwrap_or_default(),
                trend.unwrap_or_default(),
            ]);
        }
    }
    console.table(&table);
    if found.is_empty() {
        console.note(&format_args!(
            "no part was accepted at least {LEAST_FOR_SPREAD} times"
        ));
    }
    for (part, drift) in found {
        let Some(warning) = drift.warning() else {
            continue;
        };
        console.advise(
            &format_args!(
                "warning: {} drifts: at this trend, single parts are refused after {} more inspections ({}, limit {})",
                part.name(),
                warning.refuses_in,
                title(warning.quantity),
                written(warning.quantity, warning.limit)
            ),
            &"Look for the cause before: clean the window of the camera, then check the cell (partsight cell check), the \
              hangers and the parts",
        );
    }
}

fn title(quantity: DriftQuantity) -> &'static str {
    match quantity {
        DriftQuantity::Score => "score",
        DriftQuantity::ShiftBoundM => "bound of position error",
        DriftQuantity::RmsM => "rms",
        DriftQuantity::XM => "x",
        DriftQuantity::YM => "y",
        DriftQuantity::ZM => "z",
    }
}

fn written(quantity: DriftQuantity, value: f64) -> String {
    match quantity {
        DriftQuantity::Score => format!("{value:.3}"),
        DriftQuantity::ShiftBoundM
        | DriftQuantity::RmsM
        | DriftQuantity::XM
        | DriftQuantity::YM
        | DriftQuantity::ZM => format!("{:.2} mm", Metres(value).mm()),
    }
}
