//! Locates a scene's part as the paper does, starting from the standard position.

use nalgebra::Point3;

use super::{
    pose::{
        AlignParams, PoseError, PoseEstimate, align_to,
        closest::Correspondence,
        quality::{FitQuality, NUM_LOOKED_FOR, Tolerance, look_for, measure_fit},
        refine::Search,
    },
    reference::Reference,
    scene::SceneCloud,
    segment::SegmentedPart,
};
use geometry::{statistics::sample_evenly, units::Metres};

/// Number of points used to measure a fit.
const NUM_MEASURED: usize = 5000;

/// Estimates the pose of a scene's part with ICP or ICP-GA, starting from the standard position.
pub fn locate(
    part: &SegmentedPart,
    reference: &Reference,
    scene: &SceneCloud,
    params: &AlignParams,
    is_cancelled: &dyn Fn() -> bool,
) -> Result<PoseEstimate, PoseError> {
    let target = reference.target(0).ok_or(PoseError::NoReferenceCloud)?;
    let mut estimate = align_to(&part.cloud, reference.whole()?, params, None, is_cancelled)?;
    let measured = sample_evenly(&part.cloud.points, NUM_MEASURED);
    let measured: Vec<Point3<f32>> = measured.copied().collect();
    let tolerance = Tolerance {
        base: Metres::from_mm(10.0),
        noise_at_1m: part.noise_at_1m,
    };
    let pose = &estimate.target_from_source;
    let closest = Correspondence::of_each(&measured, &target, pose, Search::Tree);
    estimate.fit = FitQuality {
        sight: look_for(&target, &pose.inverse(), scene, tolerance, NUM_LOOKED_FOR),
        ..measure_fit(&measured, &closest, &target, tolerance)
    };
    Ok(estimate)
}
