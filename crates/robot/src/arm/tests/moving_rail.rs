//! An arm that a rail moves along the path.

use super::{
    places::{better_base, better_rail},
    *,
};

/// Longer than the reach to both sides of any place, with the gun, metres.
const LENGTH: f64 = 4.5;
const NUM: usize = 180;

/// An arm on a rail along y with this top speed, m/s, and a row of points that it cannot reach from any single place.
fn cell(speed: Option<f64>) -> (PlacedArm, Vec<ArmPoint>) {
    let mut placed = with_gun("irb2600");
    placed.arm.rail = Some(Rail {
        direction: Vector3::y_axis(),
        range: [-2.5, 2.5],
        speed,
        acceleration: None,
    });
    let points = row(&placed, NUM, LENGTH);
    (placed, points)
}

/// Seconds between points: the row is run at 0.3 m/s.
const STEP_TIME: f64 = LENGTH / NUM as f64 / 0.3;

#[test]
fn a_rail_that_moves_reaches_a_path_longer_than_the_arm() {
    let (still, points) = cell(None);
    let [a1, _, _, _, _, _, c4] = still.arm.lengths;
    let gun = still.flange_from_nozzle.translation.vector.norm();
    assert!(LENGTH * 0.99 > 2.0 * (a1 + still.arm.reach() + c4 + gun));
    for rail in [-2.5, -1.5, -0.5, 0.0, 0.5, 1.5, 2.5] {
        let params = CheckParams {
            rail,
            ..CheckParams::default()
        };
        let found = check_path(&still, &points, &params).expect("checked");
        assert!(found.num_reached() < NUM, "{rail}");
        let stands = |at: f64| (at - rail).abs() < 1e-12;
        assert!(found.rail_range().into_iter().all(stands));
    }

    let (moving, points) = cell(Some(1.0));
    let found = check(&moving, &points);
    let problems: Vec<_> = found.points.iter().map(|point| &point.problem).collect();
    assert_eq!(found.num_reached(), NUM, "{problems:?}");
    for (checked, point) in found.points.iter().zip(&points) {
        // The joints and the rail's position give the point.
        let solver = Solver::new(&moving, checked.rail);
        let at = solver.forward(&checked.joints.expect("reached"));
        let off = at.expect("finite").to_homogeneous() - point.robot_from_nozzle.to_homogeneous();
        assert!(off.amax() < 1e-5, "{}", off.amax());
    }
    for pair in found.points.windows(2) {
        let speed = (pair[1].rail - pair[0].rail).abs() / STEP_TIME;
        assert!(speed <= 1.0 + 1e-5, "{speed}");
    }
    let [low, high] = found.rail_range();
    assert!(
        low >= -2.5 && high <= 2.5 && high - low > 0.5,
        "{low} {high}"
    );
    assert_eq!(check(&moving, &points), found);
    // The position given for a standing rail has no effect on one that moves.
    let params = CheckParams {
        rail: 2.5,
        ..CheckParams::default()
    };
    let again = check_path(&moving, &points, &params).expect("checked");
    assert_eq!(again, found);
    assert_eq!(better_rail(&moving, &points, &params, 0), None);
}

#[test]
fn a_rail_that_is_too_slow_says_so_and_never_moves_faster_than_it_can() {
    // 15 seconds at 20 mm/s are 300 mm.
    let (slow, points) = cell(Some(0.02));
    let found = check(&slow, &points);
    assert!(found.num_reached() < NUM);
    for pair in found.points.windows(2) {
        let speed = (pair[1].rail - pair[0].rail).abs() / STEP_TIME;
        let is_reached = pair.iter().all(|point| point.joints.is_some());
        let named = matches!(pair[1].problem, Some(PointProblem::RailTooFast { .. }));
        assert!(
            !is_reached || named == (speed > 0.02 * (1.0 + 1e-6)),
            "{speed}: {pair:?}"
        );
    }

    // Two points farther apart than the arm reaches, with no time in between.
    let ends = [points[0], points[NUM - 1]].map(|point| ArmPoint {
        speed: 10.0,
        ..point
    });
    let (moving, _) = cell(Some(1.0));
    let found = check(&moving, &ends);
    assert_eq!(found.points[0].problem, None);
    let Some(PointProblem::RailTooFast { speed }) = found.points[1].problem else {
        panic!("{found:?}");
    };
    assert!(speed > 1.0);
    let problem = PointProblem::RailTooFast { speed: 1.25 };
    assert_eq!(problem.to_string(), "the rail would need 1250 mm/s");
    assert_eq!(problem.kind(), "rail_too_fast");
}

#[test]
fn a_rail_speeds_up_and_slows_down_within_its_acceleration() {
    let (mut moving, points) = cell(Some(1.0));
    let hardest = |found: &PathCheck| {
        let rails = found.points.windows(3);
        let changes = rails.map(|at| (at[2].rail - 2.0 * at[1].rail + at[0].rail).abs());
        changes.fold(0.0, f64::max) / (STEP_TIME * STEP_TIME)
    };
    let at_once = hardest(&check(&moving, &points));
    let limited = moving.arm.rail.map(|rail| Rail {
        acceleration: Some(0.4),
        ..rail
    });
    moving.arm.rail = limited;
    let found = check(&moving, &points);
    let problems: Vec<_> = found.points.iter().map(|point| &point.problem).collect();
    assert_eq!(found.num_reached(), NUM, "{problems:?}");
    assert!(hardest(&found) <= 0.4 + 1e-6, "{}", hardest(&found));
    assert!(at_once > 0.4, "{at_once}");
}

#[test]
fn a_rail_that_stands_still_changes_nothing() {
    let plain = with_gun("irb2600");
    let mut on_rail = plain.clone();
    let points = row(&plain, 40, 1.2);
    let found = check(&plain, &points);
    assert!(found.points.iter().all(|point| point.rail.abs() <= 0.0));
    on_rail.arm.rail = Some(Rail {
        direction: Vector3::y_axis(),
        range: [-2.5, 2.5],
        speed: None,
        acceleration: None,
    });
    assert_eq!(check(&on_rail, &points), found);
}

#[test]
fn a_better_base_counts_every_position_of_a_rail_that_moves() {
    let (mut moving, points) = cell(Some(1.0));
    moving.robot_from_base = Translation3::new(-0.8, 0.0, 0.0).into();
    let params = CheckParams::default();
    let num = check(&moving, &points).num_reached();
    assert!(num < NUM);
    let base = better_base(&moving, &points, &params, num).expect("a better one");
    assert_eq!(base.num_reached, NUM, "{base:?}");
    assert!(base.shift[0] > 0.1, "{base:?}");
}
