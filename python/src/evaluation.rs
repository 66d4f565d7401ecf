//! Packs kept cases into rows, judges them row by row, and reports on all results: the steps of `partsight evaluate`,
//! to share between several computers.

use std::{
    path::{Path, PathBuf},
    time::Duration,
};

use partsight::{
    Inspection, Metres, Radians, SceneCloud, Timings,
    cases::{
        CaseError, CaseFolder, CaseJudge, CaseList, CaseResult, FoundVerdict, KeptCase, PackedCase,
        RecipeRecord, SCHEMA_VERSION, Truth,
    },
    files::FileError,
    geometry::rigid::{PoseDelta, row_major},
    report::EvaluationReport,
    run,
    stages::pose::PoseEstimate,
};
use pyo3::{
    exceptions::{PyIndexError, PyKeyboardInterrupt, PyValueError},
    prelude::*,
    pybacked::PyBackedBytes,
};

use crate::{
    error::{advised, refused, warn},
    interrupt::SignalWatch,
    library::Library,
    recipe::Recipe,
};

/// The cases in a folder: first those that cannot be read, then the others by name.
#[pyclass(frozen, module = "partsight")]
pub(crate) struct KeptCases {
    folder: CaseFolder,
    list: CaseList,
}

/// A case as a row. One that cannot be read has `damage` or `newer_schema` and no content.
#[derive(Default, IntoPyObject)]
struct KeptRow {
    case: String,
    truth: Option<&'static str>,
    truth_part: Option<String>,
    difficulty: Option<String>,
    case_toml: Option<String>,
    scene_file: Option<String>,
    scene: Option<Vec<u8>>,
    empty_cell: Option<Vec<u8>>,
    damage: Option<String>,
    newer_schema: Option<u32>,
}

/// The columns of a [`KeptRow`] that an inspection needs.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct PackedRow {
    case: String,
    case_toml: Option<String>,
    scene: Option<PyBackedBytes>,
    empty_cell: Option<PyBackedBytes>,
    damage: Option<String>,
    newer_schema: Option<u32>,
}

/// The result of a case. One that cannot be read has `damage` or `newer_schema` and nothing else.
#[derive(Default, FromPyObject, IntoPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct ResultRow {
    case: String,
    difficulty: Option<String>,
    truth: Option<String>,
    truth_part: Option<String>,
    judgement: Option<String>,
    part: Option<String>,
    score: Option<f64>,
    margin: Option<f64>,
    accepted: Option<bool>,
    reason: Option<String>,
    reason_kind: Option<String>,
    rotation_error_rad: Option<f64>,
    shift_error_m: Option<f64>,
    /// 4×4 matrix, row by row.
    camera_from_part: Option<[f64; 16]>,
    reference: Option<String>,
    rms_m: Option<f64>,
    overlap: Option<f64>,
    shift_bound_m: Option<f64>,
    turn_bound_rad: Option<f64>,
    damage: Option<String>,
    newer_schema: Option<u32>,
    times: Option<TimesRow>,
}

/// Time that each stage took, nanoseconds.
#[derive(FromPyObject, IntoPyObject)]
#[pyo3(from_item_all)]
struct TimesRow {
    segment: u64,
    project: u64,
    contour: u64,
    signature: u64,
    rank: u64,
    pose: u64,
    total: u64,
}

fn kind_of(truth: &Truth) -> &'static str {
    match truth {
        Truth::Part(_) => "part",
        Truth::NotEnrolled => "not_enrolled",
        Truth::Nothing => "nothing",
    }
}

/// The name, damage and newer schema of a case that cannot be read.
fn columns_of(problem: &CaseError) -> (String, Option<String>, Option<u32>) {
    match problem {
        CaseError::Damaged { name, what } => (name.clone(), Some(what.clone()), None),
        CaseError::File(FileError::Newer { path, found, .. }) => {
            let name = path.parent().map(|case| case.display().to_string());
            (name.unwrap_or_default(), None, Some(*found))
        }
        CaseError::NoSuchCase { name, .. } => (name.clone(), Some(problem.to_string()), None),
        // The other errors concern a whole folder.
        other => (String::new(), Some(other.to_string()), None),
    }
}

/// The reverse of [`columns_of`]; `None` for a case that was read.
fn problem_of(name: &str, damage: Option<&str>, newer: Option<u32>) -> Option<CaseError> {
    let name = name.to_owned();
    match (damage, newer) {
        (_, Some(found)) => {
            let newer = FileError::Newer {
                path: Path::new(&name).join("case.toml"),
                found,
                known: SCHEMA_VERSION,
            };
            Some(newer.into())
        }
        (Some(what), None) => Some(CaseError::Damaged {
            name,
            what: what.to_owned(),
        }),
        (None, None) => None,
    }
}

impl From<&CaseError> for KeptRow {
    fn from(problem: &CaseError) -> Self {
        let (case, damage, newer_schema) = columns_of(problem);
        Self {
            case,
            damage,
            newer_schema,
            ..Self::default()
        }
    }
}

impl From<&CaseError> for ResultRow {
    fn from(problem: &CaseError) -> Self {
        let (case, damage, newer_schema) = columns_of(problem);
        Self {
            case,
            damage,
            newer_schema,
            ..Self::default()
        }
    }
}

#[pymethods]
impl KeptCases {
    /// Lists the cases in a folder.
    #[new]
    fn new(py: Python<'_>, folder: PathBuf) -> PyResult<Self> {
        let folder = CaseFolder::at(folder);
        let list = py.detach(|| folder.list()).map_err(advised)?;
        if list.cases.is_empty() && list.problems.is_empty() {
            return Err(refused(
                format!("{}: there are no cases", folder.path().display()),
                "Keep some in the window's Compare, or make some: partsight simulate --cases DIR",
            ));
        }
        Ok(Self { folder, list })
    }

    fn __len__(&self) -> usize {
        self.list.problems.len() + self.list.cases.len()
    }

    /// The case of this number in the list as a row, with everything that an inspection needs.
    fn row(&self, py: Python<'_>, number: usize) -> PyResult<KeptRow> {
        if let Some(problem) = self.list.problems.get(number) {
            return Ok(problem.into());
        }
        let place = number.checked_sub(self.list.problems.len());
        let case = place.and_then(|place| self.list.cases.get(place));
        let case = case.ok_or_else(|| PyIndexError::new_err(format!("no case {number}")))?;
        let packed = match py.detach(|| self.folder.pack(case)) {
            Ok(packed) => packed,
            Err(problem) => return Ok((&problem).into()),
        };
        let about = &case.meta.about;
        Ok(KeptRow {
            case: packed.name,
            truth: Some(kind_of(&about.truth)),
            truth_part: about.truth.part().map(str::to_owned),
            difficulty: about.difficulty.clone(),
            case_toml: Some(packed.case_toml),
            scene_file: Some(case.meta.scene.file.clone()),
            scene: Some(packed.scene),
            empty_cell: packed.empty_cell,
            damage: None,
            newer_schema: None,
        })
    }
}

/// Inspects packed cases and compares the verdicts with their truth. Returns a result per row, in the same order.
///
/// Without a recipe, the library's is used. Ctrl-C stops it between two stages.
#[pyfunction]
#[pyo3(signature = (rows, library, recipe = None))]
pub(crate) fn judge_cases(
    py: Python<'_>,
    rows: Vec<PackedRow>,
    library: &Library,
    recipe: Option<&Recipe>,
) -> PyResult<Vec<ResultRow>> {
    let recipe = library.recipe_or(recipe)?;
    let loaded = library.loaded();
    py.detach(|| {
        let judge = CaseJudge::new(&loaded.library, recipe);
        let watch = SignalWatch::new();
        let mut results = Vec::with_capacity(rows.len());
        for row in rows {
            let (case, scene) = match unpack(row) {
                Ok(unpacked) => unpacked,
                Err(problem) => {
                    results.push(ResultRow::from(&problem));
                    continue;
                }
            };
            let Ok(inspection) = run(&scene, &loaded.library, recipe, &watch) else {
                let raised = watch.into_raised();
                return Err(raised.unwrap_or_else(|| PyKeyboardInterrupt::new_err("cancelled")));
            };
            let result = judge.compare(&case, &inspection);
            results.push(ResultRow::of(result, &inspection));
        }
        Ok(results)
    })
}

fn unpack(row: PackedRow) -> Result<(KeptCase, SceneCloud), CaseError> {
    if let Some(problem) = problem_of(&row.case, row.damage.as_deref(), row.newer_schema) {
        return Err(problem);
    }
    let bytes = |bytes: PyBackedBytes| bytes.to_vec();
    let packed = PackedCase {
        name: row.case,
        case_toml: row.case_toml.unwrap_or_default(),
        scene: row.scene.map(bytes).unwrap_or_default(),
        empty_cell: row.empty_cell.map(bytes),
    };
    packed.unpack()
}

impl ResultRow {
    fn of(result: CaseResult, inspection: &Inspection) -> Self {
        let judgement = result.judgement().to_string();
        let CaseResult {
            name,
            difficulty,
            truth,
            found,
            pose_error,
            timings,
        } = result;
        let pose = inspection.found_pose();
        let bounds = pose.and_then(PoseEstimate::bounds);
        let refusal = inspection.verdict.refusal();
        Self {
            case: name,
            difficulty,
            truth: Some(kind_of(&truth).to_owned()),
            truth_part: truth.part().map(str::to_owned),
            judgement: Some(judgement),
            part: found.part,
            score: found.score,
            margin: found.margin,
            accepted: Some(found.accepted),
            reason: found.reason,
            reason_kind: refusal.map(|refusal| refusal.kind().to_string()),
            rotation_error_rad: pose_error.map(|error| error.rotation.0),
            shift_error_m: pose_error.map(|error| error.shift.0),
            camera_from_part: pose.map(|pose| row_major(&pose.camera_from_part())),
            reference: pose.and_then(|_| inspection.reference()).map(str::to_owned),
            rms_m: pose.map(|pose| pose.fit.rms_m),
            overlap: pose.map(|pose| pose.fit.overlap),
            shift_bound_m: bounds.map(|bounds| bounds.shift.0),
            turn_bound_rad: bounds.map(|bounds| bounds.turn.0),
            damage: None,
            newer_schema: None,
            times: Some(TimesRow::from(timings)),
        }
    }

    /// Converts the row back to the result of the evaluation.
    fn into_result(self) -> PyResult<Result<CaseResult, CaseError>> {
        if let Some(problem) = problem_of(&self.case, self.damage.as_deref(), self.newer_schema) {
            return Ok(Err(problem));
        }
        let incomplete =
            || PyValueError::new_err(format!("the result of {} is incomplete", self.case));
        let truth = match (self.truth.as_deref(), &self.truth_part) {
            (Some("part"), Some(part)) => Truth::Part(part.clone()),
            (Some("not_enrolled"), _) => Truth::NotEnrolled,
            (Some("nothing"), _) => Truth::Nothing,
            _ => return Err(incomplete()),
        };
        let pose_error = match (self.rotation_error_rad, self.shift_error_m) {
            (Some(rotation), Some(shift)) => Some(PoseDelta {
                rotation: Radians(rotation),
                shift: Metres(shift),
            }),
            _ => None,
        };
        let accepted = self.accepted.ok_or_else(incomplete)?;
        let timings = self.times.as_ref().ok_or_else(incomplete)?.into();
        Ok(Ok(CaseResult {
            name: self.case,
            difficulty: self.difficulty,
            truth,
            found: FoundVerdict {
                part: self.part,
                score: self.score,
                margin: self.margin,
                accepted,
                reason: self.reason,
            },
            pose_error,
            timings,
        }))
    }
}

impl From<Timings> for TimesRow {
    fn from(timings: Timings) -> Self {
        let ns = |took: Duration| u64::try_from(took.as_nanos()).unwrap_or(u64::MAX);
        Self {
            segment: ns(timings.segment),
            project: ns(timings.project),
            contour: ns(timings.contour),
            signature: ns(timings.signature),
            rank: ns(timings.rank),
            pose: ns(timings.pose),
            total: ns(timings.total),
        }
    }
}

impl From<&TimesRow> for Timings {
    fn from(row: &TimesRow) -> Self {
        Self {
            segment: Duration::from_nanos(row.segment),
            project: Duration::from_nanos(row.project),
            contour: Duration::from_nanos(row.contour),
            signature: Duration::from_nanos(row.signature),
            rank: Duration::from_nanos(row.rank),
            pose: Duration::from_nanos(row.pose),
            total: Duration::from_nanos(row.total),
        }
    }
}

/// Reports on results in the order of their cases, as `(json, text)`: the output of `partsight evaluate` with
/// `--json` and without. Each case that could not be read raises a `UserWarning`.
#[pyfunction]
#[pyo3(signature = (results, library, recipe = None, *, num_threads = 1))]
pub(crate) fn evaluation_report(
    py: Python<'_>,
    results: Vec<ResultRow>,
    library: &Library,
    recipe: Option<&Recipe>,
    num_threads: usize,
) -> PyResult<(String, String)> {
    let recipe = library.recipe_or(recipe)?;
    let loaded = library.loaded();
    let (mut judged, mut problems) = (Vec::new(), Vec::new());
    for row in results {
        match row.into_result()? {
            Ok(result) => judged.push(result),
            Err(problem) => problems.push(problem),
        }
    }
    for problem in &problems {
        warn(py, problem)?;
    }
    py.detach(|| {
        let evaluation = CaseJudge::new(&loaded.library, recipe).summarise(judged, problems);
        let described = RecipeRecord::of(recipe);
        let report = EvaluationReport::of(&evaluation, &described, num_threads);
        let json = serde_json::to_string_pretty(&report.record());
        let json = json.map_err(|error| PyValueError::new_err(error.to_string()))?;
        Ok((json + "\n", report.lines().join("\n")))
    })
}
