//! The points of outline and openings, for an exhaustive search of the closest.

use nalgebra::{Point3, Vector3};

/// Points looked at side by side.
const LANES: usize = 8;
/// A neighbour this many times as far away as the other one is no neighbour.
const SAME_OUTLINE: f32 = 3.0;

/// A few hundred points in columns of eight, which the processor looks at all at once. Neighbours along an outline are
/// neighbours in a column, so most columns are too far away as a whole.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct EdgePoints {
    /// x, y and z of eight points each; the last group is filled up with points at infinity.
    groups: Vec<[[f32; LANES]; 3]>,
    /// The least and the greatest x, y and z of eight groups each, filled up likewise.
    boxes: Vec<[[[f32; LANES]; 3]; 2]>,
    num: usize,
}

impl EdgePoints {
    /// Keeps at most `limit` of the points, evenly spread over their order.
    pub fn new(points: &[Point3<f32>], limit: usize) -> Self {
        let step = points.len().div_ceil(limit.max(1)).max(1);
        let kept: Vec<Point3<f32>> = points.iter().step_by(step).copied().collect();
        let group = |points: &[Point3<f32>]| {
            let mut columns = [[f32::INFINITY; LANES]; 3];
            for (lane, p) in points.iter().enumerate() {
                for axis in 0..3 {
                    columns[axis][lane] = p[axis];
                }
            }
            columns
        };
        let bounds = |groups: &[&[Point3<f32>]]| {
            let mut bounds = [[[f32::INFINITY; LANES]; 3]; 2];
            for (lane, points) in groups.iter().enumerate() {
                for axis in 0..3 {
                    let along = || points.iter().map(|p| p[axis]);
                    bounds[0][axis][lane] = along().fold(f32::INFINITY, f32::min);
                    bounds[1][axis][lane] = along().fold(f32::NEG_INFINITY, f32::max);
                }
            }
            bounds
        };
        let groups: Vec<&[Point3<f32>]> = kept.chunks(LANES).collect();
        Self {
            boxes: groups.chunks(LANES).map(bounds).collect(),
            groups: groups.into_iter().map(group).collect(),
            num: kept.len(),
        }
    }

    /// The number of points.
    pub fn len(&self) -> usize {
        self.num
    }

    /// True without points.
    pub fn is_empty(&self) -> bool {
        self.num == 0
    }

    /// The points in order.
    pub fn iter(&self) -> impl Iterator<Item = Point3<f32>> + '_ {
        (0..self.num).map(|i| self.point(i))
    }

    /// The point of a number below [`Self::len`].
    pub fn point(&self, i: usize) -> Point3<f32> {
        let [x, y, z] = &self.groups[i / LANES];
        Point3::new(x[i % LANES], y[i % LANES], z[i % LANES])
    }

    /// The closest point within reach, with its squared distance.
    pub fn closest(&self, at: &Point3<f32>, reach_sq: f32) -> Option<(Point3<f32>, f32)> {
        let (number, distance_sq) = self.closest_number(at, reach_sq)?;
        Some((self.point(number), distance_sq))
    }

    /// The number of the closest point within reach, with its squared distance.
    pub fn closest_number(&self, at: &Point3<f32>, reach_sq: f32) -> Option<(usize, f32)> {
        let mut best = (reach_sq, usize::MAX);
        for (number, boxes) in self.boxes.iter().enumerate() {
            let at_least = distances_to_boxes_sq(boxes, at);
            for (lane, at_least) in at_least.into_iter().enumerate() {
                if at_least < best.0 {
                    self.closest_of_group(number * LANES + lane, at, &mut best);
                }
            }
        }
        (best.1 != usize::MAX).then_some((best.1, best.0))
    }

    /// Unit vector along the outline at a point, from its neighbours; `None` of a point by itself.
    ///
    /// A neighbour that is several times as far away as the other belongs to another outline.
    pub fn along(&self, number: usize) -> Option<Vector3<f32>> {
        let at = self.point(number);
        let to = |other: Option<usize>| {
            let other = other.filter(|other| *other < self.num)?;
            Some(self.point(other) - at).filter(|step| step.norm_squared() > 0.0)
        };
        let steps = [to(number.checked_sub(1)), to(Some(number + 1))];
        let lengths = steps.map(|step| step.map_or(f32::INFINITY, |step| step.norm()));
        let least = lengths[0].min(lengths[1]);
        let step = |side: usize| steps[side].filter(|_| lengths[side] <= SAME_OUTLINE * least);
        let along = step(1).unwrap_or_default() - step(0).unwrap_or_default();
        along.try_normalize(1e-9)
    }

    /// Betters the squared distance and the number of the closest point so far.
    fn closest_of_group(&self, group: usize, at: &Point3<f32>, best: &mut (f32, usize)) {
        let mut distances_sq = [0.0; LANES];
        for (column, at) in self.groups[group].iter().zip(at.iter()) {
            for (distance_sq, x) in distances_sq.iter_mut().zip(column) {
                *distance_sq += (x - at) * (x - at);
            }
        }
        let least = distances_sq.iter().copied().fold(f32::INFINITY, f32::min);
        if least < best.0 {
            let lane = distances_sq.iter().position(|d| *d <= least).unwrap_or(0);
            *best = (least, group * LANES + lane);
        }
    }
}

/// Squared distances to eight boxes, 0 inside.
fn distances_to_boxes_sq(boxes: &[[[f32; LANES]; 3]; 2], at: &Point3<f32>) -> [f32; LANES] {
    let [low, high] = boxes;
    let mut distances_sq = [0.0; LANES];
    for axis in 0..3 {
        for lane in 0..LANES {
            let (under, over) = (low[axis][lane] - at[axis], at[axis] - high[axis][lane]);
            let beyond = if under > over { under } else { over };
            let beyond = if beyond > 0.0 { beyond } else { 0.0 };
            distances_sq[lane] += beyond * beyond;
        }
    }
    distances_sq
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn point() -> impl Strategy<Value = Point3<f32>> {
        prop::array::uniform3(-1.0_f32..1.0).prop_map(Point3::from)
    }

    #[test]
    fn an_outline_runs_along_its_neighbours_and_ends_at_a_gap() {
        let row = (0..5).map(|i| Point3::new(i as f32 * 0.01, 0.0, 0.0));
        let column = (0..5).map(|i| Point3::new(0.5, 0.2 + i as f32 * 0.01, 0.0));
        let points: Vec<Point3<f32>> = row.chain(column).collect();
        let edges = EdgePoints::new(&points, 100);
        for (number, expected) in [
            (0, Vector3::x()),
            (2, Vector3::x()),
            (4, Vector3::x()),
            (5, Vector3::y()),
            (9, Vector3::y()),
        ] {
            let along = edges.along(number).expect("neighbours");
            assert!((along - expected).norm() < 1e-5, "{number}: {along}");
        }
        assert_eq!(EdgePoints::new(&points[..1], 100).along(0), None);
    }

    proptest! {
        #[test]
        fn the_closest_edge_point_is_that_of_a_plain_search(
            points in prop::collection::vec(point(), 0..50),
            at in point(),
        ) {
            let slow = points.iter().map(|p| (p - at).norm_squared()).filter(|d| *d < 1.0).min_by(f32::total_cmp);
            let found = EdgePoints::new(&points, 1000).closest(&at, 1.0).map(|c| c.1);
            match (slow, found) {
                (Some(slow), Some(found)) => prop_assert!((slow - found).abs() < 1e-6),
                (slow, found) => prop_assert_eq!(slow.is_some(), found.is_some()),
            }
        }
    }
}
