//! Where parts may hang before a camera: the work volume, and places with the orientations that are allowed there.

use nalgebra::{Point3, UnitQuaternion, Vector3};
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
    pub max_turn: MaxTurn,
    /// The parts that may hang there; empty if each may, in any orientation.
    pub parts: Vec<PlacedPart>,
}

/// How far a part may be turned from an orientation.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum MaxTurn {
    /// About whatever axis.
    Total(Radians),
    /// About x, y and z of the place's box.
    EachAxis([Radians; 3]),
}

/// A turn, and the largest that is allowed; with limits for each axis, about the axis where it uses up most of its limit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turn {
    /// The turn.
    pub found: Radians,
    /// The largest that is allowed.
    pub limit: Radians,
}

impl Turn {
    /// False if it is larger than allowed.
    pub fn is_allowed(&self) -> bool {
        self.found <= self.limit
    }

    /// Share of the limit.
    fn share(&self) -> f64 {
        self.found.0 / self.limit.0
    }
}

impl MaxTurn {
    /// The limits: one, or one for each axis.
    pub fn limits(&self) -> &[Radians] {
        match self {
            Self::Total(limit) => std::slice::from_ref(limit),
            Self::EachAxis(limits) => limits,
        }
    }

    /// The turn from one orientation to another in the frame of `region`.
    ///
    /// For each axis, it is split into a turn about the axis of the largest limit, and a tilt of that axis after it: so that a
    /// part that may turn freely about one axis has the same tilt whichever way it is turned.
    fn turn(
        &self,
        region: &OrientedBox,
        from: &UnitQuaternion<f64>,
        to: &UnitQuaternion<f64>,
    ) -> Turn {
        let limits = match self {
            Self::Total(limit) => {
                let found = Radians(to.angle_to(from));
                let limit = *limit;
                return Turn { found, limit };
            }
            Self::EachAxis(limits) => limits,
        };
        let [rx, ry, rz] = region.angles_rad;
        let frame_from_box = UnitQuaternion::from_euler_angles(rx, ry, rz);
        let turned = frame_from_box.inverse() * (to / from) * frame_from_box;
        let axis = (0..3).max_by(|a, b| limits[*a].0.total_cmp(&limits[*b].0));
        let axis = axis.expect("three axes");
        // Of the two quaternions of a turn, that of the smaller angle.
        let sign = 1.0_f64.copysign(turned.w);
        let about = 2.0 * (sign * turned.imag()[axis]).atan2(sign * turned.w);
        let mut spin = Vector3::zeros();
        spin[axis] = about;
        let mut angles = (turned / UnitQuaternion::from_scaled_axis(spin)).scaled_axis();
        angles[axis] = about;
        let turns = angles.iter().zip(limits).map(|(angle, limit)| Turn {
            found: Radians(angle.abs()),
            limit: *limit,
        });
        turns
            .max_by(|a, b| a.share().total_cmp(&b.share()))
            .expect("three axes")
    }
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

    /// The number of the place of this name, by its order in the rack, from 1.
    pub fn number_of(&self, place: &str) -> Option<u32> {
        let mut places = self.places.iter().zip(1..);
        let (_, number) = places.find(|(known, _)| known.name == place)?;
        Some(number)
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
        !place.admits(reference) || turn.is_some_and(|turn| turn.is_allowed())
    }
}

impl Place {
    /// True if a part may hang there.
    pub fn admits(&self, reference: &Reference) -> bool {
        self.parts.is_empty() || self.entries(reference).next().is_some()
    }

    /// True if a part may only have certain orientations there.
    pub fn limits_turn(&self, reference: &Reference) -> bool {
        let mut parts = self.entries(reference);
        parts.any(|part| part.angles_rad.is_some())
    }

    /// How far a part is turned from the nearest orientation that it may have there; 0 if it may have any. `None` if that is
    /// known of other references of the part only.
    pub fn turn(&self, reference: &Reference, camera_from_part: &RigidTransform) -> Option<Turn> {
        let oriented = |part: &&PlacedPart| part.angles_rad.is_some();
        if !self.limits_turn(reference) {
            return Some(Turn {
                found: Radians(0.0),
                limit: self.max_turn.limits()[0],
            });
        }
        let own = self.entries(reference).filter(oriented);
        let own = own.filter(|part| part.name == reference.enrolled_as);
        let turns = own.filter_map(|part| {
            let [rx, ry, rz] = part.angles_rad?;
            let allowed = UnitQuaternion::from_euler_angles(rx, ry, rz);
            let found = &camera_from_part.rotation;
            Some(self.max_turn.turn(&self.region, &allowed, found))
        });
        turns.min_by(|a, b| a.share().total_cmp(&b.share()))
    }

    fn entries(&self, reference: &Reference) -> impl Iterator<Item = &PlacedPart> {
        self.parts
            .iter()
            .filter(|part| part.name == reference.enrolled_as || part.name == reference.name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn turned(x_deg: f64, y_deg: f64, z_deg: f64) -> UnitQuaternion<f64> {
        let angles = [x_deg, y_deg, z_deg].map(f64::to_radians);
        UnitQuaternion::from_scaled_axis(Vector3::from(angles))
    }

    #[test]
    fn a_part_on_one_hook_turns_freely_and_tilts_little() {
        let region = OrientedBox {
            centre_m: [0.0; 3],
            size_m: [0.3; 3],
            angles_rad: [0.3, -0.2, 0.5],
        };
        let [rx, ry, rz] = region.angles_rad;
        let frame_from_box = UnitQuaternion::from_euler_angles(rx, ry, rz);
        let in_frame = |turn| frame_from_box * turn * frame_from_box.inverse();
        let hung = turned(20.0, 100.0, -40.0);
        let limits = [8.0, 180.0, 4.0].map(Radians::from_degrees);
        for about_deg in [-180.0, -135.0, -90.0, 0.0, 30.0, 90.0, 179.0] {
            let spun = in_frame(turned(0.0, about_deg, 0.0)) * hung;
            for (x_deg, z_deg, is_allowed, [found, limit]) in [
                (7.5, 0.0, true, [7.5, 8.0]),
                (0.0, -3.9, true, [3.9, 4.0]),
                (8.5, 1.0, false, [8.5, 8.0]),
                (1.0, 4.5, false, [4.5, 4.0]),
                (-30.0, 0.0, false, [30.0, 8.0]),
            ] {
                let found_turn = in_frame(turned(x_deg, 0.0, z_deg)) * spun;
                let turn = MaxTurn::EachAxis(limits).turn(&region, &hung, &found_turn);
                assert_eq!(
                    turn.is_allowed(),
                    is_allowed,
                    "{about_deg} {x_deg} {z_deg}: {turn:?}"
                );
                // As far as its whole turn leaves another axis as the worst.
                if turn.limit == Radians::from_degrees(limit) {
                    assert!((turn.found.degrees() - found).abs() < 1e-6, "{turn:?}");
                }
            }
            let total = MaxTurn::Total(Radians::from_degrees(20.0)).turn(&region, &hung, &spun);
            assert!((total.found.degrees() - about_deg.abs()).abs() < 1e-6);
        }
        let less = MaxTurn::EachAxis([8.0, 90.0, 4.0].map(Radians::from_degrees));
        let far = in_frame(turned(2.0, 0.0, 0.0) * turned(0.0, -120.0, 0.0)) * hung;
        let turn = less.turn(&region, &hung, &far);
        assert!(!turn.is_allowed() && (turn.found.degrees() - 120.0).abs() < 1e-6);
    }
}
