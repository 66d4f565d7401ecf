//! The camera of points that came without one.

use nalgebra::Point3;

use super::{PictureEdge, SceneCloud};
use crate::geometry::{
    cloud::{Grid, PointCloud, is_finite},
    depth_frame::Intrinsics,
    distortion::Distortion,
};

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
pub(super) fn organised(cloud: &PointCloud) -> Option<SceneCloud> {
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
            distortion: Distortion::NONE,
        }),
        edge: PictureEdge::Points,
        ..SceneCloud::default()
    })
}

/// Fits column = fx · x/z + cx and row = fy · y/z + cy; `None` when the fit is off by more than a pixel (rms) or the
/// points lie behind the camera: then no pinhole camera at the origin took them.
pub(super) fn fit_intrinsics(points: &[Point3<f32>], grid: Grid) -> Option<Intrinsics> {
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
        distortion: Distortion::NONE,
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
