//! The difference between two poses, or a velocity, as six numbers.

use nalgebra::{Point3, Translation3, UnitQuaternion, Vector3};

use geometry::{
    rigid::{PoseDelta, RigidTransform},
    units::{Metres, Radians},
};

/// A shift and a rotation vector, or a linear and an angular velocity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Twist {
    /// Metres or m/s.
    pub linear: Vector3<f64>,
    /// Direction of the axis times the angle: radians or rad/s.
    pub angular: Vector3<f64>,
}

impl Twist {
    /// No motion.
    pub const ZERO: Self = Self {
        linear: Vector3::new(0.0, 0.0, 0.0),
        angular: Vector3::new(0.0, 0.0, 0.0),
    };

    /// The shift and the rotation vector of a transform, along the axes of the frame that it leads to.
    pub fn from_transform(transform: &RigidTransform) -> Self {
        Self {
            linear: transform.translation.vector,
            angular: transform.rotation.scaled_axis(),
        }
    }

    /// The transform with this shift and rotation vector; inverse of [`Self::from_transform`].
    pub fn transform(&self) -> RigidTransform {
        RigidTransform::from_parts(
            Translation3::from(self.linear),
            UnitQuaternion::from_scaled_axis(self.angular),
        )
    }

    /// Both multiplied.
    #[must_use]
    pub fn scaled(&self, by: f64) -> Self {
        Self {
            linear: self.linear * by,
            angular: self.angular * by,
        }
    }

    /// The sum of both.
    #[must_use]
    pub fn plus(&self, other: &Self) -> Self {
        Self {
            linear: self.linear + other.linear,
            angular: self.angular + other.angular,
        }
    }

    /// Distance and angle.
    pub fn size(&self) -> PoseDelta {
        PoseDelta {
            shift: Metres(self.linear.norm()),
            rotation: Radians(self.angular.norm()),
        }
    }

    /// Velocity of a point, if `linear` is that of `origin`.
    pub(crate) fn velocity_of(&self, point: &Point3<f64>, origin: &Point3<f64>) -> Vector3<f64> {
        self.linear + self.angular.cross(&(point - origin))
    }
}

/// Whether a difference is within another one.
pub(crate) fn is_within(delta: &PoseDelta, limit: &PoseDelta) -> bool {
    delta.shift <= limit.shift && delta.rotation <= limit.rotation
}

/// A multiple of a difference.
pub(crate) fn scaled(delta: &PoseDelta, by: f64) -> PoseDelta {
    PoseDelta {
        shift: Metres(by * delta.shift.0),
        rotation: Radians(by * delta.rotation.0),
    }
}

/// The pose of share `share` of the way from `from` to `to`: the point at `at`, in the moved frame, goes straight.
pub(crate) fn part_way(
    from: &RigidTransform,
    to: &RigidTransform,
    at: &Point3<f64>,
    share: f64,
) -> RigidTransform {
    let turn = (from.rotation.inverse() * to.rotation).scaled_axis() * share;
    let rotation = from.rotation * UnitQuaternion::from_scaled_axis(turn);
    let point = from * at + (to * at - from * at) * share;
    let shift = point.coords - rotation * at.coords;
    RigidTransform::from_parts(Translation3::from(shift), rotation)
}

#[cfg(test)]
mod tests {
    use super::*;
    use geometry::rigid::from_euler_zyx;

    #[test]
    fn a_transform_is_its_own_twist() {
        let pose = from_euler_zyx([0.4, -0.9, 2.0, 0.3, -0.1, 0.8]);
        let back = Twist::from_transform(&pose).transform();
        assert!((back.to_homogeneous() - pose.to_homogeneous()).norm() < 1e-12);
    }

    #[test]
    fn on_the_way_the_point_goes_straight_and_both_ends_are_met() {
        let from = from_euler_zyx([0.1, 0.5, -0.2, 1.0, 2.0, -1.0]);
        let to = from_euler_zyx([-0.3, 0.2, 0.4, 1.2, 1.9, -0.8]);
        let at = Point3::new(0.2, -0.1, 1.3);
        for (share, end) in [(0.0, from), (1.0, to)] {
            let met = part_way(&from, &to, &at, share).to_homogeneous();
            assert!((met - end.to_homogeneous()).norm() < 1e-12);
        }
        let half = part_way(&from, &to, &at, 0.5);
        assert!((half * at - nalgebra::center(&(from * at), &(to * at))).norm() < 1e-12);
        let turns = [from, to].map(|end| end.rotation.angle_to(&half.rotation));
        assert!((turns[0] - turns[1]).abs() < 1e-12);
    }
}
