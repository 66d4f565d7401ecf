//! Alignment of two clouds.

use std::path::PathBuf;

use numpy::{PyArray2, PyArrayDyn};
use partsight::{
    PointCloud, PoseEstimate, PoseMethod, ProgressObserver as _, open_file,
    stages::{pose::align_with, scene::cloud_of as cloud_of_file},
};
use pyo3::{prelude::*, types::PyAny};

use crate::{
    arrays::{cloud_of, matrix_of, points_of, transform_of},
    error::{advised, refused, warn_about},
    interrupt::SignalWatch,
};

/// The result of an alignment. Do not rely on the transform if `reason` is not `None`.
#[pyclass(frozen, module = "partsight")]
pub(crate) struct Alignment {
    pose: PoseEstimate,
}

/// Aligns `source` to `target`: finds the rigid transform that takes points of the source onto the target.
///
/// Both hold points in metres, of the shape (N, 3) or (H, W, 3). `method` is `global`, which needs no start, or the
/// paper's `icp` or `icp-ga`, which start at `initial`, a 4×4 matrix, by default the identity. Ctrl-C stops it.
#[pyfunction]
#[pyo3(signature = (source, target, *, method = "global", initial = None))]
pub(crate) fn align(
    py: Python<'_>,
    source: &Bound<'_, PyAny>,
    target: &Bound<'_, PyAny>,
    method: &str,
    initial: Option<&Bound<'_, PyAny>>,
) -> PyResult<Alignment> {
    let is_meant = |known: &PoseMethod| known.name() == method;
    let Some(method) = PoseMethod::ALL.into_iter().find(is_meant) else {
        let names = PoseMethod::ALL.map(PoseMethod::name).join(", ");
        let message = format!("there is no method {method:?}");
        return Err(refused(message, &format!("Name one of {names}")));
    };
    let initial = initial.map(transform_of).transpose()?;
    // Drop the cells of an organised cloud that have no reading.
    let [source, target] =
        [cloud_of(source)?, cloud_of(target)?].map(|cloud| PointCloud::from_points(cloud.points));
    let pose = py.detach(|| {
        let watch = SignalWatch::new();
        let is_cancelled = || watch.is_cancelled();
        let aligned = align_with(&source, &target, &method.into(), initial, &is_cancelled);
        aligned.map_err(|error| watch.into_raised().unwrap_or_else(|| advised(error)))
    })?;
    Ok(Alignment { pose })
}

#[pymethods]
impl Alignment {
    /// Transform of points of the source onto the target, 4×4, metres: a new array each time.
    #[getter]
    fn target_from_source<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        matrix_of(py, &self.pose.target_from_source)
    }

    /// Root mean square distance of the closest points, metres.
    #[getter]
    fn rms_m(&self) -> f64 {
        self.pose.fit.rms_m
    }

    /// Share of the source that lies on the target, 0..1.
    #[getter]
    fn overlap(&self) -> f64 {
        self.pose.fit.overlap
    }

    /// The source's middle is within this distance of the truth in 95 of 100 cases, metres; infinite if it is
    /// unconstrained, `None` if unknown.
    #[getter]
    fn shift_bound_m(&self) -> Option<f64> {
        self.pose.uncertainty.map(|bounds| bounds.shift.0)
    }

    /// The source's rotation is within this angle of the truth in 95 of 100 cases, radians.
    #[getter]
    fn turn_bound_rad(&self) -> Option<f64> {
        self.pose.uncertainty.map(|bounds| bounds.turn.0)
    }

    /// Why the search ended: `converged`, `below_target`, `iteration_limit` or `no_progress`.
    #[getter]
    fn stopped(&self) -> &'static str {
        self.pose.stopped.name()
    }

    /// True if another pose fits nearly as well.
    #[getter]
    fn ambiguous(&self) -> bool {
        self.pose.is_ambiguous()
    }

    /// Why the result is unreliable, in words; `None` if it is reliable.
    #[getter]
    fn reason(&self) -> Option<String> {
        self.pose.doubt().map(|doubt| doubt.to_string())
    }

    /// What to do about it, in words; `None` if there is no `reason`.
    #[getter]
    fn advice(&self) -> Option<String> {
        let doubt = self.pose.doubt()?;
        Some(partsight::Advice::advice(&doubt))
    }

    fn __repr__(&self) -> String {
        let rms_mm = self.rms_m() * 1e3;
        let doubt = self
            .reason()
            .map_or(String::new(), |why| format!("; {why}"));
        format!("<Alignment {rms_mm:.2} mm rms{doubt}>")
    }
}

/// Reads the points of a file: metres, float32 of the shape (N, 3) or (H, W, 3). A mesh is sampled evenly.
#[pyfunction]
pub(crate) fn read_points(py: Python<'_>, path: PathBuf) -> PyResult<Bound<'_, PyArrayDyn<f32>>> {
    let name = path.display();
    let opened = py.detach(|| open_file(&path)).map_err(advised)?;
    for warning in opened.warnings() {
        let advice = partsight::Advice::advice(&warning);
        warn_about(py, format_args!("{name}: {warning}"), &advice)?;
    }
    let Some(cloud) = py.detach(|| cloud_of_file(opened)) else {
        let message = format!("{name}: the mesh has no area");
        return Err(refused(message, "Export the mesh again with its faces"));
    };
    points_of(py, &cloud)
}
