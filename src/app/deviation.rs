//! How far every point of the part lies off the enrolled surface, with its sign, for colouring the view.

use nalgebra::{Isometry3, Point3};

use crate::{
    pipeline::Inspection,
    stages::{reference::Reference, scene::SceneCloud},
};

/// One deviation per point of the scene, metres, above 0 on the side that the surface's normals point to; NaN where
/// there is none. Empty without a pose.
pub(super) fn deviations(
    scene: &SceneCloud,
    inspection: &Inspection,
    reference: &Reference,
) -> Vec<f32> {
    let (Some(Ok(pose)), Ok(part)) = (&inspection.pose, &inspection.segmentation.part) else {
        return Vec::new();
    };
    let Some(normals) = &reference.cloud.normals else {
        return Vec::new();
    };
    // Micrometres are left of a metre: enough for a colour.
    let part_from_camera: Isometry3<f32> = pose.target_from_source.cast();
    let deviation = |point: &Point3<f32>| {
        let point = part_from_camera * point;
        let nearest = reference.field.nearest(&point)?;
        let surface = reference.cloud.points.get(nearest.index)?;
        Some((point - surface).dot(normals.get(nearest.index)?))
    };
    let mut all = vec![f32::NAN; scene.cloud.points.len()];
    for index in &part.indices {
        let index = *index as usize;
        all[index] = deviation(&scene.cloud.points[index]).unwrap_or(f32::NAN);
    }
    all
}
