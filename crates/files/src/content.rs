//! What a file holds, and what is odd about it.

use nalgebra::Point3;
use thiserror::Error;

use geometry::cloud::{MAX_STRAY_SHARE, PointCloud};
use geometry::depth_frame::{CameraDoubt, DepthFrame};
use geometry::error::Advice;
use geometry::mesh::TriangleMesh;
use geometry::pinhole_fit::fit_pinhole;
use geometry::statistics::quantile;
use geometry::units::Metres;

/// The content of a file.
#[derive(Clone, Debug, PartialEq)]
pub enum FileContent {
    /// Points, in camera space unless the file uses another one. At least one is finite.
    Cloud(PointCloud),
    /// A surface with at least one triangle.
    Mesh(TriangleMesh),
    /// A depth image with its camera. At least one pixel is a reading.
    Depth(DepthFrame),
}

/// Something odd about a file that could be read all the same.
#[derive(Clone, Copy, Debug, PartialEq, Error, Advice)]
pub enum FileWarning {
    /// Taken as metres, the points span more than any spray cell.
    #[error("the points span {:.0} m, so the file may be in {}", extent.0, units_of(*extent))]
    #[advice(if extent.0 < ONLY_MILLIMETRES_M {
        "Read it in its own unit, or export it in metres"
    } else {
        "Read it as millimetres, or export it in metres"
    })]
    TooWideForMetres {
        /// The longest side of the box around the points.
        extent: Metres,
    },
    /// The points span less than any part.
    #[error("the points span only {extent}, so the file is probably in another unit")]
    #[advice = "Read it in its own unit, probably metres"]
    TooSmall {
        /// The longest side of the box around the points.
        extent: Metres,
    },
    /// The file is longer than its header announces.
    #[error("{num} bytes follow the last point, so the file is probably damaged")]
    #[advice = "Copy or export the file again from the program that made it"]
    SurplusBytes {
        /// Bytes after the last point.
        num: u64,
    },
    /// Points lie behind a camera at the origin.
    #[error("{:.1} % of the points lie behind the camera, so they are probably in another frame", share * 100.0)]
    #[advice(IN_CAMERA_FRAME)]
    BehindCamera {
        /// Share of the points, 0..1.
        share: f64,
    },
    /// Rows and columns are not the picture of a pinhole camera at the origin.
    #[error("its rows and columns are not those of an undistorted camera at the origin")]
    #[advice(IN_CAMERA_FRAME)]
    NoPinholeCamera,
    /// A mesh of faces between the pixels of a camera that does not look along z.
    #[error("the mesh is the capture of one camera, saved with faces, and not a part")]
    #[advice = "Read it with y up, so that the camera looks along z, or save it again without faces"]
    CaptureWithFaces,
    /// The camera is implausible.
    #[error(transparent)]
    #[advice(transparent)]
    Camera(#[from] CameraDoubt),
}

const IN_CAMERA_FRAME: &str = "For an inspection export the capture in the camera's own frame, x right, y down, z forward, with its distortion removed";

/// The extent that causes a warning, in metres: a part of 0.1 m in millimetres looks this wide, and no cell is.
const SUSPICIOUS_EXTENT_M: f64 = 100.0;

/// The extent, in metres, from which only millimetres make a cell of it: in centimetres it spans 10 m or more.
pub const ONLY_MILLIMETRES_M: f64 = 1000.0;

/// Returns the units in which a file with this extent may be.
fn units_of(extent: Metres) -> &'static str {
    if extent.0 < ONLY_MILLIMETRES_M {
        "millimetres, centimetres or inches"
    } else {
        "millimetres"
    }
}

/// The extent below which captures and parts get a warning, in metres: a cell of metres, read as millimetres, is smaller, and
/// no part is.
const SMALLEST_EXTENT_M: f64 = 0.1;

/// Clouds with fewer readings are no captures, and a camera cannot be fitted to a few.
const MIN_READINGS: usize = 1000;

fn warnings_of(cloud: &PointCloud) -> impl Iterator<Item = FileWarning> {
    let num = cloud.surplus_bytes;
    let surplus = (num > 0).then_some(FileWarning::SurplusBytes { num });
    // Only organised clouds are always captures; others may be in any space, for example references to be enrolled.
    let share = cloud.grid.map_or(0.0, |_| cloud.share_behind());
    let behind = (share > 0.0).then_some(FileWarning::BehindCamera { share });
    let grid = cloud
        .grid
        .filter(|_| cloud.num_finite() >= MIN_READINGS && behind.is_none());
    let camera = grid.and_then(|grid| match fit_pinhole(&cloud.points, grid) {
        Some(camera) => camera.doubt().map(FileWarning::Camera),
        None => Some(FileWarning::NoPinholeCamera),
    });
    surplus.into_iter().chain(behind).chain(camera)
}

impl FileContent {
    /// Returns true if the content is marked as simulated.
    pub fn is_simulated(&self) -> bool {
        match self {
            Self::Cloud(cloud) => cloud.is_simulated,
            Self::Depth(frame) => frame.is_simulated,
            Self::Mesh(_) => false,
        }
    }

    /// Returns what is odd about the content. The numbers themselves are never changed.
    pub fn warnings(&self) -> Vec<FileWarning> {
        let bounds = match self {
            Self::Cloud(cloud) => cloud.bounds(),
            Self::Mesh(mesh) => mesh.bounds(),
            Self::Depth(_) => None,
        };
        let extent = bounds.map_or(0.0, |(low, high)| f64::from((high - low).amax()));
        let mut warnings = Vec::new();
        if extent >= SUSPICIOUS_EXTENT_M {
            let extent = Metres(extent);
            warnings.push(FileWarning::TooWideForMetres { extent });
        }
        let has_surface = match self {
            Self::Cloud(cloud) => cloud.num_finite() >= MIN_READINGS,
            Self::Mesh(_) => true,
            Self::Depth(_) => false,
        };
        if has_surface && extent < SMALLEST_EXTENT_M {
            let extent = Metres(extent);
            warnings.push(FileWarning::TooSmall { extent });
        }
        match self {
            Self::Cloud(cloud) => warnings.extend(warnings_of(cloud)),
            Self::Depth(frame) => {
                warnings.extend(frame.intrinsics.doubt().map(FileWarning::Camera));
            }
            Self::Mesh(mesh) => {
                warnings.extend(is_capture(mesh).then_some(FileWarning::CaptureWithFaces));
            }
        }
        warnings
    }

    /// As [`warnings`](Self::warnings), for content used as a capture: unorganised clouds must be in camera space, too.
    /// [`MAX_STRAY_SHARE`] of their points may be stray.
    pub fn warnings_as_capture(&self) -> Vec<FileWarning> {
        let mut warnings = self.warnings();
        if let Self::Cloud(cloud) = self
            && cloud.grid.is_none()
        {
            let share = cloud.share_behind();
            if share > MAX_STRAY_SHARE {
                warnings.push(FileWarning::BehindCamera { share });
            }
        }
        warnings
    }
}

/// Share of the triangles of a capture that face the camera, or all away from it.
const CAPTURE_MIN_FACING: f64 = 0.98;
/// Largest ratio between the solid angles of a capture's triangles, without the tenth that is smaller and the tenth that is larger:
/// each is half a pixel.
const CAPTURE_MAX_RATIO: f64 = 4.0;

/// Returns whether a mesh is the capture of a camera at the origin, saved with faces between neighbouring pixels.
pub(super) fn is_capture(mesh: &TriangleMesh) -> bool {
    if mesh.triangles.len() < MIN_READINGS {
        return false;
    }
    let solid_angles = || {
        mesh.triangles.iter().map(|corners| {
            let [a, b, c] = corners.map(|i| mesh.vertices[i as usize].cast::<f64>());
            let middle = (a.coords + b.coords + c.coords) / 3.0;
            (b - a).cross(&(c - a)).dot(&middle) / middle.norm().powi(3)
        })
    };
    let facing = solid_angles().filter(|angle| *angle > 0.0).count() as f64;
    let facing = facing / mesh.triangles.len() as f64;
    let of = |share| quantile(solid_angles().map(f64::abs), share).unwrap_or(0.0);
    facing.max(1.0 - facing) >= CAPTURE_MIN_FACING && of(0.9) <= CAPTURE_MAX_RATIO * of(0.1)
}

pub(super) fn is_before_camera(mesh: &TriangleMesh) -> bool {
    let is_behind = |p: &&Point3<f32>| p.z <= 0.0;
    mesh.vertices.iter().find(is_behind).is_none()
}
