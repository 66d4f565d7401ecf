//! Robust refinement from one or many starts: surface to surface, edge to edge.
//!
//! A sheet-metal part is nearly flat, so the distance between surfaces hardly tells where it is along itself; its
//! outline and openings do. Each step therefore minimises the distance of source points to the target's tangent planes
//! (Y. Chen and G. Medioni, "Object modelling by registration of multiple range images", Image and Vision Computing
//! 10(3), 1992) together with the distance of the source's edge points to the target's edge points. Welsch weights
//! (P. W. Holland and R. E. Welsch, "Robust regression using iteratively reweighted least-squares", Communications in
//! Statistics 6(9), 1977) shrink from centimetres to the noise, so what has no counterpart loses its vote.

use nalgebra::{Isometry3, Matrix6, Point3, Translation3, UnitQuaternion, Vector3, Vector6};

use super::{Iteration, Stopped};
use crate::geometry::{cloud::PointCloud, nearest::KdTree, rigid::RigidTransform};

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
    /// Points of outline and openings; may be empty.
    pub edges: &'a [Point3<f32>],
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

/// Distance along the surface within which the closest point of a sampled target counts as a hit, metres: the points
/// of a reference cloud are about this far apart.
pub const SPACING: f64 = 0.008;
/// Say of all edge pairs against all surface pairs. Edges fix two shifts and a turn, the surface the other three; by
/// experiment anything from 0.2 to 1 does.
const EDGE_WEIGHT: f64 = 0.5;
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
                e_m2: equations.e_m2,
                target_from_source: pose,
                num_pairs: equations.num_pairs,
            });
            let Some(step) = equations.solve() else { break };
            pose = applied(&step, &pose);
            // Below a hundredth of a millimetre and a thousandth of a degree nothing changes any more.
            if step.fixed_rows::<3>(0).norm() < 2e-5 && step.fixed_rows::<3>(3).norm() < 1e-5 {
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
struct Equations {
    matrix: Matrix6<f64>,
    right: Vector6<f64>,
    e_m2: f64,
    num_pairs: usize,
}

impl Equations {
    fn at(source: &Source, target: &Target<'_>, pose: &RigidTransform, level: &Level) -> Self {
        let mut sums = Self {
            matrix: Matrix6::zeros(),
            right: Vector6::zeros(),
            e_m2: 0.0,
            num_pairs: 0,
        };
        let moved = pose.cast::<f32>();
        // exp(-9) is nothing: pairs beyond three scales need not be found.
        let reach_sq = (3.0 * level.scale).powi(2) as f32;
        let per_scale_sq = 1.0 / (level.scale * level.scale);
        let surface = &source.surface[..level.num_surface.min(source.surface.len())];
        let normals = target.cloud.normals.as_deref().unwrap_or_default();
        let mut sum_sq = 0.0;
        for p in surface {
            let at = moved * p;
            let Some(n) = target.tree.nearest(&at, reach_sq) else {
                continue;
            };
            let away: Vector3<f64> = (target.cloud.points[n.index] - at).cast();
            let weight = (-f64::from(n.distance_sq) * per_scale_sq).exp();
            let at: Point3<f64> = at.cast();
            if let Some(normal) = normals.get(n.index) {
                sums.add_direction(&at, &away, &normal.cast(), weight);
                sums.add_point(&at, &away, POINT_WEIGHT * weight);
            } else {
                sums.add_point(&at, &away, weight);
            }
            sum_sq += f64::from(n.distance_sq);
            sums.num_pairs += 1;
        }
        sums.e_m2 = sum_sq / sums.num_pairs.max(1) as f64;
        let edges = &source.edges[..level.num_edges.min(source.edges.len())];
        if !edges.is_empty() && !target.edges.is_empty() {
            let share = EDGE_WEIGHT * surface.len() as f64 / edges.len() as f64;
            for p in edges {
                let at = moved * p;
                let Some((closest, distance_sq)) = closest_of(target.edges, &at, reach_sq) else {
                    continue;
                };
                let weight = (-f64::from(distance_sq) * per_scale_sq).exp();
                sums.add_point(&at.cast(), &(closest - at).cast(), share * weight);
            }
        }
        sums
    }

    /// A residual along one direction: d(n · (x + ω × x + t))/d(ω, t) = [x × n, n].
    fn add_direction(
        &mut self,
        at: &Point3<f64>,
        away: &Vector3<f64>,
        normal: &Vector3<f64>,
        weight: f64,
    ) {
        let lever = at.coords.cross(normal);
        let row = Vector6::new(lever.x, lever.y, lever.z, normal.x, normal.y, normal.z);
        self.matrix.ger(weight, &row, &row, 1.0);
        self.right.axpy(weight * normal.dot(away), &row, 1.0);
    }

    /// A residual along all three axes.
    fn add_point(&mut self, at: &Point3<f64>, away: &Vector3<f64>, weight: f64) {
        for axis in [Vector3::x(), Vector3::y(), Vector3::z()] {
            self.add_direction(at, away, &axis, weight);
        }
    }

    /// `None` when the pairs leave the step free.
    fn solve(&self) -> Option<Vector6<f64>> {
        // A trace of damping: far below any real curvature, enough to keep the factorisation defined.
        let damped =
            self.matrix + Matrix6::identity() * (1e-9 * self.matrix.trace().max(f64::MIN_POSITIVE));
        (self.num_pairs >= 6)
            .then(|| damped.cholesky().map(|c| c.solve(&self.right)))
            .flatten()
    }
}

/// The closest of a few hundred points, all looked at: quicker than a tree at this size.
fn closest_of(
    points: &[Point3<f32>],
    at: &Point3<f32>,
    reach_sq: f32,
) -> Option<(Point3<f32>, f32)> {
    let mut best = (0, reach_sq);
    for (i, p) in points.iter().enumerate() {
        let distance_sq = (p - at).norm_squared();
        if distance_sq < best.1 {
            best = (i, distance_sq);
        }
    }
    (best.1 < reach_sq).then(|| (points[best.0], best.1))
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
    let normals = target.cloud.normals.as_deref().unwrap_or_default();
    let surface_cost = mean(surface.iter().map(|p| {
        let at = moved * p;
        match target.tree.nearest(&at, limit_sq as f32) {
            Some(n) => surface_distance_sq(target, normals, n.index, &at).min(limit_sq),
            None => limit_sq,
        }
    }));
    let edges = &source.edges[..level.num_edges.min(source.edges.len())];
    if edges.is_empty() || target.edges.is_empty() {
        return surface_cost;
    }
    let edge_distance_sq = |among: &[Point3<f32>], at: &Point3<f32>| {
        closest_of(among, at, limit_sq as f32).map_or(limit_sq, |c| f64::from(c.1))
    };
    let moved_edges: Vec<Point3<f32>> = edges.iter().map(|p| moved * p).collect();
    let there = mean(
        moved_edges
            .iter()
            .map(|at| edge_distance_sq(target.edges, at)),
    );
    let step = (target.edges.len() / edges.len()).max(1);
    let back = mean(
        target
            .edges
            .iter()
            .step_by(step)
            .map(|at| edge_distance_sq(&moved_edges, at)),
    );
    surface_cost + (there + back) / 2.0
}

/// Squared distance of a point to the target's surface near its closest point: along the normal, and beside it what
/// goes beyond the target's spacing.
fn surface_distance_sq(
    target: &Target<'_>,
    normals: &[Vector3<f32>],
    index: usize,
    at: &Point3<f32>,
) -> f64 {
    let away: Vector3<f64> = (target.cloud.points[index] - at).cast();
    match normals.get(index) {
        Some(normal) => {
            let along = normal.cast::<f64>().dot(&away);
            let beside_sq = (away.norm_squared() - along * along).max(0.0);
            along * along + (beside_sq - SPACING * SPACING).max(0.0)
        }
        None => away.norm_squared(),
    }
}

fn mean(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let n = values.len().max(1) as f64;
    values.sum::<f64>() / n
}
