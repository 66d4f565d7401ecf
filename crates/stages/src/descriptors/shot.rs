//! Signatures of histograms of orientations: the normals around a keypoint, by sector of a sphere.
//!
//! F. Tombari, S. Salti and L. Di Stefano, "Unique signatures of histograms for local surface description", ECCV 2010;
//! S. Salti, F. Tombari and L. Di Stefano, "SHOT: Unique signatures of histograms for surface and texture description",
//! Computer Vision and Image Understanding 125, 2014. The keypoint gets a repeatable frame: the principal axes of its
//! neighbours relative to the keypoint, weighted by R - d, with signs such that most neighbours lie on the positive
//! side. The sphere is divided into 8 azimuths × 2 elevations × 2 shells, each with a histogram of 11 bins of the
//! cosine between a neighbour's normal and the z axis. A neighbour is distributed over the adjacent bins of all four
//! (quadrilinear), and the row has length one.
//!
//! Our deviations: a neighbour beyond the middle of the outermost shell, elevation or cosine bin counts fully for that bin
//! instead of being dropped in part. Turning z to the side that the camera saw, instead of to where most neighbours are, made
//! no difference at our radius; at 120 mm, where noise decides on a smooth sheet, it was right 45 times instead of 42 of 48.

use std::f32::consts::PI;

use nalgebra::{Matrix3, Point3, SymmetricEigen, Vector3};

use super::{Descriptors, normalise, surface::DescribedSurface};
use geometry::units::Metres;

/// Sectors around the z axis.
const NUM_AZIMUTHS: usize = 8;
/// Halves above and below the tangent plane.
const NUM_ELEVATIONS: usize = 2;
/// Shells from the inside out, of equal thickness.
const NUM_SHELLS: usize = 2;
/// Bins of the cosine.
const NUM_COSINES: usize = 11;
/// Numbers per row.
const WIDTH: usize = NUM_AZIMUTHS * NUM_ELEVATIONS * NUM_SHELLS * NUM_COSINES;
/// Minimum number of neighbours; with fewer the axes are random.
const MIN_NEIGHBOURS: usize = 5;

/// Parameters of [`describe_shot`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShotParams {
    /// Radius of the neighbourhood, 30..300 mm. Time grows with its square; a larger radius is more distinctive and
    /// more sensitive to occlusion.
    pub radius: Metres,
}

impl Default for ShotParams {
    fn default() -> Self {
        Self {
            radius: Metres::from_mm(300.0),
        }
    }
}

/// A neighbour of the keypoint being described.
#[derive(Clone, Copy)]
struct NeighbourInFrame {
    /// Vector from the keypoint, metres.
    offset: Vector3<f32>,
    /// Length of `offset`, above zero.
    distance: f32,
    normal: Vector3<f32>,
}

/// Computes the rows of the given points (indices into the surface, ascending); a point with too few neighbours gets none.
pub fn describe_shot(
    surface: &DescribedSurface,
    keypoints: &[u32],
    params: &ShotParams,
) -> Descriptors {
    let radius = params.radius.0 as f32;
    let mut described = Descriptors {
        width: WIDTH,
        ..Descriptors::default()
    };
    let mut around: Vec<NeighbourInFrame> = Vec::new();
    for &keypoint in keypoints {
        let here = &surface.points[keypoint as usize];
        gather(surface, here, radius, &mut around);
        if around.len() < MIN_NEIGHBOURS {
            continue;
        }
        let frame = local_frame(&around, radius);
        let start = described.values.len();
        described.values.resize(start + WIDTH, 0.0);
        let row = &mut described.values[start..];
        count(&around, &frame, radius, row);
        normalise(row);
        described.keypoints.push(keypoint);
    }
    described
}

fn gather(
    surface: &DescribedSurface,
    here: &Point3<f32>,
    radius: f32,
    around: &mut Vec<NeighbourInFrame>,
) {
    around.clear();
    surface.tree.within(here, radius, |neighbour| {
        if neighbour.distance_sq > 0.0 {
            around.push(NeighbourInFrame {
                offset: surface.points[neighbour.index] - here,
                distance: neighbour.distance_sq.sqrt(),
                normal: surface.normals[neighbour.index],
            });
        }
    });
}

/// Returns the keypoint's axes x, y, z: of largest, middle and smallest spread, right-handed.
fn local_frame(around: &[NeighbourInFrame], radius: f32) -> [Vector3<f32>; 3] {
    // The factor 1/Σ(R - d) of the weighted covariance does not change the axes.
    let spread: Matrix3<f64> = around.iter().fold(Matrix3::zeros(), |sum, a| {
        let offset: Vector3<f64> = a.offset.cast();
        sum + offset * offset.transpose() * f64::from(radius - a.distance)
    });
    let eigen = SymmetricEigen::new(spread);
    let axis = |column: usize| eigen.eigenvectors.column(column).into_owned().cast::<f32>();
    let (most, least) = (eigen.eigenvalues.imax(), eigen.eigenvalues.imin());
    let x = sign_by_majority(axis(most), around);
    // If all spreads are equal, both would be the same column.
    let least = if least == most { (most + 1) % 3 } else { least };
    let z = sign_by_majority(axis(least), around);
    [x, z.cross(&x), z]
}

/// Number of neighbours around the median distance that decide when both sides hold equally many; odd, to avoid a tie.
const NUM_DECIDING: usize = 5;

/// Returns the axis with the sign that puts most neighbours on its positive side.
fn sign_by_majority(axis: Vector3<f32>, around: &[NeighbourInFrame]) -> Vector3<f32> {
    let num_ahead =
        |some: &[&NeighbourInFrame]| some.iter().filter(|a| a.offset.dot(&axis) >= 0.0).count();
    let all: Vec<&NeighbourInFrame> = around.iter().collect();
    let ahead = 2 * num_ahead(&all);
    let is_forward = if ahead == all.len() {
        let mut sorted = all;
        sorted.sort_by(|a, b| a.distance.total_cmp(&b.distance));
        let start = (sorted.len() / 2).saturating_sub(NUM_DECIDING / 2);
        let end = (start + NUM_DECIDING).min(sorted.len());
        2 * num_ahead(&sorted[start..end]) >= end - start
    } else {
        ahead > all.len()
    };
    if is_forward { axis } else { -axis }
}

/// Distributes every neighbour over the adjacent bins.
fn count(around: &[NeighbourInFrame], frame: &[Vector3<f32>; 3], radius: f32, row: &mut [f32]) {
    let [x_axis, y_axis, z_axis] = frame;
    for a in around {
        let [x, y, z] = [x_axis, y_axis, z_axis].map(|axis| axis.dot(&a.offset));
        let turns = y.atan2(x) / (2.0 * PI) + 1.0;
        let azimuths = bins_around(turns * NUM_AZIMUTHS as f32, NUM_AZIMUTHS);
        let inclination = (z / a.distance).clamp(-1.0, 1.0).acos() / PI;
        let elevations = bins_beside(inclination * NUM_ELEVATIONS as f32, NUM_ELEVATIONS);
        let shells = bins_beside(a.distance / radius * NUM_SHELLS as f32, NUM_SHELLS);
        let cosines = bins_beside(
            (z_axis.dot(&a.normal) + 1.0) * 0.5 * NUM_COSINES as f32,
            NUM_COSINES,
        );
        for (azimuth, share) in azimuths {
            for (elevation, by_elevation) in elevations {
                let (at, share) = (azimuth * NUM_ELEVATIONS + elevation, share * by_elevation);
                for (shell, by_shell) in shells {
                    let (at, share) = ((at * NUM_SHELLS + shell) * NUM_COSINES, share * by_shell);
                    for (cosine, by_cosine) in cosines {
                        row[at + cosine] += share * by_cosine;
                    }
                }
            }
        }
    }
}

/// Returns the two bins whose centres a position lies between, each with its share; the shares sum to one. Bin i covers
/// i to i + 1; positions before the first centre or after the last count fully for that bin.
fn bins_beside(position: f32, num: usize) -> [(usize, f32); 2] {
    let x = (position - 0.5).clamp(0.0, (num - 1) as f32);
    let low = x as usize;
    let share = x - low as f32;
    [(low, 1.0 - share), ((low + 1).min(num - 1), share)]
}

/// Like [`bins_beside`], but cyclic; `position` must be at least 0.5.
fn bins_around(position: f32, num: usize) -> [(usize, f32); 2] {
    let x = position - 0.5;
    let low = x as usize;
    let share = x - low as f32;
    [(low % num, 1.0 - share), ((low + 1) % num, share)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::descriptors::surface::{
        keypoints,
        tests::{bent_surface, moved, plane, sphere, surface_of, test_motion},
    };

    fn around_of(offsets: &[[f32; 3]]) -> Vec<NeighbourInFrame> {
        offsets
            .iter()
            .map(|o| Vector3::from(*o))
            .map(|offset| NeighbourInFrame {
                offset,
                distance: offset.norm(),
                normal: Vector3::z(),
            })
            .collect()
    }

    /// Every neighbour against every bin: a triangular weight in each of the four directions, one bin wide on either side.
    fn slow_row(around: &[NeighbourInFrame], frame: &[Vector3<f32>; 3], radius: f64) -> Vec<f64> {
        let tent = |position: f64, bin: usize, num: usize| {
            let position = position.clamp(0.5, num as f64 - 0.5);
            (1.0 - (position - (bin as f64 + 0.5)).abs()).max(0.0)
        };
        let tent_around = |position: f64, bin: usize, num: f64| {
            let apart = (position - (bin as f64 + 0.5)).rem_euclid(num);
            (1.0 - apart.min(num - apart)).max(0.0)
        };
        let mut row = vec![0.0; WIDTH];
        for a in around {
            let offset = a.offset.cast::<f64>();
            let [x, y, z] = [0, 1, 2].map(|i| frame[i].cast::<f64>().dot(&offset));
            let d = offset.norm();
            let azimuth = y.atan2(x) / std::f64::consts::TAU * 8.0;
            let elevation = (z / d).acos() / std::f64::consts::PI * 2.0;
            let cosine = frame[2].cast::<f64>().dot(&a.normal.cast());
            for (i, sum) in row.iter_mut().enumerate() {
                *sum += tent_around(azimuth, i / 44, 8.0)
                    * tent(elevation, i / 22 % 2, 2)
                    * tent(d / radius * 2.0, i / 11 % 2, 2)
                    * tent(cosine.midpoint(1.0) * 11.0, i % 11, 11);
            }
        }
        let length = row.iter().map(|x| x * x).sum::<f64>().sqrt();
        row.iter().map(|x| x / length).collect()
    }

    #[test]
    fn rows_agree_with_a_tent_over_every_bin() {
        let surface = bent_surface();
        let chosen = keypoints(&surface, Metres(0.06));
        let params = ShotParams {
            radius: Metres(0.08),
        };
        let found = describe_shot(&surface, &chosen, &params);
        assert_eq!(found.keypoints, chosen);
        let mut around = Vec::new();
        for (row, &keypoint) in found.rows().zip(&chosen) {
            gather(
                &surface,
                &surface.points[keypoint as usize],
                0.08,
                &mut around,
            );
            let frame = local_frame(&around, 0.08);
            for (fast, slow) in row.iter().zip(slow_row(&around, &frame, 0.08)) {
                assert!((f64::from(*fast) - slow).abs() < 1e-4);
            }
        }
    }

    #[test]
    fn moving_camera_and_part_together_changes_next_to_nothing() {
        let surface = bent_surface();
        let chosen = keypoints(&surface, Metres(0.06));
        let before = describe_shot(&surface, &chosen, &ShotParams::default());
        let after = describe_shot(
            &moved(&surface, &test_motion()),
            &chosen,
            &ShotParams::default(),
        );
        for (a, b) in before.rows().zip(after.rows()) {
            let apart: f32 = a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum();
            assert!(apart.sqrt() < 0.01, "{apart}");
        }
    }

    #[test]
    fn the_frame_is_right_handed_and_looks_to_where_most_neighbours_are() {
        // Long in x with more points on its negative side, wide in y, and one point above the plane of the others.
        let around = around_of(&[
            [-0.9, 0.1, 0.0],
            [-0.8, -0.3, 0.0],
            [-0.7, 0.3, -0.01],
            [-0.5, -0.2, 0.0],
            [0.8, 0.2, -0.01],
            [0.6, -0.3, -0.01],
        ]);
        let [x, y, z] = local_frame(&around, 1.0);
        assert!(x.x < -0.9, "{x}");
        assert!((x.cross(&y) - z).norm() < 1e-5);
        assert!(x.dot(&y).abs() + y.dot(&z).abs() + z.dot(&x).abs() < 1e-5);
        // Four of the six lie in the plane or above it.
        assert!(z.z.abs() > 0.9);
        // The mirrored neighbourhood has the mirrored axis: the sign depends on the points, not on the solver.
        let mirrored: Vec<NeighbourInFrame> = around
            .iter()
            .map(|a| NeighbourInFrame {
                offset: -a.offset,
                ..*a
            })
            .collect();
        let [opposite, _, below] = local_frame(&mirrored, 1.0);
        assert!((opposite + x).norm() < 1e-5 && (below + z).norm() < 1e-5);
    }

    #[test]
    fn equally_many_on_both_sides_are_decided_by_those_at_the_median_distance() {
        // Three on either side; the middle distances (all but the outermost) have more on the negative side.
        let around = around_of(&[
            [0.1, 0.0, 0.0],
            [-0.2, 0.0, 0.0],
            [-0.3, 0.0, 0.0],
            [0.4, 0.0, 0.0],
            [-0.5, 0.0, 0.0],
            [0.6, 0.0, 0.0],
        ]);
        for axis in [Vector3::x(), -Vector3::x()] {
            let chosen = sign_by_majority(axis, &around);
            // Sorted by distance, the five around the median are -0.2, -0.3, 0.4, -0.5, 0.6.
            assert!(chosen.x < 0.0);
        }
    }

    #[test]
    fn a_plane_fills_only_the_bin_of_parallel_normals() {
        let params = ShotParams {
            radius: Metres(0.12),
        };
        let found = describe_shot(&plane(), &[840], &params);
        // Neither side of a plane holds more points, so z may have either sign.
        let cosine = if found.values.iter().step_by(11).any(|x| *x > 0.0) {
            0
        } else {
            10
        };
        for (i, value) in found.values.iter().enumerate() {
            assert!(i % 11 == cosine || value.abs() < 1e-6);
        }
        // Half of each neighbour counts for either elevation: the tangent plane is the border between them.
        for outer in (0..352).step_by(44).map(|i| i + 11 + cosine) {
            let (above, below) = (found.values[outer], found.values[outer + 22]);
            assert!(above > 0.1 && (above - below).abs() < 1e-4);
        }
    }

    #[test]
    fn a_sphere_rises_towards_its_own_z() {
        let surface = sphere(Point3::new(0.0, 0.0, 1.0), 0.1, 2000);
        let params = ShotParams {
            radius: Metres(0.1),
        };
        let found = describe_shot(&surface, &[1000], &params);
        let row = found.rows().next().expect("described");
        // All neighbours lie on the inner side of the tangent plane: z points inwards, against the normals, whose
        // cosines are -1..-1/2.
        for (i, value) in row.iter().enumerate() {
            assert!(i % 11 <= 3 || *value < 1e-6, "bin {i}");
        }
        let sum = |elevation: usize| -> f32 {
            let all = row.iter().enumerate();
            let picked = all.filter(|(i, _)| i / 22 % 2 == elevation);
            picked.map(|(_, x)| x).sum()
        };
        assert!(sum(0) > 1.3 * sum(1));
    }

    #[test]
    fn lonely_points_are_left_out_and_one_line_of_them_still_has_finite_rows() {
        let points: Vec<_> = (0..30).map(|i| Point3::new(i as f32, 0.0, 1.0)).collect();
        let apart = surface_of(points, vec![-Vector3::z(); 30]);
        assert!(describe_shot(&apart, &[0, 3, 29], &ShotParams::default()).is_empty());
        let line: Vec<_> = (0..30)
            .map(|i| Point3::new(0.01 * i as f32, 0.0, 1.0))
            .collect();
        let line = surface_of(line, vec![-Vector3::z(); 30]);
        let found = describe_shot(&line, &[15], &ShotParams::default());
        assert_eq!(found.len(), 1);
        assert!(found.values.iter().all(|x| x.is_finite()));
        let one_place = surface_of(vec![Point3::origin(); 30], vec![Vector3::z(); 30]);
        assert!(describe_shot(&one_place, &[0], &ShotParams::default()).is_empty());
    }
}
