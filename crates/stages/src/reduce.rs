//! Reduces a picture that is finer than the method needs: each block of readings becomes one.
//!
//! Outlines are drawn with pixels of 5 mm, and a camera of half a million pixels resolves 3 mm at 1.5 m: more pixels cost
//! time and add nothing. A block of k × k readings yields the surface that most of them lie on, or the nearer of two with as
//! many readings; its depth is their mean, which also reduces noise. Readings of two surfaces are never mixed. In a depth
//! image the mean lies on the ray through the middle of its block. Incomplete blocks at the right and bottom are dropped.

use nalgebra::Point3;

use geometry::cloud::Grid;

/// Parameters of making a scene from a capture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SceneParams {
    /// Larger pictures are reduced to at most this many pixels, 100 000..20 000 000. Raising it costs time in every
    /// stage and resolves smaller openings; lowering it blurs the outline.
    pub max_pixels: usize,
}

impl Default for SceneParams {
    fn default() -> Self {
        Self {
            max_pixels: 500_000,
        }
    }
}

impl SceneParams {
    /// Returns the side of a block in readings; 1 leaves the picture unchanged.
    pub fn block_side(&self, grid: Grid) -> usize {
        let most = self.max_pixels.max(1);
        let at_least = (grid.num_cells() as f64 / most as f64).sqrt() as usize;
        let is_enough = |side: &usize| (grid.width / side) * (grid.height / side) <= most;
        let largest = grid.width.min(grid.height).max(1);
        (at_least.max(1)..=largest)
            .find(is_enough)
            .unwrap_or(largest)
    }
}

/// Readings within this share of the nearest depth belong to one surface: far above the noise and the slope of any
/// visible surface, far below the distance between a part and what is behind it.
const SAME_SURFACE: f32 = 0.02;

/// Returns the minimum number of readings of one surface in a block; fewer are strays.
fn least_readings(side: usize) -> usize {
    (side * side / 4).max(1)
}

/// Returns the depths of the blocks of a depth image, metres, row by row; NaN where there is no reading.
pub(super) fn reduced_depths(
    depth: &[u16],
    grid: Grid,
    side: usize,
    metres_per_unit: f32,
) -> Vec<f32> {
    let columns = grid.width / side;
    let used = columns * side;
    let least = least_readings(side);
    let mut reduced = Vec::with_capacity(columns * (grid.height / side));
    // Reduce each column of the image first: whole rows at once are fast.
    let mut nearest = vec![0_u16; used];
    let mut farthest = vec![0_u16; used];
    let mut sums = vec![0_u32; used];
    let mut counts = vec![0_u32; used];
    let mut readings = Vec::with_capacity(side * side);
    for rows in depth.chunks_exact(grid.width * side) {
        nearest.fill(u16::MAX);
        farthest.fill(0);
        sums.fill(0);
        counts.fill(0);
        for row in rows.chunks_exact(grid.width) {
            for (u, &units) in row[..used].iter().enumerate() {
                // Wraps to the maximum where there is no reading (0).
                nearest[u] = nearest[u].min(units.wrapping_sub(1));
                farthest[u] = farthest[u].max(units);
                sums[u] += u32::from(units);
                counts[u] += u32::from(units != 0);
            }
        }
        for block in 0..columns {
            let of_block = block * side..(block + 1) * side;
            let count: u32 = counts[of_block.clone()].iter().sum();
            if (count as usize) < least {
                reduced.push(f32::NAN);
                continue;
            }
            let low = nearest[of_block.clone()]
                .iter()
                .fold(u16::MAX, |a, b| a.min(*b));
            let low = f32::from(low) + 1.0;
            let high = farthest[of_block.clone()].iter().fold(0, |a, b| a.max(*b));
            let units = if f32::from(high) - low <= SAME_SURFACE * low {
                let sum: u32 = sums[of_block].iter().sum();
                sum as f32 / count as f32
            } else {
                readings.clear();
                for row in rows.chunks_exact(grid.width) {
                    let valid = row[of_block.clone()].iter().filter(|units| **units != 0);
                    readings.extend(valid.map(|units| f32::from(*units)));
                }
                readings.sort_unstable_by(f32::total_cmp);
                main_surface(&readings, least).map_or(f32::NAN, mean)
            };
            reduced.push(units * metres_per_unit);
        }
    }
    reduced
}

/// Returns the mean points of the blocks of an organised cloud, row by row; NaN where there is no reading.
pub(super) fn reduced_points(points: &[Point3<f32>], grid: Grid, side: usize) -> Vec<Point3<f32>> {
    let columns = grid.width / side;
    let least = least_readings(side);
    let mut reduced = Vec::with_capacity(columns * (grid.height / side));
    let mut readings: Vec<Point3<f32>> = Vec::with_capacity(side * side);
    let mut depths: Vec<f32> = Vec::with_capacity(side * side);
    for rows in points.chunks_exact(grid.width * side) {
        for block in 0..columns {
            readings.clear();
            for row in rows.chunks_exact(grid.width) {
                let of_block = &row[block * side..(block + 1) * side];
                readings.extend(of_block.iter().filter(|p| p.z.is_finite()));
            }
            depths.clear();
            depths.extend(readings.iter().map(|p| p.z));
            depths.sort_unstable_by(f32::total_cmp);
            let surface = main_surface(&depths, least).unwrap_or_default();
            let (Some(&nearest), Some(&farthest)) = (surface.first(), surface.last()) else {
                reduced.push(Point3::new(f32::NAN, f32::NAN, f32::NAN));
                continue;
            };
            let of_surface = readings
                .iter()
                .filter(|p| p.z >= nearest && p.z <= farthest);
            let (mut sum, mut count) = (nalgebra::Vector3::zeros(), 0.0_f32);
            for p in of_surface {
                sum += p.coords;
                count += 1.0;
            }
            reduced.push(Point3::from(sum / count));
        }
    }
    reduced
}

/// Returns the depths of the surface that most of the ascending `depths` lie on, the nearer one in a tie; `None` if
/// these are fewer than `least`.
fn main_surface(depths: &[f32], least: usize) -> Option<&[f32]> {
    let mut best: &[f32] = &[];
    let mut end = 0;
    for (start, nearest) in depths.iter().enumerate() {
        let reach = nearest + SAME_SURFACE * nearest.abs();
        while depths.get(end).is_some_and(|depth| *depth <= reach) {
            end += 1;
        }
        if end - start > best.len() {
            best = &depths[start..end];
        }
    }
    (best.len() >= least).then_some(best)
}

fn mean(depths: &[f32]) -> f32 {
    depths.iter().sum::<f32>() / depths.len() as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    const GRID: Grid = Grid {
        width: 9,
        height: 5,
    };

    /// A picture of 9 × 5 readings with the given upper left block of 4 × 4, row by row.
    fn picture(block: [u16; 16]) -> Vec<u16> {
        let mut depth = vec![1000; GRID.num_cells()];
        for (i, units) in block.into_iter().enumerate() {
            depth[i / 4 * GRID.width + i % 4] = units;
        }
        depth
    }

    fn reduced(block: [u16; 16]) -> f32 {
        let depth = picture(block);
        let all = reduced_depths(&depth, GRID, 4, 0.001);
        // One row of two blocks; the last column and the last row fall outside complete blocks.
        assert_eq!((all.len(), all[1]), (2, 1.0));
        let points = depth.iter().map(|&units| match units {
            0 => Point3::new(f32::NAN, f32::NAN, f32::NAN),
            units => Point3::new(7.0, -3.0, f32::from(units) * 0.001),
        });
        let points = reduced_points(&points.collect::<Vec<_>>(), GRID, 4);
        assert_eq!(points.len(), 2);
        assert!(
            (points[0].z - all[0]).abs() < 1e-6 || (points[0].z.is_nan() && all[0].is_nan()),
            "a cloud is reduced as a depth image is: {} {}",
            points[0],
            all[0]
        );
        all[0]
    }

    #[test]
    fn a_block_has_the_mean_of_its_readings() {
        let mut block = [1000; 16];
        block[3] = 1016;
        assert!((reduced(block) - 1.001).abs() < 1e-6);
        // Dropouts are ignored.
        block[4..12].fill(0);
        assert!((reduced(block) - 1.002).abs() < 1e-6);
    }

    #[test]
    fn two_surfaces_are_never_mixed() {
        let mut block = [1000; 16];
        block[..9].fill(1300);
        assert!(
            (reduced(block) - 1.3).abs() < 1e-6,
            "most readings lie there"
        );
        block[8] = 1000;
        assert!((reduced(block) - 1.0).abs() < 1e-6, "of two the nearer one");
        block[8] = 1150;
        assert!(
            (reduced(block) - 1.3).abs() < 1e-6,
            "a flying pixel counts for nothing"
        );
    }

    #[test]
    fn a_few_strays_are_no_reading() {
        let mut block = [0; 16];
        assert!(reduced(block).is_nan());
        block[..3].fill(1000);
        assert!(reduced(block).is_nan());
        block[3] = 1000;
        assert!((reduced(block) - 1.0).abs() < 1e-6);
        // As many readings, each on a different surface.
        block[..4].copy_from_slice(&[1000, 1100, 1200, 1300]);
        assert!(reduced(block).is_nan());
    }

    #[test]
    fn the_quick_way_gives_what_the_slow_one_does() {
        let mut state = 7_u32;
        let mut random = |below: u32| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 8) % below
        };
        for _ in 0..2000 {
            let spread = 1 + random(30);
            let block: [u16; 16] = std::array::from_fn(|_| match random(5) {
                0 => 0,
                // Odd, so that no distance is exactly at the limit.
                _ => (1001 + 2 * random(spread)) as u16,
            });
            let mut valid: Vec<f32> = block
                .iter()
                .filter(|u| **u != 0)
                .map(|u| f32::from(*u))
                .collect();
            valid.sort_unstable_by(f32::total_cmp);
            let expected = main_surface(&valid, 4).map_or(f32::NAN, mean) * 0.001;
            let found = reduced(block);
            assert!((found - expected).abs() < 1e-6 || (found.is_nan() && expected.is_nan()));
        }
    }

    #[test]
    fn blocks_are_as_large_as_the_picture_asks_for() {
        let side = |width, height| SceneParams::default().block_side(Grid { width, height });
        assert_eq!([side(640, 480), side(848, 480), side(1, 1)], [1, 1, 1]);
        assert_eq!(
            [side(1280, 960), side(2560, 1920), side(4096, 3072)],
            [2, 4, 6]
        );
        let whole = SceneParams {
            max_pixels: usize::MAX,
        };
        assert_eq!(
            whole.block_side(Grid {
                width: 2560,
                height: 1920
            }),
            1
        );
    }
}
