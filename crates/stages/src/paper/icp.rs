//! Iterative closest point, point to point, as the paper uses it (eq. 12 and 13).
//!
//! P. J. Besl and N. D. McKay, "A method for registration of 3-D shapes", IEEE Transactions on Pattern Analysis and
//! Machine Intelligence 14(2), 1992: pair every source point with its closest target point, move the source by the
//! rigid transform with the least squared distance, repeat. It finds the nearest valley of E, not the deepest.

use nalgebra::Point3;

use crate::pose::{Iteration, Phase, PoseError, Stopped, refine::Refined};
use geometry::{
    nearest::KdTree,
    rigid::{RigidTransform, fit_rigid},
    units::{Metres, Radians},
};

/// Parameters of ICP.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(default)]
pub struct IcpParams {
    /// Most iterations, 1..1000.
    pub max_iterations: usize,
    /// E below which Algorithm 3 stops, square metres, 0..0.001; the paper's 1e-6 is 1 mm rms.
    pub target_e_m2: f64,
    /// Source points used, thinned evenly; 100..1 000 000. Raising it costs time in proportion.
    pub max_source_points: usize,
    /// A step that shifts by less than this, 0..10 mm, and turns little ends the search.
    pub shift_tolerance: Metres,
    /// A step that turns by less than this, 0..5°, and shifts little ends the search.
    pub turn_tolerance: Radians,
}

impl Default for IcpParams {
    fn default() -> Self {
        Self {
            max_iterations: 100,
            target_e_m2: 1e-6,
            max_source_points: 5000,
            // A hundredth of the pose accuracy asked of a paint robot.
            shift_tolerance: Metres::from_mm(0.01),
            turn_tolerance: Radians::from_degrees(0.001),
        }
    }
}

/// Aligns the source to the target's points from a start.
pub(crate) fn icp(
    source: &[Point3<f32>],
    target: &[Point3<f32>],
    target_tree: &KdTree,
    start: &RigidTransform,
    params: &IcpParams,
    is_cancelled: &dyn Fn() -> bool,
) -> Result<Refined, PoseError> {
    let mut pose = *start;
    let mut iterations = Vec::new();
    let mut stopped = Stopped::IterationLimit;
    let mut pairs: Vec<(Point3<f64>, Point3<f64>)> = Vec::with_capacity(source.len());
    let mut closest: Vec<Option<usize>> = vec![None; source.len()];
    for _ in 0..params.max_iterations {
        if is_cancelled() {
            return Err(PoseError::Cancelled);
        }
        let moved = pose.cast::<f32>();
        pairs.clear();
        let mut sum_sq = 0.0;
        for (p, closest) in source.iter().zip(&mut closest) {
            let at = moved * p;
            // Nothing farther away than the closest point of the step before needs to be looked at.
            let mut distance_sq =
                closest.map_or(f32::INFINITY, |before| (target[before] - at).norm_squared());
            if let Some(closer) = target_tree.nearest(&at, distance_sq) {
                *closest = Some(closer.index);
                distance_sq = closer.distance_sq;
            }
            if let Some(index) = *closest {
                sum_sq += f64::from(distance_sq);
                pairs.push((p.cast(), target[index].cast()));
            }
        }
        // Eq. (12)
        let e_m2 = sum_sq / pairs.len().max(1) as f64;
        iterations.push(Iteration {
            phase: Phase::Icp,
            e_m2,
            target_from_source: pose,
            num_pairs: pairs.len(),
        });
        if e_m2 < params.target_e_m2 {
            stopped = Stopped::BelowThreshold;
            break;
        }
        // Eq. (13), from the source as it was given: errors of single steps do not add up.
        // All pairs on one spot: the target is one, or the source lies so far off that one corner is closest to all.
        let next = fit_rigid(pairs.iter().copied()).ok_or(PoseError::OneSidedPairs {
            num_pairs: pairs.len(),
            rms: Metres(e_m2.sqrt()),
        })?;
        let turned = next.rotation.angle_to(&pose.rotation);
        let shifted = (next.translation.vector - pose.translation.vector).norm();
        pose = next;
        if turned < params.turn_tolerance.0 && shifted < params.shift_tolerance.0 {
            stopped = Stopped::Converged;
            break;
        }
    }
    Ok(Refined {
        target_from_source: pose,
        iterations,
        stopped,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use geometry::rigid::{from_euler_zyx, pose_error};

    /// A bent sheet with a notch: nothing about it is symmetric.
    fn sheet() -> Vec<Point3<f32>> {
        (0..2500)
            .map(|i| ((i % 50) as f32 / 50.0, (i / 50) as f32 / 70.0))
            .filter(|(u, v)| !(*u > 0.6 && *v > 0.5))
            .map(|(u, v)| Point3::new(u, v, 0.3 * u * u + 0.1 * (5.0 * v).sin() * u))
            .collect()
    }

    #[test]
    fn a_small_displacement_is_undone_both_ways_round() {
        let target = sheet();
        let tree = KdTree::new(&target);
        // Within half the spacing of the points: beyond it the closest points of a nearly flat sheet mislead.
        let truth = from_euler_zyx([0.012, -0.008, 0.01, 0.003, -0.002, 0.004]);
        for truth in [truth, truth.inverse()] {
            let back = truth.inverse().cast::<f32>();
            let source: Vec<_> = target.iter().map(|p| back * p).collect();
            let params = IcpParams {
                target_e_m2: 1e-12,
                ..IcpParams::default()
            };
            let run = icp(
                &source,
                &target,
                &tree,
                &RigidTransform::identity(),
                &params,
                &|| false,
            )
            .expect("a pose");
            let error = pose_error(&run.target_from_source, &truth, &Point3::new(0.5, 0.3, 0.1));
            assert!(
                error.rotation.degrees() < 0.01 && error.shift.mm() < 0.1,
                "{error:?}"
            );
            for pair in run.iterations.windows(2) {
                assert!(pair[1].e_m2 <= pair[0].e_m2 * (1.0 + 1e-6), "E never grows");
            }
        }
    }

    #[test]
    fn a_single_point_as_target_is_degenerate() {
        let target = vec![Point3::new(0.0, 0.0, 1.0); 20];
        let tree = KdTree::new(&target);
        let found = icp(
            &sheet(),
            &target,
            &tree,
            &RigidTransform::identity(),
            &IcpParams::default(),
            &|| false,
        );
        assert!(matches!(found, Err(PoseError::OneSidedPairs { .. })));
    }
}
