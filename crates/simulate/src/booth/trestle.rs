//! The stand of a part in a paint booth: a frame of tubes behind it, clamps on its edge, bars beside it, legs to the floor.
//!
//! The frame is built in part space, because the part was laid or hung on it; the legs follow the world's vertical. The clamps
//! touch the part, and often bars of the frame do too: a gap around the part would make it too easy.

use std::f64::consts::{FRAC_PI_2, TAU};

use nalgebra::{Point3, Unit, Vector3};
use rand::RngExt as _;
use rand_pcg::Pcg64;

use crate::{
    assembly::Assembly,
    beam::{Section, sweep},
    rasteriser::Plane,
};
use geometry::rigid::RigidTransform;

/// The stand in camera space, and the floor below it.
pub(super) struct Trestle {
    pub(super) tubes: Assembly,
    pub(super) floor: Plane,
}

/// Builds a stand for the part with these vertices (part space). `down` is in camera space.
pub(super) fn trestle(
    part: &[Point3<f64>],
    camera_from_part: &RigidTransform,
    down: &Vector3<f64>,
    random: &mut Pcg64,
) -> Trestle {
    let mut tubes = Assembly::default();
    let tube = Tube::draw(random);
    let frame = Frame::draw(part, &tube, random);
    frame.build(&mut tubes, &tube, random);
    let first_direction = random.random_range(0.0..TAU);
    let num_clamps = random.random_range(2..=4);
    for clamp in 0..num_clamps {
        let direction = first_direction
            + TAU * (f64::from(clamp) + random.random_range(-0.3..0.3)) / f64::from(num_clamps);
        add_clamp(&mut tubes, part, &frame, direction, random);
    }
    for _ in 0..random.random_range(0..=2) {
        let quarter = f64::from(random.random_range(0..4)) * FRAC_PI_2;
        let direction = quarter + random.random_range(-0.25..0.25);
        add_bar_beside(&mut tubes, part, &frame, &tube, direction, random);
    }
    // From here on in camera space.
    let mut in_camera = Assembly::default();
    in_camera.add(&tubes.into_mesh(), |p| camera_from_part * p);
    let corners = frame.corners().map(|p| camera_from_part * p);
    let hung = part.iter().map(|p| camera_from_part * p);
    let lowest = hung
        .chain(corners)
        .map(|p| down.dot(&p.coords))
        .fold(f64::NEG_INFINITY, f64::max);
    let floor = Plane {
        normal: *down,
        // A camera on a flange is not this low above the floor.
        offset: f64::max(
            lowest + random.random_range(0.3..1.0),
            random.random_range(0.9..1.5),
        ),
    };
    let backwards = camera_from_part * Vector3::z();
    add_legs(&mut in_camera, &corners, &floor, &backwards, &tube, random);
    Trestle {
        tubes: in_camera,
        floor,
    }
}

/// The kind of tube of a stand.
struct Tube {
    section: Section,
    thickness: f64,
}

/// Longest piece of a tube, in metres: the rasteriser tries every pixel of a triangle's bounding box.
const PIECE_M: f64 = 0.12;

impl Tube {
    fn draw(random: &mut Pcg64) -> Self {
        let thickness = random.random_range(0.02..0.05);
        if random.random_bool(0.6) {
            Self::square(thickness)
        } else {
            Self::round(thickness)
        }
    }

    fn square(thickness: f64) -> Self {
        let section = Section::Bar {
            width: thickness,
            depth: thickness,
        };
        Self { section, thickness }
    }

    fn round(thickness: f64) -> Self {
        let radius = 0.5 * thickness;
        let section = Section::Round { radius };
        Self { section, thickness }
    }

    fn add(&self, tubes: &mut Assembly, from: Point3<f64>, to: Point3<f64>) {
        let along = to - from;
        let length = along.norm();
        if length < 1e-3 {
            return;
        }
        let num_pieces = (length / PIECE_M).ceil() as usize;
        let path: Vec<Point3<f64>> = (0..=num_pieces)
            .map(|k| from + along * (k as f64 / num_pieces as f64))
            .collect();
        // The axis most nearly perpendicular to the tube.
        let facing = Vector3::ith_axis(along.iamin()).into_inner();
        sweep(tubes, &path, self.section, facing);
    }
}

/// Two long bars and some cross bars in a plane behind the part, in part space.
struct Frame {
    /// The axis along the long bars, 0 for x or 1 for y; the cross bars follow the other one.
    along: usize,
    /// Positions of the long bars' ends on `along`.
    ends: [f64; 2],
    /// Positions of the long bars on the other axis.
    bars: [f64; 2],
    /// The plane of the bars.
    z: f64,
}

impl Frame {
    fn draw(part: &[Point3<f64>], tube: &Tube, random: &mut Pcg64) -> Self {
        let along = random.random_range(0..2_usize);
        let across = 1 - along;
        let extent = |axis: usize| {
            let values = || part.iter().map(|p| p[axis]);
            [
                values().fold(f64::INFINITY, f64::min),
                values().fold(f64::NEG_INFINITY, f64::max),
            ]
        };
        let (long, wide) = (extent(along), extent(across));
        let at = |share: f64| wide[0] + (wide[1] - wide[0]) * share;
        let bars = [
            at(random.random_range(0.05..0.4)),
            at(random.random_range(0.6..0.95)),
        ];
        let gap = if random.random_bool(0.4) {
            0.0
        } else {
            random.random_range(0.0..0.1)
        };
        // The part rests on the bars below it.
        let over_bars = part.iter().filter(|p| {
            bars.iter()
                .any(|bar| (p[across] - bar).abs() < tube.thickness)
        });
        let back = over_bars.map(|p| p.z).fold(f64::NEG_INFINITY, f64::max);
        let z = if back.is_finite() { back } else { 0.05 };
        Self {
            along,
            ends: [
                long[0] - random.random_range(-0.15..0.25),
                long[1] + random.random_range(-0.15..0.25),
            ],
            bars,
            z: z + gap + 0.5 * tube.thickness,
        }
    }

    /// Returns the point of the frame's plane at these positions along and across the long bars.
    fn at(&self, along: f64, across: f64) -> Point3<f64> {
        if self.along == 0 {
            Point3::new(along, across, self.z)
        } else {
            Point3::new(across, along, self.z)
        }
    }

    fn corners(&self) -> [Point3<f64>; 4] {
        let ([a, b], [c, d]) = (self.ends, self.bars);
        [self.at(a, c), self.at(b, c), self.at(a, d), self.at(b, d)]
    }

    fn build(&self, tubes: &mut Assembly, tube: &Tube, random: &mut Pcg64) {
        let [from, to] = self.ends;
        for bar in self.bars {
            tube.add(tubes, self.at(from, bar), self.at(to, bar));
        }
        let cross = if random.random_bool(0.5) {
            Tube::round(0.02)
        } else {
            Tube::square(tube.thickness)
        };
        for _ in 0..random.random_range(1..=3) {
            let place = from + (to - from) * random.random::<f64>();
            let [low, high] = self.bars;
            let low = low - random.random_range(0.0..0.2);
            let high = high + random.random_range(0.0..0.2);
            cross.add(tubes, self.at(place, low), self.at(place, high));
        }
    }

    /// Returns the nearest point of a long bar.
    fn nearest(&self, to: &Point3<f64>) -> Point3<f64> {
        let across = to[1 - self.along];
        let [a, b] = self.bars;
        let bar = if (across - a).abs() < (across - b).abs() {
            a
        } else {
            b
        };
        self.at(to[self.along].clamp(self.ends[0], self.ends[1]), bar)
    }
}

/// Returns the frontmost point of the part's edge in a direction of the xy plane, and the unit vectors in that direction
/// and across it.
fn edge_in_direction(
    part: &[Point3<f64>],
    direction: f64,
) -> Option<(Point3<f64>, [Vector3<f64>; 2])> {
    let (sin, cos) = direction.sin_cos();
    let reach = |p: &Point3<f64>| p.x * cos + p.y * sin;
    let farthest = part.iter().map(reach).fold(f64::NEG_INFINITY, f64::max);
    let edge = part.iter().filter(|p| reach(p) > farthest - 0.006);
    let front = edge.min_by(|a, b| a.z.total_cmp(&b.z))?;
    Some((
        *front,
        [Vector3::new(cos, sin, 0.0), Vector3::new(-sin, cos, 0.0)],
    ))
}

/// Adds a clamp: an arm from the frame to beside the edge, a jaw over the edge, a spindle with a cross handle.
fn add_clamp(
    tubes: &mut Assembly,
    part: &[Point3<f64>],
    frame: &Frame,
    direction: f64,
    random: &mut Pcg64,
) {
    let Some((edge, [outwards, aside])) = edge_in_direction(part, direction) else {
        return;
    };
    let size = random.random_range(0.014..0.028);
    let beside = edge + outwards * (0.5 * size + 0.002);
    let arm = Tube::square(size);
    let base = Point3::new(beside.x, beside.y, frame.z);
    arm.add(tubes, frame.nearest(&base), base);
    let top = beside - Vector3::z() * (0.5 * size);
    arm.add(tubes, base, top);
    if random.random_bool(0.7) {
        // The jaw is on the paint side.
        let reach = random.random_range(0.01..0.04);
        let jaw = edge - Vector3::z() * (0.5 * size + 0.001);
        arm.add(tubes, jaw + outwards * size, jaw - outwards * reach);
    }
    if random.random_bool(0.5) {
        let length = random.random_range(0.03..0.09);
        let tilt =
            aside * random.random_range(-0.3..0.3) + outwards * random.random_range(0.0..0.6);
        let end = top + (tilt - Vector3::z()).normalize() * length;
        Tube::round(0.012).add(tubes, top, end);
        let handle = Unit::new_normalize(aside + outwards * random.random_range(-0.8..0.8));
        let half = handle.into_inner() * random.random_range(0.02..0.06);
        Tube::round(0.012).add(tubes, end - half, end + half);
    }
}

/// Adds a bar beside the outline, at about the edge's depth, on arms from the frame.
fn add_bar_beside(
    tubes: &mut Assembly,
    part: &[Point3<f64>],
    frame: &Frame,
    tube: &Tube,
    direction: f64,
    random: &mut Pcg64,
) {
    let Some((edge, [outwards, aside])) = edge_in_direction(part, direction) else {
        return;
    };
    let gap = if random.random_bool(0.3) {
        0.0
    } else {
        random.random_range(0.0..0.03)
    };
    let middle = edge
        + outwards * (0.5 * tube.thickness + gap)
        + Vector3::z() * random.random_range(0.0..0.04);
    let [before, after] = [(); 2].map(|()| random.random_range(0.1..0.5));
    let (from, to) = (middle - aside * before, middle + aside * after);
    tube.add(tubes, from, to);
    for end in [from, to] {
        let base = Point3::new(end.x, end.y, frame.z);
        tube.add(tubes, end, base);
        tube.add(tubes, base, frame.nearest(&base));
    }
}

/// Adds legs from the frame's corners to the floor, each with a foot, and beams between some of them. `backwards` points from
/// the paint side to the back.
fn add_legs(
    tubes: &mut Assembly,
    corners: &[Point3<f64>; 4],
    floor: &Plane,
    backwards: &Vector3<f64>,
    tube: &Tube,
    random: &mut Pcg64,
) {
    let mut level = || {
        let v = Vector3::from_fn(|_, _| random.random_range(-0.2..0.2));
        v - floor.normal * floor.normal.dot(&v)
    };
    // If the part leans forwards, the legs slant back so that they do not stand in front of it.
    let down = &floor.normal;
    let level_back = backwards - down * down.dot(backwards);
    let needed = (0.05 - down.dot(backwards)).max(0.0);
    let back = level_back * (needed / level_back.norm_squared().max(0.1));
    let legs = corners.map(|top| {
        let along = floor.normal + back + level();
        // `along` descends by one, so this reaches the floor.
        let foot = top + along * (floor.offset - floor.normal.dot(&top.coords));
        (top, foot)
    });
    let foot_size = random.random_range(0.05..0.1);
    for (top, foot) in legs {
        tube.add(tubes, top, foot);
        Tube::square(foot_size).add(tubes, foot - floor.normal * 0.06, foot);
    }
    let height = random.random_range(0.4..0.85);
    for [a, b] in [[0, 1], [2, 3], [0, 2]] {
        if random.random_bool(0.6) {
            let on = |(top, foot): (Point3<f64>, Point3<f64>)| top + (foot - top) * height;
            tube.add(tubes, on(legs[a]), on(legs[b]));
        }
    }
}
