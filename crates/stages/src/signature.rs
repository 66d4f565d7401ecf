//! Signature: the fan shape model, the lengths and angles of the rays from the centroid to the contour (eq. 8 to 10).
//!
//! [`LiteralSignature`] is the paper's signature as written: one ray per contour pixel, the angle folded into one
//! quadrant. The default differs: the outline is smoothed to remove the pixel staircase and resampled at equal distances,
//! so that a signature has the same length at any resolution, and the angle covers the full circle. Translating the part
//! then leaves the signature unchanged; rotating it adds a constant to the angles and shifts both lists cyclically.

use nalgebra::{Point2, Vector2};

use crate::contour::Contour;
use geometry::{polygon, units::Metres};

/// Parameters of [`describe`].
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(default)]
pub struct SignatureParams {
    /// Number of rays around the outline, a power of two, 64..2048. Raising it costs ranking time and resolves finer detail.
    pub num_rays: usize,
    /// Length over which the outline is averaged before resampling, 0..100 mm. Raising it tolerates ragged edges
    /// and rounds corners.
    pub smoothing: Metres,
}

impl Default for SignatureParams {
    fn default() -> Self {
        Self {
            num_rays: 256,
            smoothing: Metres::from_mm(25.0),
        }
    }
}

/// Rays from the centroid to points at equal distances along the outline, counter-clockwise.
#[derive(Clone, Debug, PartialEq)]
pub struct FanSignature {
    /// Mean of the outline's points (eq. 10), plane space, metres.
    pub centroid: Point2<f64>,
    /// The points relative to the centroid, metres; as complex numbers they are L·e^{iΘ}.
    pub rays: Vec<Vector2<f64>>,
    /// Length of the smoothed outline.
    pub perimeter: Metres,
}

impl FanSignature {
    /// Returns the ray lengths L (eq. 8), metres.
    pub fn lengths(&self) -> Vec<f64> {
        self.rays.iter().map(Vector2::norm).collect()
    }

    /// Returns the ray angles Θ from the first plane axis, radians, continuous from ray to ray.
    pub fn angles(&self) -> Vec<f64> {
        unwrapped(self.rays.iter().map(|r| r.y.atan2(r.x)))
    }
}

/// The paper's signature: one ray per contour pixel in the order followed.
#[derive(Clone, Debug, PartialEq)]
pub struct LiteralSignature {
    /// Ray lengths (eq. 8), pixels.
    pub lengths: Vec<f64>,
    /// Ray angles (eq. 9), radians, 0..π/2: absolute values fold the circle into one quadrant.
    pub angles: Vec<f64>,
}

/// Reason why no signature could be made.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error, serde::Serialize, serde::Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum SignatureError {
    /// The outline has no length.
    NoOutline {
        /// Number of points of the outline.
        num_points: usize,
    },
}

texts::described!(SignatureError: "refusal" by "kind");

/// Computes the fan signature of an outline.
pub fn describe(
    contour: &Contour,
    params: &SignatureParams,
) -> Result<FanSignature, SignatureError> {
    let no_outline = SignatureError::NoOutline {
        num_points: contour.outline.len(),
    };
    let spacing = polygon::perimeter(&contour.outline) / contour.outline.len().max(1) as f64;
    let reach = (params.smoothing.0 / spacing.max(f64::MIN_POSITIVE) / 2.0).round() as usize;
    // Preserve the shape of a small outline: never average over more than 1/32 of it on either side.
    let reach = reach.min(contour.outline.len() / 32);
    let smooth = polygon::smooth(&contour.outline, reach);
    let samples = polygon::resample_evenly(&smooth, params.num_rays).ok_or(no_outline)?;
    let centroid = polygon::mean_corner(&samples).ok_or(no_outline)?;
    let rays: Vec<Vector2<f64>> = samples.iter().map(|s| s - centroid).collect();
    Ok(FanSignature {
        centroid,
        perimeter: Metres(polygon::perimeter(&smooth)),
        rays,
    })
}

/// Adds full turns so that neighbours differ by at most half a turn.
fn unwrapped(angles: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut previous: Option<f64> = None;
    angles
        .map(|angle| {
            let continued = match previous {
                Some(p) => {
                    let turns = ((p - angle) / std::f64::consts::TAU).round();
                    angle + turns * std::f64::consts::TAU
                }
                None => angle,
            };
            previous = Some(continued);
            continued
        })
        .collect()
}

impl LiteralSignature {
    /// Computes the signature from an outline's pixels (column, row) in the order followed.
    pub fn of(pixels: &[[u32; 2]]) -> Self {
        let n = pixels.len().max(1) as f64;
        // Eq. (10)
        let sum = pixels.iter().fold([0.0, 0.0], |sum, &[u, v]| {
            [sum[0] + f64::from(u), sum[1] + f64::from(v)]
        });
        let centre = [sum[0] / n, sum[1] / n];
        let (mut lengths, mut angles) = (
            Vec::with_capacity(pixels.len()),
            Vec::with_capacity(pixels.len()),
        );
        for &[u, v] in pixels {
            let (x, y) = (f64::from(u) - centre[0], f64::from(v) - centre[1]);
            // Eq. (8) and (9)
            lengths.push(x.hypot(y));
            angles.push(y.abs().atan2(x.abs()));
        }
        Self { lengths, angles }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        contour::{ContourParams, find_contour},
        project::PlaneImage,
    };
    use geometry::raster::BinaryImage;

    /// An L-shaped part drawn with any rotation, translation and resolution.
    fn drawn(turn: f64, shift: [f64; 2], pixel: f64) -> FanSignature {
        let side = (1.6 / pixel) as usize;
        let mut image = BinaryImage::new(side, side);
        for row in 0..side {
            for column in 0..side {
                let x = column as f64 * pixel - 0.8 - shift[0];
                let y = 0.8 - row as f64 * pixel - shift[1];
                let (a, b) = (
                    x * turn.cos() + y * turn.sin(),
                    y * turn.cos() - x * turn.sin(),
                );
                let inside = (-0.4..0.4).contains(&a)
                    && (-0.25..0.25).contains(&b)
                    && !(a > 0.0 && b > 0.05);
                image.pixels[row * side + column] = u8::from(inside);
            }
        }
        let plane = PlaneImage::from_image(image, Metres(pixel));
        let contour = find_contour(&plane, &ContourParams::default()).expect("a shape");
        describe(&contour, &SignatureParams::default()).expect("an outline")
    }

    /// Returns the largest difference of ray lengths at the best cyclic shift.
    fn length_difference(a: &FanSignature, b: &FanSignature) -> f64 {
        let (a, b) = (a.lengths(), b.lengths());
        let n = a.len();
        (0..n)
            .map(|lag| {
                (0..n)
                    .map(|i| (a[i] - b[(i + lag) % n]).abs())
                    .fold(0.0, f64::max)
            })
            .fold(f64::INFINITY, f64::min)
    }

    #[test]
    fn turning_moving_or_resampling_the_part_shifts_the_signature_cyclically() {
        let still = drawn(0.0, [0.0, 0.0], 0.005);
        for (turn, shift, pixel) in [
            (0.65, [0.0, 0.0], 0.005),
            (0.0, [0.11, -0.07], 0.005),
            (2.5, [0.05, 0.1], 0.008),
        ] {
            let other = drawn(turn, shift, pixel);
            let difference = length_difference(&still, &other);
            // Two pixels of the coarser image: the staircase, and up to half a sample of lag.
            assert!(difference < 0.016, "{difference} m at turn {turn}");
        }
    }

    #[test]
    fn angles_go_once_around_counter_clockwise() {
        let signature = drawn(0.3, [0.0, 0.0], 0.005);
        let (lengths, angles) = (signature.lengths(), signature.angles());
        let whole = angles[angles.len() - 1] - angles[0];
        assert!((whole - std::f64::consts::TAU).abs() < 0.2);
        for (ray, (length, angle)) in signature.rays.iter().zip(lengths.iter().zip(&angles)) {
            assert!((ray - Vector2::new(length * angle.cos(), length * angle.sin())).norm() < 1e-9);
        }
    }

    #[test]
    fn the_literal_angle_is_folded_into_one_quadrant() {
        let literal = LiteralSignature::of(&[[0, 0], [4, 0], [4, 2], [0, 2]]);
        let corner = (1.0_f64).atan2(2.0);
        for (length, angle) in literal.lengths.iter().zip(&literal.angles) {
            assert!((length - 5.0_f64.sqrt()).abs() < 1e-12 && (angle - corner).abs() < 1e-12);
        }
    }
}
