//! The surface of a reference: how far a point lies off it, and what lies around each of its nodes, the reference's points.
//!
//! The surface is the zero of a moving least-squares function: the mean of the signed distances to the tangent planes of the
//! nodes around (R. Kolluri, "Provably good moving least squares", SODA 2005). On a bend, such a mean is off by the same
//! amount at the nodes themselves, so it is taken there first and subtracted (`twicing`: J. W. Tukey, "Exploratory Data
//! Analysis", 1977).

use nalgebra::{Point3, Vector3};

use crate::pose::refine::AlignmentTarget;
use geometry::{
    nearest::KdTree,
    parallel::{map_each, num_cores},
    statistics::median,
};

/// Distance off the surface beyond which a reading without noise is of something else, metres.
pub(super) const MAX_OFF_M: f64 = 0.012;
/// Radius of the nodes that make the surface at a point, in their spacings.
const SUPPORT_SPACINGS: f64 = 2.2;
/// Radius in which a node must have neighbours on every side, in their spacings.
const BORDER_SPACINGS: f64 = 3.0;
/// Distance from a node to the mean of its neighbours from which the surface ends there, as a share of their radius: 0.42 on a
/// straight edge.
const BORDER_MIN_LEAN: f64 = 0.25;
/// Distance from the border up to which readings are not judged, metres: the camera's are ragged there.
const MARGIN_M: f32 = 0.012;
/// Radius in which the bias of nodes is compared, in their spacings.
const DETAIL_SPACINGS: f64 = 2.0;
/// Cosine between two normals from which their nodes lie on one surface: up to 60°.
pub(super) const SAME_SURFACE_MIN_COSINE: f32 = 0.5;
/// Number of nodes of which the density is measured.
const NUM_DENSITY_SAMPLES: usize = 300;
/// Range of the spacing of nodes, metres; outside of it, the cloud is none of a part.
const SPACING_RANGE_M: (f64, f64) = (0.001, 0.03);

/// The nodes of a reference that one side shows.
pub(super) struct Surface<'a> {
    pub(super) points: &'a [Point3<f32>],
    /// Unit normals, towards the side that is seen.
    pub(super) normals: &'a [Vector3<f32>],
    pub(super) tree: &'a KdTree,
    /// Area that a node stands for, square metres.
    pub(super) node_area: f64,
    /// Distance between neighbouring nodes, metres.
    pub(super) spacing: f64,
    /// True for nodes that lie too near to where the surface ends.
    pub(super) is_margin: Vec<bool>,
    /// What the function says at each node, metres.
    bias: Vec<f64>,
    /// Detail that the nodes do not resolve, metres: how much more the bias differs around a node than around most.
    pub(super) details: Vec<f64>,
}

impl<'a> Surface<'a> {
    /// Prepares the nodes; `None` without normals, or if they are no surface.
    pub(super) fn new(target: &AlignmentTarget<'a>) -> Option<Self> {
        let cloud = target.cloud;
        let normals = cloud.normals.as_deref()?;
        let (points, tree) = (&cloud.points[..], target.tree());
        let node_area = node_area(points, tree)?;
        let spacing = node_area.sqrt();
        if !(SPACING_RANGE_M.0..=SPACING_RANGE_M.1).contains(&spacing) {
            return None;
        }
        let mut surface = Self {
            points,
            normals,
            tree,
            node_area,
            spacing,
            is_margin: vec![false; points.len()],
            bias: vec![0.0; points.len()],
            details: Vec::new(),
        };
        let at_nodes = map_each(points.len(), num_cores(), |node| {
            let off = surface
                .off(&points[node], MAX_OFF_M)
                .map_or(0.0, |(_, off)| off);
            (off, surface.is_border(node))
        });
        for (node, (bias, is_border)) in at_nodes.into_iter().enumerate() {
            surface.bias[node] = bias;
            if is_border {
                let is_margin = &mut surface.is_margin;
                tree.within(&points[node], MARGIN_M, |near| is_margin[near.index] = true);
            }
        }
        surface.details = surface.unresolved();
        Some(surface)
    }

    /// The details: a handle or an emblem of a few nodes is another one from another side.
    fn unresolved(&self) -> Vec<f64> {
        let variances = map_each(self.points.len(), num_cores(), |node| {
            let (mut num, mut sum, mut squares) = (0.0_f64, 0.0, 0.0);
            self.around(node, DETAIL_SPACINGS * self.spacing, |near| {
                num += 1.0;
                sum += self.bias[near];
                squares += self.bias[near] * self.bias[near];
            });
            let mean = sum / num.max(1.0);
            (squares / num.max(1.0) - mean * mean).max(0.0)
        });
        // The noise of a captured reference is everywhere, and twice its median in places.
        let usual = 2.0 * median(variances.iter().copied()).unwrap_or(0.0);
        let excess = variances.iter().map(|variance| (variance - usual).max(0.0));
        excess.map(f64::sqrt).collect()
    }

    /// Returns the node nearest to a point, and how far outside of the surface the point lies, metres; `None` if that is more than
    /// `limit`.
    pub(super) fn off(&self, at: &Point3<f32>, limit: f64) -> Option<(usize, f64)> {
        let support = SUPPORT_SPACINGS * self.spacing;
        let reach = support.hypot(limit) as f32;
        let nearest = self.tree.nearest(at, reach * reach)?.index;
        let towards = self.normals[nearest];
        let (mut sum, mut weights) = (0.0, 0.0);
        self.tree.within(at, reach, |near| {
            let normal = &self.normals[near.index];
            if normal.dot(&towards) < SAME_SURFACE_MIN_COSINE {
                return;
            }
            let off = f64::from(normal.dot(&(at - self.points[near.index])));
            let beside_sq = f64::from(near.distance_sq) - off * off;
            let share = 1.0 - beside_sq / (support * support);
            if share > 0.0 {
                let weight = share * share;
                sum += weight * (off - self.bias[near.index]);
                weights += weight;
            }
        });
        let off = sum / weights;
        // Also refuses NaN.
        (off.abs() <= limit).then_some((nearest, off))
    }

    /// Calls `visit` with each node of the same surface within `radius` (metres) of a node, itself included.
    pub(super) fn around(&self, node: usize, radius: f64, mut visit: impl FnMut(usize)) {
        let towards = &self.normals[node];
        self.tree.within(&self.points[node], radius as f32, |near| {
            if self.normals[near.index].dot(towards) >= SAME_SURFACE_MIN_COSINE {
                visit(near.index);
            }
        });
    }

    /// Returns the connected nodes around `first` that `is_in` accepts, `first` included.
    pub(super) fn connected(&self, first: usize, is_in: impl Fn(usize) -> bool) -> Vec<usize> {
        let mut is_reached = vec![false; self.points.len()];
        is_reached[first] = true;
        let mut found = vec![first];
        let mut next = 0;
        while let Some(&node) = found.get(next) {
            next += 1;
            self.around(node, 2.0 * self.spacing, |near| {
                if !is_reached[near] && is_in(near) {
                    is_reached[near] = true;
                    found.push(near);
                }
            });
        }
        found
    }

    /// Sine of the angle by which the normals within `radius` (metres) of a node differ: 0 on a plane.
    pub(super) fn bend(&self, node: usize, radius: f64) -> f64 {
        let (mut sum, mut num) = (Vector3::<f32>::zeros(), 0.0_f32);
        self.around(node, radius, |near| {
            sum += self.normals[near];
            num += 1.0;
        });
        let mean = f64::from(sum.norm() / num.max(1.0)).min(1.0);
        (1.0 - mean * mean).sqrt()
    }

    /// Mean of the points of some nodes.
    pub(super) fn middle(&self, nodes: &[usize]) -> Point3<f64> {
        let sum: Vector3<f64> = (nodes.iter())
            .map(|node| self.points[*node].coords.cast::<f64>())
            .sum();
        Point3::from(sum / nodes.len().max(1) as f64)
    }

    /// True if the surface ends at a node.
    fn is_border(&self, node: usize) -> bool {
        let radius = BORDER_SPACINGS * self.spacing;
        let (mut sum, mut num) = (Vector3::<f32>::zeros(), 0.0_f32);
        self.around(node, radius, |near| {
            sum += self.points[near] - self.points[node];
            num += 1.0;
        });
        let normal = &self.normals[node];
        let lean = sum - normal * normal.dot(&sum);
        f64::from(lean.norm() / num.max(1.0)) > BORDER_MIN_LEAN * radius
    }
}

/// Area per node, square metres: the median of what is around a sample of them; `None` without nodes.
fn node_area(points: &[Point3<f32>], tree: &KdTree) -> Option<f64> {
    let samples = || (0..points.len()).step_by((points.len() / NUM_DENSITY_SAMPLES).max(1));
    let nearest = samples().filter_map(|node| tree.nearest_other(&points[node], node));
    let nearest = median(nearest.map(|near| f64::from(near.distance_sq).sqrt()))?;
    let radius = 4.0 * nearest;
    median(samples().map(|node| {
        let mut num = 0.0_f64;
        tree.within(&points[node], radius as f32, |_| num += 1.0);
        std::f64::consts::PI * radius * radius / num
    }))
}
