//! The look at the end: frames taken with the arm at rest.

use std::time::Duration;

use nalgebra::{Point3, Vector3};

use crate::{SeenPart, StopReason, Twist, twist::is_within};
use geometry::{
    rigid::{PoseDelta, RigidTransform},
    units::{Metres, Radians},
};
use inspection::pipeline::live::{PoseTolerance, mean_pose};

/// Where servoing ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arrival {
    /// Error that is left: the mean of the frames at rest.
    pub error: PoseDelta,
    /// Bounds of each single frame, 95 %, with those of the calibration where the target depends on it.
    pub bounds: PoseDelta,
    /// Number of frames.
    pub num_frames: usize,
    /// The arm's pose there.
    pub robot_from_flange: RigidTransform,
    /// The part's mean pose in these frames, by which its path is carried.
    pub camera_from_part: RigidTransform,
    /// True if in most of the frames the part may be another model by its shape: then all of this is approximate.
    pub is_approximate: bool,
    /// Time since the start.
    pub took: Duration,
}

/// Looks with the arm at rest at one pose.
#[derive(Clone, Debug, Default)]
pub(crate) struct RestLooks {
    looks: Vec<(Twist, SeenPart)>,
}

/// The looks have been found plausible: none is left out.
const ANY: PoseTolerance = PoseTolerance {
    shift: Metres(f64::INFINITY),
    turn: Radians(f64::INFINITY),
};

/// The mean of looks at rest.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RestMean {
    pub(crate) error: Twist,
    pub(crate) bounds: PoseDelta,
    pub(crate) num: usize,
    pub(crate) is_approximate: bool,
    pub(crate) camera_from_part: RigidTransform,
}

impl RestLooks {
    /// Adds a look. If it is farther from the first one than both may be off, the part has moved: it becomes the first, and the
    /// distance is returned.
    pub(crate) fn push(&mut self, error: Twist, seen: SeenPart) -> Option<PoseDelta> {
        let mut moved = None;
        if let Some((first, first_seen)) = self.looks.first() {
            let apart = error.plus(&first.scaled(-1.0)).size();
            let (a, b) = (&seen.bounds, &first_seen.bounds);
            let both = PoseDelta {
                shift: Metres(a.shift.0 + b.shift.0),
                rotation: Radians(a.rotation.0 + b.rotation.0),
            };
            if !is_within(&apart, &both) {
                self.looks.clear();
                moved = Some(apart);
            }
        }
        self.looks.push((error, seen));
        moved
    }

    pub(crate) fn len(&self) -> usize {
        self.looks.len()
    }

    /// The mean error and the mean bounds, widened by those of the calibration; `None` without looks.
    pub(crate) fn mean(&self, calibration: &PoseDelta, middle: &Point3<f64>) -> Option<RestMean> {
        let poses = self.looks.iter().map(|(_, seen)| seen.camera_from_part);
        let poses: Vec<RigidTransform> = poses.collect();
        let mean_pose = mean_pose(&poses, middle, ANY)?;
        let num = self.looks.len();
        let approximate = self.looks.iter().filter(|(_, seen)| seen.is_approximate);
        let num_approximate = approximate.count();
        let share = 1.0 / num as f64;
        let mean = |of: fn(&Twist) -> Vector3<f64>| {
            let sum: Vector3<f64> = self.looks.iter().map(|(error, _)| of(error)).sum();
            sum * share
        };
        let bound = |of: fn(&PoseDelta) -> f64| {
            let sum: f64 = self.looks.iter().map(|(_, seen)| of(&seen.bounds)).sum();
            (sum * share).hypot(of(calibration))
        };
        Some(RestMean {
            error: Twist {
                linear: mean(|error| error.linear),
                angular: mean(|error| error.angular),
            },
            bounds: PoseDelta {
                shift: Metres(bound(|bounds| bounds.shift.0)),
                rotation: Radians(bound(|bounds| bounds.rotation.0)),
            },
            num,
            is_approximate: 2 * num_approximate > num,
            camera_from_part: mean_pose.camera_from_part,
        })
    }
}

impl RestMean {
    /// Whether another correction would not help: the error is within the deadband, or within half of what the mean of the
    /// looks may be off itself.
    pub(crate) fn is_settled(&self, deadband: &PoseDelta) -> bool {
        let share = 0.5 / (self.num as f64).sqrt();
        let limit = PoseDelta {
            shift: Metres(deadband.shift.0.max(share * self.bounds.shift.0)),
            rotation: Radians(deadband.rotation.0.max(share * self.bounds.rotation.0)),
        };
        is_within(&self.error.size(), &limit)
    }

    /// Refuses an end whose error may exceed the tolerance.
    pub(crate) fn refuse_uncertain(&self, tolerance: &PoseDelta) -> Result<(), StopReason> {
        let error = self.error.size();
        let shift_m = error.shift.0 + self.bounds.shift.0;
        let turn_rad = error.rotation.0 + self.bounds.rotation.0;
        if shift_m <= tolerance.shift.0 && turn_rad <= tolerance.rotation.0 {
            return Ok(());
        }
        Err(StopReason::Uncertain {
            shift_m,
            most_m: tolerance.shift.0,
            turn_rad,
            most_rad: tolerance.rotation.0,
        })
    }
}
