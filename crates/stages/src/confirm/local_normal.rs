//! The surface's normal at places of a part, from the readings around.

use nalgebra::{Matrix3, Point3, SymmetricEigen, Vector3};

use super::Scene;

/// Readings this close are of the same surface, metres.
const RADIUS_M: f64 = 0.05;
/// Readings looked at along either side of the window.
const NUM_ALONG: i64 = 7;
/// Fewer have no plane.
const LEAST: usize = 8;

/// Fits planes to the readings of a part around places of it.
pub(super) struct LocalNormals<'a> {
    scene: &'a Scene<'a>,
    is_part: Vec<bool>,
}

impl<'a> LocalNormals<'a> {
    pub(super) fn new(scene: &'a Scene<'a>) -> Self {
        let mut is_part = vec![false; scene.scene.cloud.points.len()];
        for &i in &scene.part.indices {
            if let Some(is_part) = is_part.get_mut(i as usize) {
                *is_part = true;
            }
        }
        Self { scene, is_part }
    }

    /// The unit normal towards the camera at a place of the part, camera space; `None` where too little of it is seen.
    pub(super) fn at(&self, at: &Point3<f64>) -> Option<Vector3<f32>> {
        let camera = self.scene.scene.intrinsics?;
        let (u, v) = camera.pixel_of(at)?;
        let half = RADIUS_M * camera.fx / at.z;
        let step = (2.0 * half / NUM_ALONG as f64).max(1.0);
        let (mut num, mut sum, mut sum_sq) = (0_usize, Vector3::zeros(), Matrix3::zeros());
        for row in -NUM_ALONG / 2..=NUM_ALONG / 2 {
            for column in -NUM_ALONG / 2..=NUM_ALONG / 2 {
                let (x, y) = (
                    (u + column as f64 * step).round(),
                    (v + row as f64 * step).round(),
                );
                let is_inside =
                    x >= 0.0 && y >= 0.0 && x < camera.width as f64 && y < camera.height as f64;
                let i = if is_inside {
                    y as usize * camera.width + x as usize
                } else {
                    continue;
                };
                if self.is_part.get(i) != Some(&true) {
                    continue;
                }
                let d: Vector3<f64> = self.scene.scene.cloud.points[i].cast::<f64>() - at;
                if d.norm_squared() < 4.0 * RADIUS_M * RADIUS_M {
                    num += 1;
                    sum += d;
                    sum_sq += d * d.transpose();
                }
            }
        }
        if num < LEAST {
            return None;
        }
        let mean = sum / num as f64;
        let eigen = SymmetricEigen::new(sum_sq / num as f64 - mean * mean.transpose());
        let normal: Vector3<f64> = eigen
            .eigenvectors
            .column(eigen.eigenvalues.imin())
            .into_owned();
        let towards = if normal.dot(&at.coords) > 0.0 {
            -normal
        } else {
            normal
        };
        Some(towards.cast())
    }
}
