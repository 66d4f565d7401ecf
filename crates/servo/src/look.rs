//! What one frame says about the part.

use std::time::Duration;

use crate::{StopReason, Task};
use geometry::rigid::{PoseDelta, RigidTransform};
use inspection::pipeline::{Inspection, Verdict};

/// The part as one frame shows it.
#[derive(Clone, Debug, PartialEq)]
pub struct Look {
    /// When the frame was taken, by the clock of the arm's states.
    pub taken_at: Duration,
    /// The part, or why it gives no pose to move by.
    pub seen: Result<SeenPart, StopReason>,
}

/// An accepted part with an unambiguous pose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SeenPart {
    /// The pose.
    pub camera_from_part: RigidTransform,
    /// The verdict's bounds, 95 %: of the middle's place, and of the rotation.
    pub bounds: PoseDelta,
    /// True if by its shape it may be another model, so that its pose is approximate.
    pub is_approximate: bool,
}

impl Look {
    /// What the inspection of a frame says about the part of a task.
    pub fn new(task: &Task, inspection: &Inspection, taken_at: Duration) -> Self {
        Self {
            taken_at,
            seen: SeenPart::of(task, inspection),
        }
    }
}

impl SeenPart {
    fn of(task: &Task, inspection: &Inspection) -> Result<Self, StopReason> {
        if let Some(why) = inspection.verdict.refusal() {
            return Err(StopReason::NotAccepted { why });
        }
        let part = task.part.clone();
        let Verdict::Part {
            part: found,
            is_approximate,
            ..
        } = &inspection.verdict
        else {
            return Err(StopReason::NoBounds { part });
        };
        // Another reference of the same part has coordinates of its own.
        let reference = inspection.reference().unwrap_or(found);
        if *found != part || reference != task.reference {
            let other = if *found == part {
                reference.to_owned()
            } else {
                found.clone()
            };
            return Err(StopReason::AnotherPart { part, other });
        }
        let pose = inspection.found_pose();
        if pose.is_some_and(|pose| pose.is_ambiguous() || pose.off_scale().is_some()) {
            return Err(StopReason::Ambiguous { part });
        }
        let bounded = pose.and_then(|pose| Some((pose.camera_from_part(), pose.bounds()?)));
        let Some((camera_from_part, bounds)) = bounded else {
            return Err(StopReason::NoBounds { part });
        };
        Ok(Self {
            camera_from_part,
            bounds: PoseDelta {
                shift: bounds.shift,
                rotation: bounds.turn,
            },
            is_approximate: *is_approximate,
        })
    }
}
