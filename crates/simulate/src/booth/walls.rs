//! The booth around the stand: one wall or a corner, the floor, and fixtures and clutter.

use nalgebra::{Point3, UnitQuaternion, Vector3};
use rand::RngExt as _;
use rand_pcg::Pcg64;

use crate::{
    assembly::Assembly,
    beam::block,
    rasteriser::{Plane, SurfaceLabel},
};

/// Walls and floor, ribs and frames on the walls, and clutter in front of them, in camera space.
pub(super) struct Walls {
    pub(super) planes: Vec<(Plane, SurfaceLabel)>,
    pub(super) fixtures: Assembly,
    pub(super) clutter: Assembly,
}

/// Distance of the back wall behind the part, in metres.
const BEHIND_M: std::ops::Range<f64> = 0.8..2.0;
/// Largest angle at which a wall counts as facing the camera, in radians.
const SQUARE_RAD: f64 = 0.25;
/// Distance of a second wall beside the part, in metres.
const BESIDE_M: std::ops::Range<f64> = 0.25..1.0;
/// Longest side of a box's pieces, in metres: the rasteriser tries every pixel of a triangle's bounding box.
const PIECE_M: f64 = 0.6;
/// Fixtures extend this far from the wall's middle, in metres.
const REACH_M: f64 = 2.4;

/// Draws walls around the part with these points (camera space).
pub(super) fn walls(
    part: &[Point3<f64>],
    camera_from_world: &UnitQuaternion<f64>,
    floor: Plane,
    random: &mut Pcg64,
) -> Walls {
    let mut fixtures = Assembly::default();
    let mut clutter = Assembly::default();
    // Usually facing the camera, sometimes oblique.
    let oblique = if random.random_bool(0.65) {
        SQUARE_RAD
    } else {
        0.8
    };
    let heading: f64 = random.random_range(-oblique..oblique);
    let back = Wall::beyond(
        part,
        camera_from_world,
        heading,
        random.random_range(BEHIND_M),
    );
    back.add_fixtures(&mut fixtures, random);
    back.put_before(&mut clutter, &floor, random);
    let mut planes = vec![
        (back.plane, SurfaceLabel::Wall),
        (floor, SurfaceLabel::Floor),
    ];
    // An oblique wall recedes beyond the sensor's range unless a second wall closes it off.
    let is_closed_off = heading.abs() > SQUARE_RAD;
    if is_closed_off || random.random_bool(0.4) {
        let receding = -heading.signum();
        let side = if is_closed_off || random.random_bool(0.5) {
            receding
        } else {
            -receding
        };
        let quarter = side * std::f64::consts::FRAC_PI_2;
        let beside = random.random_range(BESIDE_M);
        let side = Wall::beyond(part, camera_from_world, heading + quarter, beside);
        if random.random_bool(0.5) {
            side.add_fixtures(&mut fixtures, random);
        }
        planes.push((side.plane, SurfaceLabel::Wall));
    }
    Walls {
        planes,
        fixtures,
        clutter,
    }
}

/// An upright wall with its own coordinates: along it, down, and through it away from the viewer.
struct Wall {
    plane: Plane,
    /// The point of the wall behind the part's middle.
    middle: Point3<f64>,
    along: Vector3<f64>,
    down: Vector3<f64>,
}

impl Wall {
    fn beyond(
        part: &[Point3<f64>],
        camera_from_world: &UnitQuaternion<f64>,
        heading: f64,
        gap: f64,
    ) -> Self {
        let (sin, cos) = heading.sin_cos();
        let normal = camera_from_world * Vector3::new(sin, 0.0, cos);
        let reach = part.iter().map(|p| normal.dot(&p.coords));
        // The camera is in front of it too.
        let offset = reach.fold(0.2, f64::max) + gap;
        let sum: Vector3<f64> = part.iter().map(|p| p.coords).sum();
        let middle = sum / part.len().max(1) as f64;
        Self {
            plane: Plane { normal, offset },
            middle: Point3::from(middle + normal * (offset - normal.dot(&middle))),
            along: camera_from_world * Vector3::new(cos, 0.0, -sin),
            down: camera_from_world * Vector3::y(),
        }
    }

    fn place(&self, p: Point3<f64>) -> Point3<f64> {
        self.middle + self.along * p.x + self.down * p.y + self.plane.normal * p.z
    }

    /// Adds a box on the wall: its middle (along, down), its width and height, and how far it protrudes.
    fn add_block(&self, to: &mut Assembly, middle: [f64; 2], size: [f64; 2], out: f64) {
        self.add_box(to, middle, size, [0.0, out]);
    }

    /// Adds a box between two distances in front of the wall.
    fn add_box(&self, to: &mut Assembly, middle: [f64; 2], size: [f64; 2], out: [f64; 2]) {
        let z = -f64::midpoint(out[0], out[1]);
        let depth = out[1] - out[0];
        let num = size.map(|s| (s / PIECE_M).ceil().max(1.0));
        let [width, height] = [size[0] / num[0], size[1] / num[1]];
        let mut pieces = Assembly::default();
        for row in 0..num[1] as usize {
            for column in 0..num[0] as usize {
                let x = middle[0] + width * (column as f64 - 0.5 * (num[0] - 1.0));
                let y = middle[1] + height * (row as f64 - 0.5 * (num[1] - 1.0));
                block(
                    &mut pieces,
                    Point3::new(x, y, z),
                    Vector3::new(width, height, depth),
                );
            }
        }
        to.add(&pieces.into_mesh(), |p| self.place(p));
    }

    /// Adds ribs or panels, or neither, and up to four frames.
    fn add_fixtures(&self, fixtures: &mut Assembly, random: &mut Pcg64) {
        match random.random_range(0..4) {
            0 => self.add_ribs(fixtures, random),
            1 => self.add_panels(fixtures, random),
            _ => {}
        }
        for _ in 0..random.random_range(0..=4) {
            self.add_frame(fixtures, random);
        }
    }

    fn add_ribs(&self, fixtures: &mut Assembly, random: &mut Pcg64) {
        let spacing = random.random_range(0.2..0.7);
        let width = random.random_range(0.03..0.08);
        let out = random.random_range(0.02..0.05);
        let is_upright = random.random_bool(0.7);
        let mut place = -REACH_M + random.random_range(0.0..spacing);
        while place < REACH_M {
            if is_upright {
                self.add_block(fixtures, [place, 0.0], [width, 2.0 * REACH_M], out);
            } else {
                self.add_block(fixtures, [0.0, place], [2.0 * REACH_M, width], out);
            }
            place += spacing;
        }
    }

    fn add_panels(&self, fixtures: &mut Assembly, random: &mut Pcg64) {
        let width = random.random_range(0.5..1.2);
        let height = random.random_range(0.5..1.5);
        let seam = random.random_range(0.015..0.04);
        let out = random.random_range(0.012..0.03);
        let start = random.random_range(0.0..width);
        for column in -2..=2 {
            for row in -2..=2 {
                let middle = [f64::from(column) * width + start, f64::from(row) * height];
                self.add_block(fixtures, middle, [width - seam, height - seam], out);
            }
        }
    }

    /// Adds a window's frame, or a vent: a frame with slats.
    fn add_frame(&self, fixtures: &mut Assembly, random: &mut Pcg64) {
        let middle = [
            random.random_range(-1.2..1.2),
            random.random_range(-1.2..1.0),
        ];
        let size = [
            random.random_range(0.25..1.0),
            random.random_range(0.15..0.5),
        ];
        let out = random.random_range(0.02..0.05);
        let rim = random.random_range(0.025..0.05);
        let half = size.map(|s| 0.5 * s);
        for side in [-1.0, 1.0] {
            let upright = [middle[0] + side * half[0], middle[1]];
            self.add_block(fixtures, upright, [rim, size[1] + rim], out);
            let level = [middle[0], middle[1] + side * half[1]];
            self.add_block(fixtures, level, [size[0] + rim, rim], out);
        }
        if random.random_bool(0.5) {
            let spacing = random.random_range(0.04..0.07);
            let num_slats = (size[1] / spacing) as usize;
            for slat in 1..num_slats {
                let down = middle[1] - half[1] + slat as f64 * spacing;
                self.add_block(
                    fixtures,
                    [middle[0], down],
                    [size[0], 0.5 * spacing],
                    0.8 * out,
                );
            }
        }
    }

    /// Adds a column and a rail in front of the wall, and boxes on the floor at its foot.
    fn put_before(&self, clutter: &mut Assembly, floor: &Plane, random: &mut Pcg64) {
        let side = if random.random_bool(0.5) { 1.0 } else { -1.0 };
        if random.random_bool(0.5) {
            let width = random.random_range(0.06..0.2);
            let place = side * random.random_range(0.45..1.1);
            let out = random.random_range(0.08..0.4);
            let lean: f64 = random.random_range(-0.35..0.35);
            let (sin, cos) = lean.sin_cos();
            let leaning = Self {
                middle: self.place(Point3::new(place, 0.0, 0.0)),
                along: self.along * cos + self.down * sin,
                down: self.down * cos - self.along * sin,
                ..*self
            };
            leaning.add_box(
                clutter,
                [0.0, 0.0],
                [width, 2.0 * REACH_M],
                [out, out + width],
            );
        }
        if random.random_bool(0.35) {
            let height = random.random_range(0.03..0.1);
            let down = random.random_range(-0.9..0.9);
            let out = random.random_range(0.06..0.2);
            self.add_box(
                clutter,
                [0.0, down],
                [2.0 * REACH_M, height],
                [out, out + 0.05],
            );
            for place in [-1.5, -0.5, 0.5, 1.5] {
                self.add_block(clutter, [place, down], [0.04, 0.04], out);
            }
        }
        let to_floor = floor.offset - floor.normal.dot(&self.middle.coords);
        for _ in 0..random.random_range(0..=2) {
            let size = [(); 3].map(|()| random.random_range(0.12..0.45));
            let along = side * random.random_range(-1.2..0.4);
            let out = random.random_range(0.02..0.3);
            let middle = [along, to_floor - 0.5 * size[1]];
            self.add_box(clutter, middle, [size[0], size[1]], [out, out + size[2]]);
        }
    }
}
