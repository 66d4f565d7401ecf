//! A smooth motion of the flange within the limits.

use nalgebra::{Point3, Translation3, UnitQuaternion};

use crate::{Limits, Twist};
use geometry::rigid::RigidTransform;

/// Margin to the limits: commanded poses are compared with them by differences of positions over a step.
const SHARE_OF_LIMITS: f64 = 0.98;

/// The commanded pose of the flange and its velocity.
#[derive(Clone, Debug)]
pub(crate) struct Mover {
    pub(crate) robot_from_flange: RigidTransform,
    /// Velocity of the flange's origin, and angular velocity, along the axes of the base.
    velocity: Twist,
    /// Points on the flange whose speeds are limited.
    watched: Vec<Point3<f64>>,
}

impl Mover {
    /// At rest.
    pub(crate) fn new(robot_from_flange: RigidTransform, watched: Vec<Point3<f64>>) -> Self {
        Self {
            robot_from_flange,
            velocity: Twist::ZERO,
            watched,
        }
    }

    pub(crate) fn is_at_rest(&self) -> bool {
        self.velocity == Twist::ZERO
    }

    /// The velocity for this error of a control frame on the flange, as fast as the limits allow.
    pub(crate) fn towards(
        &self,
        error: &Twist,
        flange_from_control: &RigidTransform,
        gain: f64,
        limits: &Limits,
    ) -> Twist {
        let robot_from_control = self.robot_from_flange * flange_from_control;
        let linear = robot_from_control.rotation * error.linear * gain;
        let angular = robot_from_control.rotation * error.angular * gain;
        let flange = Point3::from(self.robot_from_flange.translation.vector);
        let control = Point3::from(robot_from_control.translation.vector);
        let wanted = Twist {
            linear: linear + angular.cross(&(flange - control)),
            angular,
        };
        let (speed, turn) = self.most_of(&wanted);
        let too_fast = (speed / limits.speed).max(turn / limits.turn_speed) / SHARE_OF_LIMITS;
        wanted.scaled(1.0 / too_fast.max(1.0))
    }

    /// Moves on for `dt` seconds, at `wanted` or as near to it as the accelerations allow.
    pub(crate) fn advance(&mut self, wanted: &Twist, limits: &Limits, dt: f64) {
        let change = wanted.plus(&self.velocity.scaled(-1.0));
        let (speed, turn) = self.most_of(&change);
        let too_much = (speed / (limits.acceleration_left() * dt))
            .max(turn / (limits.turn_acceleration * dt))
            / SHARE_OF_LIMITS;
        self.velocity = if too_much <= 1.0 {
            *wanted
        } else {
            self.velocity.plus(&change.scaled(1.0 / too_much))
        };
        self.robot_from_flange = self.after(dt);
    }

    /// The pose at which the robot would come to rest if it braked from now on.
    pub(crate) fn braked(&self, limits: &Limits) -> RigidTransform {
        let (speed, turn) = self.most_of(&self.velocity);
        let time = (speed / limits.acceleration_left()).max(turn / limits.turn_acceleration);
        self.after(0.5 * time / SHARE_OF_LIMITS)
    }

    fn after(&self, seconds: f64) -> RigidTransform {
        let step = self.velocity.scaled(seconds);
        let from = &self.robot_from_flange;
        RigidTransform::from_parts(
            Translation3::from(from.translation.vector + step.linear),
            UnitQuaternion::from_scaled_axis(step.angular) * from.rotation,
        )
    }

    /// The greatest speed of a watched point, and the angular one.
    fn most_of(&self, velocity: &Twist) -> (f64, f64) {
        let origin = Point3::from(self.robot_from_flange.translation.vector);
        let watched = self.watched.iter().map(|point| {
            let point = self.robot_from_flange * point;
            velocity.velocity_of(&point, &origin).norm()
        });
        let speed = watched.fold(velocity.linear.norm(), f64::max);
        (speed, velocity.angular.norm())
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;
    use rand::{RngExt as _, SeedableRng as _};
    use rand_pcg::Pcg64;

    use super::*;
    use geometry::rigid::from_euler_zyx;

    const PERIOD_S: f64 = 0.012;

    /// Moves to one goal after the other, changed while it moves, and returns the poses.
    fn moved(mover: &mut Mover, limits: &Limits, seed: u64) -> Vec<RigidTransform> {
        let mut random = Pcg64::seed_from_u64(seed);
        let control = RigidTransform::translation(0.1, -0.1, 1.3);
        let mut poses = vec![mover.robot_from_flange];
        for _ in 0..20 {
            let mut draw = |size: f64| size * (2.0 * random.random::<f64>() - 1.0);
            let by = from_euler_zyx([0.4, 0.4, 0.4, 0.3, 0.3, 0.3].map(&mut draw));
            let goal = mover.robot_from_flange * control * by;
            for _ in 0..random.random_range(1..120) {
                let error =
                    Twist::from_transform(&((mover.robot_from_flange * control).inverse() * goal));
                let wanted = mover.towards(&error, &control, 2.0, limits);
                mover.advance(&wanted, limits, PERIOD_S);
                poses.push(mover.robot_from_flange);
            }
        }
        poses
    }

    #[test]
    fn whatever_the_goals_no_watched_point_is_faster_or_accelerated_more_than_allowed() {
        let limits = Limits::default();
        let watched = [
            Point3::origin(),
            Point3::new(0.1, 0.05, 0.2),
            Point3::new(0.0, 0.0, 0.5),
        ];
        let mut most = [0.0_f64; 4];
        for seed in 0..10 {
            let mut mover = Mover::new(
                from_euler_zyx([0.3, 1.2, -0.4, 1.0, 0.2, 1.1]),
                watched.to_vec(),
            );
            let poses = moved(&mut mover, &limits, seed);
            for point in watched {
                let at: Vec<Vector3<f64>> = poses.iter().map(|p| (p * point).coords).collect();
                for three in at.windows(3) {
                    let (first, second) = (three[1] - three[0], three[2] - three[1]);
                    most[0] = most[0].max(first.norm() / PERIOD_S);
                    most[1] = most[1].max((second - first).norm() / (PERIOD_S * PERIOD_S));
                }
            }
            for three in poses.windows(3) {
                let turn = |a: &RigidTransform, b: &RigidTransform| {
                    (b.rotation * a.rotation.inverse()).scaled_axis() / PERIOD_S
                };
                let (first, second) = (turn(&three[0], &three[1]), turn(&three[1], &three[2]));
                most[2] = most[2].max(first.norm());
                most[3] = most[3].max((second - first).norm() / PERIOD_S);
            }
        }
        let [speed, acceleration, turn_speed, turn_acceleration] = most;
        assert!(
            speed <= limits.speed && speed > 0.9 * limits.speed,
            "{most:?}"
        );
        assert!(acceleration <= limits.acceleration, "{most:?}");
        assert!(acceleration > 0.8 * limits.acceleration, "{most:?}");
        assert!(turn_speed <= limits.turn_speed, "{most:?}");
        assert!(turn_acceleration <= limits.turn_acceleration, "{most:?}");
    }

    #[test]
    fn the_control_point_goes_straight_to_the_goal_and_the_error_only_falls() {
        let limits = Limits::default();
        let start = from_euler_zyx([0.3, 1.2, -0.4, 1.0, 0.2, 1.1]);
        let control = RigidTransform::translation(0.0, 0.0, 1.3);
        let goal = start * control * from_euler_zyx([0.2, -0.3, 0.25, 0.2, -0.1, 0.05]);
        let mut mover = Mover::new(start, vec![]);
        let (from, to) = ((start * control).translation, goal.translation);
        let line = (to.vector - from.vector).normalize();
        let mut last = f64::INFINITY;
        for _ in 0..2000 {
            let now = mover.robot_from_flange * control;
            let error = Twist::from_transform(&(now.inverse() * goal));
            let size = error.size();
            assert!(size.shift.0 <= last + 1e-9);
            last = size.shift.0;
            let off = now.translation.vector - from.vector;
            assert!((off - line * off.dot(&line)).norm() < 0.002, "{off}");
            let wanted = mover.towards(&error, &control, 2.0, &limits);
            mover.advance(&wanted, &limits, PERIOD_S);
        }
        assert!(last < 1e-6, "{last}");
    }

    #[test]
    fn it_brakes_to_where_it_says() {
        let limits = Limits::default();
        let mut mover = Mover::new(
            from_euler_zyx([0.3, 1.2, -0.4, 1.0, 0.2, 1.1]),
            vec![Point3::new(0.0, 0.0, 0.4)],
        );
        moved(&mut mover, &limits, 3);
        let expected = mover.braked(&limits);
        while !mover.is_at_rest() {
            mover.advance(&Twist::ZERO, &limits, 0.001);
        }
        let off = expected.inverse() * mover.robot_from_flange;
        assert!(off.translation.vector.norm() < 1e-3, "{off}");
        assert!(off.rotation.angle() < 1e-3, "{off}");
    }
}
