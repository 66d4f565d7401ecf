//! What the readings of a frame say of each node of the surface.

use nalgebra::{Point3, Vector3};

use super::{StandingPart, surface::Surface};
use crate::scene::SceneCloud;
use geometry::{cloud::is_finite, rigid::RigidTransform};

/// Pixels on each side of a reading that must show the same surface: at a jump, and beside a loss, depths are mixed.
const SAME_SURFACE_PIXELS: [usize; 2] = [1, 3];
/// Difference of depth to such a pixel, relative to the depth, from which it shows another surface: a surface at 60° has 0.01 of
/// a Kinect's.
const JUMP_SHARE: f32 = 0.02;
/// Cosine between the surface and the ray from which readings are judged: up to 60°. Beyond, noise and losses grow.
pub(super) const MIN_FACING_COSINE: f64 = 0.5;
/// Error across the rays, pixels (C. V. Nguyen, S. Izadi and D. Lovell, "Modeling Kinect Sensor Noise for Improved 3D
/// Reconstruction and Tracking", 3DIMPVT 2012).
const LATERAL_PIXELS: f64 = 0.5;

/// Sums over the readings at each node.
#[derive(Clone, Debug)]
pub(super) struct NodeReadings {
    /// Number of readings.
    pub(super) nums: Vec<f64>,
    /// Of how far outside of the surface they lie, metres.
    pub(super) offs: Vec<f64>,
    /// Of the variances that the camera's noise gives them, square metres.
    pub(super) variances: Vec<f64>,
}

impl NodeReadings {
    fn none(num_nodes: usize) -> Self {
        let zeros = || vec![0.0; num_nodes];
        Self {
            nums: zeros(),
            offs: zeros(),
            variances: zeros(),
        }
    }

    /// Takes the readings of a part in a frame.
    pub(super) fn of(
        surface: &Surface<'_>,
        frame: &SceneCloud,
        part: &StandingPart<'_>,
        part_from_camera: &RigidTransform,
        focal_length: f64,
    ) -> Self {
        let mut found = Self::none(surface.points.len());
        let camera = part_from_camera * Point3::origin();
        for &index in part.indices {
            let index = index as usize;
            if !is_inside(frame, index) {
                continue;
            }
            let depth = f64::from(frame.cloud.points[index].z);
            let at = part_from_camera * frame.cloud.points[index].cast::<f64>();
            let Some((node, off)) = surface.off(&at.cast()) else {
                continue;
            };
            let normal: Vector3<f64> = surface.normals[node].cast();
            let facing = normal.dot(&(camera - at).normalize());
            if surface.is_margin[node] || facing < MIN_FACING_COSINE {
                continue;
            }
            let along = part.noise_at_1m.0 * depth * depth * facing;
            let across =
                LATERAL_PIXELS * depth / focal_length * (1.0 - facing * facing).max(0.0).sqrt();
            found.nums[node] += 1.0;
            found.offs[node] += off;
            found.variances[node] += along * along + across * across;
        }
        found
    }

    /// Joins the readings of several frames.
    pub(super) fn joined(frames: &[Self]) -> Self {
        let num_nodes = frames.first().map_or(0, |first| first.nums.len());
        let mut all = Self::none(num_nodes);
        for frame in frames {
            let pairs = [
                (&mut all.nums, &frame.nums),
                (&mut all.offs, &frame.offs),
                (&mut all.variances, &frame.variances),
            ];
            for (sums, values) in pairs {
                for (sum, value) in sums.iter_mut().zip(values) {
                    *sum += value;
                }
            }
        }
        all
    }

    /// How far outside of the surface the readings of a node lie in the mean, metres; `None` without readings.
    pub(super) fn mean(&self, node: usize) -> Option<f64> {
        (self.nums[node] > 0.0).then(|| self.offs[node] / self.nums[node])
    }
}

/// True if a pixel and those around it show one surface.
fn is_inside(frame: &SceneCloud, index: usize) -> bool {
    let (Some(grid), points) = (frame.cloud.grid, &frame.cloud.points) else {
        return false;
    };
    let Some(point) = points.get(index).filter(|point| is_finite(point)) else {
        return false;
    };
    let (row, column) = (index / grid.width, index % grid.width);
    SAME_SURFACE_PIXELS.iter().all(|far| {
        if column < *far || row < *far || column + far >= grid.width || row + far >= grid.height {
            return false;
        }
        let down = far * grid.width;
        [index - far, index + far, index - down, index + down]
            .iter()
            .all(|near| (points[*near].z - point.z).abs() <= JUMP_SHARE * point.z)
    })
}
