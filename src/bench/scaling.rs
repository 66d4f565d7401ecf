//! Serial and parallel: one query ranked over a growing number of references by one and by several workers.
//!
//! The paper's Fig. 7(a) and (b): over eight parts its parallel version was slower than the serial one, over many
//! samples faster. The question here is from how many references on several workers pay; the default of
//! [`RankParams::parallel_from`](crate::stages::rank::RankParams::parallel_from) is the answer.
//!
//! # The references
//! Simulated. The first 64 are the eight parts of eight models of the car, each enrolled from a frontal capture. All
//! further ones are *perturbed signatures* of these: the ray lengths swing by a few per cent over the outline, the
//! images are those of the original at 25 mm a pixel, and there is no cloud. They are no parts, and what they score
//! means nothing; but ranking does the same work for them, since its transforms go over all rays and its overlap over
//! the points of the scene. That keeps a reference at a quarter of a megabyte, and ten thousand below 3 GB.
//!
//! # The times
//! The numbers of workers rank in turns, so that a disturbance hits all of them. The quickest ranking of each decides:
//! whatever else the machine does makes rankings slower, never quicker. The medians are kept beside it.

use std::time::{Duration, Instant};

use nalgebra::Vector2;
use rand::{RngExt as _, SeedableRng as _};
use rand_pcg::Pcg64;
use serde::Serialize;

use super::{speed::quantile, suites::enrol_part};
use crate::{
    error::Advice,
    geometry::{
        nearest::KdTree, nearest_field::NearestField, parallel::num_cores, raster::BinaryImage,
    },
    library::{EnrolError, EnrolParams, Library},
    pipeline::{self, Cancelled, Inspection, Recipe, Watch},
    simulate::{CellSetup, PartKind, Side, frame},
    stages::{
        correlation::{LiteralReference, spectrum},
        pose::edge_points::EdgePoints,
        project::PlaneImage,
        rank::{Matcher, Query, RankParams, rank_by},
        reference::{Reference, ReferenceView},
        scene::scene_from_frame,
    },
    units::Metres,
};

/// Numbers of workers that are compared; the first is serial.
pub const WORKERS: [usize; 4] = [1, 2, 4, 8];
/// The most references that the default measures.
pub const MOST: usize = 10_000;

/// What a ranking took.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ScalingRow {
    /// References ranked.
    pub num_references: usize,
    /// The quickest ranking per number of workers, in the order of [`WORKERS`], milliseconds.
    pub least_ms: [f64; 4],
    /// The same for the median.
    pub median_ms: [f64; 4],
    /// Rankings per number of workers.
    pub num_runs: usize,
}

/// What ranking takes over a growing number of references.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Scaling {
    /// By which matcher.
    pub matcher: Matcher,
    /// Cores of this machine: more workers than these share them.
    pub num_cores: usize,
    /// Numbers of workers.
    pub workers: [usize; 4],
    /// From few references to many.
    pub rows: Vec<ScalingRow>,
    /// For each number of workers the references from which on they pay, as far as was measured.
    pub crossovers: [Option<usize>; 4],
    /// Whether every ranking was, bit for bit, the serial one.
    pub is_identical: bool,
}

impl Scaling {
    /// From how many references on all cores pay; `None` if they never do, or there is one.
    pub fn crossover(&self) -> Option<usize> {
        let place = WORKERS.iter().rposition(|&w| w <= self.num_cores)?;
        self.crossovers[place]
    }
}

/// Why there is no measurement.
#[derive(Debug, thiserror::Error)]
pub enum ScalingError {
    /// A simulated part could not be enrolled.
    #[error(transparent)]
    Enrol(#[from] EnrolError),
    /// It was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// The query has no outline.
    #[error("the simulated query shows no part")]
    NoQuery,
}

impl Advice for ScalingError {
    fn advice(&self) -> String {
        match self {
            Self::Enrol(error) => error.advice(),
            Self::Cancelled(_) => "Run it again".into(),
            Self::NoQuery => "Report this: it is an error of the program".into(),
        }
    }
}

/// Ranks a simulated front door over 8, 16, 32 and so on to `most` references.
pub fn scaling(
    matcher: Matcher,
    most: usize,
    watch: &dyn Watch,
    after_row: &mut dyn FnMut(&ScalingRow),
) -> Result<Scaling, ScalingError> {
    let inspection = query(watch)?;
    let query = Query {
        plane: inspection.plane.as_ref().ok_or(ScalingError::NoQuery)?,
        contour: inspection.contour.as_ref().ok_or(ScalingError::NoQuery)?,
        signature: inspection.signature.as_ref().ok_or(ScalingError::NoQuery)?,
    };
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
    scaling.crossovers = [0, 1, 2, 3].map(|place| crossover(&scaling.rows, place));
    Ok(scaling)
}

/// 8, 16, 32 and so on, and `most` itself.
pub fn sizes(most: usize) -> Vec<usize> {
    let doubled = (3..usize::BITS).map(|power| 1_usize << power);
    let mut sizes: Vec<usize> = doubled.take_while(|&size| size < most).collect();
    sizes.push(most);
    sizes
}

/// Workers pay if they take less than this share of the time of one: what is closer is noise.
const PAYING: f64 = 0.9;

/// The first of two sizes in a row at which these workers pay: one alone may be a disturbance.
fn crossover(rows: &[ScalingRow], place: usize) -> Option<usize> {
    let pays = |row: &ScalingRow| place > 0 && row.least_ms[place] < PAYING * row.least_ms[0];
    let mut pairs = rows.windows(2);
    let pair = pairs.find(|pair| pair.iter().all(pays))?;
    pair.first().map(|row| row.num_references)
}

/// A ranking is repeated for about this long per number of workers.
const TIME_EACH: Duration = Duration::from_millis(400);

fn measure(
    query: &Query<'_>,
    references: &[Reference],
    params: &RankParams,
    watch: &dyn Watch,
    is_identical: &mut bool,
) -> Result<ScalingRow, Cancelled> {
    // Also warms up.
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

/// What is ranked: a captured front door of the standard car, as far as its signature.
fn query(watch: &dyn Watch) -> Result<Inspection, Cancelled> {
    let setup = CellSetup::with_part(PartKind::FrontDoor, Side::Left, 0, 3_000_000);
    let scene = scene_from_frame(&frame(&setup).frame);
    pipeline::run(&scene, &Library::default(), &Recipe::default(), watch)
}

/// Models of the car that are enrolled in earnest.
const NUM_MODELS: u64 = 8;

/// The parts that are enrolled in earnest.
fn originals(most: usize, watch: &dyn Watch) -> Result<Vec<Reference>, ScalingError> {
    let mut originals = Vec::new();
    for model_seed in 0..NUM_MODELS {
        for kind in PartKind::ALL {
            if watch.is_cancelled() {
                return Err(Cancelled.into());
            }
            if originals.len() < most {
                let enrolled = enrol_part(kind, Side::Left, model_seed, &EnrolParams::default())?;
                originals.push(without_cloud(enrolled));
            }
        }
    }
    Ok(originals)
}

/// Side of a pixel of a perturbed reference: that of the grid on which ranking compares images.
const COARSE: Metres = Metres(0.025);

/// An original, or a perturbed copy of one with nothing that this matcher does not look at.
fn nth_reference(originals: &[Reference], place: usize, matcher: Matcher) -> Reference {
    let original = &originals[place % originals.len()];
    if place < originals.len() {
        return original.clone();
    }
    let mut random = Pcg64::seed_from_u64(place as u64);
    let swing = Swing::new(&mut random);
    let mut copy = original.clone();
    copy.name = format!("{}_{place}", original.name);
    copy.views.clear();
    match matcher {
        Matcher::Default => {
            copy.views = original
                .views
                .iter()
                .map(|view| perturbed(view, &swing))
                .collect();
            copy.literal = LiteralReference::new(&crate::stages::signature::LiteralSignature {
                lengths: Vec::new(),
                angles: Vec::new(),
            });
        }
        Matcher::Paper => {
            let mut signature = original.literal.signature.clone();
            let num = signature.lengths.len();
            for (k, length) in signature.lengths.iter_mut().enumerate() {
                *length *= swing.at(k, num);
            }
            copy.literal = LiteralReference::new(&signature);
        }
    }
    copy
}

/// A factor that goes up and down a few times around the outline.
struct Swing {
    waves: [[f64; 2]; 4],
}

impl Swing {
    fn new(random: &mut Pcg64) -> Self {
        let mut wave = || {
            [
                random.random_range(-0.02..0.02),
                random.random_range(0.0..std::f64::consts::TAU),
            ]
        };
        Self {
            waves: [wave(), wave(), wave(), wave()],
        }
    }

    fn at(&self, k: usize, num: usize) -> f64 {
        let turn = std::f64::consts::TAU * k as f64 / num.max(1) as f64;
        let waves = self.waves.iter().zip(1..);
        1.0 + waves
            .map(|([height, phase], times)| height * (f64::from(times) * turn + phase).cos())
            .sum::<f64>()
    }
}

fn perturbed(view: &ReferenceView, swing: &Swing) -> ReferenceView {
    let mut view = view.clone();
    let num = view.signature.rays.len();
    let rays = &mut view.signature.rays;
    for (k, ray) in rays.iter_mut().enumerate() {
        *ray *= swing.at(k, num);
    }
    view.signature.lengths = view.signature.rays.iter().map(Vector2::norm).collect();
    view.spectrum = spectrum(&view.signature.rays);
    view.plane = coarse(&view.plane);
    // None of these is looked at by the ranking.
    view.signature.literal.lengths = Vec::new();
    view.signature.literal.angles = Vec::new();
    view.signature.angles = Vec::new();
    view.contour.outline = Vec::new();
    view.contour.openings = Vec::new();
    view.contour.outline_pixels = Vec::new();
    view
}

/// The same image with fewer pixels.
fn coarse(plane: &PlaneImage) -> PlaneImage {
    let step = ((COARSE.0 / plane.pixel.0).round() as usize).max(1);
    let (width, height) = (
        plane.image.width.div_ceil(step),
        plane.image.height.div_ceil(step),
    );
    let mut image = BinaryImage::new(width, height);
    let mut heights = Vec::with_capacity(width * height);
    for row in 0..height {
        for column in 0..width {
            let from = row * step * plane.image.width + column * step;
            image.pixels[row * width + column] = plane.image.pixels[from];
            heights.push(plane.heights[from]);
        }
    }
    PlaneImage {
        image,
        heights,
        pixel: Metres(plane.pixel.0 * step as f64),
        ..plane.clone()
    }
}

/// Only what a ranking looks at: a cloud with its searches takes megabytes.
fn without_cloud(mut reference: Reference) -> Reference {
    let cloud = crate::geometry::cloud::PointCloud::default();
    reference.tree = KdTree::new(&cloud.points);
    reference.field = NearestField::new(&cloud.points, 1.0, 1.0);
    reference.cloud = cloud;
    for view in &mut reference.views {
        view.edges = EdgePoints::new(&[], 1);
    }
    reference
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pipeline::Unwatched;

    #[test]
    fn every_number_of_workers_gives_the_serial_ranking_by_both_matchers() {
        for matcher in [Matcher::Default, Matcher::Paper] {
            let mut seen = Vec::new();
            let mut after_row = |row: &ScalingRow| seen.push(row.num_references);
            let found = scaling(matcher, 70, &Unwatched, &mut after_row).expect("measured");
            assert!(found.is_identical, "{matcher:?}");
            assert_eq!(seen, [8, 16, 32, 64, 70]);
            assert!(
                found
                    .rows
                    .iter()
                    .all(|row| row.least_ms.iter().all(|ms| *ms > 0.0))
            );
        }
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
        let found = [0, 1, 2, 3].map(|place| crossover(&rows, place));
        assert_eq!(found, [None, Some(32), None, Some(8)]);
    }
}
