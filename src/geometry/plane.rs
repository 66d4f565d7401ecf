//! A plane in space: three points span it, many points fit it.

use nalgebra::{Point3, Vector3};

use super::principal::principal_axes;

/// The points p with `normal · p + offset = 0` (the paper's ax + by + cz + d = 0).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    /// Unit normal (a, b, c).
    pub normal: Vector3<f64>,
    /// The coefficient d, metres.
    pub offset: f64,
}

impl Plane {
    /// The plane through three points; `None` when they (nearly) lie on one line.
    pub fn through(a: &Point3<f64>, b: &Point3<f64>, c: &Point3<f64>) -> Option<Self> {
        let (ab, ac) = (b - a, c - a);
        let cross = ab.cross(&ac);
        // The sine of the angle at `a`: below 1e-3 the plane turns freely about the line.
        let flatness = ab.norm() * ac.norm();
        if !(cross.norm() > 1e-3 * flatness) || flatness <= 0.0 {
            return None;
        }
        let normal = cross.normalize();
        Some(Self {
            normal,
            offset: -normal.dot(&a.coords),
        })
    }

    /// The plane with the least sum of weighted squared distances to points; `None` below three points.
    pub fn fit(points: impl Iterator<Item = (Point3<f64>, f64)> + Clone) -> Option<Self> {
        let principal = principal_axes(points)?;
        let normal: Vector3<f64> = principal.axes.column(2).into_owned();
        Some(Self {
            normal,
            offset: -normal.dot(&principal.mean.coords),
        })
    }

    /// The same plane with its normal pointing to the side on which `point` lies.
    #[must_use]
    pub fn facing(self, point: &Point3<f64>) -> Self {
        if self.signed_distance(point) < 0.0 {
            Self {
                normal: -self.normal,
                offset: -self.offset,
            }
        } else {
            self
        }
    }

    /// Distance of a point in metres, above zero on the side that the normal points to.
    pub fn signed_distance(&self, point: &Point3<f64>) -> f64 {
        self.normal.dot(&point.coords) + self.offset
    }
}
