//! How far off a pose may be: bounds that follow from the residuals.
//!
//! The pose minimises a weighted sum of squared distances, so its covariance is that of an M-estimator, the "sandwich"
//! H⁻¹ M H⁻¹ with H = Σ ψ′ J Jᵀ (P. J. Huber, "The behavior of maximum likelihood estimates under nonstandard conditions",
//! Fifth Berkeley Symposium, 1967). J is a pair's change by turn and shift, about the middle of the source; ψ′, how the
//! pull of a pair changes with its distance, is the weight minus its decrease.
//!
//! Errors of neighbouring pairs are correlated: a camera rounds depths in steps, and a whole side of an outline lies some
//! millimetres off where readings are lost. So pairs are grouped by region, those of an outline also by its side
//! (K.-Y. Liang and S. L. Zeger, "Longitudinal data analysis using generalized linear models", Biometrika 73(1), 1986),
//! and M = Σ G Gᵀ + b² Σ g gᵀ. The sums G = Σ w r J over small patches cover independent errors. For errors that a region
//! shares, g = Σ w J over the region, and b² is the mean square of the regions' mean distances: there are few regions, so
//! one figure for all is steadier than a product for each. Outlines add the smallest error that a view's outline can have.
//!
//! The stiffness H is corrected in two places. An edge point constrains the part across the outline, not along it: further
//! along there is another closest point. And slightly wrong normals produce spurious stiffness where there is none (on a
//! plane they point to every side); it is subtracted, and where it is most of the stiffness, the pose is unconstrained.
//!
//! The bounds refer to the minimum of this model. Closest points also pull along an outline, so the refinement ends a
//! step away from that minimum; this step is added.
//!
//! Known limits: an error that all points share, such as that of a camera's scale, shows in no residual.

mod freedom;
mod normals;
mod regions;

use nalgebra::{Matrix3, Matrix6, Point3, Vector3, Vector6};

pub use self::freedom::{Axis, FreeMotion};
use self::{freedom::LocalFrame, normals::tilt_sq, regions::Regions};
use super::{
    closest::Correspondence,
    equations::edge_share,
    refine::{AlignmentSource, AlignmentTarget, Level, Search},
};
use geometry::{
    rigid::{PoseDelta, RigidTransform},
    units::{Metres, Radians},
};

/// Bounds that hold in 95 of 100 cases, each by itself.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Uncertainty {
    /// How far the middle of the source may be off; infinite where nothing holds it.
    pub shift: Metres,
    /// How far the source may be turned; infinite where nothing holds it.
    pub turn: Radians,
    /// How the source can move most easily, if the pose is unconstrained.
    pub freedom: Option<FreeMotion>,
}

impl Uncertainty {
    fn free(freedom: FreeMotion) -> Self {
        Self {
            shift: Metres(f64::INFINITY),
            turn: Radians(f64::INFINITY),
            freedom: Some(freedom),
        }
    }

    /// Adds an independent error of the frame in which the pose is given.
    #[must_use]
    pub fn widened(self, by: &PoseDelta) -> Self {
        Self {
            shift: Metres(self.shift.0.hypot(by.shift.0)),
            turn: Radians(self.turn.0.hypot(by.rotation.0)),
            ..self
        }
    }

    /// False if the pose is unconstrained: the source may slide or turn.
    pub fn is_held(&self) -> bool {
        self.freedom.is_none()
    }
}

/// Beyond this, some two degrees, and beyond the reach of its pairs, bounds are a guess, and the pose is unconstrained.
const LOOSE: Radians = Radians(0.035);
/// The same where no outline is seen: closest points on a surface alone hold a pose in any shallow valley of E.
const LOOSE_WITHOUT_OUTLINE: Radians = Radians(0.01);
/// A motion is unconstrained if more than this share of the stiffness against it is spurious.
const MAX_SPURIOUS: f64 = 0.5;
/// Error of the direction of a border found among the points of a cloud, radians.
const EDGE_TILT_RAD: f64 = 0.1;
/// The spurious stiffness is estimated from every fourth pair.
const SPURIOUS_EVERY: usize = 4;
/// Side of a region of the surface and of the outline, in root mean square distances of the points from their middle.
/// An outline's errors reach further.
const REGION: f64 = 1.2;
/// Side of a patch of the surface, in the same unit: its error is independent of other patches, like those of points.
const PATCH: f64 = 0.4;
const OUTLINE_REGION: f64 = 1.5;
/// Error of a stretch of an outline that the residuals do not show, metres: most of a pixel at 1.5 m.
const OUTLINE_ERROR_M: f64 = 0.0021;
/// Share of a region's own error that its patches do not show already.
const REGION_SHARE: f64 = 0.5;
/// Scatter of turns and shifts divided by that of the model, on parts of other cars in frames of the tuning seeds, with
/// every kind of camera (`partsight-bench bounds --seed 3000000`).
const TURN_FACTOR: f64 = 1.1;
const SHIFT_FACTOR: f64 = 1.55;

/// The bounds of a pose that a refinement at this level ended at, from the closest points of the source's surface. The
/// source was seen in `num_views` frames, which err independently in what the residuals do not show.
pub fn uncertainty(
    source: &AlignmentSource,
    closest: &[Correspondence],
    target: &AlignmentTarget<'_>,
    pose: &RigidTransform,
    level: &Level,
    num_views: usize,
) -> Uncertainty {
    let outline_error = OUTLINE_ERROR_M / (num_views as f64).sqrt();
    uncertainty_with(
        source,
        closest,
        target,
        pose,
        level,
        (outline_error, num_views),
    )
}

/// As [`uncertainty`], with the error of a stretch of the outline, metres, and the number of views.
pub(super) fn uncertainty_with(
    source: &AlignmentSource,
    closest: &[Correspondence],
    target: &AlignmentTarget<'_>,
    pose: &RigidTransform,
    level: &Level,
    (outline_error, num_views): (f64, usize),
) -> Uncertainty {
    let reach_sq = (3.0 * level.scale).powi(2);
    let per_scale_sq = 1.0 / (level.scale * level.scale);
    let closest = &closest[..level.num_surface.min(closest.len())];
    let pairs: Vec<Pair> = closest
        .iter()
        .filter_map(|closest| Pair::of(closest, target, reach_sq, per_scale_sq))
        .collect();
    let weight_sum: f64 = pairs.iter().map(|p| p.weight).sum();
    if pairs.len() < 12 || weight_sum <= 0.0 {
        return Uncertainty::free(FreeMotion::Anyhow);
    }
    let sum = pairs.iter().map(|p| p.at.coords * p.weight);
    let middle = sum.sum::<Vector3<f64>>() / weight_sum;
    let squares = pairs.iter().map(|p| {
        let out = p.at.coords - middle;
        out * out.transpose()
    });
    let frame = LocalFrame::of(&(squares.sum::<Matrix3<f64>>() / pairs.len() as f64));

    let mut sums = Sums::new(middle, per_scale_sq);
    let mut patches = Regions::new(middle, PATCH * frame.radius);
    let mut surface = Regions::new(middle, REGION * frame.radius);
    for pair in &pairs {
        let lever = sums.add(&pair.at, &pair.normal, pair.off, pair.weight);
        patches.add(&pair.at, None, &lever, pair.off, pair.weight);
        surface.add(&pair.at, None, &lever, pair.off, pair.weight);
    }
    let mut spurious_stiffness = spurious_stiffness(&pairs, &middle, tilt_sq(&pairs, target));
    let edges = &source.edges[..level.num_edges.min(source.edges.len())];
    let mut outline = Regions::new(middle, OUTLINE_REGION * frame.radius);
    let share = edge_share(closest.len(), edges.len().max(1));
    let moved = pose.cast::<f32>();
    for p in edges {
        let at = moved * p;
        let Some(edge) = EdgePair::of(&at, &middle, target, reach_sq as f32) else {
            continue;
        };
        let weight = share * (-edge.away.norm_squared() * per_scale_sq).exp();
        let at = at.cast();
        sums.add(&at, &edge.normal, edge.away.dot(&edge.normal), weight);
        let off = edge.away.dot(&edge.outwards);
        let lever = sums.add(&at, &edge.outwards, off, weight);
        outline.add(&at, Some(&edge.outwards), &lever, off, weight);
        if target.edges.are_pieces() {
            let along = edge.outwards.cross(&edge.normal);
            let change = change(&(at.coords - middle), &along);
            spurious_stiffness +=
                change * change.transpose() * (weight * EDGE_TILT_RAD * EDGE_TILT_RAD);
        }
    }
    let of_regions = surface.spread(0.0) * REGION_SHARE;
    let spread = patches.scatter() + of_regions + outline.spread(outline_error);
    let loose = if outline.is_empty() {
        LOOSE_WITHOUT_OUTLINE
    } else {
        LOOSE
    };
    let limits = (loose, Metres(3.0 * level.scale));
    // What the model misses of a shift, such as readings lost on one side, differs from view to view: scans show none of it.
    let shift_factor = if num_views == 1 { SHIFT_FACTOR } else { 1.0 };
    let factors = [TURN_FACTOR, shift_factor];
    sums.bounds(&spurious_stiffness, &spread, &frame, limits, factors)
}

/// A source point and the surface of the target.
struct Pair {
    at: Point3<f64>,
    /// Of the target point.
    index: usize,
    normal: Vector3<f64>,
    /// Distance along the normal, metres.
    off: f64,
    /// Squared distance to the target point along the surface, square metres.
    beside_sq: f64,
    weight: f64,
}

impl Pair {
    fn of(
        closest: &Correspondence,
        target: &AlignmentTarget<'_>,
        reach_sq: f64,
        per_scale_sq: f64,
    ) -> Option<Self> {
        let near = closest.on_surface(target, reach_sq)?;
        Some(Self {
            at: closest.at.cast(),
            index: closest.target?.index,
            normal: near.normal,
            off: near.off,
            beside_sq: (near.distance_sq - near.off * near.off).max(0.0),
            weight: (-near.distance_sq * per_scale_sq).exp(),
        })
    }
}

/// A source's edge point and the outline of the target.
struct EdgePair {
    /// To the closest point of the outline, metres.
    away: Vector3<f64>,
    /// Of the surface there.
    normal: Vector3<f64>,
    /// Along the surface, across the outline.
    outwards: Vector3<f64>,
}

impl EdgePair {
    fn of(
        at: &Point3<f32>,
        middle: &Vector3<f64>,
        target: &AlignmentTarget<'_>,
        reach_sq: f32,
    ) -> Option<Self> {
        let (number, _) = target.edges.closest_number(at, reach_sq)?;
        let closest = target.edges.point(number);
        let along = target.edges.along(number)?;
        let near = target.nearest(Search::Field, &closest, f32::INFINITY)?;
        let normal: Vector3<f64> = target.cloud.normals.as_deref()?.get(near.index)?.cast();
        let across = along.cast().cross(&normal).try_normalize(1e-6)?;
        let out = closest.coords.cast() - middle;
        Some(Self {
            away: (closest - at).cast(),
            normal,
            outwards: if across.dot(&out) < 0.0 {
                -across
            } else {
                across
            },
        })
    }
}

fn tangents(normal: &Vector3<f64>) -> [Vector3<f64>; 2] {
    let aside = normal.cross(&Vector3::ith(normal.iamin(), 1.0)).normalize();
    [aside, normal.cross(&aside)]
}

/// How a distance along a direction changes with turn and shift.
fn change(from_middle: &Vector3<f64>, direction: &Vector3<f64>) -> Vector6<f64> {
    let turn = from_middle.cross(direction);
    Vector6::new(
        turn.x,
        turn.y,
        turn.z,
        direction.x,
        direction.y,
        direction.z,
    )
}

/// Returns the spurious stiffness from normals whose error has this mean square angle.
fn spurious_stiffness(pairs: &[Pair], middle: &Vector3<f64>, tilt_sq: f64) -> Matrix6<f64> {
    let mut hold = Matrix6::zeros();
    for pair in pairs.iter().step_by(SPURIOUS_EVERY) {
        for along in tangents(&pair.normal) {
            let change = change(&(pair.at.coords - middle), &along);
            hold += change * change.transpose() * (pair.weight * tilt_sq);
        }
    }
    hold * SPURIOUS_EVERY as f64
}

/// The sums over all pairs.
struct Sums {
    middle: Vector3<f64>,
    per_scale_sq: f64,
    /// H
    hold: Matrix6<f64>,
    /// Σ w r J
    pull: Vector6<f64>,
}

impl Sums {
    fn new(middle: Vector3<f64>, per_scale_sq: f64) -> Self {
        Self {
            middle,
            per_scale_sq,
            hold: Matrix6::zeros(),
            pull: Vector6::zeros(),
        }
    }

    /// Adds a distance along a direction, and returns its change.
    fn add(
        &mut self,
        at: &Point3<f64>,
        direction: &Vector3<f64>,
        off: f64,
        weight: f64,
    ) -> Vector6<f64> {
        let change = change(&(at.coords - self.middle), direction);
        // ψ'(r) of the Welsch weight.
        let stiffness = weight * (1.0 - 2.0 * off * off * self.per_scale_sq);
        self.hold += change * change.transpose() * stiffness;
        self.pull += change * (weight * off);
        change
    }

    fn bounds(
        &self,
        spurious_stiffness: &Matrix6<f64>,
        spread: &Matrix6<f64>,
        frame: &LocalFrame,
        (most_turn, most_shift): (Radians, Metres),
        [turn_factor, shift_factor]: [f64; 2],
    ) -> Uncertainty {
        if let Some(motion) = self.free_motion(spurious_stiffness, frame) {
            return Uncertainty::free(frame.freedom(&motion));
        }
        let Some(hold) = (self.hold - spurious_stiffness).cholesky() else {
            return Uncertainty::free(FreeMotion::Anyhow);
        };
        let inverse = hold.inverse();
        let covariance = inverse * spread * inverse;
        // ICP ends where points are close, not where surfaces are: what it has still to go counts in full.
        let to_go = inverse * self.pull;
        let block = |first: usize| covariance.fixed_view::<3, 3>(first, first).into_owned();
        let bound = |first: usize, factor: f64| {
            factor * within_95(&block(first)) + to_go.fixed_rows::<3>(first).norm()
        };
        let (turn, shift) = (bound(0, turn_factor), bound(3, shift_factor));
        let is_held = turn <= most_turn.0 && shift <= most_shift.0;
        let freedom = (!is_held).then(|| frame.widest(&covariance));
        Uncertainty {
            shift: Metres(shift),
            turn: Radians(turn),
            freedom,
        }
    }

    /// Returns an unconstrained motion, if there is one: turn, then shift.
    fn free_motion(
        &self,
        spurious_stiffness: &Matrix6<f64>,
        frame: &LocalFrame,
    ) -> Option<Vector6<f64>> {
        let units = frame.units();
        let (hold, spurious_stiffness) = (
            units * self.hold * units,
            units * spurious_stiffness * units,
        );
        if !hold
            .iter()
            .chain(&spurious_stiffness)
            .all(|x| x.is_finite())
        {
            return Some(Vector6::zeros());
        }
        let Some(root) = hold.cholesky().map(|c| c.l()) else {
            let eigen = hold.symmetric_eigen();
            let softest = eigen.eigenvectors.column(eigen.eigenvalues.imin());
            return Some(units * softest);
        };
        // The largest spurious share: with hold = L Lᵀ, an eigenvalue of L⁻¹ spurious L⁻ᵀ.
        let half = root.solve_lower_triangular(&spurious_stiffness)?;
        let whole = root.solve_lower_triangular(&half.transpose())?;
        let eigen = whole.symmetric_eigen();
        let most = eigen.eigenvalues.imax();
        if eigen.eigenvalues[most] < MAX_SPURIOUS {
            return None;
        }
        let motion =
            root.tr_solve_lower_triangular(&eigen.eigenvectors.column(most).into_owned())?;
        Some(units * motion)
    }
}

/// The length that a normal variable of this covariance keeps below in 95 of 100 cases: its square is taken for a
/// scaled χ² (F. E. Satterthwaite, "An approximate distribution of estimates of variance components", Biometrics
/// Bulletin 2(6), 1946), whose quantile is that of E. B. Wilson and M. M. Hilferty, "The distribution of chi-square",
/// PNAS 17(12), 1931.
fn within_95(covariance: &Matrix3<f64>) -> f64 {
    const QUANTILE: f64 = 1.645;
    let (mean, square) = (covariance.trace(), (covariance * covariance).trace());
    if !(mean > 0.0) {
        return 0.0;
    }
    let per_degree = 2.0 / 9.0 * square / (mean * mean);
    (mean * (1.0 - per_degree + QUANTILE * per_degree.sqrt()).powi(3)).sqrt()
}

#[cfg(test)]
mod tests;
