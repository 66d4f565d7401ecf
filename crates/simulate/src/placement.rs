//! Draws poses from a range such that the part stays in the picture.
//!
//! A point (x, y, z) of the rotated part, shifted sideways by s, is seen right of column m exactly if
//! `s ≥ (m - cx) / fx · (z + d) - x`. Taken over all points, this bounds s on both sides, and the gap between the bounds
//! grows linearly with the distance d. So the nearest distance at which the part fits has a closed form.

use nalgebra::{Point3, Translation3, UnitQuaternion, Vector3};
use rand::{RngExt as _, SeedableRng as _};
use rand_pcg::Pcg64;
use serde::{Deserialize, Serialize};

use geometry::depth_frame::Intrinsics;
use geometry::mesh::TriangleMesh;
use geometry::rigid::RigidTransform;
use geometry::units::{Metres, Radians};

/// Distance in pixels of a fully visible part from the frame's edges.
const MARGIN_PIXELS: f64 = 8.0;
/// Largest distance of a part from the optical axis where there is room, in metres.
const MAX_OFF_AXIS_M: f64 = 0.15;

/// Separates the pose's random numbers from others with the same seed.
const STREAM: u64 = 0x705e_705e_705e_705e;

/// A range of poses: yaw about the part's own upright axis first, then pitch, then roll about the optical axis.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PoseRange {
    /// Largest yaw in either direction.
    pub yaw: Radians,
    /// Largest pitch in either direction.
    pub pitch: Radians,
    /// Largest roll in either direction; half a turn allows any roll.
    pub roll: Radians,
    /// Least depth of the part's origin along the optical axis.
    pub nearest: Metres,
    /// Largest depth of the part's origin.
    pub farthest: Metres,
}

/// A drawn pose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SampledPose {
    /// The drawn pose.
    pub camera_from_part: RigidTransform,
    /// False if the part does not fit the frame anywhere in the range with this rotation; it is then at the far end, cut off
    /// evenly.
    pub fully_visible: bool,
}

impl PoseRange {
    /// A carefully hung part: ±10° about every axis, 1.0 to 1.4 m away.
    pub fn facing() -> Self {
        Self {
            yaw: Radians::from_degrees(10.0),
            pitch: Radians::from_degrees(10.0),
            roll: Radians::from_degrees(10.0),
            nearest: Metres(1.0),
            farthest: Metres(1.4),
        }
    }

    /// A carelessly hung part: ±30° yaw, ±20° pitch, any roll, 0.9 to 1.8 m away.
    pub fn placed() -> Self {
        Self {
            yaw: Radians::from_degrees(30.0),
            pitch: Radians::from_degrees(20.0),
            roll: Radians::from_degrees(180.0),
            nearest: Metres(0.9),
            farthest: Metres(1.8),
        }
    }

    /// A strongly rotated part: ±45° yaw and pitch, any roll, 0.9 to 1.8 m away.
    pub fn hard() -> Self {
        Self {
            yaw: Radians::from_degrees(45.0),
            pitch: Radians::from_degrees(45.0),
            ..Self::placed()
        }
    }

    /// Draws a pose for `mesh` (part space, metres).
    ///
    /// The distance is drawn uniformly. A part that would leave the frame is moved to the nearest distance within the range at
    /// which it fits, and sideways as far as needed.
    pub fn draw(&self, mesh: &TriangleMesh, intrinsics: &Intrinsics, seed: u64) -> SampledPose {
        self.draw_moved_back(mesh, intrinsics, self.farthest, seed)
    }

    /// Like [`PoseRange::draw`], but a part that would leave the frame may be moved back beyond the range, up to `limit`.
    pub(super) fn draw_moved_back(
        &self,
        mesh: &TriangleMesh,
        intrinsics: &Intrinsics,
        limit: Metres,
        seed: u64,
    ) -> SampledPose {
        let mut random = Pcg64::seed_from_u64(seed ^ STREAM);
        let mut within = |limit: Radians| limit.0 * (2.0 * random.random::<f64>() - 1.0);
        let yaw = UnitQuaternion::from_axis_angle(&Vector3::y_axis(), within(self.yaw));
        let pitch = UnitQuaternion::from_axis_angle(&Vector3::x_axis(), within(self.pitch));
        let roll = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), within(self.roll));
        let rotation = roll * pitch * yaw;
        let drawn = self.nearest.0 + (self.farthest.0 - self.nearest.0) * random.random::<f64>();
        let wished = [
            MAX_OFF_AXIS_M * (2.0 * random.random::<f64>() - 1.0),
            MAX_OFF_AXIS_M * (2.0 * random.random::<f64>() - 1.0),
        ];

        let turned = mesh.placed_vertices(|p| rotation * p);
        let axes = [
            ShiftRange::new(&turned, 0, intrinsics.cx, intrinsics.fx, intrinsics.width),
            ShiftRange::new(&turned, 1, intrinsics.cy, intrinsics.fy, intrinsics.height),
        ];
        let fitting = axes
            .iter()
            .map(ShiftRange::nearest_fit)
            .fold(drawn, f64::max);
        let distance = fitting.min(limit.0);
        let [x, y] = [0, 1].map(|axis| axes[axis].shift(distance, wished[axis]));
        SampledPose {
            camera_from_part: RigidTransform::from_parts(
                Translation3::new(x, y, distance),
                rotation,
            ),
            fully_visible: fitting <= limit.0,
        }
    }
}

/// The allowed shifts along one image axis at distance d: `low_slope·d + low` to `high_slope·d + high`.
struct ShiftRange {
    low_slope: f64,
    low: f64,
    high_slope: f64,
    high: f64,
}

impl ShiftRange {
    fn new(
        turned: &[Point3<f64>],
        axis: usize,
        principal: f64,
        focal: f64,
        num_pixels: usize,
    ) -> Self {
        let low_slope = (MARGIN_PIXELS - principal) / focal;
        let high_slope = (num_pixels as f64 - 1.0 - MARGIN_PIXELS - principal) / focal;
        let (mut low, mut high) = (f64::NEG_INFINITY, f64::INFINITY);
        for p in turned {
            low = low.max(low_slope * p.z - p[axis]);
            high = high.min(high_slope * p.z - p[axis]);
        }
        Self {
            low_slope,
            low,
            high_slope,
            high,
        }
    }

    /// Returns the least distance at which the two bounds leave room.
    fn nearest_fit(&self) -> f64 {
        (self.low - self.high) / (self.high_slope - self.low_slope)
    }

    /// Returns the allowed shift nearest to `wished`; the middle of the bounds if none is allowed.
    fn shift(&self, distance: f64, wished: f64) -> f64 {
        let low = self.low_slope * distance + self.low;
        let high = self.high_slope * distance + self.high;
        if low <= high {
            wished.clamp(low, high)
        } else {
            0.5 * (low + high)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::part::{PartKind, PartModel, Side};

    fn inside(mesh: &TriangleMesh, pose: &RigidTransform, margin: f64) -> bool {
        let camera = Intrinsics::KINECT;
        mesh.vertices.iter().all(|p| {
            camera
                .pixel_of(&(pose * p.cast::<f64>()))
                .is_some_and(|(u, v)| {
                    u >= margin && v >= margin && u <= 639.0 - margin && v <= 479.0 - margin
                })
        })
    }

    #[test]
    fn every_part_fits_the_camera_at_the_far_end_whatever_its_roll() {
        for kind in PartKind::ALL {
            for model_seed in 0..4 {
                let part = PartModel::new(kind, Side::Left, model_seed);
                for seed in 0..12 {
                    let placed = PoseRange::placed().draw(part.mesh(), &Intrinsics::KINECT, seed);
                    assert!(
                        placed.fully_visible,
                        "{kind} model {model_seed} seed {seed}"
                    );
                    assert!(inside(
                        part.mesh(),
                        &placed.camera_from_part,
                        MARGIN_PIXELS - 1e-6
                    ));
                    let z = placed.camera_from_part.translation.z;
                    assert!((0.9..=1.8).contains(&z));
                }
            }
        }
    }

    #[test]
    fn a_part_that_cannot_fit_says_so() {
        let part = PartModel::new(PartKind::FrontBumper, Side::Left, 0);
        let range = PoseRange {
            farthest: Metres(0.9),
            ..PoseRange::placed()
        };
        let placed = range.draw(part.mesh(), &Intrinsics::KINECT, 3);
        assert!(!placed.fully_visible);
        assert!(!inside(part.mesh(), &placed.camera_from_part, 0.0));
    }

    #[test]
    fn a_small_part_keeps_its_drawn_distance_and_a_large_one_is_moved_no_farther_than_needed() {
        let part = PartModel::new(PartKind::FrontDoor, Side::Left, 0);
        let range = PoseRange {
            farthest: Metres(3.0),
            nearest: Metres(0.5),
            ..PoseRange::facing()
        };
        for seed in 0..20 {
            let placed = range
                .draw(part.mesh(), &Intrinsics::KINECT, seed)
                .camera_from_part;
            let mut nearer = placed;
            nearer.translation.z -= 0.01;
            let z = placed.translation.z;
            let moved = !inside(part.mesh(), &nearer, MARGIN_PIXELS);
            assert!(!moved || z < 1.9, "moved back to {z}");
        }
    }
}
