//! Closed polygons in a plane: area, centroid, length, even resampling, smoothing.
//!
//! A polygon is a list of corners in order; the last is joined to the first, which is not repeated. The area is
//! positive when the corners run counter-clockwise with x to the right and y up.

use nalgebra::{Point2, Vector2};

/// Returns the signed area, square metres (shoelace formula).
pub fn signed_area(corners: &[Point2<f64>]) -> f64 {
    edges(corners)
        .map(|(a, b)| a.x * b.y - b.x * a.y)
        .sum::<f64>()
        / 2.0
}

/// Returns the length of the closed outline, metres.
pub fn perimeter(corners: &[Point2<f64>]) -> f64 {
    edges(corners).map(|(a, b)| (b - a).norm()).sum()
}

/// Returns the mean of the corners (the paper's centre of gravity, eq. 10); `None` without corners.
pub fn mean_corner(corners: &[Point2<f64>]) -> Option<Point2<f64>> {
    if corners.is_empty() {
        return None;
    }
    let sum = corners
        .iter()
        .fold(Point2::origin(), |sum: Point2<f64>, c| sum + c.coords);
    Some(sum / corners.len() as f64)
}

/// Returns `num_samples` equidistant points along the outline, starting at the first corner; `None` if the outline has
/// no length or `num_samples` is 0.
pub fn resample_evenly(corners: &[Point2<f64>], num_samples: usize) -> Option<Vec<Point2<f64>>> {
    let length = perimeter(corners);
    if !(length > 0.0) || num_samples == 0 {
        return None;
    }
    let step = length / num_samples as f64;
    let mut samples = Vec::with_capacity(num_samples);
    let mut walked = 0.0;
    for (a, b) in edges(corners) {
        let edge = (b - a).norm();
        while samples.len() < num_samples {
            let along = samples.len() as f64 * step - walked;
            if along > edge {
                break;
            }
            samples.push(if edge > 0.0 {
                a + (b - a) * (along / edge)
            } else {
                *a
            });
        }
        walked += edge;
    }
    // Rounding may put the last sample just beyond the last edge.
    while samples.len() < num_samples {
        samples.push(corners[corners.len() - 1]);
    }
    Some(samples)
}

/// Replaces each corner by the mean of itself and `reach` neighbours on either side; a polygon too short for that
/// is returned unchanged.
#[must_use]
pub fn smooth(corners: &[Point2<f64>], reach: usize) -> Vec<Point2<f64>> {
    let n = corners.len();
    if n == 0 || reach == 0 || 2 * reach + 1 > n {
        return corners.to_vec();
    }
    // A sliding sum: add the entering corner, subtract the leaving one.
    let width = 2 * reach + 1;
    let around = |first: usize| corners[first..].iter().chain(corners).map(|c| c.coords);
    let mut sum: Vector2<f64> = around(n - reach).take(width).sum();
    around(reach + 1)
        .zip(around(n - reach))
        .take(n)
        .map(|(next, last)| {
            let mean = sum / width as f64;
            sum += next - last;
            mean.into()
        })
        .collect()
}

fn edges(corners: &[Point2<f64>]) -> impl Iterator<Item = (&Point2<f64>, &Point2<f64>)> {
    corners.iter().zip(corners.iter().cycle().skip(1))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rectangle() -> Vec<Point2<f64>> {
        [(0.0, 0.0), (2.0, 0.0), (2.0, 1.0), (0.0, 1.0)]
            .map(|(x, y)| Point2::new(x, y))
            .to_vec()
    }

    #[test]
    fn a_counter_clockwise_rectangle_has_positive_area() {
        assert!((signed_area(&rectangle()) - 2.0).abs() < 1e-12);
        let clockwise: Vec<_> = rectangle().into_iter().rev().collect();
        assert!((signed_area(&clockwise) + 2.0).abs() < 1e-12);
        assert!((perimeter(&rectangle()) - 6.0).abs() < 1e-12);
    }

    #[test]
    fn even_samples_lie_on_the_outline_at_equal_distances() {
        let samples = resample_evenly(&rectangle(), 12).expect("has length");
        assert_eq!(samples.len(), 12);
        for (a, b) in edges(&samples) {
            assert!(((b - a).norm() - 0.5).abs() < 1e-9);
        }
    }

    #[test]
    fn nothing_and_a_single_place_have_no_samples() {
        assert_eq!(resample_evenly(&[], 8), None);
        assert_eq!(resample_evenly(&[Point2::new(1.0, 1.0); 3], 8), None);
    }

    #[test]
    fn smoothing_is_the_mean_over_the_neighbourhood() {
        let corners: Vec<_> = (0..9)
            .map(|i| Point2::new(f64::from(i * i % 7), f64::from(i)))
            .collect();
        let fast = smooth(&corners, 2);
        for (i, found) in fast.iter().enumerate() {
            let slow = (0..5)
                .map(|k| corners[(i + 9 + k - 2) % 9].coords)
                .sum::<nalgebra::Vector2<f64>>()
                / 5.0;
            assert!((found.coords - slow).norm() < 1e-12);
        }
    }
}
