//! Estimates the noise of the depth from the picture itself, before any plane is known.
//!
//! The reciprocal of depth is linear over the picture of a plane, however it is tilted, and the error of a
//! structured-light sensor is one of the disparity, so it is constant in 1/z at all depths. Where a surface is flat,
//! the mean square of the second difference of 1/z over three readings in a row is therefore six times the noise's
//! variance; jumps and curved places give the largest values, which are trimmed.

use crate::scene::SceneCloud;
use geometry::units::Metres;

/// Limits of the estimate, metres at 1 m: a perfect (rendered) scene must not disable the tolerance, nor a warped
/// one open it wide.
pub(super) const NOISE_RANGE_AT_1M: [f64; 2] = [0.0003, 0.008];
/// Pixels between the three readings: neighbouring pixels share the same noise.
const STEP: usize = 8;
/// Step between samples in both directions, pixels; with the two directions about 2 400 samples for a Kinect.
const EVERY: usize = 16;
/// Minimum number of second differences.
const LEAST: usize = 200;
/// Share of the second differences that is kept, the smallest.
const KEPT: f64 = 0.7;
/// Mean square of the smallest 70 % of a normal distribution of variance 1, by magnitude.
const KEPT_VARIANCE: f64 = 0.310;

/// Returns the standard deviation of the depth at 1 m; `None` if the scene is not organised or nearly empty.
pub fn noise_of_picture(scene: &SceneCloud) -> Option<Metres> {
    let grid = scene.cloud.grid?;
    let points = &scene.cloud.points;
    let mut squares: Vec<f64> = Vec::new();
    for row in (STEP..grid.height.saturating_sub(STEP)).step_by(EVERY) {
        for column in (STEP..grid.width.saturating_sub(STEP)).step_by(EVERY) {
            let middle = row * grid.width + column;
            for apart in [STEP, STEP * grid.width] {
                let second =
                    [middle - apart, middle, middle + apart].map(|i| 1.0 / f64::from(points[i].z));
                let difference = second[0] - 2.0 * second[1] + second[2];
                if difference.is_finite() {
                    squares.push(difference * difference / 6.0);
                }
            }
        }
    }
    if squares.len() < LEAST {
        return None;
    }
    squares.sort_unstable_by(f64::total_cmp);
    let kept = &squares[..(squares.len() as f64 * KEPT) as usize];
    let variance = kept.iter().sum::<f64>() / kept.len() as f64 / KEPT_VARIANCE;
    Some(Metres(
        variance
            .sqrt()
            .clamp(NOISE_RANGE_AT_1M[0], NOISE_RANGE_AT_1M[1]),
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixtures::scene_of;
    use simulate::{CellSetup, Clutter, PartKind, SensorNoise, Side};

    #[test]
    fn the_noise_of_a_cluttered_cell_is_found_without_knowing_its_walls() {
        for (multiplier, expected) in [(1.0, 1.5), (3.0, 3.7)] {
            let mut setup = CellSetup::with_part(PartKind::FrontDoor, Side::Left, 0, 17);
            setup.clutter = Clutter::InFront;
            setup.noise = SensorNoise {
                multiplier,
                seed: 17,
            };
            let scene = scene_of(&setup);
            let found = noise_of_picture(&scene).expect("a picture").mm();
            assert!(
                (found / expected - 1.0).abs() < 0.25,
                "{found} mm instead of {expected} mm"
            );
        }
    }
}
