//! Robust refinement from one or many starts: surface to surface, edge to edge.
//!
//! A sheet-metal part is nearly flat, so the distance between surfaces hardly tells where it is along itself; its
//! outline and openings do. Each step therefore minimises the distance of source points to the target's tangent planes
//! (Y. Chen and G. Medioni, "Object modelling by registration of multiple range images", Image and Vision Computing
//! 10(3), 1992) together with the distance of the source's edge points to the target's edge points. Welsch weights
//! (P. W. Holland and R. E. Welsch, "Robust regression using iteratively reweighted least-squares", Communications in
//! Statistics 6(9), 1977) shrink from centimetres to the noise, so what has no counterpart loses its vote.

use nalgebra::{
    Isometry3, Matrix3, Matrix6, Point3, Translation3, UnitQuaternion, Vector3, Vector6,
};

use super::{Iteration, Stopped};
use crate::geometry::{
    cloud::PointCloud,
    nearest::{KdTree, Neighbour},
    nearest_field::NearestField,
    rigid::RigidTransform,
};

/// What is aligned: a thinned surface and its edges, in source space.
#[derive(Clone, Debug, Default)]
pub struct Source {
    /// Points of the surface, in an order such that any first n are spread over it.
    pub surface: Vec<Point3<f32>>,
    /// Points of outline and openings, likewise; may be empty.
    pub edges: Vec<Point3<f32>>,
}

/// What it is aligned to, in target space.
#[derive(Clone, Copy, Debug)]
pub struct Target<'a> {
    /// The target's points with unit normals.
    pub cloud: &'a PointCloud,
    /// Search tree over them.
    pub tree: &'a KdTree,
    /// Field of nearest points around them.
    pub field: &'a NearestField,
    /// Points of outline and openings; may be empty.
    pub edges: &'a EdgePoints,
    /// Distance between neighbouring points, metres: along the surface, a closest point within it is a hit.
    pub spacing: f64,
}

impl Target<'_> {
    /// The closest target point within reach.
    pub fn nearest(&self, search: Search, query: &Point3<f32>, reach_sq: f32) -> Option<Neighbour> {
        match search {
            Search::Field => self
                .field
                .nearest(query)
                .filter(|n| n.distance_sq < reach_sq),
            Search::Tree => self.tree.nearest(query, reach_sq),
        }
    }
}

/// How closest points are found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Search {
    /// One look-up in the field: quick, off by up to a cell.
    Field,
    /// By the tree: exact.
    Tree,
}

/// Points looked at side by side.
const LANES: usize = 8;

/// A few hundred points in columns of eight: looking at all of them is quicker than a tree, and the processor looks at
/// several at once.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct EdgePoints {
    /// x, y and z of eight points each; the last group is filled up with points at infinity.
    groups: Vec<[[f32; LANES]; 3]>,
    num: usize,
}

impl EdgePoints {
    /// Keeps at most `limit` of the points, evenly spread over their order.
    pub fn new(points: &[Point3<f32>], limit: usize) -> Self {
        let step = points.len().div_ceil(limit.max(1)).max(1);
        let kept: Vec<Point3<f32>> = points.iter().step_by(step).copied().collect();
        let group = |points: &[Point3<f32>]| {
            let mut columns = [[f32::INFINITY; LANES]; 3];
            for (lane, p) in points.iter().enumerate() {
                for axis in 0..3 {
                    columns[axis][lane] = p[axis];
                }
            }
            columns
        };
        Self {
            groups: kept.chunks(LANES).map(group).collect(),
            num: kept.len(),
        }
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

    fn point(&self, i: usize) -> Point3<f32> {
        let [x, y, z] = &self.groups[i / LANES];
        Point3::new(x[i % LANES], y[i % LANES], z[i % LANES])
    }

    /// The closest point within reach, with its squared distance.
    fn closest(&self, at: &Point3<f32>, reach_sq: f32) -> Option<(Point3<f32>, f32)> {
        let mut best = [reach_sq; LANES];
        let mut best_group = [u32::MAX; LANES];
        for (number, [x, y, z]) in (0_u32..).zip(&self.groups) {
            let mut distance_sq = [0.0; LANES];
            for lane in 0..LANES {
                let (dx, dy, dz) = (x[lane] - at.x, y[lane] - at.y, z[lane] - at.z);
                distance_sq[lane] = dx * dx + dy * dy + dz * dz;
            }
            for lane in 0..LANES {
                let closer = distance_sq[lane] < best[lane];
                best[lane] = if closer {
                    distance_sq[lane]
                } else {
                    best[lane]
                };
                best_group[lane] = if closer { number } else { best_group[lane] };
            }
        }
        let lane = (0..LANES).min_by(|&a, &b| best[a].total_cmp(&best[b]))?;
        let group = best_group[lane];
        (group != u32::MAX).then(|| (self.point(group as usize * LANES + lane), best[lane]))
    }
}

/// One level of a refinement, from coarse to fine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Level {
    /// Surface points used.
    pub num_surface: usize,
    /// Edge points used.
    pub num_edges: usize,
    /// Scale of the Welsch weight, metres: at this distance a pair still counts exp(-1).
    pub scale: f64,
    /// Most steps.
    pub max_steps: usize,
    /// How closest points are found.
    pub search: Search,
}

/// A pose that a refinement ended at.
#[derive(Clone, Debug)]
pub struct Refined {
    /// The pose.
    pub target_from_source: RigidTransform,
    /// Every step.
    pub iterations: Vec<Iteration>,
    /// Why it ended.
    pub stopped: Stopped,
}

/// Say of all edge pairs against all surface pairs. Edges fix two shifts and a turn, the surface the other three; by
/// experiment anything from 0.2 to 1 does.
const EDGE_WEIGHT: f64 = 0.1;
/// A pull of closest points towards each other, besides that to the tangent plane, relative to it. It holds what
/// neither surface nor edges hold (a plate sliding along itself) without dragging visibly.
const POINT_WEIGHT: f64 = 0.02;

/// Refines one start through all levels.
pub fn refine(
    source: &Source,
    target: &Target<'_>,
    start: &RigidTransform,
    levels: &[Level],
) -> Refined {
    let mut pose = *start;
    let mut iterations = Vec::new();
    let mut stopped = Stopped::IterationLimit;
    for level in levels {
        stopped = Stopped::IterationLimit;
        for _ in 0..level.max_steps {
            let equations = Equations::at(source, target, &pose, level);
            iterations.push(Iteration {
                e_m2: equations.e_m2(),
                target_from_source: pose,
                num_pairs: equations.num_pairs,
            });
            let Some(step) = equations.solve() else { break };
            pose = applied(&step, &pose);
            // A twentieth of a millimetre and of the angle that moves a part's end as far: far below the noise.
            if step.fixed_rows::<3>(0).norm() < 5e-5 && step.fixed_rows::<3>(3).norm() < 5e-5 {
                stopped = Stopped::Converged;
                break;
            }
        }
    }
    Refined {
        target_from_source: pose,
        iterations,
        stopped,
    }
}

/// Turn (first three, radians) and shift (last three) in target space, applied after the pose.
fn applied(step: &Vector6<f64>, pose: &RigidTransform) -> RigidTransform {
    let turn = UnitQuaternion::from_scaled_axis(Vector3::new(step[0], step[1], step[2]));
    let shift = Translation3::new(step[3], step[4], step[5]);
    let mut next = Isometry3::from_parts(shift, turn) * pose;
    next.rotation.renormalize();
    next
}

/// The normal equations of one Gauss-Newton step.
#[derive(Default)]
struct Equations {
    /// Surface to tangent plane: upper triangle of Σ w J Jᵀ by rows, and Σ w J r.
    planes: [f64; 21],
    planes_right: [f64; 6],
    points: PointSums,
    sum_sq: f64,
    num_pairs: usize,
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
    fn at(source: &Source, target: &Target<'_>, pose: &RigidTransform, level: &Level) -> Self {
        let mut sums = Self::default();
        let moved = pose.cast::<f32>();
        // exp(-9) is nothing: pairs beyond three scales need not be found.
        let reach_sq = (3.0 * level.scale).powi(2) as f32;
        let per_scale_sq = 1.0 / (level.scale * level.scale);
        let surface = &source.surface[..level.num_surface.min(source.surface.len())];
        let normals = target.cloud.normals.as_deref().unwrap_or_default();
        for p in surface {
            let at = moved * p;
            let Some(n) = target.nearest(level.search, &at, reach_sq) else {
                continue;
            };
            let away: Vector3<f64> = (target.cloud.points[n.index] - at).cast();
            let weight = (-f64::from(n.distance_sq) * per_scale_sq).exp();
            let at: Point3<f64> = at.cast();
            if let Some(normal) = normals.get(n.index) {
                sums.add_plane(&at, &away, &normal.cast(), weight);
                sums.points.add(&at, &away, POINT_WEIGHT * weight);
            } else {
                sums.points.add(&at, &away, weight);
            }
            sums.sum_sq += f64::from(n.distance_sq);
            sums.num_pairs += 1;
        }
        let edges = &source.edges[..level.num_edges.min(source.edges.len())];
        if !edges.is_empty() && !target.edges.is_empty() {
            let share = EDGE_WEIGHT * surface.len() as f64 / edges.len() as f64;
            for p in edges {
                let at = moved * p;
                let Some((closest, distance_sq)) = target.edges.closest(&at, reach_sq) else {
                    continue;
                };
                let weight = (-f64::from(distance_sq) * per_scale_sq).exp();
                sums.points
                    .add(&at.cast(), &(closest - at).cast(), share * weight);
            }
        }
        sums
    }

    /// E of eq. 12 over this step's pairs.
    fn e_m2(&self) -> f64 {
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
    fn solve(&self) -> Option<Vector6<f64>> {
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

/// How badly a pose fits, square metres: mean squared distance to the target's surface and edges, and of the
/// target's edges to the source's, each cut off at `limit` metres.
pub fn cost(
    source: &Source,
    target: &Target<'_>,
    pose: &RigidTransform,
    level: &Level,
    limit: f64,
) -> f64 {
    let limit_sq = limit * limit;
    let moved = pose.cast::<f32>();
    let surface = &source.surface[..level.num_surface.min(source.surface.len())];
    let surface_cost = mean(surface.iter().map(|p| {
        let at = moved * p;
        match target.nearest(level.search, &at, limit_sq as f32) {
            Some(n) => surface_distance_sq(target, n.index, &at).min(limit_sq),
            None => limit_sq,
        }
    }));
    let edges = &source.edges[..level.num_edges.min(source.edges.len())];
    if edges.is_empty() || target.edges.is_empty() {
        return surface_cost;
    }
    let edge_distance_sq = |among: &EdgePoints, at: &Point3<f32>| {
        among
            .closest(at, limit_sq as f32)
            .map_or(limit_sq, |c| f64::from(c.1))
    };
    let moved_edges: Vec<Point3<f32>> = edges.iter().map(|p| moved * p).collect();
    let there = mean(
        moved_edges
            .iter()
            .map(|at| edge_distance_sq(target.edges, at)),
    );
    let moved_edges = EdgePoints::new(&moved_edges, edges.len());
    let step = (target.edges.len() / edges.len()).max(1);
    let back = mean(
        target
            .edges
            .iter()
            .step_by(step)
            .map(|at| edge_distance_sq(&moved_edges, &at)),
    );
    surface_cost + f64::midpoint(there, back)
}

/// Squared distance of a point to the target's surface near its closest point: along the normal, and beside it what
/// goes beyond the target's spacing.
fn surface_distance_sq(target: &Target<'_>, index: usize, at: &Point3<f32>) -> f64 {
    let away: Vector3<f64> = (target.cloud.points[index] - at).cast();
    match target
        .cloud
        .normals
        .as_deref()
        .and_then(|normals| normals.get(index))
    {
        Some(normal) => {
            let along = normal.cast::<f64>().dot(&away);
            let beside_sq = (away.norm_squared() - along * along).max(0.0);
            along * along + (beside_sq - target.spacing * target.spacing).max(0.0)
        }
        None => away.norm_squared(),
    }
}

fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (n, sum) = values.fold((0.0_f64, 0.0), |(n, sum), value| (n + 1.0, sum + value));
    sum / n.max(1.0)
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

        #[test]
        fn the_closest_edge_point_is_that_of_a_plain_search(
            points in prop::collection::vec(point(), 0..50),
            at in point(),
        ) {
            let points: Vec<Point3<f32>> = points.iter().map(|p| p.cast()).collect();
            let at: Point3<f32> = at.cast();
            let slow = points.iter().map(|p| (p - at).norm_squared()).filter(|d| *d < 1.0).min_by(f32::total_cmp);
            let found = EdgePoints::new(&points, 1000).closest(&at, 1.0).map(|c| c.1);
            match (slow, found) {
                (Some(slow), Some(found)) => prop_assert!((slow - found).abs() < 1e-6),
                (slow, found) => prop_assert_eq!(slow.is_some(), found.is_some()),
            }
        }
    }
}
