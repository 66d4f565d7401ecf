//! Where parts may hang before a camera: the work volume, and places with the orientations that are allowed there.

use nalgebra::{Point3, UnitQuaternion};
use serde::{Deserialize, Serialize};

use super::reference::Reference;
use geometry::{oriented_box::OrientedBox, rigid::RigidTransform, units::Radians};

/// A work volume and places, in camera space, or in the frame of a file.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Rack {
    /// Its name; may be empty.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub name: String,
    /// Readings outside all of these boxes are background; empty if parts may hang anywhere.
    pub volume: Vec<OrientedBox>,
    /// The places; empty if they are not known. The centre of none lies in another.
    pub places: Vec<Place>,
}

/// A place for one part.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Place {
    /// Its name.
    pub name: String,
    /// Where the middle of the part may be.
    pub region: OrientedBox,
    /// How far a part may be turned from an orientation that it may have there.
    #[serde(rename = "max_turn_rad")]
    pub max_turn: Radians,
    /// The parts that may hang there; empty if each may, in any orientation.
    pub parts: Vec<PlacedPart>,
}

/// A part that may hang at a place.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PlacedPart {
    /// Name of the reference.
    pub name: String,
    /// The orientation of its coordinates, rotation about x, y and z of the frame, radians, R = Rz·Ry·Rx; `None` if it may
    /// have any.
    pub angles_rad: Option<[f64; 3]>,
}

impl Rack {
    /// A rack in which parts may hang anywhere.
    pub const ANYWHERE: &Self = &Self {
        name: String::new(),
        volume: Vec::new(),
        places: Vec::new(),
    };

    /// True if parts may hang anywhere.
    pub fn is_empty(&self) -> bool {
        self.volume.is_empty() && self.places.is_empty()
    }

    /// The same rack in another frame.
    #[must_use]
    pub fn moved(&self, other_from_frame: &RigidTransform) -> Self {
        let moved = |region: &OrientedBox| region.moved(other_from_frame);
        let place = |place: &Place| Place {
            region: moved(&place.region),
            parts: (place.parts.iter())
                .map(|part| PlacedPart {
                    name: part.name.clone(),
                    angles_rad: part.angles_rad.map(|[rx, ry, rz]| {
                        let own = UnitQuaternion::from_euler_angles(rx, ry, rz);
                        (other_from_frame.rotation * own).euler_angles().into()
                    }),
                })
                .collect(),
            ..place.clone()
        };
        Self {
            name: self.name.clone(),
            volume: self.volume.iter().map(moved).collect(),
            places: self.places.iter().map(place).collect(),
        }
    }

    /// Returns a test whether a point lies in the work volume.
    pub fn volume_test(&self) -> impl Fn(&Point3<f32>) -> bool + use<> {
        let boxes = self.volume.iter();
        let boxes: Vec<_> = boxes
            .map(|region| (region.box_from_frame().cast::<f32>(), region.half().cast()))
            .collect();
        move |point| {
            boxes.is_empty()
                || boxes.iter().any(|(box_from_camera, half)| {
                    let at = (box_from_camera * point).coords.abs();
                    at.x <= half.x && at.y <= half.y && at.z <= half.z
                })
        }
    }

    /// The place nearest to a part's middle, and its distance, metres; 0 within the place. `None` if no places are known.
    pub fn nearest_place(&self, middle: &Point3<f64>) -> Option<(&Place, f64)> {
        let places = self.places.iter();
        let distances = places.map(|place| (place, place.region.distance(middle)));
        distances.min_by(|(_, a), (_, b)| a.total_cmp(b))
    }

    /// False if a part may not be turned like this at the place nearest to it.
    pub fn allows_turn(&self, reference: &Reference, part_from_camera: &RigidTransform) -> bool {
        if self.places.is_empty() {
            return true;
        }
        let camera_from_part = part_from_camera.inverse();
        let middle = reference.middle().map(|middle| camera_from_part * middle);
        let Some((place, _)) = middle.and_then(|middle| self.nearest_place(&middle)) else {
            return true;
        };
        let turn = place.turn(reference, &camera_from_part);
        !place.admits(reference) || turn.is_some_and(|turn| turn <= place.max_turn)
    }
}

impl Place {
    /// True if a part may hang there.
    pub fn admits(&self, reference: &Reference) -> bool {
        self.parts.is_empty() || self.entries(reference).next().is_some()
    }

    /// How far a part is turned from the nearest orientation that it may have there; 0 if it may have any. `None` if that is
    /// known of other references of the part only.
    pub fn turn(
        &self,
        reference: &Reference,
        camera_from_part: &RigidTransform,
    ) -> Option<Radians> {
        let oriented = |part: &&PlacedPart| part.angles_rad.is_some();
        if self
            .entries(reference)
            .all(|part| part.angles_rad.is_none())
        {
            return Some(Radians(0.0));
        }
        let own = self.entries(reference).filter(oriented);
        let own = own.filter(|part| part.name == reference.enrolled_as);
        let turns = own.filter_map(|part| {
            let [rx, ry, rz] = part.angles_rad?;
            let allowed = UnitQuaternion::from_euler_angles(rx, ry, rz);
            Some(camera_from_part.rotation.angle_to(&allowed))
        });
        turns.min_by(f64::total_cmp).map(Radians)
    }

    fn entries(&self, reference: &Reference) -> impl Iterator<Item = &PlacedPart> {
        self.parts
            .iter()
            .filter(|part| part.name == reference.enrolled_as || part.name == reference.name)
    }
}
