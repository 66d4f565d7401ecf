//! Table I: every enrolled part from T1 to T5 by every method.

use std::{fmt::Write as _, sync::Arc, time::Duration};

use super::{
    pair::Pair,
    track::{estimated, in_the_window},
};
use stages::pose::PoseMethod;
use ui::user_error::UserError;

/// Table I as far as computed.
#[derive(Debug, Default)]
pub struct TableShown {
    /// The rows, grouped by part.
    pub rows: Vec<Arc<TableRow>>,
    /// Number of rows present when the current run began.
    pub num_before: usize,
    /// Time spent on the rows added since.
    pub elapsed: Duration,
}

impl TableShown {
    /// Estimates the time left, from the rows added in this run.
    pub fn remaining(&self, total: usize) -> Option<Duration> {
        let num_added = self.rows.len().saturating_sub(self.num_before);
        let num_left = total.saturating_sub(self.rows.len());
        (num_added > 0).then(|| self.elapsed.mul_f64(num_left as f64 / num_added as f64))
    }
}

/// The results of one part from one start.
#[derive(Debug)]
pub struct TableRow {
    /// The part's name.
    pub part: String,
    /// The part's title.
    pub title: String,
    /// Index of the start in T1..T5, counted from 0.
    pub start: usize,
    /// One cell per method, in the order of [`PoseMethod::ALL`].
    pub cells: Vec<TableCell>,
}

/// The result of one method.
#[derive(Debug)]
pub struct TableCell {
    /// The method that ran.
    pub method: PoseMethod,
    /// How long the estimation took.
    pub time: Duration,
    /// The figures, or why there are none.
    pub figures: Result<TableFigures, UserError>,
}

/// The figures of a cell.
#[derive(Clone, Copy, Debug)]
pub struct TableFigures {
    /// E at the end, square metres.
    pub e_m2: f64,
    /// Root mean square distance of the overlapping points, metres.
    pub rms_m: f64,
    /// Rotation error, degrees.
    pub rotation_deg: f64,
    /// Shift error at the part's centroid, millimetres.
    pub shift_mm: f64,
    /// Number of iterations.
    pub num_iterations: usize,
    /// Why the method stopped, named as in reports.
    pub stopped: &'static str,
}

impl TableCell {
    /// Runs the method on a pair whose truth is known.
    pub fn run(method: PoseMethod, pair: &Pair, is_cancelled: &dyn Fn() -> bool) -> Self {
        let (aligned, time) = estimated(method, pair, is_cancelled);
        let figures = aligned.map(|estimate| {
            let error = pair.true_error(&estimate.target_from_source);
            TableFigures {
                e_m2: pair.e_m2(&estimate.target_from_source),
                rms_m: estimate.fit.rms_m,
                rotation_deg: error.map_or(f64::NAN, |error| error.rotation.degrees()),
                shift_mm: error.map_or(f64::NAN, |error| error.shift.mm()),
                num_iterations: estimate.iterations.len(),
                stopped: estimate.stopped.name(),
            }
        });
        Self {
            method,
            time,
            figures: figures.map_err(|error| in_the_window(&error)),
        }
    }
}

/// Values of E below this are rounding of the coordinates, square metres: (1 µm)².
const ROUNDING: f64 = 1e-12;

impl TableRow {
    /// True if no other cell has a smaller E, up to rounding; several cells may be best.
    pub fn is_best(&self, index: usize) -> bool {
        let e = |cell: &TableCell| cell.figures.as_ref().map_or(f64::INFINITY, |f| f.e_m2);
        let least = self.cells.iter().map(e).fold(f64::INFINITY, f64::min);
        let own = self.cells.get(index).map_or(f64::INFINITY, e);
        own.is_finite() && own <= least.max(ROUNDING)
    }
}

/// The columns of a method; headers are prefixed with its name.
const COLUMNS: [&str; 7] = [
    "e_m2",
    "rms_m",
    "rotation_error_deg",
    "shift_error_mm",
    "iterations",
    "stopped",
    "time_ms",
];

/// Writes the table as text, a header and one line per row, with `separator` between cells.
pub(super) fn text(rows: &[impl AsRef<TableRow>], separator: char) -> String {
    let mut text = format!("part{separator}start");
    for method in PoseMethod::ALL {
        for column in COLUMNS {
            let _ = write!(
                text,
                "{separator}{}_{column}",
                method.name().replace('-', "_")
            );
        }
    }
    text.push('\n');
    for row in rows.iter().map(AsRef::as_ref) {
        let _ = write!(text, "{}{separator}T{}", row.part, row.start + 1);
        for cell in &row.cells {
            let ms = cell.time.as_secs_f64() * 1000.0;
            let cells = if let Ok(f) = &cell.figures {
                [
                    format!("{:.4e}", f.e_m2),
                    format!("{:.4e}", f.rms_m),
                    format!("{:.4}", f.rotation_deg),
                    format!("{:.4}", f.shift_mm),
                    f.num_iterations.to_string(),
                    f.stopped.to_owned(),
                    format!("{ms:.1}"),
                ]
            } else {
                let mut none = [const { String::new() }; COLUMNS.len()];
                "no_pose".clone_into(&mut none[COLUMNS.len() - 2]);
                none
            };
            for cell in cells {
                let _ = write!(text, "{separator}{cell}");
            }
        }
        text.push('\n');
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cell(method: PoseMethod, e_m2: Option<f64>) -> TableCell {
        let problem = || UserError {
            what: "no pose".into(),
            advice: "none".into(),
        };
        TableCell {
            method,
            time: Duration::from_millis(12),
            figures: e_m2.ok_or_else(problem).map(|e_m2| TableFigures {
                e_m2,
                rms_m: e_m2.sqrt(),
                rotation_deg: 0.5,
                shift_mm: 2.0,
                num_iterations: 31,
                stopped: "converged",
            }),
        }
    }

    fn row(start: usize, e: impl Fn(usize) -> Option<f64>) -> Arc<TableRow> {
        let methods = PoseMethod::ALL.into_iter().enumerate();
        Arc::new(TableRow {
            part: "fender".into(),
            title: "Fender, left".into(),
            start,
            cells: methods.map(|(i, method)| cell(method, e(i))).collect(),
        })
    }

    #[test]
    fn the_text_has_a_header_and_one_line_per_row_with_as_many_cells() {
        let rows = [row(0, |_| Some(2e-3)), row(1, |i| (i > 0).then_some(1e-9))];
        let text = text(&rows, ',');
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines.len(), 3);
        let num_cells = 2 + PoseMethod::ALL.len() * COLUMNS.len();
        for line in &lines {
            assert_eq!(line.split(',').count(), num_cells, "{line}");
        }
        assert!(lines[0].starts_with("part,start,icp_e_m2"));
        assert!(lines[1].starts_with("fender,T1,2.0000e-3"));
        assert!(lines[2].starts_with("fender,T2,,,,,,no_pose,"));
    }

    #[test]
    fn the_best_cells_have_the_smallest_e_and_a_row_without_poses_has_none() {
        let best = |row: &TableRow| -> Vec<usize> {
            (0..PoseMethod::ALL.len())
                .filter(|index| row.is_best(*index))
                .collect()
        };
        let last = PoseMethod::ALL.len() - 1;
        assert_eq!(best(&row(0, |i| Some(1.0 / (i + 1) as f64))), [last]);
        assert_eq!(best(&row(0, |i| (i == 0).then_some(1.0))), [0]);
        assert_eq!(
            best(&row(0, |i| Some(1e-14 / (i + 1) as f64))).len(),
            last + 1
        );
        assert!(best(&row(0, |_| None)).is_empty());
    }
}
