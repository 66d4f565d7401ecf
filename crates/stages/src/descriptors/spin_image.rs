//! Spin images: positions of a keypoint's neighbours, accumulated over rotation about its normal.
//!
//! A. E. Johnson and M. Hebert, "Using spin images for efficient object recognition in cluttered 3D scenes", IEEE
//! Transactions on Pattern Analysis and Machine Intelligence 21(5), 1999. A neighbour x of the oriented point (p, n)
//! has the coordinates β = n·(x - p) along the normal and α = √(|x - p|² - β²) away from it, and is distributed
//! bilinearly over the four pixels around (α, β). Neighbours whose normal differs by more than the support angle are
//! ignored: they would be hidden from other sides.
//!
//! Deviations: the paper compares images by the correlation of the pixels that are filled in both. Here each row is
//! normalised to mean zero and length one, so that |a - b|² = 2 - 2R with R the correlation over all pixels: the
//! nearest row in descriptor space has the highest correlation. There is no term for the share of filled pixels.

use super::{Descriptors, normalise, surface::DescribedSurface};
use geometry::units::{Metres, Radians};

/// Number of pixels along α and along β.
const SIDE: usize = 15;
/// Numbers per row.
const WIDTH: usize = SIDE * SIDE;
/// Minimum number of neighbours; with fewer the image is random.
const MIN_NEIGHBOURS: usize = 5;

/// Parameters of [`describe_spin_images`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpinImageParams {
    /// Side of the image, 60..600 mm: α covers zero to this, β half of it on either side. Time grows with its square.
    pub reach: Metres,
    /// Maximum angle between the normals of keypoint and neighbour, 30°..180°.
    pub support_angle: Radians,
}

impl Default for SpinImageParams {
    fn default() -> Self {
        Self {
            reach: Metres::from_mm(500.0),
            support_angle: Radians::from_degrees(60.0),
        }
    }
}

/// Computes the rows of the given points (indices into the surface, ascending): β grows row by row, α within each.
/// Points with too few neighbours get none.
pub fn describe_spin_images(
    surface: &DescribedSurface,
    keypoints: &[u32],
    params: &SpinImageParams,
) -> Descriptors {
    let mut described = Descriptors {
        width: WIDTH,
        ..Descriptors::default()
    };
    for &keypoint in keypoints {
        let start = described.values.len();
        described.values.resize(start + WIDTH, 0.0);
        let image = &mut described.values[start..];
        let num = accumulate(surface, keypoint as usize, params, image);
        if num >= MIN_NEIGHBOURS && standardise(image) {
            described.keypoints.push(keypoint);
        } else {
            described.values.truncate(start);
        }
    }
    described
}

/// Adds the neighbours to the image; returns their number.
fn accumulate(
    surface: &DescribedSurface,
    keypoint: usize,
    params: &SpinImageParams,
    image: &mut [f32],
) -> usize {
    let here = &surface.points[keypoint];
    let normal = &surface.normals[keypoint];
    let least_cosine = params.support_angle.0.cos() as f32;
    let reach = params.reach.0 as f32;
    let pixels_per_metre = SIDE as f32 / reach;
    // Distance to the corner of the cylinder that the image covers.
    let radius = reach * (1.0_f32 + 0.25).sqrt();
    let mut num = 0;
    surface.tree.within(here, radius, |neighbour| {
        if neighbour.distance_sq == 0.0
            || surface.normals[neighbour.index].dot(normal) < least_cosine
        {
            return;
        }
        let beta = normal.dot(&(surface.points[neighbour.index] - here));
        let alpha = (neighbour.distance_sq - beta * beta).max(0.0).sqrt();
        if alpha >= reach || beta.abs() >= 0.5 * reach {
            return;
        }
        num += 1;
        add(
            image,
            alpha * pixels_per_metre,
            (beta + 0.5 * reach) * pixels_per_metre,
        );
    });
    num
}

/// Distributes a point over the four pixels around it. Pixel i covers i to i + 1; at the image's edge a point
/// counts for the outermost pixel.
fn add(image: &mut [f32], column: f32, row: f32) {
    let split = |position: f32| {
        let x = (position - 0.5).clamp(0.0, (SIDE - 1) as f32);
        let low = x as usize;
        (low, (low + 1).min(SIDE - 1), x - low as f32)
    };
    let (left, right, a) = split(column);
    let (top, bottom, b) = split(row);
    image[top * SIDE + left] += (1.0 - a) * (1.0 - b);
    image[top * SIDE + right] += a * (1.0 - b);
    image[bottom * SIDE + left] += (1.0 - a) * b;
    image[bottom * SIDE + right] += a * b;
}

/// Normalises to mean zero and length one; returns false for a constant image.
fn standardise(image: &mut [f32]) -> bool {
    let mean = image.iter().sum::<f32>() / image.len() as f32;
    for x in image.iter_mut() {
        *x -= mean;
    }
    normalise(image)
}

#[cfg(test)]
mod tests {
    use nalgebra::{Point3, Vector3};

    use super::*;
    use crate::descriptors::surface::{
        keypoints,
        tests::{bent_surface, moved, plane, sphere, surface_of, test_motion},
    };

    /// Pixels of 10 mm.
    fn small() -> SpinImageParams {
        SpinImageParams {
            reach: Metres(0.15),
            ..SpinImageParams::default()
        }
    }

    /// Every point against every pixel, as counts.
    fn slow_image(
        surface: &DescribedSurface,
        keypoint: usize,
        params: &SpinImageParams,
    ) -> Vec<f64> {
        let n = surface.normals[keypoint].cast::<f64>();
        let pixel = params.reach.0 / SIDE as f64;
        let middle = |i: usize| i as f64 + 0.5;
        let tent = |position: f64, i: usize| {
            let position = position.clamp(0.5, SIDE as f64 - 0.5);
            (1.0 - (position - middle(i)).abs()).max(0.0)
        };
        let mut image = vec![0.0; WIDTH];
        for (i, p) in surface.points.iter().enumerate() {
            let offset = p.cast::<f64>() - surface.points[keypoint].cast::<f64>();
            let beta = n.dot(&offset);
            let alpha = (offset - n * beta).norm();
            let turned = surface.normals[i]
                .cast::<f64>()
                .dot(&n)
                .clamp(-1.0, 1.0)
                .acos();
            let is_inside = alpha < params.reach.0 && beta.abs() < params.reach.0 / 2.0;
            if i == keypoint || !is_inside || turned > params.support_angle.0 {
                continue;
            }
            for (k, sum) in image.iter_mut().enumerate() {
                *sum += tent(alpha / pixel, k % SIDE)
                    * tent(beta / pixel + SIDE as f64 / 2.0, k / SIDE);
            }
        }
        image
    }

    fn counts(surface: &DescribedSurface, keypoint: usize, params: &SpinImageParams) -> Vec<f32> {
        let mut image = vec![0.0; WIDTH];
        accumulate(surface, keypoint, params, &mut image);
        image
    }

    #[test]
    fn images_agree_with_a_tent_over_every_pixel() {
        let surface = bent_surface();
        let params = SpinImageParams {
            reach: Metres(0.09),
            support_angle: Radians::from_degrees(40.0),
        };
        for keypoint in keypoints(&surface, Metres(0.08)) {
            let fast = counts(&surface, keypoint as usize, &params);
            let slow = slow_image(&surface, keypoint as usize, &params);
            let apart: f64 = fast
                .iter()
                .zip(&slow)
                .map(|(a, b)| (f64::from(*a) - b).abs())
                .sum();
            // A neighbour at the very edge of the cylinder or the support angle may fall on either side.
            assert!(apart < 2.5, "{apart} at {keypoint}");
        }
    }

    #[test]
    fn distance_in_descriptor_space_is_correlation() {
        let found = describe_spin_images(&bent_surface(), &[700, 1900], &small());
        let rows: Vec<&[f32]> = found.rows().collect();
        let correlation: f32 = {
            let raw = [700, 1900].map(|k| counts(&bent_surface(), k, &small()));
            let mean = |x: &[f32]| x.iter().sum::<f32>() / x.len() as f32;
            let (a, b) = (mean(&raw[0]), mean(&raw[1]));
            let sum = |f: &dyn Fn(f32, f32) -> f32| -> f32 {
                raw[0]
                    .iter()
                    .zip(&raw[1])
                    .map(|(x, y)| f(x - a, y - b))
                    .sum()
            };
            sum(&|x, y| x * y) / (sum(&|x, _| x * x) * sum(&|_, y| y * y)).sqrt()
        };
        let distance_sq: f32 = rows[0]
            .iter()
            .zip(rows[1])
            .map(|(a, b)| (a - b).powi(2))
            .sum();
        assert!((distance_sq - (2.0 - 2.0 * correlation)).abs() < 1e-4);
    }

    #[test]
    fn moving_camera_and_part_together_changes_next_to_nothing() {
        let surface = bent_surface();
        let chosen = keypoints(&surface, Metres(0.06));
        let params = small();
        let before = describe_spin_images(&surface, &chosen, &params);
        let after = describe_spin_images(&moved(&surface, &test_motion()), &chosen, &params);
        assert_eq!(before.keypoints, after.keypoints);
        for (a, b) in before.rows().zip(after.rows()) {
            let apart: f32 = a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum();
            assert!(apart.sqrt() < 0.02, "{apart}");
        }
    }

    #[test]
    fn a_plane_fills_the_middle_row_in_proportion_to_the_rings_areas() {
        let params = small();
        let image = counts(&plane(), 840, &params);
        for (i, count) in image.iter().enumerate() {
            assert!(i / SIDE == SIDE / 2 || *count < 1e-3, "pixel {i}: {count}");
        }
        // A ring of radius r, one pixel (10 mm) wide, contains 2πr of the points 10 mm apart.
        for column in 3..SIDE - 1 {
            let expected = std::f32::consts::TAU * (column as f32 + 0.5);
            let found = image[SIDE / 2 * SIDE + column];
            assert!(
                (found / expected - 1.0).abs() < 0.2,
                "{column}: {found}, {expected}"
            );
        }
    }

    #[test]
    fn a_sphere_stays_on_its_circle() {
        let radius = 0.15_f32;
        let surface = sphere(Point3::new(0.0, 0.0, 1.0), f64::from(radius), 6000);
        let image = counts(&surface, 2800, &small());
        // α² + (β + ρ)² = ρ² for an outward normal.
        for (i, count) in image.iter().enumerate() {
            let alpha = (i % SIDE) as f32 + 0.5;
            let beta = (i / SIDE) as f32 + 0.5 - SIDE as f32 / 2.0;
            let off = (alpha.powi(2) + (beta + 15.0).powi(2)).sqrt() - 15.0;
            assert!(off.abs() < 1.6 || *count < 1e-3, "pixel {i}: {count}");
        }
        assert!(image.iter().sum::<f32>() > 500.0);
    }

    #[test]
    fn lonely_points_and_points_among_strangers_are_left_out() {
        let params = small();
        let points: Vec<_> = (0..30).map(|i| Point3::new(i as f32, 0.0, 1.0)).collect();
        let apart = surface_of(points, vec![-Vector3::z(); 30]);
        assert!(describe_spin_images(&apart, &[0, 3, 29], &params).is_empty());
        let mut turned = plane();
        turned.normals[840] = Vector3::x();
        assert!(describe_spin_images(&turned, &[840], &params).is_empty());
        let one_place = surface_of(vec![Point3::origin(); 30], vec![Vector3::z(); 30]);
        assert!(describe_spin_images(&one_place, &[0], &params).is_empty());
    }
}
