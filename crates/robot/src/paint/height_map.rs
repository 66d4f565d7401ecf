//! The surface as heights over the plane that faces the gun; rows are laid out on it.
//!
//! Each cell holds the height and slope of a plane fitted to the points around it. Their weights are a sum of three
//! Gaussians, each twice as wide as the previous one, with a fiftieth of its weight. Within the surface the narrow one
//! dominates and smooths out ribs and noise; beyond an edge or over an opening the wide ones continue the surface, so
//! that rows run straight out over the edge.
//!
//! Known limits: one height per cell. Of folded sheet the upper layer counts.

use nalgebra::{Matrix2, Point3, Vector2, Vector3};

use super::{coat::Coat, error::PaintError, region::KeepOuts, surface::PaintSurface};
use geometry::parallel::{map_each, num_cores};

/// Most cells of a map; smaller cells show nothing more of a part.
const MAX_CELLS: f64 = 1_000_000.0;
/// Points this far below the highest one of their cell belong to another layer, metres.
const LAYER_DEPTH_M: f64 = 0.025;
/// Weight of each Gaussian relative to the one half as wide.
const SCALE_WEIGHT: f64 = 0.02;
const NUM_SCALES: usize = 3;
/// Moments of the points of a cell: number, u, v, h, uu, uv, vv, uh, vh.
type Moments = [f64; 9];

/// Heights over a plane. Map coordinates: u along the rows, v across them, w towards the gun.
#[derive(Clone, Debug)]
pub(super) struct HeightMap {
    origin: Point3<f64>,
    /// Unit vectors of u, v and w in part space.
    axes: [Vector3<f64>; 3],
    pub(super) low: [f64; 2],
    pub(super) size: [usize; 2],
    /// Side of a cell, metres.
    pub(super) cell: f64,
    /// Cells with surface that is to be painted.
    pub(super) is_painted: Vec<bool>,
    /// Distance to the nearest painted cell, metres.
    pub(super) outside: Vec<f64>,
    /// Smoothed height, metres.
    pub(super) height: Vec<f64>,
    slope: Vec<[f64; 2]>,
}

/// The smoothed surface at one place.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spot {
    /// Position, part space.
    pub(super) at: Point3<f64>,
    /// Unit normal, part space.
    pub(super) normal: Vector3<f64>,
}

impl HeightMap {
    /// Maps a surface for a coat; `axes` are those of [`Self::axes_of`]. Points in keep-out regions are not painted.
    /// Openings too narrow for a circle of the coat's diameter `opening` are painted over.
    pub(super) fn new(
        surface: &PaintSurface,
        axes: [Vector3<f64>; 3],
        coat: &Coat,
        keep_outs: &KeepOuts<'_>,
    ) -> Result<Self, PaintError> {
        // Rows extend beyond the surface by no more than this.
        let reach = coat.overrun + coat.lead + coat.spacing;
        let of = |p: &Point3<f64>| Self::in_axes(surface, &axes, p);
        let points: Vec<[f64; 3]> = surface.points.iter().map(of).collect();
        let bound = |axis: usize, pick: fn(f64, f64) -> f64| {
            points.iter().map(|p| p[axis]).reduce(pick).unwrap_or(0.0)
        };
        let extent = [0, 1].map(|axis| bound(axis, f64::max) - bound(axis, f64::min) + 2.0 * reach);
        let cell = (1.25 * surface.spacing).max((extent[0] * extent[1] / MAX_CELLS).sqrt());
        let pad = (reach / cell).ceil() as usize + 2;
        let low = [0, 1].map(|axis| bound(axis, f64::min) - pad as f64 * cell);
        let size = [0, 1]
            .map(|axis| ((bound(axis, f64::max) - low[axis]) / cell).round() as usize + pad + 1);
        let num = size[0] * size[1];
        let mut map = Self {
            origin: surface.middle,
            axes,
            low,
            size,
            cell,
            is_painted: vec![false; num],
            outside: Vec::new(),
            height: vec![0.0; num],
            slope: vec![[0.0; 2]; num],
        };
        // Height of the highest point of each cell.
        let mut tops: Vec<Option<f64>> = vec![None; num];
        for p in &points {
            let top = &mut tops[cell_of(low, cell, size, [p[0], p[1]])];
            *top = Some(top.map_or(p[2], |top: f64| top.max(p[2])));
        }
        let mut moments: Vec<Moments> = vec![[0.0; 9]; num];
        for (p, at) in points.iter().zip(&surface.points) {
            let index = cell_of(low, cell, size, [p[0], p[1]]);
            if tops[index].is_some_and(|top| p[2] < top - LAYER_DEPTH_M) {
                continue;
            }
            let [u, v, h] = *p;
            for (sum, term) in
                moments[index]
                    .iter_mut()
                    .zip([1.0, u, v, h, u * u, u * v, v * v, u * h, v * h])
            {
                *sum += term;
            }
            map.is_painted[index] |= keep_outs.distance(at, [u, v]) >= 0.0;
        }
        map.close_gaps();
        map.fill_openings(coat.opening);
        map.outside = distances(&map.is_painted, size, cell);
        map.fit_planes(&moments, coat.smoothing / 2.0)?;
        Ok(map)
    }

    /// u, v and w in part space, for rows along a direction.
    pub(super) fn axes_of(surface: &PaintSurface, along: &Vector3<f64>) -> [Vector3<f64>; 3] {
        let w = surface.side;
        let u = (along - w * w.dot(along)).normalize();
        [u, w.cross(&u), w]
    }

    /// Map coordinates of a point in part space.
    pub(super) fn in_axes(
        surface: &PaintSurface,
        axes: &[Vector3<f64>; 3],
        p: &Point3<f64>,
    ) -> [f64; 3] {
        axes.map(|axis| axis.dot(&(p - surface.middle)))
    }

    fn part_from_map(&self, [u, v, w]: [f64; 3]) -> Point3<f64> {
        self.origin + self.axes[0] * u + self.axes[1] * v + self.axes[2] * w
    }

    pub(super) fn index(&self, column: usize, row: usize) -> usize {
        row * self.size[0] + column
    }

    /// Middle of a cell.
    pub(super) fn place(&self, column: usize, row: usize) -> [f64; 2] {
        [
            self.low[0] + column as f64 * self.cell,
            self.low[1] + row as f64 * self.cell,
        ]
    }

    /// The four cells around a place, with their weights.
    fn around(&self, at: [f64; 2]) -> [(usize, f64); 4] {
        let [(i, a), (j, b)] = [0, 1].map(|axis| {
            let last = (self.size[axis] - 2) as f64;
            let x = ((at[axis] - self.low[axis]) / self.cell).clamp(0.0, last + 1.0);
            let first = x.floor().min(last);
            (first as usize, x - first)
        });
        [
            (self.index(i, j), (1.0 - a) * (1.0 - b)),
            (self.index(i + 1, j), a * (1.0 - b)),
            (self.index(i, j + 1), (1.0 - a) * b),
            (self.index(i + 1, j + 1), a * b),
        ]
    }

    /// Distance of a place from the nearest painted cell, metres.
    pub(super) fn outside_at(&self, at: [f64; 2]) -> f64 {
        self.around(at)
            .iter()
            .map(|(i, share)| self.outside[*i] * share)
            .sum()
    }

    /// The smoothed surface at a place.
    pub(super) fn spot(&self, at: [f64; 2]) -> Spot {
        let (mut height, mut slope) = (0.0, [0.0; 2]);
        for (i, share) in self.around(at) {
            height += self.height[i] * share;
            slope = [0, 1].map(|axis| slope[axis] + self.slope[i][axis] * share);
        }
        let [u, v, w] = self.axes;
        Spot {
            at: self.part_from_map([at[0], at[1], height]),
            normal: (w - u * slope[0] - v * slope[1]).normalize(),
        }
    }

    /// Paints cells between two painted ones, which are gaps between points.
    fn close_gaps(&mut self) {
        let [width, height] = self.size;
        let before = self.is_painted.clone();
        for row in 1..height - 1 {
            for column in 1..width - 1 {
                let i = self.index(column, row);
                let between = [1, width, width + 1, width - 1];
                self.is_painted[i] |= between.iter().any(|d| before[i - d] && before[i + d]);
            }
        }
    }

    /// Paints over enclosed openings that are too narrow for a circle of this diameter.
    fn fill_openings(&mut self, diameter: f64) {
        let outside = distances(&self.is_painted, self.size, self.cell);
        let mut is_seen = self.is_painted.clone();
        for start in 0..is_seen.len() {
            if is_seen[start] {
                continue;
            }
            is_seen[start] = true;
            let (mut opening, mut next) = (vec![start], 0);
            let (mut widest, mut is_enclosed) = (0.0_f64, true);
            while let Some(&i) = opening.get(next) {
                next += 1;
                widest = widest.max(outside[i]);
                let [column, row] = [i % self.size[0], i / self.size[0]];
                let is_rim = |x: usize, axis: usize| x == 0 || x + 1 == self.size[axis];
                if is_rim(column, 0) || is_rim(row, 1) {
                    is_enclosed = false;
                    continue;
                }
                for other in [i - 1, i + 1, i - self.size[0], i + self.size[0]] {
                    if !is_seen[other] {
                        is_seen[other] = true;
                        opening.push(other);
                    }
                }
            }
            // From the middle of the opening, the middles of painted cells are half a cell farther than the edge.
            if is_enclosed && 2.0 * widest - self.cell < diameter {
                for i in opening {
                    self.is_painted[i] = true;
                }
            }
        }
    }

    /// Fits height and slope of every cell; `sigma` is the standard deviation of the narrowest Gaussian, metres.
    fn fit_planes(&mut self, moments: &[Moments], sigma: f64) -> Result<(), PaintError> {
        let blurred = map_each(9, num_cores(), |which| {
            let image: Vec<f64> = moments.iter().map(|m| m[which]).collect();
            let total: f64 = image.iter().sum();
            // So small that it only matters where no point is in reach.
            let mut sum = vec![total * 1e-12; image.len()];
            for scale in 0..NUM_SCALES {
                let weight = SCALE_WEIGHT.powi(scale as i32);
                let sigma = (sigma / self.cell * f64::from(1 << scale)).max(0.5);
                for (sum, value) in sum.iter_mut().zip(blur(&image, self.size, sigma)) {
                    *sum += weight * value;
                }
            }
            sum
        });
        for row in 0..self.size[1] {
            for column in 0..self.size[0] {
                let i = self.index(column, row);
                let [n, su, sv, sh, suu, suv, svv, sum_uh, sum_vh]: Moments =
                    std::array::from_fn(|which| blurred[which][i]);
                let (u, v, h) = (su / n, sv / n, sh / n);
                // Keeps the slope finite where all points in reach lie on a line.
                let steady = (0.1 * sigma).powi(2);
                let spread = Matrix2::new(
                    suu / n - u * u + steady,
                    suv / n - u * v,
                    suv / n - u * v,
                    svv / n - v * v + steady,
                );
                let rise = Vector2::new(sum_uh / n - u * h, sum_vh / n - v * h);
                let slope = spread.lu().solve(&rise).ok_or(PaintError::Folded)?;
                let at = self.place(column, row);
                self.slope[i] = [slope.x, slope.y];
                self.height[i] = h + slope.x * (at[0] - u) + slope.y * (at[1] - v);
            }
        }
        Ok(())
    }
}

fn cell_of(low: [f64; 2], cell: f64, size: [usize; 2], at: [f64; 2]) -> usize {
    let [column, row] =
        [0, 1].map(|axis| (((at[axis] - low[axis]) / cell).round() as usize).min(size[axis] - 1));
    row * size[0] + column
}

/// Distance of each cell's middle to the middle of the nearest set one, less half a cell; 0 in set ones.
fn distances(is_set: &[bool], [width, height]: [usize; 2], cell: f64) -> Vec<f64> {
    let far = (width + height) as f64;
    // Exact: along the columns first, then the nearest over each row.
    let mut along = vec![far; is_set.len()];
    for column in 0..width {
        let mut last = far;
        for row in (0..height).chain((0..height).rev()) {
            let i = row * width + column;
            last = if is_set[i] { 0.0 } else { last + 1.0 };
            along[i] = along[i].min(last);
        }
    }
    let rows = map_each(height, num_cores(), |row| {
        let along = &along[row * width..(row + 1) * width];
        let each = (0..width).map(|column| {
            let mut best = along[column] * along[column];
            for step in 1..width {
                let squared = (step * step) as f64;
                if squared >= best {
                    break;
                }
                let mut consider = |other: f64| best = best.min(squared + other * other);
                if column >= step {
                    consider(along[column - step]);
                }
                if column + step < width {
                    consider(along[column + step]);
                }
            }
            (best.sqrt() - 0.5).max(0.0) * cell
        });
        each.collect::<Vec<f64>>()
    });
    rows.concat()
}

/// Gaussian sums over neighbouring cells, sigma in cells; not normalised, so that empty cells add nothing.
fn blur(image: &[f64], [width, height]: [usize; 2], sigma: f64) -> Vec<f64> {
    let reach = (3.5 * sigma).ceil() as usize;
    let kernel: Vec<f64> = (0..=reach)
        .map(|i| (-0.5 * (i as f64 / sigma).powi(2)).exp())
        .collect();
    let around = |i: usize, len: usize| i.saturating_sub(reach)..(i + reach + 1).min(len);
    let mut along = vec![0.0; image.len()];
    for (from, to) in image.chunks(width).zip(along.chunks_mut(width)) {
        for (i, value) in from.iter().enumerate() {
            // Most cells have no point.
            if *value == 0.0 {
                continue;
            }
            for j in around(i, width) {
                to[j] += value * kernel[i.abs_diff(j)];
            }
        }
    }
    // Whole rows, as their cells are adjacent in memory.
    let mut both = vec![0.0; image.len()];
    for (i, from) in along.chunks(width).enumerate() {
        for j in around(i, height) {
            let factor = kernel[i.abs_diff(j)];
            let to = &mut both[j * width..][..width];
            for (to, value) in to.iter_mut().zip(from) {
                *to += value * factor;
            }
        }
    }
    both
}
