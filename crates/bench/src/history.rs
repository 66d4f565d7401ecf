//! Measures how long queries of a long history take.

use std::{sync::Arc, time::Instant};

use jiff::{SignedDuration, Timestamp};
use serde::Serialize;

use geometry::statistics::quantile;
use inspection::pipeline::{Recipe, RecipeLabel, Refusal, Rejection};
use records::history::{
    Filter, History, HistoryError, HungId, InspectionDetail, KeepFrames, NewEntry, Record,
    Retention, RobotMarks, SceneTitle, StoredVerdict, Summary,
};
use simulate::{CellSetup, PartKind, Side, frame};
use stages::scene::{SceneCloud, scene_from_frame};

/// Rows per page.
const PAGE: usize = 50;
/// Number of times that each query runs.
const NUM_TIMES: usize = 21;
/// Number of inspections that are written with their frames.
const NUM_WRITTEN: usize = 25;
/// Interval between two inspections, seconds: a hundred thousand of them span almost three years.
const APART: i64 = 900;

/// Time of one operation.
#[derive(Clone, Debug, Serialize)]
pub struct HistoryTime {
    /// Name of the operation.
    pub what: &'static str,
    /// Number of matching rows; for writing, bytes per frame.
    pub num: usize,
    /// Median, milliseconds.
    pub median_ms: f64,
    /// Maximum, milliseconds.
    pub longest_ms: f64,
    /// Budget, milliseconds.
    pub budget_ms: f64,
}

/// Fills a history with `num_rows` rows and times pages with their counts, the statistics, and writing entries with
/// frames.
pub fn history_times(num_rows: usize) -> Result<Vec<HistoryTime>, HistoryError> {
    let unwritable = |source| HistoryError::Unwritable {
        path: std::env::temp_dir(),
        source,
    };
    let folder = tempfile::tempdir().map_err(unwritable)?;
    let mut history = History::open(folder.path())?.history;
    let begun: Timestamp = Timestamp::UNIX_EPOCH;
    let recipe = Arc::new(Recipe::default());
    let at = |i: usize| begun + SignedDuration::from_secs(i as i64 * APART);
    history.add_all((0..num_rows).map(|i| entry(i, at(i), &recipe, None)))?;
    let since = |rows: usize| Some(at(num_rows.saturating_sub(rows)));
    let part = || Some("grille".to_owned());
    let everything = Filter::default;
    let filters = [
        ("no filter", everything()),
        (
            "the last 1000 by date",
            Filter {
                since: since(1000),
                ..everything()
            },
        ),
        (
            "one part",
            Filter {
                part: part(),
                ..everything()
            },
        ),
        (
            "not accepted",
            Filter {
                verdict: Some(StoredVerdict::Rejected.into()),
                ..everything()
            },
        ),
        (
            "a word",
            Filter {
                text: "frame 777".into(),
                ..everything()
            },
        ),
        (
            "a word that nothing has",
            Filter {
                text: "no such word".into(),
                ..everything()
            },
        ),
        (
            "all of them together",
            Filter {
                since: since(num_rows / 2),
                part: part(),
                verdict: Some(StoredVerdict::Rejected.into()),
                text: "grille simulated".into(),
                ..everything()
            },
        ),
    ];
    let mut times = Vec::new();
    for (what, filter) in filters {
        let num = history.page(&filter, 0, PAGE)?.num_matching;
        let mut ms = Vec::new();
        for number in 0..NUM_TIMES {
            // The first page, one in the middle and the last.
            let offset = num.saturating_sub(PAGE) * (number % 3) / 2;
            let begun = Instant::now();
            history.page(&filter, offset, PAGE)?;
            ms.push(begun.elapsed().as_secs_f64() * 1e3);
        }
        times.push(time(what, num, &ms, 50.0));
    }
    let mut ms = Vec::new();
    let mut num = 0;
    for _ in 0..NUM_TIMES {
        let begun = Instant::now();
        num = history.outcomes(&everything())?.len();
        ms.push(begun.elapsed().as_secs_f64() * 1e3);
    }
    times.push(time("statistics of all", num, &ms, 500.0));
    let setup = CellSetup::with_part(PartKind::Grille, Side::Left, 0, 3);
    let scene = Arc::new(scene_from_frame(&frame(&setup).frame));
    let all = Retention {
        keep: KeepFrames::All,
        ..Retention::default()
    };
    let mut ms = Vec::new();
    for i in 0..NUM_WRITTEN {
        let entry = entry(num_rows + i, geometry::clock::now(), &recipe, Some(&scene));
        let begun = Instant::now();
        history.add(&entry, &all)?;
        ms.push(begun.elapsed().as_secs_f64() * 1e3);
    }
    let bytes = history.usage()?.num_bytes as usize / NUM_WRITTEN;
    times.push(time("writing one with its frame", bytes, &ms, 100.0));
    Ok(times)
}

fn time(what: &'static str, num: usize, ms: &[f64], budget_ms: f64) -> HistoryTime {
    let of = |share| quantile(ms.iter().copied(), share).unwrap_or(0.0);
    HistoryTime {
        what,
        num,
        median_ms: of(0.5),
        longest_ms: of(1.0),
        budget_ms,
    }
}

fn entry(
    i: usize,
    at: Timestamp,
    recipe: &Arc<Recipe>,
    scene: Option<&Arc<SceneCloud>>,
) -> NewEntry {
    let part = PartKind::ALL[i % PartKind::ALL.len()];
    let is_accepted = !i.is_multiple_of(9);
    let verdict = if is_accepted {
        StoredVerdict::Accepted
    } else {
        StoredVerdict::Rejected
    };
    let refusal = (!is_accepted).then(|| {
        Refusal::from(Rejection::LowScore {
            part: part.name().to_owned(),
            score: 0.81,
            threshold: 0.9,
        })
    });
    NewEntry {
        record: Record {
            summary: Summary {
                number: 0,
                at,
                scene: SceneTitle::SimulatedFrame(i as u64),
                source: "simulated".into(),
                is_simulated: true,
                verdict,
                part: Some(part.name().into()),
                title: part.title().into(),
                reason: refusal.as_ref().map(Refusal::kind),
                noted: RobotMarks::default(),
                score: Some([0.97, 0.3]),
                total_ms: 40.0,
                remark: String::new(),
                label: None,
                frame_bytes: None,
                trace: records::history::Traceability::default(),
                hung: HungId::new(),
                parent: None,
                num_below: 0,
                rack: None,
            },
            detail: InspectionDetail {
                nearest: Some(part.name().into()),
                refusal,
                camera_from_part: None,
                recipe_label: RecipeLabel::default(),
                recipe_identity: recipe.identity(),
                recipe: Some(Arc::clone(recipe)),
                library_identity: "0badcafe".into(),
                program: env!("CARGO_PKG_VERSION").into(),
                // Length of a typical line.
                line: "x".repeat(1500),
                thumbnail: Vec::new(),
                origin: None,
                frame: None,
                frame_loss: None,
            },
        },
        picture: None,
        scene: scene.map(Arc::clone),
        shots: Vec::new(),
        stands_for_part: false,
    }
}
