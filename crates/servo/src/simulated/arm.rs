//! A simulated arm and its controller.
//!
//! The controller follows streamed poses after a delay, within the joints' speeds and accelerations, and reports the angles of
//! its motors. With backlash the joints lag behind their motors in either direction, so that the flange is not quite where it
//! is reported.

use std::{collections::VecDeque, time::Duration};

use crate::{ArmState, StopReason};
use geometry::rigid::RigidTransform;
use robot::arm::{Joints, PlacedArm};

/// How a simulated arm moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ArmDynamics {
    /// Time between two states of the arm.
    pub period: Duration,
    /// Time from a command to its execution.
    pub delay: Duration,
    /// Greatest acceleration of each joint, rad/s².
    pub acceleration: f64,
    /// Half the play of each joint, radians.
    pub backlash: f64,
}

impl Default for ArmDynamics {
    fn default() -> Self {
        Self {
            period: Duration::from_millis(12),
            delay: Duration::from_millis(24),
            acceleration: 8.0,
            backlash: 0.003_f64.to_radians(),
        }
    }
}

/// Most periods in which the arm goes anywhere: two minutes of the default ones.
const MAX_PERIODS: usize = 10_000;
/// Angles from the target, and speeds, below which the arm is at rest: radians, and radians per second.
const AT_REST: f64 = 1e-9;

/// An arm that follows poses of its flange.
#[derive(Clone, Debug)]
pub struct SimulatedArm {
    placed: PlacedArm,
    dynamics: ArmDynamics,
    now: Duration,
    pending: VecDeque<(Duration, RigidTransform)>,
    target: Joints,
    motors: Joints,
    speeds: Joints,
    joints: Joints,
    num_unreachable: usize,
}

impl SimulatedArm {
    /// An arm at rest at these joints; `None` if they are not finite.
    pub fn new(placed: PlacedArm, joints: Joints, dynamics: ArmDynamics) -> Option<Self> {
        placed.nozzle_pose(&joints)?;
        Some(Self {
            placed,
            dynamics,
            now: Duration::ZERO,
            pending: VecDeque::new(),
            target: joints,
            motors: joints,
            speeds: [0.0; 6],
            joints,
            num_unreachable: 0,
        })
    }

    /// Sends a pose of the flange.
    pub fn send(&mut self, robot_from_flange: RigidTransform) {
        self.pending
            .push_back((self.now + self.dynamics.delay, robot_from_flange));
    }

    /// Goes there and comes to rest; returns why, if it cannot, and stays.
    pub fn go(&mut self, robot_from_flange: &RigidTransform) -> Result<(), StopReason> {
        let robot_from_nozzle = robot_from_flange * self.placed.flange_from_nozzle;
        self.target = self.placed.joints_near(&robot_from_nozzle, &self.target)?;
        self.pending.clear();
        for _ in 0..MAX_PERIODS {
            self.advance();
            let is_there = (self.motors.iter().zip(&self.target))
                .all(|(motor, target)| (motor - target).abs() < AT_REST);
            if is_there && self.speeds.iter().all(|speed| speed.abs() < AT_REST) {
                break;
            }
        }
        Ok(())
    }

    /// Moves on by a period.
    pub fn advance(&mut self) {
        self.now += self.dynamics.period;
        while let Some((_, pose)) = self.pending.pop_front_if(|(due, _)| *due <= self.now) {
            let robot_from_nozzle = pose * self.placed.flange_from_nozzle;
            match self.placed.joints_near(&robot_from_nozzle, &self.target) {
                Ok(joints) => self.target = joints,
                Err(_) => self.num_unreachable += 1,
            }
        }
        let dt = self.dynamics.period.as_secs_f64();
        let most_change = self.dynamics.acceleration * dt;
        for joint in 0..6 {
            let off = self.target[joint] - self.motors[joint];
            // As fast as it can still brake.
            let brakes = (2.0 * self.dynamics.acceleration * off.abs()).sqrt();
            let most = self.placed.arm.joint_speeds()[joint].min(brakes);
            let wanted = (off / dt).clamp(-most, most);
            let change = wanted - self.speeds[joint];
            self.speeds[joint] += change.clamp(-most_change, most_change);
            self.motors[joint] += self.speeds[joint] * dt;
            let (motor, play) = (self.motors[joint], self.dynamics.backlash);
            self.joints[joint] = self.joints[joint].clamp(motor - play, motor + play);
        }
    }

    /// The state that the controller reports.
    pub fn state(&self) -> ArmState {
        ArmState {
            at: self.now,
            robot_from_flange: self.flange(&self.motors),
            joints: Some(self.motors),
        }
    }

    /// Where the flange really is.
    pub fn true_flange(&self) -> RigidTransform {
        self.flange(&self.joints)
    }

    /// Time between two reports.
    pub fn period(&self) -> Duration {
        self.dynamics.period
    }

    /// Number of commands that it could not follow.
    pub fn num_unreachable(&self) -> usize {
        self.num_unreachable
    }

    fn flange(&self, joints: &Joints) -> RigidTransform {
        let nozzle = self.placed.nozzle_pose(joints).expect("finite joints");
        nozzle * self.placed.flange_from_nozzle.inverse()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use geometry::rigid::pose_error;
    use nalgebra::Point3;
    use robot::arm::{Arm, GUN_RADIUS_M, Obstacles};

    const START: Joints = [0.2, 0.3, 0.1, 0.3, 0.7, -0.2];

    fn arm(dynamics: ArmDynamics) -> SimulatedArm {
        let placed = PlacedArm {
            arm: Arm::named("irb4600").expect("built in"),
            robot_from_base: RigidTransform::identity(),
            flange_from_nozzle: RigidTransform::translation(0.0, 0.0, 0.2),
            gun_radius: GUN_RADIUS_M,
            obstacles: Obstacles::default(),
        };
        SimulatedArm::new(placed, START, dynamics).expect("finite")
    }

    #[test]
    fn it_follows_after_its_delay_and_reports_where_its_motors_are() {
        let dynamics = ArmDynamics {
            delay: Duration::from_millis(60),
            ..ArmDynamics::default()
        };
        let mut arm = arm(dynamics);
        let start = arm.state().robot_from_flange;
        let goal = RigidTransform::translation(0.02, 0.0, -0.01) * start;
        arm.send(goal);
        for _ in 0..4 {
            arm.advance();
            assert_eq!(arm.state().robot_from_flange, start);
        }
        for _ in 0..100 {
            arm.advance();
        }
        let at = Point3::origin();
        let reported = pose_error(&arm.state().robot_from_flange, &goal, &at);
        assert!(reported.shift.0 < 1e-6, "{reported:?}");
        let true_off = pose_error(&arm.true_flange(), &goal, &at);
        assert!(
            true_off.shift.0 > 1e-5 && true_off.shift.0 < 3e-4,
            "{true_off:?}"
        );
        assert_eq!(arm.num_unreachable(), 0);
    }

    #[test]
    fn it_neither_exceeds_the_joints_limits_nor_overshoots_a_jump() {
        let dynamics = ArmDynamics::default();
        let mut arm = arm(dynamics);
        let goal = RigidTransform::translation(0.3, 0.2, -0.1) * arm.state().robot_from_flange;
        arm.send(goal);
        let dt = dynamics.period.as_secs_f64();
        let (mut before, mut speed) = (START, [0.0; 6]);
        let mut least = f64::INFINITY;
        for _ in 0..300 {
            arm.advance();
            let joints = arm.state().joints.expect("simulated");
            for joint in 0..6 {
                let now = (joints[joint] - before[joint]) / dt;
                assert!(now.abs() <= arm.placed.arm.joint_speeds()[joint] + 1e-9);
                assert!((now - speed[joint]).abs() <= dynamics.acceleration * dt + 1e-9);
                speed[joint] = now;
            }
            before = joints;
            let off = pose_error(&arm.state().robot_from_flange, &goal, &Point3::origin());
            least = least.min(off.shift.0);
        }
        assert!(least < 1e-6, "{least}");
        arm.send(RigidTransform::translation(9.0, 0.0, 0.0));
        for _ in 0..5 {
            arm.advance();
        }
        assert_eq!(arm.num_unreachable(), 1);
    }

    #[test]
    fn it_goes_where_it_is_told_and_comes_to_rest_or_stays_and_says_why() {
        let mut arm = arm(ArmDynamics::default());
        let goal = RigidTransform::translation(0.2, 0.1, -0.1) * arm.state().robot_from_flange;
        arm.go(&goal).expect("within reach");
        let off = pose_error(&arm.state().robot_from_flange, &goal, &Point3::origin());
        assert!(off.shift.0 < 1e-6, "{off:?}");
        let there = arm.true_flange();
        let away = pose_error(&there, &goal, &Point3::origin());
        assert!(
            away.shift.0 > 1e-6 && away.shift.0 < 1e-3,
            "backlash: {away:?}"
        );
        let far = RigidTransform::translation(9.0, 0.0, 0.0);
        assert_eq!(arm.go(&far), Err(StopReason::OutOfReach));
        for _ in 0..20 {
            arm.advance();
        }
        let moved = pose_error(&arm.true_flange(), &there, &Point3::origin());
        assert!(moved.shift.0 < 1e-6, "{moved:?}");
    }
}
