//! A scene's part put in its place by Algorithm 3.

use nalgebra::Point3;

use super::{FAR_OFF, IcpGaParams, icp_ga};
use crate::{
    geometry::{nearest_field::NearestField, rigid::RigidTransform},
    stages::{
        pose::{
            PoseError, PoseEstimate, PoseMethod,
            quality::{Fit, Tolerance, look_for, measure_fit},
            refine::{Search, Target},
            spanned::spanned_axes,
        },
        reference::Reference,
        scene::SceneCloud,
        segment::SegmentedPart,
    },
    units::Metres,
};

/// The pose of a scene's part by Algorithm 3, from the standard position, that is from no displacement.
pub fn locate_by_icp_ga(
    part: &SegmentedPart,
    reference: &Reference,
    scene: &SceneCloud,
    params: &IcpGaParams,
    is_cancelled: &dyn Fn() -> bool,
) -> Result<PoseEstimate, PoseError> {
    let target = reference.target(0).ok_or(PoseError::NoReferenceCloud)?;
    // The reference's own field answers near its surface only: the confirmation starts from placements.
    let points = &target.cloud.points;
    let extent = spanned_axes("target", points)?.variances[0].sqrt();
    let cell = (2.0 * target.spacing).max(extent / 60.0) as f32;
    let field = NearestField::new(points, cell, (FAR_OFF * extent) as f32);
    let target = Target {
        field: &field,
        ..target
    };
    let source = &part.cloud.points;
    let run = icp_ga(
        source,
        &target,
        &RigidTransform::identity(),
        params,
        is_cancelled,
    )?;
    let tolerance = Tolerance {
        base: Metres::from_mm(10.0),
        noise_at_1m: part.noise_at_1m,
    };
    let measured: Vec<Point3<f32>> = source
        .iter()
        .step_by(source.len().div_ceil(NUM_MEASURED).max(1))
        .copied()
        .collect();
    let pose = run.target_from_source;
    let fit = Fit {
        sight: look_for(&target, &pose.inverse(), scene, tolerance),
        ..measure_fit(&measured, &target, &pose, tolerance, Search::Tree)
    };
    Ok(PoseEstimate {
        target_from_source: pose,
        method: PoseMethod::IcpGa,
        stopped: run.stopped,
        iterations: run.iterations,
        fit,
        runner_up: run.runner_up,
    })
}

/// Points on which the figures of a fit are taken.
const NUM_MEASURED: usize = 5000;
