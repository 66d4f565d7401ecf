//! The answers to the requests of clients.

use std::{
    iter,
    sync::{Arc, OnceLock},
    time::{Duration, Instant},
};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::request::Request;
use geometry::{
    error::Advice,
    rigid::{PoseDelta, RigidTransform, row_major},
};
use robot::line::OnLine;

/// Verdict of an inspection in an answer. The numbers are part of the protocols.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum VerdictCode {
    /// Nothing was inspected since the start.
    #[default]
    None = 0,
    /// A part with a pose that a robot may use.
    Accepted = 1,
    /// Something hangs there, but its verdict or its pose does not count.
    Refused = 2,
    /// Nothing to recognise.
    NoPart = 3,
    /// It was accepted, but the frame is too old by now.
    Stale = 4,
    /// There was nothing to inspect: no frame, or a fault of the program.
    Error = 5,
    /// As many clients are connected as are allowed.
    Full = 6,
    /// The request could not be read or asks for something that is not there.
    BadRequest = 7,
    /// To a robot that servoes: go to the pose, and ask again at rest.
    Move = 8,
    /// To a robot that servoes: the target is reached.
    Done = 9,
    /// To a robot that servoes: stay where you are.
    Stay = 10,
}

impl VerdictCode {
    /// The word in text protocols.
    pub fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Accepted => "accepted",
            Self::Refused => "refused",
            Self::NoPart => "no_part",
            Self::Stale => "stale",
            Self::Error => "error",
            Self::Full => "full",
            Self::BadRequest => "bad_request",
            Self::Move => "move",
            Self::Done => "done",
            Self::Stay => "stay",
        }
    }

    /// The code in binary protocols.
    pub fn code(self) -> u16 {
        self as u16
    }
}

/// How the camera is, in one word. The numbers are part of the protocols.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum CameraState {
    /// It is being opened.
    #[default]
    Opening = 0,
    /// Frames come.
    Running = 1,
    /// It is gone, and looked for by itself.
    Lost = 2,
    /// It ended or failed; the next trigger opens it again.
    Over = 3,
}

impl CameraState {
    /// The word in text protocols.
    pub fn name(self) -> &'static str {
        match self {
            Self::Opening => "opening",
            Self::Running => "running",
            Self::Lost => "lost",
            Self::Over => "over",
        }
    }

    /// The code in binary protocols.
    pub fn code(self) -> u16 {
        self as u16
    }
}

/// How the camera is.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, JsonSchema)]
pub struct CameraStatus {
    /// In one word.
    pub state: CameraState,
    /// Why it gives nothing; null while it does.
    pub problem: Option<Problem>,
}

/// Why there is no pose: for programs and for people.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, JsonSchema)]
pub struct Problem {
    /// A word that stays the same in later versions; empty if there is nothing to say.
    pub reason: String,
    /// What happened and what to do.
    pub message: String,
}

impl Problem {
    /// Joins what happened and what to do about it in one line.
    pub fn new(reason: impl Into<String>, what: &str, advice: &str) -> Self {
        Self {
            reason: reason.into(),
            message: format!("{what} (to do: {advice})"),
        }
    }

    /// Puts an error and its advice into words.
    pub fn of<E: std::fmt::Display + Advice>(reason: impl Into<String>, error: &E) -> Self {
        Self::new(reason, &error.to_string(), &error.advice())
    }

    /// A person has reported that the part is another one.
    pub fn reported_wrong() -> Self {
        Self::new(
            "reported_wrong",
            "the part was reported as wrong by the operator",
            "Hang the next part, or correct the report in the history",
        )
    }

    /// The robot's frame or the kind of pose was changed.
    pub(super) fn numbers_changed() -> Self {
        Self::new(
            "numbers_changed",
            "the calibration, or which pose is sent, has changed since",
            "Check that the program expects these poses, and TRIGGER again",
        )
    }

    /// The client asks for the path of its own trigger, but has none.
    pub(super) fn no_trigger() -> Self {
        Self::new(
            "no_trigger",
            "this client has not triggered, so no path is its own",
            "TRIGGER on this connection, or give the sequence number of the trigger's answer, as in PATH 1 41",
        )
    }

    /// The frame has fewer parts.
    fn no_such_part(index: u32, num_parts: u32) -> Self {
        Self::new(
            "no_such_part",
            &format!("there is no part {index} in a frame of {num_parts}"),
            "Ask for parts from 1 to the number of parts in PART's answer",
        )
    }

    /// The inspection is not kept any more, or never was.
    pub(super) fn no_such_inspection(sequence: u32) -> Self {
        Self::new(
            "no_such_inspection",
            &format!("inspection {sequence} is not kept"),
            "TRIGGER again, and give the sequence number of its answer",
        )
    }

    /// The server looks at parts, but moves no robot.
    pub(super) fn no_servoing() -> Self {
        Self::new(
            "no_servoing",
            "this server answers no SERVO",
            "Ask partsight serve, or a window that answers robots",
        )
    }

    /// The maximum number of clients is connected.
    pub(super) fn full(max_clients: usize) -> Self {
        Self::new(
            "full",
            &format!("{max_clients} clients are connected"),
            "Close a connection that is not used, or raise --max-clients",
        )
    }
}

/// The library of a service that takes new versions of it while it runs.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, JsonSchema)]
pub struct LibraryStatus {
    /// The version in use; null if it was not taken from a store.
    pub version: Option<u32>,
    /// Why a newer version could not be taken or used; null if there is none.
    pub problem: Option<Problem>,
}

/// Which of the poses goes out; see [`robot`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum PoseKind {
    /// Where the part is: for paths in the part's own frame.
    #[default]
    RobotFromPart,
    /// How far it is from its standard position: for paths taught in the base frame.
    RobotOffset,
}

/// A nozzle pose of the spray path, for the part as it hangs now.
#[derive(Clone, Debug, PartialEq)]
pub struct PathStep {
    /// Pose of the tool, see [`robot::spray`], in the robot's base frame.
    pub robot_from_nozzle: RigidTransform,
    /// [`Answer::GUN_ON`]: the gun is on from here to the next point; [`Answer::IN_BAND`]: within the band.
    pub marks: u16,
    /// Speed from here to the next point, m/s; none if the path sets none.
    pub speed: Option<f64>,
}

/// A place of a rack.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, JsonSchema)]
pub struct RackPlace {
    /// Its number by its order in the rack, from 1.
    pub number: u32,
    /// Its name.
    pub name: String,
}

/// A part that is expected in a frame, and does not hang there.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, JsonSchema)]
pub struct MissingPart {
    /// Its name.
    pub part: String,
    /// The number by which robots know it; null if it has none.
    pub number: Option<u32>,
    /// Where it is expected; null for any place.
    pub place: Option<RackPlace>,
}

impl From<&Found> for MissingPart {
    fn from(found: &Found) -> Self {
        Self {
            part: found.part.clone(),
            number: (found.number > 0).then_some(found.number),
            place: found.place.clone(),
        }
    }
}

/// What all parts of a frame show of the rack, and of what is expected.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, JsonSchema)]
pub struct FrameFacts {
    /// Name of the rack; left out if it has none, or there is no rack.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rack: Option<String>,
    /// The places of the rack at which nothing hangs; left out without a rack that has places.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub empty_places: Option<Vec<RackPlace>>,
    /// The expected parts that nothing hangs in place of; left out if nothing is expected.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub missing: Option<Vec<MissingPart>>,
}

/// Where a part on a line has its pose, and how long ago it was there.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
pub struct OnLineNow {
    #[serde(flatten)]
    on_line: OnLine,
    /// Milliseconds since it was there, at most 16777215.
    since_ms: u32,
}

/// The result of an inspection.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Found {
    /// [`VerdictCode::Accepted`], [`VerdictCode::Refused`], [`VerdictCode::NoPart`] or [`VerdictCode::Error`]; to a robot that
    /// servoes [`VerdictCode::Move`], [`VerdictCode::Done`], [`VerdictCode::Stay`] or [`VerdictCode::Error`].
    pub verdict: VerdictCode,
    /// When the frame was captured; none without a frame.
    pub captured: Option<Instant>,
    /// Name of the part; empty if it is not in the library.
    pub part: String,
    /// Number of the reference in whose coordinates the pose is; 0 if it has none.
    pub number: u32,
    /// The place of the rack where it hangs or, if it is missing, is expected; none if that is no place.
    pub place: Option<RackPlace>,
    /// Any of [`Answer::APPROXIMATE`], [`Answer::SIMULATED`] and [`Answer::MOTION_UNCHECKED`].
    pub marks: u16,
    /// The pose in the robot's base frame: of the part, sent only while the verdict is accepted, or of the flange, to a robot
    /// that should move there.
    pub pose: Option<RigidTransform>,
    /// To a robot that servoes: the error that is left, and at the target its bounds.
    pub servo_error: Option<RemainingError>,
    /// The part's stored spray path, moved by that pose.
    pub path: Vec<PathStep>,
    /// Why the stored path is not given; `None` also if none is stored.
    pub no_path: Option<Problem>,
    /// Where it is on the line, of a camera beside one: at the count that was sent or, if none was, in the frame.
    pub on_line: Option<OnLine>,
    /// When it is there, if it has a pose.
    pub on_line_since: Option<Instant>,
    /// The inspection as a JSON line; empty if there was none.
    pub report: String,
    /// Why there is no pose.
    pub problem: Problem,
}

/// How far a robot that servoes is from its target.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RemainingError {
    /// The error that is left.
    pub error: PoseDelta,
    /// Its bounds, 95 %; none before the target is reached.
    pub bounds: Option<PoseDelta>,
}

impl RemainingError {
    /// Error and angle, and their bounds, 0 for none: millimetres and degrees.
    pub(super) fn figures(&self) -> [f64; 4] {
        let figures = |delta: &PoseDelta| [delta.shift.mm(), delta.rotation.degrees()];
        let [mm, degrees] = figures(&self.error);
        let [bound_mm, bound_degrees] = self.bounds.as_ref().map_or([0.0; 2], figures);
        [mm, degrees, bound_mm, bound_degrees]
    }
}

impl Found {
    /// A result for a trigger after which nothing could be inspected.
    pub fn error(problem: Problem) -> Self {
        Self {
            verdict: VerdictCode::Error,
            problem,
            ..Self::default()
        }
    }

    /// Refuses a part that was accepted, and withholds its pose and its path.
    pub fn refuse(&mut self, problem: Problem) {
        self.verdict = VerdictCode::Refused;
        self.marks &= !Answer::OF_ACCEPTED;
        self.pose = None;
        self.path.clear();
        self.on_line = self.on_line.map(|_| OnLine::default());
        self.on_line_since = None;
        self.problem = problem;
    }
}

/// What hangs in a frame: the first part, or what there is instead of one, and the others.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FrameParts {
    /// The part of those who ask for one.
    pub first: Found,
    /// Further parts, in their order.
    pub others: Vec<Found>,
    /// What they show together.
    pub facts: Arc<FrameFacts>,
}

impl From<Found> for FrameParts {
    fn from(first: Found) -> Self {
        Self {
            first,
            ..Self::default()
        }
    }
}

impl FrameParts {
    /// All of them in their order: at least one.
    pub fn iter(&self) -> impl Iterator<Item = &Found> {
        iter::once(&self.first).chain(&self.others)
    }

    /// All of them in their order, to be changed.
    pub fn iter_mut(&mut self) -> impl Iterator<Item = &mut Found> {
        iter::once(&mut self.first).chain(&mut self.others)
    }

    /// The one of this index.
    pub(super) fn get(&self, index: usize) -> Option<&Found> {
        self.iter().nth(index)
    }

    /// Number of parts, missing ones included; 0 if nothing recognisable hangs there, and nothing is expected.
    pub(super) fn num_parts(&self) -> u32 {
        let has_part = |found: &&Found| match found.verdict {
            VerdictCode::Accepted | VerdictCode::Refused => true,
            _ => !found.part.is_empty(),
        };
        u32::try_from(self.iter().filter(has_part).count()).unwrap_or(u32::MAX)
    }
}

/// Maximum of sequence and boot numbers, and of ages in milliseconds: up to here a 32-bit real of a controller holds whole
/// numbers exactly.
pub const MAX_COUNT: u32 = (1 << 24) - 1;

/// What a trigger found in its frame, with its numbers.
#[derive(Debug, Default)]
pub(super) struct Inspected {
    /// The sequence number of the first part, from 1; those of the others follow. 0 before the first inspection.
    pub(super) sequence: u32,
    /// The boot number when it was made.
    pub(super) boot: u32,
    /// The parts, or what there is instead of one.
    pub(super) found: FrameParts,
    /// Why its poses and paths may not be sent any more, if they were accepted.
    pub(super) revoked: OnceLock<Problem>,
}

impl Inspected {
    /// The sequence number of a part, counted from 0.
    pub(super) fn sequence_of(&self, index: usize) -> u32 {
        match (self.sequence, u32::try_from(index)) {
            (sequence @ 1.., Ok(index)) => (sequence - 1 + index) % MAX_COUNT + 1,
            _ => 0,
        }
    }

    /// The answers to a request about each part.
    pub(super) fn answers(&self, request: &Request, at: &Situation) -> Vec<Answer> {
        let indices = 0..self.found.iter().count();
        indices
            .map(|index| Answer::of(request, self, index, at))
            .collect()
    }

    /// The verdict of a part as it holds now, with the reason if it differs from the original.
    fn judged(
        &self,
        found: &Found,
        age: Option<Duration>,
        max_age: Duration,
    ) -> (VerdictCode, Problem) {
        match self.revoked.get() {
            Some(problem) if found.verdict == VerdictCode::Accepted => {
                (VerdictCode::Refused, problem.clone())
            }
            _ => judged(found, age, max_age),
        }
    }
}

/// What an answer depends on besides the inspection.
#[derive(Clone, Debug)]
pub(super) struct Situation {
    /// The present boot number, 1..=[`MAX_COUNT`].
    pub(super) boot: u32,
    /// Maximum age of a frame before it is stale.
    pub(super) max_age: Duration,
    pub(super) camera: CameraStatus,
    pub(super) now: Instant,
}

/// An answer to a client, independent of the protocol.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Answer {
    /// The request answered; none if it could not be read, or if the client was refused before it sent one.
    pub request: Option<Request>,
    /// What the inspection, or else the request, came to.
    pub verdict: VerdictCode,
    /// Sequence number of the inspection, 1..=[`MAX_COUNT`]; 0 if there was none.
    pub sequence: u32,
    /// Boot number of this start of the server, 1..=[`MAX_COUNT`]; another one once the meaning of its poses has changed.
    pub boot: u32,
    /// Age of the frame, at most [`MAX_COUNT`] milliseconds; none without a frame.
    pub age_ms: Option<u32>,
    /// The camera's state.
    pub camera: CameraState,
    /// Name of the part; may be empty.
    pub part: String,
    /// Number of the reference; 0 if it has none.
    pub number: u32,
    /// The place of the rack where the part hangs or, if it is missing, is expected; none if that is no place.
    pub place: Option<RackPlace>,
    /// The flags of this type except [`Answer::POSE`], which [`Answer::flags`] adds.
    pub marks: u16,
    /// Number of the path's point, from 1; in the answer to [`Request::Part`] that of the part; 0 in other answers.
    pub point: u32,
    /// Number of points of the path; in the answer to [`Request::Part`] that of the frame's parts.
    pub points: u32,
    /// Number of the part in its frame, from 1; 0 if nothing recognisable hangs there.
    pub index: u32,
    /// Where the part is on the line, of a camera beside one.
    pub on_line: Option<OnLine>,
    /// Time from the moment of that pose to the answer, at most [`MAX_COUNT`] milliseconds.
    pub on_line_since_ms: Option<u32>,
    /// Number of parts of the frame, refused ones included.
    pub num_parts: u32,
    /// What the parts of the frame show together.
    pub facts: Arc<FrameFacts>,
    /// Speed from this point to the next, mm/s.
    pub speed_mm_s: Option<f64>,
    /// Pose in the robot's base frame; only with an accepted verdict, or for a robot that should move there.
    pub pose: Option<RigidTransform>,
    /// To [`Request::Servo`]: the error that is left.
    pub servo_error: Option<RemainingError>,
    /// Why there is no pose; in an answer to a status request, the camera's problem.
    pub problem: Problem,
}

impl Answer {
    /// Flag: the answer contains a pose.
    pub const POSE: u16 = 1;
    /// Flag: the part may be another model; its pose is only about right.
    pub const APPROXIMATE: u16 = 2;
    /// Flag: the scene is simulated or replayed, or the part was enrolled from a simulation.
    pub const SIMULATED: u16 = 4;
    /// Flag of a point of the path: the gun sprays from here to the next point.
    pub const GUN_ON: u16 = 8;
    /// Flag of a point of the path: distance and angle to the surface seen by the camera are within the band.
    pub const IN_BAND: u16 = 16;
    /// Flag: the source has no second frame, so whether the part hung still was not checked.
    pub const MOTION_UNCHECKED: u16 = 32;

    /// Flags that only an accepted part has.
    const OF_ACCEPTED: u16 = Self::APPROXIMATE | Self::MOTION_UNCHECKED;

    /// All flags that are set, with [`Answer::POSE`] if there is a pose.
    pub fn flags(&self) -> u16 {
        let pose = if self.pose.is_some() { Self::POSE } else { 0 };
        self.marks | pose
    }

    /// The age in milliseconds; -1 without a frame.
    pub(super) fn age_or_none(&self) -> i32 {
        self.age_ms
            .and_then(|age| i32::try_from(age).ok())
            .unwrap_or(-1)
    }

    /// Milliseconds from the moment of the pose on a line to the answer; -1 without one.
    pub(super) fn on_line_since_or_none(&self) -> i32 {
        let since = self.on_line_since_ms;
        since
            .and_then(|since| i32::try_from(since).ok())
            .unwrap_or(-1)
    }

    /// The number of the part's place, 0 for none; `None` without a rack that has places.
    pub(super) fn place_number(&self) -> Option<u32> {
        self.facts.empty_places.as_ref()?;
        Some(self.place.as_ref().map_or(0, |place| place.number))
    }

    /// Where the part is on the line, if it has a pose there.
    pub fn on_line_now(&self) -> Option<OnLineNow> {
        let (on_line, since_ms) = self.on_line.zip(self.on_line_since_ms)?;
        Some(OnLineNow { on_line, since_ms })
    }

    /// An answer to a client that is refused, or whose request could not be read.
    pub(super) fn turned_away(verdict: VerdictCode, problem: Problem, at: &Situation) -> Self {
        Self {
            verdict,
            boot: at.boot,
            camera: at.camera.state,
            problem,
            ..Self::default()
        }
    }

    /// Answers a request from a part of an inspected frame, counted from 0.
    pub(super) fn of(
        request: &Request,
        inspected: &Inspected,
        index: usize,
        at: &Situation,
    ) -> Self {
        // A part that is not there is answered with the numbers of the first.
        let (index, found) = match inspected.found.get(index) {
            Some(found) => (index, found),
            None => (0, &inspected.found.first),
        };
        let num_parts = inspected.found.num_parts();
        let age = found
            .captured
            .map(|captured| at.now.saturating_duration_since(captured));
        let (verdict, problem) = inspected.judged(found, age, at.max_age);
        let marks = match verdict {
            VerdictCode::Refused => found.marks & !Self::OF_ACCEPTED,
            _ => found.marks,
        };
        let mut answer = Self {
            request: Some(request.clone()),
            verdict,
            sequence: inspected.sequence_of(index),
            // Its numbers have the meaning that they had then.
            boot: inspected.boot,
            age_ms: age.map(in_milliseconds),
            camera: at.camera.state,
            part: found.part.clone(),
            number: found.number,
            place: found.place.clone(),
            marks,
            facts: Arc::clone(&inspected.found.facts),
            // No part, no number.
            index: u32::try_from(index + 1).map_or(num_parts, |index| index.min(num_parts)),
            num_parts,
            problem,
            on_line: found.on_line.map(|_| OnLine::default()),
            ..Self::default()
        };
        if let &Request::Part { number, .. } = request {
            if number > answer.num_parts {
                answer.verdict = VerdictCode::BadRequest;
                answer.problem = Problem::no_such_part(number, answer.num_parts);
            }
            (answer.point, answer.points) = (number, answer.num_parts);
        }
        if let (Request::Status, Some(problem)) = (request, &at.camera.problem) {
            answer.problem = problem.clone();
        }
        // Here and in `take_move` alone, numbers get into an answer.
        if answer.verdict == VerdictCode::Accepted {
            let num_points = u32::try_from(found.path.len()).unwrap_or(u32::MAX);
            match *request {
                Request::Trigger { .. } | Request::Last => {
                    (answer.pose, answer.points) = (found.pose, num_points);
                }
                Request::Status | Request::Path { point: 0, .. } => answer.points = num_points,
                Request::Path { point, .. } => {
                    answer.points = num_points;
                    answer.take_point(point, found);
                }
                Request::Part { number: 0, .. } | Request::Servo(_) => {}
                Request::Part { .. } => answer.pose = found.pose,
            }
            if answer.pose.is_some() {
                answer.on_line = found.on_line;
                let since = found.on_line_since;
                let since = since.map(|then| at.now.saturating_duration_since(then));
                answer.on_line_since_ms = since.map(in_milliseconds);
            }
        }
        if let Request::Servo(_) = request {
            answer.take_move(found);
        }
        answer
    }

    fn take_move(&mut self, found: &Found) {
        match self.verdict {
            VerdictCode::Move => (self.pose, self.servo_error) = (found.pose, found.servo_error),
            VerdictCode::Done => self.servo_error = found.servo_error,
            _ => {}
        }
    }

    fn take_point(&mut self, point: u32, found: &Found) {
        let step = usize::try_from(point).ok();
        let Some(step) = step.and_then(|i| found.path.get(i - 1)) else {
            self.verdict = VerdictCode::BadRequest;
            self.problem = found.no_path.clone().unwrap_or_else(|| {
                let num = found.path.len();
                let what = format!("there is no point {point} in a path of {num}");
                let advice = if found.path.is_empty() {
                    "Store a path for the part, in Paint or with partsight library path NAME path.csv. A running partsight serve has to be started again"
                } else {
                    "Ask for points from 1 to the number of points in PATH's answer"
                };
                Problem::new("no_such_point", &what, advice)
            });
            return;
        };
        self.point = point;
        self.marks |= step.marks;
        self.speed_mm_s = step.speed.map(|speed| speed * 1000.0);
        self.pose = Some(step.robot_from_nozzle);
    }
}

fn in_milliseconds(age: Duration) -> u32 {
    let age = u32::try_from(age.as_millis()).unwrap_or(MAX_COUNT);
    age.min(MAX_COUNT)
}

/// The verdict as it holds now, with the reason if it differs from the original.
pub(super) fn judged(
    found: &Found,
    age: Option<Duration>,
    max_age: Duration,
) -> (VerdictCode, Problem) {
    let advice = match found.verdict {
        VerdictCode::Accepted => "TRIGGER again; if a path takes longer to fetch, raise --max-age",
        VerdictCode::Move | VerdictCode::Done => {
            "SERVO again; if the computer takes so long, close what else uses it"
        }
        _ => return (found.verdict, found.problem.clone()),
    };
    let has_pose = found.pose.is_some() || found.verdict == VerdictCode::Done;
    let is_fresh = age.is_some_and(|age| age <= max_age);
    let poses = found.path.iter().map(|step| &step.robot_from_nozzle);
    let mut poses = poses.chain(&found.pose);
    let is_finite = poses.all(|pose| row_major(pose).iter().all(|number| number.is_finite()));
    if !is_fresh {
        let what = format!("the frame is older than {} s", max_age.as_secs_f64());
        (VerdictCode::Stale, Problem::new("stale", &what, advice))
    } else if !has_pose || !is_finite {
        let what = "the part was accepted without a pose";
        let advice = "Start the server without --pose none, and TRIGGER again";
        (VerdictCode::Refused, Problem::new("no_pose", what, advice))
    } else {
        (found.verdict, found.problem.clone())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::request::ServoRequest;
    use geometry::{
        rigid::from_euler_zyx,
        units::{Metres, Radians},
    };

    /// The answer about the first part.
    fn answer_of(request: &Request, inspected: &Inspected, at: &Situation) -> Answer {
        Answer::of(request, inspected, 0, at)
    }

    fn pose() -> RigidTransform {
        from_euler_zyx([0.1, -0.2, 0.3, 1.2, -0.4, 1.9])
    }

    fn found(captured: Instant) -> Found {
        Found {
            verdict: VerdictCode::Accepted,
            captured: Some(captured),
            part: "fender".into(),
            number: 3,
            place: Some(RackPlace {
                number: 2,
                name: "right hook".into(),
            }),
            marks: Answer::SIMULATED,
            pose: Some(pose()),
            servo_error: None,
            path: vec![PathStep {
                robot_from_nozzle: pose(),
                marks: Answer::GUN_ON,
                speed: Some(0.25),
            }],
            no_path: None,
            on_line: None,
            on_line_since: None,
            report: "{}".into(),
            problem: Problem::default(),
        }
    }

    fn situation(now: Instant) -> Situation {
        Situation {
            boot: 7,
            max_age: Duration::from_secs(10),
            camera: CameraStatus {
                state: CameraState::Running,
                problem: None,
            },
            now,
        }
    }

    const fn path(point: u32) -> Request {
        Request::Path {
            point,
            sequence: None,
        }
    }

    const fn part(number: u32) -> Request {
        Request::Part {
            number,
            sequence: None,
        }
    }

    /// A robot that servoes.
    fn servo() -> Request {
        Request::Servo(ServoRequest {
            part: 3,
            is_start: false,
            robot_from_flange: pose(),
        })
    }

    const ALL: [Request; 8] = [
        Request::TRIGGER,
        Request::Status,
        Request::Last,
        path(0),
        path(1),
        path(2),
        part(0),
        part(1),
    ];

    /// True if the answer has no pose, and no number of points of a path.
    fn has_no_numbers(request: &Request, answer: &Answer) -> bool {
        // Of the frame's parts, refused ones count as well.
        let num_parts = match request {
            Request::Part { .. } => answer.num_parts,
            _ => 0,
        };
        answer.pose.is_none() && answer.points == num_parts
    }

    fn inspected(sequence: u32, found: Found) -> Inspected {
        Inspected {
            sequence,
            boot: 7,
            found: found.into(),
            ..Inspected::default()
        }
    }

    #[test]
    fn numbers_go_out_with_an_accepted_verdict_only() {
        let start = Instant::now();
        let inspected = |found| inspected(5, found);
        let at = situation(start + Duration::from_millis(1500));
        for verdict in [
            VerdictCode::None,
            VerdictCode::Refused,
            VerdictCode::NoPart,
            VerdictCode::Error,
        ] {
            let last = inspected(Found {
                verdict,
                ..found(start)
            });
            for request in &ALL {
                let answer = answer_of(request, &last, &at);
                assert_eq!(answer.verdict, verdict, "{request:?}");
                assert!(has_no_numbers(request, &answer), "{request:?}");
                assert_eq!(answer.flags() & Answer::POSE, 0);
                assert_eq!(answer.speed_mm_s, None);
            }
        }
        let last = inspected(found(start));
        for request in &ALL {
            let answer = answer_of(request, &last, &at);
            let without = [Request::Status, path(0), path(2), part(0)];
            let has_pose = !without.contains(request);
            assert_eq!(answer.pose.is_some(), has_pose, "{request:?}");
            assert_eq!(answer.age_ms, Some(1500));
            assert_eq!((answer.sequence, answer.boot), (5, 7));
        }
        let step = answer_of(&path(1), &last, &at);
        assert_eq!(
            (step.point, step.points, step.speed_mm_s),
            (1, 1, Some(250.0))
        );
        assert_eq!(
            step.flags(),
            Answer::POSE | Answer::SIMULATED | Answer::GUN_ON
        );
        let beyond = answer_of(&path(2), &last, &at);
        assert_eq!(beyond.verdict, VerdictCode::BadRequest);
        assert_eq!(beyond.problem.reason, "no_such_point");
        let withheld = Problem::new(
            "off_the_part",
            "the path does not aim at the part",
            "Check it",
        );
        let mut last = inspected(Found {
            path: Vec::new(),
            no_path: Some(withheld.clone()),
            ..found(start)
        });
        let answer = answer_of(&path(1), &last, &at);
        assert_eq!(
            (answer.verdict, answer.problem),
            (VerdictCode::BadRequest, withheld)
        );
        last.found.first.no_path = None;
        let answer = answer_of(&path(1), &last, &at);
        assert!(answer.problem.message.contains("Store a path"));
    }

    #[test]
    fn what_was_accepted_becomes_stale_and_loses_its_numbers() {
        let start = Instant::now();
        let last = inspected(1, found(start));
        let fresh = situation(start + Duration::from_secs(10));
        assert!(answer_of(&Request::Last, &last, &fresh).pose.is_some());
        let late = situation(start + Duration::from_millis(10_001));
        for request in &ALL {
            let answer = answer_of(request, &last, &late);
            assert_eq!(answer.verdict, VerdictCode::Stale, "{request:?}");
            assert!(has_no_numbers(request, &answer), "{request:?}");
            assert_eq!(answer.problem.reason, "stale");
            assert_eq!(answer.part, "fender");
        }
    }

    #[test]
    fn a_robot_that_servoes_gets_a_pose_only_to_move_there_and_nobody_else_gets_it() {
        let start = Instant::now();
        let error = Some(RemainingError {
            error: PoseDelta {
                shift: Metres(0.1),
                rotation: Radians(0.1),
            },
            bounds: None,
        });
        let all = (0..=10).map(|code| {
            let verdicts = [
                VerdictCode::None,
                VerdictCode::Accepted,
                VerdictCode::Refused,
                VerdictCode::NoPart,
                VerdictCode::Stale,
                VerdictCode::Error,
                VerdictCode::Full,
                VerdictCode::BadRequest,
                VerdictCode::Move,
                VerdictCode::Done,
                VerdictCode::Stay,
            ];
            let verdict = verdicts[code];
            assert_eq!(usize::from(verdict.code()), code);
            verdict
        });
        for verdict in all {
            let looked = inspected(
                4,
                Found {
                    verdict,
                    servo_error: error,
                    path: Vec::new(),
                    ..found(start)
                },
            );
            let answer = answer_of(&servo(), &looked, &situation(start));
            let (is_move, is_done) = (verdict == VerdictCode::Move, verdict == VerdictCode::Done);
            assert_eq!(answer.pose.is_some(), is_move, "{verdict:?}");
            assert_eq!(
                answer.servo_error.is_some(),
                is_move || is_done,
                "{verdict:?}"
            );
            let late = situation(start + Duration::from_secs(11));
            let late = answer_of(&servo(), &looked, &late);
            assert_eq!((late.pose, late.servo_error), (None, None), "{verdict:?}");
            if is_move || is_done {
                assert_eq!(
                    (late.verdict, &*late.problem.reason),
                    (VerdictCode::Stale, "stale")
                );
                for request in &ALL {
                    assert!(
                        answer_of(request, &looked, &situation(start))
                            .pose
                            .is_none()
                    );
                }
            }
        }
        let endless = RigidTransform::translation(f64::NAN, 0.0, 0.0);
        for pose in [None, Some(endless)] {
            let verdict = VerdictCode::Move;
            let wrong = Found {
                verdict,
                pose,
                ..found(start)
            };
            let answer = answer_of(&servo(), &inspected(4, wrong), &situation(start));
            assert_eq!((answer.verdict, answer.pose), (VerdictCode::Refused, None));
        }
    }

    #[test]
    fn a_pose_that_is_missing_or_not_finite_is_refused() {
        let start = Instant::now();
        let mut endless = pose();
        endless.translation.vector.x = f64::NAN;
        let step = PathStep {
            robot_from_nozzle: endless,
            marks: 0,
            speed: None,
        };
        for wrong in [
            Found {
                pose: None,
                ..found(start)
            },
            Found {
                pose: Some(endless),
                ..found(start)
            },
            Found {
                path: vec![step],
                ..found(start)
            },
        ] {
            let last = inspected(1, wrong);
            for request in &ALL {
                let answer = answer_of(request, &last, &situation(start));
                assert_eq!(answer.verdict, VerdictCode::Refused);
                assert_eq!(answer.pose, None);
                assert_eq!(answer.problem.reason, "no_pose");
            }
        }
    }

    #[test]
    fn a_status_tells_why_the_camera_gives_nothing() {
        let now = Instant::now();
        let problem = Problem {
            reason: "camera_lost".into(),
            message: "the Kinect is gone (to do: Plug it in)".into(),
        };
        let at = Situation {
            camera: CameraStatus {
                state: CameraState::Lost,
                problem: Some(problem.clone()),
            },
            ..situation(now)
        };
        let answer = answer_of(&Request::Status, &Inspected::default(), &at);
        assert_eq!(answer.problem, problem);
        assert_eq!(answer.camera, CameraState::Lost);
        let none = (answer.verdict, answer.sequence, answer.age_or_none());
        assert_eq!(none, (VerdictCode::None, 0, -1));
    }

    #[test]
    fn an_age_is_never_longer_than_the_longest_number() {
        assert_eq!(in_milliseconds(Duration::MAX), MAX_COUNT);
    }

    #[test]
    fn what_is_revoked_is_refused_with_the_boot_number_of_its_numbers() {
        let now = Instant::now();
        let mut wrong = found(now);
        wrong.marks |= Answer::APPROXIMATE | Answer::MOTION_UNCHECKED;
        let last = inspected(5, wrong);
        last.revoked.set(Problem::reported_wrong()).expect("once");
        let at = Situation {
            boot: 8,
            ..situation(now)
        };
        for request in &ALL {
            let answer = answer_of(request, &last, &at);
            assert_eq!(answer.verdict, VerdictCode::Refused, "{request:?}");
            assert!(has_no_numbers(request, &answer), "{request:?}");
            assert_eq!((answer.flags(), answer.boot), (Answer::SIMULATED, 7));
            assert_eq!(answer.problem.reason, "reported_wrong");
        }
    }
}
