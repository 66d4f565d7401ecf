//! `partsight bench recognition --suite NAME`: right, accepted and wrongly accepted on sets of frames.

use std::path::Path;

use clap::ValueEnum;
use serde::Serialize;

use super::{BenchArgs, calibration::show_bands, write_json};
use crate::{
    bench::suites::{MEASURING_SEED, Suite, SuiteCase, SuiteLibraries, SuiteResult, run_suite},
    cli::{
        Outcome,
        console::{Advised as _, Console, Table},
    },
    library::EnrolParams,
    pipeline::{Inspection, Recipe, Unwatched},
    report::{InspectionLine, ReportError, ReportFolder, stage_pictures},
    stages::scene::SceneCloud,
};

/// The suites by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum SuiteChoice {
    /// All of them
    All,
    /// Enrolled parts hung with care: up to 10 degrees off, 1.0 to 1.4 m away
    Standard,
    /// Enrolled parts hung anyhow: up to 30 degrees off, any roll, 0.9 to 1.8 m away
    Placed,
    /// The same parts of other car models
    OtherModels,
    /// Up to 45 degrees off, clutter, three times the noise, 10 to 25 % hidden or out of the picture
    Hard,
    /// Things that nobody enrolled, and empty cells
    Unknown,
    /// Right-hand parts where only the left-hand ones are enrolled
    Mirrored,
    /// Parts of both sides, both enrolled
    BothSides,
}

impl SuiteChoice {
    fn suites(self) -> Vec<Suite> {
        let one = match self {
            Self::All => return Suite::ALL.to_vec(),
            Self::Standard => Suite::Standard,
            Self::Placed => Suite::Placed,
            Self::OtherModels => Suite::OtherModels,
            Self::Hard => Suite::Hard,
            Self::Unknown => Suite::Unknown,
            Self::Mirrored => Suite::Mirrored,
            Self::BothSides => Suite::BothSides,
        };
        vec![one]
    }
}

/// Poses of each subject, unless asked for otherwise.
const NUM_POSES: u64 = 10;
/// Worst confusions that are named per suite.
const NUM_CONFUSIONS: usize = 6;

/// What `--json` writes.
#[derive(Debug, Serialize)]
struct SuitesFile<'a> {
    schema: u32,
    simulated: bool,
    first_seed: u64,
    suites: &'a [SuiteResult],
}

pub(super) fn run(args: &BenchArgs, console: &mut Console) -> anyhow::Result<Outcome> {
    let num_poses = args.poses.unwrap_or(NUM_POSES);
    let first_seed = args.seed.unwrap_or(MEASURING_SEED);
    let mut suites: Vec<Suite> = Vec::new();
    for suite in args.suite.iter().flat_map(|choice| choice.suites()) {
        if !suites.contains(&suite) {
            suites.push(suite);
        }
    }
    let pictures = args.pictures.as_deref().map(Pictures::make).transpose()?;
    let results = results(&suites, num_poses, first_seed, pictures, console)?;
    show(&results, num_poses, first_seed, console);
    if let Some(path) = &args.json {
        write(path, &results, first_seed)?;
    }
    Ok(Outcome::Accepted)
}

/// Where the stages of what went wrong are drawn: the first frame of each subject of each suite.
pub(super) struct Pictures {
    folder: ReportFolder,
    known: Vec<(Suite, String)>,
    failed: Option<ReportError>,
}

impl Pictures {
    fn make(folder: &Path) -> anyhow::Result<Self> {
        Ok(Self {
            folder: ReportFolder::make(folder).advised()?,
            known: Vec::new(),
            failed: None,
        })
    }

    fn keep(
        &mut self,
        suite: Suite,
        case: &SuiteCase,
        scene: &SceneCloud,
        inspection: &Inspection,
    ) {
        let key = (suite, case.subject.clone());
        let is_wrong = !case.is_right() || case.is_wrong_accepted();
        if !is_wrong || self.failed.is_some() || self.known.contains(&key) {
            return;
        }
        self.known.push(key);
        let found = case.found.as_deref().unwrap_or("nothing");
        let name = format!("{}_{}_as_{found}_{}", suite.name(), case.subject, case.seed);
        let line = InspectionLine::of(&name, inspection).to_json();
        let drawn = stage_pictures(scene, inspection);
        self.failed = self.folder.write(Path::new(&name), &line, &drawn).err();
    }
}

/// Runs suites one after the other, on this thread.
pub(super) fn results(
    suites: &[Suite],
    num_poses: u64,
    first_seed: u64,
    mut pictures: Option<Pictures>,
    console: &mut Console,
) -> anyhow::Result<Vec<SuiteResult>> {
    let libraries = SuiteLibraries::enrol(&EnrolParams::default()).advised()?;
    let frames: Vec<_> = suites
        .iter()
        .map(|suite| suite.frames(num_poses, first_seed))
        .collect();
    console.start_progress(frames.iter().map(Vec::len).sum());
    let recipe = Recipe::default();
    let mut results: Vec<SuiteResult> = Vec::new();
    for (suite, frames) in suites.iter().zip(&frames) {
        let library = libraries.of(*suite);
        let done = |case: &SuiteCase, scene: &SceneCloud, inspection: &Inspection| {
            console.done();
            if let Some(pictures) = &mut pictures {
                pictures.keep(*suite, case, scene, inspection);
            }
        };
        results.push(run_suite(
            *suite, frames, library, &recipe, &Unwatched, done,
        )?);
    }
    if let Some(error) = pictures.and_then(|pictures| pictures.failed) {
        return Err(error).advised();
    }
    console.end_progress();
    Ok(results)
}

pub(super) fn write(path: &Path, suites: &[SuiteResult], first_seed: u64) -> anyhow::Result<()> {
    let file = SuitesFile {
        schema: 1,
        simulated: true,
        first_seed,
        suites,
    };
    write_json(path, &file)
}

fn show(results: &[SuiteResult], num_poses: u64, first_seed: u64, console: &mut Console) {
    console.line(&format_args!(
        "Simulated: {num_poses} poses of each subject, seeds from {first_seed}, one thread. Of what must not be \
         accepted, right is not accepted."
    ));
    console.line(&"");
    let mut table = Table::new(&[
        "suite",
        "frames",
        "right",
        "right and accepted",
        "wrong and accepted",
        "not accepted",
        "of these unknown",
        "median",
    ]);
    for result in results {
        let total = result.cases.len();
        let share =
            |num: usize| format!("{num} ({:.1} %)", 100.0 * num as f64 / total.max(1) as f64);
        table.row([
            result.suite.name().to_owned(),
            total.to_string(),
            share(result.num(SuiteCase::is_right)),
            share(result.num(|c| c.is_right() && c.accepted)),
            share(result.num(SuiteCase::is_wrong_accepted)),
            share(result.num(|c| !c.accepted)),
            share(result.num(|c| c.is_unknown)),
            format!("{:.1} ms", result.median_ms().unwrap_or_default()),
        ]);
    }
    table.show(console);
    console.line(&"");
    show_bands(results, console);
    console.line(&"");
    for result in results {
        for confusion in result.confusions().iter().take(NUM_CONFUSIONS) {
            console.line(&format_args!(
                "  {}: {} taken for {}, {}×, accepted {}× (first seed {})",
                result.suite.name(),
                confusion.subject,
                confusion.found.as_deref().unwrap_or("nothing"),
                confusion.num,
                confusion.num_accepted,
                confusion.first_seed
            ));
        }
    }
}
