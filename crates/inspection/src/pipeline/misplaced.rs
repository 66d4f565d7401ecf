//! Refuses parts that hang where, or as, the rack does not allow.

use nalgebra::{Point3, Vector3};

use super::{Inspection, Rejection, Verdict};
use crate::library::Library;
use geometry::{cloud::is_finite, units::Metres};
use stages::{rack::Rack, scene::SceneCloud};

/// Step in depth up to which a reading outside the work volume continues the part, metres.
const CONTINUED_M: f32 = 0.02;
/// Minimum number of readings at which the part continues outside the work volume.
const MIN_CONTINUED: usize = 20;

/// True if the part may be refused only because some of it was cut off.
fn is_of_shape(rejected: &Rejection) -> bool {
    matches!(
        rejected,
        Rejection::LowScore { .. }
            | Rejection::Piece { .. }
            | Rejection::HardlySeen { .. }
            | Rejection::AnotherModel { .. }
            | Rejection::AnotherMake { .. }
            | Rejection::AmbiguousPose { .. }
            | Rejection::Unconstrained { .. }
            | Rejection::Uncertain { .. }
            | Rejection::OffScale { .. }
    )
}

impl Inspection {
    /// Notes where in the rack the part hangs, and refuses it if it may not hang like this.
    pub(super) fn hang_in(&mut self, rack: &Rack, scene: &SceneCloud, library: &Library) {
        if rack.is_empty() {
            return;
        }
        self.leaves_volume = self.continues_outside(rack, scene);
        if let Verdict::Part {
            part,
            rejected: Some(rejected),
            ..
        } = &mut self.verdict
            && self.leaves_volume
            && is_of_shape(rejected)
        {
            *rejected = Rejection::CutByVolume { part: part.clone() };
        }
        let reference = self.best_reference(library);
        let pose = self.found_pose().filter(|_| self.verdict.is_named());
        let (Some(reference), Some(pose)) = (reference, pose) else {
            let nearest = (self.centroid()).and_then(|centroid| rack.nearest_place(&centroid));
            let here = nearest.filter(|(_, distance)| *distance <= 0.0);
            self.place = here.map(|(place, _)| place.name.clone());
            return;
        };
        let camera_from_part = pose.camera_from_part();
        let middle = reference.middle().map(|middle| camera_from_part * middle);
        let Some((place, distance)) = middle.and_then(|at| rack.nearest_place(&at)) else {
            return;
        };
        let (part, name) = (reference.name.clone(), place.name.clone());
        let turn = place.turn(reference, &camera_from_part);
        let rejection = match turn {
            // A distance that is no number is none either.
            _ if !(distance <= 0.0) => Some(Rejection::BesidePlaces {
                part,
                place: name.clone(),
                distance: Metres(distance),
            }),
            // The orientations of its other references say nothing about this one.
            None => Some(Rejection::WrongPlace {
                part: reference.enrolled_as.clone(),
                place: name.clone(),
            }),
            _ if !place.admits(reference) => Some(Rejection::WrongPlace {
                part,
                place: name.clone(),
            }),
            Some(turn) if !turn.is_allowed() => Some(Rejection::Turned {
                part,
                place: name.clone(),
                turn: turn.found,
                limit: turn.limit,
            }),
            Some(_) => None,
        };
        let is_there = distance <= 0.0;
        self.place = is_there.then_some(name);
        self.turn_at_place = turn.filter(|_| is_there && place.limits_turn(reference));
        if let Verdict::Part {
            rejected: rejected @ None,
            ..
        } = &mut self.verdict
        {
            *rejected = rejection;
        }
    }

    /// The mean of the part's readings.
    fn centroid(&self) -> Option<Point3<f64>> {
        let points = self.readings()?;
        let sum: Vector3<f64> = points.iter().map(|p| p.coords.cast()).sum();
        (!points.is_empty()).then(|| (sum / points.len() as f64).into())
    }

    /// True if the part goes on outside the work volume.
    fn continues_outside(&self, rack: &Rack, scene: &SceneCloud) -> bool {
        let (Ok(part), Some(grid)) = (&self.segmentation.part, scene.cloud.grid) else {
            return false;
        };
        if rack.volume.is_empty() {
            return false;
        }
        let (points, is_inside) = (&scene.cloud.points, rack.volume_test());
        let continues = |i: usize, p: &Point3<f32>| {
            let column = i % grid.width;
            let neighbours = [
                (column > 0).then(|| i - 1),
                (column + 1 < grid.width).then_some(i + 1),
                i.checked_sub(grid.width),
                Some(i + grid.width),
            ];
            neighbours.into_iter().flatten().any(|other| {
                points.get(other).is_some_and(|other| {
                    is_finite(other) && (other.z - p.z).abs() < CONTINUED_M && !is_inside(other)
                })
            })
        };
        let at_border = part.indices.iter().filter(|i| {
            let i = **i as usize;
            points.get(i).is_some_and(|p| continues(i, p))
        });
        at_border.take(MIN_CONTINUED).count() == MIN_CONTINUED
    }
}
