//! Free-space violations: surface that one shot shows where another shot's camera looks past.
//!
//! A wrong pose that slides a flat surface along itself leaves the readings on each other. But it also shifts outlines,
//! openings, stands and clamps, so that one shot shows them where the other sees only what is far behind. Readings beside
//! depth discontinuities and on thin bars count, too. [`better_pose`] slides a shot along its surface to where nothing is
//! violated.
//!
//! Limit: shots that have only a wall or the inside of a sheet in common violate nothing, however far one is slid.

use nalgebra::{Translation3, Vector3};

use super::{
    RegisterParams, ScannedShot,
    pairs::{ProjectedReading, Reach, meet},
    register::register,
    surface::{ShotSurface, Use},
    visibility::looks_past,
};
use crate::segment::PointLabel;
use geometry::{parallel::map_each, rigid::RigidTransform};

/// What two shots see of each other's surface.
#[derive(Clone, Copy, Debug)]
pub(super) struct CommonView {
    /// The two shots, in order.
    pub(super) shots: [usize; 2],
    /// Number of readings that were projected into the other shot.
    num_samples: usize,
    /// Readings that lie on the other's surface.
    agree: usize,
    /// Readings that the other camera looks past.
    violations: usize,
}

/// Readings of each of up to 8 shots that are projected into each other shot, approximately; fewer of more shots.
const NUM_SAMPLES: usize = 16_000;
/// Everything within this distance must lie behind a violating reading, metres: refined poses are off by millimetres, and
/// edges are ragged by a pixel or two.
const ASIDE_M: f64 = 0.015;
/// It must lie this far behind, metres, plus three standard deviations.
const BEHIND_M: f64 = 0.06;
/// Readings whose depths differ by less are on one surface, metres, plus three standard deviations.
const SAME_SURFACE_M: f64 = 0.02;
/// Least cosine of the angle at which a reading must be seen: a surface seen edge-on or from behind yields none.
const MIN_FACING_COSINE: f64 = 0.3;
/// Violations in the views of 49 pairs and 93 larger scans of real captures with measured poses: at most 8, and 0.09 % of what
/// two shots see together. With one pose wrong along the surface, all 123 pairs that share an edge and stay 50 mm apart exceed
/// both limits, and 26 of 46 that stay 20 to 50 mm apart.
const MOST_VIOLATIONS: usize = 12;
const MOST_VIOLATED: f64 = 0.002;
/// Least share of the readings that overlapping shots have in common; the pair of those captures that overlaps least has 1 %.
const LEAST_COMMON: f64 = 0.005;

impl CommonView {
    /// Returns the share of what both see that one of them looks past, 0..1.
    pub(super) fn violated(&self) -> f64 {
        self.violations as f64 / (self.violations + self.agree).max(1) as f64
    }

    /// Returns whether one of the poses must be wrong, or something moved.
    pub(super) fn is_contradiction(&self) -> bool {
        self.violations > MOST_VIOLATIONS && self.violated() > MOST_VIOLATED
    }

    /// Returns whether the shots see enough of the same surface to check their poses against each other.
    pub(super) fn is_overlap(&self) -> bool {
        self.agree as f64 >= LEAST_COMMON * self.num_samples as f64
    }

    /// Adds what a camera sees in the places of another shot's readings.
    fn add(
        &mut self,
        from: &ShotSurface,
        samples: &[u32],
        to: &ShotSurface,
        to_from: &RigidTransform,
    ) {
        self.num_samples += samples.len();
        for &i in samples {
            match seen_at(from, i as usize, to, to_from) {
                Some(Place::Surface) => self.agree += 1,
                Some(Place::Free) => self.violations += 1,
                None => {}
            }
        }
    }
}

/// What a camera sees in the place of another shot's reading.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Place {
    /// A surface.
    Surface,
    /// Only what is far behind.
    Free,
}

/// Returns what a camera sees in the place of another shot's reading; `None` if it cannot tell.
fn seen_at(
    from: &ShotSurface,
    i: usize,
    to: &ShotSurface,
    to_from: &RigidTransform,
) -> Option<Place> {
    let at = to_from * from.points()[i].cast::<f64>();
    let normal = to_from.rotation * from.normal(i).cast::<f64>();
    if -normal.dot(&at.coords) < MIN_FACING_COSINE * at.coords.norm() {
        return None;
    }
    let (column, row) = to.pixel(&at)?;
    let seen = to.reading(column, row)?;
    let noise = 3.0 * to.noise_at_1m.0 * at.z * at.z;
    let behind = f64::from(to.points()[seen].z) - at.z;
    if behind.abs() < SAME_SURFACE_M + noise {
        return Some(Place::Surface);
    }
    looks_past(to, &at, ASIDE_M, BEHIND_M + noise).then_some(Place::Free)
}

/// Returns about `num` of a shot's readings on a surface, those beside depth discontinuities included.
fn readings_of(surface: &ShotSurface, num: usize) -> Vec<u32> {
    let is_usable = |(_, used): &(usize, &Use)| **used != Use::None;
    let usable = || surface.uses.iter().enumerate().filter(is_usable);
    // An odd step visits all columns.
    let step = (usable().count() / num.max(1)).max(1) | 1;
    usable().step_by(step).map(|(i, _)| i as u32).collect()
}

/// Returns what each two of the shots see of each other, at their present poses.
pub(super) fn common_views(shots: &[&ScannedShot], num_workers: usize) -> Vec<CommonView> {
    let n = shots.len();
    let samples = |shot: &&ScannedShot| readings_of(&shot.surface, NUM_SAMPLES * 8 / n.max(8));
    let samples: Vec<Vec<u32>> = shots.iter().map(samples).collect();
    let pairs: Vec<[usize; 2]> = (0..n)
        .flat_map(|a| (a + 1..n).map(move |b| [a, b]))
        .collect();
    map_each(pairs.len(), num_workers, |k| {
        let [a, b] = pairs[k];
        let mut view = CommonView {
            shots: pairs[k],
            num_samples: 0,
            agree: 0,
            violations: 0,
        };
        let b_from_a = shots[b].base_from_camera.inverse() * shots[a].base_from_camera;
        view.add(&shots[a].surface, &samples[a], &shots[b].surface, &b_from_a);
        view.add(
            &shots[b].surface,
            &samples[b],
            &shots[a].surface,
            &b_from_a.inverse(),
        );
        view
    })
}

/// How far [`better_pose`] slides a shot each way: steps of so many metres.
const STEP_M: f64 = 0.025;
const NUM_STEPS: i32 = 12;
/// Readings that it projects into each other shot, approximately.
const NUM_SLID: usize = 3000;
/// Readings further apart than this are not on one surface.
const REACH: Reach = Reach {
    least: 0.06,
    sigmas: 4.0,
};
/// Distance from the other surface at which a reading counts little, metres: poses may be off by as much before refinement.
const FIT_M: f64 = 0.012;
/// A violation counts against so many readings that fit.
const AGAINST: f64 = 20.0;

/// Slides a shot from the robot's pose along its part, and returns the refined pose at which it fits the others best;
/// `None` if it contradicts them there, too.
pub(super) fn better_pose(
    shots: &[&ScannedShot],
    which: usize,
    params: &RegisterParams,
) -> Option<RigidTransform> {
    let axes = along_part(shots[which])?;
    let steps = || (-NUM_STEPS..=NUM_STEPS).map(|k| f64::from(k) * STEP_M);
    let shifts: Vec<Vector3<f64>> = steps()
        .flat_map(|x| steps().map(move |y| axes[0] * x + axes[1] * y))
        .collect();
    let slid = |shift: &Vector3<f64>| shots[which].given * Translation3::from(*shift);
    let num = NUM_SLID * 8 / shots.len().max(8);
    let samples = |shot: &&ScannedShot| readings_of(&shot.surface, num);
    let samples: Vec<Vec<u32>> = shots.iter().map(samples).collect();
    let scores = map_each(shifts.len(), params.num_workers, |k| {
        score(shots, which, &slid(&shifts[k]), &samples)
    });
    let best = (0..shifts.len()).max_by(|a, b| scores[*a].total_cmp(&scores[*b]))?;
    let mut poses: Vec<RigidTransform> = shots.iter().map(|s| s.base_from_camera).collect();
    poses[which] = slid(&shifts[best]);
    let surfaces: Vec<&ShotSurface> = shots.iter().map(|shot| &*shot.surface).collect();
    let poses = register(&surfaces, &poses, params);
    let moved: Vec<ScannedShot> = shots
        .iter()
        .zip(&poses)
        .map(|(shot, pose)| ScannedShot {
            base_from_camera: *pose,
            ..(*shot).clone()
        })
        .collect();
    let views = common_views(&moved.iter().collect::<Vec<_>>(), params.num_workers);
    let mut own = views.iter().filter(|view| view.shots.contains(&which));
    let fits = own.clone().all(|view| !view.is_contradiction()) && own.any(CommonView::is_overlap);
    fits.then_some(poses[which])
}

/// Rates how well a shot fits the others at a pose.
fn score(
    shots: &[&ScannedShot],
    which: usize,
    base_from_camera: &RigidTransform,
    samples: &[Vec<u32>],
) -> f64 {
    let own = &shots[which].surface;
    let others = (0..shots.len()).filter(|&other| other != which);
    let of_other = |other: usize| {
        let (surface, pose) = (&shots[other].surface, &shots[other].base_from_camera);
        rate(own, base_from_camera, &samples[which], surface, pose)
            + rate(surface, pose, &samples[other], own, base_from_camera)
    };
    others.map(of_other).sum()
}

/// Sums how well a shot's readings lie on another's surface, less what the other looks past.
fn rate(
    from: &ShotSurface,
    base_from_from: &RigidTransform,
    samples: &[u32],
    to: &ShotSurface,
    base_from_to: &RigidTransform,
) -> f64 {
    let to_from = base_from_to.inverse() * base_from_from;
    let rate_one = |&i: &u32| {
        let i = i as usize;
        match meet(from, i, to, &to_from, base_from_to, REACH) {
            ProjectedReading::Pair(pair) => (-(pair.off() / FIT_M).powi(2)).exp(),
            _ if seen_at(from, i, to, &to_from) == Some(Place::Free) => -AGAINST,
            _ => 0.0,
        }
    };
    samples.iter().map(rate_one).sum()
}

/// Returns two directions along the part that a shot sees, in camera space; `None` if it sees none.
fn along_part(shot: &ScannedShot) -> Option<[Vector3<f64>; 2]> {
    let labels = shot.segmentation.labels.iter().enumerate();
    let of_part = labels.filter(|(_, label)| **label == PointLabel::Part);
    let normals = of_part.map(|(i, _)| shot.surface.normal(i).cast::<f64>());
    let sum: Vector3<f64> = normals.sum();
    let normal = sum.try_normalize(1e-9)?;
    let right = normal.cross(&Vector3::y()).try_normalize(1e-9)?;
    Some([right, normal.cross(&right)])
}
