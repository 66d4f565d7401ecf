//! `partsight-bench recognition`: recognition rate, acceptance and false accepts on sets of simulated frames, then the
//! paper's matcher and the other systems of its Table I on the same frames.

use std::path::PathBuf;

use clap::Args;
use serde::Serialize;

use super::{
    FrameChoice, calibration::show_bands, confusions::Pictures, systems::SystemsTable, write_json,
};
use crate::{
    suites::{
        ExpectationFigures, InspectedFrame, MEASURING_SEED, NearestMistake, RackFigures, Suite,
        SuiteCase, SuiteFigures, SuiteFrame, SuiteLibraries, SuiteResult, add_expected_racks,
        run_suite,
    },
    systems::Systems,
};
use inspection::{
    library::EnrolParams,
    pipeline::{Recipe, RecipeBlock, parameters::changed_settings},
};
use partsight::cli::{
    Outcome,
    console::{Advised as _, Console, Table},
    input::{Choice, choice},
    recipe::{RecipeSource, show_recipe},
};

/// The suites of racks.
const RACKS: [Suite; 8] = [
    Suite::RackApart,
    Suite::RackOnBar,
    Suite::RackTouching,
    Suite::RackOverlapping,
    Suite::RackEqual,
    Suite::RackMirrored,
    Suite::RackForeign,
    Suite::RackEmpty,
];

/// The suites by name.
#[rustfmt::skip]
pub(super) const SUITES: [Choice<&[Suite]>; 14] = [
    ("all", "All of them", &Suite::ALL),
    ("standard", "Enrolled parts hung with care: up to 10 degrees off, 1.0 to 1.4 m away", &[Suite::Standard]),
    ("placed", "Enrolled parts hung anyhow: up to 30 degrees off, any roll, 0.9 to 1.8 m away", &[Suite::Placed]),
    ("other-models", "The same parts of other car models", &[Suite::OtherModels]),
    ("hard", "Up to 45 degrees off, clutter, three times the noise, 10 to 25 % hidden or out of the picture", &[Suite::Hard]),
    ("unknown", "Things that nobody enrolled, and empty cells", &[Suite::Unknown]),
    ("mirrored", "Right-hand parts where only the left-hand ones are enrolled", &[Suite::Mirrored]),
    ("both-sides", "Parts of both sides, both enrolled", &[Suite::BothSides]),
    ("floor", "Enrolled parts that stand or lean on the floor, up to 30 degrees off", &[Suite::Floor]),
    ("booth", "Enrolled parts on a stand in a paint booth, seen from the robot's flange; most of them cut by the picture", &[Suite::Booth]),
    ("booth-unknown", "Things that nobody enrolled on a stand in the booth, and stands without a part", &[Suite::BoothUnknown]),
    ("other-makes", "The same parts of cars of other makes, 6 to 12 % off in every dimension", &[Suite::OtherMakes]),
    ("noisy-makes", "The same with three times the noise", &[Suite::NoisyMakes]),
    ("rack", "Racks of 2 to 5 places: enrolled parts apart, on a bar, touching, overlapping, two equal ones, left and right of one kind, with an unknown object, with an empty place", &RACKS),
];

/// Default number of poses per subject.
const NUM_POSES: u64 = 10;
/// Number of worst confusions listed per suite.
const NUM_CONFUSIONS: usize = 6;

/// The file that `--json` writes.
#[derive(Debug, Serialize)]
struct RecognitionFile<'a> {
    schema: u32,
    simulated: bool,
    first_seed: u64,
    recipe: RecipeBlock,
    /// Parameters that differ from their defaults.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    changed: Vec<String>,
    suites: &'a [SuiteResult],
    figures: &'a [SuiteFigures],
    #[serde(skip_serializing_if = "Vec::is_empty")]
    racks: Vec<RackFigures>,
    /// Racks that were inspected with an expectation.
    #[serde(skip_serializing_if = "Option::is_none")]
    expected: Option<&'a [ExpectationFigures; 4]>,
    closest: &'a [NearestMistake],
    #[serde(skip_serializing_if = "Option::is_none")]
    table1: Option<&'a SystemsTable>,
}

#[derive(Debug, Args)]
pub(super) struct RecognitionArgs {
    #[command(flatten)]
    frames: FrameChoice,
    /// These sets of frames; may be given several times
    #[arg(long, value_parser = choice(&SUITES), value_name = "NAME")]
    suite: Vec<&'static [Suite]>,
    /// Leave out the other systems of the paper's Table I, which take most of the time
    #[arg(long)]
    only_ours: bool,
    /// Draw into this folder what went wrong, the first of each subject, and of each part the frame in which another came nearest
    #[arg(long, value_name = "DIR")]
    pictures: Option<PathBuf>,
    #[command(flatten)]
    recipe: RecipeSource,
}

pub(super) fn run(args: &RecognitionArgs, console: &mut Console) -> anyhow::Result<Outcome> {
    let frames = Frames::of(&args.frames, &args.suite, &Suite::ALL, NUM_POSES);
    let recipe = args.recipe.recipe_or_built_in()?;
    let libraries = SuiteLibraries::enrol(&EnrolParams::default()).advised()?;
    let systems = if args.only_ours {
        None
    } else {
        Some(Systems::prepare(&libraries.left).advised()?)
    };
    let mut shown = Vec::new();
    let mut pictures = args.pictures.as_deref().map(Pictures::make).transpose()?;
    let results = frames.inspect_with(&libraries, &recipe, console, |suite, frame| {
        let scene = &frame.scene;
        for (case, inspection) in &frame.cases {
            if let Some((pictures, inspection)) = pictures.as_mut().zip(inspection.as_ref()) {
                pictures.keep(suite, case, scene, inspection, libraries.for_suite(suite));
            }
            if let Some(systems) = systems.as_ref().filter(|_| suite.is_for_all_systems()) {
                shown.extend(systems.recognise(suite, case, scene, &recipe));
            }
        }
    });
    let expected = frames.expected(&libraries, &recipe, console);
    if let Some(pictures) = pictures {
        pictures.write()?;
        if let Some(folder) = &args.pictures {
            console.note(&format_args!("The pictures are in {}", folder.display()));
        }
    }
    let closest = NearestMistake::per_part(&results);
    console.line(&format_args!(
        "Simulated: {}, one thread. Of what must not be accepted, right is not accepted.",
        frames.words()
    ));
    let changed = changed_settings(&recipe, &[]);
    show_recipe(&recipe, console);
    if !changed.is_empty() {
        console.line(&format_args!("Changed: {}", changed.join(", ")));
    }
    console.line(&"");
    show(&results, console);
    let figures: Vec<SuiteFigures> = results.iter().map(SuiteFigures::of).collect();
    show_figures(&figures, console);
    let racks: Vec<RackFigures> = results.iter().filter_map(RackFigures::of).collect();
    show_racks(&racks, console);
    if let Some(expected) = &expected {
        show_expected(expected, console);
    }
    show_closest(&closest, console);
    let table1 = systems.map(|systems| SystemsTable::of(&systems, &shown));
    if let Some(table1) = table1.as_ref().filter(|_| !shown.is_empty()) {
        console.line(&"");
        table1.show(console);
    }
    if let Some(path) = &args.frames.file.json {
        let file = RecognitionFile {
            schema: 2,
            simulated: true,
            first_seed: frames.first_seed,
            recipe: RecipeBlock::from(&recipe),
            changed,
            suites: &results,
            figures: &figures,
            racks,
            expected: expected.as_ref(),
            closest: &closest,
            table1: table1.as_ref(),
        };
        write_json(path, &file)?;
    }
    Ok(Outcome::Accepted)
}

/// The frames to inspect.
pub(super) struct Frames {
    suites: Vec<(Suite, Vec<SuiteFrame>)>,
    num_poses: u64,
    pub(super) first_seed: u64,
}

impl Frames {
    /// Selects the suites asked for, or these if there are none.
    pub(super) fn of(
        choice: &FrameChoice,
        asked_for: &[&[Suite]],
        suites: &[Suite],
        num_poses: u64,
    ) -> Self {
        let mut chosen: Vec<Suite> = Vec::new();
        for suite in asked_for.concat() {
            if !chosen.contains(&suite) {
                chosen.push(suite);
            }
        }
        if chosen.is_empty() {
            chosen.extend(suites);
        }
        let first_seed = choice.seed.unwrap_or(MEASURING_SEED);
        Self::from_seed(&chosen, choice.poses.unwrap_or(num_poses), first_seed)
    }

    /// Creates the frames of these suites from a seed on.
    pub(super) fn from_seed(suites: &[Suite], num_poses: u64, first_seed: u64) -> Self {
        let frames = |suite: &Suite| (*suite, suite.frames(num_poses, first_seed));
        Self {
            suites: suites.iter().map(frames).collect(),
            num_poses,
            first_seed,
        }
    }

    /// Describes the frames.
    pub(super) fn words(&self) -> String {
        let Self {
            num_poses,
            first_seed,
            ..
        } = self;
        let is_rack = |(suite, _): &(Suite, _)| suite.rack().is_some();
        let racks = if self.suites.iter().any(is_rack) {
            " or racks of each kind"
        } else {
            ""
        };
        format!("{num_poses} poses of each subject{racks}, seeds from {first_seed}")
    }

    /// Inspects the frames one after the other on this thread.
    pub(super) fn inspect(&self, console: &mut Console) -> anyhow::Result<Vec<SuiteResult>> {
        let libraries = SuiteLibraries::enrol(&EnrolParams::default()).advised()?;
        Ok(self.inspect_with(&libraries, &Recipe::default(), console, |_, _| {}))
    }

    /// As [`inspect`](Self::inspect) with these libraries and this recipe; calls `after_each` with every frame.
    fn inspect_with(
        &self,
        libraries: &SuiteLibraries,
        recipe: &Recipe,
        console: &mut Console,
        mut after_each: impl FnMut(Suite, &InspectedFrame),
    ) -> Vec<SuiteResult> {
        console.start_progress(self.suites.iter().map(|(_, frames)| frames.len()).sum());
        let mut results: Vec<SuiteResult> = Vec::new();
        for (suite, frames) in &self.suites {
            let library = libraries.for_suite(*suite);
            let done = |frame: &InspectedFrame| {
                after_each(*suite, frame);
                console.done();
            };
            results.push(run_suite(*suite, frames, library, recipe, done));
        }
        console.end_progress();
        results
    }

    /// Inspects the racks again, with an expectation; `None` if there are none.
    fn expected(
        &self,
        libraries: &SuiteLibraries,
        recipe: &Recipe,
        console: &mut Console,
    ) -> Option<[ExpectationFigures; 4]> {
        let racks = (self.suites.iter()).filter(|(suite, _)| suite.rack().is_some());
        let racks: Vec<_> = racks.collect();
        if racks.is_empty() {
            return None;
        }
        console.start_progress(racks.iter().map(|(_, frames)| frames.len()).sum());
        let mut figures = ExpectationFigures::none();
        for (suite, frames) in racks {
            let library = libraries.for_suite(*suite);
            add_expected_racks(*suite, frames, library, recipe, &mut figures, || {
                console.done();
            });
        }
        console.end_progress();
        Some(figures)
    }
}

fn show(results: &[SuiteResult], console: &mut Console) {
    let mut table = Table::new(&[
        "suite",
        "cases",
        "right",
        "right and accepted",
        "false accepts",
        "not accepted",
        "of these unknown",
        "approximate",
        "median time",
        "pose within 2° and 10 mm",
        "median error",
        "95 % below",
    ]);
    for result in results {
        let total = result.cases.len();
        let share = |num: usize, of: usize| {
            format!("{num} ({:.1} %)", 100.0 * num as f64 / of.max(1) as f64)
        };
        let num_placed = result.num(|c| c.pose_off().is_some());
        let error = |share| match result.pose_off_quantile(share) {
            Some([turn, shift]) => format!("{turn:.2}°, {shift:.1} mm"),
            None => "-".to_owned(),
        };
        table.row([
            result.suite.name().to_owned(),
            total.to_string(),
            share(result.num(SuiteCase::is_right), total),
            share(result.num(|c| c.is_right() && c.accepted), total),
            share(result.num(SuiteCase::is_wrong_accepted), total),
            share(result.num(|c| !c.accepted), total),
            share(result.num(|c| c.is_unknown), total),
            share(result.num(|c| c.is_approximate), total),
            format!("{:.1} ms", result.median_ms().unwrap_or_default()),
            match num_placed {
                0 => "-".to_owned(),
                _ => share(result.num(SuiteCase::is_well_placed), num_placed),
            },
            error(0.5),
            error(0.95),
        ]);
    }
    console.table(&table);
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

/// Shows acceptance where at least 40 % is in sight, poses with their bounds, segmentation and time.
fn show_figures(figures: &[SuiteFigures], console: &mut Console) {
    console.line(&"");
    console.line(
        &"Frames with at least 40 % of an enrolled part in sight; poses and bounds of those that were named rightly and \
          accepted; the overlap of what was taken for the part with what shows it (intersection over union); time.",
    );
    console.line(&"");
    let mut table = Table::new(&[
        "suite",
        "40 % in sight",
        "right",
        "right and accepted",
        "false accepts",
        "pose within 2° and 10 mm",
        "with bounds",
        "bounds hold",
        "overlap",
        "5 % below",
        "from 0.9 on",
        "median time",
        "95 %",
        "longest",
    ]);
    let share = |num: usize, of: usize| match of {
        0 => "-".to_owned(),
        _ => format!("{num}/{of} ({:.1} %)", 100.0 * num as f64 / of as f64),
    };
    let or_none = |text: Option<String>| text.unwrap_or_else(|| "-".to_owned());
    let iou = |x: Option<f64>| or_none(x.map(|x| format!("{x:.3}")));
    let ms = |x: Option<f64>| or_none(x.map(|x| format!("{x:.1} ms")));
    for f in figures {
        table.row([
            f.suite.name().to_owned(),
            f.num_in_sight.to_string(),
            share(f.num_in_sight_right, f.num_in_sight),
            share(f.num_in_sight_accepted, f.num_in_sight),
            f.num_wrong_accepted.to_string(),
            share(f.num_accepted_well_placed, f.num_accepted),
            share(f.num_bounded, f.num_accepted),
            share(f.num_bounds_hold, f.num_bounded),
            iou(f.iou_median),
            iou(f.iou_p05),
            or_none(f.iou_good.map(|share| format!("{:.1} %", share * 100.0))),
            ms(f.median_ms),
            ms(f.p95_ms),
            ms(f.max_ms),
        ]);
    }
    console.table(&table);
}

/// Shows what only racks are counted for.
fn show_racks(racks: &[RackFigures], console: &mut Console) {
    if racks.is_empty() {
        return;
    }
    console.line(&"");
    console.line(
        &"Racks: each part and object is a case, and so is each inspection of nothing that hangs there, or of something again.",
    );
    console.line(&"");
    let mut table = Table::new(&[
        "suite",
        "frames",
        "enrolled parts",
        "not inspected",
        "accepted twice",
        "accepted where nothing hangs",
        "not enrolled",
        "reported as unknown or mirrored",
        "not inspected",
        "refused of nothing or again",
        "median time",
    ]);
    for f in racks {
        let ms = f.median_ms.map(|ms| format!("{ms:.1} ms"));
        let nums = [
            f.num_frames,
            f.num_parts,
            f.num_parts_missed,
            f.num_accepted_again,
            f.num_nothing_accepted,
            f.num_unknown,
            f.num_unknown_told,
            f.num_unknown_missed,
            f.num_surplus_refused,
        ];
        let name = [f.suite.name().to_owned()].into_iter();
        let nums = nums.into_iter().map(|num| num.to_string());
        table.row(name.chain(nums).chain(ms));
    }
    console.table(&table);
}

/// Shows the verdicts on racks that were inspected with an expectation.
fn show_expected(figures: &[ExpectationFigures], console: &mut Console) {
    console.line(&"");
    console.line(
        &"Racks with an expectation: every part that hangs there; the same with one replaced by another; with one more; and only one \
          of them. The right verdict is: as expected; wrong part, with the expected one; missing; and the one part accepted, but \
          as expected only if no other hangs there.",
    );
    console.line(&"");
    let mut table = Table::new(&[
        "expected",
        "frames",
        "false accepts",
        "as expected",
        "right verdict",
    ]);
    for f in figures {
        table.row([
            f.expectation.name().to_owned(),
            f.num_frames.to_string(),
            f.num_wrong_accepted.to_string(),
            f.num_met.to_string(),
            format!(
                "{} ({:.1} %)",
                f.num_right,
                100.0 * f.num_right as f64 / f.num_frames.max(1) as f64
            ),
        ]);
    }
    console.table(&table);
}

/// Shows for each part the frame in which another part scored highest.
fn show_closest(closest: &[NearestMistake], console: &mut Console) {
    if closest.is_empty() {
        return;
    }
    console.line(&"");
    console.line(
        &"Of each part, the frame in which another one came nearest to being taken for it; --pictures draws why.",
    );
    console.line(&"");
    // A clearly different part scores far below a thousandth.
    let score = |score: f64| {
        if score < 0.001 {
            format!("{score:.0e}")
        } else {
            format!("{score:.3}")
        }
    };
    let mut table = Table::new(&[
        "part",
        "nearest other",
        "its score",
        "the part's",
        "suite",
        "seed",
        "verdict",
    ]);
    for case in closest {
        table.row([
            case.part.clone(),
            case.other.clone(),
            score(case.other_score),
            score(case.own_score),
            case.suite.name().to_owned(),
            case.seed.to_string(),
            case.verdict(),
        ]);
    }
    console.table(&table);
}
