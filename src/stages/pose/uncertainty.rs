//! How far off a pose may be: bounds that follow from the residuals.
//!
//! The pose minimises a weighted sum of squared distances, so its covariance is that of an M-estimator, the "sandwich"
//! H⁻¹ M H⁻¹ with H = Σ w J Jᵀ and M = Σ w² r² J Jᵀ (P. J. Huber, "The behavior of maximum likelihood estimates under
//! nonstandard conditions", Fifth Berkeley Symposium, 1967): it takes the scatter from the residuals themselves and
//! needs no model of the noise. J is a pair's change by turn and shift, about the middle of the source.
//!
//! Neighbouring points err together: a camera rounds depths in steps, a normal is the mean over neighbours. So pulls
//! are summed over patches of the part before they are squared, and only patches count as independent (K.-Y. Liang and
//! S. L. Zeger, "Longitudinal data analysis using generalized linear models", Biometrika 73(1), 1986).
//!
//! The bounds are about the pose of least squares. A pose found another way is off it by a step, which is added.
//!
//! Noisy normals feign a hold that is not there: on a plane they point a little to every side. What they would feign
//! by their own scatter is therefore taken off H; where nothing is left, the pose is free that way.
//!
//! Known limits: an error that all points share, as of a camera's scale, shows in no residual.

use std::collections::BTreeMap;

use nalgebra::{Matrix3, Matrix6, Point3, Vector3, Vector6};

use super::{
    closest::Closest,
    equations::edge_share,
    refine::{Level, Source, Target},
};
use crate::{
    geometry::rigid::RigidTransform,
    units::{Metres, Radians},
};

/// Bounds that hold in 95 of 100 cases, each by itself.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Uncertainty {
    /// How far the middle of the source may be off; infinite where nothing holds it.
    pub shift: Metres,
    /// How far the source may be turned; infinite where nothing holds it.
    pub turn: Radians,
}

impl Uncertainty {
    /// Nothing holds the pose.
    const FREE: Self = Self {
        shift: Metres(f64::INFINITY),
        turn: Radians(f64::INFINITY),
    };

    /// False if the source may slide or turn without anything in the way.
    pub fn is_held(&self) -> bool {
        self.turn.0 < LOOSE.0 && self.shift.0.is_finite()
    }
}

/// A pose that may turn by so much, some half a degree, is not held: a spray path bears no more.
const LOOSE: Radians = Radians(0.01);
/// 95 % of a normal distribution in three dimensions lies within this squared distance, in standard deviations.
const WITHIN_SQ: f64 = 7.815;
/// Side of a patch, in root mean square distances of the points from their middle: some forty on a part.
const PATCH: f64 = 0.4;
/// Neighbours that a normal is the mean of, about, and the radius they lie within, in spacings.
const NORMAL_NEIGHBOURS: f64 = 28.0;
const NORMAL_RADIUS: f64 = 3.0;

/// The bounds of a pose that a refinement at this level ended at, from the closest points of the source's surface.
pub fn uncertainty(
    source: &Source,
    closest: &[Closest],
    target: &Target<'_>,
    pose: &RigidTransform,
    level: &Level,
) -> Uncertainty {
    let reach_sq = (3.0 * level.scale).powi(2) as f32;
    let per_scale_sq = 1.0 / (level.scale * level.scale);
    let closest = &closest[..level.num_surface.min(closest.len())];
    let pairs: Vec<Pair> = closest
        .iter()
        .filter_map(|closest| {
            let near = closest.on_surface(target, f64::from(reach_sq))?;
            Some(Pair {
                at: closest.at.cast(),
                normal: near.normal,
                off: near.off,
                weight: (-near.distance_sq * per_scale_sq).exp(),
            })
        })
        .collect();
    let weight_sum: f64 = pairs.iter().map(|p| p.weight).sum();
    if pairs.len() < 12 || weight_sum <= 0.0 {
        return Uncertainty::FREE;
    }
    let middle = pairs
        .iter()
        .map(|p| p.at.coords * p.weight)
        .sum::<Vector3<f64>>()
        / weight_sum;
    let scatter_sq = pairs.iter().map(|p| p.weight * p.off * p.off).sum::<f64>() / weight_sum;
    let radius = NORMAL_RADIUS * target.spacing;
    let tilt_sq = 4.0 * scatter_sq / (NORMAL_NEIGHBOURS * radius * radius);

    let mean_sq = pairs
        .iter()
        .map(|p| (p.at.coords - middle).norm_squared())
        .sum::<f64>();
    let patch = PATCH * (mean_sq / pairs.len() as f64).sqrt();
    let mut sums = Sums::new(middle, patch);
    for pair in &pairs {
        // ψ'(r) of the Welsch weight: what holds a pose is how the pull changes with the distance.
        let stiffness = pair.weight * (1.0 - 2.0 * pair.off * pair.off * per_scale_sq);
        sums.add(&pair.at, &pair.normal, pair.weight * pair.off, stiffness);
        for along in tangents(&pair.normal) {
            sums.take_off(&pair.at, &along, pair.weight * tilt_sq);
        }
    }
    let edges = &source.edges[..level.num_edges.min(source.edges.len())];
    let moved = pose.cast::<f32>();
    for p in edges {
        let at = moved * p;
        let Some((closest, distance_sq)) = target.edges.closest(&at, reach_sq) else {
            continue;
        };
        let weight =
            edge_share(closest.len(), edges.len()) * (-f64::from(distance_sq) * per_scale_sq).exp();
        let away: Vector3<f64> = (closest - at).cast();
        for axis in 0..3 {
            sums.add(
                &at.cast(),
                &Vector3::ith(axis, 1.0),
                weight * away[axis],
                weight,
            );
        }
    }
    sums.bounds().unwrap_or(Uncertainty::FREE)
}

struct Pair {
    at: Point3<f64>,
    normal: Vector3<f64>,
    /// Distance along the normal, metres.
    off: f64,
    weight: f64,
}

fn tangents(normal: &Vector3<f64>) -> [Vector3<f64>; 2] {
    let aside = normal.cross(&Vector3::ith(normal.iamin(), 1.0)).normalize();
    [aside, normal.cross(&aside)]
}

/// The sums of the sandwich.
struct Sums {
    middle: Vector3<f64>,
    /// Side of a patch, metres.
    patch: f64,
    /// H
    hold: Matrix6<f64>,
    /// w r J by patch.
    pulls: BTreeMap<[i32; 3], Vector6<f64>>,
}

impl Sums {
    fn new(middle: Vector3<f64>, patch: f64) -> Self {
        Self {
            middle,
            patch: patch.max(f64::MIN_POSITIVE),
            hold: Matrix6::zeros(),
            pulls: BTreeMap::new(),
        }
    }

    /// How a distance along a direction changes with turn and shift.
    fn change(&self, at: &Point3<f64>, direction: &Vector3<f64>) -> Vector6<f64> {
        let turn = (at.coords - self.middle).cross(direction);
        Vector6::new(
            turn.x,
            turn.y,
            turn.z,
            direction.x,
            direction.y,
            direction.z,
        )
    }

    fn add(&mut self, at: &Point3<f64>, direction: &Vector3<f64>, pull: f64, stiffness: f64) {
        let change = self.change(at, direction);
        self.hold += change * change.transpose() * stiffness;
        let patch = ((at.coords - self.middle) / self.patch).map(|x| x.floor() as i32);
        *self.pulls.entry(patch.into()).or_default() += change * pull;
    }

    fn take_off(&mut self, at: &Point3<f64>, direction: &Vector3<f64>, stiffness: f64) {
        let change = self.change(at, direction);
        self.hold -= change * change.transpose() * stiffness;
    }

    /// `None` where nothing holds the pose.
    fn bounds(&self) -> Option<Uncertainty> {
        let inverse = self.hold.cholesky()?.inverse();
        let num = self.pulls.len() as f64;
        let pulls = self.pulls.values();
        // What six parameters fit of so many patches is missing in the residuals.
        let spread: Matrix6<f64> = pulls
            .map(|pull| pull * pull.transpose())
            .sum::<Matrix6<f64>>()
            * (num / (num - 6.0).max(1.0));
        let covariance = inverse * spread * inverse;
        // ICP ends where points are close, not where surfaces are: what it has still to go counts in full.
        let to_go = inverse * self.pulls.values().sum::<Vector6<f64>>();
        let bound = |first: usize| {
            let block: Matrix3<f64> = covariance.fixed_view::<3, 3>(first, first).into_owned();
            let scatter = (WITHIN_SQ * block.symmetric_eigenvalues().max().max(0.0)).sqrt();
            scatter + to_go.fixed_rows::<3>(first).norm()
        };
        let (turn, shift) = (bound(0), bound(3));
        (turn.is_finite() && shift.is_finite()).then_some(Uncertainty {
            shift: Metres(shift),
            turn: Radians(turn),
        })
    }
}
