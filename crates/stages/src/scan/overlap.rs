//! Agreement of shots where they see the same surface.
//!
//! A reading is projected into another shot and paired with the reading there. The pair counts if projecting it back leads
//! to the first reading (mutual nearest readings) and if it is within [`REACH_M`]. Its distance is measured along the other
//! reading's normal. Readings beside depth discontinuities are left out.

use nalgebra::Point3;

use super::{
    pairs::{ProjectedReading, Reach, meet},
    register::samples_of,
    surface::ShotSurface,
};
use geometry::{parallel::map_each, rigid::RigidTransform, units::Metres};

/// Readings further apart than this are not on one surface, in metres.
pub const REACH_M: f64 = 0.015;
/// Readings of each of up to 8 shots that are projected into each other shot, approximately; fewer of more shots.
const NUM_SAMPLES: usize = 4000;
/// Fewer pairs than this are not an overlap.
pub const LEAST_PAIRS: usize = 50;

/// Distances between the surfaces that several shots see.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Overlap {
    /// Root mean square of the distances.
    pub rms: Metres,
    /// Median of the absolute distances.
    pub median: Metres,
    /// Number of pairs of readings.
    pub num_pairs: usize,
}

impl Overlap {
    fn from_distances(mut distances: Vec<f32>) -> Option<Self> {
        let num_pairs = distances.len();
        if num_pairs < LEAST_PAIRS {
            return None;
        }
        let sum_sq: f64 = distances.iter().map(|d| f64::from(d * d)).sum();
        let middle = num_pairs / 2;
        let (_, median, _) = distances.select_nth_unstable_by(middle, f32::total_cmp);
        Some(Self {
            rms: Metres((sum_sq / num_pairs as f64).sqrt()),
            median: Metres(f64::from(*median)),
            num_pairs,
        })
    }
}

/// How well shots agree.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Agreement {
    /// All shots together; `None` without an overlap.
    pub all: Option<Overlap>,
    /// All shots together, on the part alone.
    pub part: Option<Overlap>,
    /// Each shot with all others, in order.
    pub shots: Vec<Option<Overlap>>,
    /// Each shot with all others, on the part alone.
    pub shots_on_part: Vec<Option<Overlap>>,
}

/// Measures how well shots agree at these poses. `is_part` returns whether a point of the base frame is on the part.
pub fn overlap(
    surfaces: &[&ShotSurface],
    poses: &[RigidTransform],
    is_part: impl Fn(&Point3<f64>) -> bool + Sync,
    num_workers: usize,
) -> Agreement {
    let n = surfaces.len();
    let distances = map_each(n, num_workers, |i| {
        let samples = samples_of(surfaces[i], NUM_SAMPLES * 8 / n.max(8));
        let others = (0..n).map(|j| {
            if i == j {
                return Vec::new();
            }
            let (from, to) = (surfaces[i], surfaces[j]);
            distances(from, &samples, to, &poses[i], &poses[j], &is_part)
        });
        others.collect::<Vec<Vec<(f32, bool)>>>()
    });
    let of_shot = |i: usize, is_counted: fn(&(f32, bool)) -> bool| {
        let own = distances[i].iter().flatten();
        let others = distances.iter().flat_map(|others| &others[i]);
        let counted = own.chain(others).filter(|d| is_counted(d));
        Overlap::from_distances(counted.map(|d| d.0).collect())
    };
    let all = || distances.iter().flatten().flatten();
    Agreement {
        all: Overlap::from_distances(all().map(|d| d.0).collect()),
        part: Overlap::from_distances(all().filter(|d| d.1).map(|d| d.0).collect()),
        shots: (0..n).map(|i| of_shot(i, |_| true)).collect(),
        shots_on_part: (0..n).map(|i| of_shot(i, |d| d.1)).collect(),
    }
}

/// Returns the absolute distances from one shot's samples to another shot's surface, and whether each is on the part.
fn distances(
    from: &ShotSurface,
    samples: &[u32],
    to: &ShotSurface,
    base_from_from: &RigidTransform,
    base_from_to: &RigidTransform,
    is_part: &(impl Fn(&Point3<f64>) -> bool + Sync),
) -> Vec<(f32, bool)> {
    let to_from = base_from_to.inverse() * base_from_from;
    let from_base = base_from_from.inverse();
    let distance = |&i: &u32| {
        let reach = Reach {
            least: REACH_M,
            sigmas: 0.0,
        };
        let met = meet(from, i as usize, to, &to_from, base_from_to, reach);
        let ProjectedReading::Pair(pair) = met else {
            return None;
        };
        let (column, row) = from.pixel(&(from_base * pair.to))?;
        let own = (
            i64::from(i) % from.camera.width as i64,
            i64::from(i) / from.camera.width as i64,
        );
        // Cameras at different distances see one reading of the other at several of their own pixels.
        let is_mutual = (column - own.0).abs() <= 2 && (row - own.1).abs() <= 2;
        is_mutual.then(|| (pair.off().abs() as f32, is_part(&pair.to)))
    };
    samples.iter().filter_map(distance).collect()
}
