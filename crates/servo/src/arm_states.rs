//! Where the arm was a moment ago.

use std::{collections::VecDeque, time::Duration};

use nalgebra::Point3;

use crate::twist::part_way;
use geometry::rigid::{RigidTransform, pose_error};
use robot::arm::Joints;

/// The arm as its controller reports it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ArmState {
    /// Time of the report; frames are dated by the same clock.
    pub at: Duration,
    /// Pose of the flange in the base frame.
    pub robot_from_flange: RigidTransform,
    /// Angles of the joints, if the controller tells them.
    pub joints: Option<Joints>,
}

/// The arm's poses of the last seconds.
#[derive(Clone, Debug, Default)]
pub(crate) struct ArmStates {
    states: VecDeque<(Duration, RigidTransform)>,
}

/// Longer than any delay that is not stale.
const MAX_STATE_AGE: Duration = Duration::from_secs(5);
/// The arm is at rest while its flange moves by no more than this: metres and radians.
const REST_MAX_MOTION_M_RAD: (f64, f64) = (5e-5, 5e-5);

impl ArmStates {
    pub(crate) fn push(&mut self, state: &ArmState) {
        self.states.push_back((state.at, state.robot_from_flange));
        while (self.states.front()).is_some_and(|(at, _)| *at + MAX_STATE_AGE < state.at) {
            self.states.pop_front();
        }
    }

    pub(crate) fn poses_since(&self, since: Duration) -> impl Iterator<Item = &RigidTransform> {
        let newest_first = self.states.iter().rev();
        let lately = newest_first.take_while(move |(at, _)| *at >= since);
        lately.map(|(_, pose)| pose)
    }

    /// The flange's pose at this time, interpolated between reports; `None` before the first and after the last.
    pub(crate) fn pose_at(&self, at: Duration) -> Option<RigidTransform> {
        let next = self.states.partition_point(|(time, _)| *time < at);
        let (to_at, to) = self.states.get(next)?;
        if *to_at == at {
            return Some(*to);
        }
        let (from_at, from) = self.states.get(next.checked_sub(1)?)?;
        let seconds = |time: &Duration| time.saturating_sub(*from_at).as_secs_f64();
        let share = seconds(&at) / seconds(to_at);
        Some(part_way(from, to, &Point3::origin(), share))
    }

    /// Since when the arm has stood where it stands now.
    pub(crate) fn rest_since(&self) -> Option<Duration> {
        let (_, now) = self.states.back()?;
        let still = self.states.iter().rev().take_while(|(_, pose)| {
            let off = pose_error(pose, now, &Point3::origin());
            off.shift.0 <= REST_MAX_MOTION_M_RAD.0 && off.rotation.0 <= REST_MAX_MOTION_M_RAD.1
        });
        still.last().map(|(at, _)| *at)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use geometry::rigid::from_euler_zyx;

    fn state(millis: u64, x: f64) -> ArmState {
        ArmState {
            at: Duration::from_millis(millis),
            robot_from_flange: from_euler_zyx([0.0, 0.0, x, x, 0.0, 1.0]),
            joints: None,
        }
    }

    #[test]
    fn between_two_reports_the_pose_is_in_between_and_beyond_them_unknown() {
        let mut states = ArmStates::default();
        states.push(&state(100, 0.1));
        states.push(&state(140, 0.2));
        let at = |millis| states.pose_at(Duration::from_millis(millis));
        let quarter = at(110).expect("known");
        assert!((quarter.translation.x - 0.125).abs() < 1e-12);
        assert!((quarter.rotation.angle() - 0.125).abs() < 1e-12);
        assert_eq!(at(140), Some(state(140, 0.2).robot_from_flange));
        assert_eq!((at(99), at(141)), (None, None));
    }

    #[test]
    fn rest_begins_with_the_last_motion() {
        let mut states = ArmStates::default();
        for (millis, x) in [(0, 0.0), (10, 0.1), (20, 0.2), (30, 0.2), (40, 0.20001)] {
            states.push(&state(millis, x));
        }
        assert_eq!(states.rest_since(), Some(Duration::from_millis(20)));
    }
}
