//! Shadows: points that another part of the surface hides from the mouth of the gun.
//!
//! Every point stands for a disc perpendicular to its normal. A point is hidden if the ray from the mouth to it meets
//! another disc more than [`LAYER_TOLERANCE_SPACINGS`] before the point. The discs in the jet are sorted into cells of directions from
//! the mouth, each into all cells that its ball touches, so a ray is tested against the discs of one cell alone. A ray
//! meets no disc of a smooth surface before the point, however flat its angle, so smooth surfaces do not shadow
//! themselves. The cells do not change the result: it is the same wherever the part hangs. With rays
//! from far away, the same discs show which points are visible from a direction.
//!
//! Known limits: layers closer to each other than the tolerance cast no shadow. The edge of a shadow is exact to about
//! the spacing of the points.

use nalgebra::Vector3;

use super::surface::{PaintSurface, across};

/// Radius of a disc in spacings of the points: discs around the corners of a square meet in its middle.
pub(super) const DISC_RADIUS_SPACINGS: f64 = 0.75;
/// Depths that differ by less belong to one layer, in spacings of the points.
pub(super) const LAYER_TOLERANCE_SPACINGS: f64 = 2.0;
/// Side of a cell at the stand-off, in spacings of the points.
const CELL_SPACINGS: f64 = 1.5;
/// Most cells along each axis; on a finer surface more discs share a cell.
const MAX_CELLS_PER_AXIS: f64 = 256.0;
/// Index of no entry.
const NONE: u32 = u32::MAX;
/// Discs seen at a smaller cosine than this hide nothing.
pub(super) const MIN_FACING_COS: f64 = 0.05;

/// A point of the surface in the axes of the jet: x along the fan, y across it, z along the jet.
#[derive(Clone, Copy, Debug)]
pub(super) struct Seen {
    pub(super) index: usize,
    pub(super) at: Vector3<f64>,
    pub(super) normal: Vector3<f64>,
}

impl Seen {
    /// Depth along the jet at which a ray meets the disc; `None` if it misses the disc or meets it edge-on.
    fn met_by(&self, ray: &Vector3<f64>, radius: f64) -> Option<f64> {
        let facing = self.normal.dot(ray);
        if facing.abs() <= MIN_FACING_COS * ray.norm() {
            return None;
        }
        let at = ray * (self.normal.dot(&self.at) / facing);
        let is_met = at.z > 0.0 && (at - self.at).norm_squared() <= radius * radius;
        is_met.then_some(at.z)
    }
}

/// The discs in a jet, sorted by their directions from the mouth.
#[derive(Debug)]
pub(super) struct DirectionGrid {
    /// The last entry of each cell.
    last: Vec<u32>,
    /// A disc, as its index among the sorted points, and the previous entry of the same cell.
    entries: Vec<[u32; 2]>,
    /// Slopes of the grid's edge.
    edge: [f64; 2],
    size: [usize; 2],
    cell: f64,
    /// Radius of a disc, metres; then the tolerance of depths, metres.
    radius: f64,
    tolerance: f64,
}

impl DirectionGrid {
    /// Makes a grid for a jet with these slopes, over points of this spacing at about this distance.
    pub(super) fn new(spread: [f64; 2], spacing: f64, stand_off: f64) -> Self {
        let widest = spread[0].max(spread[1]);
        let cell = (CELL_SPACINGS * spacing / stand_off).max(2.0 * widest / MAX_CELLS_PER_AXIS);
        let size = spread.map(|slope| (2.0 * slope / cell).ceil().max(1.0) as usize);
        Self {
            last: vec![NONE; size[0] * size[1]],
            entries: Vec::new(),
            edge: spread,
            size,
            cell,
            radius: DISC_RADIUS_SPACINGS * spacing,
            tolerance: LAYER_TOLERANCE_SPACINGS * spacing,
        }
    }

    /// Index of the row or column in which a slope is; that of the edge beyond it.
    fn cell_at(&self, axis: usize, slope: f64) -> usize {
        let cell = ((slope + self.edge[axis]) / self.cell).max(0.0) as usize;
        cell.min(self.size[axis] - 1)
    }

    /// Sorts the points in the jet.
    pub(super) fn sort(&mut self, all: &[Seen]) {
        self.last.fill(NONE);
        self.entries.clear();
        for (i, seen) in all.iter().enumerate() {
            let (near, far) = (seen.at.z - self.radius, seen.at.z + self.radius);
            // A ball around the mouth is in all directions.
            let [columns, rows] = [0, 1].map(|axis| {
                if near <= 0.0 {
                    return [0, self.size[axis] - 1];
                }
                let [low, high] = [seen.at[axis] - self.radius, seen.at[axis] + self.radius];
                let low = low / if low < 0.0 { near } else { far };
                let high = high / if high > 0.0 { near } else { far };
                [low, high].map(|slope| self.cell_at(axis, slope))
            });
            for row in rows[0]..=rows[1] {
                for column in columns[0]..=columns[1] {
                    let last = &mut self.last[row * self.size[0] + column];
                    self.entries.push([i as u32, *last]);
                    *last = self.entries.len() as u32 - 1;
                }
            }
        }
    }

    /// Returns true if a sorted disc hides the point from a place within `reach` of the point, metres.
    pub(super) fn hides(&self, all: &[Seen], point: &Seen, reach: f64) -> bool {
        let [column, row] = [0, 1].map(|axis| self.cell_at(axis, point.at[axis] / point.at.z));
        let depths = point.at.z - reach..point.at.z - self.tolerance;
        let mut next = self.last[row * self.size[0] + column];
        while let Some([disc, previous]) = self.entries.get(next as usize) {
            let other = &all[*disc as usize];
            // No point of a disc is nearer to the mouth than its middle by more than the radius.
            if other.at.z - self.radius < depths.end
                && other
                    .met_by(&point.at, self.radius)
                    .is_some_and(|depth| depths.contains(&depth))
            {
                return true;
            }
            next = *previous;
        }
        false
    }
}

/// The discs of a surface, sorted as seen from far away: the rays are parallel.
#[derive(Debug)]
pub(super) struct ViewFromAfar {
    grid: DirectionGrid,
    all: Vec<Seen>,
}

/// Distance of what is far away, metres: a thousand parts.
const AFAR_M: f64 = 1000.0;

impl ViewFromAfar {
    /// Sorts the discs as seen against a direction, a unit vector from the surface.
    pub(super) fn new(surface: &PaintSurface, direction: &Vector3<f64>) -> Self {
        let x = across(direction);
        let axes = [x, x.cross(direction), -direction];
        let in_view = |v: &Vector3<f64>| Vector3::from(axes.map(|axis| axis.dot(v)));
        let middle = Vector3::z() * AFAR_M;
        let points = surface.points.iter().zip(&surface.normals).enumerate();
        let all: Vec<Seen> = points
            .map(|(index, (point, normal))| Seen {
                index,
                at: in_view(&(point - surface.middle)) + middle,
                normal: in_view(normal),
            })
            .collect();
        let spread = [0, 1].map(|axis| {
            let slopes = all.iter().map(|seen| (seen.at[axis] / seen.at.z).abs());
            slopes.fold(f64::MIN_POSITIVE, f64::max)
        });
        let mut grid = DirectionGrid::new(spread, surface.spacing, AFAR_M);
        grid.sort(&all);
        Self { grid, all }
    }

    /// Returns true if nothing hides the point from a place this far from it, metres.
    pub(super) fn sees(&self, point: usize, from: f64) -> bool {
        !self.grid.hides(&self.all, &self.all[point], from)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// True if a ray from the mouth to the point meets a disc before it; tests every disc.
    fn is_hidden(point: &Seen, all: &[Seen], spacing: f64) -> bool {
        all.iter().any(|other| {
            let facing = other.normal.dot(&point.at);
            let share = other.normal.dot(&other.at) / facing;
            let off = (point.at * share - other.at).norm();
            facing.abs() > MIN_FACING_COS * point.at.norm()
                && share > 0.0
                && off <= DISC_RADIUS_SPACINGS * spacing
                && point.at.z * share + LAYER_TOLERANCE_SPACINGS * spacing < point.at.z
        })
    }

    /// A wall with a shelf in front of it, and a slope, seen from `mouth` along z.
    fn scene(mouth: [f64; 2], tilt: f64) -> Vec<Seen> {
        let mut all = Vec::new();
        let mut add = |at: Vector3<f64>, normal: Vector3<f64>| {
            let at = at - Vector3::new(mouth[0], mouth[1], 0.0);
            let turn = nalgebra::Rotation3::from_axis_angle(&Vector3::y_axis(), tilt);
            let index = all.len();
            let (at, normal) = (turn * at, (turn * normal).normalize());
            all.push(Seen { index, at, normal });
        };
        for i in -20..=20 {
            for j in -20..=20 {
                let (x, y) = (0.01 * f64::from(i), 0.01 * f64::from(j));
                add(Vector3::new(x, y, 0.2), -Vector3::z());
                if x.abs() < 0.045 {
                    add(
                        Vector3::new(x, y, 0.12 + 0.3 * x),
                        Vector3::new(0.3, 0.0, -1.0),
                    );
                }
            }
        }
        all
    }

    #[test]
    fn the_grid_hides_what_rays_to_every_disc_find_hidden() {
        let (spacing, spread) = (0.01, [1.0, 1.0]);
        let mut grid = DirectionGrid::new(spread, spacing, 0.15);
        let (mut num_hidden, mut num_other, mut num) = (0, 0, 0);
        for mouth in [[0.0, 0.0], [0.08, 0.03], [-0.13, -0.02]] {
            for tilt in [0.0, 0.3, -0.5] {
                let all = scene(mouth, tilt);
                grid.sort(&all);
                let in_jet = |seen: &&Seen| {
                    seen.at.z > 0.0 && (0..2).all(|axis| seen.at[axis].abs() < seen.at.z)
                };
                for seen in all.iter().filter(in_jet) {
                    let expected = is_hidden(seen, &all, spacing);
                    num += 1;
                    num_hidden += usize::from(expected);
                    num_other += usize::from(expected != grid.hides(&all, seen, f64::INFINITY));
                }
            }
        }
        assert!(num_hidden * 10 > num, "{num_hidden} of {num}");
        // Only rays that meet a disc at its very edge may differ, by rounding.
        assert!(num_other * 1000 < num_hidden, "{num_other} of {num_hidden}");
    }

    #[test]
    fn a_sphere_seen_from_near_hides_nothing_of_what_faces_the_mouth() {
        let mut all = Vec::new();
        let spacing = 0.008;
        for i in 0..60 {
            let angle = f64::from(i) * 0.026;
            let num = (angle.sin() * 0.3 * std::f64::consts::TAU / spacing)
                .ceil()
                .max(1.0);
            for j in 0..num as usize {
                let turn = j as f64 / num * std::f64::consts::TAU;
                let [s, c] = [angle.sin(), angle.cos()];
                let normal = Vector3::new(s * turn.cos(), s * turn.sin(), -c);
                let at = Vector3::new(0.0, 0.0, 0.45) + normal * 0.3;
                let index = all.len();
                all.push(Seen { index, at, normal });
            }
        }
        let mut grid = DirectionGrid::new([1.3, 1.3], spacing, 0.15);
        grid.sort(&all);
        let facing = all.iter().filter(|seen| -seen.at.dot(&seen.normal) > 0.0);
        assert!(facing.clone().count() > 500);
        assert_eq!(
            facing
                .filter(|seen| grid.hides(&all, seen, f64::INFINITY))
                .count(),
            0
        );
    }
}
