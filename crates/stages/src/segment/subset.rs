//! A few thousand points of the scene, on which planes are searched.

use nalgebra::Point3;
use rand::RngExt as _;
use rand_pcg::Pcg64;

use super::SegmentParams;
use crate::scene::SceneCloud;
use geometry::{
    cloud::{Grid, is_finite},
    units::Metres,
};

/// Number of points on which planes are searched: 5 000 fix a wall to a fraction of a millimetre and fit in the cache.
const SUBSET_SIZE: usize = 5_000;
/// A thinned-out scene, stored as arrays per coordinate for fast inlier counting.
pub(super) struct Subset {
    pub(super) x: Vec<f32>,
    pub(super) y: Vec<f32>,
    pub(super) z: Vec<f32>,
    /// Maximum distance to a plane at perpendicular view for the point to belong to it, metres.
    pub(super) reach: Vec<f32>,
    /// Grid of the subset if the scene is organised.
    pub(super) cells: Option<Cells>,
}

/// Shape of the region from which a sample's other points are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Neighbourhood {
    /// As wide as it is high.
    Round,
    /// Wide and low.
    Strip,
}

pub(super) struct Cells {
    pub(super) columns: usize,
    pub(super) rows: usize,
    /// Index in the subset of each cell's point.
    point_in: Vec<Option<u32>>,
    /// Cell of each point of the subset.
    cell_of: Vec<u32>,
    /// True if the camera can deliver a reading in the cell.
    is_in_view: Vec<bool>,
}

impl Subset {
    /// Thins a scene; `noise_at_1m` is the depth's standard deviation at 1 m.
    pub(super) fn new(scene: &SceneCloud, params: &SegmentParams, noise_at_1m: Metres) -> Self {
        let points = &scene.cloud.points;
        let mut subset = Self {
            x: Vec::new(),
            y: Vec::new(),
            z: Vec::new(),
            reach: Vec::new(),
            cells: None,
        };
        let base = params.plane_distance.0 as f32;
        let noise = (params.noise_factor * noise_at_1m.0) as f32;
        let mut push = |p: &Point3<f32>| {
            subset.x.push(p.x);
            subset.y.push(p.y);
            subset.z.push(p.z);
            subset.reach.push(base + noise * p.z * p.z);
        };
        match scene.cloud.grid {
            None => {
                let step = (scene.cloud.num_finite() / SUBSET_SIZE).max(1);
                scene
                    .cloud
                    .finite()
                    .step_by(step)
                    .for_each(|(_, p)| push(p));
            }
            Some(Grid { width, height }) => {
                let step = ((width * height) as f64 / SUBSET_SIZE as f64)
                    .sqrt()
                    .round()
                    .max(1.0) as usize;
                let (columns, rows) = (width.div_ceil(step), height.div_ceil(step));
                let mut point_in = vec![None; columns * rows];
                let mut cell_of = Vec::new();
                let view = scene.field_of_view();
                let mut is_in_view = vec![true; columns * rows];
                for (cell, slot) in point_in.iter_mut().enumerate() {
                    let (u, v) = (cell % columns * step, cell / columns * step);
                    is_in_view[cell] = view.is_none_or(|view| view.contains(u as i64, v as i64));
                    let p = &points[v * width + u];
                    if is_finite(p) {
                        *slot = Some(cell_of.len() as u32);
                        cell_of.push(cell as u32);
                        push(p);
                    }
                }
                subset.cells = Some(Cells {
                    columns,
                    rows,
                    point_in,
                    cell_of,
                    is_in_view,
                });
            }
        }
        subset
    }

    pub(super) fn len(&self) -> usize {
        self.x.len()
    }

    pub(super) fn point(&self, i: u32) -> Point3<f64> {
        let i = i as usize;
        Point3::new(self.x[i], self.y[i], self.z[i]).cast()
    }

    /// Draws two more points for a sample that begins with `first`: on a grid from its neighbourhood, where they most
    /// likely lie on the same surface, otherwise from anywhere. Every second neighbourhood is wide and low, because a
    /// floor is often seen as a strip along the lower edge.
    pub(super) fn sample_neighbours(
        &self,
        first: u32,
        shape: Neighbourhood,
        unclaimed: &[u32],
        rng: &mut Pcg64,
    ) -> Option<[u32; 2]> {
        let Some(cells) = &self.cells else {
            return Some([0; 2].map(|_: u32| unclaimed[rng.random_range(0..unclaimed.len())]));
        };
        // A tenth of the picture: wide enough to determine the direction, narrow enough to stay on one surface.
        let (across, down) = match shape {
            Neighbourhood::Round => (cells.columns / 10, cells.columns / 10),
            Neighbourhood::Strip => (cells.columns / 3, cells.columns / 25),
        };
        let (across, down) = (across.max(2) as i64, down.max(2) as i64);
        let cell = i64::from(cells.cell_of[first as usize]);
        let (column, row) = (cell % cells.columns as i64, cell / cells.columns as i64);
        let mut one = || {
            let u = column + rng.random_range(-across..=across);
            let v = row + rng.random_range(-down..=down);
            let inside = u >= 0 && v >= 0 && u < cells.columns as i64 && v < cells.rows as i64;
            if inside {
                cells.point_in[v as usize * cells.columns + u as usize]
            } else {
                None
            }
        };
        Some([one()?, one()?])
    }
}

impl Cells {
    /// Returns the outermost reading of each row and column if it lies close to the border of the field of view, where
    /// sensors lose a few columns, and the number of row and column ends.
    pub(super) fn edge_points(&self) -> (Vec<u32>, usize) {
        let Self { columns, rows, .. } = *self;
        // The first reading inwards from the border, within a sixteenth of the picture; the outer `None` if no cell
        // of the line is in view.
        let first = |from: usize, step: isize, length: usize| {
            let walk = (0..length as isize).map(|i| from.wrapping_add_signed(i * step));
            let mut inwards = walk.skip_while(|cell| !self.is_in_view[*cell]).peekable();
            inwards.peek()?;
            let mut inwards = inwards.take((length / 16).max(1));
            Some(inwards.find_map(|cell| self.point_in[cell]))
        };
        let down = columns as isize;
        let sides = (0..rows).flat_map(|row| {
            let left = row * columns;
            [
                first(left, 1, columns),
                first(left + columns - 1, -1, columns),
            ]
        });
        let ends = (0..columns).flat_map(|column| {
            [
                first(column, down, rows),
                first((rows - 1) * columns + column, -down, rows),
            ]
        });
        let all: Vec<Option<u32>> = sides.chain(ends).flatten().collect();
        (all.iter().flatten().copied().collect(), all.len())
    }
}
