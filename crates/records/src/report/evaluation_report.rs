//! The report of `evaluate`: as text for people, as a record for other programs.

use std::fmt::Display;

use super::TextTable;
use crate::cases::{
    Calibration, CaseAnswer, CaseOutcome, Confusion, Evaluation, EvaluationRecord, PoseErrors,
    RecipeRecord, StageTimes, Tally, stage_times,
};
use files::visible;
use inspection::pipeline::Timings;
use texts::Message;

/// An evaluation with its recipe and stage times.
#[derive(Debug)]
pub struct EvaluationReport<'a> {
    evaluation: &'a Evaluation,
    recipe: &'a RecipeRecord,
    num_threads: usize,
    times: Vec<StageTimes>,
}

impl<'a> EvaluationReport<'a> {
    /// Creates the report on an evaluation with this recipe, which ran `num_threads` inspections at a time.
    pub fn of(evaluation: &'a Evaluation, recipe: &'a RecipeRecord, num_threads: usize) -> Self {
        let timings: Vec<Timings> = evaluation.results.iter().map(|r| r.timings).collect();
        Self {
            evaluation,
            recipe,
            num_threads,
            times: stage_times(&timings),
        }
    }

    /// Returns what `evaluate --json` writes.
    pub fn record(&self) -> EvaluationRecord<'_> {
        EvaluationRecord::of(self.evaluation, self.recipe, self.num_threads, &self.times)
    }
}

/// Report lines. Control characters in names are shown as `\u001b`.
#[derive(Default)]
struct Text {
    lines: Vec<String>,
}

impl Text {
    fn line(&mut self, line: &dyn Display) {
        self.lines.push(visible(&line.to_string()).into_owned());
    }

    fn table(&mut self, table: &TextTable) {
        self.lines.extend(table.lines());
    }
}

impl EvaluationReport<'_> {
    /// Returns the report in English, line by line.
    pub fn lines(&self) -> Vec<String> {
        let mut text = Text::default();
        let Evaluation {
            results,
            problems,
            confusion,
            by_truth,
            by_difficulty,
            calibration,
            trade_off: _,
        } = self.evaluation;
        let by_truth = by_truth.iter().map(|(truth, tally)| (truth.name(), tally));
        let by_difficulty = by_difficulty
            .iter()
            .map(|(words, tally)| (words.as_deref().unwrap_or("not given"), tally));
        let all = std::iter::once(("all", &confusion.tally));
        show_tallies("what it is", by_truth.chain(all), &mut text);
        text.line(&"");
        show_tallies("difficulty", by_difficulty, &mut text);
        text.line(&"");
        show_mistakes(self.evaluation, &mut text);
        show_confusion(confusion, &mut text);
        text.line(&"");
        show_calibration(calibration, &mut text);
        let errors = PoseErrors::of(results);
        if let (Some(median), Some(p95)) = (errors.median, errors.p95) {
            text.line(&"");
            text.line(&format_args!(
            "Pose of {} right guesses whose true one is known: median {:.2}° {:.1} mm, 95 % below {:.2}° {:.1} mm",
            errors.num, median.rotation_deg, median.shift_mm, p95.rotation_deg, p95.shift_mm
        ));
        }
        if !self.times.is_empty() {
            text.line(&"");
            show_times(&self.times, self.num_threads, &mut text);
        }
        if !problems.is_empty() {
            text.line(&"");
            text.line(&format_args!(
                "{} damaged and left out: see the warnings",
                problems.len()
            ));
        }
        text.lines
    }
}

fn show_tallies<'a>(
    heading: &str,
    rows: impl Iterator<Item = (&'a str, &'a Tally)>,
    text: &mut Text,
) {
    let mut table = TextTable::new(&[
        heading,
        "cases",
        "right",
        "false accepts",
        "refused",
        "best guess right",
    ]);
    for (name, tally) in rows {
        let share = 100.0 * tally.right as f64 / tally.total.max(1) as f64;
        table.row([
            name.to_owned(),
            tally.total.to_string(),
            format!("{} ({share:.1} %)", tally.right),
            tally.wrong_accepted.to_string(),
            tally.refused.to_string(),
            tally.guessed_right.to_string(),
        ]);
    }
    text.table(&table);
}

/// Lists every case that is not right, the worst first.
fn show_mistakes(evaluation: &Evaluation, text: &mut Text) {
    for judgement in [CaseOutcome::WrongAccepted, CaseOutcome::Refused] {
        let wrong = evaluation.results.iter();
        for result in wrong.filter(|r| r.judgement() == judgement) {
            text.line(&format_args!(
                "  {}: {}, it is {}, {}",
                result.name,
                judgement,
                result.truth.name(),
                result.found.words()
            ));
        }
    }
    let tally = &evaluation.confusion.tally;
    if tally.right < tally.total {
        text.line(&"");
    }
}

/// Heads the columns with numbers, so that eight parts fit a terminal.
fn show_confusion(confusion: &Confusion, text: &mut Text) {
    text.line(&"Confusion matrix: rows what it is, columns what it was accepted as");
    let numbers =
        (1..=confusion.columns.len()).map(|number| match confusion.columns.get(number - 1) {
            Some(CaseAnswer::Part(_)) => number.to_string(),
            _ => "none".into(),
        });
    let mut table = TextTable::default();
    table.row([String::new()].into_iter().chain(numbers));
    let column_of = |answered: &CaseAnswer| confusion.columns.iter().position(|c| c == answered);
    for row in &confusion.rows {
        let counts = confusion.columns.iter().map(|column| {
            let results = confusion.cells.get(&(row.clone(), column.clone()));
            results.map_or_else(|| ".".to_owned(), |results| results.len().to_string())
        });
        let own = row
            .part()
            .and_then(|part| column_of(&CaseAnswer::Part(part.into())));
        let name = match own {
            Some(column) => format!("{} {}", column + 1, row.name()),
            None => format!("- {}", row.name()),
        };
        table.row([name].into_iter().chain(counts));
    }
    text.table(&table);
    let has_row = |name: &str| confusion.rows.iter().any(|row| row.part() == Some(name));
    for (column, answered) in confusion.columns.iter().enumerate() {
        if let CaseAnswer::Part(name) = answered
            && !has_row(name)
        {
            text.line(&format_args!("{} {name}: no case of it", column + 1));
        }
    }
}

fn show_calibration(calibration: &Calibration, text: &mut Text) {
    let Some(error) = calibration.expected_error else {
        text.line(&Message::new("no-calibration"));
        return;
    };
    text.line(&format_args!(
        "Calibration of the best guess, accepted or not: expected error {error:.3}"
    ));
    let mut table = TextTable::new(&["score", "guesses", "mean score", "right"]);
    for bin in &calibration.bins {
        if let Some(share) = bin.share_right() {
            table.row([
                format!("{:.1} to {:.1}", bin.from, bin.to),
                bin.num.to_string(),
                format!("{:.2}", bin.mean_score),
                format!("{share:.2}"),
            ]);
        }
    }
    text.table(&table);
}

fn show_times(times: &[StageTimes], num_threads: usize, text: &mut Text) {
    let how = match num_threads {
        1 => "one inspection at a time".to_owned(),
        num => format!(
            "{num} inspections at a time on a shared machine: --threads 1 disturbs them less"
        ),
    };
    text.line(&format_args!("Time per stage, {how}"));
    let mut table = TextTable::new(&["stage", "median", "95 %"]);
    for time in times {
        table.row([
            time.stage.to_owned(),
            format!("{:.2} ms", time.median_ms),
            format!("{:.2} ms", time.p95_ms),
        ]);
    }
    text.table(&table);
}
