//! Picture of an evaluation: confusion matrix, calibration, and trade-off of the score threshold.

use image::{Rgb, RgbImage};

use super::{
    canvas::Canvas,
    chart::{DIM_TEXT, LETTERS},
    lettering::{Anchor, Lettering, REGULAR},
    pictures::{DARK, FAINT, LIGHT},
    score_plots::{PLOT, draw_calibration, draw_trade_off},
};
use crate::cases::{CaseAnswer, CaseOutcome, Confusion, Evaluation, Truth};

/// Side of a cell of the matrix, pixels.
const CELL: f64 = 46.0;
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
    for ((truth, answered), places) in cells {
        let row = rows.iter().position(|row| row == truth);
        let column = columns.iter().position(|column| column == answered);
        let (Some(row), Some(column)) = (row, column) else {
            continue;
        };
        let (colour, sign) = look(CaseOutcome::of(truth, answered));
        let (from, to) = inner(corner(row, column));
        canvas.block(from, to, colour);
        let text = format!("{}{sign}", places.len());
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        cases::{CaseResult, FoundVerdict},
        pipeline::Timings,
    };

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
