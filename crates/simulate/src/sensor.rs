//! A structured-light depth sensor: the errors and losses that it adds to a perfect depth image.
//!
//! The sensor sees a projected dot pattern, matches small blocks of it against a stored one, and converts the disparity
//! d = f·b/z to depth. The effects, in order:
//!
//! 1. *Shadow*: surfaces that the projector, a baseline b to the right of the camera, does not light have no depth. Beside
//!    a near edge this is a band `f·b·(1/z_near - 1/z_far)` pixels wide, on the left.
//! 2. *Ragged edges*: a matching block across a depth discontinuity yields either side, or nothing.
//! 3. *Lateral noise*: the block's centre of mass is off by about half a pixel.
//! 4. *Axial noise*: an error of the disparity, equal at all depths, so that the error of z grows with z². It is smooth
//!    over a few pixels, because neighbouring blocks share most of their dots. Slanted surfaces increase it.
//! 5. *Quantisation* of the disparity to 1/8 pixel.
//! 6. *Grazing*: surfaces seen at more than about 70° fade out. *Dropouts*: small blobs without a match, anywhere.
//! 7. *Range*: no readings nearer than 0.5 m or farther than 4 m.
//!
//! Sources: K. Khoshelham and S. O. Elberink, "Accuracy and Resolution of Kinect Depth Data for Indoor Mapping
//! Applications", Sensors 12(2), 2012 (random error ∝ z², about 1.5 mm at 1 m and 4 cm at 5 m);
//! C. V. Nguyen, S. Izadi and D. Lovell, "Modeling Kinect Sensor Noise for Improved 3D Reconstruction and Tracking",
//! 3DIMPVT 2012 (lateral noise below a pixel, growth of axial noise with the angle); J.-M. Gottfried, J. Fehr and
//! C. Garbe, "Computing Range Flow from Multi-modal Kinect Data", ISVC 2011 (where readings are
//! missing or unstable);
//! A. Handa, T. Whelan, J. McDonald and A. J. Davison, "A Benchmark for RGB-D Visual Odometry, 3D Reconstruction and
//! SLAM", ICRA 2014 (the order of shift, disparity noise and quantisation). Ours: the smoothing of all noise fields,
//! the thresholds of the losses, and one multiplier for noise and losses together.
//!
//! Known limits: no lens distortion, no slow bowing of depth over the frame, no interference, no specular loss. The error
//! is drawn anew for each seed, whereas a real sensor repeats part of it from frame to frame.

use rand::{Rng as _, SeedableRng as _};
use rand_pcg::Pcg64;
use serde::{Deserialize, Serialize};

use super::rasteriser::{Rendering, SurfaceLabel};
use geometry::depth_frame::{DepthFrame, Intrinsics};

/// Distance between projector and camera, in metres.
pub(super) const BASELINE_M: f64 = 0.075;
/// Steps of the disparity per pixel.
const STEPS_PER_PIXEL: f64 = 8.0;
/// Axial noise at 1 m before quantisation, in metres. Rounding to a step of 3.17 mm adds 0.92 mm; together 1.5 mm.
const AXIAL_AT_1M: f64 = 1.19e-3;
/// Lateral noise in pixels.
const LATERAL_PIXELS: f64 = 0.5;
/// Readings outside this range are lost, in metres.
const RANGE_M: (f64, f64) = (0.5, 4.0);
/// One unit of the frame in metres: 0.2 mm, so that 65 535 units reach 13 m.
const METRES_PER_UNIT: f64 = 0.0002;
/// A step of disparity between neighbours that is an edge and not a slope: 1 px is 38 mm at 1.2 m.
const EDGE_STEP_PIXELS: f32 = 1.0;

/// How much a frame is disturbed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SensorNoise {
    /// Scales noise and losses: 1 is a Kinect's, 3 is severe, 0 a perfect depth image without shadow, quantisation or range
    /// limits. At least 0; above 5 little is left of the frame.
    pub multiplier: f64,
    /// Seed of the noise; the same seed gives the same noise.
    pub seed: u64,
}

impl SensorNoise {
    /// A Kinect's noise.
    pub fn kinect(seed: u64) -> Self {
        Self {
            multiplier: 1.0,
            seed,
        }
    }

    /// A perfect depth image, rounded to the frame's unit.
    pub fn none() -> Self {
        Self {
            multiplier: 0.0,
            seed: 0,
        }
    }
}

/// A kind of depth sensor.
pub(super) trait Sensor: Send + Sync {
    /// Turns a perfect rendering into a frame.
    fn sense(&self, rendering: &Rendering, noise: &SensorNoise) -> DepthFrame;

    /// Counts the pixels of the rendering that show `label` and lie within the field of view.
    fn num_pixels_in_view(&self, rendering: &Rendering, label: SurfaceLabel) -> usize {
        rendering.num_pixels(label)
    }
}

/// The sensor of this [module](self).
pub(super) struct Kinect;

impl Sensor for Kinect {
    fn sense(&self, rendering: &Rendering, noise: &SensorNoise) -> DepthFrame {
        let depth = if noise.multiplier > 0.0 {
            with_noise(rendering, noise)
        } else {
            rendering
                .depth
                .iter()
                .map(|&z| in_units(f64::from(z), METRES_PER_UNIT))
                .collect()
        };
        DepthFrame {
            intrinsics: rendering.intrinsics,
            metres_per_unit: METRES_PER_UNIT,
            depth,
            is_simulated: true,
        }
    }
}

pub(super) fn in_units(metres: f64, metres_per_unit: f64) -> u16 {
    // The cast truncates, so adding a half rounds. Larger distances become no reading.
    let units = metres / metres_per_unit + 0.5;
    if units < f64::from(u16::MAX) {
        units as u16
    } else {
        0
    }
}

fn with_noise(rendering: &Rendering, noise: &SensorNoise) -> Vec<u16> {
    let camera = &rendering.intrinsics;
    let focal_baseline = camera.fx * BASELINE_M;
    // Infinite depth becomes disparity 0.
    let disparity: Vec<f32> = rendering
        .depth
        .iter()
        .map(|&z| focal_baseline as f32 / z)
        .collect();
    let lit = lit_by_projector(&disparity, camera);
    let edge_nearness = edge_nearness(&disparity, camera);
    let mut fields: [SmoothNoise; 4] =
        std::array::from_fn(|number| SmoothNoise::new(camera, noise.seed, number));
    let mut rows: [Vec<f32>; 4] = std::array::from_fn(|_| vec![0.0; camera.width]);

    let lateral = (LATERAL_PIXELS * noise.multiplier) as f32;
    // Losses grow more slowly than noise: a multiplier of 3 gives five times the dropouts.
    let loss_scale = noise.multiplier.sqrt().sqrt() as f32;
    let units_of_steps = units_of_steps(focal_baseline);
    // Neighbours mostly lie on one triangle, which has one angle.
    let (mut last_facing, mut slant) = (1.0_f32, slant_of(1.0));
    let mut depth = vec![0; disparity.len()];
    for v in 0..camera.height {
        for (field, row) in fields.iter_mut().zip(&mut rows) {
            field.next_row(row);
        }
        let [axial, shift_u, shift_v, loss] = &rows;
        for u in 0..camera.width {
            let pixel = v * camera.width + u;
            let threshold = loss_threshold(edge_nearness[pixel], rendering.facing[pixel]);
            if !lit[pixel] || loss[u] * loss_scale > threshold {
                continue;
            }
            let true_disparity = f64::from(sample(
                &disparity,
                camera,
                u as f32 + lateral * shift_u[u],
                v as f32 + lateral * shift_v[u],
            ));
            if true_disparity <= 0.0 {
                continue;
            }
            let facing = rendering.facing[pixel];
            if facing.to_bits() != last_facing.to_bits() {
                (last_facing, slant) = (facing, slant_of(f64::from(facing)));
            }
            let sigma = disparity_sigma(true_disparity, slant, focal_baseline, AXIAL_AT_1M)
                * noise.multiplier;
            let error = f64::from(axial[u]) * sigma;
            // The cast truncates, so adding a half rounds; a negative disparity is out of range anyway.
            let steps = ((true_disparity + error) * STEPS_PER_PIXEL + 0.5) as u32;
            // Disparities above the table are nearer than the range.
            depth[pixel] = units_of_steps.get(steps as usize).copied().unwrap_or(0);
        }
    }
    depth
}

/// Returns the reading of every number of steps of the disparity, 0 for those out of range.
fn units_of_steps(focal_baseline: f64) -> Vec<u16> {
    let most = (focal_baseline * STEPS_PER_PIXEL / RANGE_M.0).ceil() as u32;
    let units = (0..=most).map(|steps| {
        let z = focal_baseline * STEPS_PER_PIXEL / f64::from(steps);
        if (RANGE_M.0..=RANGE_M.1).contains(&z) {
            in_units(z, METRES_PER_UNIT)
        } else {
            0
        }
    });
    units.collect()
}

/// Returns the factor by which the noise grows with the angle of a surface at |cosine| `facing`; `None` if it does not.
pub(super) fn slant_of(facing: f64) -> Option<f64> {
    if facing > 0.7 {
        return None;
    }
    let angle = facing.clamp(0.0, 1.0).acos();
    let steep = (std::f64::consts::FRAC_PI_2 - angle).max(0.02);
    Some((angle / steep).powi(2))
}

/// Returns the standard deviation of the disparity before quantisation, in pixels, on a surface with this
/// [slant](slant_of). `axial_at_1m` is that of the depth at 1 m, in metres, on a surface that faces the camera.
pub(super) fn disparity_sigma(
    disparity: f64,
    slant: Option<f64>,
    focal_baseline: f64,
    axial_at_1m: f64,
) -> f64 {
    // dd = f·b/z² dz: an error of z that grows with z² is a constant error of the disparity.
    let upright = axial_at_1m * focal_baseline;
    let Some(slant) = slant else {
        return upright;
    };
    // The angle's term of Nguyen, Izadi and Lovell's axial model, limited to 1 cm where their data end.
    let z = focal_baseline / disparity;
    let slanted = (1e-4 / z.sqrt() * slant).min(0.01);
    upright.hypot(slanted * disparity / z)
}

/// Returns the value of the loss field (unit variance) above which a pixel is lost. Tuned by eye to real frames.
fn loss_threshold(edge_nearness: u8, facing: f32) -> f32 {
    // Lost are one pixel in 400 anywhere, half of the pixels at a discontinuity, a quarter of those next to them.
    let at_edge: f32 = match edge_nearness {
        0 => 2.8,
        1 => 0.7,
        _ => 0.0,
    };
    // Below cos 68° = 0.375 readings begin to be lost; at cos 84° = 0.105 nearly all are.
    let grazing = if facing < 0.375 {
        2.8 - (0.375 - facing) / (0.375 - 0.105) * 4.3
    } else {
        2.8
    };
    at_edge.min(grazing)
}

/// Returns for each pixel whether the projector lights it.
///
/// A surface point at column u with disparity d lies on the projector's column u - d. On each projector column of a row the
/// largest disparity is lit; the others lie in its shadow.
pub(super) fn lit_by_projector(disparity: &[f32], camera: &Intrinsics) -> Vec<bool> {
    let width = camera.width;
    // Disparity at the sensor's nearest range; nearer objects cast a shadow that is cut off.
    let margin = (camera.fx * BASELINE_M / RANGE_M.0).ceil() as usize;
    let mut lit = vec![true; disparity.len()];
    let mut nearest = vec![0.0_f32; width + margin + 2];
    let mut columns = vec![0.0_f32; width];
    for (row, lit_row) in disparity
        .chunks_exact(width)
        .zip(lit.chunks_exact_mut(width))
    {
        nearest.fill(0.0);
        for (u, (column, disparity)) in columns.iter_mut().zip(row).enumerate() {
            *column = ((u + margin) as f32 - disparity).max(0.0);
        }
        for (u, (&here, &disparity)) in columns.iter().zip(row).enumerate() {
            // A slope towards the camera spreads neighbours over several projector columns: fill between them.
            let next = if u + 1 < width && (row[u + 1] - disparity).abs() < EDGE_STEP_PIXELS {
                columns[u + 1]
            } else {
                here
            };
            for cell in &mut nearest[truncated(here.min(next))..=truncated(here.max(next))] {
                *cell = cell.max(disparity);
            }
        }
        for ((lit, &column), disparity) in lit_row.iter_mut().zip(&columns).zip(row) {
            *lit = nearest[truncated(column)] <= disparity + EDGE_STEP_PIXELS;
        }
    }
    lit
}

/// Truncates a column or row of a picture, at least 0; a cast to `usize` would take longer.
fn truncated(coordinate: f32) -> usize {
    coordinate as i32 as usize
}

/// Returns 2 at a discontinuity of the disparity, 1 one pixel further away, 0 elsewhere.
pub(super) fn edge_nearness(disparity: &[f32], camera: &Intrinsics) -> Vec<u8> {
    let (width, height) = (camera.width, camera.height);
    let mut nearness = vec![0_u8; disparity.len()];
    let mut mark = |pixel: usize, value: u8| nearness[pixel] = nearness[pixel].max(value);
    for v in 0..height {
        for u in 0..width {
            let pixel = v * width + u;
            let steps = [
                (u + 1 < width, 1, u >= 1, u + 2 < width),
                (v + 1 < height, width, v >= 1, v + 2 < height),
            ];
            for (has_next, stride, has_before, has_after) in steps {
                if has_next
                    && (disparity[pixel + stride] - disparity[pixel]).abs() > EDGE_STEP_PIXELS
                {
                    mark(pixel, 2);
                    mark(pixel + stride, 2);
                    if has_before {
                        mark(pixel - stride, 1);
                    }
                    if has_after {
                        mark(pixel + 2 * stride, 1);
                    }
                }
            }
        }
    }
    nearness
}

/// Samples the disparity between pixel centres: bilinear on one surface, the nearest pixel's value across a discontinuity.
pub(super) fn sample(disparity: &[f32], camera: &Intrinsics, u: f32, v: f32) -> f32 {
    let (width, height) = (camera.width, camera.height);
    let u = u.clamp(0.0, (width - 1) as f32);
    let v = v.clamp(0.0, (height - 1) as f32);
    let (column, row) = (truncated(u), truncated(v));
    let (s, t) = (u - column as f32, v - row as f32);
    let right = usize::from(column + 1 < width);
    let below = if row + 1 < height { width } else { 0 };
    let first = row * width + column;
    let [a, b, c, d] =
        [first, first + right, first + below, first + below + right].map(|i| disparity[i]);
    let (low, high) = (a.min(b).min(c.min(d)), a.max(b).max(c.max(d)));
    if high - low > EDGE_STEP_PIXELS {
        return match (s < 0.5, t < 0.5) {
            (true, true) => a,
            (false, true) => b,
            (true, false) => c,
            (false, false) => d,
        };
    }
    let top = a + (b - a) * s;
    let bottom = c + (d - c) * s;
    top + (bottom - top) * t
}

/// A field of unit variance, smooth over a few pixels, produced row by row: uniform noise filtered with the binomial
/// (1 4 6 4 1)/16 in both directions.
///
/// 25 weighted uniform draws are nearly normal out to three standard deviations, at a tenth of the cost of normal draws.
pub(super) struct SmoothNoise {
    random: Pcg64,
    /// Uniform noise on ±1 for one row.
    draws: Vec<f32>,
    /// The last five rows, filtered along the row; row r is at index r modulo 5.
    along: [Vec<f32>; 5],
    num_drawn: usize,
}

impl SmoothNoise {
    const WEIGHTS: [f32; 5] = [1.0, 4.0, 6.0, 4.0, 1.0];

    /// Creates the field of this number among those of one seed: each uses the random numbers after those of the one before.
    pub(super) fn new(camera: &Intrinsics, seed: u64, number: usize) -> Self {
        let num_draws = (camera.width + 4).next_multiple_of(4);
        let mut random = Pcg64::seed_from_u64(seed);
        // One number of the generator yields four draws.
        random.advance((number * (camera.height + 4) * num_draws / 4) as u128);
        let mut field = Self {
            random,
            draws: vec![0.0; num_draws],
            along: std::array::from_fn(|_| vec![0.0; camera.width]),
            num_drawn: 0,
        };
        for _ in 0..4 {
            field.draw();
        }
        field
    }

    fn draw(&mut self) {
        for group in self.draws.chunks_exact_mut(4) {
            let bits = self.random.next_u64();
            for (k, value) in group.iter_mut().enumerate() {
                let draw = (bits >> (16 * k)) as u16;
                *value = (f32::from(draw) + 0.5) / 32768.0 - 1.0;
            }
        }
        let row = &mut self.along[self.num_drawn % 5];
        // Sum all five in one pass: this takes most of the time of a frame.
        let near = std::array::from_fn(|k| &self.draws[k..][..row.len()]);
        add_up(&Self::WEIGHTS, near, row);
        self.num_drawn += 1;
    }

    pub(super) fn next_row(&mut self, row: &mut [f32]) {
        self.draw();
        // Uniform noise on ±1 has variance 1/3; the filter's squared weights add up to 70 per direction.
        let scale = 3.0_f32.sqrt() / 70.0;
        let near = std::array::from_fn(|k| &self.along[(self.num_drawn + k) % 5][..]);
        add_up(&Self::WEIGHTS.map(|weight| scale * weight), near, row);
    }
}

/// Stores the weighted sum of five rows, added in order, in `sum`.
fn add_up(weights: &[f32; 5], rows: [&[f32]; 5], sum: &mut [f32]) {
    let [v, w, x, y, z] = weights;
    let [a, b, c, d, e] = rows.map(|row| &row[..sum.len()]);
    for (u, sum) in sum.iter_mut().enumerate() {
        *sum = v * a[u] + w * b[u] + x * c[u] + y * d[u] + z * e[u];
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;

    use super::*;
    use crate::rasteriser::Plane;

    fn flat_wall(z: f64) -> Rendering {
        let mut rendering = Rendering::new(Intrinsics::KINECT);
        let plane = Plane {
            normal: Vector3::z(),
            offset: z,
        };
        rendering.draw_plane(&plane, SurfaceLabel::Wall);
        rendering
    }

    /// Standard deviation of the readings on flat walls around `z`, so that no step of the disparity is favoured.
    fn sigma(z: f64, multiplier: f64) -> f64 {
        let (mut sum_sq, mut num) = (0.0, 0.0);
        for k in 0..6 {
            let z = z * (1.0 + 0.002 * f64::from(k));
            let noise = SensorNoise {
                multiplier,
                seed: 11,
            };
            let frame = Kinect.sense(&flat_wall(z), &noise);
            for &units in frame.depth.iter().filter(|&&units| units > 0) {
                let error = f64::from(units) * frame.metres_per_unit - z;
                sum_sq += error * error;
                num += 1.0;
            }
        }
        f64::sqrt(sum_sq / num)
    }

    #[test]
    fn axial_noise_is_one_and_a_half_millimetres_at_one_metre_and_grows_with_depth_squared() {
        for z in [0.8, 1.2, 1.8, 2.5] {
            let per_square = sigma(z, 1.0) / (z * z);
            assert!(
                (1.3e-3..1.7e-3).contains(&per_square),
                "{per_square} at {z}"
            );
        }
        assert!(sigma(1.2, 3.0) > 2.2 * sigma(1.2, 1.0));
    }

    #[test]
    fn noise_is_shared_by_neighbours_but_not_across_the_frame() {
        let Intrinsics { width, height, .. } = Intrinsics::KINECT;
        let mut rows = SmoothNoise::new(&Intrinsics::KINECT, 5, 0);
        let mut field = vec![0.0; width * height];
        for row in field.chunks_exact_mut(width) {
            rows.next_row(row);
        }
        let correlation = |lag: usize| {
            let products: f32 = field
                .chunks_exact(width)
                .map(|row| {
                    row.iter().zip(&row[lag..]).map(|(a, b)| a * b).sum::<f32>()
                        / (width - lag) as f32
                })
                .sum();
            products / height as f32
        };
        assert!((correlation(0) - 1.0).abs() < 0.03, "{}", correlation(0));
        assert!((0.7..0.9).contains(&correlation(1)));
        assert!(correlation(6).abs() < 0.03);
    }

    #[test]
    fn the_shadow_is_on_the_left_and_as_wide_as_the_disparity_step() {
        let mut rendering = flat_wall(2.4);
        let camera = rendering.intrinsics;
        for v in 0..camera.height {
            for u in 300..400 {
                rendering.depth[v * camera.width + u] = 1.2;
            }
        }
        let disparity: Vec<f32> = rendering
            .depth
            .iter()
            .map(|&z| (525.0 * BASELINE_M) as f32 / z)
            .collect();
        let lit = lit_by_projector(&disparity, &camera);
        let row = &lit[240 * camera.width..][..camera.width];
        let num_dark = row[..300].iter().filter(|&&lit| !lit).count();
        // 525 · 0.075 · (1/1.2 - 1/2.4) = 16.4 pixels.
        assert!((15..=18).contains(&num_dark), "{num_dark}");
        assert!(row[300..].iter().all(|&lit| lit));
    }

    #[test]
    fn a_slanted_wall_casts_no_shadow_on_itself() {
        let mut rendering = Rendering::new(Intrinsics::KINECT);
        let plane = Plane {
            normal: Vector3::new(0.8, 0.0, 0.6),
            offset: 1.0,
        };
        rendering.draw_plane(&plane, SurfaceLabel::Wall);
        let disparity: Vec<f32> = rendering
            .depth
            .iter()
            .map(|&z| (525.0 * BASELINE_M) as f32 / z)
            .collect();
        let lit = lit_by_projector(&disparity, &rendering.intrinsics);
        assert!(lit.iter().all(|&lit| lit));
    }

    #[test]
    fn readings_out_of_range_are_lost() {
        for z in [0.3, 4.6] {
            let frame = Kinect.sense(&flat_wall(z), &SensorNoise::kinect(1));
            assert!(frame.depth.iter().all(|&units| units == 0));
        }
        let frame = Kinect.sense(&flat_wall(1.5), &SensorNoise::kinect(1));
        let num_lost = frame.depth.iter().filter(|&&units| units == 0).count();
        assert!(num_lost > 100 && num_lost < 6000, "{num_lost}");
    }

    #[test]
    fn without_noise_a_reading_is_the_truth_to_the_unit() {
        let frame = Kinect.sense(&flat_wall(1.2345), &SensorNoise::none());
        assert!(
            frame
                .depth
                .iter()
                .all(|&units| (f64::from(units) * 0.0002 - 1.2345).abs() < 0.000_101)
        );
    }
}
