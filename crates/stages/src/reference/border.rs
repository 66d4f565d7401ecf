//! The border of a part as oriented points, and the point pairs used to locate a piece of it.
//!
//! Two border points with their directions and surface normals define a pose, and few other pairs have the same
//! distance and angles: after B. Drost, M. Ulrich, N. Navab and S. Ilic, "Model globally, match locally: efficient and
//! robust 3D object recognition", CVPR 2010, with border points as in C. Choi, Y. Taguchi, O. Tuzel, M.-Y. Liu and S.
//! Ramalingam, "Voting-based pose estimation for robotic assembly using a 3D sensor", ICRA 2012. The poses from pairs
//! are scored instead of voted for.

use nalgebra::{Matrix3, Point3, Vector3};

use geometry::{nearest_field::NearestField, statistics::sample_evenly};

/// A point where the surface ends, or turns away from the viewer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BorderPoint {
    /// Position.
    pub at: Point3<f32>,
    /// Unit vector along the border, with the surface to its left as seen from the front.
    pub along: Vector3<f32>,
    /// Unit normal of the surface, towards the viewer.
    pub normal: Vector3<f32>,
}

/// An ordered pair of border points.
#[derive(Clone, Copy, Debug)]
pub struct BorderPair {
    /// Distance between the points, metres.
    pub distance: f32,
    /// At each point, the angle about the normal from the border's direction to the other point, radians.
    pub angles: [f32; 2],
    /// Indices of the two points.
    pub of: [u16; 2],
}

/// A pair of a reference's border that defines a frame.
#[derive(Clone, Copy, Debug)]
pub struct ReferencePair {
    /// Distance, angles and points.
    pub pair: BorderPair,
    /// Unit vector across the pair, towards the viewer; stored because it is the most expensive part of the frame.
    across: Vector3<f32>,
}

/// The border of a reference from one side.
#[derive(Clone, Debug)]
pub struct ReferenceBorder {
    /// Evenly distributed points.
    pub points: Vec<BorderPoint>,
    /// All usable pairs, sorted by bin.
    pairs: Vec<ReferencePair>,
    /// Start of each bin of distance and angles in `pairs`, and the end of the last one.
    bins: Vec<u32>,
    /// Nearest-point field of all outlines from this side.
    pub field: NearestField,
}

/// Number of points of a reference's border that are paired: about one per 4 cm for a door.
const NUM_POINTS: usize = 128;
/// Minimum distance of a pair, metres: closer pairs do not determine a pose.
pub const MIN_DISTANCE_M: f32 = 0.15;
/// Distances beyond this share a bin, metres; followed by the width of the distance bins, metres, and the number of
/// bins of each angle.
const MAX_DISTANCE_M: f32 = 2.4;
const DISTANCE_BIN_M: f32 = 0.04;
const NUM_ANGLES: usize = 24;
/// Cell size of the nearest-point field and the distance up to which it answers, metres.
const FIELD_CELL_M: f32 = 0.02;
const FIELD_BAND_M: f32 = 0.06;

impl ReferenceBorder {
    /// Creates the border from the oriented points of one view's outline, part space. `outlines` are the points at
    /// which the surface ends or turns away in any view from the same side.
    pub fn new(all: &[BorderPoint], outlines: &[Point3<f32>]) -> Self {
        let points: Vec<BorderPoint> = sample_evenly(all, NUM_POINTS).copied().collect();
        let num = points.len();
        let mut framed = vec![None; num * num];
        for (i, a) in points.iter().enumerate() {
            for (j, b) in points.iter().enumerate().skip(i + 1) {
                let pair = ReferencePair::of([a, b], [i as u16, j as u16]);
                framed[i * num + j] = pair;
                framed[j * num + i] = pair.map(ReferencePair::reversed);
            }
        }
        let num_bins = (distance_bin(MAX_DISTANCE_M) + 1) * NUM_ANGLES * NUM_ANGLES;
        let mut bins = vec![0; num_bins + 1];
        let framed: Vec<ReferencePair> = framed.into_iter().flatten().collect();
        for pair in &framed {
            bins[pair.pair.bin() + 1] += 1;
        }
        for number in 0..num_bins {
            bins[number + 1] += bins[number];
        }
        // A counting sort.
        let (mut pairs, mut next) = (framed.clone(), bins.clone());
        for pair in framed {
            let index = &mut next[pair.pair.bin()];
            pairs[*index as usize] = pair;
            *index += 1;
        }
        Self {
            points,
            pairs,
            bins,
            field: NearestField::new(outlines, FIELD_CELL_M, FIELD_BAND_M),
        }
    }

    /// Calls `visit` with each pair whose distance and angles differ from `pair` by less than the given limits, metres
    /// and radians.
    pub fn visit_pairs_like(
        &self,
        pair: &BorderPair,
        distance_off: f32,
        angle_off: f32,
        mut visit: impl FnMut(&ReferencePair),
    ) {
        let is_like = |other: &BorderPair| {
            let is_as_far = (other.distance - pair.distance).abs() < distance_off;
            let [is_like_here, is_like_there] =
                [0, 1].map(|end| angle_between(pair.angles[end], other.angles[end]) < angle_off);
            // Combined into one branch instead of three: each condition fails often, and a misprediction costs more than
            // evaluating them.
            is_as_far & is_like_here & is_like_there
        };
        let distances = distance_bin((pair.distance - distance_off).max(0.0))
            ..=distance_bin(pair.distance + distance_off);
        let reach = (angle_off / BIN_ANGLE_RAD).ceil() as usize;
        let middle = angle_bin(pair.angles[0], NUM_ANGLES) + NUM_ANGLES;
        let [first, last] =
            [-angle_off, angle_off].map(|off| angle_bin(pair.angles[1] + off, NUM_ANGLES));
        // Bins of neighbouring second angles follow each other, up to a whole turn.
        let runs = if first <= last {
            [first..last + 1, 0..0]
        } else {
            [first..NUM_ANGLES, 0..last + 1]
        };
        for distance in distances {
            for angle in middle - reach..=middle + reach {
                let of_angle = (distance * NUM_ANGLES + angle % NUM_ANGLES) * NUM_ANGLES;
                for run in &runs {
                    let [start, end] =
                        [run.start, run.end].map(|bin| self.bins[of_angle + bin] as usize);
                    let in_bins = self.pairs[start..end].iter();
                    in_bins
                        .filter(|other| is_like(&other.pair))
                        .for_each(&mut visit);
                }
            }
        }
    }
}

/// Width of a bin of an angle, radians.
const BIN_ANGLE_RAD: f32 = std::f32::consts::TAU / NUM_ANGLES as f32;

fn distance_bin(distance: f32) -> usize {
    (distance.min(MAX_DISTANCE_M) / DISTANCE_BIN_M) as usize
}

fn angle_bin(angle: f32, num: usize) -> usize {
    let turns = angle / std::f32::consts::TAU;
    ((turns - turns.floor()) * num as f32) as usize % num
}

fn angle_between(a: f32, b: f32) -> f32 {
    let off = (a - b).abs();
    let other_way = std::f32::consts::TAU - off;
    if other_way < off { other_way } else { off }
}

impl BorderPair {
    /// Creates a pair; `None` if the points are too close.
    pub fn of([a, b]: [&BorderPoint; 2], of: [u16; 2]) -> Option<Self> {
        let towards = b.at - a.at;
        let distance = towards.norm();
        (distance >= MIN_DISTANCE_M).then(|| Self {
            distance,
            angles: [angle(a, &towards), angle(b, &-towards)],
            of,
        })
    }

    /// Number of the bin of its distance and angles.
    fn bin(&self) -> usize {
        let [here, there] = self.angles.map(|angle| angle_bin(angle, NUM_ANGLES));
        (distance_bin(self.distance) * NUM_ANGLES + here) * NUM_ANGLES + there
    }

    /// Returns the unit vector from the first point to the second.
    fn along(&self, [a, b]: [&BorderPoint; 2]) -> Vector3<f32> {
        (b.at - a.at) / self.distance
    }

    /// Returns true if both points lie on one straight border, along which they could slide.
    pub fn is_straight(&self) -> bool {
        self.angles
            .iter()
            .all(|a| a.sin().abs() < STRAIGHT_MAX_SINE)
    }
}

/// Sine of the angle to the border's direction below which a point lies on it.
const STRAIGHT_MAX_SINE: f32 = 0.25;

impl ReferencePair {
    /// Creates a pair; `None` if the points are too close or face away from each other.
    fn of(ends: [&BorderPoint; 2], of: [u16; 2]) -> Option<Self> {
        let pair = BorderPair::of(ends, of)?;
        let across = across(ends, &pair.along(ends))?;
        Some(Self { pair, across })
    }

    /// Returns the pair with its ends swapped, bit-identical to one created that way.
    fn reversed(mut self) -> Self {
        self.pair.angles.reverse();
        self.pair.of.reverse();
        self
    }

    /// Returns the middle and axes, bit-identical to [`frame_of`]; `ends` are the points of the pair.
    pub fn frame(&self, ends: [&BorderPoint; 2]) -> (Point3<f32>, Matrix3<f32>) {
        frame(ends, self.pair.along(ends), self.across)
    }
}

fn angle(from: &BorderPoint, towards: &Vector3<f32>) -> f32 {
    let inwards = from.normal.cross(&from.along);
    towards.dot(&inwards).atan2(towards.dot(&from.along))
}

/// Returns the middle and axes of a pair: x along it, z the mean normal across it.
pub fn frame_of(ends: [&BorderPoint; 2]) -> Option<(Point3<f32>, Matrix3<f32>)> {
    let [a, b] = ends;
    let along = (b.at - a.at).try_normalize(1e-6)?;
    Some(frame(ends, along, across(ends, &along)?))
}

/// Returns the mean normal of two points, as a unit vector perpendicular to the line through them.
fn across([a, b]: [&BorderPoint; 2], along: &Vector3<f32>) -> Option<Vector3<f32>> {
    let normal = a.normal + b.normal;
    (normal - along * normal.dot(along)).try_normalize(0.5)
}

fn frame(
    [a, b]: [&BorderPoint; 2],
    x: Vector3<f32>,
    z: Vector3<f32>,
) -> (Point3<f32>, Matrix3<f32>) {
    let middle = nalgebra::center(&a.at, &b.at);
    (middle, Matrix3::from_columns(&[x, z.cross(&x), z]))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A flat disc of 0.5 m, seen from the front, counter-clockwise.
    fn disc(num: usize) -> Vec<BorderPoint> {
        (0..num)
            .map(|i| {
                let turn = i as f32 / num as f32 * std::f32::consts::TAU;
                BorderPoint {
                    at: Point3::new(0.5 * turn.cos(), 0.5 * turn.sin(), 0.0),
                    along: Vector3::new(-turn.sin(), turn.cos(), 0.0),
                    normal: Vector3::z(),
                }
            })
            .collect()
    }

    #[test]
    fn the_pairs_like_one_are_those_of_a_plain_search() {
        let points = disc(60);
        let border = ReferenceBorder::new(&points, &[]);
        let pairs = || (0..60).flat_map(|i| (0..60).map(move |j| [i, j]));
        let of = |[i, j]: [u16; 2]| {
            BorderPair::of([&points[usize::from(i)], &points[usize::from(j)]], [i, j])
        };
        for wanted in [[0, 7], [12, 40], [59, 3]].map(|ends| of(ends).expect("far apart")) {
            let mut found: Vec<[u16; 2]> = Vec::new();
            border.visit_pairs_like(&wanted, 0.1, 0.24, |like| found.push(like.pair.of));
            let is_like = |other: &BorderPair| {
                (other.distance - wanted.distance).abs() < 0.1
                    && (0..2).all(|end| {
                        (other.angles[end] - wanted.angles[end]).sin().abs() < 0.24_f32.sin()
                            && (other.angles[end] - wanted.angles[end]).cos() > 0.0
                    })
            };
            let mut plain: Vec<[u16; 2]> = pairs()
                .filter(|ends| of(*ends).is_some_and(|pair| is_like(&pair)))
                .collect();
            found.sort_unstable();
            plain.sort_unstable();
            assert!(found.len() >= 60, "{}", found.len());
            assert_eq!(found, plain);
        }
    }

    #[test]
    fn the_pairs_of_a_border_are_those_with_a_frame_and_keep_it_to_the_bit() {
        // A ring whose surface turns over twice along the way.
        let mut points = disc(60);
        for (i, point) in points.iter_mut().enumerate() {
            let (sin, cos) = (i as f32 * 0.2).sin_cos();
            let outwards = point.at.coords.normalize();
            point.normal = outwards * sin + Vector3::z() * cos;
            point.at.z = 0.05 * sin;
        }
        let border = ReferenceBorder::new(&points, &[]);
        let framed = (0..60).flat_map(|i| (0..60).map(move |j| [i, j]));
        let framed = framed.filter(|ends| {
            let ends = ends.map(|i| &points[i]);
            BorderPair::of(ends, [0, 0]).is_some() && frame_of(ends).is_some()
        });
        let num_framed = framed.count();
        assert_eq!(border.pairs.len(), num_framed);
        assert!((500..3000).contains(&num_framed), "{num_framed}");
        for pair in &border.pairs {
            let ends = pair.pair.of.map(|i| &border.points[usize::from(i)]);
            assert_eq!(Some(pair.frame(ends)), frame_of(ends));
        }
    }

    #[test]
    fn the_angles_of_a_pair_on_a_circle_are_alike_and_the_surface_lies_to_the_left() {
        let points = disc(60);
        let pair = BorderPair::of([&points[0], &points[15]], [0, 15]).expect("far apart");
        // A quarter chord meets the circle at an eighth of a turn on either side, inwards.
        assert!((pair.angles[0] - std::f32::consts::FRAC_PI_4).abs() < 1e-3);
        assert!((pair.angles[1] - 3.0 * std::f32::consts::FRAC_PI_4).abs() < 1e-3);
        assert!(!pair.is_straight());
        let (_, axes) = frame_of([&points[0], &points[15]]).expect("a frame");
        assert!((axes.determinant() - 1.0).abs() < 1e-5);
    }
}
