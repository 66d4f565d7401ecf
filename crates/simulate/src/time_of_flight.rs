//! A time-of-flight camera: what it makes of a perfect depth image.
//!
//! Each pixel measures by itself, so neighbours err independently, by the square of the depth, as less light comes back.
//! A pixel that sees an edge mixes both surfaces and lies between them. Sources: P. Fürsattel et al., "A Comparative Error
//! Analysis of Current Time-of-Flight Sensors", IEEE Transactions on Computational Imaging 2(1), 2016 (kinds of errors). Ours:
//! their sizes. Known limits: no error that many pixels share, such as light that is reflected twice.

use rand::{RngExt as _, SeedableRng as _};
use rand_pcg::Pcg64;

use super::sensor::in_units;
use geometry::depth_frame::DepthFrame;

/// Standard deviation at 1 m, metres.
const ERROR_AT_1M: f64 = 0.0015;
/// Ratio of the depths of neighbours beyond which they lie on two surfaces.
const EDGE_RATIO: f64 = 1.03;

/// Returns the frame of a time-of-flight camera that looks at what this perfect frame shows, with noise of this seed.
pub fn time_of_flight_frame(perfect: &DepthFrame, seed: u64) -> DepthFrame {
    let (width, height) = (perfect.intrinsics.width, perfect.intrinsics.height);
    let mut random = Pcg64::seed_from_u64(seed);
    let measured = (0..width * height).map(|pixel| {
        let z = f64::from(perfect.depth[pixel]);
        // Approximately normal, with unit variance.
        let error = (0..4).map(|_| random.random_range(-1.0..1.0)).sum::<f64>() * 0.75_f64.sqrt();
        let share_of_other = random.random_range(0.0..0.5);
        let (u, v) = (pixel % width, pixel / width);
        let neighbours = [
            (u > 0).then(|| pixel - 1),
            (u + 1 < width).then(|| pixel + 1),
            (v > 0).then(|| pixel - width),
            (v + 1 < height).then(|| pixel + width),
        ];
        let other = neighbours
            .into_iter()
            .flatten()
            .map(|pixel| f64::from(perfect.depth[pixel]))
            .find(|other| *other > 0.0 && (other / z).max(z / other) > EDGE_RATIO);
        let mixed = other.map_or(z, |other| z + share_of_other * (other - z));
        let metres = mixed * perfect.metres_per_unit;
        if z > 0.0 {
            let found = metres + ERROR_AT_1M * metres * metres * error;
            in_units(found, perfect.metres_per_unit)
        } else {
            0
        }
    });
    DepthFrame {
        depth: measured.collect(),
        ..perfect.clone()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use geometry::depth_frame::Intrinsics;

    #[test]
    fn pixels_err_independently_and_mix_the_surfaces_of_an_edge() {
        let camera = Intrinsics::KINECT;
        let width = camera.width;
        let depth =
            (0..width * camera.height).map(|pixel| if pixel % width < 320 { 5000 } else { 10_000 });
        let perfect = DepthFrame {
            intrinsics: camera,
            metres_per_unit: 0.0002,
            depth: depth.collect(),
            is_simulated: true,
        };
        let frame = time_of_flight_frame(&perfect, 1);
        let metres = |row: usize, column: usize| {
            f64::from(frame.depth[row * width + column]) * frame.metres_per_unit
        };
        let (mut squares, mut products, mut num) = (0.0, 0.0, 0.0);
        for row in 0..camera.height {
            for column in 400..600 {
                let off = metres(row, column) - 2.0;
                squares += off * off;
                products += off * (metres(row, column + 1) - 2.0);
                num += 1.0;
            }
            let edge = metres(row, 320);
            assert!((1.48..2.02).contains(&edge), "{edge}");
        }
        let sigma = f64::sqrt(squares / num);
        assert!((sigma / (4.0 * ERROR_AT_1M) - 1.0).abs() < 0.02, "{sigma}");
        assert!(f64::abs(products / squares) < 0.02);
    }
}
