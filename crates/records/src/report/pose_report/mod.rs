//! The pose report of an inspection: the verdict, and the pose of the part in a robot's convention.
//!
//! One type holds all of it; JSON, a CSV row and a PDF page are its three forms. Every number has its order, unit and
//! frame. The pose of a part that was not accepted has another name, and there are no numbers for the robot, so that no
//! program moves one by it.

mod blocks;
mod csv;
mod file;
mod pdf;
mod sheet;

use jiff::Timestamp;
use nalgebra::Point3;
use schemars::JsonSchema;
use serde::Serialize;

use super::{
    line::{TimingsLine, status_of},
    surface_line::SurfaceLine,
};
use crate::history::Traceability;
use inspection::pipeline::{Identification, Inspection, NamedRecipe, Recipe, RecipeBlock};
use robot::{Convention, RobotFrame};
use stages::{
    pose::PoseEstimate,
    stand_off::{StandOff, StandOffError, StandOffParams},
};

pub use self::{
    blocks::{
        BoundsBlock, DoubtBlock, FitBlock, MiddleBlock, NumberBlock, PoseBlock, RobotBlock,
        StandOffBlock, TransformBlock,
    },
    csv::{CsvError, append_csv},
    pdf::{PdfPictures, pose_pdf},
};

/// Version of the report; later reports only add fields.
pub const POSE_REPORT_SCHEMA: u32 = 1;

/// Number of entries of the ranking in the report.
const NUM_RANKED: usize = 5;

/// Whether a camera was read.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum SeenBy {
    /// A real camera, now or when it was recorded.
    Camera,
    /// None: the scene is simulated.
    Simulation,
    /// The scene is from a file without this information.
    NotKnown,
}

impl SeenBy {
    /// Describes the origin in words.
    pub fn describe(self) -> &'static str {
        match self {
            Self::Camera => "a camera",
            Self::Simulation => "SIMULATED: no camera was read",
            Self::NotKnown => "not known: the file does not say",
        }
    }
}

/// A pose report.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct PoseReport {
    /// Version of this report's form.
    pub schema: u32,
    /// When the scene was inspected, UTC (RFC 3339).
    #[schemars(with = "String")]
    pub inspected_at: Timestamp,
    /// The program and its version.
    pub program: String,
    /// The file or frame that was inspected.
    pub scene: String,
    /// Source of the frame, as the history names it; null from `partsight report`, which reads a file.
    pub source: Option<String>,
    /// Whether a camera was read.
    pub seen_by: SeenBy,
    /// Serial number, order and operator, as far as they are known.
    pub traceability: Traceability,
    /// What was decided.
    pub verdict: VerdictBlock,
    /// The enrolled parts that are most like it, at most five, best first.
    pub ranking: Vec<RankBlock>,
    /// Where the part is; null unless it was accepted.
    pub pose: Option<PoseBlock>,
    /// Where the part would be if it were what was not accepted. NOT A POSE TO MOVE BY: it is here to find out why.
    pub refused_pose: Option<PoseBlock>,
    /// The pose in the robot's base frame; null inside unless the part was accepted, the cell is calibrated, and a robot may
    /// act on it.
    pub robot: RobotBlock,
    /// The nozzle's stand-off if its path ran as it was taught; null unless the part was accepted and has a surface.
    pub stand_off: Option<StandOffBlock>,
    /// The check of the part's surface, which the page shows; other programs read it from the line of JSON.
    #[serde(skip)]
    pub surface: Option<SurfaceLine>,
    /// How long each stage took, milliseconds.
    pub timings_ms: TimingsLine,
    /// The parameters.
    pub recipe: RecipeBlock,
    /// The enrolled parts.
    pub library: LibraryBlock,
}

/// What was decided.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct VerdictBlock {
    /// What hangs there, which the page names; other programs read it from the fields below.
    #[serde(skip)]
    pub identification: Identification,
    /// `ok`, `unknown` or `no_part`.
    pub status: &'static str,
    /// The part's name, accepted or not; null if it is unknown or there is none.
    pub part: Option<String>,
    /// The enrolled part that comes nearest, where the part is unknown.
    pub nearest: Option<String>,
    /// True if the verdict counts. Nothing may move on a pose that was not accepted.
    pub accepted: bool,
    /// The probability that the part hangs there, 0..1.
    pub score: Option<f64>,
    /// Least score at which a part is accepted, 0..1.
    pub threshold: f64,
    /// How clearly the best part leads the next one, 0..1: the difference of their probabilities, given that only one of the
    /// two can hang there. Not the difference of their scores.
    pub margin: Option<f64>,
    /// Why it was not accepted.
    pub reason: Option<String>,
    /// What to do about it.
    pub advice: Option<String>,
    /// True if it may be another model of the part: its pose is only about right.
    pub approximate: bool,
    /// True if what was found reaches the picture's edge: some of it may be missing.
    pub touches_edge: bool,
    /// What really hung there, if a person reported the acceptance as wrong: a part, `not_enrolled` or `nothing`.
    pub reported_as: Option<String>,
}

/// An enrolled part that was looked for, and how likely it is.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct RankBlock {
    /// Its name.
    pub part: String,
    /// The probability that it hangs there, at the pose where it fits best, 0..1.
    pub score: f64,
}

/// The library.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct LibraryBlock {
    /// Eight hexadecimal digits, the same for the same parts with the same clouds, wherever they lie.
    pub identity: String,
    /// Enrolled references.
    pub num_references: usize,
}

/// The input of a report.
#[derive(Clone, Copy, Debug)]
pub struct ReportSubject<'a> {
    /// Time of the inspection.
    pub inspected_at: Timestamp,
    /// The inspected file or frame.
    pub scene: &'a str,
    /// The source of the frame, if any.
    pub source: Option<&'a str>,
    /// Whether a camera was read.
    pub seen_by: SeenBy,
    /// Serial number, order and operator.
    pub trace: &'a Traceability,
    /// The inspection.
    pub inspection: &'a Inspection,
    /// Middle of the best reference's extent, part space, metres.
    pub middle: Option<Point3<f64>>,
    /// The stand-off over the best reference at its pose.
    pub stand_off: Option<&'a Result<StandOff, StandOffError>>,
    /// The recipe of the inspection.
    pub recipe: &'a NamedRecipe,
    /// [`LibraryLoad::identity`](inspection::library::LibraryLoad::identity).
    pub library_identity: &'a str,
    /// Number of enrolled references.
    pub num_references: usize,
    /// The robot's frame, if the cell is calibrated.
    pub robot: Option<&'a RobotFrame>,
    /// The same frame, if the pose may be given in it.
    pub for_robot: Option<&'a RobotFrame>,
    /// Why a robot must not act on the result; not empty if `for_robot` is `None`.
    pub doubts: &'a [DoubtBlock],
    /// Convention of the poses, in addition to matrix and quaternion.
    pub convention: Convention,
}

impl PoseReport {
    /// Creates the report of an inspection.
    pub fn of(subject: &ReportSubject<'_>) -> Self {
        let inspection = subject.inspection;
        let verdict = VerdictBlock::of(inspection, subject.recipe);
        let found = inspection.found_pose();
        let block = found.map(|pose| PoseBlock::of(pose, inspection, subject));
        let camera_from_part = found
            .map(PoseEstimate::camera_from_part)
            .filter(|_| verdict.accepted);
        let (pose, refused_pose) = if verdict.accepted {
            (block, None)
        } else {
            (None, block)
        };
        let stand_off = subject.stand_off.and_then(|found| found.as_ref().ok());
        Self {
            schema: POSE_REPORT_SCHEMA,
            inspected_at: subject.inspected_at,
            program: format!("Partsight {}", env!("CARGO_PKG_VERSION")),
            scene: subject.scene.to_owned(),
            source: subject.source.map(ToOwned::to_owned),
            seen_by: subject.seen_by,
            traceability: subject.trace.clone(),
            pose,
            refused_pose,
            robot: RobotBlock::of(camera_from_part.as_ref(), verdict.accepted, subject),
            stand_off: stand_off
                .filter(|_| verdict.accepted)
                .map(|found| StandOffBlock::of(found, &subject.recipe.stand_off)),
            surface: inspection.surface.as_deref().map(SurfaceLine::of),
            verdict,
            ranking: inspection
                .ranking
                .by_part()
                .filter_map(|entry| {
                    Some(RankBlock {
                        part: entry.part.clone(),
                        score: inspection.ranking.score_of(entry)?,
                    })
                })
                .take(NUM_RANKED)
                .collect(),
            timings_ms: TimingsLine::of(&inspection.timings),
            recipe: subject.recipe.into(),
            library: LibraryBlock {
                identity: subject.library_identity.to_owned(),
                num_references: subject.num_references,
            },
        }
    }

    /// Adds what really hung there, if a person reported the acceptance as wrong: a part, `not_enrolled` or `nothing`.
    #[must_use]
    pub fn reported_as(mut self, actual: Option<&str>) -> Self {
        self.verdict.reported_as = actual.map(str::to_owned);
        self
    }

    /// Returns the report as indented JSON with a final line end.
    pub fn to_json(&self) -> String {
        let mut json =
            serde_json::to_string_pretty(self).expect("numbers and text have a JSON form");
        json.push('\n');
        json
    }

    /// Returns the JSON schema of [`Self::to_json`] with a final line end. `assets/pose-report.schema.json` is a copy.
    pub fn json_schema() -> String {
        let schema = schemars::schema_for!(Self);
        let mut json = serde_json::to_string_pretty(&schema).expect("a schema is JSON");
        json.push('\n');
        json
    }
}

impl VerdictBlock {
    fn of(inspection: &Inspection, recipe: &Recipe) -> Self {
        let verdict = &inspection.verdict;
        let guess = verdict.guess().map(str::to_owned);
        let is_unknown = verdict.is_unknown();
        let (reason, advice) = verdict.complaint().map(<(_, _)>::from).unzip();
        Self {
            identification: verdict.identification(),
            status: status_of(verdict),
            part: guess.clone().filter(|_| !is_unknown),
            nearest: guess.filter(|_| is_unknown),
            accepted: verdict.is_accepted(),
            score: verdict.score().map(|[score, _]| score),
            threshold: recipe.accept.min_score,
            margin: verdict.score().map(|[_, margin]| margin),
            reason,
            advice,
            approximate: verdict.is_approximate(),
            touches_edge: inspection.touches_edge(),
            reported_as: None,
        }
    }
}

#[cfg(test)]
mod tests;
