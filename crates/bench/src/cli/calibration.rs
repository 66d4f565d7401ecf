//! `partsight-bench calibration`: fits the score's model on simulated frames, and shows how much each piece of evidence
//! contributes.

use serde::Serialize;

use super::{FrameChoice, recognition::Frames, write_json};
use crate::{
    calibration::{Model, Question, Sample, bands, samples},
    suites::{Suite, SuiteResult, TUNING_SEED},
};
use partsight::cli::{
    Outcome,
    console::{Console, Table},
};

/// The file that `--json` writes.
#[derive(Debug, Serialize)]
struct CalibrationFile<'a> {
    schema: u32,
    simulated: bool,
    first_seed: u64,
    models: [Model; 2],
    suites: &'a [SuiteResult],
}

/// Default number of poses per subject.
const NUM_POSES: u64 = 14;
/// Score from which on errors are counted.
const ACCEPTED: f64 = 0.9;

pub(super) fn run(args: &FrameChoice, console: &mut Console) -> anyhow::Result<Outcome> {
    let num_poses = args.poses.unwrap_or(NUM_POSES);
    let first_seed = args.seed.unwrap_or(TUNING_SEED);
    let mut suites = Suite::ALL.to_vec();
    // What hides a part on a rack is another part, which the evidence does not know.
    suites.retain(|suite| suite.rack().is_none());
    let frames = Frames::from_seed(&suites, num_poses, first_seed);
    let results = frames.inspect(console)?;
    console.line(&format_args!("Simulated: {}.", frames.words()));
    let models = [Question::Part, Question::Type].map(|question| fit(&results, question, console));
    show_bands(&results, console);
    if let Some(path) = &args.file.json {
        let file = CalibrationFile {
            schema: 1,
            simulated: true,
            first_seed,
            models,
            suites: &results,
        };
        write_json(path, &file)?;
    }
    Ok(Outcome::Accepted)
}

/// Fits a model, and shows the contribution of each feature.
fn fit(results: &[SuiteResult], question: Question, console: &mut Console) -> Model {
    // Two-fold cross-validation: fit on one half of the subjects, measure on the other, and vice versa.
    let (odd, even) = halves(results, question);
    let what = match question {
        Question::Part => "The score",
        Question::Type => "The likeness",
    };
    console.line(&"");
    console.line(&format_args!(
        "{what}: {} contenders, {} of them right.",
        odd.len() + even.len(),
        odd.iter().chain(&even).filter(|s| s.is_right).count()
    ));
    console.line(&"");
    let mut table = Table::new(&[
        "evidence",
        "log loss on unseen subjects",
        "wrong from 0.9 on",
        "right below 0.9",
    ]);
    let features = question.features();
    let all = vec![true; features.len()];
    let mut row = |what: String, is_on: &[bool]| {
        let models = [
            Model::fit(&odd, question, is_on),
            Model::fit(&even, question, is_on),
        ];
        let loss = f64::midpoint(models[0].log_loss(&even), models[1].log_loss(&odd));
        let errors = [
            models[0].errors(&even, ACCEPTED),
            models[1].errors(&odd, ACCEPTED),
        ];
        table.row([
            what,
            format!("{loss:.4}"),
            (errors[0][0] + errors[1][0]).to_string(),
            (errors[0][1] + errors[1][1]).to_string(),
        ]);
    };
    row("all".to_owned(), &all);
    for (i, name) in features.iter().enumerate() {
        let mut is_on = all.clone();
        is_on[i] = false;
        row(format!("without {name}"), &is_on);
    }
    for (i, name) in features.iter().enumerate() {
        let mut is_on = vec![false; features.len()];
        is_on[i] = true;
        row(format!("{name} alone"), &is_on);
    }
    console.table(&table);
    let both: Vec<Sample> = odd.iter().chain(&even).copied().collect();
    let model = Model::fit(&both, question, &all);
    console.line(&"");
    console.line(&format_args!(
        "Fitted on all: constant {:.2}",
        model.constant
    ));
    for (name, weight) in features.iter().zip(&model.weights) {
        console.line(&format_args!("  {name}  {weight:.2}"));
    }
    console.line(&"");
    model
}

/// Splits the contenders into two halves by subject.
fn halves(results: &[SuiteResult], question: Question) -> (Vec<Sample>, Vec<Sample>) {
    let half = |is_odd: bool| {
        let half_of = |result: &SuiteResult| {
            let cases = result.cases.iter();
            SuiteResult {
                suite: result.suite,
                cases: cases
                    .filter(|case| (case.subject.len() % 2 == 1) == is_odd)
                    .cloned()
                    .collect(),
            }
        };
        samples(&results.iter().map(half_of).collect::<Vec<_>>(), question)
    };
    (half(true), half(false))
}

/// Shows how often the best guesses were right, by score.
pub(super) fn show_bands(results: &[SuiteResult], console: &mut Console) {
    let mut table = Table::new(&["score from", "mean score", "best guesses", "right"]);
    for band in bands(results).iter().filter(|band| band.num > 0) {
        let share = 100.0 * band.num_right as f64 / band.num as f64;
        table.row([
            format!("{:.2}", band.from),
            format!("{:.3}", band.mean_score),
            band.num.to_string(),
            format!("{} ({share:.1} %)", band.num_right),
        ]);
    }
    console.table(&table);
}
