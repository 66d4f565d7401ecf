//! The surface for the descriptors: thinned to an even spacing, with normals, a search tree and keypoints.
//!
//! Point counts in a neighbourhood are only comparable if scene and reference are sampled alike, whatever the camera's
//! distance: both are thinned to one point per cube of the same size. Keypoints form an even grid: car parts are too
//! smooth for corner detectors, which would pick fewer.

use nalgebra::{Point3, Vector3};

use geometry::{
    cloud::PointCloud, error::Advice, nearest::KdTree, normals::estimate_normals, units::Metres,
    voxel::downsample,
};

/// Parameters of [`prepare_surface`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceParams {
    /// Edge of the cubes to which the cloud is thinned, 5..30 mm. Raising it loses detail; halving it quadruples the time.
    pub spacing: Metres,
    /// Radius for estimating normals, 2..5 spacings. Raising it rounds edges, lowering it lets sensor noise through.
    pub normal_radius: Metres,
}

impl Default for SurfaceParams {
    fn default() -> Self {
        Self {
            spacing: Metres::from_mm(20.0),
            normal_radius: Metres::from_mm(60.0),
        }
    }
}

/// An evenly sampled surface.
#[derive(Clone, Debug)]
pub struct DescribedSurface {
    /// The points, metres, all finite.
    pub points: Vec<Point3<f32>>,
    /// A unit normal per point, on the side that was seen.
    pub normals: Vec<Vector3<f32>>,
    /// Search tree over the points.
    pub tree: KdTree,
}

/// Reason why a cloud has no surface to describe.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error, Advice)]
pub enum SurfaceError {
    /// Almost no points are left.
    #[error("{found} points are left of the part once it is thinned, at least {needed} are needed")]
    #[advice = "Move the camera nearer to the part, check that the cloud is in metres, and capture again"]
    TooFewPoints {
        /// Number of points after thinning.
        found: usize,
        /// Minimum number of points.
        needed: usize,
    },
}

/// Minimum number of points of a surface: a normal needs three, a descriptor counts dozens.
pub(super) const MIN_POINTS: usize = 20;

/// Thins a cloud and estimates its normals, oriented like the cloud's own normals if it has some, else towards `viewpoint`.
pub fn prepare_surface(
    cloud: &PointCloud,
    viewpoint: &Point3<f64>,
    params: &SurfaceParams,
) -> Result<DescribedSurface, SurfaceError> {
    let PointCloud {
        points,
        normals: known,
        ..
    } = downsample(cloud, params.spacing);
    if points.len() < MIN_POINTS {
        return Err(SurfaceError::TooFewPoints {
            found: points.len(),
            needed: MIN_POINTS,
        });
    }
    let tree = KdTree::new(&points);
    let mut normals = estimate_normals(&points, &tree, params.normal_radius, viewpoint);
    if let Some(known) = known {
        for (normal, known) in normals.iter_mut().zip(known) {
            if normal.dot(&known) < 0.0 {
                *normal = -*normal;
            }
        }
    }
    Ok(DescribedSurface {
        points,
        normals,
        tree,
    })
}

/// Selects evenly spaced points: those nearest to the mean of each cube of edge `spacing`. Returns their indices, ascending.
pub fn keypoints(surface: &DescribedSurface, spacing: Metres) -> Vec<u32> {
    let cloud = PointCloud {
        points: surface.points.clone(),
        ..PointCloud::default()
    };
    let nearest = |middle: &Point3<f32>| surface.tree.nearest(middle, f32::INFINITY);
    let mut chosen: Vec<u32> = downsample(&cloud, spacing)
        .points
        .iter()
        .filter_map(|middle| Some(nearest(middle)?.index as u32))
        .collect();
    chosen.sort_unstable();
    chosen.dedup();
    chosen
}

#[cfg(test)]
pub(super) mod tests {
    use nalgebra::{Isometry3, Translation3, UnitQuaternion};

    use super::*;

    /// A bent, ridged sheet of 0.5 m, about 1.2 m in front of a camera at the origin: no two places are alike.
    pub(in super::super) fn bent_sheet() -> Vec<Point3<f32>> {
        (0..60 * 50)
            .map(|i| {
                (
                    f64::from(i % 60) * 0.01 - 0.3,
                    f64::from(i / 60) * 0.01 - 0.2,
                )
            })
            .map(|(x, y)| {
                let ridge = (-((x - 0.8 * y - 0.05) / 0.03).powi(2)).exp();
                let z = 1.2 + 0.6 * x * x - 0.4 * y * y + 0.5 * x * y - 0.03 * ridge;
                Point3::new(x, y, z + 0.02 * (9.0 * x + 14.0 * y * y).sin()).cast()
            })
            .collect()
    }

    /// A surface with exactly these points and normals.
    pub(in super::super) fn surface_of(
        points: Vec<Point3<f32>>,
        normals: Vec<Vector3<f32>>,
    ) -> DescribedSurface {
        DescribedSurface {
            tree: KdTree::new(&points),
            points,
            normals,
        }
    }

    /// The bent sheet with estimated normals.
    pub(in super::super) fn bent_surface() -> DescribedSurface {
        let points = bent_sheet();
        let tree = KdTree::new(&points);
        let normals = estimate_normals(&points, &tree, Metres(0.03), &Point3::origin());
        surface_of(points, normals)
    }

    pub(in super::super) fn test_motion() -> Isometry3<f32> {
        Isometry3::from_parts(
            Translation3::new(0.4, -0.7, 2.0),
            UnitQuaternion::from_euler_angles(0.7, -1.9, 2.4),
        )
    }

    pub(in super::super) fn moved(
        surface: &DescribedSurface,
        motion: &Isometry3<f32>,
    ) -> DescribedSurface {
        surface_of(
            surface.points.iter().map(|p| motion * p).collect(),
            surface.normals.iter().map(|n| motion * n).collect(),
        )
    }

    /// Evenly spaced points of a sphere with outward normals.
    pub(in super::super) fn sphere(centre: Point3<f64>, radius: f64, num: i32) -> DescribedSurface {
        let directions = (0..num)
            .map(|i| {
                let z = -1.0 + (f64::from(i) + 0.5) / f64::from(num);
                let turn = f64::from(i) * std::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
                let r = (1.0 - z * z).sqrt();
                Vector3::new(r * turn.cos(), r * turn.sin(), z)
            })
            .collect::<Vec<_>>();
        surface_of(
            directions
                .iter()
                .map(|d| (centre + d * radius).cast())
                .collect(),
            directions.iter().map(|d| d.cast()).collect(),
        )
    }

    /// An upright plane of 41 × 41 points, 10 mm apart, facing the origin; the middle point has index 840.
    pub(in super::super) fn plane() -> DescribedSurface {
        let points: Vec<Point3<f32>> = (0..41 * 41)
            .map(|i| ((i % 41 - 20) as f32 * 0.01, (i / 41 - 20) as f32 * 0.01))
            .map(|(x, y)| Point3::new(x, y, 1.0))
            .collect();
        let normals = vec![-Vector3::z(); points.len()];
        surface_of(points, normals)
    }

    #[test]
    fn readings_that_are_none_leave_no_trace() {
        let mut cloud = PointCloud::from_points(bent_sheet());
        let clean = prepare_surface(&cloud, &Point3::origin(), &SurfaceParams::default());
        cloud.points.insert(7, Point3::new(f32::NAN, 0.0, 1.0));
        cloud.points.push(Point3::new(0.0, f32::INFINITY, 1.0));
        let poisoned = prepare_surface(&cloud, &Point3::origin(), &SurfaceParams::default());
        let (clean, poisoned) = (clean.expect("a surface"), poisoned.expect("a surface"));
        assert_eq!(clean.points, poisoned.points);
        assert_eq!(clean.normals, poisoned.normals);
        assert!(clean.normals.iter().all(|n| (n.norm() - 1.0).abs() < 1e-5));
    }

    #[test]
    fn next_to_nothing_is_refused_by_name() {
        let params = SurfaceParams::default();
        let spot = vec![Point3::new(0.0, 0.0, 1.0); 500];
        for points in [Vec::new(), spot, vec![Point3::new(f32::NAN, 0.0, 0.0); 99]] {
            let cloud = PointCloud::from_points(points);
            let error =
                prepare_surface(&cloud, &Point3::origin(), &params).expect_err("no surface");
            assert!(matches!(
                error,
                SurfaceError::TooFewPoints { found: 0..=1, .. }
            ));
        }
    }

    #[test]
    fn the_cloud_s_own_normals_say_which_side_is_out() {
        let mut cloud = PointCloud::from_points(bent_sheet());
        cloud.normals = Some(vec![Vector3::z(); cloud.points.len()]);
        let surface = prepare_surface(&cloud, &Point3::origin(), &SurfaceParams::default());
        assert!(
            surface
                .expect("a surface")
                .normals
                .iter()
                .all(|n| n.z > 0.0)
        );
    }

    #[test]
    fn keypoints_are_apart_and_leave_no_place_uncovered() {
        let surface = bent_surface();
        let chosen = keypoints(&surface, Metres(0.05));
        assert!(chosen.is_sorted_by(|a, b| a < b));
        assert!((80..200).contains(&chosen.len()), "{}", chosen.len());
        for p in &surface.points {
            let covered = chosen
                .iter()
                .any(|&k| (surface.points[k as usize] - p).norm() < 0.09);
            assert!(covered, "{p}");
        }
        assert!(keypoints(&surface_of(Vec::new(), Vec::new()), Metres(0.05)).is_empty());
    }
}
