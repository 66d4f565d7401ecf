//! Pushes a part out of the picture until a given share of it is gone.

use nalgebra::{Point3, Translation3};
use rand::{RngExt as _, SeedableRng as _};
use rand_pcg::Pcg64;

use geometry::{depth_frame::Intrinsics, mesh::TriangleMesh, rigid::RigidTransform};
use simulate::SampledPose;

/// Number of sampled points that the share is counted on.
const NUM_POINTS: usize = 2000;
/// Makes the draws independent of others with the same seed.
const STREAM: u64 = 0x0c07_0c07_0c07_0c07;

/// Draws a pose at which a share of the part's surface within this range lies beyond one edge of the picture.
pub(crate) fn pushed_out_of_the_picture(
    mesh: &TriangleMesh,
    placed: &SampledPose,
    camera: &Intrinsics,
    shares: std::ops::Range<f64>,
    seed: u64,
) -> RigidTransform {
    let mut random = Pcg64::seed_from_u64(seed ^ STREAM);
    let share = random.random_range(shares);
    let direction = [(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)][random.random_range(0..4)];
    let hung: Vec<Point3<f64>> = mesh
        .sample_evenly(NUM_POINTS, seed)
        .map(|cloud| cloud.points)
        .unwrap_or_default()
        .iter()
        .map(|p| placed.camera_from_part * p.cast::<f64>())
        .collect();
    let shifted = |by: f64| {
        Translation3::new(direction.0 * by, direction.1 * by, 0.0) * placed.camera_from_part
    };
    let share_outside = |by: f64| {
        let is_outside = |p: &&Point3<f64>| {
            let p = *p + nalgebra::Vector3::new(direction.0 * by, direction.1 * by, 0.0);
            camera.pixel_of(&p).is_none_or(|(u, v)| {
                u < 0.0 || v < 0.0 || u >= camera.width as f64 || v >= camera.height as f64
            })
        };
        hung.iter().filter(is_outside).count() as f64 / hung.len().max(1) as f64
    };
    // The share outside grows with the shift: bisection finds it to half a millimetre.
    let (mut low, mut high) = (0.0, 2.0);
    for _ in 0..12 {
        let middle = f64::midpoint(low, high);
        if share_outside(middle) < share {
            low = middle;
        } else {
            high = middle;
        }
    }
    shifted(high)
}
