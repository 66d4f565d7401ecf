//! The points of outline and openings, for an exhaustive search of the closest.

use nalgebra::{Matrix3, Point3, Vector3};

use geometry::{nearest_field::NearestField, statistics::sample_evenly, surface_grid::SurfaceEnd};

/// Points looked at side by side.
const LANES: usize = 8;
/// A neighbour this many times as far away as the other one is no neighbour.
const SAME_OUTLINE: f32 = 3.0;

/// The direction of a border is taken from ends this many half pieces away.
const NEIGHBOURS: f64 = 3.0;

/// A few hundred points in columns of eight, which the processor looks at all at once. Neighbours along an outline are
/// neighbours in a column, so most columns are too far away as a whole.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct EdgePoints {
    /// x, y and z of eight points each; the last group is filled up with points at infinity.
    groups: Vec<[[f32; LANES]; 3]>,
    /// The least and the greatest x, y and z of eight groups each, filled up likewise.
    boxes: Vec<[[[f32; LANES]; 3]; 2]>,
    num: usize,
    /// Of each point, if every one stands for a piece of a line: from it to the end of its piece.
    pieces: Vec<Vector3<f32>>,
    /// What else would be a search of all of them.
    field: Option<NearestField>,
}

impl EdgePoints {
    /// The ends of a cloud's surface, each a straight piece that reaches as far as `half` either way; at most `limit`.
    /// The closest is looked for within `band` of them only, and is off by less than `half` along them.
    pub fn of_ends(ends: &[SurfaceEnd], half: f64, limit: usize, band: f64) -> Self {
        let kept = sample_evenly(ends, limit);
        let points: Vec<Point3<f32>> = kept.clone().map(|end| end.at).collect();
        Self {
            pieces: kept
                .map(|end| along_neighbours(end, ends, NEIGHBOURS * half) * half as f32)
                .collect(),
            field: Some(NearestField::new(&points, half as f32, band as f32)),
            ..Self::new(&points, limit)
        }
    }

    /// Keeps at most `limit` of the points, evenly spread over their order.
    pub fn new(points: &[Point3<f32>], limit: usize) -> Self {
        let kept: Vec<Point3<f32>> = sample_evenly(points, limit).copied().collect();
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
            pieces: Vec::new(),
            field: None,
        }
    }

    /// True if the points stand for pieces of lines, whose directions come from noisy points.
    pub fn are_pieces(&self) -> bool {
        !self.pieces.is_empty()
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
        let point = self.point(number);
        let Some(piece) = self.pieces.get(number) else {
            return Some((point, distance_sq));
        };
        let along = (at - point).dot(piece) / piece.norm_squared();
        let foot = point + piece * along.clamp(-1.0, 1.0);
        Some((foot, (foot - at).norm_squared()))
    }

    /// The number of the closest point within reach, with its squared distance.
    pub fn closest_number(&self, at: &Point3<f32>, reach_sq: f32) -> Option<(usize, f32)> {
        if let Some(field) = &self.field {
            let near = field
                .nearest(at)
                .filter(|near| near.distance_sq < reach_sq)?;
            return Some((near.index, near.distance_sq));
        }
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
        if let Some(piece) = self.pieces.get(number) {
            return piece.try_normalize(0.0);
        }
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
        let least = least_of(distances_sq);
        if least < best.0 {
            let lane = distances_sq.iter().position(|d| *d <= least).unwrap_or(0);
            *best = (least, group * LANES + lane);
        }
    }
}

/// Returns the direction in which the ends around one spread, starting from its own direction.
fn along_neighbours(end: &SurfaceEnd, ends: &[SurfaceEnd], reach: f64) -> Vector3<f32> {
    let spread: Matrix3<f32> = ends
        .iter()
        .map(|other| other.at - end.at)
        .filter(|off| off.norm_squared() < (reach * reach) as f32)
        .map(|off| off * off.transpose())
        .sum();
    // Powers of the matrix turn a vector towards its widest direction.
    (0..4).fold(end.along, |along, _| {
        (spread * along).try_normalize(0.0).unwrap_or(along)
    })
}

/// The least of some distances. Halves are compared with each other, all lanes at once: in a row, each comparison would
/// wait for the one before.
fn least_of(mut distances: [f32; LANES]) -> f32 {
    for half in [LANES / 2, LANES / 4, LANES / 8] {
        for lane in 0..half {
            distances[lane] = distances[lane].min(distances[lane + half]);
        }
    }
    distances[0]
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
    use geometry::fixtures::any_point;

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

    #[test]
    fn ends_of_a_surface_are_pieces_of_its_border() {
        let end = |i: i32| SurfaceEnd {
            at: Point3::new(
                i as f32 * 0.02,
                if i % 2 == 0 { 0.001 } else { -0.001 },
                0.0,
            ),
            along: Vector3::new(0.9, 0.4, 0.0).normalize(),
        };
        let ends: Vec<SurfaceEnd> = (0..20).map(end).collect();
        let edges = EdgePoints::of_ends(&ends, 0.02, 100, 0.1);
        assert_eq!(edges.len(), 20);
        assert!(edges.are_pieces());
        for i in 2..18 {
            let along = edges.along(i).expect("every piece has a direction");
            assert!(along.x > 0.99, "{along}");
        }
        // Between two points the closest is on the line, not at one of them.
        let (foot, distance_sq) = edges
            .closest(&Point3::new(0.21, 0.03, 0.0), 0.01)
            .expect("near");
        assert!((foot.x - 0.21).abs() < 0.003, "{foot}");
        assert!((distance_sq.sqrt() - 0.03).abs() < 0.002);
        assert_eq!(
            edges.closest(&Point3::new(0.2, 0.3, 0.0), 1.0),
            None,
            "out of the band"
        );
    }

    proptest! {
        #[test]
        fn the_least_of_eight_distances_is_that_of_a_plain_search(
            distances in prop::array::uniform8(0.0_f32..2.0),
        ) {
            // As in a group that is filled up with points at infinity.
            let distances = distances.map(|d| if d < 1.0 { d } else { f32::INFINITY });
            let slow = distances.into_iter().fold(f32::INFINITY, f32::min);
            prop_assert_eq!(least_of(distances).to_bits(), slow.to_bits());
        }

        #[test]
        fn the_closest_edge_point_is_that_of_a_plain_search(
            points in prop::collection::vec(any_point(), 0..50),
            at in any_point(),
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
