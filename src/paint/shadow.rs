//! Shadows: points that another part of the surface hides from the mouth of the gun.
//!
//! Every point stands for a disc perpendicular to its normal. A point is hidden if the ray from the mouth to it meets
//! another disc more than [`TOLERANCE`] before the point. The discs in the jet are drawn into a depth buffer over the
//! directions from the mouth, which keeps the nearest one of each cell. If one of them is nearer than a point in its
//! cell or the eight around it, the ray to the point is tested against all discs. A ray meets no disc of a smooth
//! surface before the point, however flat its angle, so smooth surfaces do not shadow themselves.
//!
//! Known limits: layers closer to each other than the tolerance cast no shadow. The edge of a shadow is exact to about
//! the spacing of the points.

use nalgebra::Vector3;

/// Radius of a disc in spacings of the points: discs around the corners of a square meet in its middle.
pub(super) const DISC: f64 = 0.75;
/// Depths that differ by less belong to one layer, in spacings of the points.
pub(super) const TOLERANCE: f64 = 2.0;
/// Side of a cell of the buffer at the stand-off, in spacings of the points.
const CELL: f64 = 0.5;
/// Most cells of a buffer along each axis; on a finer surface several discs share a cell.
const MOST_CELLS: f64 = 256.0;
/// Discs seen at a smaller cosine than this hide nothing.
pub(super) const LEAST_FACING: f64 = 0.05;

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
        if facing.abs() <= LEAST_FACING * ray.norm() {
            return None;
        }
        let at = ray * (self.normal.dot(&self.at) / facing);
        let is_met = at.z > 0.0 && (at - self.at).norm_squared() <= radius * radius;
        is_met.then_some(at.z)
    }
}

/// The nearest disc in each direction from the mouth.
#[derive(Debug)]
pub(super) struct DepthBuffer {
    /// Depth of the nearest disc, and its index among the drawn points.
    nearest: Vec<(f64, usize)>,
    /// Slopes of the jet's edge.
    spread: [f64; 2],
    size: [usize; 2],
    cell: f64,
    /// Radius of a disc, metres; then the tolerance of depths, metres.
    radius: f64,
    tolerance: f64,
}

impl DepthBuffer {
    /// Makes a buffer for a jet with these slopes, over points of this spacing at about this distance.
    pub(super) fn new(spread: [f64; 2], spacing: f64, stand_off: f64) -> Self {
        let widest = spread[0].max(spread[1]);
        let cell = (CELL * spacing / stand_off).max(2.0 * widest / MOST_CELLS);
        let size = spread.map(|slope| (2.0 * slope / cell).ceil().max(1.0) as usize);
        Self {
            nearest: vec![(f64::INFINITY, 0); size[0] * size[1]],
            spread,
            size,
            cell,
            radius: DISC * spacing,
            tolerance: TOLERANCE * spacing,
        }
    }

    fn middle(&self, [column, row]: [usize; 2]) -> [f64; 2] {
        [
            (column as f64 + 0.5) * self.cell - self.spread[0],
            (row as f64 + 0.5) * self.cell - self.spread[1],
        ]
    }

    /// Draws the points in the jet.
    pub(super) fn draw(&mut self, all: &[Seen]) {
        self.nearest.fill((f64::INFINITY, 0));
        for (i, seen) in all.iter().enumerate().filter(|(_, seen)| seen.at.z > 0.0) {
            let reach = self.radius / seen.at.z;
            let bounds = [0, 1].map(|axis| {
                let at = seen.at[axis] / seen.at.z + self.spread[axis];
                let cells = |slope: f64| (slope / self.cell).max(0.0) as usize;
                [
                    cells(at - reach),
                    (cells(at + reach) + 1).min(self.size[axis]),
                ]
            });
            for row in bounds[1][0]..bounds[1][1] {
                for column in bounds[0][0]..bounds[0][1] {
                    let [u, v] = self.middle([column, row]);
                    let ray = Vector3::new(u, v, 1.0);
                    let nearest = &mut self.nearest[row * self.size[0] + column];
                    if let Some(depth) = seen.met_by(&ray, self.radius)
                        && depth < nearest.0
                    {
                        *nearest = (depth, i);
                    }
                }
            }
        }
    }

    /// Returns true if a drawn disc hides the point.
    pub(super) fn hides(&self, all: &[Seen], point: &Seen) -> bool {
        let around = [0, 1].map(|axis| {
            let at = point.at[axis] / point.at.z + self.spread[axis];
            let cell = ((at / self.cell).max(0.0) as usize).min(self.size[axis] - 1);
            cell.saturating_sub(1)..(cell + 2).min(self.size[axis])
        });
        let before = point.at.z - self.tolerance;
        let is_before = |other: &Seen| {
            // No point of a disc is nearer to the mouth than its middle by more than the radius.
            other.at.z - self.radius < before
                && other
                    .met_by(&point.at, self.radius)
                    .is_some_and(|depth| depth < before)
        };
        let cells = around[1].clone().flat_map(|row| {
            let cells = around[0].clone();
            cells.map(move |column| self.nearest[row * self.size[0] + column])
        });
        // Most points have nothing in front of them.
        let mut nearer = cells.filter(|(depth, _)| *depth < before).peekable();
        nearer.peek().is_some()
            && (nearer.any(|(_, i)| is_before(&all[i])) || all.iter().any(is_before))
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
            facing.abs() > LEAST_FACING * point.at.norm()
                && share > 0.0
                && off <= DISC * spacing
                && point.at.z * share + TOLERANCE * spacing < point.at.z
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
    fn the_buffer_hides_what_rays_to_every_disc_find_hidden() {
        let (spacing, spread) = (0.01, [1.0, 1.0]);
        let mut buffer = DepthBuffer::new(spread, spacing, 0.15);
        let (mut num_hidden, mut num_other, mut num) = (0, 0, 0);
        for mouth in [[0.0, 0.0], [0.08, 0.03], [-0.13, -0.02]] {
            for tilt in [0.0, 0.3, -0.5] {
                let all = scene(mouth, tilt);
                buffer.draw(&all);
                let in_jet = |seen: &&Seen| {
                    seen.at.z > 0.0 && (0..2).all(|axis| seen.at[axis].abs() < seen.at.z)
                };
                for seen in all.iter().filter(in_jet) {
                    let expected = is_hidden(seen, &all, spacing);
                    num += 1;
                    num_hidden += usize::from(expected);
                    num_other += usize::from(expected != buffer.hides(&all, seen));
                }
            }
        }
        assert!(num_hidden * 10 > num, "{num_hidden} of {num}");
        // Only discs that are seen too flat to hide the middle of a cell.
        assert!(num_other * 500 < num_hidden, "{num_other} of {num_hidden}");
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
        let mut buffer = DepthBuffer::new([1.3, 1.3], spacing, 0.15);
        buffer.draw(&all);
        let facing = all.iter().filter(|seen| -seen.at.dot(&seen.normal) > 0.0);
        assert!(facing.clone().count() > 500);
        assert_eq!(facing.filter(|seen| buffer.hides(&all, seen)).count(), 0);
    }
}
