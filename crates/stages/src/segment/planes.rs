//! The background: wall, floor and at most one more plane by default, found by RANSAC on a subset of the scene.

use nalgebra::{Point3, Vector3};
use rand::{RngExt as _, SeedableRng as _};
use rand_pcg::Pcg64;

use super::{
    PointLabel, SegmentParams,
    noise::{self, NOISE_RANGE_AT_1M},
    subset::{Neighbourhood, Subset},
};
use crate::scene::{PictureEdge, SceneCloud};
use geometry::{plane::Plane, statistics::median, units::Metres};

pub(super) struct Background {
    pub(super) planes: Vec<Plane>,
    pub(super) noise_at_1m: Metres,
}

/// Minimum share of the scene on a plane: a floor seen as a strip along the lower edge of the picture holds a few per cent.
const MIN_INLIER_SHARE: f64 = 0.012;
/// Probability that both neighbours of a point lie on the same surface as the point, used for local samples. Measured
/// on simulated frames as 0.6 to 0.9; a lower value only costs time.
const SAME_SURFACE: f64 = 0.5;
/// Maximum share of all other points behind a background plane (reflections, an open door).
const MAX_BEHIND_SHARE: f64 = 0.04;
/// Minimum share of the border of the field of view covered by a background plane: a floor seen only along the lower
/// edge covers a quarter, a part that hangs inside the picture nothing.
const MIN_EDGE_SHARE: f64 = 0.08;
/// Minimum share of the points off a background plane if the picture ends with the points.
const LEAST_FOREGROUND: f64 = 0.03;
/// Maximum number of samples of one plane. In a cloud without rows and columns they find a plane with 4 % of the points in 92 of
/// 100 cases; without a limit, a cloud without planes would take millions of samples and many seconds.
const MAX_SAMPLES: usize = 40_000;
/// Maximum number of planes examined, so that a faceted part takes bounded time.
const MAX_CANDIDATES: usize = 6;

pub(super) fn find_background(scene: &SceneCloud, params: &SegmentParams) -> Background {
    let noise_seen = noise::noise_of_picture(scene).unwrap_or(params.noise_at_1m);
    let mut noise_at_1m = Metres(params.noise_at_1m.0.max(noise_seen.0));
    let subset = Subset::new(scene, params, noise_at_1m);
    let mut rng = Pcg64::seed_from_u64(params.seed);
    let mut planes: Vec<Plane> = Vec::new();
    // Points not yet assigned to a plane, background or not.
    let mut unclaimed: Vec<u32> = (0..subset.len() as u32).collect();
    // Points on no background plane; further background planes must lie behind them.
    let mut foreground = vec![true; subset.len()];
    for _ in 0..MAX_CANDIDATES {
        let too_few = (unclaimed.len() as f64) < MIN_INLIER_SHARE * subset.len() as f64;
        if planes.len() == params.max_planes || too_few {
            break;
        }
        let Some(plane) = best_plane(&subset, &unclaimed, params, &mut rng) else {
            break;
        };
        let Some((plane, inliers)) = refine(&subset, &unclaimed, plane) else {
            break;
        };
        let is_alone = inliers.len() as f64 > (1.0 - LEAST_FOREGROUND) * subset.len() as f64;
        // Without a view around it, a plane on its own may be a flat part.
        let may_be_part = is_alone && scene.edge == PictureEdge::Points;
        if !may_be_part && is_background(&subset, &plane, &inliers, &foreground) {
            if planes.is_empty() {
                noise_at_1m = measured_noise(&subset, &plane, &inliers).unwrap_or(noise_at_1m);
            }
            for &i in &inliers {
                foreground[i as usize] = false;
            }
            planes.push(plane);
        }
        unclaimed.retain(|i| inliers.binary_search(i).is_err());
    }
    Background {
        planes,
        noise_at_1m,
    }
}

/// Labels the points on or behind a background plane.
pub(super) fn label_background(
    points: &[Point3<f32>],
    planes: &[Plane],
    noise_at_1m: Metres,
    params: &SegmentParams,
) -> Vec<PointLabel> {
    let tolerance = PlaneTolerance::new(noise_at_1m, params);
    let planes: Vec<([f32; 3], f32)> = planes
        .iter()
        .map(|plane| {
            let n = plane.normal.cast::<f32>();
            ([n.x, n.y, n.z], plane.offset as f32)
        })
        .collect();
    let backgrounds = (0..planes.len()).map(|k| PointLabel::Background(k as u8));
    let others = [PointLabel::Rest, PointLabel::NoReading];
    let kinds: Vec<PointLabel> = backgrounds.chain(others).collect();
    let [rest, no_reading] = [0, 1].map(|other| (planes.len() + other) as u32);
    let mut labels = vec![PointLabel::Rest; points.len()];
    for (block, labels) in points.chunks(BLOCK).zip(labels.chunks_mut(BLOCK)) {
        let (mut x, mut y, mut z) = ([0.0; BLOCK], [0.0; BLOCK], [0.0; BLOCK]);
        for (((p, x), y), z) in block.iter().zip(&mut x).zip(&mut y).zip(&mut z) {
            (*x, *y, *z) = (p.x, p.y, p.z);
        }
        let mut kind = z.map(|z: f32| if z.is_nan() { no_reading } else { rest });
        // The first plane counts, so it is looked at last.
        for (k, (n, offset)) in planes.iter().enumerate().rev() {
            for i in 0..BLOCK {
                let along_normal = n[0] * x[i] + n[1] * y[i] + n[2] * z[i];
                // Never true of a point without a reading.
                let is_on = along_normal + offset < tolerance.at(z[i], along_normal);
                kind[i] = if is_on { k as u32 } else { kind[i] };
            }
        }
        for (label, kind) in labels.iter_mut().zip(kind) {
            *label = kinds[kind as usize];
        }
    }
    labels
}

/// Points that are labelled side by side.
const BLOCK: usize = 64;

/// Distance from a background plane within which a point belongs to it, metres.
#[derive(Clone, Copy)]
pub(super) struct PlaneTolerance {
    base: f32,
    noise: f32,
}

impl PlaneTolerance {
    pub(super) fn new(noise_at_1m: Metres, params: &SegmentParams) -> Self {
        Self {
            base: params.plane_distance.0 as f32,
            noise: (params.noise_factor * noise_at_1m.0) as f32,
        }
    }

    /// Returns the tolerance of a point at depth `z` whose position along the plane's normal is `along_normal`.
    ///
    /// Depth noise of `noise · z²` moves the point along its ray, and so along the normal by `noise · z² · (normal · ray)` for a
    /// ray with z = 1: little for a floor seen at a grazing angle.
    pub(super) fn at(self, z: f32, along_normal: f32) -> f32 {
        self.base + self.noise * z.abs() * along_normal.abs()
    }
}

/// Returns the number of samples that contain a good one with probability `p` (eq. 1), for a share of good samples of
/// `good_share` (the paper's (1 - ε)^s), but at most [`MAX_SAMPLES`].
fn num_samples(p: f64, good_share: f64) -> usize {
    let num = ((1.0 - p).ln() / (1.0 - good_share.clamp(1e-6, 1.0 - 1e-9)).ln()).ceil() as usize;
    num.min(MAX_SAMPLES)
}

/// RANSAC: finds the plane through three points that contains most unclaimed points.
fn best_plane(
    subset: &Subset,
    unclaimed: &[u32],
    params: &SegmentParams,
    rng: &mut Pcg64,
) -> Option<Plane> {
    let gather =
        |from: &[f32]| -> Vec<f32> { unclaimed.iter().map(|&i| from[i as usize]).collect() };
    let (x, y, z, reach) = (
        gather(&subset.x),
        gather(&subset.y),
        gather(&subset.z),
        gather(&subset.reach),
    );
    let good_share = |inlier_share: f64| match subset.cells {
        Some(_) => inlier_share * SAME_SURFACE,
        None => inlier_share.powi(3),
    };
    let least = MIN_INLIER_SHARE * subset.len() as f64;
    let mut needed = num_samples(
        params.good_sample_probability,
        good_share(least / unclaimed.len() as f64),
    );
    let mut best: Option<(Plane, f64)> = None;
    let mut drawn = 0;
    while drawn < needed {
        drawn += 1;
        let shape = match drawn % 2 {
            0 => Neighbourhood::Strip,
            _ => Neighbourhood::Round,
        };
        let first = unclaimed[rng.random_range(0..unclaimed.len())];
        let Some([second, third]) = subset.sample_neighbours(first, shape, unclaimed, rng) else {
            continue;
        };
        let Some(plane) = Plane::through(
            &subset.point(first),
            &subset.point(second),
            &subset.point(third),
        ) else {
            continue;
        };
        let num_inliers = f64::from(count_inliers(&x, &y, &z, &reach, &plane));
        if num_inliers > best.map_or(least, |b| b.1) {
            best = Some((plane, num_inliers));
            let share = num_inliers / unclaimed.len() as f64;
            needed = num_samples(params.good_sample_probability, good_share(share));
        }
    }
    best.map(|b| b.0)
}

fn count_inliers(x: &[f32], y: &[f32], z: &[f32], reach: &[f32], plane: &Plane) -> u32 {
    let n = plane.normal.cast::<f32>();
    let offset = plane.offset as f32;
    let mut count = 0_u32;
    for (((x, y), z), reach) in x.iter().zip(y).zip(z).zip(reach) {
        let distance = n.x * x + n.y * y + n.z * z + offset;
        // Never overflows; a checked addition would keep the compiler from using vectors.
        count = count.wrapping_add(u32::from(distance.abs() < *reach));
    }
    count
}

/// Fits the plane to its inliers twice by least squares, weighted by the inverse variance of the depth.
fn refine(subset: &Subset, unclaimed: &[u32], plane: Plane) -> Option<(Plane, Vec<u32>)> {
    let mut plane = plane;
    for _ in 0..2 {
        let inliers = unclaimed
            .iter()
            .map(|&i| subset.point(i))
            .zip(unclaimed)
            .filter(|(p, i)| plane.signed_distance(p).abs() < f64::from(subset.reach[**i as usize]))
            .map(|(p, _)| (p, p.z.powi(-4)));
        plane = Plane::fit(inliers)?;
    }
    // The camera is at the origin of camera space.
    let plane = plane.facing(&Point3::origin());
    let inliers = unclaimed
        .iter()
        .copied()
        .filter(|&i| {
            plane.signed_distance(&subset.point(i)).abs() < f64::from(subset.reach[i as usize])
        })
        .collect();
    Some((plane, inliers))
}

/// Returns true if (nearly) all of the foreground is in front of the plane and the plane extends beyond the picture.
fn is_background(subset: &Subset, plane: &Plane, inliers: &[u32], foreground: &[bool]) -> bool {
    let (mut behind, mut total) = (0.0, 0.0_f64);
    for i in (0..subset.len() as u32).filter(|&i| foreground[i as usize]) {
        let distance = plane.signed_distance(&subset.point(i));
        let reach = f64::from(subset.reach[i as usize]);
        if distance.abs() >= reach {
            total += 1.0;
            behind += f64::from(u8::from(distance < 0.0));
        }
    }
    behind <= MAX_BEHIND_SHARE * total && runs_out_of_the_picture(subset, plane, inliers)
}

fn runs_out_of_the_picture(subset: &Subset, plane: &Plane, inliers: &[u32]) -> bool {
    match &subset.cells {
        Some(cells) => {
            let (edge, num_ends) = cells.edge_points();
            let on_plane = edge
                .iter()
                .filter(|i| inliers.binary_search(i).is_ok())
                .count();
            on_plane as f64 >= MIN_EDGE_SHARE * num_ends as f64
        }
        None => spreads_wider_than_the_rest(subset, plane, inliers),
    }
}

/// Without a picture: returns true if the plane's points extend farther than all others along a direction of the plane.
fn spreads_wider_than_the_rest(subset: &Subset, plane: &Plane, inliers: &[u32]) -> bool {
    let across = plane.normal.cross(&Vector3::x());
    let across = if across.norm() > 0.1 {
        across.normalize()
    } else {
        plane.normal.cross(&Vector3::y()).normalize()
    };
    let along = plane.normal.cross(&across);
    let extent = |indices: &mut dyn Iterator<Item = u32>, direction: &Vector3<f64>| {
        let (low, high) = indices
            .map(|i| direction.dot(&subset.point(i).coords))
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| {
                (low.min(x), high.max(x))
            });
        high - low
    };
    [across, along].iter().any(|direction| {
        let own = extent(&mut inliers.iter().copied(), direction);
        let others = extent(
            &mut (0..subset.len() as u32).filter(|i| inliers.binary_search(i).is_err()),
            direction,
        );
        // If there is nothing else, the cloud is the plane itself: an isolated flat part.
        others.is_finite() && own > 1.2 * others
    })
}

/// Estimates the standard deviation of depth at 1 m from the points' median distance to a plane; `None` if too few
/// points see the plane at a steep enough angle.
fn measured_noise(subset: &Subset, plane: &Plane, inliers: &[u32]) -> Option<Metres> {
    let deviations: Vec<f64> = inliers
        .iter()
        .map(|&i| subset.point(i))
        .filter_map(|p| {
            let along_normal = plane.normal.dot(&p.coords).abs();
            let square_on = along_normal / p.coords.norm();
            (square_on > 0.5).then(|| plane.signed_distance(&p).abs() / (p.z * along_normal))
        })
        .collect();
    if deviations.len() < 100 {
        return None;
    }
    // 1.4826 converts the median absolute deviation of a normal distribution into its standard deviation.
    let noise = 1.4826 * median(deviations.into_iter())?;
    Some(Metres(
        noise.clamp(NOISE_RANGE_AT_1M[0], NOISE_RANGE_AT_1M[1]),
    ))
}
