//! A depth image and the camera that took it.

use nalgebra::Point3;
use serde::{Deserialize, Serialize};

/// A pinhole camera without distortion, in pixels. Camera space is x right, y down, z forward.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Intrinsics {
    /// Columns, at least 1.
    pub width: usize,
    /// Rows, at least 1.
    pub height: usize,
    /// Focal length along the rows, pixels, above 0.
    pub fx: f64,
    /// Focal length along the columns, pixels, above 0.
    pub fy: f64,
    /// Column of the optical axis; pixel centres are at whole numbers.
    pub cx: f64,
    /// Row of the optical axis.
    pub cy: f64,
}

impl Intrinsics {
    /// The 640×480 camera of the simulated cell: a Kinect's field of view.
    pub const KINECT: Self = Self {
        width: 640,
        height: 480,
        fx: 525.0,
        fy: 525.0,
        cx: 319.5,
        cy: 239.5,
    };

    /// The camera point seen at column `u`, row `v` with depth `z` (metres along the optical axis).
    pub fn point_at(&self, u: f64, v: f64, z: f64) -> Point3<f64> {
        Point3::new((u - self.cx) / self.fx * z, (v - self.cy) / self.fy * z, z)
    }

    /// Column and row at which a camera point is seen; `None` behind the camera.
    pub fn pixel_of(&self, point: &Point3<f64>) -> Option<(f64, f64)> {
        (point.z > 0.0).then(|| {
            (
                point.x / point.z * self.fx + self.cx,
                point.y / point.z * self.fy + self.cy,
            )
        })
    }
}

/// One depth image as the sensor delivers it.
#[derive(Clone, Debug, PartialEq)]
pub struct DepthFrame {
    /// The camera; its width × height is the length of `depth`.
    pub intrinsics: Intrinsics,
    /// Metres that one unit of `depth` stands for, above 0.
    pub metres_per_unit: f64,
    /// Depth along the optical axis, row by row from the top left. 0 is the sensors' own sign for "no reading".
    pub depth: Vec<u16>,
    /// True if no camera read these depths: they are simulated.
    pub is_simulated: bool,
}
