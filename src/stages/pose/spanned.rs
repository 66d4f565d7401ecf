//! Principal axes of clouds that can fix a pose.

use nalgebra::Point3;

use super::{CloudRole, MIN_POINTS, PoseError};
use crate::geometry::principal::{PrincipalAxes, principal_axes};

/// The principal axes of enough points that lie on more than a line.
pub(super) fn spanned_axes(
    which: CloudRole,
    points: &[Point3<f32>],
) -> Result<PrincipalAxes, PoseError> {
    if points.len() < MIN_POINTS {
        return Err(PoseError::TooFewPoints {
            which,
            found: points.len(),
            needed: MIN_POINTS,
        });
    }
    let axes = principal_axes(points.iter().map(|p| (p.cast(), 1.0)));
    match axes {
        Some(axes) if axes.variances[1] > 1e-6 * axes.variances[0] => Ok(axes),
        other => Err(PoseError::Degenerate {
            which,
            width: other.map_or(0.0, |axes| axes.variances[1].sqrt()),
        }),
    }
}
