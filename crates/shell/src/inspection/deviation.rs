//! Signed distance of every point of the part from the enrolled surface, for colouring the view.

use nalgebra::{Isometry3, Point3};

use inspection::pipeline::Inspection;
use stages::{reference::Reference, scene::SceneCloud};

/// Returns one deviation per point of the scene, metres, above 0 on the side of the surface's normals; NaN for points without
/// one. Empty without a pose.
pub fn deviations(scene: &SceneCloud, inspection: &Inspection, reference: &Reference) -> Vec<f32> {
    let Ok(part) = &inspection.segmentation.part else {
        return Vec::new();
    };
    let points = &scene.cloud.points;
    let part = part.indices.iter().map(|index| *index as usize);
    let of_part = part.map(|index| (index, points[index]));
    deviations_at(points.len(), of_part, inspection, reference)
}

/// Does the same for any points in the camera frame: returns `num_points` deviations, NaN for points that are not in `part`.
pub(crate) fn deviations_at(
    num_points: usize,
    part: impl Iterator<Item = (usize, Point3<f32>)>,
    inspection: &Inspection,
    reference: &Reference,
) -> Vec<f32> {
    let Some(Ok(pose)) = &inspection.pose else {
        return Vec::new();
    };
    let Some(normals) = &reference.cloud.normals else {
        return Vec::new();
    };
    // In f32, coordinates of about a metre keep micrometres: enough for a colour.
    let part_from_camera: Isometry3<f32> = pose.target_from_source.cast();
    let field = reference.field();
    let deviation = |point: &Point3<f32>| {
        let point = part_from_camera * point;
        let nearest = field.nearest(&point)?;
        let surface = reference.cloud.points.get(nearest.index)?;
        Some((point - surface).dot(normals.get(nearest.index)?))
    };
    let mut all = vec![f32::NAN; num_points];
    for (index, point) in part {
        all[index] = deviation(&point).unwrap_or(f32::NAN);
    }
    all
}
