//! The deviation averaged over patches, without the form, and the noise of these averages.

use nalgebra::{Matrix3, Vector3};

use super::{
    PATCH_RADIUS_M,
    alignment::{DEVIATIONS_PER_MEDIAN, MIN_SPREAD_M, biweight},
    readings::NodeReadings,
    surface::Surface,
};
use geometry::{
    parallel::{map_each, num_cores},
    statistics::median,
};

/// Integral of the weights over a disc of radius 1: π/2 - 2/π.
const WEIGHT_OF_DISC: f64 = std::f64::consts::FRAC_PI_2 - std::f64::consts::FRAC_2_PI;
/// Share of a patch, by its weights, that must have readings.
const MIN_COVERAGE: f64 = 0.6;
/// Error of a single node of the reference, metres, before the measured noise scales it together with the camera's.
const REFERENCE_ERROR_M: f64 = 0.0005;
/// How far the part may lie off along its surface, metres: where normals differ, it shows as a deviation.
const ALONG_ERROR_M: f64 = 0.0015;
/// Radius in which the noise is measured, metres.
const NOISE_RADIUS_M: f64 = 0.13;
/// Number of patches around that a noise is measured from, at most and at least.
const NUM_AROUND: usize = 200;
const MIN_AROUND: usize = 25;
/// What a noise measured from few patches is multiplied by: the larger of it and of the whole part's counts, so that chance alone
/// would raise it.
const LOCAL_NOISE_SHARE: f64 = 0.85;
/// The smallest noise that is believed, metres: a rendered scene and its mesh have next to none.
const MIN_NOISE_M: f64 = 5e-5;
/// Number of fits of the form at a node.
const NUM_FORM_FITS: usize = 4;
/// Fewer nodes around do not tell a form.
const MIN_FORM_NODES: usize = 12;

/// What the patch of a radius around each node says.
pub(super) struct Patches {
    /// Radius of a patch, metres.
    pub(super) radius: f64,
    /// Weighted mean distance outside of the surface, metres; NaN where too little is seen.
    pub(super) offs: Vec<f64>,
    /// Standard deviation of that mean, metres.
    pub(super) noises: Vec<f64>,
}

impl Patches {
    /// Averages the readings around each node; the noises are those that the camera and the reference would give if their errors
    /// were independent. A reading counts by a dent's own profile: of all weights, these show it best above the noise (G. L. Turin,
    /// "An introduction to matched filters", IRE Transactions on Information Theory 6(3), 1960).
    pub(super) fn of(surface: &Surface<'_>, readings: &NodeReadings, radius: f64) -> Self {
        let full = WEIGHT_OF_DISC * radius * radius / surface.node_area;
        let each = map_each(surface.points.len(), num_cores(), |node| {
            if readings.num(node) <= 0.0 {
                return (f64::NAN, f64::NAN);
            }
            let (mut num, mut off, mut weights) = (0.0, 0.0, 0.0);
            let (mut variance, mut squares) = (0.0, 0.0);
            surface.around(node, radius + surface.spacing, |near| {
                let away = (surface.points[near] - surface.points[node]).cast::<f64>();
                let mut of_node = 0.0;
                for quarter in &readings.quarters[near] {
                    let Some(place) = quarter.place() else {
                        continue;
                    };
                    let weight = profile((away + place).norm(), 2.0 * radius);
                    of_node += weight * quarter.num;
                    off += weight * quarter.off;
                    variance += weight * weight * quarter.variance;
                }
                num += of_node;
                squares += of_node * of_node;
                if readings.num(near) > 0.0 {
                    weights += profile(away.norm(), 2.0 * radius);
                }
            });
            if weights < MIN_COVERAGE * full || num <= 0.0 {
                return (f64::NAN, f64::NAN);
            }
            let of_reference = REFERENCE_ERROR_M * REFERENCE_ERROR_M * squares;
            (off / num, (variance + of_reference).sqrt() / num)
        });
        let (offs, noises) = each.into_iter().unzip();
        Self {
            radius,
            offs,
            noises,
        }
    }

    /// True if enough of the patch around a node is seen.
    pub(super) fn is_seen(&self, node: usize) -> bool {
        self.offs[node].is_finite()
    }

    /// Returns the form of the part at each node, metres: what a robust plane through the means within `radius` says there. A dent
    /// is smaller than half of that circle, and what lies further off than five times the spread counts nothing.
    pub(super) fn form(&self, surface: &Surface<'_>, radius: f64) -> Vec<f64> {
        let seen = (0..self.offs.len()).filter(|node| self.is_seen(*node));
        let all = median(seen.map(|node| self.offs[node].abs())).unwrap_or(0.0);
        let most = (DEVIATIONS_PER_MEDIAN * all).max(MIN_SPREAD_M);
        map_each(self.offs.len(), num_cores(), |node| {
            if !self.is_seen(node) {
                return f64::NAN;
            }
            self.form_at(surface, node, radius, most)
        })
    }

    fn form_at(&self, surface: &Surface<'_>, node: usize, radius: f64, most: f64) -> f64 {
        let normal: Vector3<f64> = surface.normals[node].cast();
        let least = normal.iamin();
        let first = normal.cross(&Vector3::ith(least, 1.0)).normalize();
        let second = normal.cross(&first);
        // Row of the equations, weight by distance, mean.
        let mut rows: Vec<(Vector3<f64>, f64, f64)> = Vec::new();
        surface.around(node, radius, |near| {
            if self.is_seen(near) {
                let away = (surface.points[near] - surface.points[node]).cast::<f64>() / radius;
                let weight = (1.0 - away.norm_squared()).max(0.0);
                let row = Vector3::new(1.0, away.dot(&first), away.dot(&second));
                rows.push((row, weight * weight, self.offs[near]));
            }
        });
        if rows.len() < MIN_FORM_NODES {
            return self.offs[node];
        }
        // From the median: a plane through all of a dent's readings would follow it.
        let middle = median(rows.iter().map(|row| row.2)).unwrap_or(0.0);
        let mut plane = Vector3::new(middle, 0.0, 0.0);
        for _ in 0..NUM_FORM_FITS {
            let left = |(row, _, off): &(Vector3<f64>, f64, f64)| off - row.dot(&plane);
            let spread = median(rows.iter().map(|row| left(row).abs())).unwrap_or(0.0);
            let spread = (DEVIATIONS_PER_MEDIAN * spread).clamp(MIN_SPREAD_M, most);
            let mut stiffness = Matrix3::<f64>::zeros();
            let mut pull = Vector3::<f64>::zeros();
            for entry in &rows {
                let (row, weight, off) = entry;
                let weight = weight * biweight(left(entry), spread);
                stiffness += row * row.transpose() * weight;
                pull += row * (weight * off);
            }
            // Holds the tilt where all lie on a line.
            let held = 1e-6 * stiffness.trace().max(f64::MIN_POSITIVE);
            stiffness += Matrix3::identity() * held;
            let Some(solved) = stiffness.cholesky() else {
                break;
            };
            plane = solved.solve(&pull);
        }
        plane.x
    }

    /// Takes the form away.
    pub(super) fn without(mut self, form: &[f64]) -> Self {
        for (off, form) in self.offs.iter_mut().zip(form) {
            *off -= form;
        }
        self
    }

    /// Scales the noises to what the patches show: to the spread over the whole part, or around a node where that is larger, and
    /// adds what an error along the surface gives where normals differ, and detail that the reference does not resolve. So errors
    /// that neighbouring readings or all frames share, and those of the reference, are in them.
    pub(super) fn scale_noises(&mut self, surface: &Surface<'_>) {
        let seen: Vec<usize> = (0..self.offs.len())
            .filter(|node| self.is_seen(*node))
            .collect();
        let ratio = |node: usize| (self.offs[node] / self.noises[node]).abs();
        let whole = median(seen.iter().map(|node| ratio(*node))).unwrap_or(0.0);
        let scaled = map_each(self.offs.len(), num_cores(), |node| {
            if !self.is_seen(node) {
                return f64::NAN;
            }
            let mut around: Vec<usize> = Vec::new();
            surface.around(node, NOISE_RADIUS_M, |near| {
                if self.is_seen(near) {
                    around.push(near);
                }
            });
            let step = around.len().div_ceil(NUM_AROUND).max(1);
            let local = (around.len() >= MIN_AROUND)
                .then(|| median(around.iter().step_by(step).map(|near| ratio(*near))))
                .flatten();
            let local = LOCAL_NOISE_SHARE * local.unwrap_or(0.0);
            let scale = DEVIATIONS_PER_MEDIAN * whole.max(local);
            let along = ALONG_ERROR_M * surface.bend(node, self.radius);
            // A larger patch levels it.
            let detail = surface.details[node] * PATCH_RADIUS_M / self.radius;
            let of_reference = along.hypot(detail);
            (scale * self.noises[node])
                .hypot(of_reference)
                .max(MIN_NOISE_M)
        });
        self.noises = scaled;
    }
}

/// Standard deviation over the frames of the averages over patches, metres, divided by the root of their number: what more frames
/// reduce. `None` of fewer than three frames.
pub(super) fn noise_between(
    surface: &Surface<'_>,
    frames: &[NodeReadings],
    radius: f64,
) -> Option<f64> {
    if frames.len() < 3 {
        return None;
    }
    let of_each: Vec<Patches> = (frames.iter())
        .map(|frame| Patches::of(surface, frame, radius))
        .collect();
    let num = frames.len() as f64;
    let variance = |node: usize| -> Option<f64> {
        let mean = of_each.iter().map(|one| one.offs[node]).sum::<f64>() / num;
        let squares = of_each.iter().map(|one| (one.offs[node] - mean).powi(2));
        Some(squares.sum::<f64>() / (num - 1.0)).filter(|variance| variance.is_finite())
    };
    let variance = median((0..surface.points.len()).filter_map(variance))?;
    Some((variance / num).sqrt())
}

/// The profile of a dent of this width at a distance from its middle, 0..1: cos²(π·r / width).
fn profile(distance: f64, width: f64) -> f64 {
    if distance < 0.5 * width {
        (std::f64::consts::PI * distance / width).cos().powi(2)
    } else {
        0.0
    }
}

/// What of a dent's depth is left in the average over a patch of this radius at its middle, for the profile cos²(π·r / width).
pub fn share_in_average(width: f64, radius: f64) -> f64 {
    /// Rings that the patch is divided into.
    const NUM_RINGS: usize = 200;
    let (mut sum, mut weights) = (0.0, 0.0);
    for ring in 0..NUM_RINGS {
        let distance = (ring as f64 + 0.5) / NUM_RINGS as f64 * radius;
        let weight = distance * profile(distance, 2.0 * radius);
        sum += weight * profile(distance, width);
        weights += weight;
    }
    sum / weights
}
