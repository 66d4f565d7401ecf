//! The closest target points of a source: at one pose, looked up once for every figure of the fit; and from step to
//! step of a refinement, looked up anew only where another point may have come closer.

use nalgebra::{Point3, Vector3};

use super::refine::{AlignmentTarget, Search};
use geometry::{nearest::Neighbour, rigid::RigidTransform};

/// A source point at a pose, and the target point closest to it.
#[derive(Clone, Copy, Debug)]
pub struct Correspondence {
    /// Where the source point is, target space.
    pub at: Point3<f32>,
    /// `None` without one: the target is empty, or, by the field, the point is beyond its band.
    pub target: Option<Neighbour>,
}

impl Correspondence {
    /// The closest target point of each source point, in order.
    pub fn of_each(
        source: &[Point3<f32>],
        target: &AlignmentTarget<'_>,
        target_from_source: &RigidTransform,
        search: Search,
    ) -> Vec<Self> {
        let moved = target_from_source.cast::<f32>();
        let closest = |p: &Point3<f32>| {
            let at = moved * p;
            Self {
                at,
                target: target.nearest(search, &at, f32::INFINITY),
            }
        };
        source.iter().map(closest).collect()
    }

    /// Squared distance, normal and signed distance along it, if there is a target point with a normal within reach.
    pub fn on_surface(&self, target: &AlignmentTarget<'_>, reach_sq: f64) -> Option<OnSurface> {
        let near = self
            .target
            .filter(|n| f64::from(n.distance_sq) < reach_sq)?;
        let normal = *target.cloud.normals.as_deref()?.get(near.index)?;
        let away = target.cloud.points[near.index] - self.at;
        Some(OnSurface {
            distance_sq: f64::from(near.distance_sq),
            off: f64::from(normal.dot(&away)),
            normal: normal.cast(),
        })
    }
}

/// How a source point lies to the target's surface.
pub struct OnSurface {
    /// To the closest point, square metres.
    pub distance_sq: f64,
    /// To the surface along its normal, metres; above 0 where the surface is further out.
    pub off: f64,
    /// Unit normal.
    pub normal: Vector3<f64>,
}

/// Closest points of a source that moves by small steps.
///
/// Each search also returns the distance of the second closest point. As long as a source point has moved by less than
/// the lead of its closest point, no other can have overtaken it.
#[derive(Debug, Default)]
pub(super) struct ClosestTracker {
    known: Vec<Option<Known>>,
}

#[derive(Clone, Copy, Debug)]
struct Known {
    /// Where the source point was when it was looked up.
    at: Point3<f32>,
    closest: usize,
    /// Every other target point was at least this far away then, metres.
    others: f32,
}

impl ClosestTracker {
    /// The target point closest to the source point of this number, as [`AlignmentTarget::nearest`] finds it.
    pub(super) fn nearest(
        &mut self,
        number: usize,
        at: &Point3<f32>,
        target: &AlignmentTarget<'_>,
        search: Search,
        reach_sq: f32,
    ) -> Option<Neighbour> {
        if search == Search::Field {
            return target.nearest(search, at, reach_sq);
        }
        if self.known.len() <= number {
            self.known.resize(number + 1, None);
        }
        let slot = &mut self.known[number];
        if let Some(known) = slot {
            let distance_sq = (target.cloud.points[known.closest] - at).norm_squared();
            if distance_sq.sqrt() + (at - known.at).norm() < known.others {
                return (distance_sq < reach_sq).then_some(Neighbour {
                    index: known.closest,
                    distance_sq,
                });
            }
        }
        let found = target.tree().nearest_and_next(at, reach_sq);
        *slot = found.map(|(nearest, others_sq)| Known {
            at: *at,
            closest: nearest.index,
            others: others_sq.sqrt(),
        });
        found.map(|(nearest, _)| nearest)
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::pose::edge_points::EdgePoints;
    use geometry::{cloud::PointCloud, fixtures::any_point, nearest_field::NearestField};

    proptest! {
        #[test]
        fn a_followed_point_has_the_closest_of_a_search_at_every_step(
            points in prop::collection::vec(any_point(), 1..60),
            start in any_point(),
            steps in prop::collection::vec(any_point(), 1..20),
            reach in 0.1_f32..2.0,
        ) {
            let cloud = PointCloud::from_points(points);
            let target = AlignmentTarget {
                cloud: &cloud,
                tree: &std::sync::OnceLock::new(),
                field: &NearestField::new(&cloud.points, 0.1, 0.1),
                edges: &EdgePoints::default(),
                spacing: 0.1,
            };
            let mut followed = ClosestTracker::default();
            let mut at = start;
            for step in steps {
                at += step.coords * 0.05;
                let found = followed.nearest(0, &at, &target, Search::Tree, reach * reach);
                let searched = target.tree().nearest(&at, reach * reach);
                prop_assert_eq!(found.is_some(), searched.is_some());
                if let Some((found, searched)) = found.zip(searched) {
                    prop_assert!((found.distance_sq - searched.distance_sq).abs() < 1e-5);
                }
            }
        }
    }
}
