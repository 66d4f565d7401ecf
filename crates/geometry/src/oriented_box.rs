//! Boxes in any orientation.

use nalgebra::{Point3, Vector3};
use serde::{Deserialize, Serialize};

use crate::rigid::{RigidTransform, from_euler_zyx};

/// Limit for coordinates and sizes, millimetres; no cell is larger.
pub const MAX_COORDINATE_MM: f64 = 100_000.0;
/// Minimum length of a box's longest side, millimetres: a smaller one was probably given in metres.
const MIN_SIDE_MM: f64 = 10.0;

/// Which number of a file makes no box.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum BoxError {
    /// It is not finite, or out of range.
    Number {
        /// The field.
        field: &'static str,
        /// The name of the box.
        name: String,
        /// The numbers that were given.
        found: String,
    },
    /// Each side is so short that it was probably given in metres.
    Thin {
        /// The name of the box.
        name: String,
        /// The sides that were given.
        found: String,
        /// The length of the longest side, at least, millimetres.
        least: String,
    },
}

texts::described!(BoxError: "box" by "kind");

/// A box in any orientation, in some frame.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct OrientedBox {
    /// Its centre, metres.
    pub centre_m: [f64; 3],
    /// Lengths of its sides along its own x, y and z, metres.
    pub size_m: [f64; 3],
    /// Its rotation about x, y and z of the frame, radians: R = Rz·Ry·Rx.
    pub angles_rad: [f64; 3],
}

impl OrientedBox {
    /// Returns the box of these numbers of a file, `[x y z]` in millimetres and degrees. An error says which are wrong, of the
    /// box `name`.
    pub fn of_file(
        name: &str,
        centre_mm: [f64; 3],
        size_mm: [f64; 3],
        angles_deg: [f64; 3],
    ) -> Result<Self, BoxError> {
        let wrong = |field, values: [f64; 3]| {
            Err(BoxError::Number {
                field,
                name: name.to_owned(),
                found: format!("{values:?}"),
            })
        };
        if !centre_mm.iter().all(|x| x.abs() <= MAX_COORDINATE_MM) {
            return wrong("centre_mm", centre_mm);
        }
        if !(size_mm.iter()).all(|x| *x > 0.0 && *x <= MAX_COORDINATE_MM) {
            return wrong("size_mm", size_mm);
        }
        if size_mm.iter().all(|x| *x < MIN_SIDE_MM) {
            return Err(BoxError::Thin {
                name: name.to_owned(),
                found: format!("{size_mm:?}"),
                least: MIN_SIDE_MM.to_string(),
            });
        }
        if !angles_deg.iter().all(|x| x.abs() <= 360.0) {
            return wrong("angles_deg", angles_deg);
        }
        Ok(Self {
            centre_m: centre_mm.map(|x| x / 1000.0),
            size_m: size_mm.map(|x| x / 1000.0),
            angles_rad: angles_deg.map(f64::to_radians),
        })
    }

    /// True if a file could hold its numbers.
    pub fn is_sound(&self) -> bool {
        let mm = |metres: f64| 1000.0 * metres;
        let (centre, size) = (self.centre_m.map(mm), self.size_m.map(mm));
        Self::of_file("", centre, size, self.angles_rad.map(f64::to_degrees)).is_ok()
    }

    /// The transform from the frame into that of the box, whose origin is the centre.
    pub fn box_from_frame(&self) -> RigidTransform {
        let ([rx, ry, rz], [x, y, z]) = (self.angles_rad, self.centre_m);
        from_euler_zyx([rx, ry, rz, x, y, z]).inverse()
    }

    /// Half its sides, metres.
    pub fn half(&self) -> Vector3<f64> {
        Vector3::from(self.size_m) / 2.0
    }

    /// Distance of a point of the frame from the box, metres; 0 inside.
    pub fn distance(&self, point: &Point3<f64>) -> f64 {
        let at = (self.box_from_frame() * point).coords;
        let half = self.half();
        (at - at.zip_map(&half, |x, half| x.clamp(-half, half))).norm()
    }

    /// The same box in another frame.
    #[must_use]
    pub fn moved(&self, other_from_frame: &RigidTransform) -> Self {
        let moved = other_from_frame * self.box_from_frame().inverse();
        let (rx, ry, rz) = moved.rotation.euler_angles();
        Self {
            centre_m: moved.translation.vector.into(),
            size_m: self.size_m,
            angles_rad: [rx, ry, rz],
        }
    }

    /// Its corners, in the frame; two are joined by an edge if their indices differ in one bit.
    pub fn corners(&self) -> [Point3<f64>; 8] {
        let (frame_from_box, half) = (self.box_from_frame().inverse(), self.half());
        std::array::from_fn(|i| {
            let sides = [0, 1, 2].map(|axis| if (i >> axis) & 1 == 0 { -1.0 } else { 1.0 });
            frame_from_box * Point3::from(Vector3::from(sides).component_mul(&half))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn turned() -> OrientedBox {
        OrientedBox {
            centre_m: [1.0, 2.0, 3.0],
            size_m: [0.4, 0.2, 2.0],
            angles_rad: [0.3, -0.2, 0.9],
        }
    }

    #[test]
    fn a_point_is_as_far_as_it_was_moved_out_of_a_side() {
        let turned = turned();
        let frame_from_box = turned.box_from_frame().inverse();
        for (at, wanted) in [
            ([0.0, 0.0, 0.0], 0.0),
            ([0.2, 0.1, -1.0], 0.0),
            ([0.5, 0.0, 0.9], 0.3),
            ([0.5, 0.5, 0.0], 0.5),
        ] {
            let distance = turned.distance(&(frame_from_box * Point3::from(at)));
            assert!((distance - wanted).abs() < 1e-12, "{at:?}: {distance}");
        }
    }

    #[test]
    fn a_moved_box_has_moved_corners() {
        let motion = from_euler_zyx([1.0, 0.5, -2.0, 0.3, -4.0, 2.0]);
        let corners = turned().corners().map(|corner| motion * corner);
        let moved = turned().moved(&motion).corners();
        for (moved, wanted) in moved.iter().zip(&corners) {
            assert!((moved - wanted).norm() < 1e-12, "{moved} {wanted}");
        }
    }
}
