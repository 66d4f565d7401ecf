//! Clouds about their own middle: far from the origin `f32` would not resolve their points.

use nalgebra::Point3;

use super::{CloudRole, MIN_POINTS, PoseError};
use geometry::{
    cloud::PointCloud,
    principal::{PrincipalAxes, principal_axes},
    rigid::RigidTransform,
    units::Metres,
};

/// The finite points of a cloud that can fix a pose, about their own middle.
#[derive(Clone, Debug)]
pub(crate) struct Centred {
    pub(crate) points: Vec<Point3<f32>>,
    middle: Point3<f64>,
    pub(crate) axes: PrincipalAxes,
    /// Standard deviation along the widest axis, metres.
    pub(crate) extent: f64,
}

impl Centred {
    pub(crate) fn new(which: CloudRole, cloud: &PointCloud) -> Result<Self, PoseError> {
        let found = cloud.num_finite();
        if found < MIN_POINTS {
            return Err(PoseError::TooFewPoints {
                which,
                found,
                needed: MIN_POINTS,
            });
        }
        let (low, high) = cloud.bounds().unwrap_or_default();
        let middle: Point3<f64> = nalgebra::center(&low.cast::<f64>(), &high.cast::<f64>());
        let points: Vec<Point3<f32>> = cloud
            .finite()
            .map(|(_, p)| (p.cast::<f64>() - middle.coords).cast())
            .collect();
        let axes = principal_axes(points.iter().map(|p| (p.cast(), 1.0)));
        let axes = match axes {
            Some(axes) if axes.variances[1] > 1e-6 * axes.variances[0] => axes,
            // They lie on a line or a spot.
            other => {
                let width = other.map_or(0.0, |axes| axes.variances[1].sqrt());
                return Err(PoseError::Degenerate { which, width });
            }
        };
        let extent = axes.variances[0].sqrt();
        // Coordinates come with 24 binary digits: further out than this they are rounded to steps of half a per cent
        // of the cloud's own size.
        let farthest = low.coords.amax().max(high.coords.amax());
        if f64::from(farthest) * f64::from(f32::EPSILON) > 5e-3 * extent {
            return Err(PoseError::TooFarOut {
                which,
                distance: Metres(f64::from(farthest)),
            });
        }
        Ok(Self {
            points,
            middle,
            axes,
            extent,
        })
    }

    /// Takes the cloud's space into that about its middle.
    pub(crate) fn centring(&self) -> RigidTransform {
        RigidTransform::translation(-self.middle.x, -self.middle.y, -self.middle.z)
    }
}
