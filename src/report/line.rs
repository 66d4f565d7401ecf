//! The inspection as one line of JSON.

use jiff::Timestamp;
use serde::Serialize;

use crate::{
    capture::Captured,
    geometry::rigid::row_major,
    history::Traceability,
    pipeline::{Inspection, NamedRecipe, RecipeBlock, Refusal, RefusalKind, Timings, Verdict},
    robot::RobotFrame,
    stages::pose::{PoseEstimate, Uncertainty},
};

/// The version of the JSON lines.
pub const SCHEMA: u32 = 1;

/// An inspection as one line of JSON, as `inspect --json` writes it. Fields are only ever added.
#[derive(Debug, Serialize)]
pub struct InspectionLine<'a> {
    schema: u32,
    scene: &'a str,
    #[serde(flatten)]
    capture: Option<CaptureLine<'a>>,
    /// Of a file that says that no camera was read; what a source captured says it itself.
    #[serde(skip_serializing_if = "Option::is_none")]
    simulated: Option<bool>,
    status: &'static str,
    part: Option<&'a str>,
    accepted: bool,
    score: Option<f64>,
    margin: Option<f64>,
    reason: Option<String>,
    /// The same for programs.
    reason_kind: Option<RefusalKind>,
    /// What was taken for the part reaches the picture's edge: some of it may be missing.
    touches_edge: bool,
    pose: Option<PoseLine<'a>>,
    /// The same pose for the robot, if a calibration says where the camera sits.
    #[serde(skip_serializing_if = "Option::is_none")]
    robot: Option<RobotLine<'a>>,
    ranking: Vec<RankLine<'a>>,
    timings_ms: Option<TimingsLine>,
    #[serde(skip_serializing_if = "Option::is_none")]
    recipe: Option<RecipeBlock>,
    /// Of several frames inspected together.
    #[serde(skip_serializing_if = "Option::is_none")]
    scan: Option<ScanLine<'a>>,
    /// `serial`, `order` and `operator`, where they are known.
    #[serde(flatten)]
    trace: Option<&'a Traceability>,
}

/// What a line says more of several frames that were inspected together.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct ScanLine<'a> {
    /// Frames given.
    pub frames: usize,
    /// Those that were used.
    pub used: usize,
    /// The frame whose camera the pose is before.
    pub reference_frame: &'a str,
    /// Takes part space to the robot's base; null unless the part was accepted.
    pub base_from_part: Option<[f64; 16]>,
}

/// Poses in the robot's base frame; see [`crate::robot`] for what each of them is.
#[derive(Debug, Serialize)]
struct RobotLine<'a> {
    calibration: &'a str,
    robot_from_camera: [f64; 16],
    robot_from_part: [f64; 16],
    robot_offset: [f64; 16],
}

/// What a line says more of a capture that came from a source.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct CaptureLine<'a> {
    /// What was opened, as it can be opened again.
    source: &'a str,
    number: u64,
    taken_at: Timestamp,
    simulated: bool,
    /// Captures that were dropped since the source was opened, because others were being inspected.
    dropped: u64,
}

impl<'a> CaptureLine<'a> {
    /// Of a capture of this source.
    pub fn of(source: &'a str, captured: &Captured, num_dropped: u64) -> Self {
        Self {
            source,
            number: captured.number,
            taken_at: captured.taken_at,
            simulated: captured.is_simulated,
            dropped: num_dropped,
        }
    }

    /// What was opened.
    pub fn source(&self) -> &'a str {
        self.source
    }

    /// When it was taken.
    pub fn taken_at(&self) -> Timestamp {
        self.taken_at
    }

    /// True if no camera was read.
    pub fn is_simulated(&self) -> bool {
        self.simulated
    }
}

#[derive(Debug, Serialize)]
struct PoseLine<'a> {
    /// The enrolled reference whose coordinates the part's space is: of several of one part each has its own.
    reference: Option<&'a str>,
    camera_from_part: [f64; 16],
    method: &'static str,
    rms_m: f64,
    overlap: f64,
    /// The pose is within these of the truth in 95 of 100 cases; null of an unconstrained one.
    shift_bound_m: Option<f64>,
    turn_bound_rad: Option<f64>,
    /// How the part could move, if the pose is unconstrained.
    unconstrained: Option<String>,
    stopped: &'static str,
    ambiguous: bool,
    approximate: bool,
}

#[derive(Debug, Serialize)]
struct RankLine<'a> {
    part: &'a str,
    /// Null if it was not examined, and others were.
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

/// How far off a pose may be, if something holds it.
fn bounds_of(pose: &PoseEstimate) -> Option<Uncertainty> {
    pose.uncertainty.filter(Uncertainty::is_held)
}

/// `ok`, `unknown` or `no_part`.
pub(super) fn status_of(verdict: &Verdict) -> &'static str {
    match verdict {
        Verdict::Part { .. } if verdict.is_unknown() => "unknown",
        Verdict::Part { .. } => "ok",
        Verdict::NoPart(_) => "no_part",
    }
}

impl<'a> InspectionLine<'a> {
    /// Of a scene that could not be read, and why.
    pub fn unreadable(scene: &'a str, reason: &dyn std::fmt::Display) -> Self {
        Self {
            schema: SCHEMA,
            scene,
            capture: None,
            simulated: None,
            status: "unreadable",
            part: None,
            accepted: false,
            score: None,
            margin: None,
            reason: Some(reason.to_string()),
            reason_kind: None,
            touches_edge: false,
            pose: None,
            robot: None,
            ranking: Vec::new(),
            timings_ms: None,
            recipe: None,
            scan: None,
            trace: None,
        }
    }

    /// The same line, with serial number, order and operator.
    #[must_use]
    pub fn traced(self, trace: &'a Traceability) -> Self {
        Self {
            trace: Some(trace),
            ..self
        }
    }

    /// The same line, with the recipe that it was inspected by.
    #[must_use]
    pub fn by(self, recipe: &NamedRecipe) -> Self {
        Self {
            recipe: Some(recipe.into()),
            ..self
        }
    }

    /// The same line, of several frames inspected together.
    #[must_use]
    pub fn of_scan(self, scan: ScanLine<'a>) -> Self {
        Self {
            scan: Some(scan),
            ..self
        }
    }

    /// The same line, of a scene that a source captured.
    #[must_use]
    pub fn captured(self, capture: Option<CaptureLine<'a>>) -> Self {
        Self { capture, ..self }
    }

    /// The same line of a file that says that no camera was read; of others nothing is known, so nothing is said.
    #[must_use]
    pub fn of_simulated_file(self) -> Self {
        Self {
            simulated: Some(true),
            ..self
        }
    }

    /// The same line with its pose in the robot's base frame; without a frame, or unless the part was accepted, it stays
    /// as it is: nothing is said that a robot could move by.
    #[must_use]
    pub fn in_robot(self, frame: Option<&'a RobotFrame>, inspection: &Inspection) -> Self {
        let pose = inspection.pose.as_ref().and_then(|pose| pose.as_ref().ok());
        let accepted = pose.filter(|_| inspection.verdict.is_accepted());
        let robot = frame.zip(accepted).map(|(frame, pose)| {
            let camera_from_part = pose.camera_from_part();
            RobotLine {
                calibration: &frame.name,
                robot_from_camera: row_major(&frame.robot_from_camera),
                robot_from_part: row_major(&frame.robot_from_part(&camera_from_part)),
                robot_offset: row_major(&frame.robot_offset(&camera_from_part)),
            }
        });
        Self { robot, ..self }
    }

    /// Of a scene by this name.
    pub fn of(scene: &'a str, inspection: &'a Inspection) -> Self {
        let ranking = inspection.ranking.by_part().map(|entry| RankLine {
            part: &entry.part,
            score: inspection.ranking.score_of(entry),
            examined: entry.is_examined,
            distance: entry.distance,
        });
        let pose = inspection
            .pose
            .as_ref()
            .and_then(|pose| pose.as_ref().ok())
            .map(|pose| PoseLine {
                reference: inspection.reference(),
                camera_from_part: row_major(&pose.camera_from_part()),
                method: pose.method.name(),
                rms_m: pose.fit.rms_m,
                overlap: pose.fit.overlap,
                shift_bound_m: bounds_of(pose).map(|bounds| bounds.shift.0),
                turn_bound_rad: bounds_of(pose).map(|bounds| bounds.turn.0),
                unconstrained: pose
                    .uncertainty
                    .and_then(|bounds| bounds.freedom)
                    .map(|freedom| freedom.to_string()),
                stopped: pose.stopped.name(),
                ambiguous: pose.is_ambiguous(),
                approximate: inspection.verdict.is_approximate(),
            });
        let verdict = &inspection.verdict;
        Self {
            status: status_of(verdict),
            part: verdict.guess().filter(|_| !verdict.is_unknown()),
            accepted: verdict.is_accepted(),
            score: verdict.score().map(|[score, _]| score),
            margin: verdict.score().map(|[_, margin]| margin),
            reason: verdict.complaint().map(|[why, _]| why),
            reason_kind: verdict.refusal().as_ref().map(Refusal::kind),
            touches_edge: inspection.touches_edge(),
            pose,
            ranking: ranking.collect(),
            timings_ms: Some(TimingsLine::of(&inspection.timings)),
            ..Self::unreadable(scene, &"")
        }
    }
}

impl InspectionLine<'_> {
    /// `ok`, `unknown`, `no_part` or `unreadable`.
    pub fn status(&self) -> &'static str {
        self.status
    }

    /// The line itself, without its end.
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
