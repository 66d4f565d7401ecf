//! Suggestions of better places for base and rail.

use std::sync::atomic::{AtomicUsize, Ordering};

use super::{
    collisions::{among, elbow},
    *,
};
use crate::arm::check::check_unless;

pub(super) fn better_base(
    placed: &PlacedArm,
    points: &[ArmPoint],
    params: &CheckParams<'_>,
    num_reached: usize,
) -> Option<PlaceSuggestion> {
    let found = suggest_base(placed, points, params, num_reached, &|_, _| {}, &|| false);
    found.expect("searched")
}

pub(super) fn better_rail(
    placed: &PlacedArm,
    points: &[ArmPoint],
    params: &CheckParams<'_>,
    num_reached: usize,
) -> Option<PlaceSuggestion> {
    let found = suggest_rail(placed, points, params, num_reached, &|_, _| {}, &|| false);
    found.expect("searched")
}

#[test]
fn a_better_place_is_suggested() {
    let mut placed = with_gun("irb2600");
    let points = row(&placed, 30, 0.4);
    placed.robot_from_base = Translation3::new(-0.8, 0.0, 0.0).into();
    let params = CheckParams::default();
    let num = check(&placed, &points).num_reached();
    assert!(num < 30);
    let base = better_base(&placed, &points, &params, num).expect("a better one");
    assert_eq!(base.num_reached, 30);
    assert!(base.shift[0] > 0.1, "{base:?}");
    assert_eq!(better_base(&placed, &points, &params, 30), None);

    placed.arm.rail = Some(Rail {
        direction: Vector3::x_axis(),
        range: [-0.5, 2.0],
        speed: None,
        acceleration: None,
    });
    let rail = better_rail(&placed, &points, &params, num).expect("a better one");
    assert_eq!(rail.num_reached, 30);
    let there = CheckParams {
        rail: rail.shift[0],
        ..params
    };
    let again = check_path(&placed, &points, &there).expect("checked");
    assert_eq!(again.num_reached(), 30);
}

#[test]
fn a_place_is_suggested_where_less_is_run_into() {
    let mut placed = with_gun("irb2600");
    placed.arm.limits[0] = [-1.0, 1.0];
    let points = row(&placed, 60, 0.3);
    let params = CheckParams::default();
    let joints = check(&placed, &points).points[30].joints.expect("reached");
    let blocked = among(&placed, &[("lamp", elbow(&placed, &joints), 0.1)]);
    let num = check(&blocked, &points).num_reached();
    let base = better_base(&blocked, &points, &params, num).expect("a better one");
    assert!(base.num_reached > 30, "{base:?}");
    let [x, y, z] = base.shift;
    let there = PlacedArm {
        robot_from_base: Translation3::new(x, y, z).into(),
        ..blocked
    };
    let found = check(&there, &points);
    assert_eq!(found.num_reached(), base.num_reached);
}

#[test]
fn a_place_is_no_better_if_it_misses_the_approach_point() {
    let placed = with_gun("irb2600");
    let points = row(&placed, 30, 0.4);
    // So far behind the nozzle, the arm would be inside its own base.
    let params = CheckParams {
        approach: Some(1.4),
        ..CheckParams::default()
    };
    let reached = |placed: &PlacedArm| {
        let found = check_path(placed, &points, &params).expect("checked");
        found.num_reached()
    };
    assert_eq!(check(&placed, &points).num_reached(), 30);
    let num = reached(&placed);
    assert!(num < 30);
    if let Some(base) = better_base(&placed, &points, &params, num) {
        let there = PlacedArm {
            robot_from_base: Translation3::from(base.shift).into(),
            ..placed
        };
        assert!(base.num_reached > num, "{base:?}");
        assert_eq!(reached(&there), base.num_reached, "{base:?}");
    }
}

#[test]
fn the_search_counts_its_places_and_ends_when_it_is_cancelled() {
    let mut placed = with_gun("irb2600");
    placed.arm.rail = Some(Rail {
        direction: Vector3::y_axis(),
        range: [-0.3, 0.3],
        speed: Some(1.0),
        acceleration: None,
    });
    let points = row(&placed, 30, 0.4);
    let params = CheckParams::default();
    // While places are compared, and in the first of the full checks.
    for last in [0, 7, 605] {
        let seen = AtomicUsize::new(0);
        let progress = |done, total| {
            assert_eq!(total, 11 * 11 * 5 + 8);
            seen.store(done, Ordering::Relaxed);
        };
        let is_cancelled = || seen.load(Ordering::Relaxed) >= last;
        let found = suggest_base(&placed, &points, &params, 0, &progress, &is_cancelled);
        assert!(matches!(found, Err(ArmError::Cancelled)), "{found:?}");
        assert_eq!(seen.load(Ordering::Relaxed), last);
    }
}

#[test]
fn a_check_ends_in_each_of_its_stages_when_it_is_cancelled() {
    let mut placed = with_gun("irb2600");
    placed.arm.rail = Some(Rail {
        direction: Vector3::y_axis(),
        range: [-0.3, 0.3],
        speed: Some(1.0),
        acceleration: None,
    });
    let num = 30;
    let points = row(&placed, num, 0.4);
    let params = CheckParams::default();
    let checked = |most: usize| {
        let asked = AtomicUsize::new(0);
        let is_cancelled = || asked.fetch_add(1, Ordering::Relaxed) >= most;
        let found = check_unless(&is_cancelled, &placed, &points, &params);
        (found, asked.into_inner())
    };
    let (found, all) = checked(usize::MAX);
    assert_eq!(found.expect("checked"), check(&placed, &points));
    // Positions that reach a point, run of the rail, candidates, their chain, and the way: each asks once per point.
    assert!(all >= 5 * num - 1, "{all}");
    for stage in 0..5 {
        let most = stage * num + num / 2;
        let (found, asked) = checked(most);
        assert!(matches!(found, Err(ArmError::Cancelled)), "{stage}");
        // Points whose positions are still to be tested ask once more each.
        assert!(asked <= most + num, "{stage}: {asked}");
    }
}
