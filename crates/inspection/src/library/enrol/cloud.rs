//! The cloud of an enrolled part: thinning, normals and coverage.

use nalgebra::{Point3, Vector3};

use super::EnrolParams;
use geometry::{
    cloud::PointCloud, nearest::KdTree, normals::estimate_normals, principal::principal_axes,
    units::Metres, voxel::downsample,
};

/// Thins the cloud to at most the allowed number of points. Also returns the voxel used.
pub(super) fn thinned(cloud: &PointCloud, params: &EnrolParams) -> (PointCloud, Metres) {
    let skins = skins(cloud);
    let mut voxel = params.voxel;
    loop {
        let thin = match &skins {
            Some(skins) => joined(skins.each_ref().map(|skin| downsample(skin, voxel))),
            None => downsample(cloud, voxel),
        };
        let excess = thin.points.len() as f64 / params.max_points.max(1) as f64;
        if excess <= 1.0 {
            return (thin, voxel);
        }
        // The number of voxels on a surface falls with the square of their edge.
        voxel = Metres(voxel.0 * excess.sqrt().max(1.02));
    }
}

/// Share of the normals that must face the other way for a cloud to have two skins.
const MIN_OTHER_SKIN_SHARE: f64 = 0.2;

/// Splits a cloud by the side of its thinnest extent that its normals face, so that thinning does not mix the two skins of a sheet;
/// `None` without normals, or if hardly any face the other way.
fn skins(cloud: &PointCloud) -> Option<[PointCloud; 2]> {
    let normals = cloud.normals.as_deref()?;
    let axes = principal_axes(cloud.points.iter().map(|p| (p.cast(), 1.0)))?;
    let thinnest = axes.axes.column(2).into_owned().cast::<f32>();
    let skins = [true, false].map(|is_first| {
        let all = cloud.points.iter().zip(normals);
        let of_skin = all.filter(|(_, n)| (n.dot(&thinnest) > 0.0) == is_first);
        let (points, normals) = of_skin.map(|(p, n)| (*p, *n)).unzip();
        PointCloud {
            normals: Some(normals),
            points,
            ..PointCloud::default()
        }
    });
    let fewer = skins[0].points.len().min(skins[1].points.len());
    (fewer as f64 >= MIN_OTHER_SKIN_SHARE * cloud.points.len() as f64).then_some(skins)
}

fn joined([mut one, other]: [PointCloud; 2]) -> PointCloud {
    one.points.extend(other.points);
    if let Some((normals, others)) = one.normals.as_mut().zip(other.normals) {
        normals.extend(others);
    }
    one
}

/// Estimates normals over three voxels, or over three times the point spacing where the cloud is sparser.
pub(super) fn normals_towards(
    cloud: &PointCloud,
    voxel: Metres,
    viewpoint: &Point3<f64>,
) -> Vec<Vector3<f32>> {
    let radius = Metres(3.0 * voxel.0.max(spacing(&cloud.points)));
    let tree = KdTree::new(&cloud.points);
    estimate_normals(&cloud.points, &tree, radius, viewpoint)
}

/// Returns the median distance of a point to its nearest neighbour, metres, from about a hundred points.
pub(super) fn spacing(points: &[Point3<f32>]) -> f64 {
    let step = (points.len() / 100).max(1);
    let mut distances: Vec<f32> = points
        .iter()
        .step_by(step)
        .filter_map(|p| {
            points
                .iter()
                .map(|q| (p - q).norm_squared())
                .filter(|&d| d > 0.0)
                .min_by(f32::total_cmp)
        })
        .collect();
    distances.sort_unstable_by(f32::total_cmp);
    distances
        .get(distances.len() / 2)
        .map_or(0.0, |&d| f64::from(d).sqrt())
}

/// Returns the finite points, with normals only if all of them are usable.
pub(super) fn finite_only(cloud: &PointCloud) -> PointCloud {
    let usable = |n: &Vector3<f32>| n.norm().is_finite() && n.norm() > 0.1;
    let normals = cloud.normals.as_ref().and_then(|normals| {
        cloud
            .finite()
            .map(|(i, _)| usable(&normals[i]).then(|| normals[i].normalize()))
            .collect()
    });
    PointCloud {
        points: cloud.finite().map(|(_, p)| *p).collect(),
        normals,
        ..PointCloud::default()
    }
}

/// Distance to the nearest other point, in point spacings, from which a point of a thinned cloud is isolated.
const ISOLATED_MIN_SPACINGS: f64 = 5.0;
/// Maximum share of isolated points: more belong to a cloud that is sparse in places, such as the corners of a mesh.
const MAX_ISOLATED_SHARE: f64 = 0.01;

/// Drops isolated points, which would set the size of the part, from a cloud thinned with this voxel.
pub(super) fn without_isolated(cloud: PointCloud, voxel: Metres) -> PointCloud {
    let reach = ISOLATED_MIN_SPACINGS * voxel.0.max(spacing(&cloud.points));
    let tree = KdTree::new(&cloud.points);
    let is_isolated = |(i, p): (usize, &Point3<f32>)| {
        let other = tree.nearest_other(p, i);
        other.is_none_or(|other| f64::from(other.distance_sq) > reach * reach)
    };
    let is_isolated: Vec<bool> = cloud.points.iter().enumerate().map(is_isolated).collect();
    let num_isolated = is_isolated.iter().filter(|is| **is).count();
    if num_isolated == 0 || num_isolated as f64 > MAX_ISOLATED_SHARE * cloud.points.len() as f64 {
        return cloud;
    }
    let kept = |i: &usize| !is_isolated[*i];
    let indices = || (0..cloud.points.len()).filter(kept);
    PointCloud {
        points: indices().map(|i| cloud.points[i]).collect(),
        normals: cloud
            .normals
            .as_ref()
            .map(|normals| indices().map(|i| normals[i]).collect()),
        ..PointCloud::default()
    }
}

/// Minimum distance of a captured point from the camera, metres.
const MIN_DEPTH_M: f32 = 0.1;
/// Share of the points that must lie in front of the camera; the others may be stray.
const MIN_IN_FRONT_SHARE: f64 = 0.99;
/// Share of the normals that must face the camera; those at edges of a capture may be off.
const MIN_FACING_SHARE: f64 = 0.98;

/// Returns whether the cloud may be one capture by a camera at the origin.
pub(super) fn is_one_capture(cloud: &PointCloud) -> bool {
    let num_in_front = cloud.points.iter().filter(|p| p.z > MIN_DEPTH_M).count();
    let is_before_camera = num_in_front as f64 >= MIN_IN_FRONT_SHARE * cloud.points.len() as f64;
    let faces_camera = cloud.normals.as_ref().is_none_or(|normals| {
        let facing = cloud
            .points
            .iter()
            .zip(normals)
            .filter(|(p, n)| n.dot(&p.coords) <= 0.0)
            .count();
        facing as f64 >= MIN_FACING_SHARE * normals.len() as f64
    });
    is_before_camera && faces_camera
}

/// Length of the mean normal from which a surface faces one way: 0 for a closed surface, 0.5 for half a sphere, 0.9 for a
/// scanned fender. From behind, such a surface shows hardly a point.
const ONE_WAY_MIN_MEAN_NORMAL: f32 = 0.3;

/// Returns whether a surface with these normals faces one way.
pub(super) fn face_one_way(normals: &[Vector3<f32>]) -> bool {
    normals.iter().sum::<Vector3<f32>>().norm() > ONE_WAY_MIN_MEAN_NORMAL * normals.len() as f32
}
