//! Removes stands and hangers that touch the part: bars that are not a continuation of its surface.
//!
//! A morphological opening of the part's picture (J. Serra, "Image Analysis and Mathematical Morphology", 1982) keeps
//! everything wider than a tube. Of the rest, corners and tips are restored, and so are bars that begin in the surface they
//! touch, such as a window frame. A bar that begins a centimetre in front of or behind that surface belongs to a stand.
//!
//! Known limits: nothing is removed from a part that consists only of bars. A tube that lies in the surface beside the
//! part, or is wider than 56 mm, stays; a thin tip that is bent by a centimetre is removed.

use std::ops::Range;

use nalgebra::{Point3, Vector3};

use crate::{field_of_view::FieldOfView, scene::SceneCloud};
use geometry::{cloud::Grid, depth_frame::Intrinsics, plane::Plane};

/// Maximum half width of a tube, metres: stands are made of tubes of 20 to 50 mm.
const RADIUS_M: f32 = 0.028;
/// Half width of the gaps that are closed if an opening leaves too little, metres: the slots of a grille.
const CLOSED_M: f32 = 0.016;
/// Minimum share of the part that an opening must leave.
const LEAST_LEFT: f64 = 0.55;
/// The same if all bars are removed, and the factor by which those may be wider: two tubes side by side, or a tube
/// and its clamp.
const LEAST_BARE: f64 = 0.25;
const WIDE: f32 = 1.6;
/// Pieces left by an opening that are smaller than this share of the largest are feet and joints of the stand.
const LEAST_PIECE: f64 = 0.2;
/// A bar that ends within this distance of the body's core is a corner or a tip, metres.
const TIP_M: f32 = 0.085;
/// Distance from the start of a bar within which its surface and that of the body are compared, metres.
const NEAR_M: f32 = 0.06;
/// Minimum offset of a bar from the surface it touches to belong to a stand, metres.
const STEP_M: f64 = 0.0095;
/// A strip attached along more than this many times its reach is the folded edge of a sheet.
const FOLD: f32 = 2.5;
/// Pixels of the scene per cell of the mask, in each direction.
const CELL: usize = 2;

/// The bars to remove from a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Bars {
    /// Bars that are not a continuation of the surface they touch.
    OffSurface,
    /// All bars, even if little is left; the references decide whether they belong to the part.
    All,
    /// All bars except those between narrow slots: the slats of a grille.
    AllButSlats,
}

/// Divides a connected surface into the part and its stand; all three are ascending indices in the scene.
pub(super) fn remove_stand(scene: &SceneCloud, surface: Vec<u32>) -> (Vec<u32>, Vec<u32>) {
    let mask = Mask::of(scene, &surface);
    let divided = mask.and_then(|mask| mask.divided(&surface, Bars::OffSurface));
    divided.unwrap_or_else(|| (surface, Vec::new()))
}

/// A surface in cells of a few pixels, with a margin around it.
pub(super) struct Mask {
    grid: Grid,
    camera: Intrinsics,
    /// Column and row of the first cell.
    first: [usize; 2],
    width: usize,
    /// True where the surface is.
    is_set: Vec<bool>,
    /// True where the camera cannot see, so that the surface may continue.
    is_beyond: Vec<bool>,
    /// Depth of the surface, metres; its mean depth where there is no surface.
    depth: Vec<f32>,
    /// Side of each cell on the surface, metres.
    size: Vec<f32>,
}

/// Number of cells around the surface.
const MARGIN: usize = 4;

impl Mask {
    /// The mask of a surface, given by ascending indices; `None` without a picture, or if its pixels are too coarse.
    pub(super) fn of(scene: &SceneCloud, surface: &[u32]) -> Option<Self> {
        let (grid, camera) = scene.cloud.grid.zip(scene.intrinsics)?;
        let points = &scene.cloud.points;
        let (mut low, mut high) = ([usize::MAX; 2], [0; 2]);
        let mut sum = 0.0_f64;
        for (row, start, pixels) in grid.by_row(surface) {
            let ends = [pixels[0], pixels[pixels.len() - 1]];
            for column in ends.map(|i| i as usize - start) {
                for (axis, at) in [column / CELL, row / CELL].into_iter().enumerate() {
                    low[axis] = low[axis].min(at);
                    high[axis] = high[axis].max(at);
                }
            }
            for &i in pixels {
                sum += f64::from(points[i as usize].z);
            }
        }
        let mean = (sum / surface.len() as f64) as f32;
        // Give up if half a tube's width is less than a cell.
        let radius = RADIUS_M * camera.fx as f32 / mean / CELL as f32;
        if surface.is_empty() || !(radius >= 1.0) {
            return None;
        }
        let first = low.map(|at| at.saturating_sub(MARGIN));
        let [width, height] = [0, 1].map(|axis| high[axis] + MARGIN + 1 - first[axis]);
        let num = width * height;
        let mut mask = Self {
            grid,
            camera,
            first,
            width,
            is_set: vec![false; num],
            is_beyond: vec![false; num],
            depth: vec![mean; num],
            size: Vec::new(),
        };
        for (row, start, pixels) in grid.by_row(surface) {
            let cells = mask.cells_of(row);
            let (is_set, depth) = (&mut mask.is_set[cells.clone()], &mut mask.depth[cells]);
            for &i in pixels {
                let column = (i as usize - start) / CELL - first[0];
                is_set[column] = true;
                depth[column] = points[i as usize].z;
            }
        }
        let size = |depth: &f32| depth / camera.fx as f32 * CELL as f32;
        mask.size = mask.depth.iter().map(size).collect();
        if let Some(view) = scene.field_of_view() {
            mask.mark_beyond(view);
        }
        Some(mask)
    }

    /// Divides the surface that the mask was made of; `None` if no such bars touch it.
    pub(super) fn divided(&self, surface: &[u32], bars: Bars) -> Option<(Vec<u32>, Vec<u32>)> {
        let stand = self.stand(bars)?;
        let (mut part, mut off) = (Vec::with_capacity(surface.len()), Vec::new());
        for (row, start, pixels) in self.grid.by_row(surface) {
            let is_off = &stand[self.cells_of(row)];
            for &i in pixels {
                let column = (i as usize - start) / CELL - self.first[0];
                if is_off[column] { &mut off } else { &mut part }.push(i);
            }
        }
        Some((part, off))
    }

    fn mark_beyond(&mut self, view: &FieldOfView) {
        for at in (0..self.is_set.len()).filter(|at| !self.is_set[*at]) {
            let [u, v] = self.pixel_of(at);
            self.is_beyond[at] = !view.contains(u as i64, v as i64) || view.ends_at(u, v, 0);
        }
    }

    /// The cells of a row of the picture.
    fn cells_of(&self, row: usize) -> Range<usize> {
        let start = (row / CELL - self.first[1]) * self.width;
        start..start + self.width
    }

    /// Returns the first pixel of a cell.
    fn pixel_of(&self, cell: usize) -> [usize; 2] {
        let (column, row) = (cell % self.width, cell / self.width);
        [
            (column + self.first[0]) * CELL,
            (row + self.first[1]) * CELL,
        ]
    }

    fn point(&self, cell: usize) -> Point3<f64> {
        let [u, v] = self.pixel_of(cell);
        self.camera
            .point_at(u as f64, v as f64, f64::from(self.depth[cell]))
    }

    /// Returns the cells that belong to a stand; `None` if there are none.
    fn stand(&self, bars: Bars) -> Option<Vec<bool>> {
        let (half_width, tip, least_left) = match bars {
            Bars::OffSurface => (RADIUS_M, TIP_M, LEAST_LEFT),
            Bars::All | Bars::AllButSlats => (WIDE * RADIUS_M, WIDE * TIP_M, LEAST_BARE),
        };
        let num = count(&self.is_set);
        let opened = |filled: &[bool]| {
            let (core, left) = self.opened(filled, half_width);
            (count(&left) >= least_left * num).then_some((core, left))
        };
        let as_it_is = match bars {
            Bars::OffSurface | Bars::All => opened(&self.is_set),
            Bars::AllButSlats => None,
        };
        let (core, left) = as_it_is.or_else(|| opened(&self.closed()))?;
        let pieces = self.components(&left);
        let largest = pieces.iter().map(Vec::len).max()? as f64;
        let mut body = vec![false; left.len()];
        for &cell in pieces
            .iter()
            .filter(|piece| piece.len() as f64 >= LEAST_PIECE * largest)
            .flatten()
        {
            body[cell] = true;
        }
        let is_off = |i: usize| self.is_set[i] && !body[i];
        let off: Vec<bool> = (0..body.len()).map(is_off).collect();
        let body_core: Vec<bool> = core.iter().zip(&body).map(|(a, b)| *a && *b).collect();
        let from_core = distances(&body_core, self.width);
        let mut stand = vec![false; body.len()];
        for bar in self.components(&off) {
            let reach = bar.iter().map(|&i| from_core[i] * self.size[i]);
            let reach = reach.fold(0.0, f32::max);
            if reach > tip
                && (bars != Bars::OffSurface || self.is_of_a_stand(&bar, &off, &body, reach))
            {
                for cell in bar {
                    stand[cell] = true;
                }
            }
        }
        stand.contains(&true).then_some(stand)
    }

    /// Returns true if a bar is not a continuation of the surface of the body that it touches.
    fn is_of_a_stand(&self, bar: &[usize], off: &[bool], body: &[bool], reach: f32) -> bool {
        let is_beside = |cell: &usize| self.neighbours(*cell).any(|beside| body[beside]);
        let touching: Vec<usize> = bar.iter().copied().filter(is_beside).collect();
        let Some(&first) = touching.first() else {
            // Connected only across pixels without a reading.
            return true;
        };
        let size = self.size[first];
        if touching.len() as f32 * size > FOLD * reach {
            return false;
        }
        let steps = (NEAR_M / size) as usize;
        let own = self.around(&touching, off, steps);
        let beside = self.around(&touching, body, steps);
        let Some(surface) = Plane::fit(beside.iter().map(|&i| (self.point(i), 1.0))) else {
            return true;
        };
        let sum: Vector3<f64> = own.iter().map(|&i| self.point(i).coords).sum();
        let middle = Point3::from(sum / own.len() as f64);
        surface.signed_distance(&middle).abs() > STEP_M
    }

    /// Returns the cells of the core, which is wider than a tube, and the cells of the surface around them.
    fn opened(&self, filled: &[bool], half_width: f32) -> (Vec<bool>, Vec<bool>) {
        let gaps = filled.iter().zip(&self.is_beyond);
        let is_gap: Vec<bool> = gaps.map(|(filled, beyond)| !filled && !beyond).collect();
        let from_gap = distances(&is_gap, self.width);
        let core: Vec<bool> = (filled.iter().zip(&from_gap).zip(&self.size))
            .map(|((filled, from_gap), size)| *filled && (from_gap * size > half_width))
            .collect();
        let from_core = distances(&core, self.width);
        // One cell more than the radius, because distances are measured between cell centres.
        let left = (self.is_set.iter().zip(&from_core).zip(&self.size))
            .map(|((set, from_core), size)| *set && ((from_core - 1.0) * size <= half_width))
            .collect();
        (core, left)
    }

    /// Returns the surface with its narrow gaps filled.
    fn closed(&self) -> Vec<bool> {
        let is_far = |(distance, size): (f32, &f32)| distance * size > CLOSED_M;
        let from_set = distances(&self.is_set, self.width);
        let far: Vec<bool> = from_set.into_iter().zip(&self.size).map(is_far).collect();
        let from_far = distances(&far, self.width);
        let is_near_enough = from_far.into_iter().zip(&self.size).map(is_far);
        (self.is_set.iter().zip(is_near_enough))
            .map(|(set, near)| *set || near)
            .collect()
    }

    /// The way to each neighbour of a cell.
    fn steps(&self) -> [isize; 8] {
        let width = self.width as isize;
        [
            -width - 1,
            -width,
            -width + 1,
            -1,
            1,
            width - 1,
            width,
            width + 1,
        ]
    }

    fn neighbours(&self, cell: usize) -> impl Iterator<Item = usize> + use<> {
        let num = self.is_set.len();
        let beside = self.steps().into_iter();
        let beside = beside.filter_map(move |step| cell.checked_add_signed(step));
        beside.filter(move |beside| *beside < num)
    }

    /// Returns the connected components of a set of cells.
    fn components(&self, cells: &[bool]) -> Vec<Vec<usize>> {
        let steps = self.steps();
        let mut left = cells.to_vec();
        let mut pieces = Vec::new();
        for start in 0..left.len() {
            if std::mem::take(&mut left[start]) {
                let mut piece = vec![start];
                let mut at = 0;
                while let Some(&cell) = piece.get(at) {
                    at += 1;
                    for step in steps {
                        // What wraps around lies beyond the last cell, too.
                        let beside = cell.wrapping_add_signed(step);
                        if left.get_mut(beside).is_some_and(std::mem::take) {
                            piece.push(beside);
                        }
                    }
                }
                pieces.push(piece);
            }
        }
        pieces
    }

    /// Returns the cells of a set within `num_steps` steps of the start cells, moving only inside the set.
    fn around(&self, start: &[usize], cells: &[bool], num_steps: usize) -> Vec<usize> {
        let mut is_new = cells.to_vec();
        let mut found: Vec<usize> = Vec::new();
        let mut last: Vec<usize> = start.to_vec();
        for _ in 0..num_steps {
            let beside = last.iter().flat_map(|&cell| self.neighbours(cell));
            last = beside.filter(|i| std::mem::take(&mut is_new[*i])).collect();
            found.extend(&last);
        }
        found
    }
}

/// Returns the distance of each cell to the nearest true one, in cells: chamfer 3-4 (G. Borgefors, "Distance
/// transformations in digital images", Computer Vision, Graphics, and Image Processing 34(3), 1986).
pub(super) fn distances(to: &[bool], width: usize) -> Vec<f32> {
    // The smallest type: it takes the fewest instructions.
    let mut third: Vec<i16> = to.iter().map(|is| if *is { 0 } else { i16::MAX }).collect();
    let height = to.len() / width;
    for row in 1..height {
        let (above, from_row) = third.split_at_mut(row * width);
        let row = &mut from_row[..width];
        lower_to_neighbours(row, &above[above.len() - width..]);
        let first = row[0];
        lower_along(row[1..width - 1].iter_mut(), first);
    }
    for row in (0..height - 1).rev() {
        let (to_row, below) = third.split_at_mut((row + 1) * width);
        let row = &mut to_row[row * width..];
        lower_to_neighbours(row, &below[..width]);
        let first = row[width - 1];
        lower_along(row[1..width - 1].iter_mut().rev(), first);
    }
    third
        .into_iter()
        .map(|third| f32::from(third) / 3.0)
        .collect()
}

/// Lowers distances to what each one's predecessor allows, starting from `first`.
fn lower_along<'a>(row: impl Iterator<Item = &'a mut i16>, first: i16) {
    // In 32 bits there is nothing to saturate.
    let mut before = i32::from(first);
    for at in row {
        before = (before + 3).min(i32::from(*at));
        *at = before as i16;
    }
}

/// Lowers the distances of a row, in thirds of a cell, to what those of the row beside it allow. The outermost cells are margin
/// and lack some neighbours.
fn lower_to_neighbours(row: &mut [i16], beside: &[i16]) {
    let inner = row.len() - 1;
    for (at, beside) in row[1..inner].iter_mut().zip(beside.windows(3)) {
        let straight = beside[1].saturating_add(3);
        let diagonal = beside[0].min(beside[2]).saturating_add(4);
        *at = (*at).min(straight).min(diagonal);
    }
}

fn count(cells: &[bool]) -> f64 {
    cells.iter().filter(|is_set| **is_set).count() as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use geometry::cloud::PointCloud;

    const CAMERA: Intrinsics = Intrinsics::KINECT;

    /// Simulates a sheet of 0.6 m by 0.4 m with a window frame above it, and a tube of 40 mm that begins at the
    /// distance `behind` behind the sheet's lower edge and goes down; the flags are true on the tube.
    fn on_a_stand(behind: f64) -> (SceneCloud, Vec<bool>) {
        let mut is_tube = Vec::new();
        let points = (0..CAMERA.width * CAMERA.height).map(|i| {
            let at = CAMERA.point_at((i % CAMERA.width) as f64, (i / CAMERA.width) as f64, 1.2);
            let on_sheet = at.x.abs() < 0.3 && (-0.1..0.3).contains(&at.y);
            let in_frame = at.x.abs() < 0.3 && (-0.3..-0.1).contains(&at.y);
            let in_window = at.x.abs() < 0.255 && at.y > -0.255;
            let on_tube = at.x.abs() < 0.02 && (0.3..0.5).contains(&at.y);
            is_tube.push(on_tube);
            let z = match (on_sheet || in_frame && !in_window, on_tube) {
                (true, _) => 1.2,
                // The tube leans away from the sheet.
                (_, true) => 1.2 + behind + (at.y - 0.3) * 0.3,
                _ => f64::NAN,
            };
            (at * (z / 1.2)).cast()
        });
        let cloud = PointCloud {
            points: points.collect(),
            grid: Some(Grid {
                width: CAMERA.width,
                height: CAMERA.height,
            }),
            ..PointCloud::default()
        };
        (SceneCloud::new(cloud, Some(CAMERA)), is_tube)
    }

    fn taken_off(scene: &SceneCloud) -> (Vec<u32>, Vec<u32>) {
        let surface = scene.cloud.finite().map(|(i, _)| i as u32).collect();
        remove_stand(scene, surface)
    }

    #[test]
    fn a_tube_behind_the_sheet_is_taken_off_and_the_frame_of_a_window_is_not() {
        let (scene, is_tube) = on_a_stand(0.006);
        let (part, stand) = taken_off(&scene);
        assert!(stand.iter().all(|i| is_tube[*i as usize]));
        let num_tube = scene.cloud.finite().filter(|(i, _)| is_tube[*i]).count();
        assert!(
            stand.len() as f64 > 0.75 * num_tube as f64,
            "{} of {num_tube}",
            stand.len()
        );
        assert_eq!(part.len() + stand.len(), scene.cloud.num_finite());
    }

    #[test]
    fn a_part_of_bars_and_a_part_alone_stay_whole() {
        let (mut scene, is_tube) = on_a_stand(0.006);
        for (p, is_tube) in scene.cloud.points.iter_mut().zip(&is_tube) {
            if *is_tube {
                *p = Point3::new(f32::NAN, f32::NAN, f32::NAN);
            }
        }
        assert!(taken_off(&scene).1.is_empty());
        for p in &mut scene.cloud.points {
            // Bars of 2 cm, 8 cm apart: nothing is wider than a tube, and no gap is closed.
            if (p.x * 100.0).rem_euclid(10.0) > 2.0 && (p.y * 100.0).rem_euclid(10.0) > 2.0 {
                *p = Point3::new(f32::NAN, f32::NAN, f32::NAN);
            }
        }
        assert!(taken_off(&scene).1.is_empty());
    }
}
