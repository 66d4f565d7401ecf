//! Pairs of readings from two shots that should lie on one surface, found by projection.
//!
//! A reading of one shot is projected into the picture of the other and paired with the reading there (G. Blais and
//! M. D. Levine, "Registering multiview range data to create 3D computer objects", IEEE PAMI 17(8), 1995). With poses
//! known to millimetres this finds nearly the closest point with one look-up.

use nalgebra::{Point3, Vector3};

use super::surface::ShotSurface;
use geometry::rigid::RigidTransform;

/// The input of the registration from one shot.
#[derive(Clone, Copy, Debug)]
pub(super) struct RegistrationShot<'a> {
    pub(super) surface: &'a ShotSurface,
    pub(super) base_from_camera: RigidTransform,
    /// Indices of some readings on a surface, spread over the picture.
    pub(super) samples: &'a [u32],
}

/// Readings of two shots that should lie on one surface, in the base frame.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pair {
    pub(super) from: Point3<f64>,
    /// The other shot's reading.
    pub(super) to: Point3<f64>,
    /// Unit normal at `to`.
    pub(super) normal: Vector3<f64>,
    /// Standard deviation of the distance along the normal, from the noise of both readings, in metres.
    pub(super) sigma: f64,
}

impl Pair {
    /// Returns the signed distance to the other shot's surface, in metres.
    pub(super) fn off(&self) -> f64 {
        self.normal.dot(&(self.to - self.from))
    }
}

/// The other shot's reading at the place of a projected one.
#[derive(Clone, Copy, Debug)]
pub(super) enum ProjectedReading {
    /// A surface within reach that faces the same way.
    Pair(Pair),
    /// The other camera looks through the place to a surface beyond reach.
    Through,
    /// No information: outside the picture, hidden, no reading, or beside a discontinuity.
    Nothing,
}

/// Least cosine between two normals of one surface, about 45°.
const SAME_FACING_MIN_COSINE: f32 = 0.7;

/// The largest distance between two readings of one surface: the larger of the two limits.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reach {
    /// Metres.
    pub(super) least: f64,
    /// Multiples of the standard deviation of their distance.
    pub(super) sigmas: f64,
}

/// Projects one reading of a shot into another shot.
pub(super) fn meet(
    from: &ShotSurface,
    i: usize,
    to: &ShotSurface,
    to_from: &RigidTransform,
    base_from_to: &RigidTransform,
    reach: Reach,
) -> ProjectedReading {
    let at = to_from * from.points()[i].cast::<f64>();
    let Some((column, row)) = to.pixel(&at) else {
        return ProjectedReading::Nothing;
    };
    let Some(j) = to.surface_reading(column, row) else {
        return ProjectedReading::Nothing;
    };
    let seen = to.points()[j].cast::<f64>();
    let normal = to.normal(j);
    let own = to_from.rotation * from.normal(i).cast::<f64>();
    let faces = own.cast::<f32>().dot(&normal) > SAME_FACING_MIN_COSINE;
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
    // A surface seen from behind or edge-on would not yield a reading.
    let would_be_seen = -own.dot(&at.coords) > 0.3 * at.coords.norm();
    if seen.z - at.z > reach && would_be_seen {
        ProjectedReading::Through
    } else {
        ProjectedReading::Nothing
    }
}
