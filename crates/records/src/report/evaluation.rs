//! Picture of an evaluation: confusion matrix, calibration, and trade-off of the score threshold.

use image::{Rgb, RgbImage};

use super::{
    canvas::Canvas,
    chart::{Axis, Chart, DIM_TEXT, Division, LETTERS},
    lettering::{Anchor, Lettering, REGULAR},
    pictures::{DARK, DIM, FAINT, LIGHT, OPENING, PART},
};
use crate::cases::{
    Calibration, CaseAnswer, CaseOutcome, Confusion, Evaluation, ThresholdCounts, TradeOff, Truth,
};

/// Side of a cell of the matrix, pixels.
const CELL: f64 = 46.0;
/// Side of a plot, pixels.
const PLOT: f64 = 400.0;
/// Dashes and gaps of the second curve, pixels.
const DASHES: [f64; 2] = [9.0, 6.0];
/// Gap between two plots, for tick labels and title of an axis.
const GAP: f64 = 120.0;
/// Outer margin, pixels.
const EDGE: f64 = 28.0;

/// Draws the three plots side by side under `title`; `threshold` is the minimum score of the recipe.
pub fn evaluation_picture(title: &str, evaluation: &Evaluation, threshold: f64) -> RgbImage {
    let letters = Lettering::of(REGULAR);
    let confusion = &evaluation.confusion;
    let widest = |names: &mut dyn Iterator<Item = &str>| {
        names
            .map(|name| letters.width(name, LETTERS))
            .fold(60.0, f32::max)
    };
    let names = f64::from(widest(&mut confusion.rows.iter().map(row_name))) + 12.0;
    let head = f64::from(widest(&mut confusion.columns.iter().map(column_name))) + 12.0;
    let matrix = [
        CELL * confusion.columns.len() as f64,
        CELL * confusion.rows.len() as f64,
    ];
    let left = EDGE + names;
    let top = EDGE + 64.0 + head;
    let plot_left = (left + matrix[0]).max(EDGE + 330.0) + GAP;
    let plot_top = EDGE + 84.0;
    let width = plot_left + 2.0 * PLOT + GAP + 2.0 * EDGE;
    let height = (top + matrix[1] + 100.0).max(plot_top + PLOT + 110.0);
    let mut canvas = Canvas::new(width as usize, height as usize, DARK);
    canvas.write(title, 20.0, [EDGE, EDGE + 18.0], Anchor::Left, LIGHT);
    let tally = &confusion.tally;
    let text = format!(
        "{} cases: {} right, {} false accepts, {} refused",
        tally.total, tally.right, tally.wrong_accepted, tally.refused
    );
    let at = [EDGE, EDGE + 44.0];
    canvas.write(&text, LETTERS, at, Anchor::Left, DIM_TEXT);
    draw_matrix(&mut canvas, confusion, [left, top]);
    draw_calibration(&mut canvas, &evaluation.calibration, [plot_left, plot_top]);
    draw_trade_off(
        &mut canvas,
        &evaluation.trade_off,
        threshold,
        [plot_left + PLOT + GAP, plot_top],
    );
    canvas.finish()
}

fn row_name(truth: &Truth) -> &str {
    match truth {
        Truth::Part(name) => name,
        Truth::NotEnrolled => "not enrolled",
        Truth::Nothing => "nothing",
    }
}

fn column_name(answered: &CaseAnswer) -> &str {
    match answered {
        CaseAnswer::Part(name) => name,
        CaseAnswer::NotAccepted => "not accepted",
    }
}

/// Returns the colour and sign of a case's outcome; the sign makes it readable without colour.
fn look(judgement: CaseOutcome) -> (Rgb<u8>, &'static str) {
    match judgement {
        CaseOutcome::Right => (Rgb([44, 104, 78]), ""),
        CaseOutcome::Refused => (Rgb([140, 100, 30]), " !"),
        CaseOutcome::WrongAccepted => (Rgb([176, 52, 52]), " ×"),
    }
}

/// Draws the matrix: rows are the true labels, columns the accepted parts.
fn draw_matrix(canvas: &mut Canvas, confusion: &Confusion, [left, top]: [f64; 2]) {
    let Confusion {
        rows,
        columns,
        cells,
        ..
    } = confusion;
    let corner = |row: usize, column: usize| [left + CELL * column as f64, top + CELL * row as f64];
    let inner = |[x, y]: [f64; 2]| ([x + 1.0, y + 1.0], [x + CELL - 1.0, y + CELL - 1.0]);
    for (row, truth) in rows.iter().enumerate() {
        let [x, y] = corner(row, 0);
        let at = [x - 10.0, y + CELL / 2.0 + 5.0];
        canvas.write(row_name(truth), LETTERS, at, Anchor::Right, LIGHT);
        for column in 0..columns.len() {
            let (from, to) = inner(corner(row, column));
            canvas.block(from, to, FAINT);
        }
    }
    for (column, answered) in columns.iter().enumerate() {
        let [x, y] = corner(0, column);
        let at = [x + CELL / 2.0 + 5.0, y - 8.0];
        let name = column_name(answered);
        canvas.write_upwards(name, LETTERS, at, Anchor::Left, LIGHT);
    }
    for ((truth, answered), results) in cells {
        let row = rows.iter().position(|row| row == truth);
        let column = columns.iter().position(|column| column == answered);
        let (Some(row), Some(column)) = (row, column) else {
            continue;
        };
        let (colour, sign) = look(CaseOutcome::new(truth, answered));
        let (from, to) = inner(corner(row, column));
        canvas.block(from, to, colour);
        let text = format!("{}{sign}", results.len());
        let at = [from[0] + CELL / 2.0, from[1] + CELL / 2.0 + 5.0];
        canvas.write(&text, LETTERS, at, Anchor::Middle, LIGHT);
    }
    // One below the other, as the matrix may be narrow.
    let mut y = top + CELL * rows.len() as f64 + 32.0;
    for words in [
        "rows: what it is",
        "columns: what it was accepted as",
        "× wrong, ! refused",
    ] {
        canvas.write(words, LETTERS, [EDGE, y], Anchor::Left, DIM_TEXT);
        y += 20.0;
    }
}

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
fn draw_calibration(canvas: &mut Canvas, calibration: &Calibration, [left, top]: [f64; 2]) {
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
fn draw_trade_off(
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cases::{CaseResult, FoundVerdict};
    use inspection::pipeline::Timings;

    #[test]
    fn every_judgement_has_its_colour_and_an_empty_evaluation_a_picture() {
        let result = |truth: Truth, part: &str, score: f64, accepted| CaseResult {
            name: "case".into(),
            difficulty: None,
            truth,
            found: FoundVerdict {
                part: Some(part.into()),
                score: Some(score),
                accepted,
                ..FoundVerdict::default()
            },
            pose_error: None,
            timings: Timings::default(),
        };
        let door = || Truth::Part("door".into());
        let results = vec![
            result(door(), "door", 0.95, true),
            result(door(), "door", 0.6, false),
            result(Truth::NotEnrolled, "door", 0.9, true),
        ];
        let evaluation = Evaluation::of(results, Vec::new(), &["door".into()]);
        let image = evaluation_picture("A trial", &evaluation, 0.9);
        for judgement in [
            CaseOutcome::Right,
            CaseOutcome::Refused,
            CaseOutcome::WrongAccepted,
        ] {
            let num = image.pixels().filter(|p| **p == look(judgement).0).count();
            assert!(num > 1000, "{judgement:?}: {num} pixels");
        }
        // The words below the matrix end before the next plot.
        let gap = (360..405).flat_map(|x| (90..image.height()).map(move |y| (x, y)));
        let mut pixels = gap.map(|(x, y)| *image.get_pixel(x, y));
        assert!(pixels.all(|pixel| pixel == DARK));
        evaluation_picture("", &Evaluation::default(), 0.9);
    }
}
