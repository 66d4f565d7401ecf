//! What tests of this crate and of those above it build.

use nalgebra::Point3;
use proptest::prelude::*;

use crate::{
    cloud::PointCloud,
    depth_frame::{DepthFrame, Intrinsics},
    rigid::RigidTransform,
};

/// A small captured frame with these depths in millimetres.
pub fn small_frame(width: usize, depth: impl IntoIterator<Item = u16>) -> DepthFrame {
    let depth: Vec<u16> = depth.into_iter().collect();
    DepthFrame {
        intrinsics: Intrinsics {
            width,
            height: depth.len() / width,
            ..Intrinsics::KINECT
        },
        metres_per_unit: 0.001,
        depth,
        is_simulated: false,
    }
}

/// The cloud's points, transformed.
pub fn moved(cloud: &PointCloud, by: &RigidTransform) -> PointCloud {
    PointCloud::from_points(cloud.points.iter().map(|p| (by * p.cast::<f64>()).cast()))
}

/// Generates points at most 1 m from the origin along each axis.
pub fn any_point() -> impl Strategy<Value = Point3<f32>> {
    prop::array::uniform3(-1.0_f32..1.0).prop_map(Point3::from)
}
