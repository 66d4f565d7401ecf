mod moving_rail;
mod own_arm;

use std::{
    f64::consts::{FRAC_PI_2, PI},
    fmt::Write as _,
};

use nalgebra::{Isometry3, Matrix4, Point3, Translation3, Unit, UnitQuaternion, Vector3};
use rand::{RngExt as _, SeedableRng as _};
use rand_pcg::Pcg64;

use super::{kinematics::Solver, *};
use crate::{error::Advice as _, geometry::rigid::from_euler_zyx};

/// The chain of links as the makers' drawings give it: the shift to each joint, its axis, and the turn of the flange.
struct Chain {
    name: &'static str,
    joints: [([f64; 3], [f64; 3]); 6],
    flange: ([f64; 3], [f64; 3]),
    base_height: f64,
}

const X: [f64; 3] = [1.0, 0.0, 0.0];
const Y: [f64; 3] = [0.0, 1.0, 0.0];
const Z: [f64; 3] = [0.0, 0.0, 1.0];

fn back(axis: [f64; 3]) -> [f64; 3] {
    axis.map(|x| -x)
}

fn chains() -> [Chain; 5] {
    let abb = [0.0, FRAC_PI_2, 0.0];
    let fanuc = [PI, -FRAC_PI_2, 0.0];
    [
        Chain {
            name: "kr6-r900",
            joints: [
                ([0.0, 0.0, 0.4], back(Z)),
                ([0.025, 0.0, 0.0], Y),
                ([0.455, 0.0, 0.0], Y),
                ([0.0, 0.0, 0.025], back(X)),
                ([0.42, 0.0, 0.0], Y),
                ([0.09, 0.0, 0.0], back(X)),
            ],
            flange: ([0.0; 3], abb),
            base_height: 0.0,
        },
        Chain {
            name: "m-20ia",
            joints: [
                ([0.0, 0.0, 0.525], Z),
                ([0.15, 0.0, 0.0], Y),
                ([0.0, 0.0, 0.79], back(Y)),
                ([0.0, 0.0, 0.25], back(X)),
                ([0.835, 0.0, 0.0], back(Y)),
                ([0.1, 0.0, 0.0], back(X)),
            ],
            flange: ([0.0; 3], fanuc),
            base_height: 0.525,
        },
        Chain {
            name: "irb2600",
            joints: [
                ([0.0, 0.0, 0.445], Z),
                ([0.15, 0.0, 0.0], Y),
                ([0.0, 0.0, 0.7], Y),
                ([0.0, 0.0, 0.115], X),
                ([0.795, 0.0, 0.0], Y),
                ([0.085, 0.0, 0.0], X),
            ],
            flange: ([0.0; 3], abb),
            base_height: 0.0,
        },
        Chain {
            name: "irb4600",
            joints: [
                ([0.0, 0.0, 0.495], Z),
                ([0.175, 0.0, 0.0], Y),
                ([0.0, 0.0, 1.095], Y),
                ([0.0, 0.0, 0.175], X),
                ([1.27, 0.0, 0.0], Y),
                ([0.135, 0.0, 0.0], X),
            ],
            flange: ([0.0; 3], abb),
            base_height: 0.0,
        },
        Chain {
            name: "gp25",
            joints: [
                ([0.0, 0.0, 0.505], Z),
                ([0.15, 0.0, 0.0], Y),
                ([0.0, 0.0, 0.76], back(Y)),
                ([0.0, 0.0, 0.2], back(X)),
                ([0.795, 0.0, 0.0], back(Y)),
                ([0.0, 0.0, 0.0], back(X)),
            ],
            flange: ([0.1, 0.0, 0.0], fanuc),
            base_height: 0.505,
        },
    ]
}

impl Chain {
    /// Products of 4×4 matrices, link after link.
    fn forward(&self, angles: &Joints) -> Matrix4<f64> {
        let shift = |[x, y, z]: [f64; 3]| Matrix4::new_translation(&Vector3::new(x, y, z));
        let mut at = shift([0.0, 0.0, -self.base_height]);
        for ((origin, axis), angle) in self.joints.iter().zip(angles) {
            at = at * shift(*origin) * Matrix4::new_rotation(Vector3::from(*axis) * *angle);
        }
        let (origin, [r, p, y]) = self.flange;
        at * shift(origin) * Matrix4::from_euler_angles(r, p, y)
    }

    /// Where a joint is, from 1.
    fn joint(&self, angles: &Joints, number: usize) -> Point3<f64> {
        let mut at = Matrix4::new_translation(&Vector3::new(0.0, 0.0, -self.base_height));
        let mut place = Point3::origin();
        for ((origin, axis), angle) in self.joints.iter().zip(angles).take(number) {
            at *= Matrix4::new_translation(&Vector3::from(*origin));
            place = at.transform_point(&Point3::origin());
            at *= Matrix4::new_rotation(Vector3::from(*axis) * *angle);
        }
        place
    }
}

fn placed(name: &str) -> PlacedArm {
    PlacedArm {
        arm: Arm::named(name).expect("known"),
        robot_from_base: RigidTransform::identity(),
        flange_from_nozzle: RigidTransform::identity(),
        gun_radius: GUN_RADIUS,
        obstacles: Obstacles::default(),
    }
}

/// A gun held ahead of the flange and bent by 45°, so that its z axis is not joint 6.
fn with_gun(name: &str) -> PlacedArm {
    PlacedArm {
        flange_from_nozzle: from_euler_zyx([0.0, 0.8, 0.0, 0.05, 0.0, 0.2]),
        ..placed(name)
    }
}

fn any_joints(random: &mut Pcg64, arm: &Arm) -> Joints {
    arm.limits.map(|[low, high]| random.random_range(low..high))
}

#[test]
fn forward_kinematics_is_the_product_of_the_links() {
    let mut random = Pcg64::seed_from_u64(1);
    for chain in chains() {
        let placed = placed(chain.name);
        let solver = Solver::new(&placed, 0.0);
        for _ in 0..200 {
            let joints = any_joints(&mut random, &placed.arm);
            let found = solver.forward(&joints).expect("finite").to_homogeneous();
            let off = (found - chain.forward(&joints)).amax();
            assert!(off < 1e-9, "{}: {off}", chain.name);
        }
    }
}

#[test]
fn every_solution_reproduces_its_pose_and_one_is_the_one_it_came_from() {
    let mut random = Pcg64::seed_from_u64(2);
    for chain in chains() {
        let mut placed = with_gun(chain.name);
        placed.robot_from_base = from_euler_zyx([0.1, -0.2, 0.7, 0.4, -0.3, 0.2]);
        let solver = Solver::new(&placed, 0.0);
        let foot_from_gun = |joints: &Joints| {
            placed.robot_from_base.to_homogeneous()
                * chain.forward(joints)
                * placed.flange_from_nozzle.to_homogeneous()
        };
        let mut num_back = 0;
        for _ in 0..200 {
            let joints = any_joints(&mut random, &placed.arm);
            let pose = solver.forward(&joints).expect("finite");
            let found = solver.solutions(&pose, None);
            assert!(!found.is_empty() && found.len() <= 8, "{}", found.len());
            for solution in found.iter().flat_map(|found| solver.within_limits(found)) {
                let off = (foot_from_gun(&solution) - pose.to_homogeneous()).amax();
                assert!(off < 1e-6, "{}: {off}", chain.name);
            }
            let is_same = |found: &Joints| {
                let all = found.iter().zip(&joints);
                all.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) < 1e-5
            };
            let mut all = found.iter().flat_map(|found| solver.within_limits(found));
            num_back += usize::from(all.any(|found| is_same(&found)));
        }
        // Random joints are hardly ever singular.
        assert!(num_back >= 198, "{}: {num_back}", chain.name);
    }
}

#[test]
fn gun_and_arm_are_capsules_from_joint_to_joint_up_to_the_mouth() {
    let mut random = Pcg64::seed_from_u64(3);
    for chain in chains() {
        let placed = with_gun(chain.name);
        let solver = Solver::new(&placed, 0.0);
        for _ in 0..100 {
            let joints = any_joints(&mut random, &placed.arm);
            let [gun, wrist, forearm, step, upper_arm] = solver.bodies(&joints);
            let flange = chain.forward(&joints).transform_point(&Point3::origin());
            let joint = |number| chain.joint(&joints, number);
            for (at, wanted) in [
                (upper_arm.axis.from, joint(2)),
                (upper_arm.axis.to, joint(3)),
                (step.axis.from, joint(3)),
                (step.axis.to, joint(4)),
                (forearm.axis.from, joint(4)),
                (forearm.axis.to, joint(5)),
                (wrist.axis.from, joint(5)),
                (wrist.axis.to, flange),
                (gun.axis.from, flange),
            ] {
                assert!((at - wanted).norm() < 1e-9, "{}: {at}", chain.name);
            }
            // Its round end touches the mouth from behind.
            let mouth = solver.forward(&joints).expect("finite").translation.vector;
            let mouth = Point3::from(mouth);
            assert!(((mouth - gun.axis.to).norm() - GUN_RADIUS).abs() < 1e-9);
            let length = (mouth - flange).norm();
            assert!((gun.axis.length() + GUN_RADIUS - length).abs() < 1e-9);
        }
    }
}

/// A row of points ahead of the arm, the nozzle pointing ahead.
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
            is_turn_free: false,
            is_gun_on: true,
        })
        .collect()
}

fn check(placed: &PlacedArm, points: &[ArmPoint]) -> PathCheck {
    check_path(placed, points, &CheckParams::default()).expect("checked")
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

    // Joint 1 ends 10° to either side: a point at the left is not within it.
    let mut narrow = placed.clone();
    narrow.arm.limits[0] = [-0.17, 0.17];
    let mut left = row(&narrow, 1, 0.0);
    left[0].robot_from_nozzle = Translation3::new(-0.2, 0.8, 0.0) * left[0].robot_from_nozzle;
    let problem = check(&narrow, &left).points[0].problem.clone();
    assert!(
        matches!(problem, Some(PointProblem::JointLimit { joint: 1, .. })),
        "{problem:?}"
    );

    // As fast as no joint turns.
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
        is_turn_free: false,
        is_gun_on: true,
    };
    let problem = check(&bare, &[point]).points[0].problem.clone();
    assert_eq!(
        problem,
        Some(PointProblem::NearSingularity(Singularity::Wrist))
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
        is_turn_free: false,
        is_gun_on: true,
    };
    let found = check(&placed, &[across(-0.8), across(0.8)]);
    assert!(found.points.iter().all(|point| point.joints.is_some()));
    assert!(found.points[1].problem.is_some(), "{:?}", found.points[1]);
}

#[test]
fn a_slow_move_neither_turns_a_joint_once_around_nor_folds_the_arm_over() {
    let mut placed = placed("irb2600");
    let home = placed.clone();
    let solver = Solver::new(&home, 0.0);
    let pose = |joint_6: f64| {
        let joints = [0.0, 0.2, 0.3, 0.0, 0.8, joint_6];
        solver.forward(&joints).expect("finite")
    };
    // 20 mm at 1 mm/s, in which joint 6 turns from 2.95 to 3.1 rad: any joint had the time for a whole turn.
    let poses = [pose(2.95), Translation3::new(0.02, 0.0, 0.0) * pose(3.1)];
    let points = poses.map(|robot_from_nozzle| ArmPoint {
        robot_from_nozzle,
        speed: 0.001,
        is_turn_free: false,
        is_gun_on: true,
    });
    // Shoulder and elbow fold one way only.
    placed.arm.limits[0] = [-0.5, 0.5];
    placed.arm.limits[1] = [-0.3, 0.7];
    placed.arm.limits[2] = [-0.3, 0.9];
    placed.arm.limits[4] = [-1.4, 1.4];
    for (joint_4, joint_6, is_reached) in [
        ([-1.0, 1.0], [-4.0, 4.0], true),
        // Only a whole turn back is left at the second point.
        ([-1.0, 1.0], [-3.2, 3.0], false),
        // Only the other wrist is.
        ([-4.0, 4.0], [-0.1, 3.0], false),
    ] {
        placed.arm.limits[3] = joint_4;
        placed.arm.limits[5] = joint_6;
        let found = check(&placed, &points);
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
    // A wrist that hardly turns.
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
    // z still points the way of the path.
    let solver = Solver::new(&placed, 0.0);
    for (point, wanted) in found.points.iter().zip(&points) {
        let at = solver.forward(&point.joints.expect("one")).expect("finite");
        let off = at * Vector3::z() - wanted.robot_from_nozzle * Vector3::z();
        assert!(off.norm() < 1e-6);
        let shift = at.translation.vector - wanted.robot_from_nozzle.translation.vector;
        assert!(shift.norm() < 1e-6);
    }
}

/// The same arm among boxes: name, middle and edge, metres.
fn among(placed: &PlacedArm, boxes: &[(&str, Point3<f64>, f64)]) -> PlacedArm {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("boxes.toml");
    let mut text = String::new();
    for (name, at, edge) in boxes {
        let [x, y, z] = [at.x, at.y, at.z].map(|x| 1000.0 * x);
        let edge = 1000.0 * edge;
        writeln!(text, "[[box]]\nname = \"{name}\"").expect("written");
        writeln!(text, "centre_mm = [{x:.6}, {y:.6}, {z:.6}]").expect("written");
        writeln!(text, "size_mm = [{edge:.3}, {edge:.3}, {edge:.3}]").expect("written");
    }
    std::fs::write(&path, text).expect("written");
    PlacedArm {
        obstacles: Obstacles::read(&path).expect("boxes"),
        ..placed.clone()
    }
}

/// Where the axis of the gun ends with these joints, farther from the wrist than that is wide.
fn end_of_gun(placed: &PlacedArm, joints: &Joints) -> Point3<f64> {
    let [gun, ..] = Solver::new(placed, 0.0).bodies(joints);
    gun.axis.to
}

/// The elbow with these joints.
fn elbow(placed: &PlacedArm, joints: &Joints) -> Point3<f64> {
    let [.., upper_arm] = Solver::new(placed, 0.0).bodies(joints);
    upper_arm.axis.to
}

fn gun_at(name: &str) -> PointProblem {
    PointProblem::Collision {
        body: Body::Gun,
        obstacle: Obstacle::Box(name.into()),
    }
}

#[test]
fn a_box_beside_the_gun_is_run_into_as_far_as_gun_and_clearance_reach() {
    let placed = with_gun("irb2600");
    let points = row(&placed, 60, 0.3);
    let free = check(&placed, &points);
    assert_eq!(free.num_collisions(), 0);
    let end = end_of_gun(&placed, &free.points[30].joints.expect("reached"));
    let blocked = among(&placed, &[("post", end, 0.02)]);
    let found = check(&blocked, &points);
    for (checked, point) in found.points.iter().zip(&points) {
        // The gun's own 50 mm, 20 of clearance and half the box.
        let aside = (point.robot_from_nozzle.translation.vector.y - end.y).abs();
        if (aside - 0.08).abs() < 1e-3 {
            continue;
        }
        let wanted = (aside < 0.08).then(|| gun_at("post"));
        assert_eq!(checked.problem, wanted, "{aside}");
    }
    assert_eq!(found.num_reached() + found.num_collisions(), 60);
    let doubt = found.doubt("arm").expect("collides");
    assert!(doubt.contains(&format!("would collide at {}", found.num_collisions())));
    let problem = gun_at("post");
    assert_eq!(problem.describe(), "the gun is too near to the box post");
    assert_eq!(problem.kind(), "collision");
    // A wider clearance finds more.
    let mut wider = blocked.clone();
    wider.obstacles.clearance = 0.06;
    assert!(check(&wider, &points).num_collisions() > found.num_collisions() + 10);
    // The order of the boxes changes nothing.
    let twin = ("twin", end, 0.02);
    let post = ("post", end, 0.02);
    assert_eq!(
        check(&among(&placed, &[post, twin]), &points),
        check(&among(&placed, &[twin, post]), &points)
    );
}

#[test]
fn what_lies_between_two_points_is_run_into_on_the_way() {
    let placed = with_gun("irb2600");
    // Half a metre to the left.
    let points = row(&placed, 2, 1.0);
    let free = check(&placed, &points);
    assert_eq!(free.num_reached(), 2, "{free:?}");
    let begins = end_of_gun(&placed, &free.points[0].joints.expect("reached"));
    let half_way = begins + Vector3::new(0.0, 0.25, 0.0);
    let found = check(&among(&placed, &[("post", half_way, 0.02)]), &points);
    assert_eq!(found.points[0].problem, None);
    assert_eq!(found.points[1].problem, Some(gun_at("post")));
    // A second behind both is none.
    let aside = begins - Vector3::new(0.0, 0.25, 0.0);
    let found = check(&among(&placed, &[("post", aside, 0.02)]), &points);
    assert_eq!(found.num_reached(), 2, "{found:?}");
}

#[test]
fn a_free_configuration_is_preferred_to_one_that_collides() {
    let mut placed = with_gun("irb2600");
    // All eight configurations are within the limits.
    placed.arm.limits = [[-4.0, 4.0]; 6];
    let points = row(&placed, 60, 0.3);
    let free = check(&placed, &points);
    assert_eq!(free.num_reached(), 60, "{free:?}");
    let former = free.points[30].joints.expect("reached");
    let blocked = among(&placed, &[("lamp", elbow(&placed, &former), 0.1)]);
    let solver = Solver::new(&blocked, 0.0);
    assert!(free.points.iter().all(|point| {
        let joints = point.joints.expect("reached");
        solver.collides(&joints)
    }));
    let found = check(&blocked, &points);
    assert_eq!(found.num_reached(), 60, "{found:?}");
    let joints = found.points[30].joints.expect("reached");
    let folds = |joints: &Joints| blocked.arm.configuration(joints);
    assert_ne!(folds(&joints), folds(&former));

    // With none left the point is reached, but says what is in the way.
    let mut bound = with_gun("irb2600");
    bound.arm.limits[0] = [-1.0, 1.0];
    let only = check(&bound, &points).points[30].joints.expect("reached");
    let bound = among(&bound, &[("lamp", elbow(&bound, &only), 0.1)]);
    let found = check(&bound, &points);
    assert_eq!(found.num_collisions(), 60, "{found:?}");
    assert!(found.points.iter().all(|point| point.joints.is_some()));
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
    let base = suggest_base(&blocked, &points, &params, num).expect("searched");
    let base = base.expect("a better one");
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
fn a_better_place_is_suggested() {
    let mut placed = with_gun("irb2600");
    let points = row(&placed, 30, 0.4);
    placed.robot_from_base = Translation3::new(-0.8, 0.0, 0.0).into();
    let params = CheckParams::default();
    let num = check(&placed, &points).num_reached();
    assert!(num < 30);
    let base = suggest_base(&placed, &points, &params, num).expect("searched");
    let base = base.expect("a better one");
    assert_eq!(base.num_reached, 30);
    assert!(base.shift[0] > 0.1, "{base:?}");
    assert_eq!(
        suggest_base(&placed, &points, &params, 30).expect("searched"),
        None
    );

    placed.arm.rail = Some(Rail {
        direction: Vector3::x_axis(),
        range: [-0.5, 2.0],
        speed: None,
    });
    let rail = suggest_rail(&placed, &points, &params, num).expect("searched");
    let rail = rail.expect("a better one");
    assert_eq!(rail.num_reached, 30);
    let there = CheckParams {
        rail: rail.shift[0],
        ..params
    };
    let again = check_path(&placed, &points, &there).expect("checked");
    assert_eq!(again.num_reached(), 30);
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
        assert!(error.contains("clearance"), "{error}");
    }
}

#[test]
fn an_arm_of_a_file_is_the_same_and_wrong_numbers_are_named() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("arm.toml");
    let text = "name = \"Cell 3\"\n\
        lengths_mm = [150, -200, 0, 505, 760, 795, 100]\n\
        offsets_deg = [0, 0, -90, 0, 0, 180]\n\
        signs = [1, 1, -1, -1, -1, -1]\n\
        limits_deg = [[-180, 180], [-105, 155], [-86, 160], [-200, 200], [-155, 150], [-455, 455]]\n\
        speeds_deg_s = [210, 210, 265, 420, 420, 885]\n\
        base_height_mm = 505\n\
        radii_mm = [140, 125, 80]\n";
    let read = |text: &str| {
        std::fs::write(&path, text).expect("written");
        Arm::named(path.to_str().expect("a path"))
    };
    let listed = Arm::named("gp25").expect("listed");
    let found = read(text).expect("an arm");
    // Nobody says whose controller counts its joints.
    assert_eq!(found.maker(), None);
    assert_eq!(
        Arm {
            name: listed.name.clone(),
            maker: listed.maker(),
            ..found
        },
        listed
    );
    // Without radii those of the reach count: 0.76 m and 0.795 m with a step of 0.2 m.
    let bare = read(&text.replace("radii_mm = [140, 125, 80]\n", "")).expect("an arm");
    let wanted = [0.158, 0.1422, 0.0948];
    let off = bare.radii.iter().zip(wanted).map(|(a, b)| (a - b).abs());
    assert!(off.fold(0.0, f64::max) < 1e-3, "{:?}", bare.radii);
    let rail = "[rail]\ndirection = [0, 2, 0]\nfrom_mm = -2000\nto_mm = 1500\n";
    let found = read(&format!("{text}{rail}")).expect("an arm").rail;
    let wanted = Rail {
        direction: Vector3::y_axis(),
        range: [-2.0, 1.5],
        speed: None,
    };
    assert_eq!(found, Some(wanted));
    // The same as an option has it, and one that moves.
    assert_eq!("y,-2000,1500".parse::<Rail>().expect("a rail"), wanted);
    let moving = Rail {
        direction: Unit::new_normalize(-Vector3::x()),
        range: [-2.0, 1.5],
        speed: Some(0.8),
    };
    let found: Rail = " -x, -2000, 1500, 800 ".parse().expect("a rail");
    assert_eq!(found, moving);
    let text_of = rail.replace("[0, 2, 0]", "[-3, 0, 0]");
    let found = read(&format!("{text}{text_of}speed_mm_s = 800\n"));
    assert_eq!(found.expect("an arm").rail, Some(moving));
    for (option, wanted) in [
        ("", "no rail"),
        ("y", "no rail"),
        ("y,1", "no rail"),
        ("w,0,1", "no rail"),
        ("y,0,1,2,3", "no rail"),
        ("y,0,one", "no rail"),
        ("y,5,-5", "runs from 5 to -5 mm"),
        ("y,nan,5", "runs from"),
        ("y,0,inf", "runs from"),
        ("y,0,900000", "runs from"),
        ("y,0,5,0", "speed"),
        ("y,0,5,-1", "speed"),
        ("y,0,5,nan", "speed"),
        ("y,0,5,0.9", "speed"),
        ("y,0,5,10001", "speed"),
    ] {
        let error = option.parse::<Rail>().expect_err(option);
        assert!(!error.advice().is_empty());
        assert!(error.to_string().contains(wanted), "{option}: {error}");
    }
    for (old, new, wanted) in [
        ("[-86, 160]", "[160, -86]", "joint 3"),
        ("210, 210", "210, 0", "speed of joint 2"),
        ("[1, 1, -1", "[1, 2, -1", "sign of joint 2"),
        ("760", "0", "c2"),
        ("505, 760", "nan, 760", "c1"),
        ("-90, 0", "-900, 0", "offset of joint 3"),
        ("signs", "sings", "sings"),
        ("140, 125", "140, -1", "radius of the forearm"),
        ("140, 125", "nan, 125", "radius of the upper arm"),
        ("[150, ", "[", "7"),
    ] {
        let error = read(&text.replace(old, new)).expect_err(new);
        assert!(error.to_string().contains(wanted), "{new}: {error}");
        assert!(!error.advice().is_empty());
    }
    for rail in [
        rail.replace("2000", "nan"),
        rail.replace("-2000", "3000"),
        rail.replace("2, 0", "0, 0"),
        rail.replace("2, 0", "1e200, 0"),
        rail.replace("1500", "150000"),
        format!("{rail}speed_mm_s = 0\n"),
        format!("{rail}speed_mm_s = nan\n"),
    ] {
        let error = read(&format!("{text}{rail}")).expect_err("no rail");
        assert!(error.to_string().contains("rail"), "{error}");
    }
}
