//! Surface that should be seen and is not there: the camera looks through it at something behind.

use nalgebra::{Point3, Vector3};

use super::{
    DeviationRegion, RegionKind, StandingPart, readings::MIN_FACING_COSINE, surface::Surface,
};
use geometry::{cloud::is_finite, depth_frame::Intrinsics, rigid::RigidTransform, units::Metres};

/// How far behind the surface a reading must lie, metres, beyond the noise.
const BEHIND_M: f64 = 0.02;
/// The same in standard deviations of the noise.
const BEHIND_DEVIATIONS: f64 = 4.0;
/// Pixels on each side of the expected one that are looked at.
const REACH_PIXELS: i64 = 1;
/// Share of these pixels, in all frames, that must have readings: none may be a matter of gloss.
const MIN_READINGS_SHARE: f64 = 0.5;
/// Share of the readings that must lie behind.
const MIN_BEHIND_SHARE: f64 = 0.9;
/// The smallest hole that is reported, square metres: 2 cm by 2 cm, some pixels wide.
const MIN_AREA_M2: f64 = 4e-4;

/// Returns the regions of the surface, without its margin, through which the camera looks.
pub(super) fn missing(
    surface: &Surface<'_>,
    part: &StandingPart<'_>,
    camera: &Intrinsics,
    part_from_camera: &RigidTransform,
) -> Vec<DeviationRegion> {
    let camera_from_part = part_from_camera.inverse();
    let is_missing: Vec<bool> = (0..surface.points.len())
        .map(|node| {
            let at = camera_from_part * surface.points[node].cast::<f64>();
            let normal = camera_from_part * surface.normals[node].cast::<f64>();
            !surface.is_margin[node] && is_looked_through(part, camera, &at, &normal)
        })
        .collect();
    let mut is_taken = vec![false; is_missing.len()];
    let mut found = Vec::new();
    for (node, is_missing_here) in is_missing.iter().enumerate() {
        if !is_missing_here || is_taken[node] {
            continue;
        }
        let nodes = surface.connected(node, |near| is_missing[near]);
        for node in &nodes {
            is_taken[*node] = true;
        }
        let area_m2 = nodes.len() as f64 * surface.node_area;
        if area_m2 >= MIN_AREA_M2 {
            let noise = part.noise_at(&(camera_from_part * surface.middle(&nodes)));
            found.push(DeviationRegion {
                kind: RegionKind::Missing,
                area_m2,
                off: None,
                centre: surface.middle(&nodes),
                limit: Metres(BEHIND_M + BEHIND_DEVIATIONS * noise),
                noise: Metres(noise),
                points: nodes.iter().map(|node| surface.points[*node]).collect(),
            });
        }
    }
    found
}

/// True if the camera looks through the place of a node, camera space.
fn is_looked_through(
    part: &StandingPart<'_>,
    camera: &Intrinsics,
    at: &Point3<f64>,
    normal: &Vector3<f64>,
) -> bool {
    if -normal.dot(&at.coords.normalize()) < MIN_FACING_COSINE {
        return false;
    }
    let Some((u, v)) = camera.pixel_of(at) else {
        return false;
    };
    let (u, v) = ((u + 0.5).floor() as i64, (v + 0.5).floor() as i64);
    let behind = at.z + BEHIND_M + BEHIND_DEVIATIONS * part.noise_at(at);
    let (mut num_pixels, mut num_readings, mut num_behind) = (0.0, 0.0, 0.0);
    for frame in part.frames {
        for row in v - REACH_PIXELS..=v + REACH_PIXELS {
            for column in u - REACH_PIXELS..=u + REACH_PIXELS {
                if row < 0 || column < 0 {
                    return false;
                }
                if column >= camera.width as i64 || row >= camera.height as i64 {
                    return false;
                }
                num_pixels += 1.0;
                let reading = &frame.cloud.points[row as usize * camera.width + column as usize];
                if is_finite(reading) {
                    num_readings += 1.0;
                    num_behind += f64::from(u8::from(f64::from(reading.z) > behind));
                }
            }
        }
    }
    num_readings >= MIN_READINGS_SHARE * num_pixels && num_behind >= MIN_BEHIND_SHARE * num_readings
}
