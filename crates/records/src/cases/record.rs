//! The results of a run over all cases as JSON (schema 1), for comparison with a later run.
//!
//! ```json
//! {"schema":1,"matcher":"default","pose":"global","num_threads":1,
//!  "tally":{"total":48,"right":47,"wrong_accepted":0,"refused":1,"guessed_right":48},
//!  "by_truth":[{"truth":{"is":"part","part":"fender"},"tally":{…}}],
//!  "by_difficulty":[{"difficulty":"placed","tally":{…}}],
//!  "confusion":[{"truth":{"is":"part","part":"fender"},"accepted_as":null,"num":1}],
//!  "calibration":{"bins":[{"from":0.0,"to":0.1,"num":0,"num_right":0,"mean_score":0.0}],"expected_error":0.02},
//!  "trade_off":{"num_cases":48,"num_enrolled":40,"steps":[{"threshold":0.0,"num_wrong_accepted":8,"num_refused":0}]},
//!  "pose_errors":{"num":47,"median":{"rotation_deg":0.2,"shift_mm":1.1},"p95":{…}},
//!  "times_ms":[{"stage":"segment","median_ms":1.9,"p95_ms":2.4,"budget_ms":2.5}],
//!  "cases":[{"name":"fender_placed_1","difficulty":"placed","truth":{…},"found":{"part":"fender","score":0.97,
//!            "margin":0.4,"accepted":true},"judgement":"right","rotation_error_deg":0.2,"shift_error_mm":1.1,"total_ms":9.0}],
//!  "damaged":["the kept case door is damaged and set aside: scene.pcd: the kept frame is damaged: its checksum does not match"]}
//! ```
//!
//! `changed` lists other parameters that were not at their default. `accepted_as` is null if nothing was accepted.
//! `pose_errors` covers right guesses whose true pose is known.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::{
    calibration::Calibration,
    confusion::Tally,
    evaluation::Evaluation,
    judge::{CaseAnswer, CaseOutcome, CaseResult, FoundVerdict, Truth},
    stage_times::StageTimes,
    trade_off::TradeOff,
};
use files::{FileError, parse_json, read_bytes};
use geometry::{error::Advice, statistics::quantile};
use inspection::pipeline::{
    NamedRecipe, Recipe, RecipeBlock,
    parameters::{Parameter, changed_settings},
};

/// The schema that is written; newer ones are refused.
pub const RECORD_SCHEMA: u32 = 1;

/// A run over all cases, to be written.
#[derive(Debug, Serialize)]
pub struct EvaluationRecord<'a> {
    schema: u32,
    #[serde(flatten)]
    recipe: &'a RecipeRecord,
    num_threads: usize,
    tally: Tally,
    by_truth: Vec<TruthTally<'a>>,
    by_difficulty: Vec<DifficultyTally<'a>>,
    confusion: Vec<CellRecord<'a>>,
    calibration: &'a Calibration,
    trade_off: &'a TradeOff,
    pose_errors: PoseErrors,
    times_ms: &'a [StageTimes],
    cases: Vec<CaseRecord>,
    damaged: Vec<String>,
}

/// The recipe of a run.
#[derive(Clone, Debug, Serialize)]
pub struct RecipeRecord {
    /// Name and identity.
    pub recipe: RecipeBlock,
    /// As `--matcher` takes it.
    pub matcher: String,
    /// As `--pose` takes it.
    pub pose: String,
    /// Other parameters that were not at their default, as `NAME=VALUE`.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub changed: Vec<String>,
}

impl RecipeRecord {
    /// Describes this recipe.
    pub fn of(recipe: &NamedRecipe) -> Self {
        let keys = ["rank.matcher", "pose"];
        let parameters: &Recipe = recipe;
        let [matcher, pose] = keys.map(|key| {
            let parameter = Parameter::of_key(key).expect("a parameter of the recipe");
            parameter.text(parameters).to_lowercase()
        });
        Self {
            recipe: RecipeBlock::from(recipe),
            matcher,
            pose,
            changed: changed_settings(parameters, &keys),
        }
    }
}

#[derive(Debug, Serialize)]
struct TruthTally<'a> {
    truth: &'a Truth,
    tally: Tally,
}

#[derive(Debug, Serialize)]
struct DifficultyTally<'a> {
    difficulty: Option<&'a str>,
    tally: Tally,
}

#[derive(Debug, Serialize)]
struct CellRecord<'a> {
    truth: &'a Truth,
    accepted_as: Option<&'a str>,
    num: usize,
}

/// Pose errors over a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct PoseErrors {
    /// Number of right guesses whose true pose is known.
    pub num: usize,
    /// Medians of rotation and of shift, each on its own.
    pub median: Option<PoseOff>,
    /// 95th percentiles of rotation and of shift, each on its own.
    pub p95: Option<PoseOff>,
}

/// Error of a pose.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct PoseOff {
    /// Rotation error in degrees.
    pub rotation_deg: f64,
    /// Shift at the middle of the part, in millimetres.
    pub shift_mm: f64,
}

impl PoseErrors {
    /// Computes median and 95th percentile over these results.
    pub fn of(results: &[CaseResult]) -> Self {
        let errors: Vec<_> = results.iter().filter_map(|r| r.pose_error).collect();
        let off = |share: f64| {
            Some(PoseOff {
                rotation_deg: quantile(errors.iter().map(|e| e.rotation.degrees()), share)?,
                shift_mm: quantile(errors.iter().map(|e| e.shift.mm()), share)?,
            })
        };
        Self {
            num: errors.len(),
            median: off(0.5),
            p95: off(0.95),
        }
    }
}

/// The result of one case, as written to and read from the file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CaseRecord {
    /// Name of the case's folder.
    pub name: String,
    /// Free text by which cases are grouped.
    #[serde(default)]
    pub difficulty: Option<String>,
    /// The true label.
    pub truth: Truth,
    /// The verdict.
    pub found: FoundVerdict,
    /// Whether the answer was right.
    pub judgement: CaseOutcome,
    /// Rotation error of the pose, in degrees.
    #[serde(default)]
    pub rotation_error_deg: Option<f64>,
    /// Shift of the pose at the middle of the part, in millimetres.
    #[serde(default)]
    pub shift_error_mm: Option<f64>,
    /// Time of the inspection, in milliseconds.
    #[serde(default)]
    pub total_ms: f64,
}

impl From<&CaseResult> for CaseRecord {
    fn from(result: &CaseResult) -> Self {
        Self {
            name: result.name.clone(),
            difficulty: result.difficulty.clone(),
            truth: result.truth.clone(),
            found: result.found.clone(),
            judgement: result.judgement(),
            rotation_error_deg: result.pose_error.map(|e| e.rotation.degrees()),
            shift_error_mm: result.pose_error.map(|e| e.shift.mm()),
            total_ms: result.timings.total.as_secs_f64() * 1e3,
        }
    }
}

impl<'a> EvaluationRecord<'a> {
    /// Describes an evaluation with this recipe on `num_threads` threads.
    pub fn of(
        evaluation: &'a Evaluation,
        recipe: &'a RecipeRecord,
        num_threads: usize,
        times_ms: &'a [StageTimes],
    ) -> Self {
        let Evaluation {
            results,
            problems,
            confusion,
            by_truth,
            by_difficulty,
            calibration,
            trade_off,
        } = evaluation;
        let by_truth = by_truth.iter();
        let by_truth = by_truth.map(|(truth, tally)| TruthTally {
            truth,
            tally: *tally,
        });
        let by_difficulty = by_difficulty.iter();
        let by_difficulty = by_difficulty.map(|(difficulty, tally)| DifficultyTally {
            difficulty: difficulty.as_deref(),
            tally: *tally,
        });
        let cells = confusion.cells.iter();
        let cells = cells.map(|((truth, answered), results)| CellRecord {
            truth,
            accepted_as: match answered {
                CaseAnswer::Part(part) => Some(part),
                CaseAnswer::NotAccepted => None,
            },
            num: results.len(),
        });
        Self {
            schema: RECORD_SCHEMA,
            recipe,
            num_threads,
            tally: confusion.tally,
            by_truth: by_truth.collect(),
            by_difficulty: by_difficulty.collect(),
            confusion: cells.collect(),
            calibration,
            trade_off,
            pose_errors: PoseErrors::of(results),
            times_ms,
            cases: results.iter().map(CaseRecord::from).collect(),
            damaged: problems.iter().map(ToString::to_string).collect(),
        }
    }
}

/// The fields of an earlier run that a later one is compared with.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub struct EarlierRun {
    /// One result per case.
    pub cases: Vec<CaseRecord>,
}

/// Why a file cannot be read as an earlier run.
#[derive(Debug, thiserror::Error, Advice)]
pub enum RecordError {
    /// The file cannot be read.
    #[error(transparent)]
    #[advice(transparent)]
    File(#[from] FileError),
    /// The file is not an evaluation.
    #[error("{}: not an evaluation: {what}", path.display())]
    #[advice = "Choose a file that partsight evaluate DIR --json FILE wrote"]
    NotARecord {
        /// The file.
        path: PathBuf,
        /// The error of the JSON parser.
        what: String,
    },
}

impl EarlierRun {
    /// Reads a file that an earlier run wrote.
    pub fn read(path: &Path) -> Result<Self, RecordError> {
        parse_json(path, &read_bytes(path)?, RECORD_SCHEMA, |error| {
            RecordError::NotARecord {
                path: path.to_owned(),
                what: error.to_string(),
            }
        })
    }
}
