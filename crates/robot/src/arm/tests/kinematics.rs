//! Compares the inverse kinematics with products of matrices.

use nalgebra::{Matrix4, Point3};
use rand::{RngExt as _, SeedableRng as _};
use rand_pcg::Pcg64;

use super::*;

/// The chain of links from the makers' drawings: the shift to each joint, its axis, and the turn of the flange.
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
    /// The product of 4×4 matrices, link by link.
    fn forward(&self, angles: &Joints) -> Matrix4<f64> {
        let shift = |[x, y, z]: [f64; 3]| Matrix4::new_translation(&Vector3::new(x, y, z));
        let mut at = shift([0.0, 0.0, -self.base_height]);
        for ((origin, axis), angle) in self.joints.iter().zip(angles) {
            at = at * shift(*origin) * Matrix4::new_rotation(Vector3::from(*axis) * *angle);
        }
        let (origin, [r, p, y]) = self.flange;
        at * shift(origin) * Matrix4::from_euler_angles(r, p, y)
    }

    /// Position of a joint, counted from 1.
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
        // Random joints are rarely singular.
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
            assert!(((mouth - gun.axis.to).norm() - GUN_RADIUS_M).abs() < 1e-9);
            let length = (mouth - flange).norm();
            assert!((gun.axis.length() + GUN_RADIUS_M - length).abs() < 1e-9);
        }
    }
}

#[test]
fn joint_3_of_a_fanuc_is_counted_from_the_horizontal_on_its_pendant() {
    let placed = placed("m-20ia");
    let solver = Solver::new(&placed, 0.0);
    let forearm = |joints: &Joints| {
        let [_, _, forearm, ..] = solver.bodies(joints);
        (forearm.axis.to - forearm.axis.from).normalize()
    };
    let upright = [0.3, 0.0, 0.0, 0.2, 0.4, 0.1];
    // The upper arm leans and the forearm stays horizontal.
    let leaning = [0.3, 0.5, 0.5, 0.2, 0.4, 0.1];
    for joints in [&upright, &leaning] {
        assert!(forearm(joints).z.abs() < 1e-9, "{}", forearm(joints));
        let [_, j2, j3, ..] = placed.arm.on_pendant(joints);
        assert!((j2 - joints[1]).abs() < 1e-12 && j3.abs() < 1e-12);
    }
    assert!((forearm(&upright) - forearm(&leaning)).norm() < 1e-9);
    let other = Arm::named("irb2600").expect("known");
    let shown = other.on_pendant(&leaning).into_iter().zip(leaning);
    assert!(
        shown
            .into_iter()
            .all(|(shown, joint)| (shown - joint).abs() < 1e-12)
    );
}
