//! An inspection as one line of JSON.

use jiff::Timestamp;
use serde::Serialize;

use super::surface_line::SurfaceLine;
use crate::history::Traceability;
use geometry::rigid::row_major;
use inspection::pipeline::{
    Expected, ExpectedPart, Inspection, RecipeBlock, Timings, Verdict, places_of,
};
use robot::{FrameName, RobotFrame, line::OnLine};

/// Version of the JSON lines.
pub const SCHEMA: u32 = 1;

/// An inspection as one line of JSON, as `inspect --json` writes it. Later versions only add fields.
#[derive(Debug, Default, Serialize)]
pub struct InspectionLine<'a> {
    schema: u32,
    scene: &'a str,
    /// The capture, if a source delivered the scene.
    #[serde(flatten)]
    pub capture: Option<CaptureLine<'a>>,
    /// True for a scene known to be simulated; captures from a source have their own field, and nothing is known about other files.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub simulated: Option<bool>,
    #[serde(flatten)]
    first: PartLine<'a>,
    /// Every part of a frame in which several may hang, by place and from left to right, then what else hangs there.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    parts: Vec<PartLine<'a>>,
    /// Name of the rack, if it has one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rack: Option<&'a str>,
    /// Names of the rack's places at which nothing hangs.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    empty_places: Vec<&'a str>,
    /// What should hang there, if something is expected.
    #[serde(flatten)]
    expected: Option<ExpectedLine<'a>>,
    /// The recipe of the inspection.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub recipe: Option<RecipeBlock>,
    /// Set for several frames inspected together.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub scan: Option<ScanLine<'a>>,
    /// `serial`, `order` and `operator`, as far as known.
    #[serde(flatten)]
    pub trace: Option<&'a Traceability>,
    /// What really hung there, if a person reported the acceptance as wrong: a part, `not_enrolled` or `nothing`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reported_as: Option<&'a str>,
    /// False if the part was accepted in a frame of a source and no other frame shows whether it hangs still.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub motion_checked: Option<bool>,
    /// True if the frame was recorded earlier, and is replayed now.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub replayed: Option<bool>,
}

/// The fields for one part of a scene.
#[derive(Debug, Default, Serialize)]
struct PartLine<'a> {
    status: &'static str,
    part: Option<&'a str>,
    accepted: bool,
    score: Option<f64>,
    margin: Option<f64>,
    reason: Option<String>,
    /// The reason in a form for programs.
    reason_kind: Option<String>,
    /// True if the surface taken for the part reaches the picture's edge: some of the part may be missing.
    touches_edge: bool,
    /// True if it goes on outside the work volume: some of the part may be missing.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    leaves_volume: bool,
    /// Name of the rack's place where it hangs.
    #[serde(skip_serializing_if = "Option::is_none")]
    place: Option<&'a str>,
    pose: Option<PoseLine<'a>>,
    /// The same pose for the robot, if the cell is calibrated and a robot may act on it.
    #[serde(skip_serializing_if = "Option::is_none")]
    robot: Option<RobotLine<'a>>,
    /// Where it is on the line that carries it, if it has its pose there.
    #[serde(skip_serializing_if = "Option::is_none")]
    on_line: Option<OnLine>,
    ranking: Vec<RankLine<'a>>,
    timings_ms: Option<TimingsLine>,
    /// Why a robot may not act on the pose although the cell is calibrated and the part was accepted.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    robot_doubts: Vec<&'static str>,
    /// What its surface is like, if it was checked.
    #[serde(skip_serializing_if = "Option::is_none")]
    surface: Option<SurfaceLine>,
}

/// Additional fields for a frame of which is known what should hang there.
#[derive(Clone, Debug, Serialize)]
struct ExpectedLine<'a> {
    #[serde(flatten)]
    expected: &'a Expected,
    #[serde(flatten)]
    missing: Option<MissingLine<'a>>,
    /// Whether it does, by all parts of the frame.
    #[serde(skip_serializing_if = "Option::is_none")]
    as_expected: Option<bool>,
}

/// Expected parts that nothing hangs in place of.
#[derive(Clone, Debug, Serialize)]
struct MissingLine<'a> {
    /// Their names.
    missing: Vec<&'a str>,
    /// The place of each; left out if each may hang anywhere.
    #[serde(skip_serializing_if = "Option::is_none")]
    missing_places: Option<Vec<Option<String>>>,
}

/// Additional fields for several frames that were inspected together.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct ScanLine<'a> {
    /// Number of frames given.
    pub frames: usize,
    /// Number of frames used.
    pub used: usize,
    /// The frame whose camera the pose refers to.
    pub reference_frame: &'a str,
    /// Pose of the part in the robot's base frame; null unless a robot may act on it.
    pub base_from_part: Option<[f64; 16]>,
}

/// Poses in the robot's base frame; see [`robot`] for their definitions.
#[derive(Debug, Serialize)]
struct RobotLine<'a> {
    calibration: &'a FrameName,
    robot_from_camera: [f64; 16],
    robot_from_part: [f64; 16],
    robot_offset: [f64; 16],
}

/// Additional fields for a capture from a source.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct CaptureLine<'a> {
    /// The source, in the form that opens it again.
    pub source: &'a str,
    /// Its number, counted by the source.
    pub number: u64,
    /// Time of the capture.
    pub taken_at: Timestamp,
    /// True if the capture does not come from a camera.
    pub simulated: bool,
    /// Captures dropped since the source was opened, because others were being inspected.
    pub dropped: u64,
}

#[derive(Debug, Serialize)]
struct PoseLine<'a> {
    /// The reference that defines part space: several references of one part each have their own.
    reference: Option<&'a str>,
    camera_from_part: [f64; 16],
    method: &'static str,
    rms_m: f64,
    overlap: f64,
    /// Bounds of the pose error in 95 of 100 cases; null if the pose is unconstrained.
    shift_bound_m: Option<f64>,
    turn_bound_rad: Option<f64>,
    /// How the part could move, if the pose is unconstrained.
    unconstrained: Option<String>,
    stopped: &'static str,
    ambiguous: bool,
    approximate: bool,
    /// Size of the part divided by that of its reference, if it is certainly another.
    off_scale: Option<f64>,
}

#[derive(Debug, Serialize)]
struct RankLine<'a> {
    part: &'a str,
    /// Null if it was not examined but others were.
    score: Option<f64>,
    examined: bool,
    distance: f64,
}

/// How long each stage took, milliseconds.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
pub struct TimingsLine {
    /// Segmentation.
    pub segment: f64,
    /// Projection.
    pub project: f64,
    /// Contour.
    pub contour: f64,
    /// Signature.
    pub signature: f64,
    /// Ranking.
    pub rank: f64,
    /// Pose, confirmation of the best few included.
    pub pose: f64,
    /// From the scene's points to the verdict.
    pub total: f64,
}

/// Returns `ok`, `unknown` or `no_part`.
pub(super) fn status_of(verdict: &Verdict) -> &'static str {
    match verdict {
        Verdict::Part { .. } if verdict.is_unknown() => "unknown",
        Verdict::Part { .. } => "ok",
        Verdict::NoPart(_) => "no_part",
    }
}

impl<'a> InspectionLine<'a> {
    /// Creates the line for a scene that could not be read.
    pub fn unreadable(scene: &'a str, reason: &dyn std::fmt::Display) -> Self {
        Self {
            schema: SCHEMA,
            scene,
            first: PartLine {
                status: "unreadable",
                reason: Some(reason.to_string()),
                ..PartLine::default()
            },
            ..Self::default()
        }
    }

    /// Creates the line for a trigger after which nothing was inspected. `kind` is the reason in a form for programs.
    pub fn failed(source: &'a str, kind: &str, reason: &str) -> Self {
        let mut line = Self::unreadable(source, &reason);
        line.first.status = "error";
        line.first.reason_kind = Some(kind.to_owned());
        line
    }

    /// Adds the pose in the robot's base frame, and why a robot may not act on it although the cell is calibrated and the part was
    /// accepted. Without a frame, nothing is added that a robot could move by.
    #[must_use]
    pub fn in_robot(
        mut self,
        frame: Option<&'a RobotFrame>,
        inspection: &Inspection,
        doubts: Vec<&'static str>,
    ) -> Self {
        self.first.robot_doubts = doubts;
        self.first.robot = frame.zip(inspection.found_pose()).map(|(frame, pose)| {
            let camera_from_part = pose.camera_from_part();
            RobotLine {
                calibration: &frame.name,
                robot_from_camera: row_major(&frame.robot_from_camera),
                robot_from_part: row_major(&frame.robot_from_part(&camera_from_part)),
                robot_offset: row_major(&frame.robot_offset(&camera_from_part)),
            }
        });
        self
    }

    /// Adds every part of the frame, each from its own line, and the places of the rack at which nothing hangs.
    #[must_use]
    pub fn with_parts(self, parts: impl Iterator<Item = Self>, empty_places: Vec<&'a str>) -> Self {
        Self {
            parts: parts.map(|line| line.first).collect(),
            empty_places,
            ..self
        }
    }

    /// Adds what should hang there, if something is expected, and what is missing, if that is known.
    #[must_use]
    pub fn expecting(
        self,
        expected: &'a Expected,
        missing: Option<impl IntoIterator<Item = &'a ExpectedPart>>,
    ) -> Self {
        let missing = missing.map(|missing| {
            let missing: Vec<&ExpectedPart> = missing.into_iter().collect();
            MissingLine {
                missing_places: places_of(missing.iter().copied()),
                missing: missing.into_iter().map(|part| &*part.name).collect(),
            }
        });
        let line = ExpectedLine {
            expected,
            missing,
            as_expected: None,
        };
        Self {
            expected: (!expected.is_empty()).then_some(line),
            ..self
        }
    }

    /// As [`expecting`](Self::expecting), with whether it hangs there, by the inspections of all parts of the frame.
    #[must_use]
    pub fn held_against(self, expected: &'a Expected, found: &[&Inspection]) -> Self {
        let mut line = self.expecting(expected, Some(expected.missing(found)));
        if let Some(expectation) = &mut line.expected {
            expectation.as_expected = Some(expected.is_met(found));
        }
        line
    }

    /// Adds where the part is on the line that carries it.
    #[must_use]
    pub fn on_line(mut self, on_line: Option<OnLine>) -> Self {
        self.first.on_line = on_line;
        self
    }

    /// Creates the line of an inspection of this scene.
    pub fn of(scene: &'a str, inspection: &'a Inspection) -> Self {
        let ranking = inspection.ranking.by_part().map(|entry| RankLine {
            part: &entry.part,
            score: inspection.ranking.score_of(entry),
            examined: entry.is_examined,
            distance: entry.distance,
        });
        let pose = inspection.found_pose().map(|pose| PoseLine {
            reference: inspection.reference(),
            camera_from_part: row_major(&pose.camera_from_part()),
            method: pose.method.name(),
            rms_m: pose.fit.rms_m,
            overlap: pose.fit.overlap,
            shift_bound_m: pose.bounds().map(|bounds| bounds.shift.0),
            turn_bound_rad: pose.bounds().map(|bounds| bounds.turn.0),
            unconstrained: pose
                .uncertainty
                .and_then(|bounds| bounds.freedom)
                .map(|freedom| freedom.to_string()),
            stopped: pose.stopped.name(),
            ambiguous: pose.is_ambiguous(),
            approximate: inspection.verdict.is_approximate(),
            off_scale: pose.off_scale().map(|off| off.scale()),
        });
        let verdict = &inspection.verdict;
        Self {
            schema: SCHEMA,
            scene,
            first: PartLine {
                status: status_of(verdict),
                part: verdict.guess().filter(|_| !verdict.is_unknown()),
                accepted: verdict.is_accepted(),
                score: verdict.score().map(|[score, _]| score),
                margin: verdict.score().map(|[_, margin]| margin),
                reason: verdict.complaint().map(|[why, _]| why),
                reason_kind: verdict.refusal().map(|why| why.kind().to_string()),
                touches_edge: inspection.touches_edge(),
                leaves_volume: inspection.leaves_volume,
                place: inspection.place.as_deref(),
                pose,
                ranking: ranking.collect(),
                timings_ms: Some(TimingsLine::of(&inspection.timings)),
                surface: inspection.surface.as_deref().map(SurfaceLine::of),
                ..PartLine::default()
            },
            ..Self::default()
        }
    }
}

impl InspectionLine<'_> {
    /// Returns `ok`, `unknown`, `no_part`, `unreadable` or `error`.
    pub fn status(&self) -> &'static str {
        self.first.status
    }

    /// Returns the line without a line end.
    pub fn to_json(&self) -> String {
        serde_json::to_string(self).expect("numbers and text have a JSON form")
    }
}

impl TimingsLine {
    pub(super) fn of(timings: &Timings) -> Self {
        // Whole microseconds: more digits are noise.
        let ms = |d: std::time::Duration| d.as_micros() as f64 / 1000.0;
        Self {
            segment: ms(timings.segment),
            project: ms(timings.project),
            contour: ms(timings.contour),
            signature: ms(timings.signature),
            rank: ms(timings.rank),
            pose: ms(timings.pose),
            total: ms(timings.total),
        }
    }
}
