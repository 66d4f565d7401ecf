//! What a client may ask for, and what it is answered.

use std::time::{Duration, Instant};

use schemars::JsonSchema;
use serde::Serialize;

use crate::{
    error::Advice,
    geometry::rigid::{RigidTransform, row_major},
};

/// What a client asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Request {
    /// Take a frame that is captured from now on, and inspect it.
    Trigger,
    /// How the camera is, and the last verdict without its numbers.
    Status,
    /// The last inspection again.
    Last,
    /// A point of the part's spray path, carried by the last pose: its number from 1, or 0 for how many there are.
    Path(u32),
}

impl Request {
    /// The word for it, and the number of binary frames.
    pub(super) fn name(self) -> (&'static str, u16) {
        match self {
            Self::Trigger => ("TRIGGER", 1),
            Self::Status => ("STATUS", 2),
            Self::Last => ("LAST", 3),
            Self::Path(_) => ("PATH", 4),
        }
    }

    /// The request of this word, in any case, with the point that a path is asked for.
    pub(super) fn of_name(word: &str, point: u32) -> Option<Self> {
        let all = [Self::Trigger, Self::Status, Self::Last, Self::Path(point)];
        let mut all = all.into_iter();
        all.find(|request| request.name().0.eq_ignore_ascii_case(word))
    }
}

/// What an answer says of the inspection. The numbers are part of the protocols.
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
}

impl VerdictCode {
    /// The word for it.
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
        }
    }

    /// The number for it.
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
    /// The word for it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Opening => "opening",
            Self::Running => "running",
            Self::Lost => "lost",
            Self::Over => "over",
        }
    }

    /// The number for it.
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
    pub trouble: Option<Trouble>,
}

/// Why there is no pose: for programs and for people.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, JsonSchema)]
pub struct Trouble {
    /// A word that stays the same in later versions; empty if there is nothing to say.
    pub reason: String,
    /// What happened and what to do.
    pub message: String,
}

impl Trouble {
    /// An error with its advice.
    pub fn of<E: std::fmt::Display + Advice>(reason: impl Into<String>, error: &E) -> Self {
        Self {
            reason: reason.into(),
            message: in_words(&error.to_string(), &error.advice()),
        }
    }

    /// As many clients as are allowed are connected.
    pub(super) fn full(max_clients: usize) -> Self {
        Self {
            reason: "full".into(),
            message: in_words(
                &format!("{max_clients} clients are connected"),
                "Close a connection that is not used, or raise --max-clients",
            ),
        }
    }
}

/// What happened and what to do about it, in one line.
pub(super) fn in_words(what: &str, advice: &str) -> String {
    format!("{what} (to do: {advice})")
}

/// A place of the nozzle for the part as it hangs now.
#[derive(Clone, Debug, PartialEq)]
pub struct PathStep {
    /// The tool's frame, see [`crate::robot::spray`], in the robot's base frame.
    pub robot_from_nozzle: RigidTransform,
    /// Gun on from here to the next point: [`Answer::GUN_ON`]; within the band: [`Answer::IN_BAND`].
    pub marks: u16,
    /// Speed from here to the next point, m/s, where the path sets one.
    pub speed: Option<f64>,
}

/// What an inspection came to.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Found {
    /// [`VerdictCode::Accepted`], [`VerdictCode::Refused`], [`VerdictCode::NoPart`] or [`VerdictCode::Error`].
    pub verdict: VerdictCode,
    /// When the frame was captured; none without a frame.
    pub captured: Option<Instant>,
    /// Name of the part; empty if it is none of the library.
    pub part: String,
    /// The number of the reference in whose coordinates the pose is; 0 if it has none.
    pub number: u32,
    /// [`Answer::APPROXIMATE`] and [`Answer::SIMULATED`].
    pub marks: u16,
    /// The pose in the robot's base frame. It goes out only while the verdict is accepted.
    pub pose: Option<RigidTransform>,
    /// The part's stored spray path, carried by that pose.
    pub path: Vec<PathStep>,
    /// The inspection as a line of JSON; empty if there was none.
    pub report: String,
    /// Why there is no pose.
    pub trouble: Trouble,
}

impl Found {
    /// There was nothing to inspect.
    pub fn error(trouble: Trouble) -> Self {
        Self {
            verdict: VerdictCode::Error,
            trouble,
            ..Self::default()
        }
    }
}

/// Sequence and boot numbers, and ages in milliseconds, go up to here: whole numbers that a controller's 32-bit real
/// still holds exactly.
pub const MAX_COUNT: u32 = (1 << 24) - 1;

/// An inspection with its number.
#[derive(Debug, Default)]
pub(super) struct Inspected {
    /// From 1; 0 before the first one.
    pub(super) sequence: u32,
    pub(super) found: Found,
}

impl Inspected {
    /// The number behind this one's.
    pub(super) fn next_sequence(&self) -> u32 {
        self.sequence % MAX_COUNT + 1
    }
}

/// When and by whom an answer is given.
#[derive(Clone, Debug)]
pub(super) struct Situation {
    /// The number of this start, 1..=[`MAX_COUNT`].
    pub(super) boot: u32,
    /// Older frames are stale.
    pub(super) max_age: Duration,
    pub(super) camera: CameraStatus,
    pub(super) now: Instant,
}

/// What a client is told, in whatever protocol.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Answer {
    /// What was asked for; none if that could not be read or was not waited for.
    pub request: Option<Request>,
    /// What to think of it.
    pub verdict: VerdictCode,
    /// The number of the inspection, 1..=[`MAX_COUNT`]; 0 if there was none.
    pub sequence: u32,
    /// The number of this start of the server, 1..=[`MAX_COUNT`].
    pub boot: u32,
    /// Age of the frame, at most [`MAX_COUNT`] milliseconds; none without a frame.
    pub age_ms: Option<u32>,
    /// How the camera is.
    pub camera: CameraState,
    /// Name of the part; may be empty.
    pub part: String,
    /// Number of the reference; 0 if it has none.
    pub number: u32,
    /// Of the constants of this type, but for [`Answer::POSE`]: see [`Answer::flags`].
    pub marks: u16,
    /// The point of the path, from 1; 0 otherwise.
    pub point: u32,
    /// Points of the path.
    pub points: u32,
    /// Speed from the point to the next one, mm/s.
    pub speed_mm_s: Option<f64>,
    /// In the robot's base frame; only of an accepted part.
    pub pose: Option<RigidTransform>,
    /// Why there is no pose; the camera's trouble in an answer about the status.
    pub trouble: Trouble,
}

impl Answer {
    /// Flag: the answer has the numbers of a pose.
    pub const POSE: u16 = 1;
    /// Flag: the part may be another model; its pose is only about right.
    pub const APPROXIMATE: u16 = 2;
    /// Flag: no camera saw the scene, or none saw the part when it was enrolled.
    pub const SIMULATED: u16 = 4;
    /// Flag of a point of the path: the gun sprays from here to the next one.
    pub const GUN_ON: u16 = 8;
    /// Flag of a point of the path: distance and angle to the surface that the camera saw are within the band.
    pub const IN_BAND: u16 = 16;

    /// The flags that hold.
    pub fn flags(&self) -> u16 {
        let pose = if self.pose.is_some() { Self::POSE } else { 0 };
        self.marks | pose
    }

    /// The age as a number: -1 without a frame.
    pub(super) fn age_or_none(&self) -> i32 {
        self.age_ms
            .and_then(|age| i32::try_from(age).ok())
            .unwrap_or(-1)
    }

    /// To a client that is not waited for, or whose request could not be read.
    pub(super) fn turned_away(verdict: VerdictCode, trouble: Trouble, at: &Situation) -> Self {
        Self {
            verdict,
            boot: at.boot,
            camera: at.camera.state,
            trouble,
            ..Self::default()
        }
    }

    /// To a request, from the inspection that it is about.
    pub(super) fn of(request: Request, last: &Inspected, at: &Situation) -> Self {
        let found = &last.found;
        let age = found
            .captured
            .map(|captured| at.now.saturating_duration_since(captured));
        let (verdict, trouble) = judged(found, age, at.max_age);
        let mut answer = Self {
            request: Some(request),
            verdict,
            sequence: last.sequence,
            boot: at.boot,
            age_ms: age.map(in_milliseconds),
            camera: at.camera.state,
            part: found.part.clone(),
            number: found.number,
            marks: found.marks,
            trouble,
            ..Self::default()
        };
        if let (Request::Status, Some(trouble)) = (request, &at.camera.trouble) {
            answer.trouble = trouble.clone();
        }
        // The one place where numbers get into an answer.
        if verdict == VerdictCode::Accepted {
            answer.points = u32::try_from(found.path.len()).unwrap_or(u32::MAX);
            match request {
                Request::Trigger | Request::Last => answer.pose = found.pose,
                Request::Status | Request::Path(0) => {}
                Request::Path(point) => answer.take_point(point, &found.path),
            }
        }
        answer
    }

    fn take_point(&mut self, point: u32, path: &[PathStep]) {
        let step = usize::try_from(point).ok().and_then(|i| path.get(i - 1));
        let Some(step) = step else {
            self.verdict = VerdictCode::BadRequest;
            let what = format!("point {point} of a path of {}", path.len());
            let advice = if path.is_empty() {
                "Store a path: partsight library path NAME path.csv, and start the server again"
            } else {
                "Ask for the points from 1 to the number of points that PATH answers"
            };
            self.trouble = Trouble {
                reason: "no_such_point".into(),
                message: in_words(&what, advice),
            };
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

/// The verdict as it holds now, and why it is not what it was.
pub(super) fn judged(
    found: &Found,
    age: Option<Duration>,
    max_age: Duration,
) -> (VerdictCode, Trouble) {
    if found.verdict != VerdictCode::Accepted {
        return (found.verdict, found.trouble.clone());
    }
    let refused = |verdict, reason: &str, what: &str, advice: &str| {
        let trouble = Trouble {
            reason: reason.into(),
            message: in_words(what, advice),
        };
        (verdict, trouble)
    };
    let is_fresh = age.is_some_and(|age| age <= max_age);
    let poses = found.path.iter().map(|step| &step.robot_from_nozzle);
    let mut poses = poses.chain(&found.pose);
    let is_finite = poses.all(|pose| row_major(pose).iter().all(|number| number.is_finite()));
    if !is_fresh {
        let what = format!("the frame is older than {} s", max_age.as_secs_f64());
        refused(
            VerdictCode::Stale,
            "stale",
            &what,
            "TRIGGER again; if a path takes longer to fetch, raise --max-age",
        )
    } else if found.pose.is_none() || !is_finite {
        refused(
            VerdictCode::Refused,
            "no_pose",
            "the part was accepted without a pose",
            "Start the server without --pose none, and TRIGGER again",
        )
    } else {
        (VerdictCode::Accepted, found.trouble.clone())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::rigid::from_euler_zyx;

    fn pose() -> RigidTransform {
        from_euler_zyx([0.1, -0.2, 0.3, 1.2, -0.4, 1.9])
    }

    fn found(captured: Instant) -> Found {
        Found {
            verdict: VerdictCode::Accepted,
            captured: Some(captured),
            part: "fender".into(),
            number: 3,
            marks: Answer::SIMULATED,
            pose: Some(pose()),
            path: vec![PathStep {
                robot_from_nozzle: pose(),
                marks: Answer::GUN_ON,
                speed: Some(0.25),
            }],
            report: "{}".into(),
            trouble: Trouble::default(),
        }
    }

    fn situation(now: Instant) -> Situation {
        Situation {
            boot: 7,
            max_age: Duration::from_secs(10),
            camera: CameraStatus {
                state: CameraState::Running,
                trouble: None,
            },
            now,
        }
    }

    const ALL: [Request; 6] = [
        Request::Trigger,
        Request::Status,
        Request::Last,
        Request::Path(0),
        Request::Path(1),
        Request::Path(2),
    ];

    #[test]
    fn numbers_go_out_with_an_accepted_verdict_only() {
        let start = Instant::now();
        let inspected = |found| Inspected { sequence: 5, found };
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
            for request in ALL {
                let answer = Answer::of(request, &last, &at);
                assert_eq!(answer.verdict, verdict);
                assert_eq!((answer.pose, answer.points), (None, 0), "{request:?}");
                assert_eq!(answer.flags() & Answer::POSE, 0);
                assert_eq!(answer.speed_mm_s, None);
            }
        }
        let last = inspected(found(start));
        for request in ALL {
            let answer = Answer::of(request, &last, &at);
            let has_pose = !matches!(request, Request::Status | Request::Path(0 | 2));
            assert_eq!(answer.pose.is_some(), has_pose, "{request:?}");
            assert_eq!(answer.age_ms, Some(1500));
            assert_eq!((answer.sequence, answer.boot), (5, 7));
        }
        let step = Answer::of(Request::Path(1), &last, &at);
        assert_eq!(
            (step.point, step.points, step.speed_mm_s),
            (1, 1, Some(250.0))
        );
        assert_eq!(
            step.flags(),
            Answer::POSE | Answer::SIMULATED | Answer::GUN_ON
        );
        let beyond = Answer::of(Request::Path(2), &last, &at);
        assert_eq!(beyond.verdict, VerdictCode::BadRequest);
        assert_eq!(beyond.trouble.reason, "no_such_point");
    }

    #[test]
    fn what_was_accepted_becomes_stale_and_loses_its_numbers() {
        let start = Instant::now();
        let last = Inspected {
            sequence: 1,
            found: found(start),
        };
        let fresh = situation(start + Duration::from_secs(10));
        assert!(Answer::of(Request::Last, &last, &fresh).pose.is_some());
        let late = situation(start + Duration::from_millis(10_001));
        for request in ALL {
            let answer = Answer::of(request, &last, &late);
            assert_eq!(answer.verdict, VerdictCode::Stale, "{request:?}");
            assert_eq!((answer.pose, answer.points), (None, 0));
            assert_eq!(answer.trouble.reason, "stale");
            assert_eq!(answer.part, "fender");
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
            let last = Inspected {
                sequence: 1,
                found: wrong,
            };
            for request in ALL {
                let answer = Answer::of(request, &last, &situation(start));
                assert_eq!(answer.verdict, VerdictCode::Refused);
                assert_eq!(answer.pose, None);
                assert_eq!(answer.trouble.reason, "no_pose");
            }
        }
    }

    #[test]
    fn a_status_tells_why_the_camera_gives_nothing() {
        let now = Instant::now();
        let trouble = Trouble {
            reason: "camera_lost".into(),
            message: "the Kinect is gone (to do: Plug it in)".into(),
        };
        let at = Situation {
            camera: CameraStatus {
                state: CameraState::Lost,
                trouble: Some(trouble.clone()),
            },
            ..situation(now)
        };
        let answer = Answer::of(Request::Status, &Inspected::default(), &at);
        assert_eq!(answer.trouble, trouble);
        assert_eq!(answer.camera, CameraState::Lost);
        let none = (answer.verdict, answer.sequence, answer.age_or_none());
        assert_eq!(none, (VerdictCode::None, 0, -1));
    }

    #[test]
    fn sequence_numbers_go_on_from_one_and_never_reach_zero() {
        let inspected = |sequence| Inspected {
            sequence,
            found: Found::default(),
        };
        assert_eq!(inspected(0).next_sequence(), 1);
        assert_eq!(inspected(41).next_sequence(), 42);
        assert_eq!(inspected(MAX_COUNT - 1).next_sequence(), MAX_COUNT);
        assert_eq!(inspected(MAX_COUNT).next_sequence(), 1);
        assert_eq!(in_milliseconds(Duration::MAX), MAX_COUNT);
    }
}
