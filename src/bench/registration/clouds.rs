//! The clouds that are registered.

use nalgebra::{Point3, Vector3};
use rand::{RngExt as _, SeedableRng as _, seq::SliceRandom as _};
use rand_pcg::Pcg64;

use super::NUM_POINTS;
use crate::{
    geometry::{
        cloud::{PointCloud, is_finite},
        mesh::TriangleMesh,
        rigid::RigidTransform,
    },
    simulate::{CellSetup, PartModel, PartPose, PoseRange, Side, SurfaceLabel, frame_of_mesh},
    stages::scene::scene_from_frame,
    units::{Metres, Radians},
};

/// How far from the front a view is taken, as a cosine.
const FRONTAL: f64 = 0.5;

/// The surface sampled anew, every coordinate with normal noise.
pub(super) fn noisy_sample(mesh: &TriangleMesh, noise: Metres, seed: u64) -> PointCloud {
    let sample = mesh.sample_evenly(NUM_POINTS, seed);
    let sample = sample.expect("a part's mesh has an area");
    let mut rng = Pcg64::seed_from_u64(seed ^ 0x0015e);
    let points = sample
        .points
        .into_iter()
        .map(|p| p + Vector3::from([(); 3].map(|()| (noise.0 * normal(&mut rng)) as f32)));
    PointCloud::from_points(points)
}

/// Normally distributed with variance 1 (G. E. P. Box and M. E. Muller, "A note on the generation of random normal
/// deviates", Annals of Mathematical Statistics 29(2), 1958).
fn normal(rng: &mut Pcg64) -> f64 {
    let radius = (-2.0 * (1.0 - rng.random::<f64>()).ln()).sqrt();
    radius * (std::f64::consts::TAU * rng.random::<f64>()).cos()
}

/// Takes away the share of the points that lies farthest in some direction.
pub(super) fn hide(cloud: &mut PointCloud, share: f64, seed: u64) {
    let mut rng = Pcg64::seed_from_u64(seed ^ 0x41de);
    let direction = Vector3::from([(); 3].map(|()| normal(&mut rng) as f32));
    let along = |p: &Point3<f32>| p.coords.dot(&direction);
    cloud.points.sort_by(|a, b| along(a).total_cmp(&along(b)));
    let num_kept = (cloud.points.len() as f64 * (1.0 - share)).round() as usize;
    cloud.points.truncate(num_kept);
    cloud.points.shuffle(&mut rng);
}

/// Puts a share of the points anywhere in a box half as large again as the cloud's.
pub(super) fn stray(cloud: &mut PointCloud, share: f64, seed: u64) {
    let Some((low, high)) = cloud.bounds() else {
        return;
    };
    let mut rng = Pcg64::seed_from_u64(seed ^ 0x57a4);
    let (middle, size) = (nalgebra::center(&low, &high), (high - low) * 1.5);
    for p in &mut cloud.points {
        if rng.random::<f64>() < share {
            let off = Vector3::from([(); 3].map(|()| rng.random::<f32>() - 0.5));
            *p = middle + off.component_mul(&size);
        }
    }
}

/// What the simulated camera sees of a part from within 60° of its front, thinned, and the pose that puts it back.
pub(super) fn view(model: &PartModel, seed: u64) -> (PointCloud, RigidTransform) {
    let mut rng = Pcg64::seed_from_u64(seed);
    let placement = PoseRange {
        yaw: Radians::from_degrees(60.0),
        pitch: Radians::from_degrees(60.0),
        ..PoseRange::placed()
    };
    loop {
        let side = model.side().unwrap_or(Side::Left);
        let mut cell = CellSetup::with_part(model.kind(), side, model.model_seed(), rng.random());
        cell.pose = PartPose::Drawn(placement);
        let shot = frame_of_mesh(&cell, model.mesh());
        let camera_from_part = shot.truth.camera_from_part;
        let is_frontal = (camera_from_part.rotation * Vector3::z()).z >= FRONTAL;
        if !is_frontal || !shot.truth.fully_visible {
            continue;
        }
        let scene = scene_from_frame(&shot.frame);
        let mut points: Vec<Point3<f32>> = scene
            .cloud
            .points
            .iter()
            .zip(&shot.truth.labels)
            .filter(|(p, label)| **label == SurfaceLabel::Part && is_finite(p))
            .map(|(p, _)| *p)
            .collect();
        points.shuffle(&mut rng);
        points.truncate(NUM_POINTS);
        return (PointCloud::from_points(points), camera_from_part.inverse());
    }
}
