//! The confusion matrix as it is drawn: names for people, counts and judgements, prepared once.

use crate::{
    app::{inspection::library_cache::LibraryView, language::text},
    cases::{CaseAnswer, CaseOutcome, Cell, Confusion, Tally, Truth},
};

/// The matrix, row by row.
#[derive(Debug, Default)]
pub struct Matrix {
    /// Names of the rows: what it truly was.
    pub rows: Vec<String>,
    /// Names of the columns: what it was taken for.
    pub columns: Vec<String>,
    /// Cells with any case in them.
    pub cells: Vec<MatrixCell>,
    /// The sums.
    pub tally: Tally,
}

/// A cell with cases in it.
#[derive(Debug)]
pub struct MatrixCell {
    /// Which.
    pub cell: Cell,
    /// Row and column.
    pub place: [usize; 2],
    /// Whether its cases are right.
    pub judgement: CaseOutcome,
    /// Places in the list of results.
    pub results: Vec<usize>,
}

impl Matrix {
    /// Names everything.
    pub fn of(confusion: Confusion, shown: &LibraryView) -> Self {
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
                judgement: CaseOutcome::of(&cell.0, &cell.1),
                place: [row, column],
                cell,
                results,
            })
        });
        Self {
            cells: cells.collect(),
            rows: rows.iter().map(|row| truth_title(row, shown)).collect(),
            columns: columns
                .iter()
                .map(|column| answer_title(column, shown))
                .collect(),
            tally,
        }
    }

    /// The cell, if it has any case.
    pub fn cell(&self, wanted: &Cell) -> Option<&MatrixCell> {
        self.cells.iter().find(|cell| cell.cell == *wanted)
    }
}

/// What a person calls what truly hangs there.
pub fn truth_title(truth: &Truth, shown: &LibraryView) -> String {
    match truth {
        Truth::Part(name) => part_title(name, shown),
        Truth::NotEnrolled => text!("compare-not-enrolled"),
        Truth::Nothing => text!("compare-empty-cell"),
    }
}

/// What a person calls an answer.
pub fn answer_title(answer: &CaseAnswer, shown: &LibraryView) -> String {
    match answer {
        CaseAnswer::Part(name) => part_title(name, shown),
        CaseAnswer::NotAccepted => text!("compare-not-accepted"),
    }
}

/// What a person calls a part.
pub fn part_title(name: &str, shown: &LibraryView) -> String {
    let place = shown.place_of(name);
    place.map_or_else(|| name.to_owned(), |place| shown.title(place).to_owned())
}
