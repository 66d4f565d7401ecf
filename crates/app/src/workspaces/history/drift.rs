//! Drift of score, fit and position of one part over time: mean, spread, limits and trend.

use egui::{Label, Ui};
use egui_plot::LineStyle;
use jiff::{Zoned, tz::TimeZone};

use geometry::statistics::lower_median;
use records::history::{DriftQuantity, PartDrift, QuantityDrift};
use shell::language::{UnitSystem, drift_quantity, drift_value};
use ui::{
    language::text,
    plot::{Level, OverTime},
    theme::Theme,
    widgets::heading,
};

/// Above this number, inspections are drawn in groups by their medians.
const MOST_DRAWN: usize = 240;

/// The accepted inspections of one part, or groups of them, oldest first.
#[derive(Clone, Debug, PartialEq)]
pub struct Drift {
    /// The part's title.
    pub title: String,
    /// Number of inspections.
    pub num_parts: usize,
    /// Time of the first inspection of each group.
    at: Vec<Zoned>,
    /// Each known quantity, with the median of each group; NaN where none is known.
    drawn: Vec<(QuantityDrift, Vec<f32>)>,
}

impl Drift {
    pub(super) fn new(title: String, found: PartDrift, zone: &TimeZone) -> Self {
        let num_parts = found.at.len();
        let size = num_parts.div_ceil(MOST_DRAWN).max(1);
        let first = found.at.iter().step_by(size);
        let median = |group: &[f64]| {
            let known = group.iter().copied().filter(|value| value.is_finite());
            lower_median(known).map_or(f32::NAN, |value| value as f32)
        };
        Self {
            title,
            num_parts,
            at: first.map(|at| at.to_zoned(zone.clone())).collect(),
            drawn: found
                .quantities
                .into_iter()
                .map(|of| {
                    let medians = of.values.chunks(size).map(median).collect();
                    (of, medians)
                })
                .collect(),
        }
    }
}

/// Draws score, bound, fit and position one below the other, and the trends.
pub(super) fn ui(ui: &mut Ui, drift: &Drift, units: UnitSystem) {
    heading(ui, &text!("history-drift", part = drift.title.as_str()));
    let mut of_place = Vec::new();
    for (of, medians) in &drift.drawn {
        match of.quantity {
            DriftQuantity::Score => alone(ui, drift, (of, medians), units, [0.1, 1.0]),
            DriftQuantity::ShiftBoundM | DriftQuantity::RmsM => {
                alone(ui, drift, (of, medians), units, [0.002, f64::INFINITY]);
            }
            DriftQuantity::XM | DriftQuantity::YM | DriftQuantity::ZM => {
                of_place.push((of, medians.as_slice()));
            }
        }
    }
    if let [x, y, z] = of_place[..] {
        place(ui, drift, [x, y, z], units);
    }
    for (of, _) in &drift.drawn {
        let Some(trend) = of.trend else { continue };
        let text = text!(
            "history-drift-trend",
            name = drift_quantity(of.quantity),
            from = drift_value(of.quantity, trend.from, units),
            to = drift_value(of.quantity, trend.to, units),
            count = trend.over
        );
        ui.add(Label::new(text).wrap());
    }
}

/// Draws one quantity with its mean, spread and limit. The axis spans the first at least, and ends at the second at most.
fn alone(
    ui: &mut Ui,
    drift: &Drift,
    (of, medians): (&QuantityDrift, &[f32]),
    units: UnitSystem,
    [least_span, most]: [f64; 2],
) {
    let theme = Theme::of(ui);
    let written = |value: f64| drift_value(of.quantity, value, units);
    let [low, high] = of.band;
    let name = drift_quantity(of.quantity);
    let [mean, from, to] = [of.mean, low, high].map(written);
    let title = match of.limit {
        Some(limit) => text!(
            "history-drift-band-limit",
            name = name,
            mean = mean,
            from = from,
            to = to,
            limit = written(limit.value())
        ),
        None => text!(
            "history-drift-band",
            name = name,
            mean = mean,
            from = from,
            to = to
        ),
    };
    let [mean, limit] = [text!("history-drift-mean"), text!("history-drift-limit")];
    let dotted = LineStyle::Dotted { spacing: 4.0 };
    let dashed = LineStyle::Dashed { length: 6.0 };
    let mut levels: Vec<Level<'_>> = vec![
        (mean.as_str(), of.mean, theme.weak_text, LineStyle::Solid),
        ("3σ", high, theme.weak_text, dotted),
        ("", low, theme.weak_text, dotted),
    ];
    levels.extend(
        of.limit
            .map(|of| (limit.as_str(), of.value(), theme.rejected, dashed)),
    );
    let plot = OverTime {
        title: &title,
        at: &drift.at,
        curves: &[("", medians, theme.first_series)],
        levels: &levels,
        written: &written,
        least_span,
        most,
    };
    plot.show(ui);
}

/// Draws the position along the camera's axes.
fn place(ui: &mut Ui, drift: &Drift, axes: [(&QuantityDrift, &[f32]); 3], units: UnitSystem) {
    let theme = Theme::of(ui);
    let [x, y, z] = axes.map(|(of, _)| {
        let mean = units.signed_length(of.mean);
        let spread = units.length(of.band[1] - of.mean);
        format!("{mean} ± {spread}")
    });
    let title = text!("history-drift-place", x = x, y = y, z = z);
    let [x, y, z] = axes.map(|(_, medians)| medians);
    let curves = [
        ("x", x, theme.first_series),
        ("y", y, theme.second_series),
        ("z", z, theme.reference_series),
    ];
    let plot = OverTime {
        title: &title,
        at: &drift.at,
        curves: &curves,
        levels: &[],
        written: &|value| units.signed_length(value),
        least_span: 0.02,
        most: f64::INFINITY,
    };
    plot.show(ui);
}

#[cfg(test)]
mod tests {
    use jiff::{SignedDuration, Timestamp};

    use super::*;

    #[test]
    fn many_inspections_are_drawn_in_groups_by_the_medians_of_what_is_known() {
        let num = 1000;
        let known = |index: usize| {
            if index % 7 == 3 {
                f64::NAN
            } else {
                index as f64
            }
        };
        let of = QuantityDrift {
            quantity: DriftQuantity::RmsM,
            values: (0..num).map(known).collect(),
            mean: 0.0,
            band: [0.0; 2],
            limit: None,
            trend: None,
        };
        let minutes = |index: i64| Timestamp::UNIX_EPOCH + SignedDuration::from_mins(index);
        let found = PartDrift {
            at: (0..num as i64).map(minutes).collect(),
            quantities: vec![of],
        };
        let drift = Drift::new("Door".into(), found, &TimeZone::UTC);
        assert_eq!((drift.num_parts, drift.at.len()), (num, 200));
        let (_, medians) = &drift.drawn[0];
        // Of 0, 1, 2 and 4, and of 5 to 9.
        assert_eq!((medians[0], medians[1]), (1.0, 7.0));
        assert_eq!(drift.at[1].minute(), 5);
    }
}
