//! The pose of a part by those of its edges whose side is out of sight, with the readings that are lost there.
//!
//! An outline ends some of a pixel before the part does, and a pixel is larger where the part is farther away. Where the
//! folded side of an edge comes into sight, the outline ends where that side does. So when a part is turned, its outline
//! seems shifted towards its nearer edges, by 1 to 3 mm times the sine of the turn. The verdict does not mind; a
//! calibration from several captures takes the difference for depth.

use nalgebra::{Point3, Vector3};

use super::{
    Scene, THIRD, evidence::facing_view, local_normal::LocalNormals, outline_ends::outline_of,
    prepared_scene::thinned_source,
};
use crate::{pose::refine::refine, reference::Reference};
use geometry::rigid::RigidTransform;

/// What an outline loses, pixels: half of one by sampling, the rest where readings are lost.
const LOST_PIXELS: f64 = 1.0;
/// With fewer edges, or a smaller share of them, the pose is left as it is.
const LEAST_EDGES: usize = 40;
const LEAST_SHARE: f64 = 0.25;

/// Refines a confirmed pose once more, by the edges whose side is out of sight; the seed is that of the confirmation.
/// `None` if they are too few.
pub fn by_hidden_sides(
    scene: &Scene<'_>,
    reference: &Reference,
    target_from_source: &RigidTransform,
    seed: u64,
) -> Option<RigidTransform> {
    let target = reference.target(facing_view(reference, target_from_source))?;
    let camera = scene.scene.intrinsics?;
    let mut outline = outline_of(scene);
    let num_all = outline.own.len();
    let normals = LocalNormals::new(scene);
    let plane_from_camera = scene.query.plane.plane_from_camera;
    let camera_from_plane = plane_from_camera.inverse();
    let corrected = |at: &Point3<f64>, along: &Vector3<f64>| {
        let seen = camera_from_plane * at;
        let normal = normals.at(&seen)?.cast::<f64>();
        // The surface is to the left.
        let outwards = (camera_from_plane * along)
            .cross(&normal)
            .try_normalize(0.3)?;
        let away = outwards.dot(&seen.coords.normalize());
        // A pixel is longer on a surface that is seen at an angle.
        let across = (1.0 - away * away).sqrt().max(0.5);
        let lost = LOST_PIXELS * seen.z / (camera.fx * across);
        (away >= 0.0).then(|| plane_from_camera * (seen + outwards * lost))
    };
    let oriented = outline.own.iter().zip(&outline.along);
    outline.own = oriented
        .filter_map(|(at, along)| corrected(at, along))
        .collect();
    let num = outline.own.len();
    if num < LEAST_EDGES || (num as f64) < LEAST_SHARE * num_all as f64 {
        return None;
    }
    let source = thinned_source(scene, &outline, seed);
    Some(refine(&source, &target, target_from_source, &THIRD[1..]).target_from_source)
}
