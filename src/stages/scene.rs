//! The scene: the points that a camera sees, in camera space.
//!
//! A depth frame becomes an organised cloud by the pinhole model. For an organised cloud that came without a camera
//! the intrinsics are fitted from the points themselves, because x/z of a pinhole camera is linear in the column:
//! later stages ask the camera what it would have seen at a place. A capture saved as bare points (PLY, XYZ) has lost
//! its rows and columns, but not its viewpoint: it is put back onto a picture, so that it is inspected as well.

use std::sync::{Arc, OnceLock};

use nalgebra::Point3;

use super::{field_of_view::FieldOfView, segment::EmptyCell};
use crate::{
    capture::{DepthFrame, Image, Intrinsics},
    files::Opened,
    geometry::cloud::{Grid, PointCloud, is_finite},
};

/// The points of one capture, in camera space.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SceneCloud {
    /// The points, organised when they come from one frame.
    pub cloud: PointCloud,
    /// The camera, if the cloud is organised and a pinhole camera explains it.
    pub intrinsics: Option<Intrinsics>,
    /// What lies at the edge of an organised cloud.
    pub edge: PictureEdge,
    /// What the same camera saw without a part, if that was captured.
    pub empty_cell: Option<Arc<EmptyCell>>,
    /// Made when it is first asked for.
    #[doc(hidden)]
    pub field_of_view: OnceLock<FieldOfView>,
}

impl SceneCloud {
    /// A cloud whose picture, if it is organised, ends where the camera's view does.
    pub fn new(cloud: PointCloud, intrinsics: Option<Intrinsics>) -> Self {
        Self {
            cloud,
            intrinsics,
            ..Self::default()
        }
    }

    /// Where in the picture the camera could deliver readings; `None` if the scene is no picture, or if it was put around
    /// its points.
    pub fn field_of_view(&self) -> Option<&FieldOfView> {
        let grid = self.cloud.grid.filter(|_| self.edge == PictureEdge::View)?;
        Some(self.field_of_view.get_or_init(|| {
            let points = &self.cloud.points;
            let is_reading = |i: usize| points.get(i).is_some_and(is_finite);
            let known = self.empty_cell.as_ref().map(|cell| cell.field_of_view());
            FieldOfView::of(grid, is_reading, known)
        }))
    }

    /// The scene as in a mirror held beside the camera: x turned round, the picture's rows with it.
    #[must_use]
    pub fn mirrored(&self) -> Self {
        let turned = |p: &Point3<f32>| Point3::new(-p.x, p.y, p.z);
        let points = &self.cloud.points;
        let points = match self.cloud.grid {
            Some(Grid { width, .. }) => points
                .chunks(width.max(1))
                .flat_map(|row| row.iter().rev().map(turned))
                .collect(),
            None => points.iter().map(turned).collect(),
        };
        let cloud = PointCloud {
            points,
            grid: self.cloud.grid,
            is_simulated: self.cloud.is_simulated,
            ..PointCloud::default()
        };
        let intrinsics = self.intrinsics.map(|camera| Intrinsics {
            cx: camera.width as f64 - 1.0 - camera.cx,
            ..camera
        });
        // The empty cell is only of use before the part is found.
        Self {
            edge: self.edge,
            ..Self::new(cloud, intrinsics)
        }
    }
}

/// What the edge of a picture is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PictureEdge {
    /// The camera's view ends there; the scene goes on.
    #[default]
    View,
    /// The points end there: the picture was put around them.
    Points,
}

/// Points sampled of a mesh to align it.
const MESH_POINTS: usize = 16_000;

/// Every point of what a file holds; a mesh is sampled evenly, and gives `None` if it has no area.
pub fn cloud_of(opened: Opened) -> Option<PointCloud> {
    match opened {
        Opened::Cloud(cloud) => Some(cloud),
        Opened::Depth(frame) => Some(scene_from_frame(&frame).cloud),
        Opened::Mesh(mesh) => mesh.sample_evenly(MESH_POINTS, 1),
    }
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
    let cloud = PointCloud {
        points,
        grid: Some(Grid {
            width: camera.width,
            height: camera.height,
        }),
        is_simulated: frame.is_simulated,
        ..PointCloud::default()
    };
    SceneCloud::new(cloud, Some(*camera))
}

/// What a source captured, as a scene.
pub fn scene_from_image(image: Image) -> SceneCloud {
    match image {
        Image::Depth(frame) => scene_from_frame(&frame),
        Image::Cloud(cloud) => scene_from_cloud(cloud),
    }
}

/// A loaded cloud as a scene in camera space.
///
/// An organised cloud keeps its grid, and the camera is fitted. A cloud without rows and columns that one camera at
/// the origin can have seen is put back onto a picture of its own density; any other stays as it is.
pub fn scene_from_cloud(cloud: PointCloud) -> SceneCloud {
    let intrinsics = match cloud.grid {
        Some(grid) => fit_intrinsics(&cloud.points, grid),
        None => match organised(&cloud) {
            Some(scene) => return scene,
            None => None,
        },
    };
    SceneCloud::new(cloud, intrinsics)
}

/// Fewer points than this are no picture.
const MIN_PICTURE_POINTS: usize = 1000;
/// Nearer than this no depth camera reads, metres.
const NEAREST_READING: f32 = 0.05;
/// Width or height of the picture over its distance: 120° of view.
const WIDEST_VIEW: f32 = 3.5;
/// Points per pixel of the picture that they are put back onto. A capture exported as bare points has lost at most
/// its pixels without a reading; with about one point and a half per pixel few pixels stay empty.
const POINTS_PER_PIXEL: f64 = 1.4;
/// Share of the points that may lie behind another in the same pixel, by more than [`SAME_SURFACE`]: more means that
/// no single camera saw them.
const MAX_HIDDEN_SHARE: f64 = 0.02;
/// Share of the pixels that are filled at least: a part cut out of its scene leaves the corners of its picture empty,
/// and the edge of such a picture is no edge of the camera's view.
const MIN_FILLED_SHARE: f64 = 0.75;
/// Difference in depth, relative to the depth, up to which two points of a pixel are of one surface.
const SAME_SURFACE: f32 = 0.05;

/// Puts points back onto the picture of a camera at the origin; `None` if no such camera saw them all.
fn organised(cloud: &PointCloud) -> Option<SceneCloud> {
    let ratios = |p: &Point3<f32>| [p.x / p.z, p.y / p.z];
    let (mut low, mut high) = ([f32::INFINITY; 2], [f32::NEG_INFINITY; 2]);
    let mut num_points = 0_usize;
    for (_, p) in cloud.finite() {
        if p.z < NEAREST_READING {
            return None;
        }
        num_points += 1;
        for (axis, ratio) in ratios(p).into_iter().enumerate() {
            low[axis] = low[axis].min(ratio);
            high[axis] = high[axis].max(ratio);
        }
    }
    let [across, down] = [0, 1].map(|axis| high[axis] - low[axis]);
    let is_picture = across > 0.0 && down > 0.0 && across.max(down) < WIDEST_VIEW;
    if num_points < MIN_PICTURE_POINTS || !is_picture {
        return None;
    }
    let focal = (num_points as f64 / POINTS_PER_PIXEL / f64::from(across * down)).sqrt();
    let [width, height] = [across, down].map(|x| (f64::from(x) * focal) as usize + 1);
    if width.min(height) < 8 {
        return None;
    }
    let mut nearest: Vec<Option<u32>> = vec![None; width * height];
    let mut num_hidden = 0_usize;
    for (i, p) in cloud.finite() {
        let [u, v] = ratios(p);
        let column = (f64::from(u - low[0]) * focal) as usize;
        let row = (f64::from(v - low[1]) * focal) as usize;
        let slot = &mut nearest[row.min(height - 1) * width + column.min(width - 1)];
        if let Some(holder) = *slot {
            let held = cloud.points[holder as usize].z;
            num_hidden += usize::from((held - p.z).abs() > SAME_SURFACE * p.z);
            if held <= p.z {
                continue;
            }
        }
        *slot = Some(i as u32);
    }
    let num_filled = nearest.iter().flatten().count();
    let is_full = num_filled as f64 >= MIN_FILLED_SHARE * nearest.len() as f64;
    if !is_full || num_hidden as f64 > MAX_HIDDEN_SHARE * num_points as f64 {
        return None;
    }
    let none = Point3::new(f32::NAN, f32::NAN, f32::NAN);
    let pick = |slot: &Option<u32>| slot.map_or(none, |i| cloud.points[i as usize]);
    Some(SceneCloud {
        cloud: PointCloud {
            points: nearest.iter().map(pick).collect(),
            grid: Some(Grid { width, height }),
            is_simulated: cloud.is_simulated,
            ..PointCloud::default()
        },
        // A ratio falls into the pixel whose centre is half a pixel further.
        intrinsics: Some(Intrinsics {
            width,
            height,
            fx: focal,
            fy: focal,
            cx: -f64::from(low[0]) * focal - 0.5,
            cy: -f64::from(low[1]) * focal - 0.5,
        }),
        edge: PictureEdge::Points,
        ..SceneCloud::default()
    })
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
            is_simulated: false,
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
    fn a_capture_exported_as_bare_points_becomes_a_picture_again() {
        let scene = scene_from_frame(&tilted_wall());
        // Another order: nothing but the positions is left.
        let points: Vec<_> = scene.cloud.points.iter().rev().copied().collect();
        let again = scene_from_cloud(PointCloud::from_points(points));
        let (camera, grid) = (
            again.intrinsics.expect("a camera"),
            again.cloud.grid.expect("a grid"),
        );
        assert!(again.cloud.num_finite() as f64 > 0.9 * grid.num_cells() as f64);
        for (i, p) in again.cloud.finite() {
            let (u, v) = camera.pixel_of(&p.cast()).expect("in front");
            assert!(
                (u - (i % grid.width) as f64).abs() <= 0.51
                    && (v - (i / grid.width) as f64).abs() <= 0.51
            );
        }
    }

    #[test]
    fn a_cloud_seen_from_all_around_stays_without_a_picture() {
        let points = (0..20_000).map(|i| {
            let (a, b) = (i as f32 * 0.0917, i as f32 / 20_000.0 * 2.0 - 1.0);
            let r = (1.0 - b * b).sqrt();
            Point3::new(0.3 * r * a.cos(), 0.3 * b, 1.5 + 0.3 * r * a.sin())
        });
        let scene = scene_from_cloud(PointCloud::from_points(points));
        assert_eq!((scene.cloud.grid, scene.intrinsics), (None, None));
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
