//! Aligns two clouds of which nothing else is known: no outline, no view, perhaps no start.

use nalgebra::Point3;

use super::{
    MIN_POINTS, PoseError, PoseEstimate, PoseMethod,
    global::{PreparedTarget, starts},
    icp::{IcpParams, icp},
    refine::Refined,
};
use crate::geometry::{
    cloud::PointCloud,
    nearest::KdTree,
    principal::{PrincipalAxes, principal_axes},
    rigid::RigidTransform,
};

/// Aligns the source to the target: `target_from_source`.
///
/// `initial` is a start; without one the global method searches everywhere and ICP begins with no displacement.
pub fn align(
    source: &PointCloud,
    target: &PointCloud,
    method: PoseMethod,
    initial: Option<RigidTransform>,
) -> Result<PoseEstimate, PoseError> {
    let source = finite_points("source", source)?;
    let target = finite_points("target", target)?;
    let source_axes = spanned_axes("source", &source)?;
    let target_axes = spanned_axes("target", &target)?;
    let prepared = PreparedTarget::new(&target);
    match method {
        PoseMethod::Icp => {
            let params = IcpParams::default();
            let step = source.len().div_ceil(params.max_source_points).max(1);
            let thinned: Vec<Point3<f32>> = source.iter().step_by(step).copied().collect();
            let start = initial.unwrap_or_else(RigidTransform::identity);
            let tree = KdTree::new(&target);
            let run = icp(&thinned, &target, &tree, &start, &params)?;
            let refined = Refined {
                target_from_source: run.target_from_source,
                iterations: run.iterations,
                stopped: run.stopped,
            };
            Ok(prepared.estimate(&source, refined, PoseMethod::Icp, None))
        }
        PoseMethod::Global => {
            let starts = match initial {
                Some(start) => vec![start],
                None => starts(&source_axes, &target_axes),
            };
            prepared.search(&source, &starts)
        }
    }
}

fn finite_points(which: &'static str, cloud: &PointCloud) -> Result<Vec<Point3<f32>>, PoseError> {
    let points: Vec<Point3<f32>> = cloud.finite().map(|(_, p)| *p).collect();
    if points.len() < MIN_POINTS {
        return Err(PoseError::TooFewPoints {
            which,
            found: points.len(),
            needed: MIN_POINTS,
        });
    }
    Ok(points)
}

/// The principal axes of points that lie on more than a line.
fn spanned_axes(which: &'static str, points: &[Point3<f32>]) -> Result<PrincipalAxes, PoseError> {
    let axes = principal_axes(points.iter().map(|p| (p.cast(), 1.0)));
    match axes {
        Some(axes) if axes.variances[1] > 1e-6 * axes.variances[0] => Ok(axes),
        other => Err(PoseError::Degenerate {
            which,
            width: other.map_or(0.0, |axes| axes.variances[1].sqrt()),
        }),
    }
}

#[cfg(test)]
mod tests {
    use rand::{RngExt as _, SeedableRng as _};
    use rand_pcg::Pcg64;

    use super::*;
    use crate::geometry::rigid::{from_euler_zyx, pose_error};

    /// A bent sheet with a notch: nothing about it is symmetric, and its points lie on no lattice that could slide
    /// onto itself.
    fn sheet() -> PointCloud {
        let mut rng = Pcg64::seed_from_u64(7);
        let points: Vec<Point3<f32>> = (0..5000)
            .map(|_| (rng.random::<f32>(), 0.8 * rng.random::<f32>()))
            .filter(|(u, v)| !(*u > 0.6 && *v > 0.5))
            .map(|(u, v)| Point3::new(u, v, 0.3 * u * u + 0.1 * (5.0 * v).sin() * u))
            .collect();
        PointCloud::from_points(points)
    }

    fn moved(cloud: &PointCloud, by: &RigidTransform) -> PointCloud {
        PointCloud::from_points(cloud.points.iter().map(|p| (by * p.cast::<f64>()).cast()))
    }

    #[test]
    fn a_displaced_copy_is_found_from_anywhere_both_ways_round() {
        let target = sheet();
        for start in [
            [1.57, 0.0, 0.0, 0.8, 0.0, 0.5],
            [3.1, 1.2, -2.0, -0.4, 0.7, 0.1],
            [0.2, -1.4, 2.9, 0.1, -0.6, 2.0],
        ] {
            let truth = from_euler_zyx(start);
            for truth in [truth, truth.inverse()] {
                let source = moved(&target, &truth.inverse());
                let found = align(&source, &target, PoseMethod::Global, None).expect("a pose");
                let centre = truth.inverse() * Point3::new(0.5, 0.3, 0.1);
                let error = pose_error(&found.target_from_source, &truth, &centre);
                assert!(
                    error.rotation.degrees() < 0.01 && error.shift.mm() < 0.1,
                    "{error:?} from {start:?}"
                );
                assert!(!found.is_ambiguous());
            }
        }
    }

    #[test]
    fn the_same_clouds_give_the_same_bits() {
        let target = sheet();
        let source = moved(&target, &from_euler_zyx([0.4, 0.3, -1.0, 0.1, 0.2, 0.3]));
        let run = || align(&source, &target, PoseMethod::Global, None).expect("a pose");
        assert_eq!(run(), run());
    }

    #[test]
    fn clouds_that_fix_no_pose_get_a_named_error() {
        let sheet = sheet();
        let line = PointCloud::from_points((0..100).map(|i| Point3::new(i as f32, 0.0, 0.0)));
        let spot = PointCloud::from_points((0..100).map(|_| Point3::new(1.0, 2.0, 3.0)));
        let few =
            PointCloud::from_points((0..3).map(|i| Point3::new(i as f32, (i * i) as f32, 0.0)));
        let empty = PointCloud::default();
        for method in [PoseMethod::Global, PoseMethod::Icp] {
            for bad in [&line, &spot] {
                assert!(matches!(
                    align(bad, &sheet, method, None),
                    Err(PoseError::Degenerate {
                        which: "source",
                        ..
                    })
                ));
                assert!(matches!(
                    align(&sheet, bad, method, None),
                    Err(PoseError::Degenerate {
                        which: "target",
                        ..
                    })
                ));
            }
            for bad in [&few, &empty] {
                assert!(matches!(
                    align(bad, &sheet, method, None),
                    Err(PoseError::TooFewPoints {
                        which: "source",
                        ..
                    })
                ));
                assert!(matches!(
                    align(&sheet, bad, method, None),
                    Err(PoseError::TooFewPoints {
                        which: "target",
                        ..
                    })
                ));
            }
        }
    }
}
