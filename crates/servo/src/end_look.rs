//! The look at the end: frames taken with the arm at rest.

use std::time::Duration;

use crate::{
    Goal, SeenPart, StopReason, Task,
    twist::{is_within, scaled},
};
use geometry::{
    rigid::{PoseDelta, RigidTransform, pose_error},
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

/// Looks with the arm at rest. Those from before a small correction still count: the part's place is then known by more frames
/// than one stop takes, and a correction does not chase the noise of these few.
#[derive(Clone, Debug, Default)]
pub(crate) struct RestLooks {
    looks: Vec<RestLook>,
}

#[derive(Clone, Copy, Debug)]
struct RestLook {
    /// The arm's pose, and the part's in what it is fixed to.
    robot_from_flange: RigidTransform,
    in_place: RigidTransform,
    seen: SeenPart,
}

/// A look counts while the camera would see the part at most this far from where it saw it then: over this way a wrong
/// calibration, by 20 mm and 2°, adds less than half a millimetre.
const SAME_VIEW_MAX_MOVE: PoseDelta = PoseDelta {
    shift: Metres(0.003),
    rotation: Radians(0.0052),
};
/// Most looks that count: those of ten stops.
const MAX_LOOKS: usize = 60;
/// If the means of two stops are apart by more than this share of what noise explains in 95 of 100, the part has crept. At 1,
/// noise alone would count as creeping at one stop in ten, at 1.5 at one in a thousand; and a part that creeps by less moves the
/// mean by at most 0.6 of the bounds of a single look, which the end allows for in full.
const CREEP_MIN_RATIO: f64 = 1.5;

/// The looks have been found plausible: none is left out.
const ANY: PoseTolerance = PoseTolerance {
    shift: Metres(f64::INFINITY),
    turn: Radians(f64::INFINITY),
};

/// The mean of looks at rest.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RestMean {
    /// Where the arm should be, and how far it is from there.
    pub(crate) goal: Goal,
    /// Bounds of a single look, widened by those of the calibration.
    pub(crate) bounds: PoseDelta,
    /// What the mean may be off by noise alone, 95 %.
    noise: PoseDelta,
    pub(crate) num: usize,
    pub(crate) is_approximate: bool,
    pub(crate) camera_from_part: RigidTransform,
}

impl RestLooks {
    /// Adds a look with the arm at a pose, and forgets those from elsewhere. If it is farther from the first one than both may
    /// be off, the part has moved: it becomes the first, and the distance is returned.
    pub(crate) fn push(
        &mut self,
        task: &Task,
        robot_from_flange: &RigidTransform,
        seen: SeenPart,
    ) -> Option<PoseDelta> {
        self.looks.retain(|look| {
            let now = task.seen_from(robot_from_flange, &look.in_place);
            let way = pose_error(&look.seen.camera_from_part, &now, &task.middle);
            is_within(&way, &SAME_VIEW_MAX_MOVE)
        });
        let in_place = task.part_in_place(robot_from_flange, &seen.camera_from_part);
        let mut moved = None;
        if let Some(first) = self.looks.first() {
            let apart = pose_error(&first.in_place, &in_place, &task.middle);
            let (a, b) = (&seen.bounds, &first.seen.bounds);
            let both = PoseDelta {
                shift: Metres(a.shift.0 + b.shift.0),
                rotation: Radians(a.rotation.0 + b.rotation.0),
            };
            if !is_within(&apart, &both) {
                self.looks.clear();
                moved = Some(apart);
            }
        }
        if self.looks.len() == MAX_LOOKS {
            self.looks.remove(0);
        }
        self.looks.push(RestLook {
            robot_from_flange: *robot_from_flange,
            in_place,
            seen,
        });
        moved
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.looks.is_empty()
    }

    pub(crate) fn clear(&mut self) {
        self.looks.clear();
    }

    /// The mean with the arm where the last look was taken; `None` without looks. `num_new` looks are from this stop. If their
    /// mean is farther from that of the others than noise explains, the part has crept, and only they count.
    pub(crate) fn mean(&mut self, task: &Task, num_new: usize) -> Option<RestMean> {
        let num_old = self.looks.len().saturating_sub(num_new);
        let (old, new) = self.looks.split_at(num_old);
        if let (Some(before), Some(now)) = (mean_place(old, task), mean_place(new, task)) {
            let share = (1.0 / num_old as f64 + 1.0 / num_new as f64).sqrt();
            let apart = pose_error(&before, &now, &task.middle);
            if !is_within(&apart, &scaled(&mean_bounds(new), CREEP_MIN_RATIO * share)) {
                self.looks.drain(..num_old);
            }
        }
        let num = self.looks.len();
        let approximate = self.looks.iter().filter(|look| look.seen.is_approximate);
        let num_approximate = approximate.count();
        let robot_from_flange = &self.looks.last()?.robot_from_flange;
        let camera_from_part = task.seen_from(robot_from_flange, &mean_place(&self.looks, task)?);
        let (bounds, calibration) = (mean_bounds(&self.looks), task.calibration_bounds());
        Some(RestMean {
            goal: task.goal(robot_from_flange, &camera_from_part),
            bounds: PoseDelta {
                shift: Metres(bounds.shift.0.hypot(calibration.shift.0)),
                rotation: Radians(bounds.rotation.0.hypot(calibration.rotation.0)),
            },
            noise: scaled(&bounds, 1.0 / (num as f64).sqrt()),
            num,
            is_approximate: 2 * num_approximate > num,
            camera_from_part,
        })
    }
}

/// The part's mean pose in what it is fixed to; `None` without looks.
fn mean_place(looks: &[RestLook], task: &Task) -> Option<RigidTransform> {
    let poses: Vec<RigidTransform> = looks.iter().map(|look| look.in_place).collect();
    mean_pose(&poses, &task.middle, ANY).map(|mean| mean.camera_from_part)
}

/// The mean of the bounds of single looks.
fn mean_bounds(looks: &[RestLook]) -> PoseDelta {
    let mean = |of: fn(&PoseDelta) -> f64| {
        let sum: f64 = looks.iter().map(|look| of(&look.seen.bounds)).sum();
        sum / looks.len() as f64
    };
    PoseDelta {
        shift: Metres(mean(|bounds| bounds.shift.0)),
        rotation: Radians(mean(|bounds| bounds.rotation.0)),
    }
}

impl RestMean {
    /// Whether another correction would not help: the error is within the deadband, or within half of what the mean may be off
    /// by noise, to which it then adds an eighth.
    pub(crate) fn is_settled(&self, deadband: &PoseDelta) -> bool {
        let half = scaled(&self.noise, 0.5);
        let limit = PoseDelta {
            shift: Metres(deadband.shift.0.max(half.shift.0)),
            rotation: Radians(deadband.rotation.0.max(half.rotation.0)),
        };
        is_within(&self.goal.error.size(), &limit)
    }

    /// Refuses an end whose error may exceed the tolerance.
    pub(crate) fn refuse_uncertain(&self, tolerance: &PoseDelta) -> Result<(), StopReason> {
        let error = self.goal.error.size();
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
