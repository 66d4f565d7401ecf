//! The points of outline and openings, for an exhaustive search of the closest.

use nalgebra::Point3;

/// Points looked at side by side.
const LANES: usize = 8;

/// A few hundred points in columns of eight: looking at all of them is quicker than a tree, and the processor looks at
/// several at once.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct EdgePoints {
    /// x, y and z of eight points each; the last group is filled up with points at infinity.
    groups: Vec<[[f32; LANES]; 3]>,
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
        Self {
            groups: kept.chunks(LANES).map(group).collect(),
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

    fn point(&self, i: usize) -> Point3<f32> {
        let [x, y, z] = &self.groups[i / LANES];
        Point3::new(x[i % LANES], y[i % LANES], z[i % LANES])
    }

    /// The closest point within reach, with its squared distance.
    pub fn closest(&self, at: &Point3<f32>, reach_sq: f32) -> Option<(Point3<f32>, f32)> {
        let mut best = [reach_sq; LANES];
        let mut best_group = [u32::MAX; LANES];
        for (number, [x, y, z]) in (0_u32..).zip(&self.groups) {
            let mut distance_sq = [0.0; LANES];
            for lane in 0..LANES {
                let (dx, dy, dz) = (x[lane] - at.x, y[lane] - at.y, z[lane] - at.z);
                distance_sq[lane] = dx * dx + dy * dy + dz * dz;
            }
            for lane in 0..LANES {
                let closer = distance_sq[lane] < best[lane];
                best[lane] = if closer {
                    distance_sq[lane]
                } else {
                    best[lane]
                };
                best_group[lane] = if closer { number } else { best_group[lane] };
            }
        }
        let lane = (0..LANES).min_by(|&a, &b| best[a].total_cmp(&best[b]))?;
        let group = best_group[lane];
        (group != u32::MAX).then(|| (self.point(group as usize * LANES + lane), best[lane]))
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn point() -> impl Strategy<Value = Point3<f32>> {
        prop::array::uniform3(-1.0_f32..1.0).prop_map(Point3::from)
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
