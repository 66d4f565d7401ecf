//! How well a pose fits: distances of the source to the target, and how much of the target the camera sees.
//!
//! Distances alone are blind one way: a small patch lies well on any large part. So the target is also looked for in
//! the depth image. Where it should be seen, its surface is there, something hides it, or the camera looks past it to
//! the wall, which is the strongest evidence against a part.

use nalgebra::Point3;

use super::{closest::Correspondence, refine::AlignmentTarget};
use crate::scene::SceneCloud;
use geometry::{cloud::is_finite, rigid::RigidTransform, units::Metres};

/// Figures of a fit.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct FitQuality {
    /// Mean squared distance of the source points to their closest target points (eq. 12), square metres.
    pub e_m2: f64,
    /// Root mean square distance of the inliers to the target's surface, metres.
    pub rms_m: f64,
    /// Share of the source points that lie on the target within tolerance, 0..1.
    pub overlap: f64,
    /// How much of the target the camera sees at this pose; `None` without a camera.
    pub sight: Option<VisibilityShares>,
}

impl FitQuality {
    /// 0..1: both the source on the target and, where a camera looks, the target in the scene.
    ///
    /// What is hidden counts half as missing: something may well stand before the part, but then less is known.
    pub fn score(&self) -> f64 {
        let present = self.sight.map_or(1.0, |s| {
            s.confirmed / (s.confirmed + s.missing + s.hidden * 0.5).max(f64::MIN_POSITIVE)
        });
        (self.overlap * present).sqrt()
    }
}

/// What a camera sees of the target where it should be, as shares of the points that face the camera in the picture.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct VisibilityShares {
    /// The surface is where it should be.
    pub confirmed: f64,
    /// The camera sees through it to something behind: the surface is not there.
    pub missing: f64,
    /// Something else is before it.
    pub hidden: f64,
    /// No reading there.
    pub unknown: f64,
    /// Outside the field of view; the other four are shares of what is inside.
    pub outside: f64,
}

/// Numbers of points, by what is seen in their places; see [`VisibilityShares`].
#[derive(Clone, Copy, Debug, Default)]
pub struct VisibilityCounts {
    /// The surface.
    pub confirmed: f64,
    /// Something behind it.
    pub missing: f64,
    /// Something before it.
    pub hidden: f64,
    /// No reading.
    pub unknown: f64,
    /// Nothing: it is outside the field of view.
    pub outside: f64,
}

impl VisibilityCounts {
    /// Returns the shares; `None` if no point is inside the field of view.
    pub fn shares(&self) -> Option<VisibilityShares> {
        let total = self.confirmed + self.missing + self.hidden + self.unknown;
        (total >= 1.0).then(|| VisibilityShares {
            confirmed: self.confirmed / total,
            missing: self.missing / total,
            hidden: self.hidden / total,
            unknown: self.unknown / total,
            outside: self.outside / (total + self.outside),
        })
    }
}

/// How far a source point may lie off the target and still be on it: base plus the noise at its depth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerance {
    /// Distance at no noise: spacing of the target and accuracy of the pose.
    pub base: Metres,
    /// Standard deviation of a source point's depth at 1 m; it grows with depth². Zero for clouds without a camera.
    pub noise_at_1m: Metres,
}

impl Tolerance {
    /// Three standard deviations hold 997 of 1000.
    fn at_depth(self, z: f64) -> f64 {
        self.base.0 + 3.0 * self.noise_at_1m.0 * z * z
    }
}

/// Distances of source points to the target, from the closest points of the first of them. If those were looked up in
/// the field, points beyond its band count as being at its edge, so E is a lower bound.
pub fn measure_fit(
    source: &[Point3<f32>],
    closest: &[Correspondence],
    target: &AlignmentTarget<'_>,
    tolerance: Tolerance,
) -> FitQuality {
    let normals = target.cloud.normals.as_deref().unwrap_or_default();
    let (mut sum_sq, mut inlier_sum_sq, mut num_inliers) = (0.0, 0.0, 0.0_f64);
    for (p, closest) in source.iter().zip(closest) {
        let Some(n) = closest.target else {
            sum_sq += FAR_OFF_SQ;
            continue;
        };
        sum_sq += f64::from(n.distance_sq);
        if f64::from(n.distance_sq) < tolerance.at_depth(f64::from(p.z)).powi(2) {
            let away = target.cloud.points[n.index] - closest.at;
            // Along the normal: beside it the closest point of a sampled target is a matter of spacing.
            let off = normals
                .get(n.index)
                .map_or(away.norm(), |normal| normal.dot(&away));
            inlier_sum_sq += f64::from(off * off);
            num_inliers += 1.0;
        }
    }
    let num = source.len().min(closest.len()).max(1) as f64;
    FitQuality {
        e_m2: sum_sq / num,
        rms_m: (inlier_sum_sq / num_inliers.max(1.0)).sqrt(),
        overlap: num_inliers / num,
        sight: None,
    }
}

/// Squared distance that a point beyond the field's band counts with, square metres.
const FAR_OFF_SQ: f64 = 0.0064;

/// Points of the target that are looked for at a pose that is the last word.
pub const NUM_LOOKED_FOR: usize = 2000;
/// A surface seen at a flatter angle than this (cosine) is often lost by the camera, so its absence is no evidence.
pub const MIN_FACING_COSINE: f64 = 0.3;
/// Pixels around the expected one that may show the surface: the pose is not perfect and edges are ragged.
pub const PIXEL_REACH: i64 = 2;

/// Looks for some of the target's points in the scene's depth image; `None` when the scene has none.
pub fn look_for(
    target: &AlignmentTarget<'_>,
    camera_from_target: &RigidTransform,
    scene: &SceneCloud,
    tolerance: Tolerance,
    num_looked_for: usize,
    pixel_reach: i64,
) -> Option<VisibilityShares> {
    let camera = scene.intrinsics?;
    let normals = target.cloud.normals.as_deref()?;
    let points = &scene.cloud.points;
    let view = scene.field_of_view();
    let step = (target.cloud.points.len() / num_looked_for).max(1);
    let mut counts = VisibilityCounts::default();
    for (p, normal) in target.cloud.points.iter().zip(normals).step_by(step) {
        let at = camera_from_target * p.cast::<f64>();
        let facing = -(camera_from_target * normal.cast::<f64>()).dot(&at.coords.normalize());
        if facing < MIN_FACING_COSINE {
            continue;
        }
        let Some((u, v)) = camera.pixel_of(&at) else {
            continue;
        };
        // Rounds what is inside; what is outside stays so.
        let (u, v) = ((u + 0.5).floor() as i64, (v + 0.5).floor() as i64);
        let inside = |u: i64, v: i64| {
            u >= 0 && v >= 0 && u < camera.width as i64 && v < camera.height as i64
        };
        if !inside(u, v) || view.is_some_and(|view| !view.contains(u, v)) {
            counts.outside += 1.0;
            continue;
        }
        let reach = tolerance.at_depth(at.z) / facing;
        // Of the readings around, the one nearest in depth to what is expected.
        let mut nearest: Option<f64> = None;
        for dv in [0, -pixel_reach, pixel_reach] {
            for du in [0, -pixel_reach, pixel_reach] {
                if !inside(u + du, v + dv) {
                    continue;
                }
                let seen = &points[(v + dv) as usize * camera.width + (u + du) as usize];
                if is_finite(seen) {
                    let off = f64::from(seen.z) - at.z;
                    if nearest.is_none_or(|n| off.abs() < n.abs()) {
                        nearest = Some(off);
                    }
                }
            }
        }
        match nearest {
            None => counts.unknown += 1.0,
            Some(off) if off.abs() <= reach => counts.confirmed += 1.0,
            Some(off) if off > 0.0 => counts.missing += 1.0,
            Some(_) => counts.hidden += 1.0,
        }
    }
    counts.shares()
}
