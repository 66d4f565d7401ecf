//! An evaluation, and what changed since an earlier one, in the terminal.

use crate::{
    bench::StageTimes,
    cases::{
        Calibration, CaseAnswer, CaseChange, CaseOutcome, Changes, Confusion, Evaluation,
        FoundVerdict, PoseErrors, Tally,
    },
    cli::console::{Console, Table},
};

/// Everything but the changes.
pub(super) fn show(
    evaluation: &Evaluation,
    times: &[StageTimes],
    num_threads: usize,
    console: &mut Console,
) {
    let Evaluation {
        results,
        problems,
        confusion,
        by_truth,
        by_difficulty,
        calibration,
        trade_off: _,
    } = evaluation;
    let by_truth = by_truth.iter().map(|(truth, tally)| (truth.name(), tally));
    let by_difficulty = by_difficulty
        .iter()
        .map(|(words, tally)| (words.as_deref().unwrap_or("not said"), tally));
    let all = std::iter::once(("all", &confusion.tally));
    show_tallies("what it is", by_truth.chain(all), console);
    console.line(&"");
    show_tallies("difficulty", by_difficulty, console);
    console.line(&"");
    show_mistakes(evaluation, console);
    show_confusion(confusion, console);
    console.line(&"");
    show_calibration(calibration, console);
    let errors = PoseErrors::of(results);
    if let (Some(median), Some(p95)) = (errors.median, errors.p95) {
        console.line(&"");
        console.line(&format_args!(
            "Pose of {} right guesses whose true one is known: median {:.2}° {:.1} mm, 95 % below {:.2}° {:.1} mm",
            errors.num, median.rotation_deg, median.shift_mm, p95.rotation_deg, p95.shift_mm
        ));
    }
    if !times.is_empty() {
        console.line(&"");
        show_times(times, num_threads, console);
    }
    if !problems.is_empty() {
        console.line(&"");
        console.line(&format_args!(
            "{} damaged and left out: see the warnings",
            problems.len()
        ));
    }
}

fn show_tallies<'a>(
    heading: &str,
    rows: impl Iterator<Item = (&'a str, &'a Tally)>,
    console: &mut Console,
) {
    let mut table = Table::new(&[
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
    table.show(console);
}

/// Every case that is not right, the worst first.
fn show_mistakes(evaluation: &Evaluation, console: &mut Console) {
    for judgement in [CaseOutcome::WrongAccepted, CaseOutcome::Refused] {
        let wrong = evaluation.results.iter();
        for result in wrong.filter(|r| r.judgement() == judgement) {
            console.line(&format_args!(
                "  {}: {}, it is {}, {}",
                result.name,
                judgement.words(),
                result.truth.name(),
                found_words(&result.found)
            ));
        }
    }
    let tally = &evaluation.confusion.tally;
    if tally.right < tally.total {
        console.line(&"");
    }
}

fn found_words(found: &FoundVerdict) -> String {
    let guess = match (&found.part, found.score) {
        (Some(part), Some(score)) if found.accepted => {
            return format!("accepted as {part} at {score:.2}");
        }
        (Some(part), Some(score)) => Some(format!("best guess {part} at {score:.2}")),
        _ => None,
    };
    // A high score alone does not say why it is refused.
    let words: Vec<String> = guess.into_iter().chain(found.reason.clone()).collect();
    if words.is_empty() {
        return "nothing found".into();
    }
    words.join(": ")
}

/// Columns by number, so that eight names fit a terminal.
fn show_confusion(confusion: &Confusion, console: &mut Console) {
    console.line(&"Confusion matrix: rows what it is, columns what it was accepted as");
    let numbers =
        (1..=confusion.columns.len()).map(|number| match confusion.columns.get(number - 1) {
            Some(CaseAnswer::Part(_)) => number.to_string(),
            _ => "none".into(),
        });
    let mut table = Table::default();
    table.row([String::new()].into_iter().chain(numbers));
    let column_of = |answered: &CaseAnswer| confusion.columns.iter().position(|c| c == answered);
    for row in &confusion.rows {
        let counts = confusion.columns.iter().map(|column| {
            let places = confusion.cells.get(&(row.clone(), column.clone()));
            places.map_or_else(|| ".".to_owned(), |places| places.len().to_string())
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
    table.show(console);
    let has_row = |name: &str| confusion.rows.iter().any(|row| row.part() == Some(name));
    for (column, answered) in confusion.columns.iter().enumerate() {
        if let CaseAnswer::Part(name) = answered
            && !has_row(name)
        {
            console.line(&format_args!("{} {name}: no case of it", column + 1));
        }
    }
}

fn show_calibration(calibration: &Calibration, console: &mut Console) {
    let Some(error) = calibration.expected_error else {
        console.line(&"Calibration: nothing was taken for a part");
        return;
    };
    console.line(&format_args!(
        "Calibration of the best guess, accepted or not: expected error {error:.3}"
    ));
    let mut table = Table::new(&["score", "guesses", "mean score", "right"]);
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
    table.show(console);
}

fn show_times(times: &[StageTimes], num_threads: usize, console: &mut Console) {
    let how = match num_threads {
        1 => "one inspection at a time".to_owned(),
        num => format!(
            "{num} inspections at a time on a shared machine: --threads 1 disturbs them less"
        ),
    };
    console.line(&format_args!("Time per stage, {how}"));
    let mut table = Table::new(&["stage", "median", "95 %"]);
    for time in times {
        table.row([
            time.stage.to_owned(),
            format!("{:.2} ms", time.median_ms),
            format!("{:.2} ms", time.p95_ms),
        ]);
    }
    table.show(console);
}

/// Scores listed; more are counted.
const MOST_LISTED: usize = 20;

/// What differs from an earlier run.
pub(super) fn show_changes(changes: &Changes, console: &mut Console) {
    let Changes {
        regressions,
        mends,
        rescored,
        num_common,
        added,
        gone,
    } = changes;
    console.line(&"");
    console.line(&format_args!(
        "Against the earlier run, {num_common} cases of both: {} worse, {} better, {} with another score or guess",
        regressions.len(),
        mends.len(),
        rescored.len()
    ));
    for (word, list) in [("worse", regressions), ("better", mends)] {
        for change in list {
            let [was, is] = change.judgements.map(CaseOutcome::words);
            console.line(&format_args!(
                "  {word}: {}, it is {}: {was} before ({}), {is} now ({})",
                change.name,
                change.truth.name(),
                found_words(&change.before),
                found_words(&change.now)
            ));
        }
    }
    let score = |found: &FoundVerdict| {
        found
            .score
            .map_or_else(|| "-".into(), |s| format!("{s:.3}"))
    };
    let other = |change: &CaseChange| {
        let (before, now) = (&change.before.part, &change.now.part);
        match (before == now, now) {
            (true, _) => String::new(),
            (false, Some(now)) => format!(", now taken for {now}"),
            (false, None) => ", now without a guess".into(),
        }
    };
    for change in rescored.iter().take(MOST_LISTED) {
        console.line(&format_args!(
            "  {}: {} before, {} now{}",
            change.name,
            score(&change.before),
            score(&change.now),
            other(change)
        ));
    }
    if rescored.len() > MOST_LISTED {
        console.line(&format_args!("  and {} more", rescored.len() - MOST_LISTED));
    }
    for (words, names) in [("not in the earlier run", added), ("not in this run", gone)] {
        if !names.is_empty() {
            console.line(&format_args!("  {words}: {}", names.join(", ")));
        }
    }
}
