//! Three angles for a rotation: R = R₁(α) · R₂(β) · R₃(γ). Read from the left, they are turns about axes that move
//! along (intrinsic); from the right, turns about fixed axes (extrinsic).
//!
//! α is computed from two entries of R, and γ from R with α undone. So γ compensates for an error of α, which is large
//! near gimbal lock, and the product stays accurate to the last digits.
//! (K. Shoemake, "Euler angle conversion", Graphics Gems IV, 1994, names the cases.)

use nalgebra::{Matrix3, UnitQuaternion, Vector3};

use super::robot_pose::GimbalLock;

/// The axes, from left to right.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Order {
    /// Rz · Ry · Rx; β within ±90°.
    Zyx,
    /// Rx · Ry · Rz; β within ±90°.
    Xyz,
    /// Rz · Ry · Rz; β from 0 to 180°.
    Zyz,
}

/// In gimbal lock α and γ turn about one axis. Below this sine of the angle between their axes, only their sum or
/// difference is known to the last digits; γ is then set to 0, with an error of the same size.
const LOCKED_MAX_SINE: f64 = 1e-10;
/// Below this sine, a tenth of a degree in the pose can change α and γ by ten degrees.
const NEAR_LOCK_MAX_SINE: f64 = 0.01;

impl Order {
    /// Returns the angles α, β, γ in radians, each within ±π, and how near they are to gimbal lock.
    pub(super) fn angles(self, rotation: &UnitQuaternion<f64>) -> ([f64; 3], GimbalLock) {
        let r: Matrix3<f64> = *rotation.to_rotation_matrix().matrix();
        // Sine and cosine of α, times the sine of the angle between the first and the third axis.
        let (sin, cos) = match self {
            Self::Zyx => (r[(1, 0)], r[(0, 0)]),
            Self::Xyz => (-r[(1, 2)], r[(2, 2)]),
            Self::Zyz => (r[(1, 2)], r[(0, 2)]),
        };
        let aside = sin.hypot(cos);
        let is_locked = aside < LOCKED_MAX_SINE;
        let alpha = if is_locked {
            // With γ = 0 the second column of R is the y axis turned by α alone.
            match self {
                Self::Zyx | Self::Zyz => (-r[(0, 1)]).atan2(r[(1, 1)]),
                Self::Xyz => r[(2, 1)].atan2(r[(1, 1)]),
            }
        } else {
            sin.atan2(cos)
        };
        let beta = match self {
            Self::Zyx => (-r[(2, 0)]).atan2(aside),
            Self::Xyz => r[(0, 2)].atan2(aside),
            Self::Zyz => aside.atan2(r[(2, 2)]),
        };
        let (s, c) = alpha.sin_cos();
        // The second row of R₁(-α) · R, which is [sin γ, cos γ, 0] or, for X as the last axis, [0, cos γ, -sin γ].
        let gamma = match self {
            _ if is_locked => 0.0,
            Self::Zyx => (s * r[(0, 2)] - c * r[(1, 2)]).atan2(c * r[(1, 1)] - s * r[(0, 1)]),
            Self::Xyz => (c * r[(1, 0)] + s * r[(2, 0)]).atan2(c * r[(1, 1)] + s * r[(2, 1)]),
            Self::Zyz => (c * r[(1, 0)] - s * r[(0, 0)]).atan2(c * r[(1, 1)] - s * r[(0, 1)]),
        };
        let lock = if is_locked {
            GimbalLock::Locked
        } else if aside < NEAR_LOCK_MAX_SINE {
            GimbalLock::Near
        } else {
            GimbalLock::Clear
        };
        ([alpha, beta, gamma], lock)
    }

    /// Returns the rotation by the angles α, β, γ in radians.
    pub(super) fn rotation(self, [alpha, beta, gamma]: [f64; 3]) -> UnitQuaternion<f64> {
        let about = |axis: Vector3<f64>, angle| UnitQuaternion::from_scaled_axis(axis * angle);
        let (x, y, z) = (Vector3::x(), Vector3::y(), Vector3::z());
        let (first, last) = match self {
            Self::Zyx => (z, x),
            Self::Xyz => (x, z),
            Self::Zyz => (z, z),
        };
        about(first, alpha) * about(y, beta) * about(last, gamma)
    }
}
