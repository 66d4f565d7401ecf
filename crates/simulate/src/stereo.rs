//! A stereo camera: what matching blocks of two pictures makes of a perfect depth image.
//!
//! Other than a structured-light sensor's ([`crate::sensor`]), its errors reach over the whole block: neighbours share most
//! of their pixels, so noise is alike for several pixels, and a near surface grows over the far one beside it (foreground
//! fattening). What the second camera does not see is lost, and so are patches without texture.
//!
//! Sources: A. Grunnet-Jepsen, J. N. Sweetser and J. Woodfill, "Best-Known-Methods for Tuning Intel RealSense D400 Depth
//! Cameras", 2018 (baseline, error of the disparity); H. Hirschmüller, P. R. Innocent and J. Garibaldi, "Real-Time
//! Correlation-Based Stereo Vision with Reduced Border Errors", IJCV 47, 2002 (growth of near surfaces within a block).
//! Ours: the shape of the fields.

use rand::{RngExt as _, SeedableRng as _};
use rand_pcg::Pcg64;

use super::sensor::{in_units, lit_by_projector};
use geometry::depth_frame::DepthFrame;

/// Distance between the cameras, metres.
const BASELINE_M: f64 = 0.055;
/// Standard deviation of the disparity's error, pixels.
const DISPARITY_ERROR_PIXELS: f32 = 0.08;
/// Half the side of a block, pixels.
const BLOCK_RADIUS: usize = 3;
/// Steps of the disparity per pixel.
const STEPS_PER_PIXEL: f32 = 32.0;
/// A step of disparity within a block that is an edge and not a slope, pixels.
const EDGE_STEP_PIXELS: f32 = 1.0;
/// Radius over which texture changes, pixels, and its value below which a patch has none: one pixel in 300.
const TEXTURE_RADIUS: usize = 6;
const MIN_TEXTURE: f32 = -2.7;

/// Returns the frame of a stereo camera that looks at what this perfect frame shows, with noise of this seed.
pub fn stereo_frame(perfect: &DepthFrame, seed: u64) -> DepthFrame {
    let camera = &perfect.intrinsics;
    let size = [camera.width, camera.height];
    let focal_baseline = (camera.fx * BASELINE_M) as f32;
    let disparity: Vec<f32> = perfect
        .depth
        .iter()
        .map(|&units| match units {
            0 => 0.0,
            units => focal_baseline / (f32::from(units) * perfect.metres_per_unit as f32),
        })
        .collect();
    let is_seen_twice = lit_by_projector(&disparity, camera);
    let [noise, reach, texture] = [BLOCK_RADIUS, BLOCK_RADIUS, TEXTURE_RADIUS]
        .iter()
        .enumerate()
        .map(|(number, &radius)| smooth_field(size, radius, seed, number as u64))
        .collect::<Vec<_>>()
        .try_into()
        .expect("three fields");
    let matched = (0..disparity.len()).map(|pixel| {
        if !is_seen_twice[pixel] || texture[pixel] < MIN_TEXTURE {
            return 0;
        }
        // Between no growth and that of the whole radius.
        let radius = (reach[pixel] + 1.5).clamp(0.0, 3.0) / 3.0 * BLOCK_RADIUS as f32;
        let nearest = nearest_within(&disparity, size, pixel, radius as usize);
        let here = if nearest - disparity[pixel] > EDGE_STEP_PIXELS {
            nearest
        } else {
            disparity[pixel]
        };
        let found = here + DISPARITY_ERROR_PIXELS * noise[pixel];
        let found = (found * STEPS_PER_PIXEL).round() / STEPS_PER_PIXEL;
        if here > 0.0 && found > 0.0 {
            in_units(f64::from(focal_baseline / found), perfect.metres_per_unit)
        } else {
            0
        }
    });
    DepthFrame {
        depth: matched.collect(),
        ..perfect.clone()
    }
}

/// The largest disparity within this many pixels.
fn nearest_within(disparity: &[f32], [width, height]: [usize; 2], at: usize, radius: usize) -> f32 {
    let (u, v) = (at % width, at / width);
    let columns = u.saturating_sub(radius)..=(u + radius).min(width - 1);
    let rows = v.saturating_sub(radius)..=(v + radius).min(height - 1);
    let rows = rows.map(|v| &disparity[v * width..][columns.clone()]);
    rows.flatten().fold(0.0, |nearest, d| nearest.max(*d))
}

/// A field of mean 0 and variance 1: white noise, averaged three times over this radius along rows and columns.
fn smooth_field([width, height]: [usize; 2], radius: usize, seed: u64, number: u64) -> Vec<f32> {
    let mut random = Pcg64::seed_from_u64(seed);
    random.advance(u128::from(number) << 32);
    let mut field: Vec<f32> = (0..width * height)
        .map(|_| random.random_range(-1.0..1.0))
        .collect();
    for _ in 0..3 {
        for row in field.chunks_exact_mut(width) {
            average(row, radius);
        }
        let mut column = vec![0.0; height];
        for u in 0..width {
            for v in 0..height {
                column[v] = field[v * width + u];
            }
            average(&mut column, radius);
            for v in 0..height {
                field[v * width + u] = column[v];
            }
        }
    }
    let mean_sq = field.iter().map(|x| x * x).sum::<f32>() / field.len() as f32;
    for value in &mut field {
        *value /= mean_sq.sqrt();
    }
    field
}

/// Replaces each value by the mean of those within the radius.
fn average(line: &mut [f32], radius: usize) {
    let sums: Vec<f32> = std::iter::once(0.0)
        .chain(line.iter().scan(0.0, |sum, x| {
            *sum += x;
            Some(*sum)
        }))
        .collect();
    for k in 0..line.len() {
        let (first, end) = (k.saturating_sub(radius), (k + radius + 1).min(line.len()));
        line[k] = (sums[end] - sums[first]) / (end - first) as f32;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use geometry::depth_frame::Intrinsics;

    /// A plate at 1.5 m, 100 pixels wide, before a wall at 2.5 m.
    fn perfect() -> DepthFrame {
        let camera = Intrinsics::KINECT;
        let depth = (0..camera.width * camera.height).map(|pixel| {
            let is_plate = (200..300).contains(&(pixel % camera.width));
            if is_plate { 7500 } else { 12_500 }
        });
        DepthFrame {
            intrinsics: camera,
            metres_per_unit: 0.0002,
            depth: depth.collect(),
            is_simulated: true,
        }
    }

    fn metres(frame: &DepthFrame, row: usize, column: usize) -> f64 {
        let units = frame.depth[row * frame.intrinsics.width + column];
        f64::from(units) * frame.metres_per_unit
    }

    #[test]
    fn noise_is_that_of_the_disparity_and_alike_within_a_block() {
        let frame = stereo_frame(&perfect(), 1);
        let expected =
            2.5 * 2.5 * f64::from(DISPARITY_ERROR_PIXELS) / (frame.intrinsics.fx * BASELINE_M);
        let (mut squares, mut near, mut far, mut num) = (0.0, 0.0, 0.0, 0.0);
        for row in 0..frame.intrinsics.height {
            for column in 320..600 {
                let off = |column| metres(&frame, row, column) - 2.5;
                if [column, column + 2, column + 20]
                    .iter()
                    .all(|c| metres(&frame, row, *c) > 0.0)
                {
                    squares += off(column) * off(column);
                    near += off(column) * off(column + 2);
                    far += off(column) * off(column + 20);
                    num += 1.0;
                }
            }
        }
        let sigma = f64::sqrt(squares / num);
        assert!(
            (sigma / expected - 1.0).abs() < 0.15,
            "{sigma} of {expected}"
        );
        assert!(near / squares > 0.5 && (far / squares).abs() < 0.2);
    }

    #[test]
    fn a_near_surface_grows_raggedly_and_what_one_camera_sees_is_lost() {
        let frame = stereo_frame(&perfect(), 2);
        let widths: Vec<usize> = (0..frame.intrinsics.height)
            .map(|row| {
                let is_near = |column: &usize| (1.3..1.7).contains(&metres(&frame, row, *column));
                (250..320).take_while(is_near).count()
            })
            .collect();
        let (least, most) = (widths.iter().min(), widths.iter().max());
        assert!(
            least >= Some(&50) && most <= Some(&(50 + BLOCK_RADIUS)),
            "{least:?} {most:?}"
        );
        assert!(least < most);
        // f·b·(1/z_near - 1/z_far) = 8.6 pixels on the left.
        let is_lost = |column| {
            (0..400)
                .filter(|row| metres(&frame, *row, column) == 0.0)
                .count()
        };
        assert!(is_lost(194) > 300 && is_lost(150) < 20);
    }

    #[test]
    fn the_same_seed_gives_the_same_frame() {
        let perfect = perfect();
        assert_eq!(
            stereo_frame(&perfect, 3).depth,
            stereo_frame(&perfect, 3).depth
        );
        assert_ne!(
            stereo_frame(&perfect, 3).depth,
            stereo_frame(&perfect, 4).depth
        );
    }
}
