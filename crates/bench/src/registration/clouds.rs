//! Clouds for registration.

use nalgebra::{Point3, Vector3};
use rand::{RngExt as _, SeedableRng as _, seq::SliceRandom as _};
use rand_pcg::Pcg64;

use super::NUM_POINTS;
use geometry::{
    cloud::{PointCloud, is_finite},
    mesh::TriangleMesh,
    rigid::RigidTransform,
    units::{Metres, Radians},
};
use simulate::{
    CellSetup, PartPose, PoseRange, SensorNoise, SimulatedFrame, SimulatedObject, SurfaceLabel,
    frame_of_mesh,
};
use stages::scene::scene_from_frame;

/// Samples the surface anew, with normal noise on every coordinate.
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

/// Draws from the standard normal distribution (G. E. P. Box and M. E. Muller, "A note on the generation of random
/// normal deviates", Annals of Mathematical Statistics 29(2), 1958).
fn normal(rng: &mut Pcg64) -> f64 {
    let radius = (-2.0 * (1.0 - rng.random::<f64>()).ln()).sqrt();
    radius * (std::f64::consts::TAU * rng.random::<f64>()).cos()
}

/// Removes the share of the points that lies farthest in a random direction.
pub(super) fn hide(cloud: &mut PointCloud, share: f64, seed: u64) {
    let mut rng = Pcg64::seed_from_u64(seed ^ 0x41de);
    let direction = Vector3::from([(); 3].map(|()| normal(&mut rng) as f32));
    let along = |p: &Point3<f32>| p.coords.dot(&direction);
    cloud.points.sort_by(|a, b| along(a).total_cmp(&along(b)));
    let num_kept = (cloud.points.len() as f64 * (1.0 - share)).round() as usize;
    cloud.points.truncate(num_kept);
    cloud.points.shuffle(&mut rng);
}

/// Moves a share of the points to random places in a box 1.5 times the size of the cloud's.
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

/// Returns what the simulated camera sees of a part from within 60° of its front, thinned, and the true pose.
pub(super) fn view(mesh: &TriangleMesh, seed: u64) -> (PointCloud, RigidTransform) {
    let mut rng = Pcg64::seed_from_u64(seed);
    let shot = drawn_shot(mesh, Radians::from_degrees(60.0), None, &mut rng);
    let mut points = part_points(&shot);
    points.shuffle(&mut rng);
    points.truncate(NUM_POINTS);
    let camera_from_part = shot.truth.camera_from_part;
    (PointCloud::from_points(points), camera_from_part.inverse())
}

/// Draws a frame that shows one whole side of the part, from within an angle of its front.
fn drawn_shot(
    mesh: &TriangleMesh,
    most: Radians,
    noise: Option<SensorNoise>,
    rng: &mut Pcg64,
) -> SimulatedFrame {
    let placement = PoseRange {
        yaw: most,
        pitch: most,
        ..PoseRange::placed()
    };
    loop {
        let mut cell = CellSetup::new(SimulatedObject::Nothing, rng.random());
        cell.pose = PartPose::Drawn(placement);
        cell.noise = noise.unwrap_or(cell.noise);
        let shot = frame_of_mesh(&cell, mesh);
        let facing = (shot.truth.camera_from_part.rotation * Vector3::z()).z;
        if facing >= most.0.cos() && shot.truth.fully_visible {
            return shot;
        }
    }
}

fn part_points(shot: &SimulatedFrame) -> Vec<Point3<f32>> {
    let scene = scene_from_frame(&shot.frame);
    let labelled = scene.cloud.points.iter().zip(&shot.truth.labels);
    labelled
        .filter(|(p, label)| **label == SurfaceLabel::Part && is_finite(p))
        .map(|(p, _)| *p)
        .collect()
}

/// Draws points at random places of the whole surface.
pub(super) fn random_sample(mesh: &TriangleMesh, rng: &mut Pcg64) -> PointCloud {
    let sample = mesh.sample_evenly(NUM_DENSE, rng.random());
    let dense = sample.expect("a part's mesh has an area").points;
    disturbed(dense, rng)
}

/// Draws points of what a perfect camera sees from within 75° of the outside, in part space.
pub(super) fn seen_from_outside(mesh: &TriangleMesh, rng: &mut Pcg64) -> PointCloud {
    let shot = drawn_shot(
        mesh,
        Radians::from_degrees(75.0),
        Some(SensorNoise::none()),
        rng,
    );
    let part_from_camera = shot.truth.camera_from_part.inverse();
    let seen = part_points(&shot).into_iter();
    let seen = seen.map(|p| (part_from_camera * p.cast::<f64>()).cast());
    disturbed(seen.collect(), rng)
}

/// Number of evenly sampled points to draw from at random: in an even sample itself, neighbours repel each other.
const NUM_DENSE: usize = 8 * NUM_POINTS;
/// Fewest points of a random sample, and its least and greatest noise, metres.
const FEWEST_POINTS: f64 = 1_500.0;
const LEAST_NOISE: f64 = 0.0005;
const MOST_NOISE: f64 = 0.004;

/// Keeps a random number of the points and adds noise of a random size along and across the surface.
fn disturbed(mut points: Vec<Point3<f32>>, rng: &mut Pcg64) -> PointCloud {
    let mut between =
        |low: f64, high: f64| (low.ln() + rng.random::<f64>() * (high / low).ln()).exp();
    let num_points = between(FEWEST_POINTS, NUM_POINTS as f64) as usize;
    let noise = between(LEAST_NOISE, MOST_NOISE);
    points.shuffle(rng);
    points.truncate(num_points);
    for p in &mut points {
        *p += Vector3::from([(); 3].map(|()| (noise * normal(rng)) as f32));
    }
    PointCloud::from_points(points)
}
