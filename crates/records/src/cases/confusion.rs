//! The confusion matrix: true label against accepted part.

use std::collections::{BTreeMap, BTreeSet};

use serde::Serialize;

use super::judge::{CaseAnswer, CaseOutcome, CaseResult, Truth};

/// Row and column of a cell of the matrix.
pub type Cell = (Truth, CaseAnswer);

/// Counts of results.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Tally {
    /// Number of results.
    pub total: usize,
    /// See [`CaseOutcome::Right`].
    pub right: usize,
    /// See [`CaseOutcome::WrongAccepted`].
    pub wrong_accepted: usize,
    /// See [`CaseOutcome::Refused`].
    pub refused: usize,
    /// Results whose best guess, accepted or not, is the true part.
    pub guessed_right: usize,
}

impl Tally {
    /// Counts these results.
    pub fn of<'a>(results: impl IntoIterator<Item = &'a CaseResult>) -> Self {
        let mut tally = Self::default();
        for result in results {
            tally.total += 1;
            match result.judgement() {
                CaseOutcome::Right => tally.right += 1,
                CaseOutcome::WrongAccepted => tally.wrong_accepted += 1,
                CaseOutcome::Refused => tally.refused += 1,
            }
            tally.guessed_right += usize::from(result.is_guess_right() == Some(true));
        }
        tally
    }
}

/// Results sorted into the cells of the confusion matrix.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Confusion {
    /// True labels: parts in the library's order, then parts no longer enrolled, then the other labels.
    pub rows: Vec<Truth>,
    /// Answers: every part among labels and answers, last the refusal.
    pub columns: Vec<CaseAnswer>,
    /// For each cell that is not empty, the indices of its results.
    pub cells: BTreeMap<Cell, Vec<usize>>,
    /// Counts over all cells.
    pub tally: Tally,
}

impl Confusion {
    /// Sorts the results into cells; `order` lists the library's parts.
    pub fn of(results: &[CaseResult], order: &[String]) -> Self {
        let mut confusion = Self {
            tally: Tally::of(results),
            ..Self::default()
        };
        let mut truths = BTreeSet::new();
        let mut parts = BTreeSet::new();
        for (index, result) in results.iter().enumerate() {
            let answered = result.found.answered();
            truths.insert(result.truth.clone());
            parts.extend(result.truth.part().map(str::to_owned));
            if let CaseAnswer::Part(part) = &answered {
                parts.insert(part.clone());
            }
            let cell = (result.truth.clone(), answered);
            confusion.cells.entry(cell).or_default().push(index);
        }
        let index_of = |part: &str| order.iter().position(|name| name == part);
        let rank = |part: &str| index_of(part).unwrap_or(order.len());
        confusion.rows = truths.into_iter().collect();
        // The sort is stable: names stay in order within a rank, and parts come before the other labels.
        confusion
            .rows
            .sort_by_key(|truth| truth.part().map_or(usize::MAX, rank));
        let mut parts: Vec<String> = parts.into_iter().collect();
        parts.sort_by_key(|part| rank(part));
        let parts = parts.into_iter().map(CaseAnswer::Part);
        confusion.columns = parts.chain([CaseAnswer::NotAccepted]).collect();
        confusion
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cases::FoundVerdict;
    use inspection::pipeline::Timings;

    fn result(truth: Truth, found: Option<&str>) -> CaseResult {
        CaseResult {
            name: "case".into(),
            difficulty: None,
            truth,
            found: FoundVerdict {
                part: found.map(Into::into),
                accepted: found.is_some(),
                ..FoundVerdict::default()
            },
            pose_error: None,
            timings: Timings::default(),
        }
    }

    #[test]
    fn every_result_is_in_exactly_one_cell_and_counted_once() {
        let part = |name: &str| Truth::Part(name.into());
        let results = [
            result(Truth::NotEnrolled, Some("trunk")),
            result(part("door"), Some("door")),
            result(part("door"), None),
            result(part("sold_off"), Some("trunk")),
            result(Truth::Nothing, None),
        ];
        let order = ["trunk".to_owned(), "door".to_owned()];
        let confusion = Confusion::of(&results, &order);
        assert_eq!(
            confusion.tally,
            Tally {
                total: 5,
                right: 2,
                wrong_accepted: 2,
                refused: 1,
                guessed_right: 1
            }
        );
        assert_eq!(
            confusion.rows,
            [
                part("door"),
                part("sold_off"),
                Truth::NotEnrolled,
                Truth::Nothing
            ]
        );
        let columns: Vec<_> = ["trunk", "door", "sold_off"]
            .map(|name| CaseAnswer::Part(name.into()))
            .into_iter()
            .chain([CaseAnswer::NotAccepted])
            .collect();
        assert_eq!(confusion.columns, columns);
        let mut indices: Vec<usize> = confusion.cells.values().flatten().copied().collect();
        indices.sort_unstable();
        assert_eq!(indices, [0, 1, 2, 3, 4]);
        let cell = (Truth::NotEnrolled, CaseAnswer::Part("trunk".into()));
        assert_eq!(confusion.cells[&cell], [0]);
    }
}
