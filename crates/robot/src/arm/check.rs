//! Checks a path against an arm.

use nalgebra::Translation3;

use super::{
    ArmError, ArmPoint, CheckParams, PathCheck, PlacedArm,
    chain::{UPRIGHT, angle_of, nozzle_at, turns_of},
    check_points::check_points,
    kinematics::Solver,
    problem::PointProblem,
    validate::validate,
};

/// Finds the joints for every point of the path, or the problem there. Points without a problem are reached one after
/// the other by straight moves at their speed; with the gun off, more slowly or by joint moves where that is needed.
/// With an approach distance, the moves to and from the path are checked as well; their problems are reported at the first
/// and the last point.
pub fn check_path(
    placed: &PlacedArm,
    points: &[ArmPoint],
    params: &CheckParams<'_>,
) -> Result<PathCheck, ArmError> {
    check_unless(&|| false, placed, points, params)
}

/// As [`check_path`], but returns [`ArmError::Cancelled`] soon after `is_cancelled` returns true.
pub(super) fn check_unless(
    is_cancelled: &(dyn Fn() -> bool + Sync),
    placed: &PlacedArm,
    points: &[ArmPoint],
    params: &CheckParams<'_>,
) -> Result<PathCheck, ArmError> {
    // Before the ends are added, so that an error counts the path's own points.
    validate(placed, points, params)?;
    let ends = params.approach.and_then(|away| ends_of(points, away));
    let Some([approach, retreat]) = ends else {
        let points = check_points(is_cancelled, placed, points, params)?;
        return Ok(PathCheck { points, ends: None });
    };
    let mut all = vec![approach];
    all.extend(points);
    // The gun is off behind the last point, whatever the path says.
    if let Some(last) = all.last_mut() {
        last.is_gun_on = false;
    }
    all.push(retreat);
    let mut points = check_points(is_cancelled, placed, &all, params)?;
    let retreat = points.pop();
    let approach = points.remove(0);
    if let (Some(last), Some(retreat)) = (points.last_mut(), &retreat) {
        last.problem = graver(last.problem.take(), retreat.problem.clone());
    }
    if let Some(first) = points.first_mut() {
        first.problem = graver(first.problem.take(), approach.problem.clone());
    }
    let ends = retreat.map(|retreat| [approach, retreat]);
    Ok(PathCheck { points, ends })
}

/// The approach point and the end of a program, this far behind the first and the last point of its path.
pub(super) fn ends_of(points: &[ArmPoint], distance: f64) -> Option<[ArmPoint; 2]> {
    let away = Translation3::new(0.0, 0.0, -distance);
    let behind = |point: &ArmPoint| ArmPoint {
        robot_from_nozzle: point.robot_from_nozzle * away,
        is_gun_on: false,
        ..*point
    };
    Some([behind(points.first()?), behind(points.last()?)])
}

/// Returns the problem to report: a collision takes precedence.
fn graver(own: Option<PointProblem>, other: Option<PointProblem>) -> Option<PointProblem> {
    if matches!(other, Some(PointProblem::Collision { .. })) {
        other
    } else {
        own.or(other)
    }
}

/// Whether a point can be reached at some turn without a collision.
pub(super) fn is_reached(solver: &Solver<'_>, point: &ArmPoint, num_turns: usize) -> bool {
    /// If the first few solutions collide, the others usually do as well, and there are hundreds of places to compare.
    const NUM_TESTED: usize = 6;
    let poses =
        turns_of(point, num_turns).map(|turn| nozzle_at(point, UPRIGHT, angle_of(turn, num_turns)));
    let solutions = poses.flat_map(|pose| solver.solutions(&pose, None));
    let mut within = solutions
        .filter(|joints| {
            solver.beyond_limit(joints).is_none() && solver.singularity(joints).is_none()
        })
        .take(NUM_TESTED);
    within.any(|joints| !solver.collides(&joints))
}
