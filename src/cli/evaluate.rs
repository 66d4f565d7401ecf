//! `partsight evaluate`: accuracy on recorded cases with known truth, and changes since an earlier run.

use std::path::PathBuf;

use anyhow::Context as _;
use clap::Args;

use super::{
    LibraryChoice, Outcome,
    console::{Advised as _, Console, advised_error},
    recipe::RecipeChoice,
    write_json,
};
use geometry::parallel::num_cores;
use records::{
    cases::{
        CaseChange, CaseFolder, CaseJudge, Changes, EarlierRun, Evaluation, FoundVerdict,
        RecipeRecord, evaluate,
    },
    report::{EvaluationReport, evaluation_picture, write_png},
};

/// Inspect recorded cases with known truth: accuracy, confusion matrix, calibration, times
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  partsight simulate --cases tried --num 40 --placement facing,placed,hard
  partsight evaluate tried
  partsight evaluate tried --json monday.json --report monday.png
  partsight evaluate tried --against monday.json
  partsight evaluate tried --threads 1        # for times that nothing else disturbs

A folder of cases holds a folder for each, with case.toml (what it truly is, how hard it is, where it hangs) and \
scene.pcd; the window keeps such cases in Compare. With --pose icp, icp-ga or global the pose is measured too where the \
true one is known.

Exit codes: 0 no false accepts, and nothing is worse than in the earlier run; 1 something was accepted wrongly, or is \
worse; 2 a case is damaged, or nothing could run. An enrolled part that is refused is counted, but is not a failure. \
Files are written at the end, in one piece: Ctrl-C leaves none.")]
pub(super) struct EvaluateArgs {
    /// The folder of cases
    #[arg(value_name = "DIR")]
    folder: PathBuf,
    #[command(flatten)]
    library: LibraryChoice,
    #[command(flatten)]
    recipe: RecipeChoice,
    /// Inspections in parallel; default: all cores. More than one affects only the measured times
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=256))]
    threads: Option<u16>,
    /// Write everything to this file as JSON
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Draw confusion matrix, calibration and thresholds into this file
    #[arg(long, value_name = "PNG")]
    report: Option<PathBuf>,
    /// Compare with what an earlier run wrote with --json
    #[arg(long, value_name = "FILE.json")]
    against: Option<PathBuf>,
}

pub(super) fn run(args: &EvaluateArgs, console: &mut Console) -> anyhow::Result<Outcome> {
    if args.json.is_some() && args.json == args.report {
        return Err(advised_error(
            "--json and --report are the same file",
            "Give two different files",
        ));
    }
    // Read first, so that a wrong file does not cost the work.
    let earlier = args.against.as_deref().map(EarlierRun::read);
    let earlier = earlier.transpose().advised()?;
    let recipe = args.recipe.recipe()?;
    let library = args
        .library
        .load_some(&recipe.reference_params(), console)?
        .library;
    let folder = CaseFolder::at(&args.folder);
    let list = folder.list().advised()?;
    if list.cases.is_empty() && list.problems.is_empty() {
        let path = args.folder.display();
        // Cases must not get into a folder of something else.
        let (what, folder) = if args.folder.is_dir() {
            ("there are no cases", "NEW_FOLDER".to_owned())
        } else {
            ("there is no such folder", path.to_string())
        };
        return Err(advised_error(
            format!("{path}: {what}"),
            format!(
                "Keep some in the window's Compare, or make some: partsight simulate --cases {folder}"
            ),
        ));
    }
    let num_threads = args.threads.map_or_else(num_cores, usize::from);
    console.start_progress(list.cases.len());
    let judge = CaseJudge::new(&library, &recipe);
    let shown: &Console = console;
    let evaluation = evaluate(&folder, list, &judge, num_threads, &|case| {
        shown.begin(&case.name);
        shown.done();
    });
    console.end_progress();
    for problem in &evaluation.problems {
        console.warn(problem, problem);
    }
    let changes = earlier.map(|earlier| Changes::between(&earlier, &evaluation.results));
    let described = RecipeRecord::of(&recipe);
    let report = EvaluationReport::of(&evaluation, &described, num_threads);
    for line in report.lines() {
        console.line(&line);
    }
    if let Some(changes) = &changes {
        show_changes(changes, console);
    }
    if let Some(path) = &args.json {
        write_json(path, &report.record())
            .with_context(|| format!("{} was not written", path.display()))?;
        console.note(&format_args!("The results are in {}", path.display()));
    }
    if let Some(path) = &args.report {
        let label = &recipe.label;
        let RecipeRecord {
            matcher,
            pose,
            changed,
            ..
        } = &described;
        let mut title = format!(
            "{}, recipe {label}, matcher {matcher}, pose {pose}",
            args.folder.display()
        );
        for change in changed {
            title.push_str(", ");
            title.push_str(change);
        }
        let threshold = recipe.accept.min_score;
        write_png(path, &evaluation_picture(&title, &evaluation, threshold))
            .advised()
            .with_context(|| format!("{} was not written", path.display()))?;
        console.note(&format_args!("The report is in {}", path.display()));
    }
    Ok(outcome(&evaluation, changes.as_ref()))
}

fn outcome(evaluation: &Evaluation, changes: Option<&Changes>) -> Outcome {
    let is_worse = changes.is_some_and(|changes| !changes.regressions.is_empty());
    if !evaluation.problems.is_empty() {
        Outcome::CouldNotRun
    } else if evaluation.confusion.tally.wrong_accepted > 0 || is_worse {
        Outcome::NotAccepted
    } else {
        Outcome::Accepted
    }
}

/// Maximum number of scores listed; all are counted.
const MOST_LISTED: usize = 20;

/// Shows the differences from an earlier run.
fn show_changes(changes: &Changes, console: &mut Console) {
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
            let [was, is] = change.judgements;
            console.line(&format_args!(
                "  {word}: {}, it is {}: {was} before ({}), {is} now ({})",
                change.name,
                change.truth.name(),
                change.before.words(),
                change.now.words()
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
