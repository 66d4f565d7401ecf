//! How far the normals of a target are off: what they feign to hold.

use nalgebra::Vector3;

use super::{Pair, tangents};
use crate::pose::refine::{AlignmentTarget, Search};
use geometry::statistics::median;

/// Neighbours that a normal is the mean of, about, and the radius they lie within, in spacings.
const NORMAL_NEIGHBOURS: f64 = 28.0;
const NORMAL_RADIUS: f64 = 3.0;
/// No normal is known better than this, radians.
const MIN_TILT_RAD: f64 = 0.005;
/// Points whose neighbours are looked at.
const NUM_ASKED: usize = 200;
/// The median of a squared normal variable of variance 1.
const MEDIAN_SQ: f64 = 0.455;

/// Mean square of the angle between the normal that a pair was given and that of the surface, radians squared.
///
/// The noise of the target's own points tilts its normals; and a pair has the normal of the closest point, which on a
/// curved surface is not that at its own place. Both follow from neighbouring target points. Medians, because at a
/// crease neighbours differ, and a crease does hold.
pub(super) fn tilt_sq(pairs: &[Pair], target: &AlignmentTarget<'_>) -> f64 {
    let normals = target.cloud.normals.as_deref().unwrap_or_default();
    let step = (pairs.len() / NUM_ASKED).max(1);
    let (mut offs_sq, mut bends_sq) = (Vec::new(), Vec::new());
    for pair in pairs.iter().step_by(step) {
        let at = target.cloud.points[pair.index];
        let aside: Vector3<f32> = tangents(&pair.normal)[0].cast() * (1.5 * target.spacing as f32);
        let reach = 5.0 * target.spacing as f32;
        let neighbour = target.nearest(Search::Field, &(at + aside), reach * reach);
        let Some(neighbour) = neighbour.filter(|n| n.index != pair.index) else {
            continue;
        };
        let apart: Vector3<f64> = (target.cloud.points[neighbour.index] - at).cast();
        if let Some(normal) = normals.get(neighbour.index) {
            let bend_sq = (normal.cast::<f64>() - pair.normal).norm_squared();
            bends_sq.push(bend_sq / apart.norm_squared().max(f64::MIN_POSITIVE));
            offs_sq.push(apart.dot(&pair.normal).powi(2));
        }
    }
    // A neighbour is off by the noise of both.
    let noise_sq = median(offs_sq.into_iter()).unwrap_or(0.0) / (2.0 * MEDIAN_SQ);
    let radius = NORMAL_RADIUS * target.spacing;
    let weight_sum: f64 = pairs.iter().map(|p| p.weight).sum();
    let beside_sq = pairs.iter().map(|p| p.weight * p.beside_sq).sum::<f64>() / weight_sum;
    4.0 * noise_sq / (NORMAL_NEIGHBOURS * radius * radius)
        + median(bends_sq.into_iter()).unwrap_or(0.0) * beside_sq
        + MIN_TILT_RAD * MIN_TILT_RAD
}
