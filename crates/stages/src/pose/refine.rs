//! Robust refinement from one or many starts: surface to surface, edge to edge.
//!
//! A sheet-metal part is nearly flat, so the distance between surfaces hardly tells where it is along itself; its
//! outline and openings do. Each step therefore minimises the distance of source points to the target's tangent planes
//! (Y. Chen and G. Medioni, "Object modelling by registration of multiple range images", Image and Vision Computing
//! 10(3), 1992) together with the distance of the source's edge points to the target's edge points. Welsch weights
//! (P. W. Holland and R. E. Welsch, "Robust regression using iteratively reweighted least-squares", Communications in
//! Statistics 6(9), 1977) shrink from centimetres to the noise, so what has no counterpart loses its vote.

use std::sync::OnceLock;

use nalgebra::{Isometry3, Point3, Translation3, UnitQuaternion, Vector3, Vector6};

use super::{
    Iteration, Phase, Stopped, closest::ClosestTracker, edge_points::EdgePoints,
    equations::Equations,
};
use geometry::{
    cloud::PointCloud,
    nearest::{KdTree, Neighbour},
    nearest_field::NearestField,
    rigid::RigidTransform,
};

/// What is aligned: a thinned surface and its edges, in source space.
#[derive(Clone, Debug, Default)]
pub struct AlignmentSource {
    /// Points of the surface, in an order such that any first n are spread over it.
    pub surface: Vec<Point3<f32>>,
    /// Points of outline and openings, likewise; may be empty.
    pub edges: Vec<Point3<f32>>,
}

/// What it is aligned to, in target space.
#[derive(Clone, Copy, Debug)]
pub struct AlignmentTarget<'a> {
    /// The target's points with unit normals.
    pub cloud: &'a PointCloud,
    /// Search tree over them, built by the first call of [`Self::tree`].
    pub tree: &'a OnceLock<KdTree>,
    /// Field of nearest points around them.
    pub field: &'a NearestField,
    /// Points of outline and openings; may be empty.
    pub edges: &'a EdgePoints,
    /// Distance between neighbouring points, metres: along the surface, a closest point within it is a hit.
    pub spacing: f64,
}

impl<'a> AlignmentTarget<'a> {
    /// The search tree over the target's points.
    pub fn tree(&self) -> &'a KdTree {
        self.tree.get_or_init(|| KdTree::new(&self.cloud.points))
    }

    /// The closest target point within reach.
    pub fn nearest(&self, search: Search, query: &Point3<f32>, reach_sq: f32) -> Option<Neighbour> {
        match search {
            Search::Field => self
                .field
                .nearest(query)
                .filter(|n| n.distance_sq < reach_sq),
            Search::Tree => self.tree().nearest(query, reach_sq),
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
    /// A shift below this share of the scale, with as little a turn, ends the level.
    pub settled: f64,
    /// How closest points are found.
    pub search: Search,
}

/// What ends a level where a pose is to be as exact as the clouds are: a fiftieth of a millimetre on a part, more on a
/// scan of a street.
pub const SETTLED: f64 = 0.002;
/// The turn that counts as much as a shift by the whole scale, radians: a part is some metres long at most.
const TURN_PER_SCALE: f64 = 0.025;

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

impl Refined {
    /// Goes on with a refinement that began at this pose.
    pub fn append(&mut self, next: Self) {
        self.target_from_source = next.target_from_source;
        self.iterations.extend(next.iterations);
        self.stopped = next.stopped;
    }
}

/// Refines one start through all levels.
pub fn refine(
    source: &AlignmentSource,
    target: &AlignmentTarget<'_>,
    start: &RigidTransform,
    levels: &[Level],
) -> Refined {
    let mut pose = *start;
    let mut iterations = Vec::new();
    let mut stopped = Stopped::IterationLimit;
    let mut followed = ClosestTracker::default();
    for level in levels {
        stopped = Stopped::IterationLimit;
        let mut before: Option<RefinementStep> = None;
        for _ in 0..level.max_steps {
            let equations = Equations::at(source, target, &pose, level, &mut followed);
            iterations.push(Iteration {
                phase: Phase::Refinement,
                e_m2: equations.e_m2(),
                target_from_source: pose,
                num_pairs: equations.num_pairs,
            });
            if let Some(step) =
                before.filter(|b| b.stretch > 1.0 && equations.support() < b.support)
            {
                // Stretched too far: from where it began, only as far as the equations say.
                pose = applied(&step.twist, &step.from);
                before = Some(RefinementStep {
                    stretch: 1.0,
                    support: f64::INFINITY,
                    ..step
                });
                continue;
            }
            let Some(twist) = equations.solve() else {
                break;
            };
            let stretch = before.map_or(1.0, |b| b.next_stretch(&twist));
            before = Some(RefinementStep {
                from: pose,
                twist,
                stretch,
                support: equations.support(),
            });
            pose = applied(&(twist * stretch), &pose);
            let shift_settled = (level.settled * level.scale).max(1e-5);
            if twist.fixed_rows::<3>(0).norm() < TURN_PER_SCALE * level.settled
                && twist.fixed_rows::<3>(3).norm() < shift_settled
            {
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

/// A step of the refinement.
///
/// Closest points hold a sheet where it is, so it slides along itself by many small steps the same way. As long as the
/// way stays the same, each is therefore stretched to twice the length of the one before, and taken back if less of
/// the source is on the target then.
#[derive(Clone, Copy)]
struct RefinementStep {
    from: RigidTransform,
    /// What the equations said: turn in radians, shift in metres.
    twist: Vector6<f64>,
    stretch: f64,
    /// Of the pose it began at.
    support: f64,
}

impl RefinementStep {
    fn next_stretch(&self, twist: &Vector6<f64>) -> f64 {
        let along =
            self.twist.dot(twist) / (self.twist.norm() * twist.norm()).max(f64::MIN_POSITIVE);
        if along > SAME_WAY_MIN_COSINE {
            (2.0 * self.stretch).min(MOST_STRETCHED)
        } else {
            1.0
        }
    }
}

/// Cosine between two steps above which they go the same way.
const SAME_WAY_MIN_COSINE: f64 = 0.8;
/// No step is stretched further than this.
const MOST_STRETCHED: f64 = 16.0;

/// Turn (first three, radians) and shift (last three) in target space, applied after the pose.
fn applied(step: &Vector6<f64>, pose: &RigidTransform) -> RigidTransform {
    let turn = UnitQuaternion::from_scaled_axis(Vector3::new(step[0], step[1], step[2]));
    let shift = Translation3::new(step[3], step[4], step[5]);
    let mut next = Isometry3::from_parts(shift, turn) * pose;
    next.rotation.renormalize();
    next
}

/// How badly a pose fits, square metres: mean squared distance to the target's surface and edges, and of the
/// target's edges to the source's, each cut off at `limit` metres.
pub fn cost(
    source: &AlignmentSource,
    target: &AlignmentTarget<'_>,
    pose: &RigidTransform,
    level: &Level,
    limit: f64,
) -> f64 {
    costs(source, target, pose, level, limit).whole()
}

/// How badly a pose fits, square metres: mean squared distances, cut off.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Costs {
    /// Of the source's surface to the target's.
    pub(super) surface: f64,
    /// Of the source's edges to the target's, and of the target's to the source's; 0 without edges.
    pub(super) edges: [f64; 2],
}

impl Costs {
    pub(super) fn whole(&self) -> f64 {
        self.surface + f64::midpoint(self.edges[0], self.edges[1])
    }
}

/// As [`cost`], each by itself.
pub(super) fn costs(
    source: &AlignmentSource,
    target: &AlignmentTarget<'_>,
    pose: &RigidTransform,
    level: &Level,
    limit: f64,
) -> Costs {
    let limit_sq = limit * limit;
    let moved = pose.cast::<f32>();
    let surface = &source.surface[..level.num_surface.min(source.surface.len())];
    let surface = mean(surface.iter().map(|p| {
        let at = moved * p;
        match target.nearest(level.search, &at, limit_sq as f32) {
            Some(n) => surface_distance_sq(target, n.index, &at).min(limit_sq),
            None => limit_sq,
        }
    }));
    let edges = &source.edges[..level.num_edges.min(source.edges.len())];
    if edges.is_empty() || target.edges.is_empty() {
        return Costs {
            surface,
            edges: [0.0; 2],
        };
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
    Costs {
        surface,
        edges: [there, back],
    }
}

/// Squared distance of a point to the target's surface near its closest point: along the normal, and beside it what
/// goes beyond the target's spacing.
fn surface_distance_sq(target: &AlignmentTarget<'_>, index: usize, at: &Point3<f32>) -> f64 {
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
