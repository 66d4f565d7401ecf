//! The evidence for and against a reference at its pose, and the score that follows from it.
//!
//! The score is a logistic model: the probability that the part hangs there, at the pose found. Its weights are fitted
//! to simulated frames (`partsight-bench calibration`, tuning seeds). Every reference that was examined is one sample, so
//! a box counts against each part that it resembles.
//!
//! Only what both views show is compared: a region of the reference beyond the picture, or of the scene beyond where the
//! reference's view cut it off, counts neither for nor against. What counts for a reference is how much of it is
//! confirmed: the area that lies on it, and the length of outline and openings that lies on its own (`little` falls with
//! both). Frames of pieces, of the booth and of other makes are among the samples. Of 2 500 candidates in 1 070 frames,
//! one wrong one scores 0.9 or more, and 20 of 650 right ones score less.
//!
//! A part of another make has a similar whole shape, but bulges and ends elsewhere. The similarity from the ranking, the
//! points off the reference, the relief and the outline give a second probability, the likeness: that the part is of the
//! reference's type.
//!
//! Dropped, because the model was as good without: the distance between the outlines (the length in agreement implies
//! it), whether points off the reference lie beside it, the hidden share, and the share of the outline that is cut.

use nalgebra::{Point3, Vector3};

use super::{PreparedScene, odds};
use crate::{
    pose::{
        closest::Correspondence,
        quality::{FitQuality, PIXEL_REACH, VisibilityShares, look_for, measure_fit},
        refine::{AlignmentSource, AlignmentTarget, Search},
    },
    reference::Reference,
};
use geometry::rigid::RigidTransform;

/// Evidence for and against a reference at its pose. Distances are capped at 40 mm, so a single stray counts little.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Evidence {
    /// Share of the part's points that lie off the reference, of those that its view could show, 0..1.
    pub off: f64,
    /// Share of the part's points beyond where the reference's view cut it off, 0..1.
    pub beyond: f64,
    /// Area of the part that lies on the reference, square metres.
    pub seen_m2: f64,
    /// Length of the part's outline that lies on the reference's, metres.
    pub edge_m: f64,
    /// Share of the reference that the camera looks through, of what it sees or looks through, 0..1.
    pub missing: f64,
    /// Share of the reference that something nearer hides, 0..1.
    pub hidden: f64,
    /// Share of the reference beyond the picture, 0..1.
    pub outside: f64,
    /// How far the surface bulges or sinks from the reference's, metres: root mean square of the mean signed distances
    /// over patches of 12 cm, less what the noise leaves of itself in such a mean.
    pub relief_m: f64,
    /// Mean distance of the part's outline and openings to the reference's, metres.
    pub outline_m: f64,
    /// How far stretches of the outline lie off the reference's, metres: root mean square of their mean signed distances.
    /// `None` as long as the pose is not refined to the end, or if too little of the outline is seen.
    pub outline_shift_m: Option<f64>,
    /// How far half of the outline lies off the reference's at most, metres: median of the stretches' shifts by length.
    /// `None` where `outline_shift_m` is.
    pub outline_median_m: Option<f64>,
    /// Share of the part's outline where only the view ends, 0..1.
    pub cut: f64,
    /// Mean cosine of the angle that the reference is seen at, where the part lies on it.
    pub facing: f64,
    /// What the ranking scored: how alike the whole shapes are, 0..1.
    pub shape: f64,
    /// `None` unless it was held against a part that looks alike.
    pub close: Option<CloseLook>,
}

/// What every reading of a part says of its reference.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct CloseLook {
    /// As [`Evidence::relief_m`] over patches of 3 cm, with the noise.
    pub relief_m: f64,
    /// Mean distance of the readings to the reference, metres; more than 10 mm count as 10 mm.
    pub distance_m: f64,
    /// As [`Evidence::missing`], of every point of the reference and with a pixel of play instead of two.
    pub missing: f64,
}

/// Distances beyond this count as this, metres.
const MAX_DISTANCE_M: f64 = 0.04;
/// A point this close to where the reference's view ends may lie beyond it, metres.
const AT_CUT_M: f64 = 0.015;
/// An edge this close to the reference's lies on it, metres.
const ON_EDGE_M: f64 = 0.02;
/// Side of a patch, metres: some 40 points of a door, and less than the radius of anything pressed into a sheet.
pub(super) const PATCH_M: f32 = 0.12;
/// The same of a close look, which takes every reading.
const CLOSE_PATCH_M: f32 = 0.03;
/// A close look counts larger distances as this, metres.
const CLOSE_MAX_DISTANCE_M: f64 = 0.01;
/// Readings that a close look takes are at most twice this.
const NUM_CLOSE: usize = 30_000;
/// Fewer points than this make no mean.
const PATCH_MIN_POINTS: f64 = 6.0;
/// What is left of the noise in the mean over a patch, as measured on parts that were enrolled: neighbouring readings
/// share theirs.
const NOISE_LEFT_SHARE: f64 = 0.3;

impl PreparedScene<'_> {
    /// Takes the figures of one reference at a pose, from the closest points of the first of the part's.
    pub(super) fn evaluate(
        &self,
        reference: &Reference,
        view: usize,
        target_from_source: &RigidTransform,
        closest: &[Correspondence],
        num_looked_for: usize,
    ) -> (FitQuality, Evidence) {
        let target = reference
            .target(view)
            .expect("what has a pose has a cloud and a view");
        let scene = self.scene;
        let measured = &self.source.surface[..closest.len()];
        let tolerance = self.tolerance;
        let camera_from_target = target_from_source.inverse();
        let sight = look_for(
            &target,
            &camera_from_target,
            scene.scene,
            tolerance,
            num_looked_for,
            PIXEL_REACH,
        );
        let is_beyond = |at: &Point3<f32>| reference.cut.depth_inside(&at.cast()) < AT_CUT_M;
        let shared = || {
            measured
                .iter()
                .zip(closest)
                .filter(|(_, c)| !is_beyond(&c.at))
        };
        let (shared_points, shared_closest): (Vec<Point3<f32>>, Vec<Correspondence>) =
            shared().map(|(p, c)| (*p, *c)).unzip();
        let fit = FitQuality {
            sight,
            ..measure_fit(&shared_points, &shared_closest, &target, tolerance)
        };
        let beyond = 1.0 - shared_points.len() as f64 / measured.len().max(1) as f64;
        let (outline_m, edge_share) =
            outline_distance(&self.source, &target, target_from_source, &is_beyond);
        let noise = |p: &Point3<f32>| scene.part.noise_at_1m.0 * f64::from(p.z * p.z);
        let noise_sq = shared_points.iter().map(|p| noise(p).powi(2)).sum::<f64>();
        let noise_sq = noise_sq / shared_points.len().max(1) as f64;
        let relief_sq = relief(&shared_closest, &target, PATCH_M).powi(2);
        let evidence = Evidence {
            off: 1.0 - fit.overlap,
            missing: sight.map_or(0.0, |sight| missing_share(&sight)),
            hidden: sight.map_or(0.0, |s| s.hidden),
            outside: sight.map_or(0.0, |s| s.outside),
            relief_m: (relief_sq - NOISE_LEFT_SHARE * NOISE_LEFT_SHARE * noise_sq)
                .max(0.0)
                .sqrt(),
            outline_m,
            beyond,
            seen_m2: scene.query.contour.area * (1.0 - beyond) * fit.overlap,
            edge_m: self.own_m() * edge_share,
            outline_shift_m: None,
            outline_median_m: None,
            cut: self.cut_share(),
            facing: mean_facing(&shared_closest, &target, target_from_source),
            shape: 0.0,
            close: None,
        };
        (fit, evidence)
    }

    /// Looks closely at one reference at a pose.
    pub(super) fn look_closely(
        &self,
        reference: &Reference,
        view: usize,
        target_from_source: &RigidTransform,
    ) -> Option<CloseLook> {
        let target = reference.target(view)?;
        let all = &self.scene.part.cloud.points;
        let step = (all.len() / NUM_CLOSE).max(1);
        let points: Vec<Point3<f32>> = all.iter().step_by(step).copied().collect();
        let mut closest =
            Correspondence::of_each(&points, &target, target_from_source, Search::Field);
        closest.retain(|closest| reference.cut.depth_inside(&closest.at.cast()) >= AT_CUT_M);
        let distance = |closest: &Correspondence| {
            let distance = closest
                .target
                .map_or(CLOSE_MAX_DISTANCE_M, |n| f64::from(n.distance_sq).sqrt());
            distance.min(CLOSE_MAX_DISTANCE_M)
        };
        let distance: f64 = closest.iter().map(distance).sum();
        let camera_from_target = target_from_source.inverse();
        let (scene, tolerance) = (self.scene.scene, self.tolerance);
        let every = target.cloud.points.len();
        let sight = look_for(&target, &camera_from_target, scene, tolerance, every, 1)?;
        Some(CloseLook {
            relief_m: relief(&closest, &target, CLOSE_PATCH_M),
            distance_m: distance / closest.len().max(1) as f64,
            missing: missing_share(&sight),
        })
    }
}

/// Share of a reference that the camera looks through, of what it sees or looks through.
fn missing_share(sight: &VisibilityShares) -> f64 {
    sight.missing / (sight.confirmed + sight.missing).max(f64::MIN_POSITIVE)
}

/// Mean cosine between the reference's surface and the rays that see it.
fn mean_facing(
    closest: &[Correspondence],
    target: &AlignmentTarget<'_>,
    target_from_source: &RigidTransform,
) -> f64 {
    let camera = target_from_source * Point3::origin();
    let cosines = closest.iter().filter_map(|closest| {
        let near = closest.on_surface(target, MAX_DISTANCE_M * MAX_DISTANCE_M)?;
        let ray = closest.at.cast::<f64>() - camera;
        Some(-near.normal.dot(&ray.normalize()))
    });
    let (num, sum) = cosines.fold((0.0_f64, 0.0), |(num, sum), cosine| {
        (num + 1.0, sum + cosine)
    });
    sum / num.max(1.0)
}

/// Root mean square of the mean signed distances of patches of this side, metres.
pub(super) fn relief(closest: &[Correspondence], target: &AlignmentTarget<'_>, side: f32) -> f64 {
    let mut patches: Vec<([i32; 3], f64)> = closest
        .iter()
        .filter_map(|closest| {
            let near = closest.on_surface(target, MAX_DISTANCE_M * MAX_DISTANCE_M)?;
            let patch = closest.at.coords.map(|x| (x / side).floor() as i32);
            Some((patch.into(), near.off))
        })
        .collect();
    patches.sort_by_key(|p| p.0);
    let (mut sum, mut num) = (0.0, 0.0_f64);
    for patch in patches.chunk_by(|a, b| a.0 == b.0) {
        let n = patch.len() as f64;
        if n >= PATCH_MIN_POINTS {
            let mean = patch.iter().map(|p| p.1).sum::<f64>() / n;
            sum += n * mean * mean;
            num += n;
        }
    }
    (sum / num.max(1.0)).sqrt()
}

/// Mean distance of the part's edges to the reference's, and the share of them that lies there.
pub(super) fn outline_distance(
    source: &AlignmentSource,
    target: &AlignmentTarget<'_>,
    target_from_source: &RigidTransform,
    is_beyond: &dyn Fn(&Point3<f32>) -> bool,
) -> (f64, f64) {
    if source.edges.is_empty() || target.edges.is_empty() {
        return (MAX_DISTANCE_M, 0.0);
    }
    let moved = target_from_source.cast::<f32>();
    let (mut num, mut num_on, mut sum) = (0.0_f64, 0.0, 0.0);
    for p in &source.edges {
        let at = moved * p;
        if !is_beyond(&at) {
            let closest = target
                .edges
                .closest(&at, (MAX_DISTANCE_M * MAX_DISTANCE_M) as f32);
            let off = closest.map_or(MAX_DISTANCE_M, |c| f64::from(c.1).sqrt());
            num += 1.0;
            num_on += if off < ON_EDGE_M { 1.0 } else { 0.0 };
            sum += off;
        }
    }
    if num < 1.0 {
        return (MAX_DISTANCE_M, 0.0);
    }
    (sum / num, num_on / source.edges.len() as f64)
}

/// The view of a reference that its pose shows most squarely.
pub(crate) fn facing_view(reference: &Reference, target_from_source: &RigidTransform) -> usize {
    let views = 0..reference.views.len();
    let facings = views.map(|view| (view, facing(reference, view, target_from_source)));
    facings
        .max_by(|a, b| a.1.total_cmp(&b.1))
        .map_or(0, |best| best.0)
}

/// Cosine of the angle between a view of a reference and where the camera is.
pub(super) fn facing(
    reference: &Reference,
    view: usize,
    target_from_source: &RigidTransform,
) -> f64 {
    let part_from_plane = reference.views[view].plane_from_part.inverse();
    let towards = target_from_source * Point3::origin() - part_from_plane * Point3::origin();
    (part_from_plane * Vector3::z()).dot(&towards.normalize())
}

/// A part that is seen at more than 61° to its face is not recognised: hardly a point of it says anything, and a strip
/// of anything fits it.
const MIN_FACING_COSINE: f64 = 0.48;
/// Nor is a part of which less than this lies on the reference, square metres: a strip of floor lies well on the end of
/// a bumper.
const MIN_SEEN_M2: f64 = 0.05;
/// Nor is what shows hardly an edge of its own, metres.
const MIN_EDGE_M: f64 = 0.15;
/// Nor is what lies mostly beyond where the reference's view ended, as a share: its pose rests on a strip.
const MAX_BEYOND_SHARE: f64 = 0.6;
/// Share of the outline that may be cut in the shape of a whole part.
const MAX_CUT_SHARE: f64 = 0.1;
/// What a perfect fit of a part that is hardly seen scores.
const HARDLY_SEEN_SCORE: f64 = 0.4;

impl Evidence {
    /// What the score is made of: each 0 for a perfect fit, and some 1 where a fit becomes doubtful. Shares beyond 0.4
    /// say no more than 0.4 does.
    pub fn features(&self) -> [f64; NUM_FEATURES] {
        [
            self.off.min(0.4) / 0.1,
            self.missing.min(0.4) / 0.1,
            self.relief_m / 0.005,
            little(self.seen_m2, self.edge_m),
        ]
    }

    /// True if so much of the part, or of its reference, is out of sight that its whole shape is not the part's.
    pub fn is_piece(&self) -> bool {
        self.cut >= MAX_CUT_SHARE || self.beyond > 0.0
    }

    /// The probability that a whole part is of the same type as the reference, of whatever make, 0..1; 0 for a piece,
    /// whose shape is not that of the part.
    pub fn likeness(&self) -> f64 {
        if self.is_piece() {
            return 0.0;
        }
        let weighted = self.type_features().into_iter().zip(TYPE_WEIGHTS);
        let sum: f64 = weighted.map(|(x, weight)| weight * x).sum();
        1.0 / (1.0 + (-(TYPE_CONSTANT + sum)).exp())
    }

    /// What the likeness is made of.
    pub fn type_features(&self) -> [f64; NUM_TYPE_FEATURES] {
        [
            self.off.min(0.6) / 0.1,
            self.relief_m / 0.005,
            self.outline_m / 0.01,
            (1.0 - self.shape) / 0.1,
        ]
    }

    /// How much more probable this reference is than another one for the same part, -1..1: the difference of their
    /// probabilities, given that one of the two is right. `None` unless both were looked at closely.
    ///
    /// The scores of two good fits say little about which is the better one; every reading together does. Fitted to 646
    /// simulated frames of a part of one of four car models, all enrolled, whose scores were too close: hung askew or with care,
    /// behind a plank, with three times a Kinect's noise, on the floor and in a booth. Fitted to the frames of one set of
    /// models, a lead of 0.6 in those of the other was right 577 times and wrong 4 times.
    pub fn lead_over(&self, other: &Self) -> Option<f64> {
        let (own, others) = (self.close?, other.close?);
        // Of a piece with little outline, the rest decides.
        let shifts = self.outline_shift_m.zip(other.outline_shift_m);
        let log_odds = (odds(self.score()) / odds(other.score())).ln()
            + 1250.0 * (others.relief_m - own.relief_m)
            + 13_300.0 * (others.distance_m - own.distance_m)
            + 126.0 * (others.missing - own.missing)
            + 360.0 * shifts.map_or(0.0, |(own, others)| others - own);
        Some((log_odds / 2.0).tanh())
    }

    /// True if enough of the part would be in sight to tell it from something else.
    pub fn is_seen(&self) -> bool {
        self.facing >= MIN_FACING_COSINE
            && self.beyond <= MAX_BEYOND_SHARE
            && is_enough(self.seen_m2, self.edge_m)
    }

    /// The probability that the part hangs there and stands where it was found, 0..1; at most 0.4 for what is hardly
    /// seen.
    pub fn score(&self) -> f64 {
        score_of(self.features(), self.is_seen())
    }
}

/// What the best fit of any reference scores where the part covers so many square metres and so many metres of its
/// outline are its own: no pose confirms more than that.
pub(super) fn most_score(area_m2: f64, own_m: f64) -> f64 {
    let features = [0.0, 0.0, 0.0, little(area_m2, own_m)];
    score_of(features, is_enough(area_m2, own_m))
}

fn score_of(features: [f64; NUM_FEATURES], is_seen: bool) -> f64 {
    let most = if is_seen { 1.0 } else { HARDLY_SEEN_SCORE };
    let weighted = features.into_iter().zip(WEIGHTS);
    let sum: f64 = weighted.map(|(x, weight)| weight * x).sum();
    most / (1.0 + (-(CONSTANT + sum)).exp())
}

/// How little of a reference is confirmed.
fn little(seen_m2: f64, edge_m: f64) -> f64 {
    (0.5 / (edge_m + 2.0 * seen_m2).max(0.05)).min(2.0)
}

fn is_enough(seen_m2: f64, edge_m: f64) -> bool {
    seen_m2 >= MIN_SEEN_M2 && edge_m >= MIN_EDGE_M
}

/// The model of the score, as `partsight-bench calibration` fits it on the tuning seeds.
const CONSTANT: f64 = 5.67;
const WEIGHTS: [f64; NUM_FEATURES] = [-0.58, -7.29, -4.35, -4.88];

/// Figures that a score is made of.
pub const NUM_FEATURES: usize = 4;
/// Their names, in order.
pub const FEATURES: [&str; NUM_FEATURES] = ["off", "missing", "relief", "little"];

/// The model of the likeness, fitted likewise.
const TYPE_CONSTANT: f64 = 20.0;
const TYPE_WEIGHTS: [f64; NUM_TYPE_FEATURES] = [-0.75, -2.54, -1.55, -1.64];

/// Figures that a likeness is made of.
pub const NUM_TYPE_FEATURES: usize = 4;
/// Their names, in order.
pub const TYPE_FEATURES: [&str; NUM_TYPE_FEATURES] = ["off", "relief", "outline", "shape"];

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn no_pose_scores_more_than_a_perfect_fit_of_all_that_is_in_sight(
            area in 0.0_f64..0.6,
            own in 0.0_f64..3.0,
            [on, at_edges, shared, missing] in prop::array::uniform4(0.0_f64..1.0),
            relief in 0.0_f64..0.01,
            facing in 0.0_f64..1.0,
        ) {
            let found = Evidence {
                off: 1.0 - on,
                beyond: 1.0 - shared,
                seen_m2: area * shared * on,
                edge_m: own * at_edges,
                missing,
                hidden: 0.0,
                outside: 0.0,
                relief_m: relief,
                outline_m: 0.0,
                outline_shift_m: None,
                outline_median_m: None,
                cut: 0.0,
                facing,
                shape: 1.0,
                close: None,
            };
            prop_assert!(found.score() <= most_score(area, own));
            let perfect = Evidence {
                off: 0.0,
                beyond: 0.0,
                seen_m2: area,
                edge_m: own,
                missing: 0.0,
                relief_m: 0.0,
                facing: 1.0,
                ..found
            };
            prop_assert!((perfect.score() - most_score(area, own)).abs() < 1e-12);
        }
    }
}
