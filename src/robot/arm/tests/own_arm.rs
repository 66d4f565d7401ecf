//! Gun and wrist against the arm that carries them.

use super::*;

fn in_radians(degrees: [f64; 6]) -> Joints {
    degrees.map(f64::to_radians)
}

#[test]
fn a_wrist_that_is_folded_into_the_upper_arm_is_named() {
    let mut placed = placed("irb2600");
    // The forearm hangs down beside the upper arm, which is upright: the wrist is 171 mm ahead of joint 2 and 85 mm below it.
    let folded = in_radians([0.0, 0.0, 86.0, 0.0, 17.0, 0.0]);
    let wanted = PointProblem::Collision {
        body: Body::Wrist,
        obstacle: Obstacle::UpperArm,
    };
    let collision = Solver::new(&placed, 0.0).collision(&folded);
    assert_eq!(collision, Some(wanted.clone()));
    // So does the check of a path for which the arm has to fold so.
    placed.arm.limits[0] = [-0.2, 0.2];
    placed.arm.limits[1] = [-0.1, 0.1];
    placed.arm.limits[2] = [1.4, 1.6];
    let point = ArmPoint {
        robot_from_nozzle: Solver::new(&placed, 0.0).forward(&folded).expect("finite"),
        speed: 0.3,
        is_turn_free: false,
        is_gun_on: true,
    };
    let found = check(&placed, &[point]);
    assert_eq!(found.points[0].problem, Some(wanted.clone()));
    assert_eq!(found.num_collisions(), 1);
    assert_eq!(wanted.describe(), "the wrist is too near to the upper arm");
    // 191 mm are left between the axes, of which both bodies take some: a thinner arm is clear.
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
    assert_eq!(wanted.describe(), "the gun is too near to the base column");
    let solver = Solver::new(&placed, 0.0);
    // Leaned far forward, folded under itself, the gun level and through joint 1 at the height of the foot.
    let inwards = [0.0, 80.0, 60.0, 0.0, 50.0, 0.0];
    // Whichever way joint 1 turns, the column is in the middle.
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
    });
    let moved = Solver::new(&on_rail, 2.0).collision(&in_radians(inwards));
    assert_eq!(moved, Some(wanted));
    // The other way up it is free.
    assert_eq!(
        solver.collision(&in_radians([0.0, 0.0, 0.0, 0.0, 30.0, 0.0])),
        None
    );
}

#[test]
fn bodies_that_share_a_joint_do_not_collide() {
    for name in ARM_NAMES {
        let placed = with_gun(name);
        let found = check(&placed, &row(&placed, 20, 0.3));
        assert_eq!(found.num_collisions(), 0, "{name}: {found:?}");
    }
}
