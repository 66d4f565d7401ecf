//! The viewpoint feature histogram: one row for everything that a camera sees of a part.
//!
//! R. B. Rusu, G. Bradski, R. Thibaux and J. Hsu, "Fast 3D recognition and pose using the viewpoint feature histogram",
//! IROS 2010, in the layout of the authors' Point Cloud Library: the three pair angles between the centroid with the
//! mean normal and every point (45 bins each), the distances from the centroid (45 bins), and the cosine between every
//! normal and the direction from the centroid to the camera (128 bins). Rows are compared by χ².
//!
//! Deviations: distances are in metres, because car parts have a fixed size and size is evidence; each of the five
//! histograms sums to one.
//!
//! A global histogram depends on the visible surface. So a reference is described once per virtual view, using only the
//! points visible to that camera, and the row nearest to the scene's represents the reference. Rotating the camera
//! about its axis does not change a row.

use nalgebra::{Point3, Vector3};

use super::{
    pair::{bin, pair_angles},
    surface::{DescribedSurface, MIN_POINTS, SurfaceError, SurfaceParams, prepare_surface},
};
use crate::reference::{Coverage, seen_around};
use geometry::cloud::PointCloud;

/// Number of bins of each of the three angles, and of the distance.
const NUM_SHAPE_BINS: usize = 45;
/// Number of bins of the cosine to the viewing direction.
const NUM_VIEW_BINS: usize = 128;
/// Numbers per row.
const WIDTH: usize = 4 * NUM_SHAPE_BINS + NUM_VIEW_BINS;
/// Upper limit of the last distance bin, metres: half a long bumper.
const MAX_DISTANCE_M: f32 = 1.0;

/// The histogram of a part as seen by a camera, as one row.
#[derive(Clone, Debug, PartialEq)]
pub struct ViewHistogram {
    /// The bins of α, φ, θ, the distance and the view, in this order. Each of the five histograms sums to one.
    pub row: Vec<f32>,
}

/// Computes the row of a surface as seen from `viewpoint`.
pub fn describe_vfh(surface: &DescribedSurface, viewpoint: &Point3<f64>) -> ViewHistogram {
    let mut row = vec![0.0; WIDTH];
    let num = surface.points.len();
    let sum = |all: &mut dyn Iterator<Item = Vector3<f32>>| -> Vector3<f64> {
        all.fold(Vector3::zeros(), |sum, v| sum + v.cast::<f64>())
    };
    let centroid: Point3<f64> =
        Point3::from(sum(&mut surface.points.iter().map(|p| p.coords)) / num.max(1) as f64);
    // If the normals cancel there is no mean direction, and any will do.
    let mean_normal = sum(&mut surface.normals.iter().copied())
        .try_normalize(1e-9)
        .unwrap_or_else(Vector3::z)
        .cast();
    let towards_camera: Vector3<f32> = (viewpoint - centroid)
        .try_normalize(1e-9)
        .unwrap_or_else(Vector3::z)
        .cast();
    let centroid = centroid.cast();
    for (point, normal) in surface.points.iter().zip(&surface.normals) {
        if let Some(angles) = pair_angles((&centroid, &mean_normal), (point, normal)) {
            let bins = [
                bin(angles.alpha, 1.0, NUM_SHAPE_BINS),
                bin(angles.phi, 1.0, NUM_SHAPE_BINS),
                bin(angles.theta, std::f32::consts::PI, NUM_SHAPE_BINS),
            ];
            for (angle, bin) in bins.into_iter().enumerate() {
                row[angle * NUM_SHAPE_BINS + bin] += 1.0;
            }
        }
        let share = (point - centroid).norm() / MAX_DISTANCE_M;
        row[3 * NUM_SHAPE_BINS + bin(2.0 * share - 1.0, 1.0, NUM_SHAPE_BINS)] += 1.0;
        let cosine = towards_camera.dot(normal);
        row[4 * NUM_SHAPE_BINS + bin(cosine, 1.0, NUM_VIEW_BINS)] += 1.0;
    }
    let (shape, view) = row.split_at_mut(4 * NUM_SHAPE_BINS);
    for histogram in shape.chunks_exact_mut(NUM_SHAPE_BINS).chain([view]) {
        let sum: f32 = histogram.iter().sum();
        if sum > 0.0 {
            for bin in histogram {
                *bin /= sum;
            }
        }
    }
    ViewHistogram { row }
}

/// Computes the rows of a reference cloud, one per view; a view with too few visible points has none.
pub fn describe_views(
    cloud: &PointCloud,
    coverage: Coverage,
    params: &SurfaceParams,
) -> Result<Vec<ViewHistogram>, SurfaceError> {
    let views = seen_around(cloud, coverage);
    let describe = |(viewpoint, seen): &(Point3<f64>, PointCloud)| {
        prepare_surface(seen, viewpoint, params).map(|surface| describe_vfh(&surface, viewpoint))
    };
    let mut refused = SurfaceError::TooFewPoints {
        found: 0,
        needed: MIN_POINTS,
    };
    let rows: Vec<ViewHistogram> = views
        .iter()
        .filter_map(|view| describe(view).map_err(|error| refused = error).ok())
        .collect();
    if rows.is_empty() {
        return Err(refused);
    }
    Ok(rows)
}

/// Returns the index of the reference with the row nearest to the scene's; `None` without references.
pub fn nearest_reference(
    scene: &ViewHistogram,
    references: &[Vec<ViewHistogram>],
) -> Option<usize> {
    let nearest = |views: &Vec<ViewHistogram>| {
        let distances = views.iter().map(|view| distance(scene, view));
        distances.fold(f32::INFINITY, f32::min)
    };
    let distances = references.iter().map(nearest).enumerate();
    distances
        .min_by(|a, b| a.1.total_cmp(&b.1))
        .map(|(reference, _)| reference)
}

/// Returns the χ² distance of two rows, 0..10: Σ (a - b)²/(a + b).
pub fn distance(a: &ViewHistogram, b: &ViewHistogram) -> f32 {
    let term = |(a, b): (&f32, &f32)| {
        let sum = a + b;
        if sum > 0.0 {
            (a - b).powi(2) / sum
        } else {
            0.0
        }
    };
    a.row.iter().zip(&b.row).map(term).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::descriptors::surface::tests::{
        bent_sheet, bent_surface, moved, plane, sphere, surface_of, test_motion,
    };

    fn apart(a: &ViewHistogram, b: &ViewHistogram) -> f32 {
        a.row.iter().zip(&b.row).map(|(a, b)| (a - b).abs()).sum()
    }

    /// The formulas as written, in double precision.
    fn slow_row(surface: &DescribedSurface, viewpoint: &Point3<f64>) -> ViewHistogram {
        let num = surface.points.len() as f64;
        let points: Vec<Point3<f64>> = surface.points.iter().map(|p| p.cast()).collect();
        let normals: Vec<Vector3<f64>> = surface.normals.iter().map(|n| n.cast()).collect();
        let centroid = Point3::from(points.iter().map(|p| p.coords).sum::<Vector3<f64>>() / num);
        let u = normals.iter().sum::<Vector3<f64>>().normalize();
        let view = (viewpoint - centroid).normalize();
        let mut row = vec![0.0_f32; 308];
        let mut put = |start: usize, num_bins: usize, share: f64| {
            let bin = ((share * num_bins as f64) as usize).min(num_bins - 1);
            row[start + bin] += 1.0 / num as f32;
        };
        for (p, n) in points.iter().zip(&normals) {
            let d = (p - centroid).normalize();
            let v = d.cross(&u).normalize();
            let w = u.cross(&v);
            put(0, 45, v.dot(n).midpoint(1.0));
            put(45, 45, u.dot(&d).midpoint(1.0));
            put(
                90,
                45,
                (w.dot(n).atan2(u.dot(n)) / std::f64::consts::PI).midpoint(1.0),
            );
            put(135, 45, (p - centroid).norm() / 1.0);
            put(180, 128, view.dot(n).midpoint(1.0));
        }
        ViewHistogram { row }
    }

    #[test]
    fn the_row_agrees_with_the_formulas() {
        let surface = bent_surface();
        for viewpoint in [Point3::origin(), Point3::new(0.7, -0.4, 0.1)] {
            let fast = describe_vfh(&surface, &viewpoint);
            assert_eq!(fast.row.len(), 308);
            // Some points lie on the border of two bins and fall on either side due to rounding.
            assert!(apart(&fast, &slow_row(&surface, &viewpoint)) < 0.02);
        }
    }

    #[test]
    fn moving_camera_and_part_together_changes_next_to_nothing() {
        let surface = bent_surface();
        let motion = test_motion();
        let before = describe_vfh(&surface, &Point3::origin());
        let camera = motion.cast::<f64>() * Point3::origin();
        let after = describe_vfh(&moved(&surface, &motion), &camera);
        assert!(apart(&before, &after) < 0.05, "{}", apart(&before, &after));
        assert!(distance(&before, &after) < 0.02);
        // But a camera that does not move along sees another side of it.
        let from_aside = describe_vfh(&surface, &Point3::new(1.2, 0.0, 0.4));
        assert!(distance(&before, &from_aside) > 0.5);
    }

    #[test]
    fn a_plane_seen_square_on_has_one_bin_for_each_angle() {
        let found = describe_vfh(&plane(), &Point3::origin());
        for (start, num, middle) in [(0, 45, 22), (45, 45, 22), (90, 45, 22), (180, 128, 127)] {
            let histogram = &found.row[start..start + num];
            assert!(
                (histogram[middle] - 1.0).abs() < 1e-3,
                "{start}: {histogram:?}"
            );
        }
        // Half the diagonal is 0.28 m: bins up to number 12, at 45 bins per metre.
        assert!(found.row[135 + 13..180].iter().all(|x| *x == 0.0));
        assert!(found.row[135 + 11] > 0.0);
    }

    #[test]
    fn the_near_half_of_a_sphere_spreads_its_normals_evenly_over_the_view() {
        // Archimedes: equal heights on a sphere have equal areas. The same holds for cosines to the direction of the camera.
        let surface = sphere(Point3::new(0.0, 0.0, 2.0), 0.3, 12_800);
        let found = describe_vfh(&surface, &Point3::origin());
        for (bin, share) in found.row[180..308].iter().enumerate() {
            let expected = if bin < 64 { 0.0 } else { 1.0 / 64.0 };
            assert!((share - expected).abs() < 0.1 / 64.0, "{bin}: {share}");
        }
        // The centroid of a hemisphere lies half a radius in: 0.15 m from the top, 0.335 m from the rim.
        for (bin, share) in found.row[135..180].iter().enumerate() {
            assert!((6..=15).contains(&bin) || *share == 0.0, "{bin}: {share}");
        }
    }

    #[test]
    fn the_nearest_view_speaks_for_its_reference() {
        let views = |surface: &DescribedSurface| {
            [0.0, 0.4]
                .map(|x| describe_vfh(surface, &Point3::new(x, 0.0, 0.0)))
                .to_vec()
        };
        let bent = bent_surface();
        let references = [views(&plane()), views(&bent), Vec::new()];
        let seen = describe_vfh(&bent, &Point3::new(0.38, 0.02, 0.0));
        assert_eq!(nearest_reference(&seen, &references), Some(1));
        assert_eq!(nearest_reference(&seen, &[]), None);
    }

    #[test]
    fn a_reference_has_a_row_for_each_side_and_none_without_points() {
        let mut cloud = PointCloud::from_points(bent_sheet());
        let params = SurfaceParams::default();
        let error = describe_views(&PointCloud::default(), Coverage::OneSide, &params);
        assert!(matches!(
            error,
            Err(SurfaceError::TooFewPoints { found: 0, .. })
        ));
        cloud.normals = Some(bent_surface().normals);
        let found = describe_views(&cloud, Coverage::OneSide, &params).expect("rows");
        assert_eq!(found.len(), 9);
        assert!(
            found
                .iter()
                .flat_map(|view| &view.row)
                .all(|x| x.is_finite())
        );
    }

    #[test]
    fn all_points_in_one_place_leave_a_finite_row() {
        let one_place = surface_of(vec![Point3::origin(); 30], vec![Vector3::z(); 30]);
        let found = describe_vfh(&one_place, &Point3::origin());
        assert!(found.row.iter().all(|x| x.is_finite()));
        assert!(distance(&found, &found) < 1e-9);
        let nothing = describe_vfh(&surface_of(Vec::new(), Vec::new()), &Point3::origin());
        assert!(nothing.row.iter().all(|x| *x == 0.0));
    }
}
