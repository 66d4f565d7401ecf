//! A cloud of a surface divided into cubes of a few points each, to find where the surface ends.
//!
//! Inside a surface, the mean of a cube's points is close to the mean of the points in it and in the adjacent cubes.
//! Where the surface ends it lies to one side of that mean, with no points beyond. Both means are sums over cubes, so
//! finding the borders costs little more than sorting the points into cubes.
//!
//! Known limits: borders of openings and bars narrower than two cubes are not found.

use nalgebra::{Matrix3, Point3, Vector3};

/// Target for the mean number of points per cube.
const POINTS_PER_CUBE: f64 = 6.0;
/// Accepted ratio to that target, up or down.
const MAX_DENSITY_RATIO: f64 = 1.3;
/// Bits of a cube's number along one axis.
const BITS_PER_AXIS: u32 = 21;
const MAX_CUBE_NUMBER: u64 = (1 << BITS_PER_AXIS) - 1;
/// Marks an empty slot.
const NOTHING: u32 = u32::MAX;
/// Minimum number of points in a cube and its neighbours to look for an end.
const MIN_POINTS_AROUND: f64 = 12.0;
/// Offset of a cube's mean from which the surface ends there, in cube sides; a straight end gives half a side.
const END_MIN_OFFSET_SIDES: f64 = 0.33;
/// Half the width of the strip across an end of the surface, and how far it may reach beyond a cube's mean, in cube sides.
const STRIP_HALF_WIDTH_SIDES: f64 = 0.75;
const STRIP_MAX_REACH_SIDES: f64 = 0.85;

/// A point at which a surface ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceEnd {
    /// A point of the border.
    pub at: Point3<f32>,
    /// Unit vector along the border.
    pub along: Vector3<f32>,
}

/// Points in cubes.
#[derive(Debug)]
pub struct SurfaceGrid<'a> {
    points: &'a [Point3<f32>],
    low: Point3<f32>,
    side: f64,
    cubes: Vec<Cube>,
    /// Hash table from cube places to cube numbers.
    slots: Vec<u32>,
    /// Indices of the points, cube by cube.
    members: Vec<u32>,
}

#[derive(Debug)]
struct Cube {
    place: u64,
    moments: Moments,
    /// Range of its points in `members`: the first, and one past the last.
    first: u32,
    end: u32,
}

/// Interpolates trilinearly between the values at the centres of 27 cubes; `within` is the offset from the central
/// one, in sides.
fn between(around: &[Vector3<f32>; 27], within: &Vector3<f32>) -> Vector3<f32> {
    let [x, y, z] = [0, 1, 2].map(|axis| {
        let share = within[axis].abs().min(1.0);
        [
            (1, 1.0 - share),
            (if within[axis] < 0.0 { 0 } else { 2 }, share),
        ]
    });
    let mut sum = Vector3::zeros();
    for (k, of_z) in z {
        for (j, of_y) in y {
            for (i, of_x) in x {
                sum += around[(k * 3 + j) * 3 + i] * (of_x * of_y * of_z);
            }
        }
    }
    sum
}

/// Sums over points, relative to the origin.
#[derive(Clone, Copy, Debug, Default)]
struct Moments {
    num: f64,
    sum: Vector3<f64>,
    /// xx, xy, xz, yy, yz, zz
    products: [f64; 6],
}

impl<'a> SurfaceGrid<'a> {
    /// Divides the points into cubes of about six points each. The points must be finite and centred on their mean.
    pub fn new(points: &'a [Point3<f32>]) -> Self {
        let first = points.first().copied().unwrap_or_default();
        let (low, high) = points
            .iter()
            .fold((first, first), |(low, high), p| (low.inf(p), high.sup(p)));
        let size = f64::from((high - low).amax()).max(f64::MIN_POSITIVE);
        let least = size / f64::from(1_u32 << (BITS_PER_AXIS - 1));
        // Assume a surface as large as its extent squared.
        let mut side = size * (POINTS_PER_CUBE / points.len().max(1) as f64).sqrt();
        let mut cut = Cut::new(points, &low, side.max(least));
        for _ in 0..4 {
            let off = POINTS_PER_CUBE * cut.places.len() as f64 / points.len().max(1) as f64;
            if (1.0 / MAX_DENSITY_RATIO..MAX_DENSITY_RATIO).contains(&off) {
                break;
            }
            side = (side * off.sqrt()).max(least);
            cut = Cut::new(points, &low, side);
        }
        cut.into_grid(points, low)
    }

    /// Side of a cube, metres.
    pub fn side(&self) -> f64 {
        self.side
    }

    /// Returns points along the borders of the surface, one per border cube.
    pub fn ends(&self) -> Vec<SurfaceEnd> {
        (0..self.cubes.len())
            .filter_map(|cube| self.end(cube))
            .collect()
    }

    /// Returns a unit normal for each point, towards the origin, interpolated between the adjacent cubes.
    pub fn normals(&self) -> Vec<Vector3<f32>> {
        let of_cubes: Vec<Vector3<f32>> = self.cubes.iter().map(|cube| self.normal(cube)).collect();
        let mut normals = vec![Vector3::zeros(); self.points.len()];
        for (cube, own) in self.cubes.iter().zip(&of_cubes) {
            let mut around = [Vector3::zeros(); 27];
            for (around, place) in around.iter_mut().zip(places_around(cube.place)) {
                if let Some(other) = self.cube_at(place) {
                    let normal = of_cubes[other];
                    *around = if normal.dot(own) < 0.0 {
                        -normal
                    } else {
                        normal
                    };
                }
            }
            for &member in &self.members[cube.first as usize..cube.end as usize] {
                let p = &self.points[member as usize];
                let between = between(&around, &self.within(cube, p));
                normals[member as usize] = between.try_normalize(0.0).unwrap_or(*own);
            }
        }
        normals
    }

    fn normal(&self, cube: &Cube) -> Vector3<f32> {
        let mut moments = Moments::default();
        for place in places_around(cube.place) {
            if let Some(other) = self.cube_at(place) {
                moments.add(&self.cubes[other].moments);
            }
        }
        let inwards = -cube.moments.mean();
        let normal = moments
            .normal()
            .or_else(|| inwards.try_normalize(f64::MIN_POSITIVE));
        let normal = normal.unwrap_or_else(Vector3::z);
        if normal.dot(&inwards) < 0.0 {
            -normal
        } else {
            normal
        }
        .cast()
    }

    /// Returns the offset of a point from the centre of its cube, in cube sides.
    fn within(&self, cube: &Cube, p: &Point3<f32>) -> Vector3<f32> {
        let at = (p - self.low) / self.side as f32;
        // Cubes are numbered from 1.
        let middle =
            |axis: u32| ((cube.place >> (axis * BITS_PER_AXIS)) & MAX_CUBE_NUMBER) as f32 - 0.5;
        at - Vector3::new(middle(0), middle(1), middle(2))
    }

    fn end(&self, number: usize) -> Option<SurfaceEnd> {
        let cube = &self.cubes[number];
        let mut around = [number; 27];
        let mut num_around = 0;
        let (mut num, mut sum) = (0.0, Vector3::zeros());
        for place in places_around(cube.place) {
            if let Some(other) = self.cube_at(place) {
                around[num_around] = other;
                num_around += 1;
                num += self.cubes[other].moments.num;
                sum += self.cubes[other].moments.sum;
            }
        }
        let mean = cube.moments.mean();
        let aside = mean - sum / num;
        if num < MIN_POINTS_AROUND || aside.norm() < END_MIN_OFFSET_SIDES * self.side {
            return None;
        }
        let mut moments = Moments::default();
        for &other in &around[..num_around] {
            moments.add(&self.cubes[other].moments);
        }
        let normal = moments.normal()?;
        let aside = aside - normal * normal.dot(&aside);
        if aside.norm() < END_MIN_OFFSET_SIDES * self.side {
            return None;
        }
        let out = aside.normalize();
        let along = normal.cross(&out);
        let (mut top, mut num_behind) = (f64::NEG_INFINITY, 0.0_f64);
        for &other in &around[..num_around] {
            let Cube { first, end, .. } = self.cubes[other];
            for &member in &self.members[first as usize..end as usize] {
                let off = self.points[member as usize].coords.cast::<f64>() - mean;
                let outwards = off.dot(&out);
                if off.dot(&along).abs() < STRIP_HALF_WIDTH_SIDES * self.side
                    && outwards > -self.side
                {
                    top = top.max(outwards);
                    num_behind += 1.0;
                }
            }
        }
        // Extend the surface by the spacing of its points.
        let at = top + (top + self.side) / num_behind.max(1.0);
        (top <= STRIP_MAX_REACH_SIDES * self.side).then(|| SurfaceEnd {
            at: Point3::from((mean + out * at).cast()),
            along: along.cast(),
        })
    }

    fn cube_at(&self, place: u64) -> Option<usize> {
        let mut slot = hash(place, self.slots.len());
        loop {
            let number = self.slots[slot];
            if number == NOTHING {
                return None;
            }
            if self.cubes[number as usize].place == place {
                return Some(number as usize);
            }
            slot = (slot + 1) & (self.slots.len() - 1);
        }
    }
}

/// The points assigned to cubes.
struct Cut {
    side: f64,
    places: Vec<u64>,
    slots: Vec<u32>,
    /// The cube of each point.
    of_point: Vec<u32>,
}

impl Cut {
    fn new(points: &[Point3<f32>], low: &Point3<f32>, side: f64) -> Self {
        let per_side = 1.0 / side;
        let mut cut = Self {
            side,
            places: Vec::new(),
            slots: vec![NOTHING; (2 * points.len()).next_power_of_two().max(2)],
            of_point: Vec::with_capacity(points.len()),
        };
        for p in points {
            // Number from 1, so that a cube at the low end has a neighbour before it.
            let along = |axis: usize| (f64::from(p[axis] - low[axis]) * per_side) as u64 + 1;
            let place = place_of([along(0), along(1), along(2)]);
            let number = cut.number_at(place);
            cut.of_point.push(number);
        }
        cut
    }

    fn number_at(&mut self, place: u64) -> u32 {
        let mut slot = hash(place, self.slots.len());
        loop {
            let number = self.slots[slot];
            if number == NOTHING {
                let number = self.places.len() as u32;
                self.slots[slot] = number;
                self.places.push(place);
                return number;
            }
            if self.places[number as usize] == place {
                return number;
            }
            slot = (slot + 1) & (self.slots.len() - 1);
        }
    }

    fn into_grid(self, points: &[Point3<f32>], low: Point3<f32>) -> SurfaceGrid<'_> {
        let empty = |place: u64| Cube {
            place,
            moments: Moments::default(),
            first: 0,
            end: 0,
        };
        let mut cubes: Vec<Cube> = self.places.into_iter().map(empty).collect();
        for (p, of) in points.iter().zip(&self.of_point) {
            let cube = &mut cubes[*of as usize];
            cube.moments.add_point(&p.coords.cast());
            cube.end += 1;
        }
        let mut first = 0;
        for cube in &mut cubes {
            let num = cube.end;
            (cube.first, cube.end) = (first, first);
            first += num;
        }
        let mut members = vec![0; points.len()];
        for (i, of) in (0_u32..).zip(&self.of_point) {
            let cube = &mut cubes[*of as usize];
            members[cube.end as usize] = i;
            cube.end += 1;
        }
        SurfaceGrid {
            points,
            low,
            side: self.side,
            cubes,
            slots: self.slots,
            members,
        }
    }
}

fn place_of([x, y, z]: [u64; 3]) -> u64 {
    (z << (2 * BITS_PER_AXIS)) | (y << BITS_PER_AXIS) | x
}

/// Iterates over a place and the 26 around it.
fn places_around(place: u64) -> impl Iterator<Item = u64> {
    let low = place - place_of([1, 1, 1]);
    (0..27).map(move |i| low + place_of([i % 3, i / 3 % 3, i / 9]))
}

/// Multiplies by 2^64 over the golden ratio and keeps the leading bits (D. E. Knuth, "The Art of Computer
/// Programming", vol. 3, 6.4).
fn hash(place: u64, num_slots: usize) -> usize {
    let bits = num_slots.trailing_zeros();
    (place.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> (64 - bits)) as usize
}

impl Moments {
    fn add_point(&mut self, p: &Vector3<f64>) {
        self.num += 1.0;
        self.sum += p;
        let products = [
            p.x * p.x,
            p.x * p.y,
            p.x * p.z,
            p.y * p.y,
            p.y * p.z,
            p.z * p.z,
        ];
        for (sum, product) in self.products.iter_mut().zip(products) {
            *sum += product;
        }
    }

    fn add(&mut self, other: &Self) {
        self.num += other.num;
        self.sum += other.sum;
        for (sum, product) in self.products.iter_mut().zip(other.products) {
            *sum += product;
        }
    }

    fn mean(&self) -> Vector3<f64> {
        self.sum / self.num
    }

    /// Returns the direction of least variance; `None` for points on a line.
    ///
    /// The eigenvalue is a root of the characteristic polynomial in closed form (O. K. Smith, "Eigenvalues of a
    /// symmetric 3 × 3 matrix", Communications of the ACM 4(4), 1961); the vector is perpendicular to the rows of
    /// the matrix minus the eigenvalue.
    fn normal(&self) -> Option<Vector3<f64>> {
        let [xx, xy, xz, yy, yz, zz] = self.products.map(|product| product / self.num);
        let mean = self.mean();
        let covariance = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz) - mean * mean.transpose();
        let middle = covariance.trace() / 3.0;
        let off = covariance - Matrix3::identity() * middle;
        let spread = (off.norm_squared() / 6.0).sqrt();
        if !(spread > 0.0) {
            return None;
        }
        let angle = ((off / spread).determinant() / 2.0).clamp(-1.0, 1.0).acos() / 3.0;
        let least = 2.0 * spread * (angle + std::f64::consts::TAU / 3.0).cos();
        let left = off - Matrix3::identity() * least;
        let [a, b, c] = [0, 1, 2].map(|i| left.row(i).transpose());
        let crosses = [a.cross(&b), b.cross(&c), c.cross(&a)];
        let longest = crosses
            .into_iter()
            .max_by(|a, b| a.norm_squared().total_cmp(&b.norm_squared()))?;
        let length = longest.norm();
        (length > 1e-6 * spread * spread).then(|| longest / length)
    }
}

#[cfg(test)]
mod tests {
    use rand::{RngExt as _, SeedableRng as _};
    use rand_pcg::Pcg64;

    use super::*;

    #[test]
    fn a_sheet_ends_at_its_outline_and_at_its_opening_and_nowhere_else() {
        let mut rng = Pcg64::seed_from_u64(3);
        let hole = Point3::new(0.6, 0.4, 0.0);
        let points: Vec<Point3<f32>> = (0..12_000)
            .map(|_| [(); 3].map(|()| rng.random::<f32>()))
            .map(|[u, v, noise]| Point3::new(u, 0.8 * v, 0.2 * u * u + 0.002 * noise))
            .filter(|p| (p.x - hole.x).hypot(p.y - hole.y) > 0.15)
            .collect();
        let grid = SurfaceGrid::new(&points);
        assert!((0.015..0.03).contains(&grid.side()), "{}", grid.side());
        let ends = grid.ends();
        let off = |end: &SurfaceEnd| {
            let (x, y) = (end.at.x, end.at.y);
            let outer = [x, 1.0 - x, y, 0.8 - y]
                .into_iter()
                .fold(
                    f32::INFINITY,
                    |least, d| {
                        if d.abs() < least.abs() { d } else { least }
                    },
                );
            let inner = (x - hole.x).hypot(y - hole.y) - 0.15;
            if inner.abs() < outer.abs() {
                inner
            } else {
                outer
            }
        };
        let near = ends.iter().filter(|end| off(end).abs() < 0.01);
        assert!(near.count() * 100 > 97 * ends.len(), "{} ends", ends.len());
        // An outline of 3.6 m and an opening of 0.94 m, in cubes of about 2 cm.
        assert!((180..600).contains(&ends.len()), "{} ends", ends.len());
        let mean = ends.iter().map(off).sum::<f32>() / ends.len() as f32;
        assert!(mean.abs() < 0.002, "{mean}");
        let is_bottom = |end: &&SurfaceEnd| end.at.y < 0.01 && (0.1..0.9).contains(&end.at.x);
        let bottom = ends.iter().filter(is_bottom);
        let (num, num_along) = bottom.fold((0, 0), |(num, num_along), end| {
            (num + 1, num_along + i32::from(end.along.y.abs() < 0.5))
        });
        assert!(num > 20 && num_along * 5 > num * 4, "{num_along} of {num}");
        let normals = grid.normals();
        let off = points.iter().zip(&normals).filter(|(p, normal)| {
            let slope = Vector3::new(-0.4 * p.x, 0.0, 1.0).normalize();
            normal.dot(&slope).abs() < 0.999
        });
        assert!(off.count() * 100 < points.len());
    }

    #[test]
    fn a_closed_surface_has_no_end_and_few_points_have_none() {
        let ball: Vec<Point3<f32>> = (0..8000)
            .map(|i| {
                let z = -1.0 + (f64::from(i) + 0.5) / 4000.0;
                let turn = f64::from(i) * std::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
                let r = (1.0 - z * z).sqrt();
                Point3::new(r * turn.cos(), r * turn.sin(), z).cast()
            })
            .collect();
        assert!(SurfaceGrid::new(&ball).ends().len() < 20);
        assert_eq!(SurfaceGrid::new(&ball[..5]).ends(), []);
        assert_eq!(SurfaceGrid::new(&[]).ends(), []);
    }
}
