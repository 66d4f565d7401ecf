//! The normal equations of one Gauss-Newton step: surface to tangent plane, edge point to edge point.

use nalgebra::{Matrix3, Matrix6, Point3, Vector3, Vector6};

use super::{
    closest::ClosestTracker,
    refine::{AlignmentSource, AlignmentTarget, Level},
};
use geometry::rigid::RigidTransform;

/// Say of all edge pairs against all surface pairs. Edges fix two shifts and a turn, the surface the other three; by
/// experiment anything from 0.2 to 1 does.
const EDGE_WEIGHT: f64 = 0.1;
/// A pull of closest points towards each other, besides that to the tangent plane, relative to it. It holds what
/// neither surface nor edges hold (a plate sliding along itself) without dragging visibly.
const POINT_WEIGHT: f64 = 0.02;

/// What an edge pair counts beside a surface pair.
pub(super) fn edge_share(num_surface: usize, num_edges: usize) -> f64 {
    EDGE_WEIGHT * num_surface as f64 / num_edges as f64
}

/// The normal equations of one Gauss-Newton step.
#[derive(Default)]
pub(super) struct Equations {
    /// Surface to tangent plane: upper triangle of Σ w J Jᵀ by rows, and Σ w J r.
    planes: [f64; 21],
    planes_right: [f64; 6],
    points: PointSums,
    sum_sq: f64,
    pub(super) num_pairs: usize,
    /// Σ of the Welsch weights, those of edges by their share.
    weight_sum: f64,
}

/// Sums over pairs pulled together along all three axes: with J = (-skew(x), I) the normal equations follow from them.
#[derive(Default)]
struct PointSums {
    weight: f64,
    at: Vector3<f64>,
    /// Σ w x xᵀ as xx, xy, xz, yy, yz, zz.
    at_at: [f64; 6],
    away: Vector3<f64>,
    lever: Vector3<f64>,
}

impl Equations {
    pub(super) fn at(
        source: &AlignmentSource,
        target: &AlignmentTarget<'_>,
        pose: &RigidTransform,
        level: &Level,
        followed: &mut ClosestTracker,
    ) -> Self {
        let mut sums = Self::default();
        let moved = pose.cast::<f32>();
        // exp(-9) is nothing: pairs beyond three scales need not be found.
        let reach_sq = (3.0 * level.scale).powi(2) as f32;
        let per_scale_sq = 1.0 / (level.scale * level.scale);
        let surface = &source.surface[..level.num_surface.min(source.surface.len())];
        let normals = target.cloud.normals.as_deref().unwrap_or_default();
        for (i, p) in surface.iter().enumerate() {
            let at = moved * p;
            let Some(n) = followed.nearest(i, &at, target, level.search, reach_sq) else {
                continue;
            };
            let away: Vector3<f64> = (target.cloud.points[n.index] - at).cast();
            let weight = (-f64::from(n.distance_sq) * per_scale_sq).exp();
            let at: Point3<f64> = at.cast();
            if let Some(normal) = normals.get(n.index) {
                let normal = normal.cast();
                sums.add_plane(&at, &away, &normal, weight);
                sums.points.add(&at, &away, POINT_WEIGHT * weight);
            } else {
                sums.points.add(&at, &away, weight);
            }
            sums.sum_sq += f64::from(n.distance_sq);
            sums.weight_sum += weight;
            sums.num_pairs += 1;
        }
        let edges = &source.edges[..level.num_edges.min(source.edges.len())];
        if !edges.is_empty() && !target.edges.is_empty() {
            let share = edge_share(surface.len(), edges.len());
            for p in edges {
                let at = moved * p;
                let Some((closest, distance_sq)) = target.edges.closest(&at, reach_sq) else {
                    continue;
                };
                let weight = share * (-f64::from(distance_sq) * per_scale_sq).exp();
                sums.weight_sum += weight;
                sums.points.add(&at.cast(), &(closest - at).cast(), weight);
            }
        }
        sums
    }

    /// How much of the source is on the target, in points: what the robust refinement raises.
    pub(super) fn support(&self) -> f64 {
        self.weight_sum
    }

    /// E of eq. 12 over this step's pairs.
    pub(super) fn e_m2(&self) -> f64 {
        self.sum_sq / self.num_pairs.max(1) as f64
    }

    /// A residual along a normal: d(n · (x + ω × x + t))/d(ω, t) = [x × n, n].
    fn add_plane(
        &mut self,
        at: &Point3<f64>,
        away: &Vector3<f64>,
        normal: &Vector3<f64>,
        weight: f64,
    ) {
        let lever = at.coords.cross(normal);
        let row = [lever.x, lever.y, lever.z, normal.x, normal.y, normal.z];
        let residual = weight * normal.dot(away);
        let mut entry = 0;
        for i in 0..6 {
            let weighted = weight * row[i];
            for other in &row[i..] {
                self.planes[entry] += weighted * other;
                entry += 1;
            }
            self.planes_right[i] += residual * row[i];
        }
    }

    /// The step (turn, shift); `None` when the pairs leave it free.
    pub(super) fn solve(&self) -> Option<Vector6<f64>> {
        if self.num_pairs < 6 {
            return None;
        }
        let mut entries = self.planes.iter();
        let mut matrix = Matrix6::zeros();
        for i in 0..6 {
            for (j, entry) in (i..6).zip(&mut entries) {
                matrix[(i, j)] = *entry;
                matrix[(j, i)] = *entry;
            }
        }
        let mut right = Vector6::from(self.planes_right);
        self.points.add_to(&mut matrix, &mut right);
        // A trace of damping: far below any real curvature, enough to keep the factorisation defined.
        let damped = matrix + Matrix6::identity() * (1e-9 * matrix.trace().max(f64::MIN_POSITIVE));
        damped.cholesky().map(|c| c.solve(&right))
    }
}

impl PointSums {
    fn add(&mut self, at: &Point3<f64>, away: &Vector3<f64>, weight: f64) {
        let x = at.coords;
        let wx = x * weight;
        self.weight += weight;
        self.at += wx;
        for (sum, product) in self.at_at.iter_mut().zip([
            wx.x * x.x,
            wx.x * x.y,
            wx.x * x.z,
            wx.y * x.y,
            wx.y * x.z,
            wx.z * x.z,
        ]) {
            *sum += product;
        }
        self.away += away * weight;
        self.lever += wx.cross(away);
    }

    fn add_to(&self, matrix: &mut Matrix6<f64>, right: &mut Vector6<f64>) {
        let [xx, xy, xz, yy, yz, zz] = self.at_at;
        // -skew(x)² = |x|² I - x xᵀ
        let turn = Matrix3::new(yy + zz, -xy, -xz, -xy, xx + zz, -yz, -xz, -yz, xx + yy);
        let cross = self.at.cross_matrix();
        let mut block = |row: usize, column: usize, values: &Matrix3<f64>| {
            let mut view = matrix.fixed_view_mut::<3, 3>(row, column);
            view += values;
        };
        block(0, 0, &turn);
        block(0, 3, &cross);
        block(3, 0, &cross.transpose());
        block(3, 3, &(Matrix3::identity() * self.weight));
        let mut turn_right = right.fixed_rows_mut::<3>(0);
        turn_right += self.lever;
        let mut shift_right = right.fixed_rows_mut::<3>(3);
        shift_right += self.away;
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn point() -> impl Strategy<Value = Point3<f64>> {
        prop::array::uniform3(-1.0_f64..1.0).prop_map(Point3::from)
    }

    proptest! {
        /// The summed-up normal equations are those of the stacked residuals, row by row.
        #[test]
        fn equations_agree_with_stacked_rows(
            pairs in prop::collection::vec((point(), point(), point(), 0.1_f64..1.0), 6..20),
        ) {
            let mut fast = Equations { num_pairs: pairs.len(), ..Equations::default() };
            let (mut matrix, mut right) = (Matrix6::zeros(), Vector6::zeros());
            let mut add_row = |at: &Point3<f64>, away: &Vector3<f64>, direction: &Vector3<f64>, weight: f64| {
                let lever = at.coords.cross(direction);
                let row = Vector6::new(lever.x, lever.y, lever.z, direction.x, direction.y, direction.z);
                matrix += row * row.transpose() * weight;
                right += row * (weight * direction.dot(away));
            };
            for (at, to, normal, weight) in &pairs {
                let (away, normal) = (to - at, normal.coords.normalize());
                fast.add_plane(at, &away, &normal, *weight);
                fast.points.add(at, &away, *weight);
                add_row(at, &away, &normal, *weight);
                for axis in [Vector3::x(), Vector3::y(), Vector3::z()] {
                    add_row(at, &away, &axis, *weight);
                }
            }
            let slow = matrix.cholesky().expect("well posed").solve(&right);
            let fast = fast.solve().expect("well posed");
            prop_assert!((slow - fast).norm() < 1e-6 * (1.0 + slow.norm()), "{slow} {fast}");
        }
    }
}
