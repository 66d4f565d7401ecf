//! The line of the simulated cell: parts swing in one after the other, hang still, and swing out.

use nalgebra::{Point3, Rotation3, Translation3, Vector3};

use crate::geometry::rigid::RigidTransform;

/// Seconds in which a part comes in.
const COMING: f64 = 1.2;
/// Seconds in which it leaves.
const LEAVING: f64 = 0.8;
/// How far it comes from, metres: out of the picture, also of the longest part at the far end of where parts hang.
const OUTSIDE: f64 = 2.5;
/// How far above the part's middle the hook is that it swings from, metres.
const HOOK_ABOVE: f64 = 0.8;
/// The first swing after it stopped, radians. After a second and a half less than 0.1 mm is left of it.
const SWING: f64 = 0.05;
/// Seconds in which the swing becomes e times smaller.
const SWING_FADES: f64 = 0.25;
/// Swings a second.
const SWINGS_PER_SECOND: f64 = 1.1;

/// A moment of the line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ConveyorState {
    /// Which part it is, from 0.
    pub(super) visit: u64,
    /// Seconds since that part began to come in.
    since: f64,
    /// Seconds until the next one begins.
    left: f64,
}

impl ConveyorState {
    /// What the line does `seconds` after it started, with a new part every so many seconds.
    pub(super) fn of(seconds: f64, every: f64) -> Self {
        let visit = (seconds / every).floor();
        let since = seconds - visit * every;
        Self {
            visit: visit as u64,
            since,
            left: every - since,
        }
    }

    /// Where the part is now that hangs here when at rest.
    pub(super) fn camera_from_part(&self, rest_pose: &RigidTransform) -> RigidTransform {
        let coming = (1.0 - self.since / COMING).max(0.0);
        let leaving = (1.0 - self.left / LEAVING).max(0.0);
        // Slows down as it comes, gathers speed as it leaves; the line runs to the left.
        let aside = OUTSIDE * (coming.powi(3) - leaving.powi(3));
        let settling = (self.since - COMING).max(0.0);
        let angle = SWING
            * (-settling / SWING_FADES).exp()
            * (std::f64::consts::TAU * SWINGS_PER_SECOND * settling).sin();
        let middle = Point3::from(rest_pose.translation.vector);
        let hook = middle - Vector3::y() * HOOK_ABOVE;
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
        let at = |seconds: f64| ConveyorState::of(seconds, every).camera_from_part(&rest_pose);
        let x = |seconds: f64| at(seconds).translation.x - rest_pose.translation.x;
        assert!((x(0.0) - OUTSIDE).abs() < 1e-9);
        assert!((x(every - 1e-9) + OUTSIDE).abs() < 1e-6);
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
        assert_eq!(ConveyorState::of(0.0, 4.0).visit, 0);
        assert_eq!(ConveyorState::of(3.99, 4.0).visit, 0);
        assert_eq!(ConveyorState::of(4.0, 4.0).visit, 1);
        assert_eq!(ConveyorState::of(41.0, 4.0).visit, 10);
    }
}
