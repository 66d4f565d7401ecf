mod accelerations;
mod collisions;
mod files;
mod follow;
mod freedom;
mod kinematics;
mod moving_rail;
mod own_arm;
mod places;
mod smooth_tilts;
mod speeds;

use std::f64::consts::{FRAC_PI_2, PI};

use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};

use super::{kinematics::Solver, *};
use geometry::{error::Advice as _, rigid::from_euler_zyx};

/// Film that each way of a path deposits: indices of points, and metres.
type Films = Vec<Vec<(u32, f32)>>;

fn placed(name: &str) -> PlacedArm {
    PlacedArm {
        arm: Arm::named(name).expect("known"),
        robot_from_base: RigidTransform::identity(),
        flange_from_nozzle: RigidTransform::identity(),
        gun_radius: GUN_RADIUS_M,
        obstacles: Obstacles::default(),
    }
}

/// A gun held ahead of the flange and tilted by about 45°, so that its z axis is not that of joint 6.
fn with_gun(name: &str) -> PlacedArm {
    PlacedArm {
        flange_from_nozzle: from_euler_zyx([0.0, 0.8, 0.0, 0.05, 0.0, 0.2]),
        ..placed(name)
    }
}

/// A row of points ahead of the arm, with the nozzle pointing ahead.
fn row(arm: &PlacedArm, num: usize, length: f64) -> Vec<ArmPoint> {
    let ahead = 0.7 * arm.arm.reach() + 0.25;
    let turn = UnitQuaternion::from_axis_angle(&Vector3::y_axis(), FRAC_PI_2);
    (0..num)
        .map(|i| ArmPoint {
            robot_from_nozzle: Isometry3::from_parts(
                Translation3::new(ahead, length * (i as f64 / num as f64 - 0.5), 0.4),
                turn,
            ),
            speed: 0.3,
            aim: 0.15,
            is_turn_free: false,
            is_gun_on: true,
            is_stop: false,
        })
        .collect()
}

fn check(placed: &PlacedArm, points: &[ArmPoint]) -> PathCheck {
    check_path(placed, points, &CheckParams::default()).expect("checked")
}

/// The same without turning a fan.
fn check_unturned(placed: &PlacedArm, points: &[ArmPoint]) -> PathCheck {
    let params = CheckParams {
        num_turns: 1,
        ..CheckParams::default()
    };
    check_path(placed, points, &params).expect("checked")
}

#[test]
fn a_row_ahead_of_every_arm_is_reached_without_a_jump() {
    for name in ARM_NAMES {
        let placed = with_gun(name);
        let points = row(&placed, 60, 0.3);
        let found = check(&placed, &points);
        let problems: Vec<_> = found.points.iter().map(|point| &point.problem).collect();
        assert_eq!(found.num_reached(), 60, "{name}: {problems:?}");
        let solver = Solver::new(&placed, 0.0);
        for (point, wanted) in found.points.iter().zip(&points) {
            let joints = point.joints.expect("reached");
            let at = solver.forward(&joints).expect("finite");
            let off = at.translation.vector - wanted.robot_from_nozzle.translation.vector;
            assert!(off.norm() < 1e-6);
            assert!(at.rotation.angle_to(&wanted.robot_from_nozzle.rotation) < 1e-6);
        }
        for pair in found.points.windows(2) {
            let (a, b) = (pair[0].joints.expect("one"), pair[1].joints.expect("one"));
            // 5 mm at 0.3 m/s.
            let time = 0.3 / 60.0 / 0.3;
            for i in 0..6 {
                assert!((a[i] - b[i]).abs() <= placed.arm.speeds[i] * time + 1e-9);
            }
        }
    }
}

#[test]
fn each_reason_is_named() {
    let placed = with_gun("irb2600");
    let far = row(&placed, 3, 20.0);
    let found = check(&placed, &far);
    assert_eq!(found.points[0].problem, Some(PointProblem::OutOfReach));
    assert_eq!(found.points[0].joints, None);

    // Joint 1 is limited to 10° on either side: a point to the left is beyond it.
    let mut narrow = placed.clone();
    narrow.arm.limits[0] = [-0.17, 0.17];
    let mut left = row(&narrow, 1, 0.0);
    left[0].robot_from_nozzle = Translation3::new(-0.2, 0.8, 0.0) * left[0].robot_from_nozzle;
    let problem = check(&narrow, &left).points[0].problem.clone();
    assert!(
        matches!(problem, Some(PointProblem::JointLimit { joint: 1, .. })),
        "{problem:?}"
    );

    // Faster than any joint can turn.
    let mut fast = row(&placed, 20, 0.8);
    for point in &mut fast {
        point.speed = 50.0;
    }
    let problem = check(&placed, &fast).points[10].problem.clone();
    let Some(PointProblem::TooFast { speed, joint }) = problem else {
        panic!("{problem:?}");
    };
    assert!(speed > placed.arm.speeds[joint - 1]);

    // The wrist straight: the nozzle along the forearm.
    let mut bare = super::tests::placed("irb2600");
    // No other configuration is left.
    bare.arm.limits[0] = [-0.2, 0.2];
    bare.arm.limits[1] = [0.1, 0.5];
    bare.arm.limits[2] = [0.0, 0.4];
    let solver = Solver::new(&bare, 0.0);
    let straight = [0.0, 0.3, 0.2, 0.1, 0.0, 0.0];
    let point = ArmPoint {
        robot_from_nozzle: solver.forward(&straight).expect("finite"),
        speed: 0.3,
        aim: 0.15,
        is_turn_free: false,
        is_gun_on: true,
        is_stop: false,
    };
    let problem = check(&bare, &[point]).points[0].problem.clone();
    assert_eq!(
        problem,
        Some(PointProblem::NearSingularity {
            singularity: Singularity::Wrist
        })
    );
}

#[test]
fn a_long_way_through_a_limit_or_a_fold_is_found_between_its_ends() {
    // From one side of the arm to the other, through its own base.
    let placed = with_gun("irb2600");
    let across = |y: f64| ArmPoint {
        robot_from_nozzle: Isometry3::from_parts(
            Translation3::new(0.05, y, 0.4),
            UnitQuaternion::from_axis_angle(&Vector3::x_axis(), PI),
        ),
        speed: 0.3,
        aim: 0.15,
        is_turn_free: false,
        is_gun_on: true,
        is_stop: false,
    };
    let found = check(&placed, &[across(-0.8), across(0.8)]);
    assert!(found.points.iter().all(|point| point.joints.is_some()));
    assert!(found.points[1].problem.is_some(), "{:?}", found.points[1]);
}

/// 20 mm during which joint 6 turns from 2.95 to 3.1 rad, at 1 mm/s: every joint has time for a whole turn. Shoulder and
/// elbow of the arm get one configuration only.
fn one_way_round(placed: &mut PlacedArm) -> [ArmPoint; 2] {
    let solver = Solver::new(placed, 0.0);
    let pose = |joint_6: f64| {
        let joints = [0.0, 0.2, 0.3, 0.0, 0.8, joint_6];
        solver.forward(&joints).expect("finite")
    };
    let poses = [pose(2.95), Translation3::new(0.02, 0.0, 0.0) * pose(3.1)];
    placed.arm.limits[0] = [-0.5, 0.5];
    placed.arm.limits[1] = [-0.3, 0.7];
    placed.arm.limits[2] = [-0.3, 0.9];
    placed.arm.limits[4] = [-1.4, 1.4];
    poses.map(|robot_from_nozzle| ArmPoint {
        robot_from_nozzle,
        speed: 0.001,
        aim: 0.15,
        is_turn_free: false,
        is_gun_on: true,
        is_stop: false,
    })
}

#[test]
fn a_slow_move_neither_turns_a_joint_once_around_nor_folds_the_arm_over() {
    let mut placed = placed("irb2600");
    let points = one_way_round(&mut placed);
    for (joint_4, joint_6, is_reached) in [
        ([-1.0, 1.0], [-4.0, 4.0], true),
        // At the second point only a whole turn back is left.
        ([-1.0, 1.0], [-3.2, 3.0], false),
        // Only the other configuration of the wrist is left there.
        ([-4.0, 4.0], [-0.1, 3.0], false),
    ] {
        placed.arm.limits[3] = joint_4;
        placed.arm.limits[5] = joint_6;
        let found = check_unturned(&placed, &points);
        assert!(found.points.iter().all(|point| point.joints.is_some()));
        assert_eq!(found.points[0].problem, None, "{found:?}");
        let problem = &found.points[1].problem;
        let is_limit = matches!(
            problem,
            Some(PointProblem::JointLimit { joint: 6, angle }) if *angle > 3.0
        );
        assert!(is_limit != is_reached, "{found:?}");
        assert_eq!(problem.is_none(), is_reached, "{found:?}");
    }
}

#[test]
fn a_round_jet_reaches_more_because_the_nozzle_may_turn() {
    let mut placed = with_gun("gp25");
    // A wrist with little range.
    placed.arm.limits[3] = [-0.6, 0.6];
    placed.arm.limits[5] = [-0.6, 0.6];
    let mut points = row(&placed, 20, 0.3);
    for point in &mut points {
        point.robot_from_nozzle *= UnitQuaternion::from_euler_angles(0.0, 0.0, 2.0);
    }
    let fixed = check(&placed, &points).num_reached();
    for point in &mut points {
        point.is_turn_free = true;
    }
    let found = check(&placed, &points);
    assert!(fixed < 20 && found.num_reached() == 20, "{fixed} {found:?}");
    assert!(found.points[0].turn != 0.0);
    // z still points as the path has it.
    let solver = Solver::new(&placed, 0.0);
    for (point, wanted) in found.points.iter().zip(&points) {
        let at = solver.forward(&point.joints.expect("one")).expect("finite");
        let off = at * Vector3::z() - wanted.robot_from_nozzle * Vector3::z();
        assert!(off.norm() < 1e-6);
        let shift = at.translation.vector - wanted.robot_from_nozzle.translation.vector;
        assert!(shift.norm() < 1e-6);
    }
}

#[test]
fn bad_arms_and_paths_are_refused_with_advice() {
    let refused = |error: ArmError| {
        assert!(!error.advice().is_empty());
        error.to_string()
    };
    assert!(refused(Arm::named("rx-78").expect_err("unknown")).contains("rx-78"));
    assert!(refused(Arm::named("ur10e").expect_err("no wrist")).contains("spherical wrist"));
    assert!(refused(Arm::named("none.toml").expect_err("no file")).contains("none.toml"));
    let placed = with_gun("m-20ia");
    let points = row(&placed, 3, 0.3);
    let params = CheckParams::default();
    assert!(refused(check_path(&placed, &[], &params).expect_err("empty")).contains("no points"));
    let mut broken = points.clone();
    broken[1].robot_from_nozzle.translation.vector.x = f64::NAN;
    assert!(refused(check_path(&placed, &broken, &params).expect_err("NaN")).contains("point 2"));
    broken = points.clone();
    broken[2].speed = 0.0;
    assert!(refused(check_path(&placed, &broken, &params).expect_err("0")).contains("point 3"));
    let mut base = placed.clone();
    base.robot_from_base.translation.vector.z = f64::INFINITY;
    assert!(refused(check_path(&base, &points, &params).expect_err("base")).contains("base"));
    let mut on_rail = placed.clone();
    on_rail.arm.rail = Some(Rail {
        direction: Vector3::y_axis(),
        range: [-1.0, f64::NAN],
        speed: Some(1.0),
        acceleration: None,
    });
    assert!(refused(check_path(&on_rail, &points, &params).expect_err("rail")).contains("rail"));
    for bad in [f64::NAN, -0.001, 1.1] {
        let mut wide = placed.clone();
        wide.gun_radius = bad;
        let error = refused(check_path(&wide, &points, &params).expect_err("radius"));
        assert!(error.contains("radius of the gun"), "{error}");
        let mut near = placed.clone();
        near.obstacles.clearance = bad;
        let error = refused(check_path(&near, &points, &params).expect_err("clearance"));
        assert!(error.contains("expected 0 to 1000 mm"), "{error}");
        assert!(error.contains("clearance"), "{error}");
    }
    // A gun without a radius is a line, whose body is not checked.
    let mut thin = placed.clone();
    thin.gun_radius = 0.0;
    let error = refused(check_path(&thin, &points, &params).expect_err("radius"));
    assert!(error.contains("expected 1 to 1000 mm"), "{error}");
    for num_turns in [0, 73] {
        let params = CheckParams {
            num_turns,
            ..params
        };
        let error = refused(check_path(&placed, &points, &params).expect_err("turns"));
        assert!(error.contains("number of turns"), "{error}");
    }
    let endless = CheckParams {
        approach: Some(f64::INFINITY),
        ..params
    };
    let error = refused(check_path(&placed, &points, &endless).expect_err("approach"));
    assert!(error.contains("approach"), "{error}");
}
