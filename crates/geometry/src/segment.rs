//! A straight segment in space: its distance to another segment, to a box and to a cloud.

use nalgebra::{Point3, Vector3};

use super::{nearest::KdTree, rigid::RigidTransform};

/// A straight segment, metres. A segment of zero length is a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment {
    /// Start point.
    pub from: Point3<f64>,
    /// End point.
    pub to: Point3<f64>,
}

/// Minimum step along a segment beside a cloud, metres. It lets a distance d be overestimated by at most MIN_STEP_M² /
/// 8d: 0.1 mm at 100 mm.
const MIN_STEP_M: f64 = 0.01;

impl Segment {
    /// Returns the length, metres.
    pub fn length(&self) -> f64 {
        (self.to - self.from).norm()
    }

    /// Returns the segment with its ends swapped.
    #[must_use]
    pub fn reversed(&self) -> Self {
        Self {
            from: self.to,
            to: self.from,
        }
    }

    /// Returns the rest of the segment after it last leaves the sphere of `radius` metres around a point; `None` if it ends
    /// inside.
    pub fn beyond(&self, point: &Point3<f64>, radius: f64) -> Option<Self> {
        if (self.to - point).norm() < radius {
            return None;
        }
        let (apart, way) = (self.from - point, self.to - self.from);
        // It crosses the sphere at the roots of a·s² + 2·b·s + c.
        let (a, b) = (way.norm_squared(), apart.dot(&way));
        let c = apart.norm_squared() - radius * radius;
        let root = b * b - a * c;
        let last = if a > 0.0 && root > 0.0 {
            ((root.sqrt() - b) / a).clamp(0.0, 1.0)
        } else {
            0.0
        };
        Some(Self {
            from: self.from + way * last,
            to: self.to,
        })
    }

    /// Returns the segment in another frame.
    #[must_use]
    pub fn moved(&self, transform: &RigidTransform) -> Self {
        Self {
            from: transform * self.from,
            to: transform * self.to,
        }
    }

    /// Returns the distance to another segment, metres; 0 where they meet.
    ///
    /// C. Ericson, *Real-Time Collision Detection*, 2005, section 5.1.9.
    pub fn distance_to_segment(&self, other: &Self) -> f64 {
        let (way, other_way) = (self.to - self.from, other.to - other.from);
        let apart = self.from - other.from;
        let (length_sq, other_length_sq) = (way.norm_squared(), other_way.norm_squared());
        let (along, other_along) = (way.dot(&apart), other_way.dot(&apart));
        let shares = if length_sq == 0.0 && other_length_sq == 0.0 {
            [0.0, 0.0]
        } else if length_sq == 0.0 {
            [0.0, other_along / other_length_sq]
        } else if other_length_sq == 0.0 {
            [-along / length_sq, 0.0]
        } else {
            let both = way.dot(&other_way);
            let spread = length_sq * other_length_sq - both * both;
            // Any share will do for parallel segments.
            let share = if spread > 0.0 {
                ((both * other_along - along * other_length_sq) / spread).clamp(0.0, 1.0)
            } else {
                0.0
            };
            // Clamp to the other segment's ends.
            let other_share = ((both * share + other_along) / other_length_sq).clamp(0.0, 1.0);
            [(both * other_share - along) / length_sq, other_share]
        };
        let [share, other_share] = shares.map(|share| share.clamp(0.0, 1.0));
        (apart + way * share - other_way * other_share).norm()
    }

    /// Returns the distance to the box around the origin with half extents `half`, metres; 0 where they meet.
    pub fn distance_to_box(&self, half: &Vector3<f64>) -> f64 {
        let (from, way) = (self.from.coords, self.to - self.from);
        // Offset from the nearest point of the box.
        let off = |share: f64| {
            let at = from + way * share;
            at - at.zip_map(half, |x, half| x.clamp(-half, half))
        };
        // Half the slope of the squared distance. It never decreases, because a box is convex, and it is linear between
        // the shares at which the segment crosses the plane of a face.
        let slope = |share: f64| off(share).dot(&way);
        let mut before = slope(0.0);
        if before >= 0.0 {
            return off(0.0).norm();
        }
        let mut shares: [f64; 8] = std::array::from_fn(|k| match k {
            6 => 0.0,
            7 => 1.0,
            k => {
                let axis = k / 2;
                let face = if k.is_multiple_of(2) {
                    -half[axis]
                } else {
                    half[axis]
                };
                let share = (face - from[axis]) / way[axis];
                // Ignore crossings outside the segment, and planes parallel to it.
                if share > 0.0 && share < 1.0 {
                    share
                } else {
                    0.0
                }
            }
        });
        shares.sort_by(f64::total_cmp);
        for pair in shares.windows(2) {
            let after = slope(pair[1]);
            if after >= 0.0 {
                let share = pair[0] + (pair[1] - pair[0]) * before / (before - after);
                return off(share).norm();
            }
            before = after;
        }
        off(1.0).norm()
    }

    /// Returns the distance to the nearest point of a cloud, metres, if it is below `within`.
    ///
    /// Walks along the segment from its start. Where the nearest point is at distance d, no point within the next `d -
    /// best` of the segment can be nearer than the best so far, so a segment far from the cloud takes one search.
    pub fn distance_to_cloud(&self, cloud: &KdTree, within: f64) -> Option<f64> {
        let length = self.length();
        let mut best = within;
        let mut walked = 0.0;
        loop {
            let share = if length > 0.0 { walked / length } else { 0.0 };
            let here = self.from + (self.to - self.from) * share;
            let rest = length - walked;
            // Points farther away cannot come within `best` on the rest of the segment.
            let radius = best + rest;
            let Some(found) = cloud.nearest(&here.cast(), (radius * radius) as f32) else {
                break;
            };
            let distance = f64::from(found.distance_sq).sqrt();
            best = best.min(distance);
            if rest <= 0.0 {
                break;
            }
            walked = (walked + (distance - best).max(MIN_STEP_M)).min(length);
        }
        (best < within).then_some(best)
    }
}

#[cfg(test)]
mod tests {
    use rand::{RngExt as _, SeedableRng as _};
    use rand_pcg::Pcg64;

    use super::*;

    fn segment(from: [f64; 3], to: [f64; 3]) -> Segment {
        Segment {
            from: Point3::from(from),
            to: Point3::from(to),
        }
    }

    fn any_point(random: &mut Pcg64, range: f64) -> [f64; 3] {
        std::array::from_fn(|_| random.random_range(-range..range))
    }

    #[test]
    fn two_segments_are_as_far_apart_as_their_nearest_places() {
        let along_x = segment([0.0, 0.0, 0.0], [1.0, 0.0, 0.0]);
        for (from, to, wanted) in [
            // Crossing, above, beyond its end, parallel, collinear, and a point.
            ([0.5, -1.0, 0.0], [0.5, 1.0, 0.0], 0.0),
            ([0.5, -1.0, 0.2], [0.5, 1.0, 0.2], 0.2),
            ([1.3, -1.0, 0.4], [1.3, 1.0, 0.4], 0.5),
            ([-5.0, 0.3, 0.0], [5.0, 0.3, 0.0], 0.3),
            ([4.0, 0.0, 0.0], [2.0, 0.0, 0.0], 1.0),
            ([0.2, 0.0, 0.7], [0.2, 0.0, 0.7], 0.7),
        ] {
            let other = segment(from, to);
            for (a, b) in [(&along_x, &other), (&other, &along_x)] {
                let found = a.distance_to_segment(b);
                assert!((found - wanted).abs() < 1e-12, "{a:?} {b:?}: {found}");
            }
        }
        let mut random = Pcg64::seed_from_u64(5);
        let mut any = || segment(any_point(&mut random, 1.0), any_point(&mut random, 1.0));
        for _ in 0..300 {
            let (a, b) = (any(), any());
            let found = a.distance_to_segment(&b);
            let places = |one: Segment| {
                (0..=100).map(move |i| one.from + (one.to - one.from) * f64::from(i) / 100.0)
            };
            let pairs = places(a).flat_map(|at| places(b).map(move |other| (at - other).norm()));
            let slow = pairs.fold(f64::INFINITY, f64::min);
            assert!(found <= slow + 1e-12, "{a:?} {b:?}: {found}, {slow}");
            assert!(
                found > slow - (a.length() + b.length()) / 200.0,
                "{a:?} {b:?}"
            );
        }
    }

    #[test]
    fn what_is_beyond_a_sphere_begins_where_it_leaves_it() {
        let centre = Point3::new(1.0, 0.0, 0.0);
        for (from, to, wanted) in [
            // From within, through it, before it, aside, and not at all.
            ([1.0, 0.0, 0.0], [4.0, 0.0, 0.0], Some([1.5, 0.0, 0.0])),
            ([-4.0, 0.0, 0.0], [4.0, 0.0, 0.0], Some([1.5, 0.0, 0.0])),
            ([3.0, 0.0, 0.0], [4.0, 0.0, 0.0], Some([3.0, 0.0, 0.0])),
            ([-4.0, 0.6, 0.0], [4.0, 0.6, 0.0], Some([-4.0, 0.6, 0.0])),
            ([2.0, 0.0, 0.0], [2.0, 0.0, 0.0], Some([2.0, 0.0, 0.0])),
            ([4.0, 0.0, 0.0], [1.4, 0.0, 0.0], None),
        ] {
            let any = segment(from, to);
            let found = any.beyond(&centre, 0.5);
            assert_eq!(found.map(|found| found.to), wanted.map(|_| any.to));
            let off = found.zip(wanted).map(|(found, wanted)| {
                let wanted = Point3::from(wanted);
                (found.from - wanted).norm()
            });
            assert!(off.unwrap_or(0.0) < 1e-12, "{any:?}: {found:?}");
        }
        let back = segment([1.0, 2.0, 3.0], [4.0, 5.0, 6.0]).reversed();
        assert_eq!(back, segment([4.0, 5.0, 6.0], [1.0, 2.0, 3.0]));
    }

    #[test]
    fn distances_to_a_box_are_those_to_its_faces_edges_and_corners() {
        let half = Vector3::new(1.0, 2.0, 3.0);
        for (from, to, wanted) in [
            // Beside a face: parallel to it and towards it.
            ([1.5, -9.0, 0.0], [1.5, 9.0, 0.0], 0.5),
            ([4.0, 0.0, 0.0], [1.25, 0.5, 0.5], 0.25),
            // Past an edge in z, at right angles to it.
            ([4.0, 3.0, 0.0], [2.0, 5.0, 0.0], 2.0_f64.sqrt() * 2.0),
            // A point beyond a corner.
            ([2.0, 4.0, 5.0], [2.0, 4.0, 5.0], 3.0),
            // Away from the box.
            ([1.0, 2.0, 4.0], [5.0, 6.0, 9.0], 1.0),
            // Through the box, out of it and within it.
            ([-5.0, 0.0, 0.0], [5.0, 0.1, 0.2], 0.0),
            ([0.5, 0.0, 0.0], [9.0, 0.0, 0.0], 0.0),
            ([0.5, 0.5, 0.5], [-0.5, -0.5, 1.0], 0.0),
        ] {
            for segment in [segment(from, to), segment(to, from)] {
                let found = segment.distance_to_box(&half);
                assert!((found - wanted).abs() < 1e-12, "{segment:?}: {found}");
            }
        }
    }

    #[test]
    fn a_box_is_as_near_as_the_nearest_of_many_places_on_the_segment() {
        let mut random = Pcg64::seed_from_u64(3);
        let half = Vector3::new(0.3, 0.1, 0.5);
        for _ in 0..500 {
            let any = segment(any_point(&mut random, 1.0), any_point(&mut random, 1.0));
            let places = (0..=2000).map(|i| any.from + (any.to - any.from) * f64::from(i) / 2000.0);
            let slow = places.map(|at| {
                let off = at.coords.abs() - half;
                off.map(|x| x.max(0.0)).norm()
            });
            let slow = slow.fold(f64::INFINITY, f64::min);
            let found = any.distance_to_box(&half);
            assert!(found <= slow + 1e-12, "{any:?}: {found}, {slow}");
            assert!(found > slow - any.length() / 4000.0 - 1e-12, "{any:?}");
        }
    }

    fn slow_distance(points: &[Point3<f32>], segment: &Segment) -> f64 {
        let way = segment.to - segment.from;
        let distances = points.iter().map(|p| {
            let off = p.cast::<f64>() - segment.from;
            let share = (off.dot(&way) / way.norm_squared()).clamp(0.0, 1.0);
            (off - way * share).norm()
        });
        distances.fold(f64::INFINITY, f64::min)
    }

    #[test]
    fn a_cloud_is_as_near_as_its_nearest_point() {
        let mut random = Pcg64::seed_from_u64(4);
        let points: Vec<Point3<f32>> = (0..400)
            .map(|_| Point3::from(any_point(&mut random, 0.5)).cast())
            .collect();
        let tree = KdTree::new(&points);
        let mut num_near = 0;
        for _ in 0..500 {
            let any = segment(any_point(&mut random, 1.5), any_point(&mut random, 1.5));
            let slow = slow_distance(&points, &any);
            let too_far = (slow * slow + MIN_STEP_M * MIN_STEP_M / 4.0).sqrt() + 1e-5;
            match any.distance_to_cloud(&tree, 0.1) {
                Some(found) => {
                    num_near += 1;
                    assert!(found > slow - 1e-5 && found < too_far, "{found} {slow}");
                }
                None => assert!(too_far > 0.1, "{slow}"),
            }
        }
        assert!((50..450).contains(&num_near), "{num_near}");
    }

    #[test]
    fn a_segment_without_length_is_a_point_and_no_cloud_is_near_nothing() {
        let at = segment([0.0, 0.0, 0.2], [0.0, 0.0, 0.2]);
        let points = [Point3::origin(), Point3::new(f32::NAN, 0.0, 0.2)];
        let tree = KdTree::new(&points);
        let found = at.distance_to_cloud(&tree, 1.0).expect("near");
        assert!((found - 0.2).abs() < 1e-6);
        assert_eq!(at.distance_to_cloud(&tree, 0.19), None);
        let empty = KdTree::new(&[]);
        assert_eq!(at.distance_to_cloud(&empty, f64::INFINITY), None);
        assert!((at.distance_to_box(&Vector3::repeat(0.1)) - 0.1).abs() < 1e-12);
    }
}
