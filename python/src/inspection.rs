//! Inspections: which enrolled part hangs in a scene, and where.

use std::{
    collections::BTreeMap,
    path::{Path, PathBuf},
    sync::Arc,
};

use numpy::{PyArray1, PyArray2, PyArrayDyn, PyArrayMethods as _, ndarray::IxDyn};
use partsight::{
    PointLabel, PoseEstimate, RigidTransform, SceneCloud,
    history::Traceability,
    pipeline::{Cancelled, Expected, NamedRecipe, run_all},
    rack::RackFile,
    report::InspectionLine,
    run,
};
use pyo3::{exceptions::PyKeyboardInterrupt, prelude::*};
use station::{Doubt, Inspected, Subject};

use crate::{
    arrays::{matrix_of, points_of, shape_of},
    error::advised,
    interrupt::SignalWatch,
    library::Library,
    recipe::Recipe,
    scene::Scene,
};

/// The result of an inspection. Rely on it only if the part is accepted.
#[pyclass(frozen, module = "partsight")]
pub(crate) struct Inspection {
    subject: Subject,
    scene: Arc<SceneCloud>,
    recipe: NamedRecipe,
    found: partsight::Inspection,
    /// True if the named part was enrolled without a camera.
    is_part_simulated: bool,
    /// Names of the rack's places at which nothing of the frame hangs.
    #[pyo3(get)]
    empty_places: Vec<String>,
}

/// Inspects a scene: which enrolled part hangs there, and where.
///
/// Without a recipe, the library's is used. The same scene, library and recipe give the same result, to the bit, on
/// any number of threads. Ctrl-C stops it between two stages.
#[pyfunction]
#[pyo3(signature = (scene, library, recipe = None))]
pub(crate) fn inspect(
    py: Python<'_>,
    scene: &Scene,
    library: &Library,
    recipe: Option<&Recipe>,
) -> PyResult<Inspection> {
    let recipe = library.recipe_or(recipe)?;
    let found = interruptible(py, |watch| {
        run(&scene.capture, &library.loaded().library, recipe, watch)
    })?;
    Ok(Inspection::new(scene, library, recipe, found))
}

/// Inspects a scene in which several parts may hang: every part, accepted ones first, from left to right in the picture, and
/// whatever else is neither background nor part.
///
/// The recipe's `segment.max_parts` says how many may hang there. `rack` is the path of a rack file or its text, in the
/// camera's frame: the accepted parts are then in the order of its places. `expected` has the names of the parts that should
/// hang there, or `place=name` for a part at a place of the rack; without it, those count that the recipe expects. A part that is not expected is refused as `wrong_part`,
/// `expected_elsewhere` or `not_expected`. Otherwise as `inspect`, whose result is the first of a single part.
#[pyfunction]
#[pyo3(signature = (scene, library, recipe = None, *, expected = None, rack = None))]
pub(crate) fn inspect_all(
    py: Python<'_>,
    scene: &Scene,
    library: &Library,
    recipe: Option<&Recipe>,
    expected: Option<Vec<String>>,
    rack: Option<PathBuf>,
) -> PyResult<Vec<Inspection>> {
    let loaded = library.loaded();
    let rack = rack.map(|rack| {
        let file = match rack.to_str() {
            // No file's name has line ends.
            Some(text) if text.contains('\n') => RackFile::parse(Path::new("rack"), text),
            _ => RackFile::read(&rack),
        };
        file?.for_library(&loaded.library, None)
    });
    let rack = rack.transpose().map_err(advised)?.unwrap_or_default();
    let parts = expected.iter().flatten().map(|text| text.as_str().into());
    let expected = Expected::new(parts.collect(), Some(&rack), |name| {
        loaded.library.has_part(name)
    });
    let given = expected.map_err(advised)?;
    let recipe = library.recipe_or(recipe)?;
    let expected = recipe.expected_or_own(given, Some(&rack), |name| loaded.library.has_part(name));
    let expected = expected.map_err(advised)?;
    let recipe = recipe.in_rack(rack).expecting(expected);
    let found = interruptible(py, |watch| {
        run_all(&scene.capture, &loaded.library, &recipe, watch)
    })?;
    let empty_places = recipe.empty_places(&found.iter().collect::<Vec<_>>());
    let empty_places: Vec<String> = empty_places.into_iter().map(str::to_owned).collect();
    let all = found.into_iter().map(|found| Inspection {
        empty_places: empty_places.clone(),
        ..Inspection::new(scene, library, &recipe, found)
    });
    Ok(all.collect())
}

/// Inspects without the interpreter's lock, until Ctrl-C.
fn interruptible<T: Send>(
    py: Python<'_>,
    inspect: impl FnOnce(&SignalWatch) -> Result<T, Cancelled> + Send,
) -> PyResult<T> {
    py.detach(|| {
        let watch = SignalWatch::new();
        inspect(&watch).map_err(|cancelled| {
            let raised = watch.into_raised();
            raised.unwrap_or_else(|| PyKeyboardInterrupt::new_err(cancelled.to_string()))
        })
    })
}

impl Inspection {
    fn new(
        scene: &Scene,
        library: &Library,
        recipe: &NamedRecipe,
        found: partsight::Inspection,
    ) -> Self {
        let verdict = &found.verdict;
        let named = verdict.guess().filter(|_| !verdict.is_unknown());
        let best = found.ranking.entries.first();
        let loaded = library.loaded();
        let part = best.and_then(|best| loaded.parts.get(best.reference));
        Self {
            subject: scene.subject(),
            scene: scene.capture.clone(),
            recipe: recipe.clone(),
            is_part_simulated: named.and(part).is_some_and(|part| part.simulated),
            found,
            empty_places: Vec::new(),
        }
    }
}

#[pymethods]
impl Inspection {
    /// True if the part was named and accepted, so that it may be relied on.
    #[getter]
    fn accepted(&self) -> bool {
        self.found.verdict.is_accepted()
    }

    /// `ok`, a part of the library; `unknown`, something else; or `no_part`.
    #[getter]
    fn status(&self) -> &'static str {
        InspectionLine::of(&self.subject.scene, &self.found).status()
    }

    /// The best guess, accepted or not; `None` unless the status is `ok`.
    #[getter]
    fn part(&self) -> Option<&str> {
        let verdict = &self.found.verdict;
        verdict.guess().filter(|_| !verdict.is_unknown())
    }

    /// Probability that the best match is there, at its pose, 0..1.
    #[getter]
    fn score(&self) -> Option<f64> {
        self.found.verdict.score().map(|[score, _]| score)
    }

    /// Its lead over the next part, 0..1.
    #[getter]
    fn margin(&self) -> Option<f64> {
        self.found.verdict.score().map(|[_, margin]| margin)
    }

    /// Why it is not accepted, in words; `None` if it is.
    #[getter]
    fn reason(&self) -> Option<String> {
        self.found.verdict.complaint().map(|[why, _]| why)
    }

    /// The reason as a word for programs, such as `low_score`; docs/guide/files.md lists them.
    #[getter]
    fn reason_kind(&self) -> Option<String> {
        let refusal = self.found.verdict.refusal();
        refusal.map(|refusal| refusal.kind().to_string())
    }

    /// What to do about it, in words; `None` if it is accepted.
    #[getter]
    fn advice(&self) -> Option<String> {
        self.found.verdict.complaint().map(|[_, what]| what)
    }

    /// Why a robot must not act on the pose, as words for programs, such as `old`; docs/guide/files.md lists them. Empty if it
    /// may, as far as is known without the cell's calibration.
    #[getter]
    fn robot_doubts(&self) -> Vec<&'static str> {
        let doubts = self.recorded().doubts_if_calibrated();
        doubts.iter().map(Doubt::kind).collect()
    }

    /// Name of the rack's place where it hangs; `None` if it hangs at none, or there is no rack.
    #[getter]
    fn place(&self) -> Option<&str> {
        self.found.place.as_deref()
    }

    /// True if the segmented part reaches the edge of the picture, so that some of it may be missing.
    #[getter]
    fn touches_edge(&self) -> bool {
        self.found.touches_edge()
    }

    /// True if the scene, or the named part when it was enrolled, does not come from a camera: no robot may move by
    /// it.
    #[getter]
    fn is_simulated(&self) -> bool {
        self.scene.cloud.is_simulated || self.is_part_simulated
    }

    /// The pose of the part ranked first, accepted or not; `None` if there is none.
    #[getter]
    fn pose(&self) -> Option<Pose> {
        let pose = self.found.found_pose()?;
        let reference = self.found.reference().map(str::to_owned);
        let is_approximate = self.found.verdict.is_approximate();
        Some(Pose::of(pose, reference, is_approximate))
    }

    /// The points that were inspected, as `Scene.points`: a new array each time.
    #[getter]
    fn cloud<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f32>>> {
        points_of(py, &self.scene.cloud)
    }

    /// The label of each point of `cloud`, a value of `Segment` as uint8, of the shape (H, W) or (N,): a new array
    /// each time. The background planes are `Segment.BACKGROUND` and above.
    #[getter]
    fn segments<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<u8>>> {
        let labels = self.found.segmentation.labels.iter();
        let values = labels.map(|label| match label {
            PointLabel::NoReading => 0,
            PointLabel::Rest => 1,
            PointLabel::Part => 2,
            PointLabel::Background(plane) => plane.saturating_add(3),
        });
        let shape = shape_of(&self.scene.cloud);
        PyArray1::from_vec(py, values.collect()).reshape(IxDyn(&shape))
    }

    /// Time that each stage took, and the `total`, in milliseconds.
    #[getter]
    fn timings_ms(&self) -> BTreeMap<&'static str, f64> {
        let timings = &self.found.timings;
        let stages = [
            ("segment", timings.segment),
            ("project", timings.project),
            ("contour", timings.contour),
            ("signature", timings.signature),
            ("rank", timings.rank),
            ("pose", timings.pose),
            ("total", timings.total),
        ];
        let in_ms = |(stage, took): (_, std::time::Duration)| (stage, took.as_secs_f64() * 1e3);
        stages.map(in_ms).into()
    }

    /// The JSON line that `partsight inspect --json` writes for the same file, including the ranking.
    fn to_json(&self) -> String {
        self.recorded().line(&Traceability::default())
    }

    fn __repr__(&self) -> String {
        let verdict = &self.found.verdict;
        let part = verdict.identification();
        let part = part.in_english(verdict.guess().unwrap_or_default());
        let not = if self.accepted() { "" } else { "not " };
        format!(
            "<Inspection {:?}: {part}, {not}accepted>",
            self.subject.scene
        )
    }
}

impl Inspection {
    fn recorded(&self) -> Inspected<'_> {
        Inspected {
            subject: &self.subject,
            scene: &self.scene,
            inspection: &self.found,
            recipe: &self.recipe,
            robot: None,
            is_forced: false,
            on_line: None,
        }
    }
}

/// The pose of the part and its uncertainty. Names and units are those of the JSON line.
#[pyclass(frozen, module = "partsight")]
pub(crate) struct Pose {
    camera_from_part: RigidTransform,
    /// The reference whose coordinates define part space.
    #[pyo3(get)]
    reference: Option<String>,
    /// How it was found: `global`, `icp` or `icp-ga`.
    #[pyo3(get)]
    method: &'static str,
    /// Root mean square distance of the closest points, metres.
    #[pyo3(get)]
    rms_m: f64,
    /// Share of the points seen that lie on the reference, 0..1.
    #[pyo3(get)]
    overlap: f64,
    /// The part's middle is within this distance of the truth in 95 of 100 cases, metres; `None` if it is
    /// unconstrained.
    #[pyo3(get)]
    shift_bound_m: Option<f64>,
    /// The part's rotation is within this angle of the truth in 95 of 100 cases, radians.
    #[pyo3(get)]
    turn_bound_rad: Option<f64>,
    /// How the part could move and still fit; `None` if the pose is constrained.
    #[pyo3(get)]
    unconstrained: Option<String>,
    /// Why the search ended: `converged`, `below_target`, `iteration_limit` or `no_progress`.
    #[pyo3(get)]
    stopped: &'static str,
    /// True if another pose fits nearly as well.
    #[pyo3(get)]
    ambiguous: bool,
    /// True if it may be another model of the part, so that the pose is only approximate.
    #[pyo3(get)]
    approximate: bool,
    /// Size of the part divided by that of its reference, if it is certainly another: the camera's numbers are probably wrong.
    #[pyo3(get)]
    off_scale: Option<f64>,
}

impl Pose {
    fn of(pose: &PoseEstimate, reference: Option<String>, is_approximate: bool) -> Self {
        let held = pose.bounds();
        let freedom = pose.uncertainty.and_then(|bounds| bounds.freedom);
        Self {
            camera_from_part: pose.camera_from_part(),
            reference,
            method: pose.method.name(),
            rms_m: pose.fit.rms_m,
            overlap: pose.fit.overlap,
            shift_bound_m: held.map(|bounds| bounds.shift.0),
            turn_bound_rad: held.map(|bounds| bounds.turn.0),
            unconstrained: freedom.map(|freedom| freedom.to_string()),
            stopped: pose.stopped.name(),
            ambiguous: pose.is_ambiguous(),
            approximate: is_approximate,
            off_scale: pose.off_scale().map(|off| off.scale()),
        }
    }
}

#[pymethods]
impl Pose {
    /// Transform from part space to camera space, 4×4, metres: a new array each time.
    #[getter]
    fn camera_from_part<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        matrix_of(py, &self.camera_from_part)
    }
}
