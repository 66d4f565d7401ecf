//! Nearest-neighbour search: a k-d tree over a fixed set of points.
//!
//! The tree is an implicit, balanced binary tree (Bentley, "Multidimensional binary search trees used for associative
//! searching", Communications of the ACM 18(9), 1975). Points are re-ordered once so that each leaf is a run of
//! consecutive points; inner nodes store one split each. Registration runs millions of queries, so a query allocates
//! nothing and the points of a leaf are adjacent in memory.

use std::ops::Range;

use nalgebra::Point3;

/// Points per leaf. Scanning a whole leaf is faster than descending further. On clouds of 5 000 to 50 000 points, 8
/// to 16 were equally fast.
const LEAF_POINTS: usize = 12;

/// A neighbour found by a search.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Neighbour {
    /// Index of the point in the slice the tree was built from.
    pub index: usize,
    /// Squared distance, square metres.
    pub distance_sq: f32,
}

/// A k-d tree over finite points.
#[derive(Clone, Debug)]
pub struct KdTree {
    /// Points in leaf order.
    points: Vec<[f32; 3]>,
    /// For each point in leaf order, its index in the input.
    indices: Vec<u32>,
    /// Inner nodes, root at 0, children of node i at 2i + 1 and 2i + 2. The leaves are numbered after them.
    splits: Vec<Split>,
    /// Start of each leaf in leaf order, and the end of the last one.
    leaves: Vec<u32>,
}

#[derive(Clone, Copy, Debug, Default)]
struct Split {
    axis: u8,
    at: f32,
}

impl KdTree {
    /// Builds the tree in O(n log n). Points that are not finite are left out. Searches in an empty tree find nothing.
    pub fn new(points: &[Point3<f32>]) -> Self {
        let mut entries: Vec<([f32; 3], u32)> = points
            .iter()
            .enumerate()
            .filter(|(_, p)| super::cloud::is_finite(p))
            .map(|(i, p)| ([p.x, p.y, p.z], i as u32))
            .collect();
        let num_leaves = entries.len().div_ceil(LEAF_POINTS).next_power_of_two();
        let mut splits = vec![Split::default(); num_leaves - 1];
        split_at_medians(&mut entries, &mut splits, 0);
        Self {
            points: entries.iter().map(|e| e.0).collect(),
            indices: entries.iter().map(|e| e.1).collect(),
            splits,
            leaves: leaf_ends(entries.len(), num_leaves),
        }
    }

    /// Returns the number of points in the tree.
    pub fn len(&self) -> usize {
        self.points.len()
    }

    /// Returns true if the tree holds no points.
    pub fn is_empty(&self) -> bool {
        self.points.is_empty()
    }

    /// Returns the point nearest to `query` among those closer than `radius_sq` (square metres; infinity for no limit).
    pub fn nearest(&self, query: &Point3<f32>, radius_sq: f32) -> Option<Neighbour> {
        self.nearest_but(query, radius_sq, u32::MAX)
    }

    /// Returns the point nearest to `query`, excluding the point with the given index.
    pub fn nearest_other(&self, query: &Point3<f32>, index: usize) -> Option<Neighbour> {
        self.nearest_but(query, f32::INFINITY, index as u32)
    }

    /// Returns the nearest point as [`Self::nearest`] does, and a lower bound on the squared distance of every other point.
    pub fn nearest_and_next(
        &self,
        query: &Point3<f32>,
        radius_sq: f32,
    ) -> Option<(Neighbour, f32)> {
        let best = self.best::<true>(query, radius_sq, u32::MAX);
        Some((self.neighbour(&best)?, best.next_sq))
    }

    fn nearest_but(&self, query: &Point3<f32>, radius_sq: f32, skipped: u32) -> Option<Neighbour> {
        self.neighbour(&self.best::<false>(query, radius_sq, skipped))
    }

    fn neighbour(&self, best: &Best) -> Option<Neighbour> {
        (best.position != usize::MAX).then(|| Neighbour {
            index: self.indices[best.position] as usize,
            distance_sq: best.distance_sq,
        })
    }

    /// `NEXT`: whether to track the second nearest point too.
    fn best<const NEXT: bool>(&self, query: &Point3<f32>, radius_sq: f32, skipped: u32) -> Best {
        let mut best = Best {
            position: usize::MAX,
            distance_sq: radius_sq,
            next_sq: radius_sq,
            skipped,
        };
        let query = [query.x, query.y, query.z];
        self.search::<NEXT>(&query, 0, &mut [0.0; 3], &mut best);
        best
    }

    /// Descends into the nearer child first, and into the farther one only if its cell can hold a closer point.
    /// `offsets` are the distances from the query to the node's cell along each axis; they are restored on return.
    fn search<const NEXT: bool>(
        &self,
        query: &[f32; 3],
        node: usize,
        offsets: &mut [f32; 3],
        best: &mut Best,
    ) {
        let Some(&Split { axis, at }) = self.splits.get(node) else {
            let leaf = self.leaf(node);
            let start = leaf.start;
            for (i, p) in self.points[leaf].iter().enumerate() {
                let d = [p[0] - query[0], p[1] - query[1], p[2] - query[2]];
                let distance_sq = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
                if distance_sq < best.distance_sq && self.indices[start + i] != best.skipped {
                    best.next_sq = best.distance_sq;
                    best.position = start + i;
                    best.distance_sq = distance_sq;
                } else if NEXT && distance_sq < best.next_sq {
                    best.next_sq = distance_sq;
                }
            }
            return;
        };
        let axis = usize::from(axis);
        let to_plane = query[axis] - at;
        let (low, high) = (2 * node + 1, 2 * node + 2);
        let (near, far) = if to_plane < 0.0 {
            (low, high)
        } else {
            (high, low)
        };
        self.search::<NEXT>(query, near, offsets, best);
        let before = std::mem::replace(&mut offsets[axis], to_plane);
        let limit_sq = if NEXT { best.next_sq } else { best.distance_sq };
        if offsets.iter().map(|o| o * o).sum::<f32>() < limit_sq {
            self.search::<NEXT>(query, far, offsets, best);
        }
        offsets[axis] = before;
    }

    /// The positions of a leaf's points in leaf order.
    fn leaf(&self, node: usize) -> Range<usize> {
        let number = node - self.splits.len();
        self.leaves[number] as usize..self.leaves[number + 1] as usize
    }

    /// Calls `visit` with each point within `radius` (metres) of `query`, in no particular order.
    pub fn within(&self, query: &Point3<f32>, radius: f32, mut visit: impl FnMut(Neighbour)) {
        let query = [query.x, query.y, query.z];
        self.visit_within(&query, radius * radius, 0, &mut [0.0; 3], &mut visit);
    }

    /// Descends into each child whose cell reaches into the ball; `offsets` as in [`Self::search`].
    fn visit_within(
        &self,
        query: &[f32; 3],
        radius_sq: f32,
        node: usize,
        offsets: &mut [f32; 3],
        visit: &mut impl FnMut(Neighbour),
    ) {
        let Some(&Split { axis, at }) = self.splits.get(node) else {
            let leaf = self.leaf(node);
            for (p, index) in self.points[leaf.clone()].iter().zip(&self.indices[leaf]) {
                let d = [p[0] - query[0], p[1] - query[1], p[2] - query[2]];
                let distance_sq = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
                if distance_sq <= radius_sq {
                    visit(Neighbour {
                        index: *index as usize,
                        distance_sq,
                    });
                }
            }
            return;
        };
        let axis = usize::from(axis);
        let to_plane = query[axis] - at;
        let before = offsets[axis];
        // The high child first: sums over the neighbours depend on their order.
        for (child, is_far) in [
            (2 * node + 2, to_plane < 0.0),
            (2 * node + 1, to_plane > 0.0),
        ] {
            offsets[axis] = if is_far { to_plane } else { before };
            if offsets.iter().map(|o| o * o).sum::<f32>() <= radius_sq {
                self.visit_within(query, radius_sq, child, offsets, visit);
            }
        }
        offsets[axis] = before;
    }
}

/// The nearest point so far, as a position in leaf order.
struct Best {
    position: usize,
    distance_sq: f32,
    /// Squared distance of the second nearest point, valid only if tracked.
    next_sq: f32,
    /// Index of a point to ignore.
    skipped: u32,
}

/// Returns the start of each leaf, and the end of the last one: every inner node halves its points.
fn leaf_ends(num_points: usize, num_leaves: usize) -> Vec<u32> {
    let last = num_points as u32;
    let mut ends = vec![0, last];
    while ends.len() <= num_leaves {
        let halves = ends
            .windows(2)
            .flat_map(|run| [run[0], run[0] + (run[1] - run[0]) / 2]);
        ends = halves.chain([last]).collect();
    }
    ends
}

/// Orders `entries` so that every inner node splits its points at the median of their longest axis.
fn split_at_medians(entries: &mut [([f32; 3], u32)], splits: &mut [Split], node: usize) {
    if node >= splits.len() {
        return;
    }
    let axis = longest_axis(entries);
    let middle = entries.len() / 2;
    if middle < entries.len() {
        let (_, median, _) =
            entries.select_nth_unstable_by(middle, |a, b| a.0[axis].total_cmp(&b.0[axis]));
        splits[node] = Split {
            axis: axis as u8,
            at: median.0[axis],
        };
    }
    let (low, high) = entries.split_at_mut(middle);
    split_at_medians(low, splits, 2 * node + 1);
    split_at_medians(high, splits, 2 * node + 2);
}

fn longest_axis(entries: &[([f32; 3], u32)]) -> usize {
    let mut low = [f32::INFINITY; 3];
    let mut high = [f32::NEG_INFINITY; 3];
    for (p, _) in entries {
        for axis in 0..3 {
            low[axis] = low[axis].min(p[axis]);
            high[axis] = high[axis].max(p[axis]);
        }
    }
    (0..3)
        .max_by(|&a, &b| (high[a] - low[a]).total_cmp(&(high[b] - low[b])))
        .unwrap_or(0)
}

/// Returns the median distance between nearest neighbours, metres, sampled on about 500 points; 1 µm if all points
/// coincide. `tree` holds the same points.
pub fn median_spacing(points: &[Point3<f32>], tree: &KdTree) -> f64 {
    const NUM_ASKED: usize = 500;
    let step = (points.len() / NUM_ASKED).max(1);
    let mut distances: Vec<f32> = points
        .iter()
        .enumerate()
        .step_by(step)
        .filter_map(|(i, p)| tree.nearest_other(p, i).map(|n| n.distance_sq.sqrt()))
        // Ignore duplicate points.
        .filter(|d| *d > 0.0)
        .collect();
    if distances.is_empty() {
        return 1e-6;
    }
    let middle = distances.len() / 2;
    f64::from(*distances.select_nth_unstable_by(middle, f32::total_cmp).1)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn slow_nearest(points: &[Point3<f32>], query: &Point3<f32>) -> Option<f32> {
        points
            .iter()
            .map(|p| (p - query).norm_squared())
            .min_by(f32::total_cmp)
    }

    fn point() -> impl Strategy<Value = Point3<f32>> {
        // Deliberately few distinct values: equal coordinates are the hard case for median splits.
        (-8_i32..8, -8_i32..8, -8_i32..8)
            .prop_map(|(x, y, z)| Point3::new(x as f32, y as f32, z as f32) / 4.0)
    }

    proptest! {
        #[test]
        fn finds_the_same_distance_as_a_linear_search(
            points in prop::collection::vec(point(), 0..200),
            query in point(),
        ) {
            let tree = KdTree::new(&points);
            let found = tree.nearest(&query, f32::INFINITY);
            prop_assert_eq!(found.map(|n| n.distance_sq), slow_nearest(&points, &query));
            if let Some(n) = found {
                prop_assert!(((points[n.index] - query).norm_squared() - n.distance_sq).abs() < 1e-6);
            }
        }

        #[test]
        fn the_next_is_as_far_away_as_the_second_of_a_linear_search(
            points in prop::collection::vec(point(), 2..200),
            query in point(),
        ) {
            let mut slow: Vec<f32> = points.iter().map(|p| (p - query).norm_squared()).collect();
            slow.sort_by(f32::total_cmp);
            let found = KdTree::new(&points).nearest_and_next(&query, f32::INFINITY);
            prop_assert_eq!(found.map(|(near, next)| [near.distance_sq, next]), Some([slow[0], slow[1]]));
        }

        #[test]
        fn every_point_lies_in_the_leaf_that_the_splits_above_lead_to(
            points in prop::collection::vec(point(), 0..400),
        ) {
            let tree = KdTree::new(&points);
            let mut cells = vec![(0_usize, 0..tree.len())];
            let mut num_leaves = 0;
            while let Some((node, run)) = cells.pop() {
                let Some(Split { axis, at }) = tree.splits.get(node) else {
                    prop_assert!(run.len() <= LEAF_POINTS);
                    prop_assert_eq!(tree.leaf(node), run);
                    num_leaves += 1;
                    continue;
                };
                let axis = usize::from(*axis);
                let middle = run.start + run.len() / 2;
                prop_assert!(tree.points[run.start..middle].iter().all(|p| p[axis] <= *at));
                prop_assert!(tree.points[middle..run.end].iter().all(|p| p[axis] >= *at));
                cells.extend([(2 * node + 1, run.start..middle), (2 * node + 2, middle..run.end)]);
            }
            prop_assert_eq!(num_leaves, tree.leaves.len() - 1);
        }

        #[test]
        fn within_visits_exactly_the_points_inside_the_radius(
            points in prop::collection::vec(point(), 0..200),
            query in point(),
            radius in 0.0_f32..3.0,
        ) {
            let mut found = Vec::new();
            KdTree::new(&points).within(&query, radius, |n| found.push(n.index));
            found.sort_unstable();
            let slow: Vec<usize> = (0..points.len())
                .filter(|&i| (points[i] - query).norm_squared() <= radius * radius)
                .collect();
            prop_assert_eq!(found, slow);
        }
    }

    #[test]
    fn points_that_are_not_finite_are_never_found() {
        let points = [Point3::new(f32::NAN, 0.0, 0.0), Point3::new(1.0, 0.0, 0.0)];
        let tree = KdTree::new(&points);
        assert_eq!(tree.len(), 1);
        assert_eq!(
            tree.nearest(&Point3::origin(), f32::INFINITY)
                .map(|n| n.index),
            Some(1)
        );
        assert_eq!(tree.nearest(&Point3::origin(), 0.5), None);
    }
}
