//! The left half of the paper's Table I: ours, the paper's matcher and other systems on the same frames.

use serde::Serialize;

use crate::{
    suites::Suite,
    systems::{
        PAPER_COLUMNS, PAPER_MEAN_OF_OTHERS, PAPER_MEAN_OF_OWN, PAPER_SECONDS, Preparation, System,
        Systems, SystemsCase, paper_means,
    },
};
use geometry::statistics::quantile;
use partsight::cli::console::{Console, Table};
use simulate::PartKind;

/// Results of the systems, as `--json` writes them.
#[derive(Debug, Serialize)]
pub(super) struct SystemsTable {
    num_frames: usize,
    num_points_median: Option<f64>,
    systems: Vec<SystemLine>,
    /// The paper's own Table I, seconds.
    paper: PaperLines,
    frames: Vec<FrameLine>,
}

#[derive(Debug, Serialize)]
struct SystemLine {
    system: System,
    source: &'static str,
    num_right: usize,
    by_suite: Vec<SuiteShare>,
    median_ms: Option<f64>,
    p95_ms: Option<f64>,
    /// Median number of points of the thinned surface.
    num_surface_points: Option<f64>,
    /// Median number of descriptor rows of the part.
    num_rows: Option<f64>,
    /// Number of descriptor rows of all references.
    num_reference_rows: Option<usize>,
    prepare_ms: f64,
}

/// Results of a system in one suite.
#[derive(Clone, Copy, Debug, Serialize)]
struct SuiteShare {
    suite: Suite,
    num_right: usize,
    num_frames: usize,
}

#[derive(Debug, Serialize)]
struct PaperLines {
    columns: [&'static str; 5],
    /// Part, and seconds per column.
    parts: Vec<(&'static str, [f64; 5])>,
    mean_of_others_as_stated: f64,
    mean_of_own_as_stated: f64,
}

impl PaperLines {
    fn as_printed() -> Self {
        let names = PartKind::ALL.map(PartKind::name);
        Self {
            columns: PAPER_COLUMNS,
            parts: names.into_iter().zip(PAPER_SECONDS).collect(),
            mean_of_others_as_stated: PAPER_MEAN_OF_OTHERS,
            mean_of_own_as_stated: PAPER_MEAN_OF_OWN,
        }
    }
}

#[derive(Debug, Serialize)]
struct FrameLine {
    suite: Suite,
    truth: String,
    seed: u64,
    num_points: Option<usize>,
    answers: Vec<AnswerLine>,
}

#[derive(Debug, Serialize)]
struct AnswerLine {
    system: System,
    found: Option<String>,
    time_ms: f64,
}

impl SystemsTable {
    pub(super) fn of(systems: &Systems<'_>, cases: &[SystemsCase]) -> Self {
        let known = cases.iter().filter_map(|case| case.num_points);
        Self {
            num_frames: cases.len(),
            num_points_median: quantile(known.map(|n| n as f64), 0.5),
            systems: system_lines(systems, cases),
            paper: PaperLines::as_printed(),
            frames: cases.iter().map(frame_line).collect(),
        }
    }

    pub(super) fn show(&self, console: &mut Console) {
        let num_frames = self.num_frames;
        console.line(&format_args!(
            "The left half of the paper's Table I, on the {num_frames} frames of these suites in which an enrolled part \
             hangs. The part is segmented once for all: {:.0} points (median). Every system names one of 8 references, \
             none may refuse. The time is the processor's on this machine, for describing the part and matching it. \
             FPFH, SHOT, spin images and VFH are our choice: the paper's sources for its four are not known to us.",
            self.num_points_median.unwrap_or(0.0),
        ));
        console.line(&"");
        let suites: Vec<Suite> = self.systems.first().map_or_else(Vec::new, |line| {
            line.by_suite.iter().map(|share| share.suite).collect()
        });
        let heading = ["system", "source", "right"].into_iter();
        let heading = heading.chain(suites.iter().map(|suite| suite.name()));
        let rest = [
            "median",
            "95 %",
            "points kept",
            "rows",
            "rows of 8",
            "prepared in",
        ];
        let mut table = Table::new(&heading.chain(rest).collect::<Vec<_>>());
        let whole = |x: Option<f64>| x.map_or_else(|| "-".to_owned(), |x| format!("{x:.0}"));
        let ms = |x: Option<f64>| x.map_or_else(|| "-".to_owned(), |x| format!("{x:.1} ms"));
        let share = |num: usize, of: usize| {
            format!(
                "{num}/{of} ({:.1} %)",
                100.0 * num as f64 / of.max(1) as f64
            )
        };
        for line in &self.systems {
            let first = [
                line.system.title().to_owned(),
                line.source.to_owned(),
                share(line.num_right, num_frames),
            ];
            let by_suite = line.by_suite.iter();
            let by_suite =
                by_suite.map(|suite| format!("{}/{}", suite.num_right, suite.num_frames));
            let last = [
                ms(line.median_ms),
                ms(line.p95_ms),
                whole(line.num_surface_points),
                whole(line.num_rows),
                whole(line.num_reference_rows.map(|n| n as f64)),
                ms(Some(line.prepare_ms)),
            ];
            table.row(first.into_iter().chain(by_suite).chain(last));
        }
        console.table(&table);
        console.line(&"");
        show_paper(console);
    }
}

fn system_lines(systems: &Systems<'_>, cases: &[SystemsCase]) -> Vec<SystemLine> {
    let mut suites: Vec<Suite> = cases.iter().map(|case| case.suite).collect();
    suites.dedup();
    let line = |(index, (system, prepared)): (usize, (System, Preparation))| {
        let answers = || cases.iter().filter_map(move |c| c.answers.get(index));
        let ms = || answers().map(|a| a.time.as_secs_f64() * 1e3);
        let sizes = || answers().filter_map(|a| a.size);
        let in_suite = |suite: &Suite| {
            let frames = || cases.iter().filter(|case| case.suite == *suite);
            SuiteShare {
                suite: *suite,
                num_right: frames().filter(|case| case.is_right(index)).count(),
                num_frames: frames().count(),
            }
        };
        SystemLine {
            system,
            source: system.source(),
            num_right: cases.iter().filter(|case| case.is_right(index)).count(),
            by_suite: suites.iter().map(in_suite).collect(),
            median_ms: quantile(ms(), 0.5),
            p95_ms: quantile(ms(), 0.95),
            num_surface_points: quantile(sizes().map(|s| s.num_points as f64), 0.5),
            num_rows: quantile(sizes().map(|s| s.num_rows as f64), 0.5),
            num_reference_rows: prepared.num_rows,
            prepare_ms: prepared.time.as_secs_f64() * 1e3,
        }
    };
    let prepared = System::ALL.into_iter().zip(systems.preparations());
    prepared.enumerate().map(line).collect()
}

fn frame_line(case: &SystemsCase) -> FrameLine {
    let answers = System::ALL.into_iter().zip(&case.answers);
    FrameLine {
        suite: case.suite,
        truth: case.expected.clone(),
        seed: case.seed,
        num_points: case.num_points,
        answers: answers
            .map(|(system, answer)| AnswerLine {
                system,
                found: answer.found.clone(),
                time_ms: answer.time.as_secs_f64() * 1e3,
            })
            .collect(),
    }
}

fn show_paper(console: &mut Console) {
    console.line(
        &"The paper's own, seconds per part on its machine and captures. It names its four other systems only by number, \
          calls all eight parts recognised, and counts no errors.",
    );
    console.line(&"");
    let mut heading = vec!["part"];
    heading.extend(PAPER_COLUMNS);
    let mut table = Table::new(&heading);
    for (part, seconds) in PartKind::ALL.iter().zip(PAPER_SECONDS) {
        let cells = seconds.map(|s| format!("{s}"));
        table.row(std::iter::once(part.name().to_owned()).chain(cells));
    }
    let means = paper_means().map(|mean| format!("{mean:.3}"));
    table.row(std::iter::once("mean".to_owned()).chain(means));
    console.table(&table);
    console.line(&format_args!(
        "In its text: {PAPER_MEAN_OF_OTHERS} s for the four on average, {PAPER_MEAN_OF_OWN} s for its own."
    ));
}
