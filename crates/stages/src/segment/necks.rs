//! Cuts a surface where it is narrow: parts that touch are joined there.
//!
//! An erosion of the surface's picture (J. Serra, "Image Analysis and Mathematical Morphology", 1982) leaves its wide
//! places; what belongs to each grows back from it. Steps of the depth count as ends of the surface.
//!
//! Known limits: parts that touch along more than they are wide stay joined, unless there is a step of the depth.

use super::{clusters::Link, stand::distances};
use crate::scene::SceneCloud;
use geometry::cloud::Grid;

/// Half widths of the necks at which a surface is cut, pixels.
pub(super) const HALF_WIDTHS_PIXELS: [f32; 6] = [0.0, 1.0, 2.0, 4.0, 8.0, 12.0];
/// Wide places smaller than this are bumps, pixels.
const MIN_CORE: usize = 100;

/// The picture of a surface.
pub(super) struct Silhouette {
    /// Indices of the surface's points in the scene, ascending.
    surface: Vec<u32>,
    /// Pixel of each of them in the picture, which has a margin of a pixel on every side.
    pixels: Vec<usize>,
    width: usize,
    is_set: Vec<bool>,
    /// Distance of each pixel to the nearest end of the surface, pixels.
    from_end: Vec<f32>,
}

impl Silhouette {
    /// Takes the picture of a surface, given by ascending indices; it ends where `link` does not join neighbours.
    pub(super) fn new(scene: &SceneCloud, grid: Grid, surface: Vec<u32>, link: Link) -> Self {
        let (mut left, mut right) = (usize::MAX, 0);
        let (mut top, mut bottom) = (usize::MAX, 0);
        for (row, start, of_row) in grid.by_row(&surface) {
            left = left.min(of_row[0] as usize - start);
            right = right.max(of_row[of_row.len() - 1] as usize - start);
            top = top.min(row);
            bottom = row;
        }
        let width = (right + 3).saturating_sub(left);
        let height = (bottom + 3).saturating_sub(top);
        let mut pixels = Vec::with_capacity(surface.len());
        for (row, start, of_row) in grid.by_row(&surface) {
            let first = (row + 1 - top) * width + 1;
            pixels.extend(of_row.iter().map(|i| first + *i as usize - start - left));
        }
        let mut is_set = vec![false; width * height];
        for &pixel in &pixels {
            is_set[pixel] = true;
        }
        let mut is_end: Vec<bool> = is_set.iter().map(|is_set| !is_set).collect();
        let points = &scene.cloud.points;
        for (&i, &pixel) in surface.iter().zip(&pixels) {
            let i = i as usize;
            for (j, beside) in [(i + 1, pixel + 1), (i + grid.width, pixel + width)] {
                if is_set[beside] && !link.joins(&points[i], &points[j]) {
                    is_end[pixel] = true;
                    is_end[beside] = true;
                }
            }
        }
        Self {
            from_end: distances(&is_end, width),
            surface,
            pixels,
            width,
            is_set,
        }
    }

    /// Cuts the surface at necks up to twice as wide as `half_width`, and returns the indices of each piece, ascending. What
    /// no piece grows to is left out.
    pub(super) fn cut(&self, half_width: f32) -> Vec<Vec<u32>> {
        let mut piece_of = vec![NO_PIECE; self.is_set.len()];
        let mut num_pieces = 0;
        let mut cores = Vec::with_capacity(self.pixels.len());
        let is_core = |pixel: usize| self.from_end[pixel] > half_width;
        for &pixel in &self.pixels {
            if piece_of[pixel] == NO_PIECE && is_core(pixel) {
                let first = cores.len();
                piece_of[pixel] = num_pieces;
                cores.push(pixel);
                self.grow(&mut cores, first, &mut piece_of, is_core);
                if cores.len() - first < MIN_CORE {
                    for pixel in cores.drain(first..) {
                        piece_of[pixel] = BUMP;
                    }
                } else {
                    num_pieces += 1;
                }
            }
        }
        for piece in &mut piece_of {
            if *piece == BUMP {
                *piece = NO_PIECE;
            }
        }
        self.grow(&mut cores, 0, &mut piece_of, |pixel| self.is_set[pixel]);
        let mut pieces = vec![Vec::new(); num_pieces as usize];
        for (&i, &pixel) in self.surface.iter().zip(&self.pixels) {
            if let Some(piece) = pieces.get_mut(piece_of[pixel] as usize) {
                piece.push(i);
            }
        }
        pieces
    }

    /// Adds to the pixels from `first` on those around them, the nearest first, and gives them the same piece.
    fn grow(
        &self,
        pixels: &mut Vec<usize>,
        first: usize,
        piece_of: &mut [u32],
        may_grow_to: impl Fn(usize) -> bool,
    ) {
        let w = self.width as isize;
        let mut at = first;
        while let Some(&pixel) = pixels.get(at) {
            at += 1;
            for step in [-w - 1, -w, 1 - w, -1, 1, w - 1, w, w + 1] {
                // The margin is not set.
                let beside = pixel.wrapping_add_signed(step);
                if piece_of[beside] == NO_PIECE && may_grow_to(beside) {
                    piece_of[beside] = piece_of[pixel];
                    pixels.push(beside);
                }
            }
        }
    }
}

const NO_PIECE: u32 = u32::MAX;
const BUMP: u32 = u32::MAX - 1;

#[cfg(test)]
mod tests {
    use nalgebra::Point3;

    use super::*;
    use crate::segment::SegmentParams;
    use geometry::{cloud::PointCloud, units::Metres};

    const GRID: Grid = Grid {
        width: 200,
        height: 80,
    };

    /// Numbers of pixels of the pieces of a surface 1 m away, cut at necks up to twice as wide as `half_width`.
    fn cut(half_width: f32, depth: impl Fn(usize, usize) -> Option<f32>) -> Vec<usize> {
        let point = |i: usize| match depth(i % GRID.width, i / GRID.width) {
            Some(z) => {
                let [u, v] = [i % GRID.width, i / GRID.width].map(|at| at as f32 * 0.002);
                Point3::new(u, v, z)
            }
            None => Point3::new(f32::NAN, f32::NAN, f32::NAN),
        };
        let cloud = PointCloud {
            points: (0..GRID.num_cells()).map(point).collect(),
            grid: Some(GRID),
            ..PointCloud::default()
        };
        let surface = cloud.finite().map(|(i, _)| i as u32).collect();
        let scene = SceneCloud::new(cloud, None);
        let link = Link::new(&scene, Metres(0.0), &SegmentParams::default());
        let silhouette = Silhouette::new(&scene, GRID, surface, link);
        let pieces = silhouette.cut(half_width);
        pieces.iter().map(Vec::len).collect()
    }

    /// Two squares of 60 pixels, with a bridge of this many rows and ten columns between them.
    fn bridged(rows: usize) -> impl Fn(usize, usize) -> Option<f32> {
        move |u, v| {
            let in_square =
                (10..70).contains(&v) && ((20..80).contains(&u) || (90..150).contains(&u));
            let in_bridge = (30..30 + rows).contains(&v) && (80..90).contains(&u);
            (in_square || in_bridge).then_some(1.0)
        }
    }

    #[test]
    fn a_surface_is_cut_at_the_middle_of_its_necks_and_nowhere_else() {
        for (rows, too_little, enough) in [(3, 1.0, 2.0), (7, 2.0, 4.0), (20, 8.0, 12.0)] {
            assert_eq!(cut(too_little, bridged(rows)), [7200 + 10 * rows], "{rows}");
            let half = 3600 + 5 * rows;
            let halves = cut(enough, bridged(rows));
            assert!(
                halves.len() == 2 && halves.iter().all(|n| n.abs_diff(half) <= rows),
                "{rows}: {halves:?}"
            );
        }
        // Apart, but near enough to be taken for one surface; what lies alone and is small belongs to neither.
        let speck = |u, v| ((160..165).contains(&u) && v < 5).then_some(1.0);
        let apart = |u, v| bridged(0)(u, v).or_else(|| speck(u, v));
        assert_eq!(cut(0.0, apart), [3600, 3600]);
    }

    #[test]
    fn a_step_of_the_depth_is_an_end() {
        let wide = |u: usize, v: usize| {
            let z = if u < 75 { 1.0 } else { 1.05 };
            ((10..70).contains(&v) && (20..150).contains(&u)).then_some(z)
        };
        let pieces = cut(1.0, wide);
        assert_eq!(pieces, [55 * 60, 75 * 60]);
    }
}
