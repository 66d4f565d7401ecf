//! What bounds the match of two shapes before they are laid on each other: where a library is too large to compare every
//! reference in full, most are ruled out by it.
//!
//! None of it depends on the rotation in the plane: the magnitudes of the outline's spectrum, and the area of the image by
//! distance from the outline's centroid, where placements put the shapes.

use super::{correlation::RaySpectra, project::PlaneImage, signature::FanSignature};
use geometry::units::Metres;

/// Number of lowest frequencies, from -7 to 8, whose magnitudes are kept; the others count together.
const NUM_FREQUENCIES: usize = 16;
/// Number of rings; the last has no end.
const NUM_RINGS: usize = 24;
/// Width of a ring, metres.
const RING_WIDTH_M: f64 = 0.05;
/// Spacing of the pixels that are counted, metres.
const SPACING_M: f64 = 0.02;

/// Summary of a shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShapeSummary {
    /// Magnitudes of the rays' discrete Fourier transform over their number, metres; the last is the root of the sum of
    /// the other frequencies' squares.
    magnitudes: [f32; NUM_FREQUENCIES + 1],
    /// Mean of the squared ray lengths, square metres.
    power: f32,
    /// Area of the image in each ring around the centroid, square metres.
    rings: [f32; NUM_RINGS],
}

impl ShapeSummary {
    /// Summarises a shape.
    pub fn of(plane: &PlaneImage, signature: &FanSignature) -> Self {
        let spectrum = RaySpectra::of([&signature.rays[..]]);
        let num_rays = signature.rays.len() as f32;
        let squares: Vec<f32> = spectrum
            .values
            .iter()
            .map(|v| v.norm_sqr() / num_rays.powi(2))
            .collect();
        let mut magnitudes = [0.0; NUM_FREQUENCIES + 1];
        let half = NUM_FREQUENCIES / 2;
        for (index, square) in squares.iter().enumerate() {
            let kept = if index <= half {
                index
            } else if squares.len() - index < half {
                index + NUM_FREQUENCIES - squares.len()
            } else {
                NUM_FREQUENCIES
            };
            magnitudes[kept] += square;
        }
        Self {
            magnitudes: magnitudes.map(f32::sqrt),
            power: squares.iter().sum(),
            rings: rings(plane, signature),
        }
    }

    /// Returns a lower bound of the root mean square distance between the outlines' samples over all rotations and lags.
    ///
    /// The correlation Σ Q·R̄·e^{iφ} is at most Σ |Q|·|R|, and, by the Cauchy-Schwarz inequality, the sum over the higher
    /// frequencies at most the product of the roots of their sums of squares.
    pub fn least_outline_distance(&self, other: &Self) -> Metres {
        let products = self.magnitudes.iter().zip(&other.magnitudes);
        let most: f32 = products.map(|(a, b)| a * b).sum();
        let square = self.power + other.power - 2.0 * most;
        Metres(f64::from(square.max(0.0)).sqrt())
    }

    /// Returns an upper bound of the shared area over the joint area, 0..1, over all rotations about the centroid: no ring
    /// shares more than the smaller of its two areas. It is as exact as the sampled areas.
    pub fn most_overlap(&self, other: &Self) -> f64 {
        let rings = self.rings.iter().zip(&other.rings);
        let (shared, joint) = rings.fold((0.0, 0.0), |(shared, joint), (a, b)| {
            (shared + a.min(*b), joint + a.max(*b))
        });
        if joint > 0.0 {
            f64::from(shared / joint)
        } else {
            0.0
        }
    }
}

fn rings(plane: &PlaneImage, signature: &FanSignature) -> [f32; NUM_RINGS] {
    let step = ((SPACING_M / plane.pixel.0).round() as usize).max(1);
    let area_each = (step as f64 * plane.pixel.0).powi(2) as f32;
    // In widths of a ring.
    let pixel = plane.pixel.0 / RING_WIDTH_M;
    let corner = (plane.plane_point(0.0, 0.0) - signature.centroid) / RING_WIDTH_M;
    let mut rings = [0.0; NUM_RINGS];
    let rows = plane.image.pixels.chunks_exact(plane.image.width.max(1));
    for (row, pixels) in rows.enumerate().step_by(step) {
        let y = corner.y - row as f64 * pixel;
        for (column, _) in pixels
            .iter()
            .enumerate()
            .step_by(step)
            .filter(|(_, set)| **set != 0)
        {
            let x = corner.x + column as f64 * pixel;
            rings[((x * x + y * y).sqrt() as usize).min(NUM_RINGS - 1)] += area_each;
        }
    }
    rings
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector2;
    use proptest::prelude::*;

    use super::*;
    use crate::correlation::CircularCorrelator;
    use geometry::raster::BinaryImage;

    /// A shape with some pixels set, and any rays.
    fn shape(pixels: &[u8], rays: &[(f64, f64)]) -> (ShapeSummary, FanSignature) {
        let image = BinaryImage {
            width: pixels.len() / 8,
            height: 8,
            pixels: pixels.to_vec(),
        };
        let plane = PlaneImage::from_image(image, Metres(0.1));
        let signature = FanSignature {
            centroid: plane.plane_point(2.0, 3.0),
            rays: rays.iter().map(|(x, y)| Vector2::new(*x, *y)).collect(),
            perimeter: Metres(1.0),
        };
        (ShapeSummary::of(&plane, &signature), signature)
    }

    proptest! {
        #[test]
        fn no_lag_brings_two_outlines_closer_than_the_bound(
            rays in prop::collection::vec((-1.0_f64..1.0, -1.0_f64..1.0), 64),
            other in prop::collection::vec((-1.0_f64..1.0, -1.0_f64..1.0), 64),
        ) {
            let (summary, signature) = shape(&[1; 64], &rays);
            let (of_other, signature_of_other) = shape(&[1; 64], &other);
            let bound = summary.least_outline_distance(&of_other).0;
            let spectra = |signature: &FanSignature| RaySpectra::of([&signature.rays[..]]);
            let mut correlator = CircularCorrelator::new(spectra(&signature));
            let spectrum = spectra(&signature_of_other);
            let correlations: Vec<_> = correlator.correlate(&spectrum).collect();
            let (values, power) = correlations[0];
            for value in values {
                let left = power - 2.0 * f64::from(value.norm());
                prop_assert!(bound <= (left.max(0.0) / 64.0).sqrt() + 1e-3);
            }
            prop_assert!(summary.least_outline_distance(&summary).0 < 1e-3);
        }

        #[test]
        fn no_two_images_of_the_same_centroid_share_more_than_the_bound(
            pixels in prop::collection::vec(0_u8..2, 64),
            other in prop::collection::vec(0_u8..2, 64),
        ) {
            let of = |pixels: &[u8]| shape(pixels, &[(1.0, 0.0); 16]).0;
            let count = |is_set: fn(u8, u8) -> bool| {
                let pairs = pixels.iter().zip(&other);
                pairs.filter(|(a, b)| is_set(**a, **b)).count() as f64
            };
            let (shared, joint) = (count(|a, b| a & b == 1), count(|a, b| a | b == 1));
            let bound = of(&pixels).most_overlap(&of(&other));
            prop_assert!(joint < 1.0 || bound >= shared / joint - 1e-6);
        }
    }

    #[test]
    fn nothing_overlaps_an_empty_image() {
        let [empty, full] = [0, 1].map(|set| shape(&[set; 64], &[(1.0, 0.0); 16]).0);
        assert!(empty.most_overlap(&full) < 1e-9 && empty.most_overlap(&empty) < 1e-9);
        assert!((full.most_overlap(&full) - 1.0).abs() < 1e-6);
    }
}
