//! Patches of a part without readings: the shadow in a door's handle recess, a slot, the reflection of a lamp.

use nalgebra::{Point2, Point3, Vector3};
use rand::RngExt as _;
use rand_pcg::Pcg64;

use crate::{
    cell::SimulatedObject,
    part::{PartKind, Side},
};
use geometry::{depth_frame::Intrinsics, rigid::RigidTransform};

/// Elongated patches in the picture.
pub(super) struct SpecularDropout(Vec<Patch>);

/// A line with a thickness, in pixels.
struct Patch {
    from: Point2<f64>,
    to: Point2<f64>,
    radius: f64,
}

/// How far the noise moves a patch's edge, as a share of its radius.
const RAGGED: f64 = 0.45;

impl SpecularDropout {
    pub(super) fn none() -> Self {
        Self(Vec::new())
    }

    /// Draws up to three patches on the visible surface of the part, and for doors usually the handle.
    pub(super) fn draw(
        subject: SimulatedObject,
        seen: &[Point3<f64>],
        camera_from_part: &RigidTransform,
        camera: &Intrinsics,
        random: &mut Pcg64,
    ) -> Self {
        let mut patches = Vec::new();
        let mut add = |middle: Point3<f64>, along: Vector3<f64>, radius: f64| {
            let ends = [middle - along, middle + along].map(|p| camera.pixel_of(&p));
            if let [Some(from), Some(to)] = ends {
                patches.push(Patch {
                    from: Point2::new(from.0, from.1),
                    to: Point2::new(to.0, to.1),
                    radius: radius * camera.fx / middle.z,
                });
            }
        };
        if let Some(handle) = handle_of(subject)
            && random.random_bool(0.7)
        {
            let middle = camera_from_part * handle;
            let along = camera_from_part * Vector3::x() * random.random_range(0.05..0.1);
            add(middle, along, random.random_range(0.006..0.016));
        }
        let num_patches = [0, 0, 1, 1, 2, 3][random.random_range(0..6)];
        for _ in 0..num_patches {
            let Some(place) = seen.get(random.random_range(0..seen.len().max(1))) else {
                break;
            };
            let middle = place + camera_from_part.translation.vector;
            let slant = random.random_range(-0.3..0.3);
            let along = camera_from_part * Vector3::new(1.0, slant, 0.0);
            let half_length = random.random_range(0.01..0.08);
            add(
                middle,
                along * half_length,
                random.random_range(0.003..0.012),
            );
        }
        Self(patches)
    }

    /// Returns true if the reading at a pixel is lost. `noise` of unit variance makes the edges ragged.
    pub(super) fn takes(&self, u: f64, v: f64, noise: f64) -> bool {
        self.0.iter().any(|patch| {
            let p = Point2::new(u, v);
            let (along, to_p) = (patch.to - patch.from, p - patch.from);
            let share = (to_p.dot(&along) / along.norm_squared().max(1e-9)).clamp(0.0, 1.0);
            let distance = (to_p - along * share).norm();
            distance < patch.radius * (1.0 + RAGGED * noise)
        })
    }
}

/// Returns the middle of a door's handle, in part space.
fn handle_of(subject: SimulatedObject) -> Option<Point3<f64>> {
    let SimulatedObject::Part { kind, side, .. } = subject else {
        return None;
    };
    let (x, y) = match kind {
        PartKind::FrontDoor => (0.405, 0.015),
        PartKind::BackDoor => (0.34, -0.01),
        _ => return None,
    };
    let x = match side {
        Side::Left => x,
        Side::Right => -x,
    };
    Some(Point3::new(x, y, 0.0))
}
