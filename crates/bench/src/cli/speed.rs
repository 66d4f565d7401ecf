//! `partsight-bench speed`: stage times compared with their budgets, and times of whole inspections per set, compared
//! with an earlier run.

use std::{
    fs::DirEntry,
    path::{Path, PathBuf},
};

use anyhow::Context as _;
use clap::Args;
use serde::{Deserialize, Serialize};

use super::{
    FrameChoice,
    recognition::{Frames, SUITES},
    write_json,
};
use crate::{speed::SetTimes, suites::Suite};
use capture::may_be_capture;
use files::read_limited;
use geometry::parallel::on_one_core;
use inspection::pipeline::{Recipe, Timings, Unwatched, run as inspect};
use partsight::cli::{
    LibraryChoice, Outcome,
    console::{Advised as _, Console, Table, advised_error},
    input::{choice, open_scene},
};
use records::cases::{StageTimes, stage_times};

/// The file that `--json` writes.
#[derive(Debug, Serialize)]
struct SpeedFile {
    schema: u32,
    simulated: bool,
    num_frames: usize,
    stages: Vec<StageTimes>,
    sets: Vec<SetTimes>,
}

/// The fields that `--compare` reads from it.
#[derive(Debug, Deserialize)]
struct EarlierSpeed {
    sets: Vec<SetTimes>,
}

/// Default number of poses per subject.
const NUM_POSES: u64 = 25;
/// Maximum size of an earlier measurement, bytes; they take some kilobytes.
const MOST_BYTES: u64 = 1 << 20;

#[derive(Debug, Args)]
pub(super) struct SpeedArgs {
    #[command(flatten)]
    frames: FrameChoice,
    /// These sets of frames; may be given several times
    #[arg(long, value_parser = choice(&SUITES), value_name = "NAME")]
    suite: Vec<&'static [Suite]>,
    /// Inspect these scenes, or those in these folders, with the library instead of simulated frames
    #[arg(long, value_name = "FILE|DIR", num_args = 1.., conflicts_with_all = ["suite", "poses", "seed"])]
    files: Vec<PathBuf>,
    /// Show how many times as long each set took as in this file, which --json wrote
    #[arg(long, value_name = "JSON")]
    compare: Option<PathBuf>,
    #[command(flatten)]
    library: LibraryChoice,
}

pub(super) fn run(args: &SpeedArgs, console: &mut Console) -> anyhow::Result<Outcome> {
    // Fails before anything is measured.
    let earlier = args.compare.as_deref().map(read_earlier).transpose()?;
    let is_simulated = args.files.is_empty();
    let (sets, words) = if is_simulated {
        let frames = Frames::of(&args.frames, &args.suite, &[Suite::Placed], NUM_POSES);
        let results = frames.inspect(console)?.into_iter().map(|result| {
            let timings: Vec<Timings> = result
                .cases
                .iter()
                .filter_map(|case| case.timings)
                .collect();
            (result.suite.name(), timings)
        });
        let sets: Vec<_> = results.collect();
        let num: usize = sets.iter().map(|set| set.1.len()).sum();
        let words = format!("Simulated: {num} inspections, {}", frames.words());
        (sets, words)
    } else {
        let timings = inspect_files(args, console)?;
        let words = format!("{} files", timings.len());
        (vec![("files", timings)], words)
    };
    console.line(&format_args!(
        "{words}; one core, under the machine's present load."
    ));
    console.line(&"");
    let timings: Vec<Timings> = sets.iter().flat_map(|set| &set.1).copied().collect();
    let stages = stage_times(&timings);
    show(&stages, console);
    let sets: Vec<SetTimes> = sets
        .iter()
        .filter_map(|(name, timings)| SetTimes::of(name, timings))
        .collect();
    console.line(&"");
    show_sets(&sets, earlier.as_ref(), console);
    if let Some(path) = &args.frames.file.json {
        let file = SpeedFile {
            schema: 2,
            simulated: is_simulated,
            num_frames: timings.len(),
            stages,
            sets,
        };
        write_json(path, &file)?;
    }
    Ok(Outcome::Accepted)
}

fn read_earlier(path: &Path) -> anyhow::Result<EarlierSpeed> {
    let bytes = read_limited(path, MOST_BYTES).advised()?;
    serde_json::from_slice(&bytes)
        .with_context(|| format!("{} is no measurement of speed", path.display()))
        .map_err(|error| {
            advised_error(
                format!("{error:#}"),
                "Give a file that partsight-bench speed --json FILE wrote",
            )
        })
}

/// Times inspections of files with the selected library. A file that cannot be opened is an error: its time would be
/// missing.
fn inspect_files(args: &SpeedArgs, console: &mut Console) -> anyhow::Result<Vec<Timings>> {
    let recipe = Recipe::default();
    let load = (args.library).load_some(&recipe.reference_params(), console)?;
    let files = scenes_at(&args.files)?;
    console.start_progress(files.len());
    let timed = |path: &PathBuf| {
        let (scene, _) = open_scene(path).advised()?;
        let inspection = on_one_core(|| inspect(&scene, &load.library, &recipe, &Unwatched))?;
        console.done();
        Ok(inspection.timings)
    };
    let timings = files.iter().map(timed).collect();
    console.end_progress();
    timings
}

/// The given files, and in place of each folder what may be scenes in it, by name.
fn scenes_at(given: &[PathBuf]) -> anyhow::Result<Vec<PathBuf>> {
    let mut files = Vec::new();
    for path in given {
        if !path.is_dir() {
            files.push(path.clone());
            continue;
        }
        let entries = path
            .read_dir()
            .and_then(Iterator::collect::<Result<Vec<_>, _>>);
        let entries = entries.with_context(|| path.display().to_string())?;
        let mut inside: Vec<PathBuf> = entries.iter().map(DirEntry::path).collect();
        inside.retain(|file| may_be_capture(file) && file.is_file());
        if inside.is_empty() {
            let advice = "Give a folder of depth images or clouds";
            return Err(advised_error(
                format!("{}: no scene in it", path.display()),
                advice,
            ));
        }
        inside.sort();
        files.extend(inside);
    }
    Ok(files)
}

fn show(times: &[StageTimes], console: &mut Console) {
    let mut table = Table::new(&["stage", "median", "95 %", "budget"]);
    for t in times {
        table.row([
            t.stage.to_owned(),
            format!("{:.2} ms", t.median_ms),
            format!("{:.2} ms", t.p95_ms),
            format!("{:.1} ms", t.budget_ms),
        ]);
    }
    console.table(&table);
}

/// Shows the times of whole inspections and, given an earlier run, their ratios to it.
fn show_sets(sets: &[SetTimes], earlier: Option<&EarlierSpeed>, console: &mut Console) {
    let ms = |ms: f64| format!("{ms:.1} ms");
    let mut head = vec!["whole inspection", "frames", "median", "95 %", "longest"];
    if earlier.is_some() {
        head.extend(["median ×", "95 % ×", "longest ×"]);
    }
    let mut table = Table::new(&head);
    for set in sets {
        let mut row = vec![
            set.set.clone(),
            set.num_frames.to_string(),
            ms(set.median_ms),
            ms(set.p95_ms),
            ms(set.longest_ms),
        ];
        if let Some(earlier) = earlier {
            let before = earlier.sets.iter().find(|before| before.set == set.set);
            row.extend(match before {
                Some(before) => set.against(before).map(|ratio| format!("{ratio:.2}")),
                None => [(); 3].map(|()| "-".to_owned()),
            });
        }
        table.row(row);
    }
    console.table(&table);
}
