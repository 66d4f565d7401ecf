//! A structured-light camera whose depth is registered to a colour picture.
//!
//! Like [`crate::sensor`], with these differences: readings end inside the picture ([`FieldOfView`]); no steps of
//! disparity are left after registration; depth discontinuities lose fewer pixels and have *flying* ones, whose depth is
//! between the two surfaces; glossy patches have no readings ([`SpecularDropout`]). The noise was fitted to real frames of a
//! paint shop: 0.9 to 1.5 mm at 1 m, growing with z², with a correlation of 0.77, 0.50, 0.24 between columns one to
//! three apart and of 0.77, 0.45, 0.14 between rows, which makes walls look rippled.

use rand::{Rng as _, RngExt as _, SeedableRng as _};
use rand_pcg::Pcg64;

use super::{field_of_view::FieldOfView, gloss::SpecularDropout};
use crate::{
    rasteriser::{Rendering, SurfaceLabel},
    sensor::{
        BASELINE_M, Sensor, SensorNoise, SmoothNoise, disparity_sigma, edge_nearness, in_units,
        lit_by_projector, sample, slant_of,
    },
};
use geometry::depth_frame::{DepthFrame, Intrinsics};

/// One unit of the frame, in metres.
const METRES_PER_UNIT: f64 = 0.001;
/// Readings outside this range are lost, in metres.
const RANGE_M: std::ops::Range<f64> = 0.4..4.0;
/// Axial noise at 1 m, in metres.
const AXIAL_AT_1M: std::ops::Range<f64> = 0.9e-3..1.6e-3;
/// Share of the axial noise's variance that is uncorrelated between neighbours.
const WHITE: f64 = 0.06;
/// Lateral noise in pixels, which moves edges.
const LATERAL_PIXELS: f32 = 0.5;
/// Beside a depth discontinuity, pixels whose noise is above this fly.
const FLIES_ABOVE: f32 = 0.8;

/// A camera with its field of view and its lost patches.
pub(super) struct RegisteredCamera {
    field_of_view: FieldOfView,
    gloss: SpecularDropout,
    /// In metres.
    axial_at_1m: f64,
}

impl RegisteredCamera {
    pub(super) fn new(field_of_view: FieldOfView, gloss: SpecularDropout, seed: u64) -> Self {
        Self {
            field_of_view,
            gloss,
            axial_at_1m: Pcg64::seed_from_u64(seed).random_range(AXIAL_AT_1M),
        }
    }

    fn apply_noise(&self, rendering: &Rendering, noise: &SensorNoise, depth: &mut [u16]) {
        let camera = &rendering.intrinsics;
        let focal_baseline = camera.fx * BASELINE_M;
        let disparity: Vec<f32> = rendering
            .depth
            .iter()
            .map(|&z| focal_baseline as f32 / z)
            .collect();
        let lit = lit_by_projector(&disparity, camera);
        let edge_nearness = edge_nearness(&disparity, camera);
        let mut axial = RippledNoise::new(camera, noise.seed);
        let mut fields: [SmoothNoise; 3] =
            std::array::from_fn(|k| SmoothNoise::new(camera, noise.seed, k + 1));
        let mut rows: [Vec<f32>; 3] = std::array::from_fn(|_| vec![0.0; camera.width]);
        let lateral = LATERAL_PIXELS * noise.multiplier as f32;
        let axial_at_1m = self.axial_at_1m * noise.multiplier;
        let loss_scale = noise.multiplier.sqrt().sqrt() as f32;
        for v in 0..camera.height {
            let axial = axial.next_row();
            for (field, row) in fields.iter_mut().zip(&mut rows) {
                field.next_row(row);
            }
            let [shift_u, shift_v, loss] = &rows;
            for u in 0..camera.width {
                let pixel = v * camera.width + u;
                let at_edge = edge_nearness[pixel];
                let threshold = loss_threshold(at_edge, rendering.facing[pixel]);
                if !lit[pixel] || loss[u] * loss_scale > threshold {
                    continue;
                }
                if self.gloss.takes(u as f64, v as f64, f64::from(loss[u])) {
                    continue;
                }
                let place = (
                    u as f32 + lateral * shift_u[u],
                    v as f32 + lateral * shift_v[u],
                );
                let seen = sample(&disparity, camera, place.0, place.1);
                let seen = if at_edge == 2 && -loss[u] > FLIES_ABOVE {
                    flying(&disparity, camera, pixel, seen, shift_u[u])
                } else {
                    seen
                };
                let seen = f64::from(seen);
                let slant = slant_of(f64::from(rendering.facing[pixel]));
                let sigma = disparity_sigma(seen, slant, focal_baseline, axial_at_1m);
                let z = focal_baseline / (seen + f64::from(axial[u]) * sigma);
                if RANGE_M.contains(&z) {
                    depth[pixel] = in_units(z, METRES_PER_UNIT);
                }
            }
        }
    }
}

impl Sensor for RegisteredCamera {
    /// Without noise only pixels outside the field of view are lost.
    fn sense(&self, rendering: &Rendering, noise: &SensorNoise) -> DepthFrame {
        let mut depth = vec![0; rendering.depth.len()];
        if noise.multiplier > 0.0 {
            self.apply_noise(rendering, noise, &mut depth);
        } else {
            let perfect = rendering.depth.iter();
            let perfect = perfect.map(|&z| in_units(f64::from(z), METRES_PER_UNIT));
            depth.iter_mut().zip(perfect).for_each(|(to, z)| *to = z);
        }
        let Intrinsics { width, height, .. } = rendering.intrinsics;
        for v in 0..height {
            for u in 0..width {
                let pixel = v * width + u;
                let z = f64::from(rendering.depth[pixel]);
                if !self.field_of_view.contains(u as f64, v as f64, z) {
                    depth[pixel] = 0;
                }
            }
        }
        DepthFrame {
            intrinsics: rendering.intrinsics,
            metres_per_unit: METRES_PER_UNIT,
            depth,
            is_simulated: true,
        }
    }

    fn num_pixels_in_view(&self, rendering: &Rendering, label: SurfaceLabel) -> usize {
        let width = rendering.intrinsics.width;
        let labels = rendering.labels.iter().enumerate();
        labels
            .filter(|(pixel, shown)| {
                **shown == label
                    && self.field_of_view.contains(
                        (pixel % width) as f64,
                        (pixel / width) as f64,
                        f64::from(rendering.depth[*pixel]),
                    )
            })
            .count()
    }
}

/// Returns a disparity between this pixel's and that of the neighbour that differs most.
fn flying(disparity: &[f32], camera: &Intrinsics, pixel: usize, seen: f32, noise: f32) -> f32 {
    let neighbours = [
        pixel.checked_sub(1),
        Some(pixel + 1),
        pixel.checked_sub(camera.width),
        Some(pixel + camera.width),
    ];
    let others = neighbours.into_iter().flatten();
    let others = others.filter_map(|other| disparity.get(other).copied());
    let other = others.max_by(|a, b| (a - seen).abs().total_cmp(&(b - seen).abs()));
    let share = 0.5 + 0.3 * noise.clamp(-1.0, 1.0);
    seen + (other.unwrap_or(seen) - seen) * share
}

/// Returns the value of the loss field (unit variance) above which a pixel is lost. Tuned by eye to real frames.
fn loss_threshold(edge_nearness: u8, facing: f32) -> f32 {
    let at_edge: f32 = match edge_nearness {
        0 => 3.2,
        1 => 2.4,
        _ => 1.2,
    };
    // Below cos 70° = 0.34 readings begin to be lost; at cos 84° = 0.105 nearly all are.
    let grazing = if facing < 0.34 {
        2.8 - (0.34 - facing) / (0.34 - 0.105) * 4.3
    } else {
        3.2
    };
    at_edge.min(grazing)
}

/// Noise of unit variance, correlated slightly further along rows than along columns: the sensor's smooth noise, widened,
/// plus some white noise.
struct RippledNoise {
    smooth: SmoothNoise,
    white: Pcg64,
    /// The last three rows of the smooth noise; row r is at index r modulo 3.
    rows: [Vec<f32>; 3],
    num_rows: usize,
    /// Sum of the three rows with weights 1 2 1.
    column_sum: Vec<f32>,
    row: Vec<f32>,
}

impl RippledNoise {
    fn new(camera: &Intrinsics, seed: u64) -> Self {
        let mut noise = Self {
            smooth: SmoothNoise::new(camera, seed, 0),
            white: Pcg64::seed_from_u64(seed ^ 0x3417_3417_3417_3417),
            rows: std::array::from_fn(|_| vec![0.0; camera.width]),
            num_rows: 0,
            column_sum: vec![0.0; camera.width],
            row: vec![0.0; camera.width],
        };
        noise.draw();
        noise.draw();
        noise
    }

    fn draw(&mut self) {
        self.smooth.next_row(&mut self.rows[self.num_rows % 3]);
        self.num_rows += 1;
    }

    fn next_row(&mut self) -> &[f32] {
        self.draw();
        let [above, here, below] = std::array::from_fn(|k| &self.rows[(self.num_rows + k) % 3]);
        for (u, sum) in self.column_sum.iter_mut().enumerate() {
            *sum = above[u] + 2.0 * here[u] + below[u];
        }
        // (1 2 1)/4 turns a binomial filter of width 5 into one of width 7, and (1 4 6 4 1)/16 into one of width 9. Their
        // squared weights add up to 924/4096 and 12870/65536 instead of 70/256.
        let per_five = 70.0 / 256.0;
        let variance = (924.0 / 4096.0 / per_five) * (12870.0 / 65536.0 / per_five);
        let scale = f64::sqrt((1.0 - WHITE) / variance) as f32 / 64.0;
        // Uniform noise on ±1 has variance 1/3.
        let white = f64::sqrt(3.0 * WHITE) as f32;
        let last = self.row.len() - 1;
        let sum = &self.column_sum;
        for u in 0..=last {
            let [a, b] = [1, 2].map(|k| sum[u.saturating_sub(k)] + sum[(u + k).min(last)]);
            let draw = self.white.next_u32() as f32 / (u32::MAX as f32) * 2.0 - 1.0;
            self.row[u] = scale * (6.0 * sum[u] + 4.0 * a + b) + white * draw;
        }
        &self.row
    }
}
