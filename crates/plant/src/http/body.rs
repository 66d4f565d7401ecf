//! Bodies of the answers. Compatible changes only add fields.

use std::iter;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

use geometry::rigid::row_major;
use robot::{Convention, RobotPose};
use serve::{
    Answer, AskedOrder, CameraState, ExpectedNumber, FrameFacts, LibraryStatus, OnLineNow,
    PathStep, Problem, RackPlace, Request, VerdictCode, count_age,
};

/// What a trigger may say of its frame.
#[derive(Debug, Default, JsonSchema, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct TriggerBody {
    /// The numbers of the parts that should hang there, up to 8; a number that is given twice stands for two such parts.
    #[serde(default)]
    expected: Vec<u32>,
    /// The number of the place of each, by the order of the rack's file, from 1; 0, or none at its end, for any place.
    #[serde(default)]
    places: Vec<u32>,
    /// The production order whose parts should hang there, instead of their numbers.
    #[serde(default)]
    order: String,
    /// The serial number of what hangs there, alone or with its order.
    #[serde(default)]
    serial: String,
    /// What the encoder of the line shows, signed or unsigned, of up to 32 bits.
    #[serde(default)]
    count: Option<i64>,
    /// Milliseconds since the count was read, 0 to 10000; 0 if left out.
    #[serde(default)]
    count_age_ms: Option<f64>,
}

impl TriggerBody {
    /// Reads a body; an empty one expects nothing. `None` if it is something else.
    pub(super) fn request_in(body: &[u8]) -> Option<Request> {
        let read = |body| serde_json::from_slice::<Self>(body).ok();
        let Self {
            expected,
            places,
            order,
            serial,
            count,
            count_age_ms,
        } = match body.trim_ascii() {
            [] => Self::default(),
            body => read(body)?,
        };
        if expected.contains(&0) || places.len() > expected.len() {
            return None;
        }
        let counts = i64::from(i32::MIN)..=i64::from(u32::MAX);
        let is_none = |count: i64| !counts.contains(&count);
        if count.is_some_and(is_none) || (count.is_none() && count_age_ms.is_some()) {
            return None;
        }
        // A negative count is that of a counter of 32 bits.
        let count = count.map(|count| count as u32);
        let age = count_age(count_age_ms.unwrap_or_default())?;
        let places = places.into_iter().chain(iter::repeat(0));
        let parts = expected.into_iter().zip(places);
        let parts = parts.map(|(part, place)| ExpectedNumber { part, place });
        let request = Request::expecting(parts)?;
        let request = request.at_count(count).read_before(age);
        request.of_order(AskedOrder::new(&order, &serial)?)
    }
}

/// An answer about the last inspection, or why there is none.
#[derive(Debug, JsonSchema, Serialize)]
pub(super) struct AnswerBody {
    /// What to think of it. Only an accepted one has numbers.
    verdict: VerdictCode,
    /// The number of the inspection, 1 to 16777215; 0 if there was none.
    sequence: u32,
    /// The number of this start of the server, 1 to 16777215; another one once its poses mean something else.
    boot: u32,
    /// Milliseconds since the frame was captured, at most 16777215; null without a frame.
    age_ms: Option<u32>,
    /// How the camera is; null in the answer to a request that was refused.
    camera: Option<CameraState>,
    /// The name of the part; null if it is none of the library.
    part: Option<String>,
    /// The number of the reference in whose coordinates the pose is; null if it has none.
    number: Option<u32>,
    /// The part may be another model; its pose is only about right.
    approximate: bool,
    /// The scene is simulated or replayed, or no camera saw the part when it was enrolled.
    simulated: bool,
    /// It was checked that the part hung still, or there is no pose; false if the source does not show it.
    motion_checked: bool,
    /// The number of the part in its frame, from 1; 0 if nothing recognisable hangs there.
    index: u32,
    /// How many parts hang in the frame, refused ones included.
    num_parts: u32,
    /// The place of the rack where it hangs or, if it is missing, is expected; left out if that is no place.
    #[serde(skip_serializing_if = "Option::is_none")]
    place: Option<RackPlace>,
    /// How many points the part's spray path has; 0 without a pose.
    points: u32,
    /// The pose in the robot's base frame; null unless the part was accepted and the frame is fresh.
    pose: Option<PoseBody>,
    /// Where the part is on the line of a camera beside one; null without a pose.
    on_line: Option<OnLineNow>,
    /// Why there is no pose; of the status why the camera gives nothing; null if there is nothing to say.
    problem: Option<Problem>,
}

/// A pose in the robot's base frame.
#[derive(Debug, JsonSchema, Serialize)]
struct PoseBody {
    #[serde(flatten)]
    in_convention: RobotPose,
    /// The same pose, whatever the convention: a 4×4 matrix, row by row, lengths in metres.
    transform: [f64; 16],
}

impl AnswerBody {
    pub(super) fn of(answer: &Answer, convention: Convention) -> Self {
        let has = |mark| answer.flags() & mark != 0;
        Self {
            verdict: answer.verdict,
            sequence: answer.sequence,
            boot: answer.boot,
            age_ms: answer.age_ms,
            camera: Some(answer.camera),
            part: (!answer.part.is_empty()).then(|| answer.part.clone()),
            number: (answer.number > 0).then_some(answer.number),
            approximate: has(Answer::APPROXIMATE),
            simulated: has(Answer::SIMULATED),
            motion_checked: !has(Answer::MOTION_UNCHECKED),
            index: answer.index,
            num_parts: answer.num_parts,
            place: answer.place.clone(),
            points: answer.points,
            pose: answer.pose.map(|pose| PoseBody {
                in_convention: convention.write(&pose),
                transform: row_major(&pose),
            }),
            on_line: answer.on_line_now(),
            problem: (answer.problem != Problem::default()).then(|| answer.problem.clone()),
        }
    }

    /// An answer that is not about an inspection, because the request was refused or the program failed.
    pub(super) fn without_inspection(verdict: VerdictCode, boot: u32, problem: Problem) -> Self {
        let answer = Answer {
            verdict,
            boot,
            problem,
            ..Answer::default()
        };
        Self {
            camera: None,
            ..Self::of(&answer, Convention::default())
        }
    }
}

/// The answer about the first part of a frame, and those about all.
#[derive(Debug, JsonSchema, Serialize)]
pub(super) struct FrameBody {
    #[serde(flatten)]
    answer: AnswerBody,
    /// Every part, from left to right, accepted ones first; empty if nothing recognisable hangs there.
    parts: Vec<AnswerBody>,
    #[serde(flatten)]
    facts: FrameFacts,
}

impl FrameBody {
    pub(super) fn of(answers: &[Answer], convention: Convention) -> Self {
        let parts = answers.iter().filter(|part| part.num_parts > 0);
        Self {
            answer: AnswerBody::of(&answers[0], convention),
            parts: parts.map(|part| AnswerBody::of(part, convention)).collect(),
            facts: (*answers[0].facts).clone(),
        }
    }
}

/// How the service is.
#[derive(Debug, JsonSchema, Serialize)]
pub(super) struct StatusBody {
    #[serde(flatten)]
    pub(super) answer: AnswerBody,
    /// The library; null unless the service takes new versions of it while it runs.
    pub(super) library: Option<LibraryStatus>,
}

/// The last inspection with its spray path.
#[derive(Debug, JsonSchema, Serialize)]
pub(super) struct PathBody {
    #[serde(flatten)]
    answer: AnswerBody,
    /// Every point in its order; empty without a pose, or if none is stored.
    path: Vec<PathPoint>,
}

/// A point of the spray path as the part hangs now.
#[derive(Debug, JsonSchema, Serialize)]
struct PathPoint {
    /// The nozzle's pose in the robot's base frame: the numbers of the convention, in the order and units of `pose.values`.
    numbers: Vec<f64>,
    /// The gun sprays from this point to the next one.
    gun_on: bool,
    /// Distance and angle to the surface that the camera saw are within the band.
    in_band: bool,
    /// Speed to the next point, mm/s; null where the path sets none.
    speed_mm_s: Option<f64>,
}

impl PathBody {
    pub(super) fn of(answer: &Answer, path: &[PathStep], convention: Convention) -> Self {
        let points = path.iter().map(|step| {
            let pose = convention.write(&step.robot_from_nozzle);
            PathPoint {
                numbers: pose.numbers(),
                gun_on: step.marks & Answer::GUN_ON != 0,
                in_band: step.marks & Answer::IN_BAND != 0,
                speed_mm_s: step.speed.map(|speed| speed * 1000.0),
            }
        });
        Self {
            answer: AnswerBody::of(answer, convention),
            path: points.collect(),
        }
    }
}

/// The last inspection in full.
#[derive(Debug, JsonSchema, Serialize)]
pub(super) struct ReportBody {
    #[serde(flatten)]
    pub(super) frame: FrameBody,
    /// The line of JSON that `partsight serve --json` writes of it; null if nothing was inspected. Of a part without a pose
    /// above, it has none either.
    pub(super) report: Option<Map<String, Value>>,
}

/// The service answers.
#[derive(Debug, JsonSchema, Serialize)]
pub(super) struct HealthBody {
    /// The number of this start of the server, 1 to 16777215.
    pub(super) boot: u32,
    /// How the camera is. The service looks for a lost one by itself: there is no need to start it again.
    pub(super) camera: CameraState,
}
