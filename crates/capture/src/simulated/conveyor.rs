//! The conveyor line of the simulated cell: parts swing in one after the other, hang still, and swing out.

use nalgebra::{Point3, Rotation3, Translation3, Vector3};

use geometry::rigid::RigidTransform;

/// Time in which a part comes in, seconds.
const ARRIVAL_TIME_S: f64 = 1.2;
/// Time in which a part leaves, seconds.
const DEPARTURE_TIME_S: f64 = 0.8;
/// Distance from which parts come in, metres: outside the picture, even for the longest part at the farthest position.
pub(super) const PART_START_DISTANCE_M: f64 = 2.5;
/// Distance from which racks come in, metres: outside the picture, even for the widest one.
pub(super) const RACK_START_DISTANCE_M: f64 = 4.0;
/// Height of the hook from which a part swings, above the part's middle, metres.
const HOOK_HEIGHT_M: f64 = 0.8;
/// Amplitude of the swing when the part stops, radians. After 1.5 s less than 0.1 mm remains of it.
const SWING_AMPLITUDE_RAD: f64 = 0.05;
/// Time in which the amplitude falls by a factor of e, seconds.
const SWING_DECAY_S: f64 = 0.25;
/// Frequency of the swing, Hz.
const SWING_FREQUENCY_HZ: f64 = 1.1;

/// The state of the line at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ConveyorState {
    /// Number of the part, from 0.
    pub(super) visit: u64,
    /// Seconds since the part began to come in.
    since: f64,
    /// Seconds until the next part begins to come in.
    left: f64,
}

impl ConveyorState {
    /// The state `seconds` after the start, with a new part every `every` seconds.
    pub(super) fn at(seconds: f64, every: f64) -> Self {
        let visit = (seconds / every).floor();
        let since = seconds - visit * every;
        Self {
            visit: visit as u64,
            since,
            left: every - since,
        }
    }

    /// The present pose of the part or rack that rests at `rest_pose` and comes from this distance, metres.
    pub(super) fn camera_from_part(
        &self,
        rest_pose: &RigidTransform,
        start_distance_m: f64,
    ) -> RigidTransform {
        let coming = (1.0 - self.since / ARRIVAL_TIME_S).max(0.0);
        let leaving = (1.0 - self.left / DEPARTURE_TIME_S).max(0.0);
        // Decelerates when coming, accelerates when leaving; the line runs to the left.
        let aside = start_distance_m * (coming.powi(3) - leaving.powi(3));
        let settling = (self.since - ARRIVAL_TIME_S).max(0.0);
        let angle = SWING_AMPLITUDE_RAD
            * (-settling / SWING_DECAY_S).exp()
            * (std::f64::consts::TAU * SWING_FREQUENCY_HZ * settling).sin();
        let middle = Point3::from(rest_pose.translation.vector);
        let hook = middle - Vector3::y() * HOOK_HEIGHT_M;
        let swing = Rotation3::from_axis_angle(&Vector3::z_axis(), angle);
        Translation3::new(aside, 0.0, 0.0)
            * Translation3::from(hook.coords)
            * nalgebra::UnitQuaternion::from_rotation_matrix(&swing)
            * Translation3::from(-hook.coords)
            * rest_pose
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_part_comes_in_from_outside_hangs_still_and_leaves_without_a_jump() {
        let rest_pose = RigidTransform::translation(0.1, -0.05, 1.3);
        let every = 6.0;
        let at = |seconds: f64| {
            let state = ConveyorState::at(seconds, every);
            state.camera_from_part(&rest_pose, PART_START_DISTANCE_M)
        };
        let x = |seconds: f64| at(seconds).translation.x - rest_pose.translation.x;
        assert!((x(0.0) - PART_START_DISTANCE_M).abs() < 1e-9);
        assert!((x(every - 1e-9) + PART_START_DISTANCE_M).abs() < 1e-6);
        let mut still = 0;
        for k in 0..(every * 100.0) as usize - 1 {
            let (here, next) = (at(k as f64 / 100.0), at((k + 1) as f64 / 100.0));
            let step = (next.translation.vector - here.translation.vector).norm();
            assert!(step < 0.1, "a jump of {step} m at {k}");
            let off = (here.translation.vector - rest_pose.translation.vector).norm();
            let turned = here.rotation.angle_to(&rest_pose.rotation);
            still += usize::from(off < 1e-4 && turned < 1e-4);
        }
        assert!(still > 220, "still for {still} hundredths of a second");
    }

    #[test]
    fn the_next_part_follows() {
        assert_eq!(ConveyorState::at(0.0, 4.0).visit, 0);
        assert_eq!(ConveyorState::at(3.99, 4.0).visit, 0);
        assert_eq!(ConveyorState::at(4.0, 4.0).visit, 1);
        assert_eq!(ConveyorState::at(41.0, 4.0).visit, 10);
    }
}
