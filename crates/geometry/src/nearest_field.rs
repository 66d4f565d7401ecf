//! A nearest-point field: for every grid cell around a cloud, the point nearest to the cell's centre.
//!
//! Evaluating a pose takes hundreds of nearest-point queries, and thousands of poses are evaluated. The field answers a query
//! with one look-up, following the precomputed distance map of M. A. Greenspan and G. Godin, "A nearest neighbor method for
//! efficient ICP", 3DIM 2001. It is built once per reference by growing outwards from the occupied cells, layer by layer.
//!
//! Known limits: the result is the point nearest to the *cell*, so it may lie up to a cell's diagonal farther away
//! than the true nearest point; outside the band around the cloud there is no result. The final refinement of a
//! pose queries the k-d tree.

use nalgebra::{Point3, Vector3};

use super::nearest::Neighbour;

/// Marks a cell without a nearby point; its lower 16 bits do so in a `Narrow` field.
const NOTHING: u32 = u32::MAX;
/// Maximum number of cells: a larger grid would cost more memory than it saves time, so the cells grow until it fits.
const MAX_CELLS: f64 = 4e6;
/// Maximum number of cells along one axis, so that 16 bits can number them; a long, thin cloud gets larger cells.
const MAX_CELLS_ALONG: f64 = 60_000.0;

/// Nearest points within a band around a cloud.
#[derive(Clone, Debug, PartialEq)]
pub struct NearestField {
    low: Point3<f32>,
    per_cell: f32,
    /// Cells along each axis.
    size: [u16; 3],
    cells: Cells,
    points: Vec<Point3<f32>>,
}

/// Index of the nearest point per cell, x fastest.
#[derive(Clone, Debug, PartialEq)]
enum Cells {
    /// For at most 65 535 points, which most references have; half the size, so more of it stays in the CPU caches.
    Narrow(Vec<u16>),
    /// For more points.
    Wide(Vec<u32>),
}

impl Cells {
    fn new(nearest: Vec<u32>, num_points: usize) -> Self {
        if num_points > usize::from(u16::MAX) {
            return Self::Wide(nearest);
        }
        // Convert by reference: an in-place `collect` would keep the larger allocation.
        Self::Narrow(nearest.iter().map(|point| *point as u16).collect())
    }

    #[inline]
    fn point(&self, cell: usize) -> Option<usize> {
        match self {
            Self::Narrow(points) => {
                let point = points[cell];
                (point != NOTHING as u16).then_some(usize::from(point))
            }
            Self::Wide(points) => {
                let point = points[cell];
                (point != NOTHING).then_some(point as usize)
            }
        }
    }
}

impl NearestField {
    /// Creates a field over finite points with cells of `cell` metres; it answers queries up to about `band` metres
    /// off the cloud.
    pub fn new(points: &[Point3<f32>], cell: f32, band: f32) -> Self {
        let cloud = super::cloud::PointCloud::from_points(points.iter().copied());
        assert_eq!(
            cloud.points.len(),
            points.len(),
            "a field is made of finite points"
        );
        let Some((low, high)) = cloud.bounds() else {
            return Self {
                low: Point3::origin(),
                per_cell: 1.0,
                size: [0; 3],
                cells: Cells::Narrow(Vec::new()),
                points: Vec::new(),
            };
        };
        let extent: Vector3<f32> = (high - low).add_scalar(2.0 * band);
        let volume = extent
            .iter()
            .map(|x| f64::from(*x / cell) + 2.0)
            .product::<f64>();
        let cell = cell * (volume / MAX_CELLS).cbrt().max(1.0) as f32;
        let cell = cell.max(extent.max() / MAX_CELLS_ALONG as f32);
        // Cells whose centre is within the band hold a point; beyond them and one more layer there is a margin of
        // empty cells.
        let layers = (band / cell).ceil() as usize + 2;
        let low = low - Vector3::repeat((layers as f32 + 0.5) * cell);
        let size = [0, 1, 2].map(|axis| ((high[axis] - low[axis]) / cell) as usize + layers + 2);
        let mut field = Self {
            low,
            per_cell: 1.0 / cell,
            size: size.map(|num| num as u16),
            cells: Cells::Narrow(Vec::new()),
            points: cloud.points,
        };
        field.grow(cell, band);
        field
    }

    /// Returns the point nearest to the cell of `query`; `None` outside the band.
    #[inline]
    pub fn nearest(&self, query: &Point3<f32>) -> Option<Neighbour> {
        let index = self.index_near(query)?;
        Some(Neighbour {
            index,
            distance_sq: (self.points[index] - query).norm_squared(),
        })
    }

    /// Returns the squared distance of that point; infinite outside the band.
    #[expect(clippy::inline_always, reason = "a call takes as long as the look-up")]
    #[inline(always)]
    pub fn distance_sq(&self, query: &Point3<f32>) -> f32 {
        let index = self.index_near(query);
        index.map_or(f32::INFINITY, |i| (self.points[i] - query).norm_squared())
    }

    /// Returns the index of that point.
    #[expect(clippy::inline_always, reason = "a call takes as long as the look-up")]
    #[inline(always)]
    fn index_near(&self, query: &Point3<f32>) -> Option<usize> {
        let d = (query - self.low) * self.per_cell;
        let inside = d.x >= 0.0 && d.y >= 0.0 && d.z >= 0.0;
        // A cast saturates at `u16::MAX`, which exceeds every axis; casting to 16 bits takes the fewest instructions.
        let [x, y, z] = [d.x, d.y, d.z].map(|at| at as u16);
        let [width, height, depth] = self.size;
        if !inside || x >= width || y >= height || z >= depth {
            return None;
        }
        let row = usize::from(z) * usize::from(height) + usize::from(y);
        self.cells.point(row * usize::from(width) + usize::from(x))
    }

    /// Seeds the occupied cells and propagates each cell's point to its neighbours, one layer at a time.
    fn grow(&mut self, side: f32, band: f32) {
        let size = self.size.map(usize::from);
        let [sx, sy, _] = size;
        let mut cells = vec![NOTHING; size.iter().product()];
        let (low, points) = (self.low, std::mem::take(&mut self.points));
        let off_centre = |point: u32, [x, y, z]: [u16; 3]| {
            let at = |i: u16, low: f32| (f32::from(i) + 0.5) * side + low;
            points[point as usize] - Point3::new(at(x, low.x), at(y, low.y), at(z, low.z))
        };
        // Squared distance from each cell's centre to its point.
        let mut held_sq = vec![f32::INFINITY; cells.len()];
        let mut front: Vec<(u32, [u16; 3])> = Vec::new();
        for (i, p) in (0_u32..).zip(&points) {
            let d = (p - low) * self.per_cell;
            let at = [d.x as u16, d.y as u16, d.z as u16];
            let index = (usize::from(at[2]) * sy + usize::from(at[1])) * sx + usize::from(at[0]);
            let distance_sq = off_centre(i, at).norm_squared();
            if distance_sq < held_sq[index] {
                if cells[index] == NOTHING {
                    front.push((index as u32, at));
                }
                cells[index] = i;
                held_sq[index] = distance_sq;
            }
        }
        // Propagate across faces, no farther than the band.
        let farthest_sq = (band + side).powi(2);
        let steps = [1, sx, sx * sy].map(|step| step as u32);
        let mut next = Vec::new();
        while !front.is_empty() {
            for (index, at) in front.drain(..) {
                let candidate = cells[index as usize];
                let off = off_centre(candidate, at);
                let here_sq = off.norm_squared();
                let mut hand_on = |axis: usize, towards: f32, index: u32, way: i16| {
                    // Squared distance to the centre of the adjacent cell.
                    let distance_sq = here_sq + side * (side - 2.0 * towards * off[axis]);
                    let held_sq = &mut held_sq[index as usize];
                    if distance_sq < *held_sq && distance_sq <= farthest_sq {
                        let holder = &mut cells[index as usize];
                        if *holder == NOTHING {
                            let mut beside = at;
                            beside[axis] = beside[axis].wrapping_add_signed(way);
                            next.push((index, beside));
                        }
                        *holder = candidate;
                        *held_sq = distance_sq;
                    }
                };
                // The outermost cells lie beyond the band, so they are never in the front.
                for (axis, step) in steps.into_iter().enumerate() {
                    hand_on(axis, 1.0, index + step, 1);
                    hand_on(axis, -1.0, index - step, -1);
                }
            }
            std::mem::swap(&mut front, &mut next);
        }
        self.cells = Cells::new(cells, points.len());
        self.points = points;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::nearest::KdTree;

    /// A curved sheet with about `num_along` points along one side.
    fn sheet(num_along: usize) -> Vec<Point3<f32>> {
        let place = |i: usize| i as f32 / num_along as f32;
        (0..num_along * num_along * 5 / 6)
            .map(|i| (place(i % num_along), place(i / num_along)))
            .map(|(u, v)| Point3::new(u, v, 0.2 * (4.0 * u).sin() * v))
            .collect()
    }

    /// Query points around that sheet.
    fn queries(num: u32) -> impl Iterator<Item = Point3<f32>> {
        (0..num).map(|i| {
            let spread = |k: u32, range: f32| {
                ((i.wrapping_mul(2_654_435_761 + k) >> 8) % 1000) as f32 / 1000.0 * range
            };
            Point3::new(
                spread(0, 1.2) - 0.1,
                spread(97, 1.2) - 0.1,
                spread(31, 0.5) - 0.25,
            )
        })
    }

    #[test]
    fn answers_are_as_near_as_the_true_nearest_up_to_a_cells_diagonal() {
        let points = sheet(60);
        let (cell, band) = (0.015, 0.06);
        let field = NearestField::new(&points, cell, band);
        let tree = KdTree::new(&points);
        let mut answered = 0;
        for query in queries(20_000) {
            let truth = tree
                .nearest(&query, f32::INFINITY)
                .expect("points")
                .distance_sq
                .sqrt();
            match field.nearest(&query) {
                Some(found) => {
                    answered += 1;
                    assert!(found.distance_sq.sqrt() <= truth + cell * 3.0_f32.sqrt() + 1e-6);
                }
                None => assert!(
                    truth > band - cell * 3.0_f32.sqrt(),
                    "{truth} m off the cloud, within the band"
                ),
            }
        }
        assert!(answered > 1000);
    }

    #[test]
    fn an_empty_cloud_and_a_far_point_answer_nothing() {
        let empty = NearestField::new(&[], 0.01, 0.05);
        assert_eq!(empty.nearest(&Point3::origin()), None);
        let one = NearestField::new(&[Point3::origin()], 0.01, 0.05);
        assert!(one.nearest(&Point3::new(0.01, 0.0, 0.0)).is_some());
        for far in [1.0, -1.0, 1e9, -1e9, f32::INFINITY, f32::NAN] {
            for axis in 0..3 {
                let mut query = Point3::<f32>::origin();
                query[axis] = far;
                assert_eq!(one.nearest(&query), None);
            }
        }
    }

    #[test]
    fn cells_of_16_and_of_32_bits_answer_alike() {
        let narrow = NearestField::new(&sheet(60), 0.015, 0.06);
        let Cells::Narrow(cells) = &narrow.cells else {
            panic!("3000 points are few");
        };
        let widened = cells.iter().map(|point| match *point {
            u16::MAX => NOTHING,
            point => point.into(),
        });
        let wide = NearestField {
            cells: Cells::Wide(widened.collect()),
            ..narrow.clone()
        };
        for query in queries(5000) {
            assert_eq!(narrow.nearest(&query), wide.nearest(&query));
        }
        // The last index that fits into 16 bits, and the first that does not.
        for (num, is_narrow) in [(65_535, true), (65_536, false)] {
            let crowd = (1..num).map(|i| Point3::new((i % 1000) as f32 * 1e-4, 0.0, 0.0));
            let apart = Point3::new(1.0, 0.0, 0.0);
            let points: Vec<Point3<f32>> = crowd.chain([apart]).collect();
            let field = NearestField::new(&points, 0.01, 0.02);
            assert_eq!(matches!(field.cells, Cells::Narrow(_)), is_narrow);
            let found = field.nearest(&apart).map(|near| near.index);
            assert_eq!(found, Some(num - 1));
        }
    }
}
