//! Fast point feature histograms: relative orientations of the normals around a keypoint.
//!
//! R. B. Rusu, N. Blodow and M. Beetz, "Fast Point Feature Histograms (FPFH) for 3D registration", ICRA 2009. Each
//! point p gets a *simplified* histogram SPFH(p) of the three angles between it and each neighbour, 11 bins per angle;
//! the keypoint's row is its own plus the mean of its neighbours', each divided by its distance ω:
//! `FPFH(p) = SPFH(p) + 1/k Σ SPFH(p_k)/ω_k`.
//!
//! The square roots of the shares are stored, so that the Euclidean distance of two rows is the Hellinger distance of
//! the histograms (R. Arandjelović and A. Zisserman, "Three things everyone should know to improve object retrieval",
//! CVPR 2012); this recognised more parts.
//!
//! Our choices where the paper leaves room: ω is in radii, so that the row does not depend on the unit of length; the
//! 11 bins of each angle sum to one; the source of a pair is the point whose normal is more aligned with the line to
//! the other, so a pair has the same angles from both ends and is evaluated once.

use super::{
    Descriptors,
    pair::{bin, pair_angles},
    surface::DescribedSurface,
};
use geometry::units::Metres;

/// Bins per angle.
const NUM_BINS: usize = 11;
/// Numbers per row.
const WIDTH: usize = 3 * NUM_BINS;
/// Minimum number of neighbours for a description.
const MIN_NEIGHBOURS: u32 = 5;

/// Parameters of [`describe_fpfh`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FpfhParams {
    /// Radius of the neighbourhood, 30..200 mm; the description covers twice that. Time grows with its square.
    pub radius: Metres,
}

impl Default for FpfhParams {
    fn default() -> Self {
        Self {
            radius: Metres::from_mm(140.0),
        }
    }
}

/// The pair histogram of one point.
#[derive(Clone, Copy)]
struct Simplified {
    counts: [u32; WIDTH],
    num_pairs: u32,
}

/// Computes the rows of the given points (indices into the surface, ascending); a point with too few neighbours gets none.
pub fn describe_fpfh(
    surface: &DescribedSurface,
    keypoints: &[u32],
    params: &FpfhParams,
) -> Descriptors {
    let radius = params.radius.0 as f32;
    let simplified = simplified_histograms(surface, radius);
    let mut described = Descriptors {
        width: WIDTH,
        ..Descriptors::default()
    };
    for &keypoint in keypoints {
        if let Some(row) = row_at(surface, &simplified, keypoint as usize, radius) {
            described.keypoints.push(keypoint);
            described.values.extend_from_slice(&row);
        }
    }
    described
}

/// Computes SPFH of every point; each pair is counted at both ends.
fn simplified_histograms(surface: &DescribedSurface, radius: f32) -> Vec<Simplified> {
    let empty = Simplified {
        counts: [0; WIDTH],
        num_pairs: 0,
    };
    let mut all = vec![empty; surface.points.len()];
    for (i, p) in surface.points.iter().enumerate() {
        surface.tree.within(p, radius, |neighbour| {
            let j = neighbour.index;
            if j <= i {
                return;
            }
            if let Some(bins) = pair_bins(surface, i, j) {
                for end in [i, j] {
                    all[end].num_pairs += 1;
                    for bin in bins {
                        all[end].counts[bin] += 1;
                    }
                }
            }
        });
    }
    all
}

/// Returns the bins of a pair, the same for (i, j) and (j, i).
fn pair_bins(surface: &DescribedSurface, i: usize, j: usize) -> Option<[usize; 3]> {
    let end = |i: usize| (&surface.points[i], &surface.normals[i]);
    let line = surface.points[j] - surface.points[i];
    let i_looks_along = surface.normals[i].dot(&line) >= -surface.normals[j].dot(&line);
    let angles = if i_looks_along {
        pair_angles(end(i), end(j))
    } else {
        pair_angles(end(j), end(i))
    }?;
    Some([
        bin(angles.alpha, 1.0, NUM_BINS),
        NUM_BINS + bin(angles.phi, 1.0, NUM_BINS),
        2 * NUM_BINS + bin(angles.theta, std::f32::consts::PI, NUM_BINS),
    ])
}

fn row_at(
    surface: &DescribedSurface,
    simplified: &[Simplified],
    keypoint: usize,
    radius: f32,
) -> Option<[f32; WIDTH]> {
    let own = &simplified[keypoint];
    if own.num_pairs < MIN_NEIGHBOURS {
        return None;
    }
    let mut around = [0.0; WIDTH];
    let mut num_around = 0;
    let here = &surface.points[keypoint];
    surface.tree.within(here, radius, |neighbour| {
        let other = &simplified[neighbour.index];
        if neighbour.distance_sq > 0.0 && other.num_pairs > 0 {
            num_around += 1;
            let weight = radius / neighbour.distance_sq.sqrt() / other.num_pairs as f32;
            for (sum, &count) in around.iter_mut().zip(&other.counts) {
                *sum += weight * count as f32;
            }
        }
    });
    let share = 1.0 / num_around.max(1) as f32;
    let mut row: [f32; WIDTH] = std::array::from_fn(|bin| {
        own.counts[bin] as f32 / own.num_pairs as f32 + share * around[bin]
    });
    for angle in row.chunks_exact_mut(NUM_BINS) {
        let sum: f32 = angle.iter().sum();
        for bin in angle {
            *bin = (*bin / sum).sqrt();
        }
    }
    Some(row)
}

#[cfg(test)]
mod tests {
    use nalgebra::{Point3, Vector3};

    use super::*;
    use crate::descriptors::surface::{
        keypoints,
        tests::{bent_surface, moved, plane, sphere, surface_of, test_motion},
    };

    /// The formulas as written, pair by pair.
    fn slow_row(surface: &DescribedSurface, keypoint: usize, radius: f64) -> Vec<f64> {
        let n = surface.points.len();
        let point = |i: usize| surface.points[i].cast::<f64>();
        let normal = |i: usize| surface.normals[i].cast::<f64>();
        let near =
            |i: usize| (0..n).filter(move |&j| j != i && (point(j) - point(i)).norm() <= radius);
        let spfh = |i: usize| {
            let mut bins = vec![0.0; 33];
            let mut num = 0.0;
            for j in near(i) {
                let angle_at = |a: usize, b: usize| {
                    let line = (point(b) - point(a)).normalize();
                    normal(a).dot(&line).clamp(-1.0, 1.0).acos()
                };
                let (s, t) = if angle_at(i, j) <= angle_at(j, i) {
                    (i, j)
                } else {
                    (j, i)
                };
                let d = (point(t) - point(s)).normalize();
                let u = normal(s);
                let v = d.cross(&u).normalize();
                let w = u.cross(&v);
                let theta = w.dot(&normal(t)).atan2(u.dot(&normal(t))) / std::f64::consts::PI;
                for (k, x) in [v.dot(&normal(t)), u.dot(&d), theta].iter().enumerate() {
                    bins[11 * k + ((x.midpoint(1.0) * 11.0) as usize).min(10)] += 1.0;
                }
                num += 1.0;
            }
            for bin in &mut bins {
                *bin /= num;
            }
            bins
        };
        let mut row = spfh(keypoint);
        let num = near(keypoint).count() as f64;
        for k in near(keypoint) {
            let omega = (point(k) - point(keypoint)).norm() / radius;
            for (sum, x) in row.iter_mut().zip(spfh(k)) {
                *sum += x / omega / num;
            }
        }
        for angle in row.chunks_mut(11) {
            let sum: f64 = angle.iter().sum();
            for bin in angle {
                *bin = (*bin / sum).sqrt();
            }
        }
        row
    }

    #[test]
    fn rows_agree_with_the_formulas_pair_by_pair() {
        let surface = bent_surface();
        let chosen: Vec<u32> = keypoints(&surface, Metres(0.05))
            .into_iter()
            .step_by(9)
            .collect();
        let params = FpfhParams {
            radius: Metres(0.035),
        };
        let found = describe_fpfh(&surface, &chosen, &params);
        assert_eq!(found.keypoints, chosen);
        for (row, &keypoint) in found.rows().zip(&chosen) {
            let slow = slow_row(&surface, keypoint as usize, 0.035);
            let apart: f64 = row
                .iter()
                .zip(slow)
                .map(|(a, b)| (f64::from(*a) - b).abs())
                .sum();
            // A few pairs lie on the border of two bins and fall on either side due to rounding.
            assert!(apart < 0.02, "{apart} at {keypoint}");
        }
    }

    #[test]
    fn moving_camera_and_part_together_changes_next_to_nothing() {
        let surface = bent_surface();
        let chosen = keypoints(&surface, Metres(0.06));
        let before = describe_fpfh(&surface, &chosen, &FpfhParams::default());
        let after = describe_fpfh(
            &moved(&surface, &test_motion()),
            &chosen,
            &FpfhParams::default(),
        );
        assert_eq!(before.keypoints, after.keypoints);
        for (a, b) in before.rows().zip(after.rows()) {
            let apart: f32 = a.iter().zip(b).map(|(a, b)| (a - b).abs()).sum();
            assert!(apart < 0.02, "{apart}");
        }
    }

    #[test]
    fn a_plane_fills_the_middle_bin_of_each_angle() {
        let found = describe_fpfh(&plane(), &[840], &FpfhParams::default());
        for (bin, value) in found.values.iter().enumerate() {
            let expected = if bin % 11 == 5 { 1.0 } else { 0.0 };
            assert!((value - expected).abs() < 1e-6, "bin {bin}: {value}");
        }
    }

    #[test]
    fn a_sphere_shows_its_radius_in_the_bins_of_its_angles() {
        // Neighbours up to 0.1 on a radius of 0.1: normals turn by up to 60°, θ/π in 0..1/3 is bins 5 to 7, and
        // φ = -d/2ρ in -1/2..0 is bins 2 to 5.
        let surface = sphere(Point3::new(0.0, 0.0, 1.0), 0.1, 2000);
        let params = FpfhParams {
            radius: Metres(0.1),
        };
        let found = describe_fpfh(&surface, &[1000], &params);
        let row = found.rows().next().expect("described");
        assert!((row[5] - 1.0).abs() < 1e-6);
        let share = |bins: &[f32]| bins.iter().map(|root| root * root).sum::<f32>();
        assert!((share(&row[11 + 2..=11 + 5]) - 1.0).abs() < 1e-5);
        assert!((share(&row[22 + 5..=22 + 7]) - 1.0).abs() < 1e-5);
        assert!(row[11 + 3] > 0.4 && row[22 + 6] > 0.4);
    }

    #[test]
    fn lonely_points_are_left_out() {
        let points: Vec<_> = (0..30).map(|i| Point3::new(i as f32, 0.0, 1.0)).collect();
        let apart = surface_of(points, vec![-Vector3::z(); 30]);
        assert!(describe_fpfh(&apart, &[0, 3, 29], &FpfhParams::default()).is_empty());
        let one_place = surface_of(vec![Point3::origin(); 30], vec![Vector3::z(); 30]);
        assert!(describe_fpfh(&one_place, &[0, 3], &FpfhParams::default()).is_empty());
    }
}
