//! Plots of scores: calibration, and trade-off of the threshold.

use image::Rgb;

use super::{
    canvas::Canvas,
    chart::{Axis, Chart, DIM_TEXT, Division, LETTERS},
    lettering::Anchor,
    pictures::{DIM, LIGHT, OPENING, PART},
};
use crate::cases::{Calibration, ThresholdCounts, TradeOff};

/// Side of a plot, pixels.
pub(super) const PLOT: f64 = 400.0;
/// Dashes and gaps of the second curve, pixels.
const DASHES: [f64; 2] = [9.0, 6.0];

/// Creates a chart whose axes both go from 0 to 1.
fn unit_chart([left, top]: [f64; 2], [across, up]: [&str; 2]) -> Chart<'_> {
    let fifths = || (0..=5).map(|i| f64::from(i) / 5.0);
    let axis = |title| Axis {
        title,
        range: [0.0, 1.0],
        division: Division::Even,
        ticks: fifths().map(|v| (v, format!("{v:.1}"))).collect(),
    };
    Chart {
        corners: [[left, top], [left + PLOT, top + PLOT]],
        across: axis(across),
        up: axis(up),
    }
}

/// Draws a dot per bin with its number of guesses; on the diagonal the score equals the share of right guesses.
pub(super) fn draw_calibration(
    canvas: &mut Canvas,
    calibration: &Calibration,
    [left, top]: [f64; 2],
) {
    let chart = unit_chart(
        [left, top],
        ["score of the best guess", "share of right guesses"],
    );
    chart.draw_axes(canvas);
    canvas.line(chart.place([0.0, 0.0]), chart.place([1.0, 1.0]), DIM);
    let bins = calibration.bins.iter();
    let bins =
        bins.filter_map(|bin| Some((bin.num, chart.place([bin.mean_score, bin.share_right()?]))));
    let bins: Vec<(usize, [f64; 2])> = bins.collect();
    canvas.polyline(bins.iter().map(|(_, at)| *at), (1.0, &[]), PART);
    for (num, at) in bins {
        canvas.dot(at, 5.0, PART);
        // Above the dot, since the tick labels are below the lowest ones.
        let above = [at[0], at[1] - 12.0];
        canvas.write(&num.to_string(), LETTERS, above, Anchor::Middle, LIGHT);
    }
    let words = calibration.expected_error.map_or_else(
        || "no guess, no calibration".to_owned(),
        |error| format!("expected calibration error {error:.3}; numbers are guesses"),
    );
    let at = [left, top + PLOT + 74.0];
    canvas.write(&words, LETTERS, at, Anchor::Left, DIM_TEXT);
}

/// Draws for every threshold the shares of false accepts and of refused parts, by the score alone.
pub(super) fn draw_trade_off(
    canvas: &mut Canvas,
    trade_off: &TradeOff,
    threshold: f64,
    [left, top]: [f64; 2],
) {
    let TradeOff {
        num_cases,
        num_enrolled,
        steps,
    } = trade_off;
    let chart = unit_chart([left, top], ["least score", "share"]);
    chart.draw_axes(canvas);
    let ends = [0.0, 1.0].map(|share| chart.place([threshold, share]));
    canvas.line(ends[0], ends[1], DIM);
    let share = |num: usize, of: usize| num as f64 / of.max(1) as f64;
    let curve = |height: &dyn Fn(&ThresholdCounts) -> f64| -> Vec<[f64; 2]> {
        let at = |step: &ThresholdCounts| chart.place([step.threshold, height(step)]);
        steps.iter().map(at).collect()
    };
    let refused = curve(&|step| share(step.num_refused, *num_enrolled));
    let wrong = curve(&|step| share(step.num_wrong_accepted, *num_cases));
    let looks: [(&str, &[f64], Rgb<u8>); 2] = [
        ("false accepts, of all cases", &[], PART),
        ("refused, of the enrolled parts", &DASHES, OPENING),
    ];
    for (row, ((words, pattern, colour), curve)) in
        (0..).zip(looks.into_iter().zip([wrong, refused]))
    {
        canvas.polyline(curve, (2.0, pattern), colour);
        let y = top - 30.0 + 20.0 * f64::from(row);
        let sample = [[left, y - 5.0], [left + 40.0, y - 5.0]];
        canvas.polyline(sample, (2.0, pattern), colour);
        let at = [left + 50.0, y];
        canvas.write(words, LETTERS, at, Anchor::Left, LIGHT);
    }
    let words = format!("the upright line is the threshold of {threshold:.2}");
    let at = [left, top + PLOT + 74.0];
    canvas.write(&words, LETTERS, at, Anchor::Left, DIM_TEXT);
}
