//! Reconstructs the picture and the camera of unorganised points.

use nalgebra::Point3;

use super::{PictureEdge, SceneCloud};
use crate::geometry::{
    cloud::{Grid, PointCloud},
    depth_frame::Intrinsics,
    distortion::Distortion,
};

/// Minimum number of points for a picture.
const MIN_PICTURE_POINTS: usize = 1000;
/// Minimum range of a depth camera, metres.
const NEAREST_READING: f32 = 0.05;
/// Limit for the picture's width and height at unit distance: a view of about 120°.
const WIDEST_VIEW: f64 = 3.5;
/// Minimum number of pixels along each side.
const LEAST_SIDE: f64 = 7.0;
/// Points per pixel of the reconstructed picture. A capture exported as bare points lacks only pixels without a
/// reading, so at 1.4 points per pixel few pixels stay empty.
const POINTS_PER_PIXEL: f64 = 1.4;
/// Maximum share of points whose depth differs from that of another in the same pixel by more than [`SAME_SURFACE`];
/// more means that no single camera saw them.
const MAX_HIDDEN_SHARE: f64 = 0.02;
/// Minimum share of filled pixels: a part cut out of its scene leaves the corners empty, and the edge of such a picture
/// is not the edge of the camera's view.
const MIN_FILLED_SHARE: f64 = 0.75;
/// Maximum difference in depth, relative to the depth, between two points of one surface.
const SAME_SURFACE: f32 = 0.05;

/// Arranges points into the picture of a camera at the origin; `None` if no such camera saw them all.
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
    // In f64, because the area of a sliver underflows in f32.
    let [across, down] = [0, 1].map(|axis| f64::from(high[axis] - low[axis]));
    let is_picture = across > 0.0 && down > 0.0 && across.max(down) < WIDEST_VIEW;
    if num_points < MIN_PICTURE_POINTS || !is_picture {
        return None;
    }
    let focal = (num_points as f64 / POINTS_PER_PIXEL / (across * down)).sqrt();
    let sides = [across, down].map(|x| x * focal);
    // This also keeps the number of pixels along the other side below the number of points.
    if !sides.iter().all(|&side| side >= LEAST_SIDE) {
        return None;
    }
    let [width, height] = sides.map(|side| side as usize + 1);
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
            surplus_bytes: cloud.surplus_bytes,
            ..PointCloud::default()
        },
        // A ratio is truncated to the pixel whose centre is half a pixel further.
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
