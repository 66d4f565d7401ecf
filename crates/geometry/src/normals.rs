//! Surface normals of a cloud, from the plane through each point's neighbours.
//!
//! The normal is the direction of least variance among the points within a radius (H. Hoppe, T. `DeRose`, T. Duchamp,
//! J. McDonald and W. Stuetzle, "Surface reconstruction from unorganized points", SIGGRAPH 1992). Its sign is
//! arbitrary; a depth camera saw every point from one place, so the normal is turned towards that place.
//!
//! Known limits: across an edge that is sharp compared to the radius, the normals are those of a rounded edge.

use nalgebra::{Point3, Vector3};

use super::{cloud::is_finite, nearest::KdTree, principal::principal_axes};
use crate::units::Metres;

/// Ratio of the standard deviations along the second and first axes below which neighbours count as a line.
const LINE_MAX_RATIO: f64 = 1e-3;

/// Returns a unit normal per point, turned towards `viewpoint`; `tree` holds the same points.
///
/// A point has no plane if it has fewer than three neighbours within the radius, itself included, or if they lie on a
/// line; its normal then points to the viewpoint. A point that is not finite has a NaN normal.
pub fn estimate_normals(
    points: &[Point3<f32>],
    tree: &KdTree,
    radius: Metres,
    viewpoint: &Point3<f64>,
) -> Vec<Vector3<f32>> {
    let mut neighbours: Vec<Point3<f64>> = Vec::new();
    let mut normal_at = |p: &Point3<f32>| {
        if !is_finite(p) {
            return Vector3::repeat(f32::NAN);
        }
        neighbours.clear();
        tree.within(p, radius.0 as f32, |n| {
            neighbours.push(points[n.index].cast());
        });
        let to_viewpoint = (viewpoint - p.cast::<f64>())
            .try_normalize(f64::MIN_POSITIVE)
            .unwrap_or_else(|| -Vector3::z());
        let normal = plane_normal(&neighbours).unwrap_or(to_viewpoint);
        let towards = if normal.dot(&to_viewpoint) < 0.0 {
            -normal
        } else {
            normal
        };
        towards.cast()
    };
    points.iter().map(&mut normal_at).collect()
}

fn plane_normal(neighbours: &[Point3<f64>]) -> Option<Vector3<f64>> {
    let principal = principal_axes(neighbours.iter().map(|p| (*p, 1.0)))?;
    let [first, second, _] = principal.variances;
    let is_plane = second > first * LINE_MAX_RATIO * LINE_MAX_RATIO && second > 0.0;
    is_plane.then(|| principal.axes.column(2).into_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn normals_of(
        points: &[Point3<f32>],
        radius: f64,
        viewpoint: Point3<f64>,
    ) -> Vec<Vector3<f32>> {
        estimate_normals(points, &KdTree::new(points), Metres(radius), &viewpoint)
    }

    #[test]
    fn a_tilted_plane_has_its_own_normal_on_the_side_of_the_viewpoint() {
        let expected = Vector3::new(0.3, -0.2, -1.0).normalize();
        let points: Vec<Point3<f32>> = (0..900)
            .map(|i| (f64::from(i % 30) * 0.01, f64::from(i / 30) * 0.01))
            .map(|(x, y)| Point3::new(x, y, 1.2 + 0.3 * x - 0.2 * y).cast())
            .collect();
        for normal in normals_of(&points, 0.03, Point3::origin()) {
            assert!((normal.cast::<f64>() - expected).norm() < 1e-4);
        }
        let behind = Point3::new(0.0, 0.0, 10.0);
        assert!((normals_of(&points, 0.03, behind)[0].cast::<f64>() + expected).norm() < 1e-4);
    }

    #[test]
    fn the_near_half_of_a_sphere_has_radial_normals() {
        let centre = Point3::new(0.1, 0.0, 2.0);
        // A Fibonacci spiral samples the sphere evenly.
        let points: Vec<Point3<f32>> = (0..4000)
            .map(|i| {
                let z = -1.0 + (f64::from(i) + 0.5) / 4000.0;
                let turn = f64::from(i) * std::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
                let r = (1.0 - z * z).sqrt();
                (centre + Vector3::new(r * turn.cos(), r * turn.sin(), z) * 0.5).cast()
            })
            .filter(|p: &Point3<f32>| f64::from(p.z) < 1.75)
            .collect();
        for (p, normal) in points
            .iter()
            .zip(normals_of(&points, 0.05, Point3::origin()))
        {
            let radial = (p.cast::<f64>() - centre).normalize();
            // At the rim, neighbours lie on one side only: a radius of 0.05 on a sphere of 0.5 tilts the normal by
            // at most 3 degrees.
            assert!(normal.cast::<f64>().dot(&radial) > 0.998, "{normal} at {p}");
        }
    }

    #[test]
    fn lone_points_and_lines_look_at_the_viewpoint() {
        let line: Vec<Point3<f32>> = (0..20)
            .map(|i| Point3::new(i as f32 * 0.01, 0.0, 1.0))
            .collect();
        let lone = [Point3::new(0.0_f32, 0.0, 2.0); 1];
        let same = [Point3::new(0.0_f32, 1.0, 0.0); 5];
        for points in [&line[..], &lone, &same] {
            for (p, normal) in points
                .iter()
                .zip(normals_of(points, 0.05, Point3::origin()))
            {
                assert!((normal + p.coords.normalize()).norm() < 1e-5);
            }
        }
    }

    #[test]
    fn only_what_is_no_point_has_no_normal() {
        let points = [Point3::new(f32::NAN, 0.0, 0.0), Point3::origin()];
        let normals = normals_of(&points, 0.1, Point3::origin());
        assert!(normals[0].x.is_nan());
        assert_eq!(normals[1], -Vector3::z());
        assert!(normals_of(&[], 0.1, Point3::origin()).is_empty());
    }
}
