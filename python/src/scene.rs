//! Scenes: from a file, from arrays or simulated.

use std::{path::PathBuf, sync::Arc, time::SystemTime};

use numpy::{PyArray1, PyArray2, PyArrayDyn, PyArrayMethods as _};
use partsight::{
    CellSetup, DepthFrame, Distortion, Image, Intrinsics, PartKind, PointCloud, SceneCloud, Side,
    files::written_at, read_image, scene_from_image, simulated_frame,
};
use pyo3::{prelude::*, types::PyAny};
use station::Subject;

use crate::{
    arrays::{Depths, NO_POINT, cloud_of, depths_of, matrix_of, points_of},
    error::{advised, refused, warn_about},
};

/// The points that a depth camera saw, in camera space, x right, y down, z forward, in metres.
#[pyclass(frozen, module = "partsight")]
pub(crate) struct Scene {
    pub(crate) name: String,
    pub(crate) capture: Arc<SceneCloud>,
    /// When it was captured: a file when it was written, anything else when it became a scene.
    captured_at: SystemTime,
}

impl Scene {
    fn new(name: String, scene: SceneCloud) -> Self {
        Self {
            name,
            capture: Arc::new(scene),
            captured_at: SystemTime::now(),
        }
    }

    /// What is inspected, as of now.
    pub(crate) fn subject(&self) -> Subject {
        let is_simulated = self.capture.cloud.is_simulated;
        Subject::of_scene(self.name.clone(), "file".into(), is_simulated)
            .captured_at(self.captured_at)
    }
}

#[pymethods]
impl Scene {
    /// Reads a capture: PCD, PLY, XYZ or CSV text, or a depth PNG with its camera beside it.
    ///
    /// Clouds are in metres; `scan.ply#units=mm#up=z` reads one in millimetres whose z points up. Anything odd about
    /// a file raises a `UserWarning`. A file without readings, as from a covered camera, gives an empty scene.
    #[staticmethod]
    fn open(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        let name = path.display().to_string();
        let (scene, warnings) = py
            .detach(|| {
                read_image(&path).map(|(image, warnings)| (scene_from_image(image), warnings))
            })
            .map_err(advised)?;
        for warning in &warnings {
            let advice = partsight::Advice::advice(warning);
            warn_about(py, format_args!("{name}: {warning}"), &advice)?;
        }
        Ok(Self {
            captured_at: written_at(&path).unwrap_or(SystemTime::UNIX_EPOCH),
            ..Self::new(name, scene)
        })
    }

    /// Makes a scene from a depth image of the shape (H, W).
    ///
    /// Depths are along the optical axis, in units of `metres_per_unit`; 0 is no reading, nor is a negative or
    /// non-finite float. `fx`, `fy`, `cx` and `cy` are in pixels, with pixel centres at whole numbers; the image must
    /// have no lens distortion. Numbers that no depth camera has raise a `UserWarning`. Set `is_simulated` if the depths
    /// do not come from a camera.
    #[staticmethod]
    #[pyo3(signature = (depth, fx, fy, cx, cy, metres_per_unit, *, name = "array", is_simulated = false))]
    #[expect(clippy::too_many_arguments, reason = "the numbers of a camera")]
    fn from_depth(
        py: Python<'_>,
        depth: &Bound<'_, PyAny>,
        fx: f64,
        fy: f64,
        cx: f64,
        cy: f64,
        metres_per_unit: f64,
        name: &str,
        is_simulated: bool,
    ) -> PyResult<Self> {
        for (value, what) in [(fx, "fx"), (fy, "fy"), (metres_per_unit, "metres_per_unit")] {
            if !(value.is_finite() && value > 0.0) {
                let message = format!("{what} is {value}, not a number above 0");
                return Err(refused(message, "Take it from the camera's calibration"));
            }
        }
        if !(cx.is_finite() && cy.is_finite()) {
            let message = format!("the principal point is {cx}, {cy}");
            return Err(refused(message, "Take it from the camera's calibration"));
        }
        let (depths, grid) = depths_of(depth)?;
        let intrinsics = Intrinsics {
            width: grid.width,
            height: grid.height,
            fx,
            fy,
            cx,
            cy,
            distortion: Distortion::NONE,
        };
        warn_of_camera(py, name, &intrinsics)?;
        let scene = py.detach(|| match depths {
            Depths::Units(depth) => scene_from_image(Image::Depth(DepthFrame {
                intrinsics,
                metres_per_unit,
                depth,
                is_simulated,
            })),
            Depths::Floats(depth) => {
                scene_of_floats(&depth, intrinsics, metres_per_unit, is_simulated)
            }
        });
        Ok(Self::new(name.to_owned(), scene))
    }

    /// Makes a scene from points in camera space, metres, of the shape (N, 3), or (H, W, 3) with the camera's rows
    /// and columns.
    ///
    /// Give rows and columns if they are known: without them the points are projected back into a picture, if a
    /// camera at the origin can have seen them all. Points that are not finite are no readings. Rows and columns of a
    /// camera that cannot be raise a `UserWarning`. Set `is_simulated` if the points do not come from a camera.
    #[staticmethod]
    #[pyo3(signature = (points, *, name = "array", is_simulated = false))]
    fn from_points(
        py: Python<'_>,
        points: &Bound<'_, PyAny>,
        name: &str,
        is_simulated: bool,
    ) -> PyResult<Self> {
        let cloud = PointCloud {
            is_simulated,
            ..cloud_of(points)?
        };
        let is_organised = cloud.grid.is_some();
        let scene = py.detach(|| scene_from_image(Image::Cloud(cloud)));
        if let Some(camera) = scene.intrinsics.filter(|_| is_organised) {
            warn_of_camera(py, name, &camera)?;
        }
        Ok(Self::new(name.to_owned(), scene))
    }

    /// Name of the file or array; the `scene` of the JSON line.
    #[getter]
    fn name(&self) -> &str {
        &self.name
    }

    /// The points in metres, float32, of the shape (H, W, 3), NaN without a reading, or (N, 3): a new array each time.
    ///
    /// They are fewer than the pixels of an image that is finer than the method needs.
    #[getter]
    fn points<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f32>>> {
        points_of(py, &self.capture.cloud)
    }

    /// `(fx, fy, cx, cy)` of the camera, in pixels of `points`; `None` if no camera is known.
    #[getter]
    fn intrinsics(&self) -> Option<(f64, f64, f64, f64)> {
        self.capture.intrinsics.map(four_numbers)
    }

    /// True if it does not come from a camera.
    #[getter]
    fn is_simulated(&self) -> bool {
        self.capture.cloud.is_simulated
    }

    fn __repr__(&self) -> String {
        let num_readings = self.capture.cloud.num_finite();
        format!("<Scene {:?}, {num_readings} readings>", self.name)
    }
}

/// Issues a `UserWarning` about a camera whose numbers are probably wrong.
fn warn_of_camera(py: Python<'_>, name: &str, camera: &Intrinsics) -> PyResult<()> {
    camera.doubt().map_or(Ok(()), |doubt| {
        let advice = partsight::Advice::advice(&doubt);
        warn_about(py, format_args!("{name}: {doubt}"), &advice)
    })
}

fn four_numbers(camera: Intrinsics) -> (f64, f64, f64, f64) {
    (camera.fx, camera.fy, camera.cx, camera.cy)
}

/// Converts the depths to points on the camera's rays, because a depth frame holds whole units only.
fn scene_of_floats(
    depth: &[f32],
    camera: Intrinsics,
    metres_per_unit: f64,
    is_simulated: bool,
) -> SceneCloud {
    let point = |(i, depth): (usize, &f32)| {
        let z = f64::from(*depth) * metres_per_unit;
        let (u, v) = ((i % camera.width) as f64, (i / camera.width) as f64);
        let point = camera.point_at(u, v, z).cast::<f32>();
        let is_reading = z > 0.0 && point.iter().all(|x| x.is_finite());
        if is_reading { point } else { NO_POINT }
    };
    let mut scene = scene_from_image(Image::Cloud(PointCloud {
        points: depth.iter().enumerate().map(point).collect(),
        grid: Some(partsight::Grid {
            width: camera.width,
            height: camera.height,
        }),
        is_simulated,
        ..PointCloud::default()
    }));
    if scene.cloud.grid.is_some() {
        // Replace the intrinsics fitted to the points by those that the points were made with.
        let block_side = scene.reduced.as_ref().map_or(1, |from| from.block_side);
        scene.intrinsics = Some(camera.in_blocks(block_side));
    }
    scene
}

/// A frame of the simulated cell, with the truth.
#[pyclass(frozen, module = "partsight")]
pub(crate) struct SimulatedFrame {
    frame: partsight::SimulatedFrame,
}

#[pymethods]
impl SimulatedFrame {
    /// The depths in units of `metres_per_unit`, uint16 of the shape (H, W); 0 is no reading. A new array each time.
    #[getter]
    fn depth<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<u16>>> {
        let Intrinsics { width, height, .. } = self.frame.frame.intrinsics;
        PyArray1::from_slice(py, &self.frame.frame.depth).reshape([height, width])
    }

    /// `(fx, fy, cx, cy)` in pixels.
    #[getter]
    fn intrinsics(&self) -> (f64, f64, f64, f64) {
        four_numbers(self.frame.frame.intrinsics)
    }

    /// Metres per unit of `depth`.
    #[getter]
    fn metres_per_unit(&self) -> f64 {
        self.frame.frame.metres_per_unit
    }

    /// The true transform from the simulated model's coordinates to camera space, 4×4. An enrolled part has other
    /// coordinates, those of the camera that saw it.
    #[getter]
    fn camera_from_model<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        matrix_of(py, &self.frame.truth.camera_from_part)
    }

    /// The scene of the frame.
    fn scene(&self, py: Python<'_>) -> Scene {
        let image = Image::Depth(self.frame.frame.clone());
        let scene = py.detach(|| scene_from_image(image));
        Scene::new("simulated".into(), scene)
    }
}

/// Simulates a frame of a cell: a part in front of a wall and a floor, with a Kinect's noise.
///
/// The seed determines pose, cell and noise; the same arguments give the same frame.
#[pyfunction]
#[pyo3(signature = (part = "fender", *, side = "left", seed = 1))]
pub(crate) fn simulate_frame(
    py: Python<'_>,
    part: &str,
    side: &str,
    seed: u64,
) -> PyResult<SimulatedFrame> {
    let kind = PartKind::from_name(part).ok_or_else(|| {
        let names = PartKind::ALL.map(PartKind::name).join(", ");
        refused(
            format!("there is no simulated part {part:?}"),
            &format!("Name one of {names}"),
        )
    })?;
    let side = Side::from_name(side).ok_or_else(|| {
        refused(
            format!("there is no side {side:?}"),
            "Name one of left, right",
        )
    })?;
    let setup = CellSetup::with_part(kind, side, 0, seed);
    let frame = py.detach(|| simulated_frame(&setup));
    Ok(SimulatedFrame { frame })
}
