//! The nearest point of an outline for every cell of the plane around it.
//!
//! Each cell's nearest point is handed on to its neighbours in two sweeps over the grid (P.-E. Danielsson, "Euclidean
//! distance mapping", Computer Graphics and Image Processing 14(3), 1980), so the answer is off by less than a cell.

use nalgebra::{Point2, Vector2};

/// Side of a cell, metres.
const CELL: f64 = 0.01;
/// How far beyond the outline the field answers, metres.
const BAND: f64 = 0.25;
/// More cells than this along one axis belong to no part.
const MAX_SIDE: usize = 2000;
const NOTHING: u32 = u32::MAX;

/// Nearest outline points on a grid.
#[derive(Clone, Debug)]
pub struct OutlineField {
    low: Point2<f64>,
    size: [usize; 2],
    nearest: Vec<u32>,
    points: Vec<Point2<f64>>,
}

impl OutlineField {
    /// A field around finite points, metres; empty if there are none or they reach too far.
    pub fn new(points: Vec<Point2<f64>>) -> Self {
        let (mut low, mut high) = (
            Point2::new(f64::MAX, f64::MAX),
            Point2::new(f64::MIN, f64::MIN),
        );
        for p in &points {
            low = low.inf(p);
            high = high.sup(p);
        }
        let low = low - Vector2::repeat(BAND);
        let size =
            [0, 1].map(|axis| ((high[axis] + BAND - low[axis]) / CELL).max(0.0) as usize + 1);
        if points.is_empty() || size.iter().any(|side| *side > MAX_SIDE) {
            return Self {
                low: Point2::origin(),
                size: [0; 2],
                nearest: Vec::new(),
                points: Vec::new(),
            };
        }
        let mut field = Self {
            low,
            size,
            nearest: vec![NOTHING; size[0] * size[1]],
            points,
        };
        for index in 0..field.points.len() {
            if let Some(cell) = field.cell_of(&field.points[index]) {
                field.offer(cell, index as u32);
            }
        }
        field.sweep();
        field
    }

    /// The outline point near `query`; `None` beyond the band.
    pub fn nearest(&self, query: &Point2<f64>) -> Option<Point2<f64>> {
        let index = self.nearest[self.cell_of(query)?];
        self.points.get(index as usize).copied()
    }

    fn cell_of(&self, p: &Point2<f64>) -> Option<usize> {
        let d = (p - self.low) / CELL;
        let is_inside = d.x >= 0.0 && d.y >= 0.0;
        let [x, y] = [d.x as usize, d.y as usize];
        (is_inside && x < self.size[0] && y < self.size[1]).then(|| y * self.size[0] + x)
    }

    fn offer(&mut self, cell: usize, index: u32) {
        let [x, y] = [cell % self.size[0], cell / self.size[0]];
        let centre = self.low + Vector2::new(x as f64 + 0.5, y as f64 + 0.5) * CELL;
        let off = |index: u32| match self.points.get(index as usize) {
            Some(p) => (p - centre).norm_squared(),
            None => f64::INFINITY,
        };
        if off(index) < off(self.nearest[cell]) {
            self.nearest[cell] = index;
        }
    }

    fn sweep(&mut self) {
        let [width, height] = self.size;
        for y in 0..height {
            for x in 0..width {
                self.take_over(x, y, &[(-1, 0), (-1, -1), (0, -1), (1, -1)]);
            }
            for x in (0..width).rev() {
                self.take_over(x, y, &[(1, 0)]);
            }
        }
        for y in (0..height).rev() {
            for x in (0..width).rev() {
                self.take_over(x, y, &[(1, 0), (1, 1), (0, 1), (-1, 1)]);
            }
            for x in 0..width {
                self.take_over(x, y, &[(-1, 0)]);
            }
        }
    }

    fn take_over(&mut self, x: usize, y: usize, from: &[(isize, isize)]) {
        for &(dx, dy) in from {
            let (Some(nx), Some(ny)) = (x.checked_add_signed(dx), y.checked_add_signed(dy)) else {
                continue;
            };
            if nx < self.size[0] && ny < self.size[1] {
                let index = self.nearest[ny * self.size[0] + nx];
                if index != NOTHING {
                    self.offer(y * self.size[0] + x, index);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn the_nearest_point_is_that_of_a_plain_search_to_within_a_cell(
            points in prop::collection::vec((-0.5_f64..0.5, -0.3_f64..0.3), 1..60),
            at in (-0.6_f64..0.6, -0.4_f64..0.4),
        ) {
            let points: Vec<Point2<f64>> = points.into_iter().map(|(x, y)| Point2::new(x, y)).collect();
            let at = Point2::new(at.0, at.1);
            let slow = points.iter().map(|p| (p - at).norm()).fold(f64::INFINITY, f64::min);
            if let Some(found) = OutlineField::new(points).nearest(&at) {
                prop_assert!((found - at).norm() < slow + 2.0 * CELL);
            }
        }
    }

    #[test]
    fn no_points_and_far_points_give_no_answer() {
        for points in [
            Vec::new(),
            vec![Point2::new(0.0, 0.0), Point2::new(1e9, 0.0)],
        ] {
            assert_eq!(OutlineField::new(points).nearest(&Point2::origin()), None);
        }
    }
}
