//! Rotations that map a reference onto itself: its poses before and after look the same from every side.

use nalgebra::{Translation3, Unit, UnitQuaternion, Vector3};

use super::{NUM_EDGES, Reference};
use crate::pose::refine::{AlignmentSource, Level, Search, refine};
use geometry::{principal::principal_axes, rigid::RigidTransform, statistics::sample_evenly};

/// Turns about a principal axis that are tried are one n-th of a whole one, up to this n.
const MOST_FOLD: u8 = 6;
/// Points that are compared.
const NUM_COMPARED: usize = 1000;
/// Distance at which a turned point still lies on the reference, metres: nearly twice the spacing of its points.
const ON_ITSELF_M: f32 = 0.015;
/// Share of the points that lie there after a turn that changes nothing.
const MIN_UNCHANGED_SHARE: f64 = 0.985;
/// The same by the field, and about an axis that is off by a degree or a centimetre: a wheel with five spokes has 0.93, one
/// with six 0.97, and the shipped and other car parts have at most 0.79.
const MIN_NEARLY_UNCHANGED_SHARE: f64 = 0.85;
/// Corrects the axis: first centimetres and degrees.
const CORRECTION: [Level; 2] = [
    Level {
        num_surface: NUM_COMPARED,
        num_edges: NUM_EDGES,
        scale: 0.03,
        max_steps: 8,
        settled: 0.005,
        search: Search::Field,
    },
    Level {
        num_surface: NUM_COMPARED,
        num_edges: NUM_EDGES,
        scale: 0.01,
        max_steps: 12,
        settled: 0.005,
        search: Search::Tree,
    },
];
/// A smaller turn leads to the same pose, radians.
const MIN_TURN_RAD: f64 = 0.35;

impl Reference {
    /// Returns a turn that lays the reference onto itself, part space; `None` if there is none about a principal axis.
    /// Computed on first use.
    pub fn own_turn(&self) -> Option<RigidTransform> {
        *self.own_turn.get_or_init(|| {
            let points = sample_evenly(&self.cloud.points, NUM_COMPARED);
            let principal = principal_axes(points.map(|p| (p.cast::<f64>(), 1.0)))?;
            let mean = Translation3::from(principal.mean);
            let turns = (0..3).flat_map(|axis| {
                let axis: Vector3<f64> = principal.axes.column(axis).into_owned();
                (2..=MOST_FOLD).map(move |fold| {
                    let turn = std::f64::consts::TAU / f64::from(fold);
                    let turn = UnitQuaternion::from_axis_angle(&Unit::new_normalize(axis), turn);
                    mean * turn * mean.inverse()
                })
            });
            let turns =
                turns.filter_map(|turn| Some((self.share_on_itself(&turn, Search::Field)?, turn)));
            let mut candidates: Vec<_> = turns
                .filter(|(share, _)| *share >= MIN_NEARLY_UNCHANGED_SHARE)
                .collect();
            candidates.sort_by(|a, b| b.0.total_cmp(&a.0));
            candidates.into_iter().find_map(|(_, turn)| {
                let turn = self.corrected(&turn)?;
                let share = self.share_on_itself(&turn, Search::Tree)?;
                let is_own = share >= MIN_UNCHANGED_SHARE && turn.rotation.angle() >= MIN_TURN_RAD;
                is_own.then_some(turn)
            })
        })
    }

    /// The other poses at which a reference looks the same as at this one, part space from another; none without a turn of its
    /// own.
    pub(crate) fn turned_onto_itself(&self, pose: &RigidTransform) -> Vec<RigidTransform> {
        let Some(turn) = self.own_turn() else {
            return Vec::new();
        };
        let fold = (std::f64::consts::TAU / turn.rotation.angle()).round() as usize;
        let turned = std::iter::successors(Some(turn * pose), |turned| Some(turn * turned));
        turned.take(fold.saturating_sub(1)).collect()
    }

    /// Share of its points that lie on it after a motion and face the same way there, 0..1.
    fn share_on_itself(&self, motion: &RigidTransform, search: Search) -> Option<f64> {
        let back = (0..self.views.len()).find(|view| !self.are_of_one_side(0, *view));
        let sides = [self.target(0), back.and_then(|back| self.target(back))];
        let motion = motion.cast::<f32>();
        let normals = self.cloud.normals.as_deref()?;
        let all = self.cloud.points.len().min(normals.len());
        let numbers: Vec<usize> = (0..all).collect();
        let numbers = sample_evenly(&numbers, NUM_COMPARED);
        let is_on = |i: &&usize| {
            let (at, normal) = (motion * self.cloud.points[**i], motion * normals[**i]);
            sides.iter().flatten().any(|side| {
                let near = side.nearest(search, &at, ON_ITSELF_M * ON_ITSELF_M);
                let normals = side.cloud.normals.as_deref();
                near.zip(normals)
                    .is_some_and(|(near, normals)| normals[near.index].dot(&normal) > 0.0)
            })
        };
        let num_on = numbers.clone().filter(is_on).count();
        Some(num_on as f64 / numbers.count().max(1) as f64)
    }

    fn corrected(&self, turn: &RigidTransform) -> Option<RigidTransform> {
        let target = self.whole_target(0)?;
        let points = sample_evenly(&self.cloud.points, NUM_COMPARED);
        let source = AlignmentSource {
            surface: points.copied().collect(),
            edges: target.edges.iter().collect(),
        };
        Some(refine(&source, &target, turn, &CORRECTION).target_from_source)
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Point3;

    use crate::reference::{Coverage, Reference, ReferenceParams};
    use geometry::cloud::PointCloud;

    use super::*;

    /// A wheel: a ring with spokes, all alike; the first is missing if it is `marked`.
    fn wheel(num_spokes: usize, is_marked: bool) -> Reference {
        let points = (0..90_i16).flat_map(|x| (0..90_i16).map(move |y| [x, y]));
        let points = points.filter_map(|[x, y]| {
            let (x, y) = (0.008 * f32::from(x - 45), 0.008 * f32::from(y - 45));
            let (radius, turn) = (x.hypot(y), y.atan2(x).rem_euclid(std::f32::consts::TAU));
            let spoke = turn / std::f32::consts::TAU * num_spokes as f32;
            let across = (spoke - spoke.round()) / num_spokes as f32 * std::f32::consts::TAU;
            let is_spoke = (across * radius).abs() < 0.03 && radius < 0.3;
            let is_first = (spoke.round() as usize).is_multiple_of(num_spokes) && radius > 0.1;
            let is_part = (0.25..0.34).contains(&radius) || (is_spoke && !(is_marked && is_first));
            is_part.then(|| Point3::new(0.1 + x, y - 0.2, 1.2))
        });
        let points: Vec<Point3<f32>> = points.collect();
        let cloud = PointCloud {
            normals: Some(vec![-Vector3::z(); points.len()]),
            ..PointCloud::from_points(points)
        };
        let params = ReferenceParams::default();
        Reference::prepare("wheel", cloud, Coverage::OneSide, &params).expect("a reference")
    }

    #[test]
    fn a_wheel_has_a_turn_of_its_own_unless_a_spoke_is_missing() {
        for num_spokes in [3, 4, 5, 6] {
            let turn = wheel(num_spokes, false).own_turn().expect("a turn");
            let spokes = turn.rotation.angle() / std::f64::consts::TAU * num_spokes as f64;
            assert!(
                (spokes - spokes.round()).abs() < 0.02,
                "{num_spokes}: {spokes}"
            );
            assert_eq!(wheel(num_spokes, true).own_turn(), None, "{num_spokes}");
        }
    }
}
