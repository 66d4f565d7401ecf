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
            let off = f64::from(surface.points()[i].z) - at.z;
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

/// Pixels to each side that [`looks_past`] examines at least and at most.
const ASIDE: [i64; 2] = [2, 14];
/// One in this many of those pixels may have no reading.
const MISSING: i64 = 20;

/// Returns whether a camera looks past a place: everything that it sees within `aside` metres of it lies at least `beyond`
/// metres behind it.
pub(super) fn looks_past(surface: &ShotSurface, at: &Point3<f64>, aside: f64, beyond: f64) -> bool {
    let Some((column, row)) = surface.pixel(at) else {
        return false;
    };
    let is_behind = |i: usize| f64::from(surface.points()[i].z) - at.z > beyond;
    // The middle decides nearly always, with one look-up.
    if !surface.reading(column, row).is_some_and(is_behind) {
        return false;
    }
    let reach = (surface.camera.fx * aside / at.z).ceil() as i64;
    let reach = reach.clamp(ASIDE[0], ASIDE[1]);
    let mut num_missing = 0;
    for v in row - reach..=row + reach {
        for u in column - reach..=column + reach {
            match surface.reading(u, v) {
                Some(i) if !is_behind(i) => return false,
                Some(_) => {}
                None => num_missing += 1,
            }
        }
    }
    num_missing * MISSING <= (2 * reach + 1).pow(2)
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::scene::scene_from_frame;
    use geometry::depth_frame::{DepthFrame, Intrinsics};

    #[test]
    fn a_camera_looks_past_a_place_if_all_around_it_lies_behind() {
        let camera = Intrinsics::KINECT;
        // A post 1 m away before a wall 2 m away, with a shadow without readings on its left.
        let depth = (0..camera.width * camera.height).map(|i| match i % camera.width {
            280..300 => 0,
            300..330 => 1000,
            _ => 2000,
        });
        let frame = DepthFrame {
            intrinsics: camera,
            metres_per_unit: 0.001,
            depth: depth.collect(),
            is_simulated: true,
        };
        let surface =
            ShotSurface::from_scene(&Arc::new(scene_from_frame(&frame))).expect("a picture");
        let past = |column: f64, z: f64| {
            looks_past(&surface, &camera.point_at(column, 240.0, z), 0.015, 0.06)
        };
        // 15 mm at 1 m are 8 pixels.
        assert!(past(400.0, 1.0) && past(340.0, 1.0));
        assert!(!past(335.0, 1.0), "the post is near");
        assert!(!past(315.0, 1.0), "the post is there");
        assert!(!past(290.0, 1.0) && !past(275.0, 1.0), "no readings");
        assert!(!past(400.0, 1.97), "the wall is there");
        assert!(!past(2.0, 1.0), "the picture ends");
    }
}
