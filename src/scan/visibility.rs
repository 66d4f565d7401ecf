//! What a shot's camera sees at a place: the surface, something behind it, something in front of it, or nothing.

use nalgebra::{Point3, Vector3};

use super::surface::{ShotSurface, Use};

/// What a camera sees at a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Visibility {
    /// The surface is there; the index of the reading.
    Here(usize),
    /// The camera looks through the place to something behind it.
    Through,
    /// Something nearer hides the place.
    Hidden,
    /// The place is in the picture, but has no reading.
    NoReading,
    /// The place is outside the picture or the field of view.
    Outside,
}

/// Pixels around the expected one that may show the surface: poses are not exact, and edges are ragged.
const REACH: i64 = 1;

/// Looks for a surface at a camera point with this normal (in camera space; zero if unknown), within `tolerance` metres
/// along the normal.
///
/// Returns `Through` only if most pixels around look through: beside an edge the next pixel may show the background.
pub fn visibility_at(
    surface: &ShotSurface,
    at: &Point3<f64>,
    normal: &Vector3<f64>,
    tolerance: f64,
) -> Visibility {
    let Some((column, row)) = surface.pixel(at) else {
        return Visibility::Outside;
    };
    let seen = surface.field_of_view.as_ref();
    if seen.is_some_and(|seen| !seen.contains(column, row)) {
        return Visibility::Outside;
    }
    // The distance along the ray to a tilted surface is larger than the distance along its normal.
    let facing = -normal.dot(&at.coords) / at.coords.norm();
    let along_ray = tolerance
        / if *normal == Vector3::zeros() {
            1.0
        } else {
            facing.max(0.3)
        };
    let (mut best, mut num_through, mut num_nearer) = (None::<(f64, usize)>, 0, 0);
    for dv in -REACH..=REACH {
        for du in -REACH..=REACH {
            let Some(i) = surface.reading(column + du, row + dv) else {
                continue;
            };
            let off = f64::from(surface.points[i].z) - at.z;
            if off > along_ray {
                num_through += 1;
            } else if off < -along_ray {
                num_nearer += 1;
            } else {
                // Prefer the expected pixel, then the nearest in depth.
                let cost = if du == 0 && dv == 0 {
                    0.0
                } else {
                    1.0 + off.abs()
                };
                let usable = surface.uses[i] != Use::None;
                if usable && best.is_none_or(|(least, _)| cost < least) {
                    best = Some((cost, i));
                }
            }
        }
    }
    match best {
        Some((_, i)) => Visibility::Here(i),
        None if num_nearer > 0 => Visibility::Hidden,
        None if num_through >= LEAST_THROUGH => Visibility::Through,
        None => Visibility::NoReading,
    }
}

/// Fewer readings than this behind a place mean an edge or a hole in the readings.
const LEAST_THROUGH: usize = 6;
