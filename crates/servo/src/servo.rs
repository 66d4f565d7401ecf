//! Servoing in short steps, for a robot that takes a pose every few milliseconds.
//!
//! ```text
//!            num_agreeing looks            within the deadband         num_final looks at rest
//!  Gathering ─────────────────► Approaching ──────────────────► Looking ─────────────────────► done
//!      ▲                            ▲                              │
//!      │ the part has moved         └────── the error is too large ┘
//!      └─ hold: brake, wait for accepted looks ── after `patience`: stop
//! ```
//!
//! A look that is not accepted, another part, an implausible step, a frame without a sound time, no accepted look for
//! `max_age`, an arm that does not follow, a pose outside of the fence: each brakes the robot at once. It goes on when the
//! part is accepted again where it was, or, if it has moved, after several looks agree; otherwise it stops for good.
//!
//! Nothing here has a clock, a thread or a device: the same looks and arm states give the same commands.

use std::time::Duration;

use nalgebra::Point3;
use serde::{Deserialize, Serialize};

use crate::{
    Arrival, Fence, Goal, Look, SeenPart, ServoError, ServoParams, StopReason, Task, Twist,
    arm_states::{ArmState, ArmStates},
    end_look::RestLooks,
    mover::Mover,
    twist::{is_within, part_way, scaled},
};
use geometry::rigid::{PoseDelta, RigidTransform, pose_error};
use robot::calibration::CameraPlace;

/// What the robot should do.
#[derive(Clone, Debug, PartialEq)]
pub enum Step {
    /// Go to this pose of the flange until the next state of the arm.
    Command(RigidTransform),
    /// Stay: it has stopped for good.
    Stop(StopReason),
    /// Stay: the target is reached.
    Done(Box<Arrival>),
}

/// What a run is doing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ServoState {
    /// It waits until enough looks agree.
    Looking,
    /// The robot moves towards the target.
    Moving,
    /// The next step waits until it is allowed.
    Waiting,
    /// The robot is held, see [`Servo::held`].
    Holding,
    /// Looks at rest show whether the target is reached.
    Checking,
}

/// Where a run stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Standing {
    /// The flange, where it was sent last.
    pub robot_from_flange: RigidTransform,
    /// The flange at the target; `None` until enough looks agree.
    pub robot_from_goal: Option<RigidTransform>,
    /// The part in what it is fixed to, see [`Task::part_in_place`]; `None` before it is seen.
    pub part_in_place: Option<RigidTransform>,
    /// What it is doing.
    pub state: ServoState,
}

/// A run of servoing.
#[derive(Clone, Debug)]
pub struct Servo {
    task: Task,
    params: ServoParams,
    fence: Fence,
    reported: ArmStates,
    /// Where the robot was sent lately.
    sent: ArmStates,
    run: Option<Run>,
    part: PartTrack,
    hold: Option<Hold>,
    phase: Phase,
    steps: Option<Steps>,
    num_rounds: usize,
    end: Option<Step>,
}

/// Motion in steps, each of which waits until it is allowed.
#[derive(Clone, Copy, Debug)]
struct Steps {
    longest: PoseDelta,
    /// Where the step that is allowed began; none while it waits.
    from: Option<RigidTransform>,
}

impl Steps {
    /// Ends the step that is allowed, if the robot would come to rest here and that is far enough.
    fn end_at(&mut self, braked: &RigidTransform) {
        let longest = &self.longest;
        self.from = self.from.filter(|from| {
            let length = pose_error(from, braked, &Point3::origin());
            is_within(&length, longest)
        });
    }
}

/// What begins with the first state of the arm.
#[derive(Clone, Debug)]
struct Run {
    started_at: Duration,
    /// Time of the last step; none before the first.
    last_at: Option<Duration>,
    mover: Mover,
}

/// The part so far.
#[derive(Clone, Debug, Default)]
struct PartTrack {
    /// Time of the last frame that had a sound time.
    last_frame: Option<Duration>,
    /// Time of the last accepted frame.
    accepted_at: Option<Duration>,
    /// Its pose in what it is fixed to, in the last accepted frame.
    in_place: Option<RigidTransform>,
    /// Number of accepted frames in a row that agree.
    num_agreeing: usize,
    goal: Option<Goal>,
    /// Number of looks in the mean of the goal.
    num_in_goal: usize,
    at_rest: RestLooks,
}

/// Why the robot is held.
#[derive(Clone, Debug)]
struct Hold {
    reason: StopReason,
    since: Duration,
    /// True if nothing can release it.
    is_final: bool,
}

#[derive(Clone, Debug)]
enum Phase {
    Approaching,
    /// At rest, with this many looks of this stop.
    Looking(usize),
}

impl Servo {
    /// A run that has not begun.
    pub fn new(task: Task, params: ServoParams, fence: Fence) -> Result<Self, ServoError> {
        Ok(Self {
            task,
            fence: fence.with_clearance(params.clearance),
            params: params.checked()?,
            reported: ArmStates::default(),
            sent: ArmStates::default(),
            run: None,
            part: PartTrack::default(),
            hold: None,
            phase: Phase::Approaching,
            steps: None,
            num_rounds: 0,
            end: None,
        })
    }

    /// Moves in steps from now on, each at most this long, and only after [`Self::allow_step`]. The time in which a step waits
    /// does not count.
    pub fn move_in_steps(&mut self, longest: PoseDelta) {
        self.steps = Some(Steps {
            longest,
            from: None,
        });
    }

    /// Allows the step that waits.
    pub fn allow_step(&mut self) {
        if let (Some(steps), Some(run)) = (&mut self.steps, &self.run) {
            steps.from.get_or_insert(run.mover.robot_from_flange);
        }
    }

    fn is_waiting(&self) -> bool {
        self.steps.is_some_and(|steps| steps.from.is_none())
    }

    /// Where the run stands; `None` before the first state of the arm.
    pub fn standing(&self) -> Option<Standing> {
        let run = self.run.as_ref()?;
        let goal = self.part.goal.as_ref();
        let state = match (&self.hold, &self.phase, goal) {
            (Some(_), ..) => ServoState::Holding,
            (None, Phase::Looking(_), _) => ServoState::Checking,
            (None, Phase::Approaching, None) => ServoState::Looking,
            (None, Phase::Approaching, Some(_)) if self.is_waiting() => ServoState::Waiting,
            (None, Phase::Approaching, Some(_)) => ServoState::Moving,
        };
        Some(Standing {
            robot_from_flange: run.mover.robot_from_flange,
            robot_from_goal: goal.map(|goal| goal.robot_from_flange),
            part_in_place: self.part.in_place,
            state,
        })
    }

    /// Why the robot is held at the moment.
    pub fn held(&self) -> Option<&StopReason> {
        self.hold.as_ref().map(|hold| &hold.reason)
    }

    /// The error at the last commanded pose; `None` until enough looks agree.
    pub fn error(&self) -> Option<Twist> {
        let (run, goal) = (self.run.as_ref()?, self.part.goal.as_ref()?);
        Some(Task::error_at(&run.mover.robot_from_flange, goal))
    }

    /// Brakes, and then stops for good.
    pub fn stop(&mut self, reason: StopReason) {
        let now = self
            .run
            .as_ref()
            .and_then(|run| run.last_at)
            .unwrap_or_default();
        self.hold_for_good(reason, now);
    }

    /// Takes in the newest state of the arm and, if there is one, the newest look, and returns what to do.
    pub fn step(&mut self, look: Option<&Look>, arm: &ArmState) -> Step {
        if let Some(end) = &self.end {
            return end.clone();
        }
        let now = arm.at;
        let mut run = self.run.take().unwrap_or_else(|| {
            let watched = self.watched();
            Run {
                started_at: now,
                last_at: None,
                mover: Mover::new(arm.robot_from_flange, watched),
            }
        });
        let dt = self.time_step(&run, now);
        if self.is_waiting() {
            run.started_at = now.min(run.started_at + Duration::from_secs_f64(dt));
        }
        self.reported.push(arm);
        self.refuse_astray(&run, arm);
        if let Some(look) = look
            && let Err(reason) = self.observe(look, &run.mover, arm)
        {
            self.hold(reason, now);
        }
        self.refuse_late(&run, now);
        self.move_on(&mut run.mover, arm, dt);
        run.last_at = Some(now);
        let robot_from_flange = run.mover.robot_from_flange;
        let is_at_rest = run.mover.is_at_rest();
        self.sent.push(&ArmState {
            at: now,
            robot_from_flange,
            joints: None,
        });
        let started_at = run.started_at;
        self.run = Some(run);
        if is_at_rest && let Some(end) = self.ended(now, started_at) {
            self.end = Some(end.clone());
            return end;
        }
        Step::Command(robot_from_flange)
    }

    /// Points on the flange whose speeds are limited, besides its middle: tools and camera.
    fn watched(&self) -> Vec<Point3<f64>> {
        let mut watched: Vec<Point3<f64>> = self.fence.ends().collect();
        if let CameraPlace::OnFlange {
            flange_from_camera, ..
        } = &self.task.camera
        {
            watched.push(Point3::from(flange_from_camera.translation.vector));
        }
        watched
    }

    /// Seconds since the last step; holds if the arm's times are unsound.
    fn time_step(&mut self, run: &Run, now: Duration) -> f64 {
        let Some(last_at) = run.last_at else {
            return 0.0;
        };
        let gap_s = now.as_secs_f64() - last_at.as_secs_f64();
        let most = self.params.max_gap.as_secs_f64();
        if !(gap_s > 0.0 && gap_s <= most) {
            self.hold_for_good(StopReason::ArmTimes { gap_s }, now);
        }
        gap_s.clamp(0.0, most)
    }

    /// Holds for good if the arm is not on the way on which it was sent.
    fn refuse_astray(&mut self, run: &Run, arm: &ArmState) {
        let at = Point3::origin();
        let sent = self
            .sent
            .poses_since(arm.at.saturating_sub(self.params.max_lag));
        let off = |pose: &RigidTransform| pose_error(pose, &arm.robot_from_flange, &at);
        let limit = self.params.max_astray;
        let is_on_way = sent
            .chain([&run.mover.robot_from_flange])
            .any(|pose| is_within(&off(pose), &limit));
        if !is_on_way {
            let off = off(&run.mover.robot_from_flange);
            let reason = StopReason::ArmAstray {
                shift_m: off.shift.0,
                turn_rad: off.rotation.0,
            };
            self.hold_for_good(reason, arm.at);
        }
    }

    /// Takes in a look, or says why the robot must not move by it.
    fn observe(&mut self, look: &Look, mover: &Mover, arm: &ArmState) -> Result<(), StopReason> {
        let robot_from_flange = self.flange_at(look.taken_at, arm.at)?;
        let seen = look.seen.clone()?;
        let task = &self.task;
        let in_place = task.part_in_place(&robot_from_flange, &seen.camera_from_part);
        let before = self.part.in_place.replace(in_place);
        let step = before.map(|before| pose_error(&before, &in_place, &task.middle));
        self.part.accepted_at = Some(look.taken_at);
        if step.is_some_and(|step| is_within(&step, &self.params.max_step)) {
            self.part.num_agreeing += 1;
        } else {
            self.part.num_agreeing = 1;
        }
        let goal = task.goal(&robot_from_flange, &seen.camera_from_part);
        if self.part.num_agreeing < self.params.num_agreeing {
            // The part has moved, or is seen for the first time.
            let had_goal = self.part.goal.take().is_some();
            self.part.num_in_goal = 0;
            self.part.at_rest.clear();
            self.phase = Phase::Approaching;
            let step = step.filter(|_| had_goal);
            return step.map_or(Ok(()), |step| {
                Err(StopReason::Moved {
                    shift_m: step.shift.0,
                    turn_rad: step.rotation.0,
                })
            });
        }
        let error = Task::error_at(&mover.robot_from_flange, &goal).size();
        if !is_within(&error, &self.params.max_error) {
            return Err(StopReason::TooFar {
                shift_m: error.shift.0,
                turn_rad: error.rotation.0,
            });
        }
        if !task.is_part_held() {
            let robot_from_part = task.robot_from_part(&robot_from_flange, &seen.camera_from_part);
            self.fence.place_part(&robot_from_part, &task.middle);
        }
        self.fence
            .check(&goal.robot_from_flange, arm.joints.as_ref())?;
        if self.hold.as_ref().is_some_and(|hold| !hold.is_final) {
            self.hold = None;
        }
        self.use_look(&goal, &robot_from_flange, seen, look.taken_at, mover);
        Ok(())
    }

    /// The flange when a frame was taken, or why its time is unsound.
    fn flange_at(
        &mut self,
        taken_at: Duration,
        now: Duration,
    ) -> Result<RigidTransform, StopReason> {
        if let Some(ahead) = taken_at.checked_sub(now).filter(|ahead| !ahead.is_zero()) {
            return Err(StopReason::FrameTimes {
                off_s: ahead.as_secs_f64(),
            });
        }
        let last = self.part.last_frame;
        if let Some(back) = last.and_then(|last| last.checked_sub(taken_at)) {
            return Err(StopReason::FrameTimes {
                off_s: back.as_secs_f64(),
            });
        }
        self.part.last_frame = Some(taken_at);
        let age = now.saturating_sub(taken_at);
        let stale = StopReason::Stale {
            age_s: age.as_secs_f64(),
        };
        if age > self.params.max_age {
            return Err(stale);
        }
        self.reported.pose_at(taken_at).ok_or(stale)
    }

    /// Averages the goal on the way, and collects looks at rest.
    fn use_look(
        &mut self,
        goal: &Goal,
        robot_from_flange: &RigidTransform,
        seen: SeenPart,
        taken_at: Duration,
        mover: &Mover,
    ) {
        if let Phase::Looking(num_looks) = &mut self.phase {
            let rest = self.reported.rest_since().filter(|_| mover.is_at_rest());
            if rest.is_some_and(|since| taken_at >= since + self.params.settle) {
                let moved = self.part.at_rest.push(&self.task, robot_from_flange, seen);
                *num_looks = moved.map_or(*num_looks, |_| 0) + 1;
            }
            return;
        }
        // Looks at rest have corrected the goal, and those on the way are worse.
        if !self.part.at_rest.is_empty() {
            return;
        }
        self.part.num_in_goal = (self.part.num_in_goal + 1).min(self.params.num_averaged);
        let share = 1.0 / self.part.num_in_goal as f64;
        let before = self.part.goal.unwrap_or(*goal);
        let control = Point3::from(goal.flange_from_control.translation.vector);
        self.part.goal = Some(Goal {
            robot_from_flange: part_way(
                &before.robot_from_flange,
                &goal.robot_from_flange,
                &control,
                share,
            ),
            ..*goal
        });
    }

    /// Holds if the last accepted look is too old, and ends what takes too long.
    fn refuse_late(&mut self, run: &Run, now: Duration) {
        let last = self.part.accepted_at.unwrap_or(run.started_at);
        let age = now.saturating_sub(last);
        if age > self.params.max_age && self.hold.is_none() {
            self.hold(
                StopReason::Lost {
                    age_s: age.as_secs_f64(),
                },
                now,
            );
        }
        if now.saturating_sub(run.started_at) > self.params.max_time {
            self.hold_for_good(
                StopReason::TimeOver {
                    limit_s: self.params.max_time.as_secs_f64(),
                },
                now,
            );
        }
    }

    /// Moves the commanded pose on, or brakes.
    fn move_on(&mut self, mover: &mut Mover, arm: &ArmState, dt: f64) {
        if dt <= 0.0 {
            return;
        }
        let limits = self.params.limits;
        if let Some(steps) = &mut self.steps {
            steps.end_at(&mover.braked(&limits));
        }
        let may_move = self.hold.is_none() && matches!(self.phase, Phase::Approaching);
        let goal = self.part.goal.filter(|_| may_move);
        let mut wanted = Twist::ZERO;
        if let Some(goal) = goal {
            let error = Task::error_at(&mover.robot_from_flange, &goal);
            if is_within(&error.size(), &scaled(&self.params.deadband, 0.5)) {
                self.phase = Phase::Looking(0);
            } else if !self.is_waiting() {
                let control = &goal.flange_from_control;
                wanted = mover.towards(&error, control, self.params.gain, &limits);
            }
        }
        let mut next = mover.clone();
        next.advance(&wanted, &limits, dt);
        // If it brakes from the next pose on, it must come to rest inside.
        let braked = next.braked(&limits);
        if let (true, Err(reason)) = (
            wanted != Twist::ZERO,
            self.fence.check(&braked, arm.joints.as_ref()),
        ) {
            // A look that allows the goal would only release it to try the same way again.
            self.hold_for_good(reason, arm.at);
            mover.advance(&Twist::ZERO, &limits, dt);
        } else {
            *mover = next;
        }
    }

    /// How it ends, if it does, with the robot at rest.
    fn ended(&mut self, now: Duration, started_at: Duration) -> Option<Step> {
        if let Some(hold) = &self.hold {
            let is_over = hold.is_final || now.saturating_sub(hold.since) > self.params.patience;
            return is_over.then(|| Step::Stop(hold.reason.clone()));
        }
        let Phase::Looking(num_looks) = self.phase else {
            return None;
        };
        if num_looks < self.params.num_final {
            return None;
        }
        let mean = self.part.at_rest.mean(&self.task, num_looks)?;
        let run = self.run.as_ref()?;
        if mean.is_settled(&self.params.deadband) {
            return Some(match mean.refuse_uncertain(&self.params.tolerance) {
                Err(reason) => Step::Stop(reason),
                Ok(()) => Step::Done(Box::new(Arrival {
                    error: mean.goal.error.size(),
                    bounds: mean.bounds,
                    num_frames: mean.num,
                    robot_from_flange: run.mover.robot_from_flange,
                    camera_from_part: mean.camera_from_part,
                    is_approximate: mean.is_approximate,
                    took: now.saturating_sub(started_at),
                })),
            });
        }
        self.num_rounds += 1;
        if self.num_rounds > self.params.max_rounds {
            let error = mean.goal.error.size();
            return Some(Step::Stop(StopReason::NotSettling {
                num_rounds: self.params.max_rounds,
                shift_m: error.shift.0,
                turn_rad: error.rotation.0,
            }));
        }
        // Correct by the mean, which is better than what the way there was averaged from.
        let goal = self.part.goal.as_mut()?;
        let control = run.mover.robot_from_flange * goal.flange_from_control;
        goal.robot_from_flange =
            control * mean.goal.error.transform() * goal.flange_from_control.inverse();
        self.phase = Phase::Approaching;
        None
    }

    fn hold(&mut self, reason: StopReason, now: Duration) {
        match &mut self.hold {
            Some(hold) if !hold.is_final => hold.reason = reason,
            Some(_) => {}
            None => {
                self.hold = Some(Hold {
                    reason,
                    since: now,
                    is_final: false,
                });
            }
        }
    }

    fn hold_for_good(&mut self, reason: StopReason, now: Duration) {
        self.hold(reason, now);
        if let Some(hold) = &mut self.hold {
            hold.is_final = true;
        }
    }
}

#[cfg(test)]
mod tests;
