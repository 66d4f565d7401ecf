//! Servoing in single moves, for every controller that can be sent to a pose: look at rest, move, look again.
//!
//! The robot asks with its pose, waits for one pose, moves there in a straight line as fast as its own program says, and asks
//! again, until the answer is that the target is reached. Gain and speed limits do not apply; instead a move is at most
//! `max_move` long, so that a wrong calibration, which bends the way, is corrected before it carries the robot far.

use nalgebra::Point3;

use crate::{
    Arrival, Fence, Look, SeenPart, ServoError, ServoParams, StopReason, Task,
    arm_states::ArmState,
    end_look::RestLooks,
    twist::{is_within, part_way},
};
use geometry::rigid::{PoseDelta, RigidTransform, pose_error};
use robot::arm::Joints;

/// What the robot should do.
#[derive(Clone, Debug, PartialEq)]
pub enum OnePoseAnswer {
    /// Go to this pose of the flange, and ask again at rest.
    Move {
        /// The pose.
        robot_from_flange: RigidTransform,
        /// The error from which it corrects.
        error: PoseDelta,
    },
    /// Stay: the target is reached.
    Done(Box<Arrival>),
    /// Stay. It may ask again when the reason is gone.
    Stay(StopReason),
}

/// A run in single moves.
#[derive(Clone, Debug)]
pub struct OnePose {
    task: Task,
    params: ServoParams,
    /// Longest move.
    max_move: PoseDelta,
    fence: Fence,
    /// The part's pose in what it is fixed to, at the last request.
    in_place: Option<RigidTransform>,
    at_rest: RestLooks,
    first: Option<ArmState>,
    /// Where the robot was sent last.
    sent: Option<RigidTransform>,
    num_moves: usize,
}

/// The way of a move is checked in steps of this, metres and radians.
const CHECK_STEP_M_RAD: (f64, f64) = (0.02, 0.035);

impl OnePose {
    /// A run that has not begun. Moves are at most `max_move` long; of `params` those of the looks count, and `max_rounds`
    /// beside the moves that the distance needs.
    pub fn new(
        task: Task,
        params: ServoParams,
        max_move: PoseDelta,
        fence: Fence,
    ) -> Result<Self, ServoError> {
        Self::check_longest(&max_move)?;
        Ok(Self {
            task,
            fence: fence.with_clearance(params.clearance),
            params: params.checked()?,
            max_move,
            in_place: None,
            at_rest: RestLooks::default(),
            first: None,
            sent: None,
            num_moves: 0,
        })
    }

    /// Refuses a longest move that is out of its range.
    pub fn check_longest(max_move: &PoseDelta) -> Result<(), ServoError> {
        let PoseDelta { shift, rotation } = max_move;
        for (what, value, low, high) in [
            ("the longest move, mm", shift.mm(), 1.0, 500.0),
            ("the longest move, °", rotation.degrees(), 0.1, 45.0),
        ] {
            if !(low..=high).contains(&value) {
                return Err(ServoError {
                    what,
                    value,
                    low,
                    high,
                });
            }
        }
        Ok(())
    }

    /// Answers a request: the looks at frames that were taken between two states of the arm.
    pub fn answer(&mut self, looks: &[Look], [before, after]: [&ArmState; 2]) -> OnePoseAnswer {
        match self.next(looks, before, after) {
            Ok(answer) => answer,
            Err(reason) => {
                if let StopReason::Moved { .. } = reason {
                    self.at_rest.clear();
                }
                OnePoseAnswer::Stay(reason)
            }
        }
    }

    fn next(
        &mut self,
        looks: &[Look],
        before: &ArmState,
        after: &ArmState,
    ) -> Result<OnePoseAnswer, StopReason> {
        let first = *self.first.get_or_insert(*before);
        let flange = &after.robot_from_flange;
        stays_within(&before.robot_from_flange, flange, &self.params.deadband)?;
        if let Some(sent) = &self.sent {
            // Its base or tool is another one, or it was stopped on the way.
            stays_within(sent, flange, &self.params.max_astray)?;
        }
        if looks.is_empty() {
            let age = after.at.saturating_sub(before.at);
            return Err(StopReason::Lost {
                age_s: age.as_secs_f64(),
            });
        }
        for look in looks {
            let seen = self.refuse_look(look, before, after)?;
            if let Some(apart) = self.at_rest.push(&self.task, flange, seen) {
                return Err(StopReason::Moved {
                    shift_m: apart.shift.0,
                    turn_rad: apart.rotation.0,
                });
            }
        }
        let mean = self.at_rest.mean(&self.task, looks.len());
        let mean = mean.expect("there are looks");
        let error = mean.goal.error.size();
        if mean.is_settled(&self.params.deadband) {
            mean.refuse_uncertain(&self.params.tolerance)?;
            return Ok(OnePoseAnswer::Done(Box::new(Arrival {
                error,
                bounds: mean.bounds,
                num_frames: mean.num,
                robot_from_flange: *flange,
                camera_from_part: mean.camera_from_part,
                is_approximate: mean.is_approximate,
                took: after.at.saturating_sub(first.at),
            })));
        }
        let wanted = mean.goal.robot_from_flange;
        let control = Point3::from(mean.goal.flange_from_control.translation.vector);
        let robot_from_flange = self.limited(flange, &wanted, &control);
        self.check_way(flange, &robot_from_flange, after)?;
        self.refuse_endless(&robot_from_flange, &wanted, &error)?;
        self.sent = Some(robot_from_flange);
        Ok(OnePoseAnswer::Move {
            robot_from_flange,
            error,
        })
    }

    /// What one look shows of the part, or why the robot must not move by it.
    fn refuse_look(
        &mut self,
        look: &Look,
        before: &ArmState,
        after: &ArmState,
    ) -> Result<SeenPart, StopReason> {
        let taken_at = look.taken_at;
        let off = (before.at.checked_sub(taken_at)).or(taken_at.checked_sub(after.at));
        if let Some(off) = off.filter(|off| !off.is_zero()) {
            return Err(StopReason::FrameTimes {
                off_s: off.as_secs_f64(),
            });
        }
        let seen = look.seen.clone()?;
        let (task, flange) = (&self.task, &after.robot_from_flange);
        let in_place = task.part_in_place(flange, &seen.camera_from_part);
        let last = self.in_place.replace(in_place);
        let step = last.map(|last| pose_error(&last, &in_place, &task.middle));
        if let Some(step) = step.filter(|step| !is_within(step, &self.params.max_step)) {
            return Err(StopReason::Moved {
                shift_m: step.shift.0,
                turn_rad: step.rotation.0,
            });
        }
        let goal = task.goal(flange, &seen.camera_from_part);
        let error = goal.error.size();
        if !is_within(&error, &self.params.max_error) {
            return Err(StopReason::TooFar {
                shift_m: error.shift.0,
                turn_rad: error.rotation.0,
            });
        }
        if !task.is_part_held() {
            let robot_from_part = task.robot_from_part(flange, &seen.camera_from_part);
            self.fence.place_part(&robot_from_part, &task.middle);
        }
        Ok(seen)
    }

    /// The pose on the straight way to `wanted` that a longest move reaches.
    fn limited(
        &self,
        from: &RigidTransform,
        wanted: &RigidTransform,
        control: &Point3<f64>,
    ) -> RigidTransform {
        let excess = |to: &RigidTransform| {
            let points = [Point3::origin(), *control].into_iter();
            let shifts = points.map(|point| (to * point - from * point).norm());
            let longest = shifts.fold(0.0, f64::max) / self.max_move.shift.0;
            longest.max(from.rotation.angle_to(&to.rotation) / self.max_move.rotation.0)
        };
        let (mut to, mut share) = (*wanted, 1.0);
        // The flange goes in an arc about the control point, so its shift does not quite grow with the share.
        while excess(&to) > 1.0 {
            share *= 0.99 / excess(&to);
            to = part_way(from, wanted, control, share);
        }
        to
    }

    /// Counts corrections: moves that reach as far as they should, and still do not end.
    fn refuse_endless(
        &mut self,
        to: &RigidTransform,
        wanted: &RigidTransform,
        error: &PoseDelta,
    ) -> Result<(), StopReason> {
        if to == wanted {
            self.num_moves += 1;
        }
        if self.num_moves <= self.params.max_rounds {
            return Ok(());
        }
        Err(StopReason::NotSettling {
            num_rounds: self.params.max_rounds,
            shift_m: error.shift.0,
            turn_rad: error.rotation.0,
        })
    }

    /// Checks the straight way, in the arm's configuration if its joints are reported, else in any that reaches it.
    fn check_way(
        &self,
        from: &RigidTransform,
        to: &RigidTransform,
        arm: &ArmState,
    ) -> Result<(), StopReason> {
        let placed = self.fence.arm.as_ref().filter(|_| arm.joints.is_none());
        let Some(placed) = placed else {
            return self.check_way_from(from, to, arm.joints);
        };
        let mut blocked = StopReason::OutOfReach;
        for joints in placed.joints_at(&(from * placed.flange_from_nozzle)) {
            match self.check_way_from(from, to, Some(joints)) {
                Ok(()) => return Ok(()),
                Err(reason) => blocked = reason,
            }
        }
        Err(blocked)
    }

    fn check_way_from(
        &self,
        from: &RigidTransform,
        to: &RigidTransform,
        mut joints: Option<Joints>,
    ) -> Result<(), StopReason> {
        let way = pose_error(from, to, &Point3::origin());
        let steps = (way.shift.0 / CHECK_STEP_M_RAD.0).max(way.rotation.0 / CHECK_STEP_M_RAD.1);
        let steps = steps.ceil().max(1.0) as usize;
        for step in 1..=steps {
            let share = step as f64 / steps as f64;
            let pose = part_way(from, to, &Point3::origin(), share);
            joints = self.fence.check(&pose, joints.as_ref())?.or(joints);
        }
        Ok(())
    }
}

/// Refuses an arm that is farther than this from where it should be.
fn stays_within(
    wanted: &RigidTransform,
    found: &RigidTransform,
    limit: &PoseDelta,
) -> Result<(), StopReason> {
    let off = pose_error(wanted, found, &Point3::origin());
    if is_within(&off, limit) {
        return Ok(());
    }
    Err(StopReason::ArmAstray {
        shift_m: off.shift.0,
        turn_rad: off.rotation.0,
    })
}

#[cfg(test)]
mod tests;
