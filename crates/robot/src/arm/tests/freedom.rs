//! What the check may change about a path: turn and tilt of the nozzle, and moves with the gun off.

use super::*;
use crate::arm::{Way, chain::nozzle_at, way::MIN_TRAVEL_SPEED_M_S};

/// Leaves the joints 2° beyond what these points need.
fn limit_to(placed: &mut PlacedArm, points: &[ArmPoint]) {
    let found = check(placed, points);
    assert_eq!((found.num_reached(), found.tilted()), (points.len(), None));
    for (joint, limits) in placed.arm.limits.iter_mut().enumerate() {
        let angles = found
            .points
            .iter()
            .map(|point| point.joints.expect("reached")[joint]);
        let range = [f64::INFINITY, f64::NEG_INFINITY];
        let [low, high] = angles.fold(range, |[low, high], at| [low.min(at), high.max(at)]);
        *limits = [low - 0.035, high + 0.035];
    }
}

#[test]
fn a_fan_may_turn_by_half_a_turn_but_no_less() {
    let mut placed = with_gun("gp25");
    let straight = row(&placed, 20, 0.02);
    limit_to(&mut placed, &straight);
    for (turn, is_reached) in [(0.0, true), (PI, true), (FRAC_PI_2, false)] {
        let mut points = straight.clone();
        for point in &mut points {
            point.robot_from_nozzle *= UnitQuaternion::from_euler_angles(0.0, 0.0, turn);
        }
        let found = check(&placed, &points);
        assert_eq!(found.num_reached() == 20, is_reached, "{turn} {found:?}");
        if is_reached {
            assert!(
                found
                    .points
                    .iter()
                    .all(|point| (point.turn.abs() - turn).abs() < 1e-9)
            );
        }
    }
}

#[test]
fn the_nozzle_tilts_about_the_point_that_it_aims_at_where_the_arm_needs_it() {
    let mut placed = with_gun("irb2600");
    let points = row(&placed, 20, 0.02);
    limit_to(&mut placed, &points);
    let limit = 10.0_f64.to_radians();
    // The second half of the path leans by 5°.
    let mut leaning = points.clone();
    for point in &mut leaning[10..] {
        point.robot_from_nozzle = nozzle_at(point, [0.5 * limit, 0.0], 0.0);
    }
    // Slow enough for the tilt between two points.
    for point in &mut leaning {
        point.speed = 0.05;
    }
    assert!(check(&placed, &leaning).num_reached() <= 10);
    let params = CheckParams {
        max_tilt: limit,
        ..CheckParams::default()
    };
    let found = check_path(&placed, &leaning, &params).expect("checked");
    assert_eq!(found.num_reached(), 20, "{found:?}");
    let (num, most) = found.tilted().expect("tilted");
    assert!(num >= 10 && most <= limit + 1e-9, "{num} {most}");
    let aim = Translation3::new(0.0, 0.0, points[0].aim);
    let solver = Solver::new(&placed, 0.0);
    for (point, wanted) in found.points.iter().zip(&leaning) {
        let [aims, wanted] = [point.robot_from_nozzle, wanted.robot_from_nozzle]
            .map(|nozzle| (nozzle * aim).translation.vector);
        assert!((aims - wanted).norm() < 1e-9);
        let at = solver
            .forward(&point.joints.expect("reached"))
            .expect("finite");
        let off = at.inverse() * point.robot_from_nozzle;
        assert!(off.translation.vector.norm() < 1e-6 && off.rotation.angle() < 1e-6);
    }
    for bad in [f64::NAN, -0.1, 0.6] {
        let params = CheckParams {
            max_tilt: bad,
            ..params
        };
        let error = check_path(&placed, &leaning, &params).expect_err("out of range");
        assert!(error.to_string().contains("tilt"), "{error}");
    }
}

#[test]
fn a_move_with_the_gun_off_takes_the_time_that_the_joints_need() {
    let placed = with_gun("irb2600");
    let mut points = row(&placed, 20, 0.8);
    for (i, point) in points.iter_mut().enumerate() {
        point.speed = 50.0;
        point.is_gun_on = i != 9;
    }
    let found = check(&placed, &points);
    assert_eq!(found.points[10].problem, None);
    let Way::Slower(speed) = found.points[10].way else {
        panic!("{:?}", found.points[10]);
    };
    assert!((MIN_TRAVEL_SPEED_M_S..25.1).contains(&speed), "{speed}");
    assert_eq!(found.changed_moves(), [1, 0, 0]);
    for i in [9, 11] {
        let problem = &found.points[i].problem;
        assert!(
            matches!(problem, Some(PointProblem::TooFast { .. })),
            "{problem:?}"
        );
    }
}

#[test]
fn between_strokes_the_arm_changes_its_configuration_by_a_joint_move_if_a_program_can_name_it() {
    let mut placed = placed("irb2600");
    let maker = placed.arm.maker;
    let mut points = one_way_round(&mut placed);
    for point in &mut points {
        point.speed = 0.3;
        point.is_gun_on = false;
    }
    // At the second point only the other configuration of the wrist is left.
    placed.arm.limits[3] = [-4.0, 4.0];
    placed.arm.limits[5] = [-0.1, 3.0];
    let found = check(&placed, &points);
    assert_eq!(
        (found.num_reached(), found.changed_moves()),
        (2, [0, 1, 0]),
        "{found:?}"
    );
    // The approach of a program is straight.
    for point in &mut points {
        point.is_stop = true;
    }
    assert_eq!(check(&placed, &points).num_reached(), 1);
    for point in &mut points {
        point.is_stop = false;
    }
    // A program that cannot name the configuration leaves it to the controller.
    placed.arm.maker = None;
    assert_eq!(check(&placed, &points).num_reached(), 1);
    placed.arm.maker = maker;
    points[1].is_gun_on = true;
    assert_eq!(check(&placed, &points).num_reached(), 1);
}
