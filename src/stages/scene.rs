//! The scene: the points that a camera sees, in camera space.
//!
//! A depth frame becomes an organised cloud by the pinhole model. For an organised cloud that came without a camera
//! the intrinsics are fitted from the points themselves, because x/z of a pinhole camera is linear in the column:
//! later stages ask the camera what it would have seen at a place.

use nalgebra::Point3;

use crate::{
    capture::frame::{DepthFrame, Intrinsics},
    geometry::cloud::{Grid, PointCloud, is_finite},
};

/// The points of one capture, in camera space.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SceneCloud {
    /// The points, organised when they come from one frame.
    pub cloud: PointCloud,
    /// The camera, if the cloud is organised and a pinhole camera explains it.
    pub intrinsics: Option<Intrinsics>,
}

/// The points of a depth frame; pixels without a reading become NaN.
pub fn scene_from_frame(frame: &DepthFrame) -> SceneCloud {
    let camera = &frame.intrinsics;
    assert_eq!(
        frame.depth.len(),
        camera.width * camera.height,
        "a frame holds width × height readings"
    );
    let scale = frame.metres_per_unit as f32;
    // x/z per column and y/z per row, so that the inner loop is three multiplications.
    let x_over_z: Vec<f32> = (0..camera.width)
        .map(|u| ((u as f64 - camera.cx) / camera.fx) as f32)
        .collect();
    let mut points = Vec::with_capacity(frame.depth.len());
    for (v, row) in frame.depth.chunks_exact(camera.width).enumerate() {
        let y_over_z = ((v as f64 - camera.cy) / camera.fy) as f32;
        points.extend(row.iter().zip(&x_over_z).map(|(&units, &x_over_z)| {
            let z = if units == 0 {
                f32::NAN
            } else {
                f32::from(units) * scale
            };
            Point3::new(x_over_z * z, y_over_z * z, z)
        }));
    }
    SceneCloud {
        cloud: PointCloud {
            points,
            grid: Some(Grid {
                width: camera.width,
                height: camera.height,
            }),
            ..PointCloud::default()
        },
        intrinsics: Some(*camera),
    }
}

/// A loaded cloud as a scene in camera space, with the camera fitted if the cloud is organised.
pub fn scene_from_cloud(cloud: PointCloud) -> SceneCloud {
    let intrinsics = cloud
        .grid
        .and_then(|grid| fit_intrinsics(&cloud.points, grid));
    SceneCloud { cloud, intrinsics }
}

/// Fits column = fx · x/z + cx and row = fy · y/z + cy; `None` when the fit is off by more than a pixel (rms) or the
/// points lie behind the camera: then no pinhole camera at the origin took them.
fn fit_intrinsics(points: &[Point3<f32>], grid: Grid) -> Option<Intrinsics> {
    let mut columns = LineFit::default();
    let mut rows = LineFit::default();
    // A few thousand readings fix four numbers; an odd stride visits all columns.
    let stride = (points.len() / 4000).max(1) | 1;
    for (i, p) in points.iter().enumerate().step_by(stride) {
        if !is_finite(p) {
            continue;
        }
        if p.z <= 0.0 {
            return None;
        }
        columns.add(f64::from(p.x / p.z), (i % grid.width) as f64);
        rows.add(f64::from(p.y / p.z), (i / grid.width) as f64);
    }
    let (fx, cx) = columns.solve()?;
    let (fy, cy) = rows.solve()?;
    (fx > 0.0 && fy > 0.0).then_some(Intrinsics {
        width: grid.width,
        height: grid.height,
        fx,
        fy,
        cx,
        cy,
    })
}

/// Least squares for pixel = focal · ratio + centre.
#[derive(Default)]
struct LineFit {
    num: f64,
    x: f64,
    y: f64,
    xx: f64,
    xy: f64,
    yy: f64,
}

impl LineFit {
    fn add(&mut self, x: f64, y: f64) {
        self.num += 1.0;
        self.x += x;
        self.y += y;
        self.xx += x * x;
        self.xy += x * y;
        self.yy += y * y;
    }

    fn solve(&self) -> Option<(f64, f64)> {
        if self.num < 100.0 {
            return None;
        }
        let xx = self.xx - self.x * self.x / self.num;
        let xy = self.xy - self.x * self.y / self.num;
        let yy = self.yy - self.y * self.y / self.num;
        if xx <= 0.0 {
            return None;
        }
        let slope = xy / xx;
        let rms = ((yy - slope * xy).max(0.0) / self.num).sqrt();
        (rms < 1.0).then(|| (slope, (self.y - slope * self.x) / self.num))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tilted_wall() -> DepthFrame {
        let intrinsics = Intrinsics::KINECT;
        let depth = (0..intrinsics.width * intrinsics.height)
            .map(|i| (8000 + (i % 640) * 3 + (i / 640) * 2) as u16)
            .collect();
        DepthFrame {
            intrinsics,
            metres_per_unit: 0.0002,
            depth,
        }
    }

    #[test]
    fn points_fall_back_onto_the_pixels_they_came_from() {
        let mut frame = tilted_wall();
        frame.depth[12_345] = 0;
        let scene = scene_from_frame(&frame);
        assert!(scene.cloud.points[12_345].z.is_nan());
        for (i, p) in scene.cloud.finite() {
            let (u, v) = frame.intrinsics.pixel_of(&p.cast()).expect("in front");
            assert!((u - (i % 640) as f64).abs() < 1e-3 && (v - (i / 640) as f64).abs() < 1e-3);
        }
    }

    #[test]
    fn the_camera_is_found_again_from_the_points_alone() {
        let scene = scene_from_frame(&tilted_wall());
        let camera = scene_from_cloud(scene.cloud)
            .intrinsics
            .expect("a pinhole camera");
        let truth = Intrinsics::KINECT;
        for (found, expected) in [
            (camera.fx, truth.fx),
            (camera.fy, truth.fy),
            (camera.cx, truth.cx),
            (camera.cy, truth.cy),
        ] {
            assert!(
                (found - expected).abs() < 0.05,
                "{found} instead of {expected}"
            );
        }
    }

    #[test]
    fn a_grid_that_no_camera_took_has_no_intrinsics() {
        let grid = Grid {
            width: 40,
            height: 30,
        };
        let points = (0..1200)
            .map(|i| Point3::new((i * 7 % 40) as f32, (i * 11 % 30) as f32, 1.0))
            .collect();
        let cloud = PointCloud {
            points,
            grid: Some(grid),
            ..PointCloud::default()
        };
        assert_eq!(scene_from_cloud(cloud).intrinsics, None);
    }
}
