//! Aligns two clouds of which nothing else is known: no outline, no view, perhaps no start.

use nalgebra::Point3;

use super::{
    CloudRole, PoseError, PoseEstimate, PoseMethod,
    centred::Centred,
    global::search,
    prepared::{Measured, PreparedTarget},
};
use crate::paper::{IcpGaParams, IcpParams, icp, icp_ga};
use geometry::{cloud::PointCloud, rigid::RigidTransform, statistics::sample_evenly};

/// Parameters of [`align_with`].
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(default)]
pub struct AlignParams {
    /// How the pose is estimated.
    pub method: PoseMethod,
    /// ICP alone.
    pub icp: IcpParams,
    /// ICP-GA.
    pub icp_ga: IcpGaParams,
}

impl From<PoseMethod> for AlignParams {
    fn from(method: PoseMethod) -> Self {
        Self {
            method,
            ..Self::default()
        }
    }
}

/// Aligns the source to the target, with the method's default parameters.
///
/// `initial` is a start; without one the global method searches everywhere, and ICP and ICP-GA begin with no
/// displacement.
pub fn align(
    source: &PointCloud,
    target: &PointCloud,
    method: PoseMethod,
    initial: Option<RigidTransform>,
) -> Result<PoseEstimate, PoseError> {
    align_with(source, target, &method.into(), initial, &|| false)
}

/// As [`align`], with the given parameters. Once the target is prepared, `is_cancelled` is called every few milliseconds.
pub fn align_with(
    source: &PointCloud,
    target: &PointCloud,
    params: &AlignParams,
    initial: Option<RigidTransform>,
    is_cancelled: &dyn Fn() -> bool,
) -> Result<PoseEstimate, PoseError> {
    let source = Centred::new(CloudRole::Source, source)?;
    let target = PreparedTarget::new(target)?;
    align_centred(&source, &target, params, initial, is_cancelled)
}

/// As [`align_with`], to a target that was prepared before.
pub fn align_to(
    source: &PointCloud,
    target: &PreparedTarget,
    params: &AlignParams,
    initial: Option<RigidTransform>,
    is_cancelled: &dyn Fn() -> bool,
) -> Result<PoseEstimate, PoseError> {
    let source = Centred::new(CloudRole::Source, source)?;
    align_centred(&source, target, params, initial, is_cancelled)
}

fn align_centred(
    source: &Centred,
    prepared: &PreparedTarget,
    params: &AlignParams,
    initial: Option<RigidTransform>,
    is_cancelled: &dyn Fn() -> bool,
) -> Result<PoseEstimate, PoseError> {
    let target = &prepared.centred;
    let (small, large) = (
        source.extent.min(target.extent),
        source.extent.max(target.extent),
    );
    if large > MOST_DIFFERENT * small {
        return Err(PoseError::SizesDiffer {
            ratio: large / small,
        });
    }
    let from_origin =
        |start: RigidTransform| target.centring() * start * source.centring().inverse();
    let no_turn = from_origin(RigidTransform::identity());
    let start = initial.map(from_origin);
    let by_points = || Measured {
        surface: &source.points,
        edges: Vec::new(),
        level: prepared.finest(),
        outline_error: 0.0,
    };
    let mut estimate = match params.method {
        PoseMethod::Icp => {
            let some = sample_evenly(&source.points, params.icp.max_source_points);
            let some: Vec<Point3<f32>> = some.copied().collect();
            let target = prepared.target();
            let start = start.unwrap_or(no_turn);
            let refined = icp(
                &some,
                &target.cloud.points,
                target.tree(),
                &start,
                &params.icp,
                is_cancelled,
            )?;
            prepared.estimate(by_points(), refined, PoseMethod::Icp, None)
        }
        PoseMethod::IcpGa => {
            let start = start.unwrap_or(no_turn);
            let (refined, runner_up) =
                icp_ga(source, prepared, &start, &params.icp_ga, is_cancelled)?;
            prepared.estimate(by_points(), refined, PoseMethod::IcpGa, runner_up)
        }
        PoseMethod::Global => search(source, prepared, no_turn, start, is_cancelled)?,
    };
    let (back, there) = (target.centring().inverse(), source.centring());
    estimate.in_other_spaces(|pose| back * pose * there);
    Ok(estimate)
}

/// A cloud whose size is another one's times this is of another thing, or in other units.
const MOST_DIFFERENT: f64 = 50.0;

#[cfg(test)]
mod tests;
