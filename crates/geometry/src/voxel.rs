//! Thins a cloud to one point per cube of space: the mean of all points in it.
//!
//! Points are sorted by the number of their cube, so the result depends only on the points: the same cloud gives
//! the same bytes on every run.

use std::collections::BTreeMap;

use nalgebra::{Point3, Vector3};

use super::cloud::PointCloud;
use crate::units::Metres;

/// Bits of a cube's number along one axis; three of them fit into a `u64`.
const BITS_PER_AXIS: u32 = 21;

/// Averages the position, normal and colour of the finite points in every cube with edges of `size`; ordered by cube.
///
/// Labels and the grid are dropped, since they cannot be averaged. `size` must be above zero.
pub fn downsample(cloud: &PointCloud, size: Metres) -> PointCloud {
    assert!(size.0 > 0.0, "a cube has edges longer than zero");
    let Some((low, high)) = cloud.bounds() else {
        return PointCloud::default();
    };
    // At most two million cubes along an axis: a stray point kilometres away enlarges the cubes instead of overflowing.
    let extent = f64::from((high - low).amax());
    let most = f64::from((1_u32 << BITS_PER_AXIS) - 1);
    let per_metre = 1.0 / size.0.max(extent / most);
    let low: Point3<f64> = low.cast();
    let cube_along = |x: f32, low: f64| ((f64::from(x) - low) * per_metre) as u64;
    let mut members: Vec<(u64, u32)> = cloud
        .finite()
        .map(|(i, p)| {
            let [x, y, z] = [
                cube_along(p.x, low.x),
                cube_along(p.y, low.y),
                cube_along(p.z, low.z),
            ];
            let number = (z << (2 * BITS_PER_AXIS)) | (y << BITS_PER_AXIS) | x;
            (number, i as u32)
        })
        .collect();
    members.sort_unstable();

    let cubes = || members.chunk_by(|a, b| a.0 == b.0);
    PointCloud {
        points: cubes()
            .map(|cube| mean_position(&cloud.points, cube))
            .collect(),
        normals: cloud
            .normals
            .as_ref()
            .map(|normals| cubes().map(|cube| mean_normal(normals, cube)).collect()),
        colours: cloud
            .colours
            .as_ref()
            .map(|colours| cubes().map(|cube| mean_colour(colours, cube)).collect()),
        labels: None,
        grid: None,
        is_simulated: cloud.is_simulated,
        surplus_bytes: cloud.surplus_bytes,
    }
}

/// Returns the values of the cubes with these numbers along x, y and z, piece by piece: cubes are of one piece if they are
/// connected by faces, edges or corners.
pub fn connected_pieces<V>(mut cubes: BTreeMap<[i32; 3], V>) -> Vec<Vec<V>> {
    let mut pieces = Vec::new();
    while let Some((first, value)) = cubes.pop_first() {
        let mut piece = vec![value];
        let mut open = vec![first];
        while let Some([x, y, z]) = open.pop() {
            for neighbour in (0..27).map(|n| [x + n / 9 - 1, y + n / 3 % 3 - 1, z + n % 3 - 1]) {
                if let Some(value) = cubes.remove(&neighbour) {
                    piece.push(value);
                    open.push(neighbour);
                }
            }
        }
        pieces.push(piece);
    }
    pieces
}

fn mean_position(points: &[Point3<f32>], cube: &[(u64, u32)]) -> Point3<f32> {
    let sum = cube.iter().fold(Vector3::zeros(), |sum, &(_, i)| {
        sum + points[i as usize].coords.cast::<f64>()
    });
    Point3::from(sum / cube.len() as f64).cast()
}

/// Returns the normalised mean, or the first normal if they cancel out, as on both faces of a thin sheet.
fn mean_normal(normals: &[Vector3<f32>], cube: &[(u64, u32)]) -> Vector3<f32> {
    let sum = cube
        .iter()
        .fold(Vector3::zeros(), |sum: Vector3<f32>, &(_, i)| {
            sum + normals[i as usize]
        });
    let first = normals[cube[0].1 as usize];
    // A mean shorter than 0.1 is the remainder of a cancellation.
    if sum.norm() > 0.1 * cube.len() as f32 {
        sum.normalize()
    } else {
        first
    }
}

fn mean_colour(colours: &[[u8; 3]], cube: &[(u64, u32)]) -> [u8; 3] {
    let n = cube.len() as u32;
    std::array::from_fn(|channel| {
        let sum: u32 = cube
            .iter()
            .map(|&(_, i)| u32::from(colours[i as usize][channel]))
            .sum();
        ((sum + n / 2) / n) as u8
    })
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use proptest::prelude::*;

    use super::*;

    fn cloud_of(points: &[[f32; 3]]) -> PointCloud {
        PointCloud::from_points(points.iter().map(|p| Point3::from(*p)))
    }

    proptest! {
        #[test]
        fn every_cube_has_the_mean_of_its_points(
            points in prop::collection::vec(prop::array::uniform3(-1.0_f32..1.0), 1..300),
            size in 0.05_f64..0.7,
        ) {
            let cloud = cloud_of(&points);
            let (low, _) = cloud.bounds().expect("points");
            let mut cubes: BTreeMap<[u64; 3], Vec<Point3<f64>>> = BTreeMap::new();
            for p in &cloud.points {
                let d: Vector3<f64> = (p.cast::<f64>() - low.cast::<f64>()) * (1.0 / size);
                cubes.entry([d.z as u64, d.y as u64, d.x as u64]).or_default().push(p.cast());
            }
            let thinned = downsample(&cloud, Metres(size));
            prop_assert_eq!(thinned.points.len(), cubes.len());
            for (found, members) in thinned.points.iter().zip(cubes.values()) {
                let sum = members.iter().fold(Vector3::zeros(), |sum, p| sum + p.coords);
                let mean = sum / members.len() as f64;
                prop_assert!((found.coords.cast::<f64>() - mean).norm() < 1e-6);
            }
        }
    }

    #[test]
    fn normals_stay_of_unit_length_and_colours_are_averaged() {
        let mut cloud = cloud_of(&[[0.0; 3], [0.001, 0.0, 0.0], [1.0, 0.0, 0.0]]);
        cloud.normals = Some(vec![Vector3::x(), Vector3::y(), Vector3::z()]);
        cloud.colours = Some(vec![[0, 10, 255], [255, 10, 255], [1, 2, 3]]);
        let thinned = downsample(&cloud, Metres::from_mm(10.0));
        let half = std::f32::consts::FRAC_1_SQRT_2;
        let normals = thinned.normals.expect("kept");
        assert!((normals[0] - Vector3::new(half, half, 0.0)).norm() < 1e-6);
        assert_eq!(normals[1], Vector3::z());
        assert_eq!(thinned.colours, Some(vec![[128, 10, 255], [1, 2, 3]]));
    }

    #[test]
    fn opposite_normals_leave_a_unit_normal() {
        let mut cloud = cloud_of(&[[0.0; 3], [0.0, 0.0, 0.001]]);
        cloud.normals = Some(vec![Vector3::z(), -Vector3::z()]);
        let thinned = downsample(&cloud, Metres::from_mm(10.0));
        assert_eq!(thinned.normals, Some(vec![Vector3::z()]));
    }

    #[test]
    fn no_reading_and_no_point_leave_nothing() {
        let mut cloud = PointCloud::default();
        assert_eq!(downsample(&cloud, Metres(0.1)), PointCloud::default());
        cloud.points = vec![Point3::new(f32::NAN, 0.0, 0.0); 3];
        assert_eq!(downsample(&cloud, Metres(0.1)), PointCloud::default());
    }

    #[test]
    fn a_stray_point_far_away_is_kept_apart() {
        let cloud = cloud_of(&[[0.0; 3], [0.01, 0.0, 0.0], [9e6, 9e6, 9e6]]);
        assert_eq!(downsample(&cloud, Metres::from_mm(1.0)).points.len(), 2);
    }
}
