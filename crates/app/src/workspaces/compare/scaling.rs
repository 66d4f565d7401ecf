//! Serial and parallel ranking: one query over a growing number of references, with one and with several workers.
//!
//! Corresponds to the paper's Fig. 7(a) and (b): over eight parts its parallel version was slower than the serial one,
//! over many samples faster. This measures from how many references on several workers pay off, which sets the default
//! of [`RankParams::parallel_from`](stages::rank::RankParams::parallel_from).
//!
//! Of a large library, not all references are compared in full. Over some frames it is counted how often the first is
//! nevertheless that of an exhaustive ranking.
//!
//! # The times
//! The worker counts take turns, so that a disturbance affects all of them. The fastest ranking of each decides, since
//! other load on the machine makes rankings slower, never faster. The medians are reported too.

mod references;

use std::time::{Duration, Instant};

use serde::Serialize;

use self::references::{NUM_MODELS, nth_reference, originals};
use geometry::{error::Advice, parallel::num_cores, statistics::quantile};
use inspection::{
    library::{EnrolError, Library},
    pipeline::{self, Cancelled, Inspection, ProgressObserver, Recipe},
};
use simulate::{CellSetup, Clutter, PartKind, Side, frame};
use stages::{
    rank::{EXHAUSTIVE_UP_TO, Matcher, Query, RankParams, rank, rank_by},
    reference::Reference,
    scene::scene_from_frame,
};

/// The worker counts compared; the first is serial.
pub const WORKERS: [usize; 4] = [1, 2, 4, 8];
/// Seed of the first simulated frame, one of those that parameters are tuned on.
const FIRST_SEED: u64 = 3_000_000;
/// Default for the largest number of references.
pub const MOST: usize = 10_000;

/// Ranking times for one number of references.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ScalingRow {
    /// Number of references ranked.
    pub num_references: usize,
    /// Fastest ranking per worker count, in the order of [`WORKERS`], milliseconds.
    pub least_ms: [f64; 4],
    /// Median per worker count, milliseconds.
    pub median_ms: [f64; 4],
    /// Rankings per worker count.
    pub num_runs: usize,
}

/// Ranking times for a growing number of references.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Scaling {
    /// The matcher that ranks.
    pub matcher: Matcher,
    /// Cores of this machine; more workers than these share them.
    pub num_cores: usize,
    /// Worker counts.
    pub workers: [usize; 4],
    /// One row per number of references, ascending.
    pub rows: Vec<ScalingRow>,
    /// For each worker count, the number of references from which on it pays off, as far as measured.
    pub crossovers: [Option<usize>; 4],
    /// True if every ranking was bit for bit the serial one.
    pub is_identical: bool,
    /// Number of frames in which the first of the most references is that of an exhaustive ranking, and number of frames;
    /// `None` where all rankings are exhaustive.
    pub same_first: Option<[usize; 2]>,
}

impl Scaling {
    /// Returns the number of references from which on all cores pay off; `None` if they never do, or there is only one.
    pub fn crossover(&self) -> Option<usize> {
        let index = WORKERS.iter().rposition(|&w| w <= self.num_cores)?;
        self.crossovers[index]
    }
}

/// Why the measurement failed.
#[derive(Debug, thiserror::Error, Advice)]
pub enum ScalingError {
    /// A simulated part could not be enrolled.
    #[error(transparent)]
    #[advice(transparent)]
    Enrol(#[from] EnrolError),
    /// The measurement was cancelled.
    #[error(transparent)]
    #[advice = "Run it again"]
    Cancelled(#[from] Cancelled),
    /// The query has no outline.
    #[error("the simulated query shows no part")]
    #[advice = "Report this: it is an error of the program"]
    NoQuery,
}

/// Ranks a simulated front door over 8, 16, 32 and so on up to `most` references.
pub fn scaling(
    matcher: Matcher,
    most: usize,
    watch: &dyn ProgressObserver,
    after_row: &mut dyn FnMut(&ScalingRow),
) -> Result<Scaling, ScalingError> {
    let setup = CellSetup::with_part(PartKind::FrontDoor, Side::Left, 0, FIRST_SEED);
    let inspection = inspected(&setup, watch)?;
    let query = inspection.query().ok_or(ScalingError::NoQuery)?;
    let params = RankParams {
        matcher,
        ..RankParams::default()
    };
    let originals = originals(most, watch)?;
    let mut references: Vec<Reference> = Vec::new();
    let mut scaling = Scaling {
        matcher,
        num_cores: num_cores(),
        workers: WORKERS,
        rows: Vec::new(),
        crossovers: [None; 4],
        is_identical: true,
        same_first: None,
    };
    for size in sizes(most) {
        while references.len() < size {
            references.push(nth_reference(&originals, references.len(), matcher));
        }
        let row = measure(
            &query,
            &references,
            &params,
            watch,
            &mut scaling.is_identical,
        )?;
        after_row(&row);
        scaling.rows.push(row);
    }
    scaling.crossovers = [0, 1, 2, 3].map(|index| crossover(&scaling.rows, index));
    if matcher == Matcher::Default && most > EXHAUSTIVE_UP_TO {
        scaling.same_first = Some(same_first(&references, &params, watch)?);
    }
    Ok(scaling)
}

/// Returns 8, 16, 32 and so on below `most`, and `most` itself.
pub fn sizes(most: usize) -> Vec<usize> {
    let doubled = (3..usize::BITS).map(|power| 1_usize << power);
    let mut sizes: Vec<usize> = doubled.take_while(|&size| size < most).collect();
    sizes.push(most);
    sizes
}

/// Workers pay off if they take less than this share of the serial time; a smaller gain is noise.
const PAYING: f64 = 0.9;

/// Returns the first of two consecutive sizes at which these workers pay off; a single one may be a disturbance.
fn crossover(rows: &[ScalingRow], index: usize) -> Option<usize> {
    let pays = |row: &ScalingRow| index > 0 && row.least_ms[index] < PAYING * row.least_ms[0];
    let mut pairs = rows.windows(2);
    let pair = pairs.find(|pair| pair.iter().all(pays))?;
    pair.first().map(|row| row.num_references)
}

/// Approximate total time of the repeated rankings per worker count. The tests check the rankings, not the times.
const TIME_EACH: Duration = Duration::from_millis(if cfg!(test) { 40 } else { 400 });

fn measure(
    query: &Query<'_>,
    references: &[Reference],
    params: &RankParams,
    watch: &dyn ProgressObserver,
    is_identical: &mut bool,
) -> Result<ScalingRow, Cancelled> {
    // Also serves as warm-up.
    let begun = Instant::now();
    let serial = rank_by(1, query, references, params);
    let one = begun.elapsed().as_secs_f64().max(1e-6);
    let num_runs = ((TIME_EACH.as_secs_f64() / one) as usize).clamp(5, 401);
    let mut times = [const { Vec::new() }; 4];
    for _ in 0..num_runs {
        for (times, workers) in times.iter_mut().zip(WORKERS) {
            if watch.is_cancelled() {
                return Err(Cancelled);
            }
            let begun = Instant::now();
            let ranking = rank_by(workers, query, references, params);
            times.push(begun.elapsed().as_secs_f64() * 1e3);
            *is_identical &= ranking == serial;
        }
    }
    let share = |share: f64| {
        let of = |times: &Vec<f64>| quantile(times.iter().copied(), share);
        times.each_ref().map(|times| of(times).unwrap_or(f64::NAN))
    };
    Ok(ScalingRow {
        num_references: references.len(),
        least_ms: share(0.0),
        median_ms: share(0.5),
        num_runs,
    })
}

/// Number of frames whose first reference is compared with that of an exhaustive ranking.
const NUM_FRAMES: u64 = 64;

/// Ranks simulated parts of the enrolled models, every second partly hidden, with and without leaving references out.
fn same_first(
    references: &[Reference],
    params: &RankParams,
    watch: &dyn ProgressObserver,
) -> Result<[usize; 2], Cancelled> {
    let (mut num_same, mut num_frames) = (0, 0);
    for number in 0..NUM_FRAMES {
        let kind = PartKind::ALL[number as usize % PartKind::ALL.len()];
        let model = number / PartKind::ALL.len() as u64 % NUM_MODELS;
        let mut setup = CellSetup::with_part(kind, Side::Left, model, FIRST_SEED + number);
        if (number + model) % 2 == 1 {
            setup.clutter = Clutter::InFront;
        }
        let inspection = inspected(&setup, watch)?;
        if let Some(query) = inspection.query() {
            let ranking = rank(&query, references, params);
            let exhaustive = references.chunks(EXHAUSTIVE_UP_TO).flat_map(|some| {
                let ranking = rank(&query, some, params);
                ranking.entries.into_iter().map(|entry| entry.score)
            });
            let best = exhaustive.fold(0.0, f64::max);
            num_frames += 1;
            num_same += usize::from(ranking.entries[0].score >= best);
        }
    }
    Ok([num_same, num_frames])
}

/// Inspects a simulated frame up to its signature.
fn inspected(setup: &CellSetup, watch: &dyn ProgressObserver) -> Result<Inspection, Cancelled> {
    let scene = scene_from_frame(&frame(setup).frame);
    pipeline::run(&scene, &Library::default(), &Recipe::default(), watch)
}

#[cfg(test)]
mod tests {
    use super::*;
    use inspection::pipeline::Unwatched;

    fn check_rankings(matcher: Matcher) {
        let mut seen = Vec::new();
        let mut after_row = |row: &ScalingRow| seen.push(row.num_references);
        let found = scaling(matcher, 70, &Unwatched, &mut after_row).expect("measured");
        assert!(found.is_identical);
        assert_eq!(seen, [8, 16, 32, 64, 70]);
        let mut times = found.rows.iter().flat_map(|row| row.least_ms);
        assert!(times.all(|ms| ms > 0.0));
    }

    #[test]
    fn every_number_of_workers_gives_the_serial_ranking() {
        check_rankings(Matcher::Default);
    }

    #[test]
    fn every_number_of_workers_gives_the_serial_ranking_of_the_paper() {
        check_rankings(Matcher::Paper);
    }

    #[test]
    fn workers_pay_from_the_first_of_two_sizes_at_which_they_are_a_tenth_quicker() {
        let row = |num_references, two: f64, four: f64| ScalingRow {
            num_references,
            least_ms: [1.0, two, four, 0.5],
            median_ms: [1.0; 4],
            num_runs: 5,
        };
        let rows = [
            row(8, 0.8, 1.2),
            row(16, 0.95, 1.1),
            row(32, 0.8, 1.0),
            row(64, 0.7, 0.8),
        ];
        let found = [0, 1, 2, 3].map(|index| crossover(&rows, index));
        assert_eq!(found, [None, Some(32), None, Some(8)]);
    }
}
