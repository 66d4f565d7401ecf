//! Forward and inverse kinematics, singularities and configurations.

use std::f64::consts::TAU;

use nalgebra::{Isometry3, Point3, Quaternion, Translation3, UnitQuaternion, Vector3};
use rs_opw_kinematics::{
    glam::{DQuat, DVec3},
    kinematic_traits::{Kinematics as _, Pose},
    kinematics_impl::OPWKinematics,
    parameters::opw_kinematics::Parameters,
};
use serde::Serialize;

use super::{
    Arm, PlacedArm, PointProblem,
    obstacles::{Body, Capsule, Nearness, Obstacle, Obstacles, worst},
};
use geometry::{rigid::RigidTransform, segment::Segment};

/// Angles of the six joints, radians.
pub type Joints = [f64; 6];

/// A pose in which the arm cannot move in some direction.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Singularity {
    /// The wrist is straight: joints 4 and 6 turn about one line.
    Wrist,
    /// The arm is stretched out.
    Elbow,
    /// The middle of the wrist is on the axis of joint 1.
    Shoulder,
}

/// Sine of 2°: nearer to a wrist or elbow singularity, joints would have to be too fast.
const NEAR_SINGULAR_SINE: f64 = 0.035;
/// Least distance of the wrist from the axis of joint 1, for the same reason, metres.
const NEAR_AXIS_M: f64 = 0.03;
/// Largest error of a solution in forward kinematics, metres and radians.
const MAX_SOLUTION_ERROR: f64 = 1e-6;

/// The inverse kinematics of an arm, with its obstacles.
pub(super) struct Solver<'a> {
    pub(super) arm: &'a Arm,
    obstacles: &'a Obstacles,
    opw: OPWKinematics,
    base_from_robot: RigidTransform,
    nozzle_from_flange: RigidTransform,
    /// End of the gun's axis on the flange, so that its round end touches the nozzle's mouth.
    gun_end: Point3<f64>,
    gun_radius: f64,
}

impl<'a> Solver<'a> {
    /// A solver for this position of the rail.
    pub(super) fn new(placed: &'a PlacedArm, rail: f64) -> Self {
        let arm = &placed.arm;
        let [a1, a2, b, c1, c2, c3, c4] = arm.lengths;
        let opw = OPWKinematics::new(Parameters {
            a1,
            a2,
            b,
            c1,
            c2,
            c3,
            c4,
            offsets: arm.offsets,
            sign_corrections: arm.signs,
            dof: 6,
        });
        let foot = Translation3::new(0.0, 0.0, -arm.base_height);
        let robot_from_foot =
            Translation3::from(arm.rail_shift(rail)) * placed.robot_from_base * foot;
        let mouth = placed.flange_from_nozzle.translation.vector;
        let gun_radius = placed.checked_gun_radius();
        let way = mouth.try_normalize(0.0).unwrap_or_else(Vector3::zeros);
        Self {
            arm,
            obstacles: &placed.obstacles,
            opw,
            base_from_robot: robot_from_foot.inverse(),
            nozzle_from_flange: placed.flange_from_nozzle.inverse(),
            gun_end: Point3::from(mouth - way * gun_radius),
            gun_radius,
        }
    }

    /// Pose of the nozzle in the frame of the path.
    pub(super) fn forward(&self, joints: &Joints) -> Option<RigidTransform> {
        let foot_from_flange = isometry(&self.opw.try_forward(joints).ok()?);
        Some(self.base_from_robot.inverse() * foot_from_flange * self.nozzle_from_flange.inverse())
    }

    /// The bodies of gun and arm for these joints, which must be finite. Elbow and forearm are one body of two
    /// capsules.
    pub(super) fn bodies(&self, joints: &Joints) -> [Capsule; 5] {
        let robot_from_foot = self.base_from_robot.inverse();
        // Joints 1 to 3, the forearm behind the elbow's offset, the middle of the wrist, the flange.
        let poses = self.opw.forward_with_joint_poses(joints);
        let poses = poses.map(|pose| robot_from_foot * isometry(&pose));
        let [_, shoulder, elbow, forearm, wrist, _] =
            poses.map(|pose| Point3::from(pose.translation.vector));
        let [upper_arm, forearm_radius, _] = self.arm.radii;
        let [gun, wrist_body] = self.gun_and_wrist(&poses[5]);
        let capsule = |body, from, to, radius| Capsule {
            body,
            axis: Segment { from, to },
            radius,
        };
        [
            gun,
            wrist_body,
            capsule(Body::Forearm, forearm, wrist, forearm_radius),
            capsule(Body::Forearm, elbow, forearm, forearm_radius),
            capsule(Body::UpperArm, shoulder, elbow, upper_arm),
        ]
    }

    /// Gun and wrist with the flange at this pose, in whichever configuration and wherever the arm stands.
    fn gun_and_wrist(&self, robot_from_flange: &RigidTransform) -> [Capsule; 2] {
        let [.., c4] = self.arm.lengths;
        let [.., wrist_radius] = self.arm.radii;
        let flange = Point3::from(robot_from_flange.translation.vector);
        let gun = Segment {
            from: flange,
            to: robot_from_flange * self.gun_end,
        };
        let wrist = Segment {
            from: robot_from_flange * Point3::new(0.0, 0.0, -c4),
            to: flange,
        };
        [
            Capsule {
                body: Body::Gun,
                axis: gun,
                radius: self.gun_radius,
            },
            Capsule {
                body: Body::Wrist,
                axis: wrist,
                radius: wrist_radius,
            },
        ]
    }

    /// Axis and radius of the base column.
    fn column(&self) -> (Segment, f64) {
        let robot_from_foot = self.base_from_robot.inverse();
        let [a1, _, _, c1, ..] = self.arm.lengths;
        let [upper_arm, ..] = self.arm.radii;
        let axis = Segment {
            from: robot_from_foot * Point3::origin(),
            to: robot_from_foot * Point3::new(0.0, 0.0, c1),
        };
        (axis, upper_arm.max(a1.abs()))
    }

    /// The part and boxes in which the base column would stand. The floor is not among them.
    pub(super) fn in_column(&self) -> Vec<Obstacle> {
        let (axis, radius) = self.column();
        let column = [Capsule {
            body: Body::UpperArm,
            axis,
            radius,
        }];
        let hit = self.obstacles.pairs(&column);
        let hit = hit.map(|(_, _, obstacle)| obstacle);
        hit.filter(|obstacle| *obstacle != Obstacle::Floor)
            .collect()
    }

    /// How far the arm's foot would be below the floor of the cell, metres; `None` without a floor.
    pub(super) fn foot_below_floor(&self) -> Option<f64> {
        let (axis, _) = self.column();
        Some(self.obstacles.floor? - axis.from.z)
    }

    /// All pairs of the arm's own bodies that are too near.
    fn pairs_of_arm(&self, bodies: &[Capsule; 5]) -> impl Iterator<Item = Nearness> {
        self.obstacles.pairs_of_arm(bodies, self.column())
    }

    /// Whether gun or arm are too near to something.
    pub(super) fn collides(&self, joints: &Joints) -> bool {
        let bodies = self.bodies(joints);
        self.pairs_of_arm(&bodies).next().is_some() || self.obstacles.are_hit_by(&bodies)
    }

    /// Whether gun or wrist are too near to an obstacle of the cell with the nozzle at this pose: then all joints that
    /// reach it collide, wherever the arm stands.
    pub(super) fn gun_collides(&self, robot_from_nozzle: &RigidTransform) -> bool {
        let bodies = self.gun_and_wrist(&(robot_from_nozzle * self.nozzle_from_flange));
        self.obstacles.are_hit_by(&bodies)
    }

    /// As [`Self::collides`], but without what [`Self::gun_collides`] tests.
    pub(super) fn arm_collides(&self, joints: &Joints) -> bool {
        let bodies = self.bodies(joints);
        let [_, _, rest @ ..] = &bodies;
        self.pairs_of_arm(&bodies).next().is_some() || self.obstacles.are_hit_by(rest)
    }

    /// As [`Self::collides`], but finds the worst pair, which takes longer.
    pub(super) fn collision(&self, joints: &Joints) -> Option<PointProblem> {
        let bodies = self.bodies(joints);
        let pairs = self.pairs_of_arm(&bodies);
        let (body, obstacle) = worst(pairs.chain(self.obstacles.pairs(&bodies)))?;
        Some(PointProblem::Collision { body, obstacle })
    }

    /// All solutions within a turn either way, whatever the limits; `near` decides what a singularity leaves free.
    pub(super) fn solutions(
        &self,
        robot_from_nozzle: &RigidTransform,
        near: Option<&Joints>,
    ) -> Vec<Joints> {
        let flange = self.base_from_robot * robot_from_nozzle * self.nozzle_from_flange;
        let (t, q) = (flange.translation.vector, flange.rotation.quaternion());
        let pose = Pose::try_from_parts(
            DVec3::new(t.x, t.y, t.z),
            DQuat::from_xyzw(q.i, q.j, q.k, q.w),
        );
        let Ok(pose) = pose else {
            return Vec::new();
        };
        let mut found = match near {
            Some(near) => self.opw.inverse_continuing(&pose, near),
            None => self.opw.inverse(&pose),
        };
        found.retain(|joints| {
            let off = self.forward(joints).map(|at| {
                let shift = (at.translation.vector - robot_from_nozzle.translation.vector).norm();
                shift.max(at.rotation.angle_to(&robot_from_nozzle.rotation))
            });
            off.is_some_and(|off| off < MAX_SOLUTION_ERROR)
        });
        found
    }

    /// The solution with all whole turns of its joints that are within the limits.
    pub(super) fn within_limits(&self, joints: &Joints) -> Vec<Joints> {
        let mut all = vec![*joints];
        for (i, [low, high]) in self.arm.limits.into_iter().enumerate() {
            all = all
                .iter()
                .flat_map(|joints| {
                    let first = joints[i] + TAU * ((low - joints[i]) / TAU).ceil();
                    let turns = std::iter::successors(Some(first), |angle| Some(angle + TAU));
                    let within = turns.take_while(move |angle| *angle <= high);
                    within.map(|angle| {
                        let mut joints = *joints;
                        joints[i] = angle;
                        joints
                    })
                })
                .collect();
        }
        all
    }

    /// The joint that is farthest beyond its limit, and its angle; `None` if all are within.
    pub(super) fn beyond_limit(&self, joints: &Joints) -> Option<(usize, f64)> {
        let beyond = |i: usize| {
            let [low, high] = self.arm.limits[i];
            // The angle, up to whole turns, that is nearest to the limits.
            let middle = f64::midpoint(low, high);
            let angle = joints[i] - TAU * ((joints[i] - middle) / TAU).round();
            (i, angle, (low - angle).max(angle - high))
        };
        let worst = (0..6).map(beyond).max_by(|a, b| a.2.total_cmp(&b.2))?;
        (worst.2 > 0.0).then_some((worst.0, worst.1))
    }

    /// The singularity nearby, if there is one.
    pub(super) fn singularity(&self, joints: &Joints) -> Option<Singularity> {
        let [ahead, elbow, wrist] = self.arm.shape(joints).map(f64::abs);
        let all = [
            (wrist < NEAR_SINGULAR_SINE, Singularity::Wrist),
            (elbow < NEAR_SINGULAR_SINE, Singularity::Elbow),
            (ahead < NEAR_AXIS_M, Singularity::Shoulder),
        ];
        all.into_iter()
            .find(|(is_near, _)| *is_near)
            .map(|(_, which)| which)
    }
}

impl Arm {
    /// Angles of the model of Brandstötter et al.
    fn model(&self, joints: &Joints) -> Joints {
        std::array::from_fn(|i| joints[i] * f64::from(self.signs[i]) - self.offsets[i])
    }

    /// Signed distance of the wrist from the axis of joint 1, and the sines of the elbow and of joint 5.
    pub(super) fn shape(&self, joints: &Joints) -> [f64; 3] {
        let [a1, a2, _, _, c2, c3, _] = self.lengths;
        let [_, q2, q3, _, q5, _] = self.model(joints);
        let fold = q3 + a2.atan2(c3);
        let ahead = c2 * q2.sin() + a2.hypot(c3) * (q2 + fold).sin() + a1;
        [ahead, fold.sin(), q5.sin()]
    }

    /// The configuration as one bit of eight.
    pub(super) fn configuration_bit(&self, joints: &Joints) -> u8 {
        let [ahead, up, unflipped] = self.configuration(joints).map(u8::from);
        1 << (4 * ahead + 2 * up + unflipped)
    }

    /// The configuration: wrist ahead, elbow up, wrist unflipped. Ahead and up are relative to joint 1 and turn with
    /// it: behind joint 1 an elbow that is up bends the same way.
    pub fn configuration(&self, joints: &Joints) -> [bool; 3] {
        self.shape(joints).map(|x| x > 0.0)
    }
}

fn isometry(pose: &Pose) -> RigidTransform {
    let (t, q) = (pose.translation, pose.rotation);
    let turn = UnitQuaternion::from_quaternion(Quaternion::new(q.w, q.x, q.y, q.z));
    Isometry3::from_parts(Translation3::new(t.x, t.y, t.z), turn)
}
