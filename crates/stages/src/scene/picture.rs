//! Reconstructs the picture and the camera of unorganised points.

use nalgebra::Point3;

use super::{PictureEdge, SceneCloud};
use geometry::{
    cloud::{Grid, MAX_STRAY_SHARE, PointCloud},
    depth_frame::Intrinsics,
    distortion::Distortion,
};

/// Minimum number of points for a picture.
const MIN_PICTURE_POINTS: usize = 1000;
/// Minimum range of a depth camera, metres.
const NEAREST_READING_M: f32 = 0.05;
/// Limit for the picture's width and height at unit distance: a view of about 120°.
const WIDEST_VIEW: f64 = 3.5;
/// Minimum number of pixels along each side.
const MIN_SIDE_PIXELS: f64 = 7.0;
/// Points per pixel of the reconstructed picture. A capture exported as bare points lacks only pixels without a
/// reading, so at 1.4 points per pixel few pixels stay empty.
const POINTS_PER_PIXEL: f64 = 1.4;
/// Maximum share of points whose depth differs from that of another in the same pixel by more than [`SAME_SURFACE`];
/// more means that no single camera saw them.
const MAX_HIDDEN_SHARE: f64 = 0.02;
/// Minimum share of filled pixels: a part cut out of its scene leaves the corners empty, and the edge of such a picture
/// is not the edge of the camera's view.
const MIN_FILLED_SHARE: f64 = 0.75;
/// Distance beyond the quantiles at [`MAX_STRAY_SHARE`] at which a point is stray, relative to the distance between them:
/// the corner of a picture turned by 45° is 2 % beyond them.
const STRAY_MARGIN: f32 = 0.1;
/// Maximum difference in depth, relative to the depth, between two points of one surface.
const SAME_SURFACE: f32 = 0.05;

/// Arranges points into the picture of a camera at the origin; `None` if no such camera saw them all.
///
/// Exact zeros, which stand for "no reading", are left out, and so are up to [`MAX_STRAY_SHARE`] of stray points.
pub(super) fn organised(cloud: &PointCloud) -> Option<SceneCloud> {
    let view = View::around(seen(cloud).map(|(_, _, ratios)| ratios));
    let is_unseen = |p: &Point3<f32>| p.z < NEAREST_READING_M && *p != Point3::origin();
    let num_unseen = cloud.finite().filter(|(_, p)| is_unseen(p)).count();
    let max_stray = (MAX_STRAY_SHARE * view.num_points as f64) as usize;
    if view.num_points < MIN_PICTURE_POINTS || num_unseen > max_stray {
        return None;
    }
    // Quantiles take time, so they come second.
    let without_strays = || view.without_strays(cloud, max_stray - num_unseen);
    picture(cloud, &view).or_else(|| picture(cloud, &without_strays()?))
}

/// Iterates over the points at the range of a camera, with their indices, x/z and y/z.
fn seen(cloud: &PointCloud) -> impl Iterator<Item = (usize, &Point3<f32>, [f32; 2])> {
    let at_range = cloud.finite().filter(|(_, p)| p.z >= NEAREST_READING_M);
    at_range.map(|(i, p)| (i, p, [p.x / p.z, p.y / p.z]))
}

/// The field of view that points fill.
struct View {
    /// Smallest x/z and y/z.
    low: [f32; 2],
    /// Largest x/z and y/z.
    high: [f32; 2],
    /// Number of distinct points, which determines the number of pixels.
    num_points: usize,
}

impl View {
    fn around(all_ratios: impl Iterator<Item = [f32; 2]>) -> Self {
        let (mut low, mut high) = ([f32::INFINITY; 2], [f32::NEG_INFINITY; 2]);
        let mut num_points = 0;
        for ratios in all_ratios {
            num_points += 1;
            for (axis, ratio) in ratios.into_iter().enumerate() {
                low[axis] = low[axis].min(ratio);
                high[axis] = high[axis].max(ratio);
            }
        }
        Self {
            low,
            high,
            num_points,
        }
    }

    fn contains(&self, ratios: [f32; 2]) -> bool {
        (0..2).all(|axis| (self.low[axis]..=self.high[axis]).contains(&ratios[axis]))
    }

    /// Returns the view without stray points, and with copies of a point counted once. `None` if it has more than
    /// `max_stray` stray points, or neither stray points nor copies.
    fn without_strays(&self, cloud: &PointCloud, max_stray: usize) -> Option<Self> {
        let limits = [0, 1].map(|axis| {
            let mut side: Vec<f32> = seen(cloud).map(|(_, _, ratios)| ratios[axis]).collect();
            let outside = (MAX_STRAY_SHARE * side.len() as f64) as usize;
            let inside = side.len() - 1 - outside;
            let low = *side.select_nth_unstable_by(outside, f32::total_cmp).1;
            let high = *side.select_nth_unstable_by(inside, f32::total_cmp).1;
            let margin = STRAY_MARGIN * (high - low);
            (low - margin, high + margin)
        });
        let allowed = Self {
            low: limits.map(|(low, _)| low),
            high: limits.map(|(_, high)| high),
            num_points: self.num_points,
        };
        let all_ratios = seen(cloud).map(|(_, _, ratios)| ratios);
        let mut view = Self::around(all_ratios.filter(|ratios| allowed.contains(*ratios)));
        if self.num_points - view.num_points > max_stray {
            return None;
        }
        let points = seen(cloud).filter(|(_, _, ratios)| allowed.contains(*ratios));
        let share = distinct_share(points.map(|(_, p, _)| p));
        view.num_points = (view.num_points as f64 * share).round() as usize;
        (view.num_points < self.num_points).then_some(view)
    }
}

/// Returns the share of distinct points, from about one in 64: all copies of a point are counted, or none is.
fn distinct_share<'a>(points: impl Iterator<Item = &'a Point3<f32>>) -> f64 {
    let is_counted = |bits: &[u32; 3]| {
        let mixed = bits
            .iter()
            .fold(0_u32, |sum, &x| (sum ^ x).wrapping_mul(0x9E37_79B1));
        mixed >> 26 == 0
    };
    let all_bits = points.map(|p| [p.x, p.y, p.z].map(f32::to_bits));
    let mut counted: Vec<[u32; 3]> = all_bits.filter(is_counted).collect();
    let num_counted = counted.len().max(1);
    counted.sort_unstable();
    counted.dedup();
    counted.len().max(1) as f64 / num_counted as f64
}

/// Arranges the points within the view into a picture; `None` if they do not fill it or hide one another.
fn picture(cloud: &PointCloud, view: &View) -> Option<SceneCloud> {
    let View {
        low,
        high,
        num_points,
    } = *view;
    // In f64, because the area of a sliver underflows in f32.
    let [across, down] = [0, 1].map(|axis| f64::from(high[axis] - low[axis]));
    let is_picture = across > 0.0 && down > 0.0 && across.max(down) < WIDEST_VIEW;
    if num_points < MIN_PICTURE_POINTS || !is_picture {
        return None;
    }
    let focal = (num_points as f64 / POINTS_PER_PIXEL / (across * down)).sqrt();
    let sides = [across, down].map(|x| x * focal);
    // This also keeps the number of pixels along the other side below the number of points.
    if !sides.iter().all(|&side| side >= MIN_SIDE_PIXELS) {
        return None;
    }
    let [width, height] = sides.map(|side| side as usize + 1);
    let mut nearest: Vec<Option<u32>> = vec![None; width * height];
    let mut num_hidden = 0_usize;
    let mut num_placed = 0_usize;
    for (i, p, [u, v]) in seen(cloud).filter(|(_, _, ratios)| view.contains(*ratios)) {
        num_placed += 1;
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
    if !is_full || num_hidden as f64 > MAX_HIDDEN_SHARE * num_placed as f64 {
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
