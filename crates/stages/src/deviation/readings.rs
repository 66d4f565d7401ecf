//! What the readings of a frame say of each node of the surface, and of the four quarters around it: nodes are too far apart for
//! the smallest patches.

use nalgebra::{Point3, Vector3};

use super::{
    StandingPart,
    surface::{MAX_OFF_M, Surface},
};
use crate::scene::SceneCloud;
use geometry::{cloud::is_finite, rigid::RigidTransform};

/// Pixels on each side of a reading that must show the same surface: at a jump, and beside a loss, depths are mixed.
const SAME_SURFACE_PIXELS: [usize; 2] = [1, 3];
/// Difference of depth to such a pixel, relative to the depth, from which it shows another surface: a surface at 60° has 0.01 of
/// a Kinect's.
const JUMP_SHARE: f32 = 0.02;
/// Cosine between the surface and the ray from which readings are judged: up to 60°. Beyond, noise and losses grow.
pub(super) const MIN_FACING_COSINE: f64 = 0.5;
/// Standard deviations of the noise by which a reading of the surface may lie further off.
const LIMIT_DEVIATIONS: f64 = 3.0;
/// Error across the rays, pixels (C. V. Nguyen, S. Izadi and D. Lovell, "Modeling Kinect Sensor Noise for Improved 3D
/// Reconstruction and Tracking", 3DIMPVT 2012).
const LATERAL_PIXELS: f64 = 0.5;

/// Sums over the readings in a quarter of what is nearest to a node.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Quarter {
    /// Number of readings.
    pub(super) num: f64,
    /// Of how far outside of the surface they lie, metres.
    pub(super) off: f64,
    /// Of the variances that the camera's noise gives them, square metres.
    pub(super) variance: f64,
    /// Of their places on the surface, from the node, metres.
    away: Vector3<f64>,
}

impl Quarter {
    fn add(&mut self, other: &Self) {
        self.num += other.num;
        self.off += other.off;
        self.variance += other.variance;
        self.away += other.away;
    }

    /// Where its readings lie in the mean, from the node, metres; `None` without readings.
    pub(super) fn place(&self) -> Option<Vector3<f64>> {
        (self.num > 0.0).then(|| self.away / self.num)
    }
}

/// The readings at each node.
#[derive(Clone, Debug)]
pub(super) struct NodeReadings {
    pub(super) quarters: Vec<[Quarter; 4]>,
}

impl NodeReadings {
    fn none(num_nodes: usize) -> Self {
        Self {
            quarters: vec![[Quarter::default(); 4]; num_nodes],
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
            let noise = part.noise_at_1m.0 * depth * depth;
            // Without room for the noise, it would be cut off on one side of a dent.
            let limit = MAX_OFF_M + LIMIT_DEVIATIONS * noise;
            let Some((node, off)) = surface.off(&at.cast(), limit) else {
                continue;
            };
            let normal: Vector3<f64> = surface.normals[node].cast();
            let facing = normal.dot(&(camera - at).normalize());
            if surface.is_margin[node] || facing < MIN_FACING_COSINE {
                continue;
            }
            let along = noise * facing;
            let sine = (1.0 - facing * facing).max(0.0).sqrt();
            let across = LATERAL_PIXELS * depth / focal_length * sine;
            let away = at - surface.points[node].cast::<f64>() - normal * off;
            found.quarters[node][quarter_of(&normal, &away)].add(&Quarter {
                num: 1.0,
                off,
                variance: along * along + across * across,
                away,
            });
        }
        found
    }

    /// Joins the readings of several frames.
    pub(super) fn joined(frames: &[Self]) -> Self {
        let num_nodes = frames.first().map_or(0, |first| first.quarters.len());
        let mut all = Self::none(num_nodes);
        for frame in frames {
            for (sums, values) in all.quarters.iter_mut().zip(&frame.quarters) {
                for (sum, value) in sums.iter_mut().zip(values) {
                    sum.add(value);
                }
            }
        }
        all
    }

    /// Number of readings at a node.
    pub(super) fn num(&self, node: usize) -> f64 {
        self.quarters[node].iter().map(|quarter| quarter.num).sum()
    }

    /// How far outside of the surface the readings of a node lie in the mean, metres; `None` without readings.
    pub(super) fn mean(&self, node: usize) -> Option<f64> {
        let off: f64 = self.quarters[node].iter().map(|quarter| quarter.off).sum();
        let num = self.num(node);
        (num > 0.0).then(|| off / num)
    }

    /// Moves the readings of a node further outside, by metres.
    pub(super) fn shift(&mut self, node: usize, by: f64) {
        for quarter in &mut self.quarters[node] {
            quarter.off += quarter.num * by;
        }
    }
}

/// The quarter around a node that a place lies in.
fn quarter_of(normal: &Vector3<f64>, away: &Vector3<f64>) -> usize {
    let first = normal.cross(&Vector3::ith(normal.iamin(), 1.0));
    let second = normal.cross(&first);
    let is_beyond = |axis: &Vector3<f64>| usize::from(away.dot(axis) > 0.0);
    2 * is_beyond(&first) + is_beyond(&second)
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
