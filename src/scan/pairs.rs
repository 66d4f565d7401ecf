//! Pairs of readings of two shots that should lie on one surface, found by projection.
//!
//! A reading of one shot is projected into the picture of the other, and paired with what that shows (G. Blais and
//! M. D. Levine, "Registering multiview range data to create 3D computer objects", IEEE PAMI 17(8), 1995). With poses
//! known to millimetres this finds nearly the closest point, by one look-up.

use nalgebra::{Point3, Vector3};

use super::surface::{ShotSurface, Use};
use crate::geometry::rigid::RigidTransform;

/// A shot as the registration sees it.
#[derive(Clone, Copy, Debug)]
pub(super) struct RegistrationShot<'a> {
    pub(super) surface: &'a ShotSurface,
    pub(super) base_from_camera: RigidTransform,
    /// Some of its readings on a surface, spread over the picture.
    pub(super) samples: &'a [u32],
}

/// Readings of two shots that should lie on one surface, in the base frame.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pair {
    pub(super) from: Point3<f64>,
    /// Where the other shot sees the surface.
    pub(super) to: Point3<f64>,
    /// Unit normal there.
    pub(super) normal: Vector3<f64>,
    /// Standard deviation of the distance along the normal, from both readings.
    pub(super) sigma: f64,
}

impl Pair {
    /// Signed distance to the other shot's surface, metres.
    pub(super) fn off(&self) -> f64 {
        self.normal.dot(&(self.to - self.from))
    }
}

/// What the other shot shows where a reading should be.
#[derive(Clone, Copy, Debug)]
pub(super) enum ProjectedReading {
    /// A surface within reach that faces the same way.
    Pair(Pair),
    /// The other camera looks through the place, to a surface beyond reach.
    Through,
    /// Nothing that says anything: outside, hidden, no reading, or beside a discontinuity.
    Nothing,
}

/// Normals that differ by more than some 45° are of two surfaces.
const SAME_FACING: f32 = 0.7;

/// How far apart two readings of one surface may be.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reach {
    /// Metres.
    pub(super) least: f64,
    /// Standard deviations of their distance, if that is more.
    pub(super) sigmas: f64,
}

/// Projects one reading of a shot into another.
pub(super) fn meet(
    from: &ShotSurface,
    i: usize,
    to: &ShotSurface,
    to_from: &RigidTransform,
    base_from_to: &RigidTransform,
    reach: Reach,
) -> ProjectedReading {
    let at = to_from * from.points[i].cast::<f64>();
    let Some((column, row)) = to.pixel(&at) else {
        return ProjectedReading::Nothing;
    };
    let Some(j) = to.reading(column, row) else {
        return ProjectedReading::Nothing;
    };
    if to.uses[j] != Use::Surface {
        return ProjectedReading::Nothing;
    }
    let seen = to.points[j].cast::<f64>();
    let normal = to.normals[j];
    let own = to_from.rotation * from.normals[i].cast::<f64>();
    let faces = own.cast::<f32>().dot(&normal) > SAME_FACING;
    let sigma = from.sigma(i).hypot(to.sigma(j));
    let reach = reach.least.max(reach.sigmas * sigma);
    if (seen - at).norm() < reach && faces {
        return ProjectedReading::Pair(Pair {
            from: base_from_to * at,
            to: base_from_to * seen,
            normal: base_from_to.rotation * normal.cast::<f64>(),
            sigma,
        });
    }
    // A surface that is seen from behind, or edge-on, would not be seen at all.
    let would_be_seen = -own.dot(&at.coords) > 0.3 * at.coords.norm();
    if seen.z - at.z > reach && would_be_seen {
        ProjectedReading::Through
    } else {
        ProjectedReading::Nothing
    }
}
