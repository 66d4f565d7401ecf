//! What tests of this crate and of those above it build.

use nalgebra::Point3;
use proptest::prelude::*;

use crate::{
    cloud::PointCloud,
    depth_frame::{DepthFrame, Intrinsics},
    rigid::RigidTransform,
};

/// Reports that a test checks nothing for want of something; fails where this environment variable is `1`.
#[expect(
    clippy::print_stdout,
    reason = "a test that checks nothing must say so"
)]
pub fn skipped(variable: &str, what: impl std::fmt::Display) {
    let is_required = std::env::var_os(variable).is_some_and(|value| value == "1");
    assert!(!is_required, "{variable}=1, and skipped: {what}");
    println!("skipped: {what}");
}

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
