//! Collisions of gun, wrist and forearm with the arm that carries them.

use super::*;

fn in_radians(degrees: [f64; 6]) -> Joints {
    degrees.map(f64::to_radians)
}

#[test]
fn a_wrist_that_is_folded_into_the_upper_arm_is_named() {
    let mut placed = placed("irb2600");
    // The forearm hangs down beside the upright upper arm: the wrist is 171 mm ahead of joint 2 and 85 mm below it.
    let folded = in_radians([0.0, 0.0, 86.0, 0.0, 17.0, 0.0]);
    let wanted = PointProblem::Collision {
        body: Body::Wrist,
        obstacle: Obstacle::UpperArm,
    };
    let collision = Solver::new(&placed, 0.0).collision(&folded);
    assert_eq!(collision, Some(wanted.clone()));
    // So does the check of a path that forces the arm to fold like this.
    placed.arm.limits[0] = [-0.2, 0.2];
    placed.arm.limits[1] = [-0.1, 0.1];
    placed.arm.limits[2] = [1.4, 1.6];
    let point = ArmPoint {
        robot_from_nozzle: Solver::new(&placed, 0.0).forward(&folded).expect("finite"),
        speed: 0.3,
        aim: 0.15,
        is_turn_free: false,
        is_gun_on: true,
        is_stop: false,
    };
    let found = check(&placed, &[point]);
    assert_eq!(found.points[0].problem, Some(wanted.clone()));
    assert_eq!(found.num_collisions(), 1);
    assert_eq!(wanted.to_string(), "wrist too near to the upper arm");
    // The axes are 191 mm apart, minus the radii of both bodies: a thinner arm is clear.
    placed.arm.radii = [0.08, 0.08, 0.08];
    assert_eq!(check(&placed, &[point]).num_collisions(), 0);
    placed.obstacles.clearance = 0.04;
    assert_eq!(check(&placed, &[point]).num_collisions(), 1);
}

#[test]
fn a_gun_that_is_swung_into_the_base_column_is_named() {
    let placed = PlacedArm {
        flange_from_nozzle: Translation3::new(0.0, 0.0, 0.5).into(),
        ..placed("irb2600")
    };
    let wanted = PointProblem::Collision {
        body: Body::Gun,
        obstacle: Obstacle::BaseColumn,
    };
    assert_eq!(wanted.to_string(), "gun too near to the base column");
    let solver = Solver::new(&placed, 0.0);
    // Leaning far forward and folded under itself, with the gun level and through joint 1 at the height of the foot.
    let inwards = [0.0, 80.0, 60.0, 0.0, 50.0, 0.0];
    // For every angle of joint 1 the column is in the middle.
    for turn in [-170.0, -60.0, 0.0, 45.0, 170.0] {
        let mut joints = in_radians(inwards);
        joints[0] = f64::to_radians(turn);
        assert_eq!(solver.collision(&joints), Some(wanted.clone()), "{turn}");
    }
    // The column stands on the rail and moves with it.
    let mut on_rail = placed.clone();
    on_rail.robot_from_base = Translation3::new(0.0, 0.0, 3.0).into();
    on_rail.arm.rail = Some(Rail {
        direction: Vector3::y_axis(),
        range: [-2.5, 2.5],
        speed: None,
        acceleration: None,
    });
    let moved = Solver::new(&on_rail, 2.0).collision(&in_radians(inwards));
    assert_eq!(moved, Some(wanted));
    // With the arm upright it is free.
    assert_eq!(
        solver.collision(&in_radians([0.0, 0.0, 0.0, 0.0, 30.0, 0.0])),
        None
    );
}

#[test]
fn a_forearm_that_lies_across_the_base_column_is_named() {
    let mut placed = placed("m-20ia");
    // Leaning back until the upper arm is level behind joint 2, with the forearm level ahead above it: the forearm
    // passes over the end of the column, 250 mm higher, and the wrist is beyond.
    let across = in_radians([0.0, -90.0, -90.0, 0.0, 0.0, 0.0]);
    let [_, wrist, forearm, ..] = Solver::new(&placed, 0.0).bodies(&across);
    assert!((forearm.axis.from.z - 0.25).abs() < 1e-9 && (wrist.axis.from.z - 0.25).abs() < 1e-9);
    assert!(forearm.axis.from.x < -0.5 && wrist.axis.from.x > 0.1);
    let wanted = PointProblem::Collision {
        body: Body::Forearm,
        obstacle: Obstacle::BaseColumn,
    };
    assert_eq!(wanted.to_string(), "forearm too near to the base column");
    // 150 mm of the column and 130 mm of the forearm, in any direction.
    for turn in [-170.0, 0.0, 90.0] {
        let mut joints = across;
        joints[0] = f64::to_radians(turn);
        let found = Solver::new(&placed, 0.0).collision(&joints);
        assert_eq!(found, Some(wanted.clone()), "{turn}");
    }
    // A thinner one leaves 20 mm.
    placed.arm.radii[1] = 0.08;
    for (clearance, is_hit) in [(0.019, false), (0.021, true)] {
        placed.obstacles.clearance = clearance;
        let found = Solver::new(&placed, 0.0).collision(&across);
        assert_eq!(found, is_hit.then(|| wanted.clone()), "{clearance}");
    }
}

#[test]
fn a_gun_that_is_folded_back_along_the_forearm_is_named() {
    let mut placed = PlacedArm {
        flange_from_nozzle: Translation3::new(0.4, 0.0, 0.0).into(),
        ..placed("irb2600")
    };
    // The forearm level, the wrist bent down by 90°: the gun runs back below the forearm or, with joint 6 turned by
    // 180°, away from it, 85 mm lower in both cases.
    let back = in_radians([0.0, 0.0, 0.0, 0.0, 90.0, 0.0]);
    let away = in_radians([0.0, 0.0, 0.0, 0.0, 90.0, 180.0]);
    let [gun, _, forearm, ..] = Solver::new(&placed, 0.0).bodies(&back);
    for end in [gun.axis.from, gun.axis.to] {
        assert!((forearm.axis.to.z - end.z - 0.085).abs() < 1e-9, "{end}");
    }
    assert!(gun.axis.to.x < forearm.axis.to.x - 0.3);
    let wanted = PointProblem::Collision {
        body: Body::Gun,
        obstacle: Obstacle::Forearm,
    };
    assert_eq!(wanted.to_string(), "gun too near to the forearm");
    let found = Solver::new(&placed, 0.0).collision(&back);
    assert_eq!(found, Some(wanted.clone()));
    assert_eq!(Solver::new(&placed, 0.0).collision(&away), None);
    // A thin forearm leaves 15 mm to the gun's 50 mm.
    placed.arm.radii[1] = 0.02;
    for (clearance, is_hit) in [(0.014, false), (0.016, true)] {
        placed.obstacles.clearance = clearance;
        let solver = Solver::new(&placed, 0.0);
        let found = solver.collision(&back);
        assert_eq!(found, is_hit.then(|| wanted.clone()), "{clearance}");
        assert_eq!(solver.collision(&away), None);
    }
}

#[test]
fn a_straight_gun_ahead_of_the_wrist_is_clear_of_the_forearm() {
    for name in ARM_NAMES {
        let placed = PlacedArm {
            flange_from_nozzle: Translation3::new(0.0, 0.0, 0.3).into(),
            ..placed(name)
        };
        let solver = Solver::new(&placed, 0.0);
        // The upper arm upright, the forearm level.
        let mut joints = match name {
            "kr6-r900" => in_radians([0.0, -90.0, 90.0, 0.0, 0.0, 0.0]),
            _ => [0.0; 6],
        };
        for turn in [-150.0, 0.0, 60.0] {
            joints[3] = f64::to_radians(turn);
            for bend in [-89.0, -45.0, 0.0, 45.0, 89.0] {
                joints[4] = f64::to_radians(bend);
                assert_eq!(solver.collision(&joints), None, "{name} {turn} {bend}");
            }
        }
    }
}

#[test]
fn bodies_that_share_a_joint_do_not_collide() {
    for name in ARM_NAMES {
        let placed = with_gun(name);
        let found = check(&placed, &row(&placed, 20, 0.3));
        assert_eq!(found.num_collisions(), 0, "{name}: {found:?}");
    }
}
