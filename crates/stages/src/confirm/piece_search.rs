//! Where a piece of a part may lie on a reference, and how well, before anything is refined.
//!
//! Centroid and rays of a piece are not those of the part, so the ranking's placements are off. Pairs of oriented border
//! points are looked up among the reference's ([`crate::reference::border`]); each that fits is a pose. Most of
//! them fail on the first points that are laid on; the others are scored by the part's surface and border on the
//! reference, and by where the camera looks past the reference. Only what both views show is compared: nothing that
//! lies outside one of them speaks against a pose.

use nalgebra::{Isometry3, Matrix3, Point3, Rotation3, Translation3, UnitQuaternion, Vector3};
use rand::{SeedableRng as _, seq::SliceRandom as _};
use rand_pcg::Pcg64;

use super::{PreparedScene, candidate::START_MAX_EXTRA_COST};
use crate::reference::{
    Reference,
    border::{BorderPair, BorderPoint, ReferenceBorder, ReferencePair, frame_of},
};
use geometry::{cloud::is_finite, rigid::RigidTransform};

/// Points of a piece's border that are paired.
const NUM_BORDER: usize = 80;
/// Pairs that are looked up in each reference: of a piece; where only a high score counts, which takes a border that is
/// nearly all the part's own; and of what looks whole, whose border is nearly all there.
pub(super) const NUM_PAIRS: usize = 450;
pub(super) const NUM_PAIRS_FOR_A_HIGH_SCORE: usize = 250;
pub(super) const NUM_PAIRS_OF_A_WHOLE: usize = 150;
/// A score from which on a fit is close.
pub(super) const HIGH_SCORE: f64 = 0.3;
/// Points of the surface that a pose is scored on, and those that it is first tried on.
const NUM_SURFACE: usize = 56;
const NUM_TRIED: usize = 16;
/// Points of a reference that are looked for in the scene.
const NUM_LOOKED_FOR: usize = 60;
/// How far two distances between border points may differ, metres: the reference's are some 4 cm apart.
const MAX_DISTANCE_DIFFERENCE_M: f32 = 0.02;
/// How far two angles may differ, radians.
const MAX_ANGLE_DIFFERENCE_RAD: f32 = 0.24;
/// Cosine of the angle between two normals that belong together.
const NORMAL_MIN_COSINE: f32 = 0.87;
/// Distances beyond this count as this, metres.
const MAX_DISTANCE_M: f32 = 0.045;
/// A pose is dropped as soon as more than this share of the points tried so far is off, and one point more: tubes of a
/// stand are taken for the part at times, and most wrong poses show after three points.
const MAX_OFF_SHARE: f32 = 0.4;
/// Share of the border tried first that must find the reference's.
const MIN_BORDER_SHARE: f32 = 0.3;
/// One in this many pairs is looked up first, to decide which references are worth the rest.
const FIRST_SHARE: usize = 3;
/// Poses of a reference that are scored, and those that the first pairs led to.
const MOST_SCORED: usize = 40;
const MOST_SCORED_FIRST: usize = 24;
/// Poses kept of a reference.
const MOST_KEPT: usize = 6;
/// Poses that lie this close, turn (degrees) and shift (millimetres), lead to the same one.
const SAME_DEG_MM: (f64, f64) = (12.0, 45.0);
/// Step along the sheet around a refined pose, metres, and how many are taken each way.
const SLIDE_M: f64 = 0.03;
const NUM_SLIDES: i32 = 4;
/// Other places are tried that cost this much more than the refined pose at most, so many of them.
const SLIDE_MAX_EXTRA_COST: f64 = 0.3;
const MOST_SLID: usize = 3;
/// A point this close to where the reference's view ends, metres, may lie beyond it.
const AT_CUT_M: f64 = 0.01;
/// What the camera looks past is farther than the reference by at least this, metres, plus the noise.
const PAST_M: f64 = 0.035;
/// Fewer points than this in both views score nothing.
const LEAST_SHARED: usize = 6;
/// What a part costs that lies wholly beyond the reference's view.
const UNSEEN_COST: f32 = 0.6;
/// What a reference costs that the camera looks past altogether.
const LOOKED_PAST_COST: f32 = 3.0;

/// A pose of a reference that may be right.
#[derive(Clone, Copy, Debug)]
pub(super) struct Start {
    /// 0 for a perfect fit.
    pub(super) cost: f64,
    /// The pose.
    pub(super) target_from_source: RigidTransform,
}

/// What of a piece is laid onto references, camera space.
pub(super) struct PieceSample {
    surface: Vec<Point3<f32>>,
    pub(super) border: Vec<BorderPoint>,
    pairs: Vec<OrientedPair>,
}

/// A pair of the piece's border, with its middle and its axes.
struct OrientedPair {
    pair: BorderPair,
    middle: Point3<f32>,
    axes: Matrix3<f32>,
}

impl PieceSample {
    /// Any first points of surface and border are spread over the piece.
    pub(super) fn new(
        surface: &[Point3<f32>],
        mut border: Vec<BorderPoint>,
        num_pairs: usize,
        seed: u64,
    ) -> Self {
        let mut rng = Pcg64::seed_from_u64(seed);
        border.shuffle(&mut rng);
        border.truncate(NUM_BORDER);
        let numbers = 0..border.len();
        let all = numbers
            .clone()
            .flat_map(|i| (i + 1..border.len()).map(move |j| [i, j]));
        let mut pairs: Vec<BorderPair> = all
            .filter_map(|[i, j]| BorderPair::of([&border[i], &border[j]], [i as u16, j as u16]))
            .filter(|pair| !pair.is_straight())
            .collect();
        pairs.shuffle(&mut rng);
        pairs.truncate(num_pairs);
        let oriented = |pair: BorderPair| {
            let (middle, axes) = frame_of(pair.of.map(|i| &border[usize::from(i)]))?;
            Some(OrientedPair { pair, middle, axes })
        };
        let pairs = pairs.into_iter().filter_map(oriented).collect();
        Self {
            surface: surface[..NUM_SURFACE.min(surface.len())].to_vec(),
            border,
            pairs,
        }
    }

    /// Number of pairs that are looked up first.
    fn num_first(&self) -> usize {
        self.pairs.len().div_ceil(FIRST_SHARE)
    }
}

/// What the first pairs of a piece led to on a reference.
#[derive(Clone)]
pub(super) struct FirstLook {
    rough: RoughPoses,
    /// The best few, the cheapest first.
    pub(super) starts: Vec<Start>,
}

impl FirstLook {
    /// The least cost; infinite if nothing fits.
    pub(super) fn cost(&self) -> f64 {
        self.starts.first().map_or(f64::INFINITY, |best| best.cost)
    }
}

impl PreparedScene<'_> {
    /// Looks up the first of the piece's pairs in a reference, and gives poses that cost less than `limit`, none of them
    /// refined; `others` are scored with them.
    pub(super) fn first_look(
        &self,
        piece: &PieceSample,
        reference: &Reference,
        others: impl Iterator<Item = RigidTransform>,
        limit: f64,
    ) -> FirstLook {
        let mut rough = RoughPoses::default();
        rough.add(piece, reference, &piece.pairs[..piece.num_first()]);
        let best = rough.all.iter().take(MOST_SCORED_FIRST);
        let poses = best.map(|(_, pose)| pose.cast()).chain(others);
        let starts = self.scored(piece, reference, poses, limit).collect();
        FirstLook {
            rough,
            starts: self.best_distinct(starts, MOST_KEPT),
        }
    }

    /// Looks up the other pairs, and gives the best few poses of both that cost less than `limit`.
    pub(super) fn second_look(
        &self,
        piece: &PieceSample,
        reference: &Reference,
        first: &FirstLook,
        limit: f64,
    ) -> Vec<Start> {
        let FirstLook {
            mut rough,
            mut starts,
        } = first.clone();
        rough.add(piece, reference, &piece.pairs[piece.num_first()..]);
        let poses = rough.all.iter().map(|(_, pose)| pose.cast());
        starts.extend(self.scored(piece, reference, poses, limit));
        self.best_distinct(starts, MOST_KEPT)
    }

    /// The poses that cost less than `limit`, and not much more than one before them: the best should come first.
    fn scored(
        &self,
        piece: &PieceSample,
        reference: &Reference,
        poses: impl Iterator<Item = RigidTransform>,
        mut limit: f64,
    ) -> impl Iterator<Item = Start> {
        poses.filter_map(move |target_from_source| {
            let cost = self.coarse_cost(piece, reference, &target_from_source, limit)?;
            limit = limit.min(cost + START_MAX_EXTRA_COST);
            Some(Start {
                cost,
                target_from_source,
            })
        })
    }

    /// Other places along the sheet around a pose that cost hardly more than the pose does, the cheapest first: a smooth
    /// sheet is held by its border alone, and a refinement stops at the first place that fits a little.
    pub(super) fn slides(
        &self,
        piece: &PieceSample,
        reference: &Reference,
        target_from_source: &RigidTransform,
        cost: f64,
    ) -> Vec<Start> {
        let camera_from_plane = self.scene.query.plane.plane_from_camera.inverse();
        let steps = || (-NUM_SLIDES..=NUM_SLIDES).map(|step| f64::from(step) * SLIDE_M);
        let along = steps().flat_map(|x| steps().map(move |y| Vector3::new(x, y, 0.0)));
        let starts = along
            .filter(|along| *along != Vector3::zeros())
            .filter_map(|along| {
                let shift = Translation3::from(camera_from_plane.rotation * along);
                let target_from_source = target_from_source * shift;
                let limit = cost + SLIDE_MAX_EXTRA_COST;
                let cost = self.coarse_cost(piece, reference, &target_from_source, limit)?;
                Some(Start {
                    cost,
                    target_from_source,
                })
            });
        self.best_distinct(starts.collect(), MOST_SLID)
    }

    /// The cheapest of some starts that lead to different poses.
    fn best_distinct(&self, mut starts: Vec<Start>, most: usize) -> Vec<Start> {
        starts.sort_by(|a, b| a.cost.total_cmp(&b.cost));
        let mut kept: Vec<Start> = Vec::with_capacity(most);
        for start in starts {
            let pose = &start.target_from_source;
            let is_apart = |k: &Start| self.is_apart(&k.target_from_source, pose, SAME_DEG_MM);
            if kept.len() < most && kept.iter().all(is_apart) {
                kept.push(start);
            }
        }
        kept
    }

    /// How badly a pose fits, 0 for a perfect fit: the part on the reference, its border on the reference's, and the
    /// reference where the camera looks past it; `None` from `limit` on.
    pub(super) fn coarse_cost(
        &self,
        piece: &PieceSample,
        reference: &Reference,
        target_from_source: &RigidTransform,
        limit: f64,
    ) -> Option<f64> {
        let moved = target_from_source.cast::<f32>();
        let is_cut = !reference.cut.is_nothing();
        let is_beyond =
            |at: &Point3<f32>| is_cut && reference.cut.depth_inside(&at.cast()) < AT_CUT_M;
        let field = reference.field();
        let (mut num, mut off) = (0_usize, 0.0_f32);
        for p in &piece.surface {
            let at = moved * p;
            if !is_beyond(&at) {
                num += 1;
                off += clipped(field.distance_sq(&at));
            }
        }
        if num < LEAST_SHARED {
            return None;
        }
        let num_surface = piece.surface.len().max(1);
        let beyond = 1.0 - num as f32 / num_surface as f32;
        let surface = off / num as f32;
        let is_below = |cost: f32| (f64::from(cost) < limit).then_some(cost);
        let mut cost = is_below(surface + UNSEEN_COST * beyond)?;
        let (mut num, mut off) = (0.0_f32, 0.0_f32);
        for p in &piece.border {
            let at = moved * p.at;
            if !is_beyond(&at) {
                num += 1.0;
                let borders = reference.borders().iter();
                let distances_sq = borders.map(|border| border.field.distance_sq(&at));
                off += clipped(distances_sq.fold(f32::INFINITY, f32::min));
            }
        }
        if num > 0.0 {
            cost = is_below(cost + off / num)?;
        }
        let missing = LOOKED_PAST_COST * self.missing_share(reference, target_from_source);
        is_below(cost + missing).map(f64::from)
    }

    /// Share of a reference that the camera looks past, of what it sees or looks past.
    fn missing_share(&self, reference: &Reference, target_from_source: &RigidTransform) -> f32 {
        let scene = self.scene.scene;
        let (Some(camera), Some(normals)) = (scene.intrinsics, reference.cloud.normals.as_deref())
        else {
            return 0.0;
        };
        let camera_from_target = target_from_source.inverse();
        let viewer = target_from_source * Point3::origin();
        let points = &reference.cloud.points;
        let step = (points.len() / NUM_LOOKED_FOR).max(1);
        let (mut seen, mut past) = (0.0_f32, 0.0_f32);
        for (p, normal) in points.iter().zip(normals).step_by(step) {
            let p: Point3<f64> = p.cast();
            let towards: Vector3<f64> = viewer - p;
            let facing = normal.cast::<f64>().dot(&towards);
            if facing < 0.3 * towards.norm() {
                continue;
            }
            let at = camera_from_target * p;
            let Some((u, v)) = camera.pixel_of(&at) else {
                continue;
            };
            let (u, v) = (u + 0.5, v + 0.5);
            let is_inside =
                u >= 0.0 && v >= 0.0 && u < camera.width as f64 && v < camera.height as f64;
            if !is_inside {
                continue;
            }
            let reading = &scene.cloud.points[v as usize * camera.width + u as usize];
            if !is_finite(reading) {
                continue;
            }
            let reach = PAST_M + 3.0 * self.tolerance.noise_at_1m.0 * at.z * at.z;
            let beyond = f64::from(reading.z) - at.z;
            if beyond > reach {
                past += 1.0;
            } else if beyond > -reach {
                seen += 1.0;
            }
        }
        if seen + past > 0.0 {
            past / (seen + past)
        } else {
            1.0
        }
    }
}

/// The poses of a reference that pairs led to, by how far off the first points are.
#[derive(Clone)]
struct RoughPoses {
    all: Vec<(f32, Isometry3<f32>)>,
    /// What is further off is not among the best.
    limit: f32,
}

impl Default for RoughPoses {
    fn default() -> Self {
        Self {
            all: Vec::with_capacity(2 * MOST_SCORED),
            limit: f32::INFINITY,
        }
    }
}

impl RoughPoses {
    /// Adds the poses in which one of these pairs lies on one of the reference's, as far as the first points agree; the best
    /// come first.
    fn add(&mut self, piece: &PieceSample, reference: &Reference, pairs: &[OrientedPair]) {
        for border in reference.borders() {
            for ours in pairs {
                border.visit_pairs_like(
                    &ours.pair,
                    MAX_DISTANCE_DIFFERENCE_M,
                    MAX_ANGLE_DIFFERENCE_RAD,
                    |theirs| {
                        try_pose(piece, reference, border, ours, theirs, self);
                    },
                );
            }
        }
        self.keep_best();
        self.all.sort_by(|a, b| a.0.total_cmp(&b.0));
    }

    fn push(&mut self, off: f32, turn: &Matrix3<f32>, shift: &Vector3<f32>) {
        let turn = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(*turn));
        self.all
            .push((off, Isometry3::from_parts((*shift).into(), turn)));
        if self.all.len() == 2 * MOST_SCORED {
            self.keep_best();
        }
    }

    fn keep_best(&mut self) {
        if self.all.len() > MOST_SCORED {
            let by_off = |a: &(f32, _), b: &(f32, _)| a.0.total_cmp(&b.0);
            self.all.select_nth_unstable_by(MOST_SCORED - 1, by_off);
            self.all.truncate(MOST_SCORED);
            self.limit = self.all[MOST_SCORED - 1].0;
        }
    }
}

/// Keeps the pose in which a pair of the piece's border lies on one of the reference's, if the first points agree.
///
/// By itself, so that the search for pairs, most of which are unlike, stays a tight loop.
#[inline(never)]
fn try_pose(
    piece: &PieceSample,
    reference: &Reference,
    border: &ReferenceBorder,
    ours: &OrientedPair,
    theirs: &ReferencePair,
    poses: &mut RoughPoses,
) {
    let points = theirs.pair.of.map(|i| &border.points[usize::from(i)]);
    let (onto, their_axes) = theirs.frame(points);
    let turn: Matrix3<f32> = their_axes * ours.axes.transpose();
    let are_turned_alike = (ours.pair.of.iter().zip(points)).all(|(i, b)| {
        (turn * piece.border[usize::from(*i)].normal).dot(&b.normal) > NORMAL_MIN_COSINE
    });
    if !are_turned_alike {
        return;
    }
    let shift = (onto - turn * ours.middle.coords).coords;
    if let Some(off) = early_out_cost(piece, reference, border, &turn, &shift, poses.limit) {
        poses.push(off, &turn, &shift);
    }
}

/// Mean squared distance of the first points at a pose, in squares of [`MAX_DISTANCE_M`], surface and border added; `None` as soon
/// as too many of them are off, or the sum is beyond `limit`.
fn early_out_cost(
    piece: &PieceSample,
    reference: &Reference,
    border: &ReferenceBorder,
    turn: &Matrix3<f32>,
    shift: &Vector3<f32>,
    limit: f32,
) -> Option<f32> {
    // Of fewer points the mean is larger.
    const PER_POINT: f32 = 1.0 / NUM_TRIED as f32;
    let is_cut = !reference.cut.is_nothing();
    let is_beyond = |at: &Point3<f32>| is_cut && reference.cut.depth_inside(&at.cast()) < AT_CUT_M;
    let field = reference.field();
    // Counted as floats: to convert whole numbers takes longer than to look a point up.
    let (mut num, mut num_off, mut sum) = (0.0_f32, 0.0_f32, 0.0_f32);
    for p in piece.surface.iter().take(NUM_TRIED) {
        let at = Point3::from(turn * p.coords + shift);
        if is_beyond(&at) {
            continue;
        }
        num += 1.0;
        let off = clipped(field.distance_sq(&at));
        num_off += if off < 1.0 { 0.0 } else { 1.0 };
        sum += off;
        if num_off > 1.0 + MAX_OFF_SHARE * num || sum * PER_POINT > limit {
            return None;
        }
    }
    if num < LEAST_SHARED as f32 {
        return None;
    }
    let surface = sum / num;
    let (mut num, mut num_on, mut sum) = (0.0_f32, 0.0_f32, 0.0_f32);
    for p in piece.border.iter().take(NUM_TRIED) {
        let at = Point3::from(turn * p.at.coords + shift);
        if is_beyond(&at) {
            continue;
        }
        num += 1.0;
        let off = clipped(border.field.distance_sq(&at));
        num_on += if off < 1.0 { 1.0 } else { 0.0 };
        sum += off;
        if surface + sum * PER_POINT > limit {
            return None;
        }
    }
    (num_on >= MIN_BORDER_SHARE * num).then(|| surface + sum / num.max(1.0))
}

fn clipped(distance_sq: f32) -> f32 {
    (distance_sq / (MAX_DISTANCE_M * MAX_DISTANCE_M)).min(1.0)
}
