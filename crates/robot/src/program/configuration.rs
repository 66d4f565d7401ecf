//! The configuration of an arm at a point in each controller's notation, from the joints found by the check of its
//! reach. The languages' files say what their words mean.
//!
//! Front and back are the sides of joint 1 on which the centre of the wrist may lie; the elbow is up if the forearm
//! bends forward from the upper arm. Both follow from the arm's lengths, so they change exactly where the arm is
//! singular.
//!
//! How a controller counts the joints of an arm from a file is unknown: without a maker, or with another maker's language,
//! there is no configuration.

use crate::arm::{Arm, Joints};

/// Joints are rounded to this many steps per degree before they are compared, as fine as poses are written.
const STEPS_PER_DEGREE: f64 = 1e4;

/// How an arm stands.
pub(super) struct Posture {
    /// True if the centre of the wrist is in front of joint 1.
    pub(super) is_ahead: bool,
    pub(super) is_elbow_up: bool,
    /// The joints, degrees, as the controller counts them.
    pub(super) degrees: [f64; 6],
}

impl Posture {
    /// How an arm stands with these joints.
    pub(super) fn of(arm: &Arm, joints: &Joints) -> Self {
        let [is_ahead, is_elbow_up, _] = arm.configuration(joints);
        Self {
            is_ahead,
            is_elbow_up,
            degrees: joints
                .map(|angle| (angle.to_degrees() * STEPS_PER_DEGREE).round() / STEPS_PER_DEGREE),
        }
    }
}
