//! The confusion matrix for drawing: counts and verdicts, computed once, and the titles of its rows and columns.

use crate::shared::truth_title;
use records::{
    cases::{CaseAnswer, CaseOutcome, Cell, Confusion, Tally, Truth},
    history::StoredVerdict,
};
use shell::inspection::library_cache::LibraryView;
use ui::language::{described, text};

/// The matrix, row by row.
#[derive(Debug, Default)]
pub struct Matrix {
    /// True labels, from top to bottom.
    pub rows: Vec<Truth>,
    /// Answers, from left to right.
    pub columns: Vec<CaseAnswer>,
    /// Cells that are not empty.
    pub cells: Vec<MatrixCell>,
    /// Counts over all cells.
    pub tally: Tally,
}

/// A cell that is not empty.
#[derive(Debug)]
pub struct MatrixCell {
    /// Truth and answer.
    pub cell: Cell,
    /// Row and column.
    pub place: [usize; 2],
    /// The same for all its cases.
    pub judgement: CaseOutcome,
    /// Places of its cases in the list of results.
    pub results: Vec<usize>,
}

impl Matrix {
    /// Prepares a confusion matrix for drawing.
    pub fn of(confusion: Confusion) -> Self {
        let Confusion {
            rows,
            columns,
            cells,
            tally,
        } = confusion;
        let cells = cells.into_iter().filter_map(|(cell, results)| {
            let row = rows.iter().position(|row| *row == cell.0)?;
            let column = columns.iter().position(|column| *column == cell.1)?;
            Some(MatrixCell {
                judgement: CaseOutcome::new(&cell.0, &cell.1),
                place: [row, column],
                cell,
                results,
            })
        });
        Self {
            cells: cells.collect(),
            rows,
            columns,
            tally,
        }
    }

    /// The cell, if it is not empty.
    pub fn cell(&self, wanted: &Cell) -> Option<&MatrixCell> {
        self.cells.iter().find(|cell| cell.cell == *wanted)
    }
}

/// Name of a row: shorter than in a menu.
pub fn row_title(truth: &Truth, shown: &LibraryView) -> String {
    match truth {
        Truth::Nothing => text!("shell-empty-cell"),
        Truth::Part(_) | Truth::NotEnrolled => truth_title(Some(truth), shown),
    }
}

/// Name of a column.
pub fn column_title(answer: &CaseAnswer, shown: &LibraryView) -> String {
    match answer {
        CaseAnswer::Part(name) => shown.title_of(name).to_owned(),
        CaseAnswer::NotAccepted => described(&StoredVerdict::Rejected),
    }
}
