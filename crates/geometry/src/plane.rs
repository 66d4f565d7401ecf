//! A plane in space, through three points or fitted to many.

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
    /// Returns the plane through three points; `None` if they are (nearly) collinear.
    pub fn through(a: &Point3<f64>, b: &Point3<f64>, c: &Point3<f64>) -> Option<Self> {
        let (ab, ac) = (b - a, c - a);
        let cross = ab.cross(&ac);
        // The sine of the angle at `a`: below 1e-3 the plane's rotation about the line is undetermined.
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

    /// Fits the plane with the least sum of weighted squared distances to the points; `None` for fewer than three points.
    pub fn fit(points: impl Iterator<Item = (Point3<f64>, f64)> + Clone) -> Option<Self> {
        let principal = principal_axes(points)?;
        let normal: Vector3<f64> = principal.axes.column(2).into_owned();
        Some(Self {
            normal,
            offset: -normal.dot(&principal.mean.coords),
        })
    }

    /// Returns the plane with its normal on the side of `point`.
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

    /// Returns the signed distance of a point, metres; positive on the side of the normal.
    pub fn signed_distance(&self, point: &Point3<f64>) -> f64 {
        self.normal.dot(&point.coords) + self.offset
    }
}
