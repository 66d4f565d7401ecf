//! How much larger or smaller a source is than its target: what a camera with wrong numbers shows.
//!
//! If a camera's depths are too long by a share, or its focal lengths too small, everything that it sees is as much too
//! large. A pose cannot follow, but a similarity can: turn, shift and scale are refined together from the pose on, surface to
//! tangent plane and outline across outline, as in [`super::refine`] (the scale is that of S. Umeyama, "Least-squares
//! estimation of transformation parameters between two point patterns", IEEE TPAMI 13(4), 1991, here for pairs that may slide
//! along the surface).
//!
//! Only those points of the outline may be given that are edges of the part: where the picture ends or the surface curves out
//! of sight, an outline has the size of the view. Where a shift explains what a scale does, because one side of the outline is
//! out of sight, the deviation is large. It is made up of errors that a region of the surface or a side of the outline shares,
//! as in [`super::uncertainty`], and of how much the scale changes without any one stretch (the jackknife: J. W. Tukey, "Bias
//! and confidence in not-quite large samples", Annals of Mathematical Statistics 29, 1958).
//!
//! Known limits: an error of one focal length alone shows by half of it at most; an optical centre that is off shows not at
//! all, nor does a picture turned by half a turn, which is that of a camera mounted upside down.

use std::collections::BTreeMap;

use nalgebra::{Point3, SMatrix, SVector, Translation3, UnitQuaternion, Vector3};

use super::{
    equations::edge_share,
    refine::{AlignmentSource, AlignmentTarget, Search},
};
use geometry::{rigid::RigidTransform, units::Metres};

/// The size of a source relative to its target.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScaleEstimate {
    /// Size of the source divided by that of the target.
    pub scale: f64,
    /// Standard deviation of `scale`.
    pub deviation: f64,
}

/// Least difference from 1 that is no error of the estimate. Of accepted pairs of real frames whose deviation is small, the worst is
/// 1.8 % off; another model of a part, 2.5 %.
const MIN_OFF: f64 = 0.03;
/// Least difference from 1 in standard deviations.
const MIN_DEVIATIONS: f64 = 2.5;

impl ScaleEstimate {
    /// The difference, if the source is certainly larger or smaller than its target.
    pub fn off(&self) -> Option<OffScale> {
        let off = (self.scale - 1.0).abs();
        let is_off = off > MIN_OFF && off > MIN_DEVIATIONS * self.deviation;
        is_off.then_some(OffScale {
            is_larger: self.scale > 1.0,
            by: off,
        })
    }
}

/// The source is larger or smaller than the target, so the camera's numbers are probably wrong.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize, thiserror::Error)]
pub struct OffScale {
    /// True if it is larger than its target.
    pub is_larger: bool,
    /// Difference of the sizes, as a share of the target's.
    pub by: f64,
}

impl OffScale {
    /// Size of the source divided by that of the target.
    pub fn scale(&self) -> f64 {
        if self.is_larger {
            1.0 + self.by
        } else {
            1.0 - self.by
        }
    }
}

impl texts::Described for OffScale {
    fn message(&self) -> texts::Message {
        texts::Message::new("pose-off-scale").with_fields(self)
    }
}

texts::display!(OffScale);

/// Turn, shift and logarithm of the scale.
type Step = SVector<f64, 7>;
type Square = SMatrix<f64, 7, 7>;

/// Scales of the weights in the rounds, metres: a part of a metre that is 5 % too large ends 25 mm too far out.
const ROUND_SCALES_M: [f64; 5] = [0.04, 0.04, 0.04, 0.03, 0.03];
const LAST_ROUND_SCALES_M: [f64; 4] = [0.02; 4];
/// If the last rounds change the scale by more, it depends on which pairs count, and is none.
const MAX_DRIFT: f64 = 0.01;
/// By so much the scale comes out too large at the right size: 1.1 % on average in real frames of a fender, 1.3 % of a door, 0.4 % in
/// simulated ones. Stray points lie outside an outline rather than inside.
const BIAS: f64 = 0.008;
/// Greatest factor by which turn and shift, which are not known either, increase the variance of the scale. In accepted real frames
/// it is below 8; where one side of an outline is seen, above 100, and a piece of a door whose scale came out 12 % off had 30.
const MAX_INFLATION: f64 = 20.0;
/// Source points used.
const NUM_SURFACE: usize = 600;
/// Fewer pairs of edges show no size.
const MIN_EDGES: usize = 16;
/// Side of a region of the surface whose pairs share an error, metres. A side of the outline shares one, too.
const REGION_M: f64 = 0.5;
/// Error that a region of the surface shares, metres.
const SURFACE_ERROR_M: f64 = 0.003;
/// Error that a side of the outline shares, metres: two pixels at 1.2 m.
const OUTLINE_ERROR_M: f64 = 0.005;
/// The same from noise, in standard deviations of the depth: noise of 15 mm makes parts up to 6 % larger.
const NOISE_SHARE: f64 = 1.5;
/// Sides of the stretches that are left out in turn, of the surface and of the outline, metres.
const STRETCHES_M: [f64; 2] = [0.3, 0.2];
/// Pairs beyond this many scales of the weight count nothing.
const REACH: f64 = 2.5;

/// Returns the scale of a source at this pose, from those points of its outline that are edges of the part; `None` if the pairs
/// leave it free.
pub fn scale(
    source: &AlignmentSource,
    edges: &[Point3<f32>],
    target: &AlignmentTarget<'_>,
    target_from_source: &RigidTransform,
    noise_at_1m: Metres,
) -> Option<ScaleEstimate> {
    let surface = &source.surface[..NUM_SURFACE.min(source.surface.len())];
    let mut similarity = Similarity {
        surface,
        edges,
        edge_share: edge_share(surface.len(), source.edges.len().max(1)),
        pose: *target_from_source,
        log_scale: 0.0,
    };
    for weight_scale in ROUND_SCALES_M {
        similarity.refine(target, weight_scale)?;
    }
    let before = similarity.log_scale;
    let mut last = None;
    for weight_scale in LAST_ROUND_SCALES_M {
        last = Some(similarity.refine(target, weight_scale)?);
    }
    let (pairs, sums) = last?;
    let num_edges = pairs.iter().filter(|pair| pair.is_edge).count();
    let is_settled = (similarity.log_scale - before).abs() <= MAX_DRIFT;
    let is_shown = num_edges >= MIN_EDGES && sums.inflation()? <= MAX_INFLATION;
    if !(is_settled && is_shown) {
        return None;
    }
    let depth_sq: f64 = edges
        .iter()
        .map(|p| f64::from(p.coords.norm_squared()))
        .sum();
    let noise = noise_at_1m.0 * depth_sq / edges.len() as f64;
    Some(ScaleEstimate {
        // The target is this much larger than the source.
        scale: (-similarity.log_scale - BIAS).exp(),
        deviation: sums
            .shared_error(&pairs, OUTLINE_ERROR_M.hypot(NOISE_SHARE * noise))
            .hypot(sums.jackknife(&pairs)?),
    })
}

/// A source that is turned, shifted and scaled.
struct Similarity<'a> {
    surface: &'a [Point3<f32>],
    edges: &'a [Point3<f32>],
    /// What a pair of edges counts beside one of the surface.
    edge_share: f64,
    pose: RigidTransform,
    log_scale: f64,
}

/// A source point and what it is pulled to.
struct Pair {
    at: Point3<f64>,
    direction: Vector3<f64>,
    /// Along the direction, metres.
    off: f64,
    weight: f64,
    is_edge: bool,
}

impl Similarity<'_> {
    /// Takes one step; `None` if the pairs leave it free.
    fn refine(
        &mut self,
        target: &AlignmentTarget<'_>,
        weight_scale: f64,
    ) -> Option<(Vec<Pair>, Sums)> {
        let pairs = self.pairs(target, weight_scale);
        let sums = Sums::of(&pairs)?;
        let step = sums.hold.cholesky()?.solve(&sums.pull);
        self.log_scale += step[6];
        let turn = UnitQuaternion::from_scaled_axis(Vector3::new(step[0], step[1], step[2]));
        let shift = Vector3::new(step[3], step[4], step[5]);
        // x ↦ m + e^σ R (x - m) + t
        let middle = sums.middle;
        let grown = step[6].exp();
        let moved = middle.coords + shift - (turn * middle.coords) * grown;
        self.pose = RigidTransform::from_parts(
            Translation3::from(moved + (turn * self.pose.translation.vector) * grown),
            turn * self.pose.rotation,
        );
        Some((pairs, sums))
    }

    fn pairs(&self, target: &AlignmentTarget<'_>, weight_scale: f64) -> Vec<Pair> {
        let reach_sq = (REACH * weight_scale).powi(2) as f32;
        let per_scale_sq = 1.0 / (weight_scale * weight_scale);
        let scale = self.log_scale.exp();
        let moved = |p: &Point3<f32>| {
            let turned = self.pose.rotation * (p.coords.cast::<f64>() * scale);
            Point3::from(turned + self.pose.translation.vector)
        };
        let normals = target.cloud.normals.as_deref().unwrap_or_default();
        let of_surface = self.surface.iter().filter_map(|p| {
            let at = moved(p);
            let near = target.nearest(Search::Tree, &at.cast(), reach_sq)?;
            let direction: Vector3<f64> = normals.get(near.index)?.cast();
            let away = target.cloud.points[near.index].cast::<f64>() - at;
            Some(Pair {
                at,
                off: away.dot(&direction),
                direction,
                weight: (-f64::from(near.distance_sq) * per_scale_sq).exp(),
                is_edge: false,
            })
        });
        let of_edges = self.edges.iter().filter_map(|p| {
            let at = moved(p);
            let (number, distance_sq) = target.edges.closest_number(&at.cast(), reach_sq)?;
            let closest = target.edges.point(number);
            let along = target.edges.along(number)?;
            let near = target.nearest(Search::Field, &closest, f32::INFINITY)?;
            let normal = normals.get(near.index)?;
            let direction = along.cross(normal).try_normalize(1e-6)?.cast::<f64>();
            let away = closest.cast::<f64>() - at;
            Some(Pair {
                at,
                off: away.dot(&direction),
                direction,
                weight: self.edge_share * (-f64::from(distance_sq) * per_scale_sq).exp(),
                is_edge: true,
            })
        });
        of_surface.chain(of_edges).collect()
    }
}

impl Pair {
    /// How the distance along the direction changes with turn, shift and scale about a point.
    fn change(&self, middle: &Point3<f64>) -> Step {
        let out = self.at - middle;
        let turn = out.cross(&self.direction);
        let d = &self.direction;
        Step::from([turn.x, turn.y, turn.z, d.x, d.y, d.z, out.dot(d)])
    }

    /// Which way the outline faces here; the same all over the surface.
    fn side(&self) -> [i32; 3] {
        if self.is_edge {
            self.direction.map(|x| (1.2 * x).round() as i32).into()
        } else {
            [0; 3]
        }
    }
}

/// The normal equations of some pairs.
struct Sums {
    middle: Point3<f64>,
    /// Σ w J Jᵀ
    hold: Square,
    /// Σ w r J
    pull: Step,
    /// Σ w J
    lever: Step,
}

impl Sums {
    fn of(pairs: &[Pair]) -> Option<Self> {
        let weight: f64 = pairs.iter().map(|pair| pair.weight).sum();
        let sum: Vector3<f64> = pairs.iter().map(|pair| pair.at.coords * pair.weight).sum();
        let mut sums = Self::about(Point3::from(sum / weight));
        for pair in pairs {
            sums.add(pair);
        }
        sums.hold += Square::identity() * (1e-9 * sums.hold.trace());
        (weight > 0.0).then_some(sums)
    }

    fn about(middle: Point3<f64>) -> Self {
        Self {
            middle,
            hold: Square::zeros(),
            pull: Step::zeros(),
            lever: Step::zeros(),
        }
    }

    fn add(&mut self, pair: &Pair) {
        let change = pair.change(&self.middle);
        let weighted = change * pair.weight;
        self.hold += change * weighted.transpose();
        self.pull += weighted * pair.off;
        self.lever += weighted;
    }

    /// The sums of each group of pairs that lie together and face the same way; of the surface, and of the outline.
    fn grouped(&self, pairs: &[Pair], sides: [f64; 2]) -> impl Iterator<Item = (bool, Self)> {
        let mut groups: BTreeMap<(bool, [i32; 3], [i32; 3]), Self> = BTreeMap::new();
        for pair in pairs {
            let side = sides[usize::from(pair.is_edge)];
            let cell = ((pair.at - self.middle) / side).map(|x| x.floor() as i32);
            let group = groups.entry((pair.is_edge, pair.side(), cell.into()));
            group.or_insert_with(|| Self::about(self.middle)).add(pair);
        }
        groups
            .into_iter()
            .map(|((is_edge, ..), sums)| (is_edge, sums))
    }

    /// Variance of the scale, divided by what it would be if turn and shift were known.
    fn inflation(&self) -> Option<f64> {
        Some(self.hold[(6, 6)] * self.hold.cholesky()?.inverse()[(6, 6)])
    }

    /// Standard deviation of the scale by errors that whole regions and sides share.
    fn shared_error(&self, pairs: &[Pair], outline_error: f64) -> f64 {
        let Some(hold) = self.hold.cholesky() else {
            return f64::INFINITY;
        };
        let variances = self
            .grouped(pairs, [REGION_M, f64::INFINITY])
            .map(|(is_edge, group)| {
                let error = if is_edge {
                    outline_error
                } else {
                    SURFACE_ERROR_M
                };
                (hold.solve(&group.lever)[6] * error).powi(2)
            });
        variances.sum::<f64>().sqrt()
    }

    /// Standard deviation of the scale by what the stretches disagree about; `None` if it hangs on one of them.
    fn jackknife(&self, pairs: &[Pair]) -> Option<f64> {
        let (mut sum_sq, mut num) = (0.0, 0.0);
        for (_, group) in self.grouped(pairs, STRETCHES_M) {
            let without = (self.hold - group.hold).cholesky()?;
            sum_sq += without.solve(&(self.pull - group.pull))[6].powi(2);
            num += 1.0;
        }
        Some((sum_sq * (num - 1.0) / num).sqrt())
    }
}

#[cfg(test)]
mod tests {
    use std::sync::OnceLock;

    use super::*;
    use crate::pose::edge_points::EdgePoints;
    use geometry::{cloud::PointCloud, nearest_field::NearestField};
    use nalgebra::Isometry3;

    /// A sheet of 1 m by 0.6 m that rises by `bulge` in the middle, with its rim, a point a centimetre.
    fn sheet(bulge: f32) -> (PointCloud, Vec<Point3<f32>>) {
        let at = |x: f32, y: f32| Point3::new(x, y, bulge * (1.0 - 4.0 * x * x));
        let surface = (0..=100).flat_map(|i| (0..=60).map(move |j| (i, j)));
        let points: Vec<Point3<f32>> = surface
            .map(|(i, j)| at(i as f32 * 0.01 - 0.5, j as f32 * 0.01 - 0.3))
            .collect();
        let normals = points
            .iter()
            .map(|p| Vector3::new(8.0 * bulge * p.x, 0.0, 1.0).normalize());
        let normals = Some(normals.collect());
        let sides = (0..100).map(|i| i as f32 * 0.01 - 0.5);
        let ends = (0..60).map(|i| i as f32 * 0.01 - 0.3);
        let rim: Vec<Point3<f32>> = sides
            .clone()
            .map(|x| at(x, -0.3))
            .chain(ends.clone().map(|y| at(0.5, y)))
            .chain(sides.map(|x| at(-x, 0.3)))
            .chain(ends.map(|y| at(-0.5, -y)))
            .collect();
        let cloud = PointCloud {
            normals,
            ..PointCloud::from_points(points)
        };
        (cloud, rim)
    }

    /// The scale of a sheet this many times as large, of whose rim only some points are seen.
    fn scale_of(
        times: f64,
        bulge: f32,
        is_seen: impl Fn(&Point3<f32>) -> bool,
    ) -> Option<ScaleEstimate> {
        let (cloud, rim) = sheet(bulge);
        let field = NearestField::new(&cloud.points, 0.01, 0.1);
        let edges = EdgePoints::new(&rim, 400);
        let target = AlignmentTarget {
            cloud: &cloud,
            tree: &OnceLock::new(),
            field: &field,
            edges: &edges,
            spacing: 0.01,
        };
        let source_from_target =
            Isometry3::new(Vector3::new(0.1, -0.2, 1.4), Vector3::new(0.2, -0.3, 1.1));
        let seen = |p: &Point3<f32>| {
            let grown = p.coords.cast::<f64>() * times;
            (source_from_target * Point3::from(grown)).cast::<f32>()
        };
        let surface = cloud.points.iter().step_by(7);
        let source = AlignmentSource {
            surface: surface.map(seen).collect(),
            edges: rim.iter().filter(|p| is_seen(p)).map(seen).collect(),
        };
        let pose = source_from_target.inverse();
        scale(&source, &source.edges, &target, &pose, Metres(0.0))
    }

    #[test]
    fn a_sheet_that_is_larger_or_smaller_is_found_to_be_by_as_much() {
        for times in [0.95, 0.97, 1.0, 1.02, 1.05, 1.07] {
            for bulge in [0.0, 0.08] {
                let found = scale_of(times, bulge, |_| true).expect("an estimate");
                // No point of this outline is a stray one.
                let expected = times * (-BIAS).exp();
                assert!(
                    (found.scale - expected).abs() < 0.004,
                    "{times} {bulge}: {found:?}"
                );
                let off = (expected - 1.0).abs();
                let is_found_off = found.off().is_some();
                assert!(is_found_off || off < 0.035, "{times} {bulge}: {found:?}");
                assert!(!is_found_off || off > 0.025, "{times} {bulge}: {found:?}");
            }
        }
    }

    #[test]
    fn a_sheet_of_which_one_side_is_seen_has_no_certain_scale() {
        for times in [0.95, 1.0, 1.05] {
            let found = scale_of(times, 0.0, |p| p.x > 0.4 && p.y.abs() < 0.299);
            let off = found.and_then(|found| found.off());
            assert_eq!(off, None, "{times}: {found:?}");
        }
    }
}
