//! Locates a scene's part as the paper does, starting from the standard position, and measures the pose as every other one
//! is: bounds and scale take in the outline, which ICP and ICP-GA ignore.

use nalgebra::Point3;

use super::{
    confirm::{Scene, bounds_and_scale, facing_view},
    pose::{
        AlignParams, PoseError, PoseEstimate, align_to,
        closest::Correspondence,
        quality::{FitQuality, NUM_LOOKED_FOR, PIXEL_REACH, Tolerance, look_for, measure_fit},
        refine::Search,
    },
    reference::Reference,
};
use geometry::{rigid::RigidTransform, statistics::sample_evenly, units::Metres};

/// Number of points used to measure a fit.
const NUM_MEASURED: usize = 5000;

/// Seed for thinning the points of which bounds and scale are taken.
const SEED: u64 = 1;

/// A pose by ICP or ICP-GA.
#[derive(Clone, Debug, PartialEq)]
pub struct Located {
    /// The pose.
    pub pose: PoseEstimate,
    /// How well the best other pose fits, 0..1, in the measure of [`FitQuality::score`]; 0 if no other was found.
    pub rival: f64,
}

/// Estimates the pose of a scene's part with ICP or ICP-GA, starting from the standard position.
pub fn locate(
    scene: &Scene<'_>,
    reference: &Reference,
    params: &AlignParams,
    is_cancelled: &dyn Fn() -> bool,
) -> Result<Located, PoseError> {
    let part = scene.part;
    let mut pose = align_to(&part.cloud, reference.whole()?, params, None, is_cancelled)?;
    let measured = sample_evenly(&part.cloud.points, NUM_MEASURED);
    let measured: Vec<Point3<f32>> = measured.copied().collect();
    let tolerance = Tolerance {
        base: Metres::from_mm(10.0),
        noise_at_1m: part.noise_at_1m,
    };
    let fit_at = |pose: &RigidTransform| {
        let target = reference.target(facing_view(reference, pose));
        let target = target.ok_or(PoseError::NoReferenceCloud)?;
        let closest = Correspondence::of_each(&measured, &target, pose, Search::Tree);
        let seen_from = pose.inverse();
        Ok(FitQuality {
            sight: look_for(
                &target,
                &seen_from,
                scene.scene,
                tolerance,
                NUM_LOOKED_FOR,
                PIXEL_REACH,
            ),
            ..measure_fit(&measured, &closest, &target, tolerance)
        })
    };
    pose.fit = fit_at(&pose.target_from_source)?;
    if let Some((bounds, scale)) =
        bounds_and_scale(scene, reference, &pose.target_from_source, SEED)
    {
        (pose.uncertainty, pose.scale) = (Some(bounds), scale);
    }
    let rival = pose
        .runner_up
        .map(|other| fit_at(&other.target_from_source))
        .transpose()?;
    Ok(Located {
        rival: rival.map_or(0.0, |fit| fit.score()),
        pose,
    })
}
