//! Fits a pinhole camera to the points of an organised cloud: x/z is linear in the column, y/z in the row.

use nalgebra::Point3;

use super::{
    cloud::{Grid, is_finite},
    depth_frame::Intrinsics,
    distortion::Distortion,
};

/// Fits column = fx · x/z + cx and row = fy · y/z + cy. `None` if the fit is off by a pixel (rms) or more, if a
/// point lies behind the camera, or if there are fewer than 100 readings: then the cloud is not known to come from
/// a pinhole camera at the origin.
pub fn fit_pinhole(points: &[Point3<f32>], grid: Grid) -> Option<Intrinsics> {
    let mut columns = LineFit::default();
    let mut rows = LineFit::default();
    // A few thousand readings suffice for four numbers; an odd stride visits all columns.
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
