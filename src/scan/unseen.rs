//! How much of a scanned part's outline is only where the view of every frame ends.
//!
//! At each point of the outline a probe is held beyond it, along the surface. A frame that looks past the probe, or sees
//! another surface there, shows that the part ends. Where the probe is hidden from all frames, or outside their
//! pictures, the part may go on.

use nalgebra::{Point3, Vector3};

use super::{
    Scan,
    visibility::{Visibility, visibility_at},
};
use crate::geometry::nearest::KdTree;

/// Neighbours within this are looked at, metres: three voxels.
const REACH: f32 = 0.012;
/// A gap this wide between the directions to the neighbours is an outline, radians.
const GAP: f64 = 2.4;
/// Distances of the probe beyond the outline, metres.
const PROBES: [f64; 2] = [0.02, 0.04];
/// A surface within this of the probe is there, metres.
const TOLERANCE: f64 = 0.012;
/// Points that are looked at.
const NUM_POINTS: usize = 8000;

/// A point of a scanned part's outline, base frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OutlinePoint {
    /// Where it is, metres.
    pub point: Point3<f32>,
    /// Out of the surface, along it; a unit vector.
    pub outwards: Vector3<f32>,
    /// Along the outline; a unit vector.
    pub along: Vector3<f32>,
    /// True where no frame sees that the part ends.
    pub is_open: bool,
}

/// Share of the part's outline where no frame sees that the part ends, 0..1.
pub fn unseen_share(scan: &Scan) -> f64 {
    open_share(&outline(scan))
}

/// Share of these points where the outline is open, 0..1.
pub fn open_share(outline: &[OutlinePoint]) -> f64 {
    let num_open = outline.iter().filter(|point| point.is_open).count();
    num_open as f64 / outline.len().max(1) as f64
}

/// The part's outline, thinned to what some thousand of the part's points show of it.
pub fn outline(scan: &Scan) -> Vec<OutlinePoint> {
    let part = scan.cloud.part();
    let points = &part.cloud.points;
    let Some(normals) = &part.cloud.normals else {
        return Vec::new();
    };
    let tree = KdTree::new(points);
    let step = (points.len() / NUM_POINTS).max(1);
    let mut outline = Vec::new();
    for (point, normal) in points.iter().zip(normals).step_by(step) {
        let Some(outwards) = outwards(point, normal, points, &tree) else {
            continue;
        };
        let ends = PROBES.iter().any(|far| {
            let probe = point.cast::<f64>() + outwards * *far;
            scan.used().any(|(_, shot)| {
                let camera_from_base = shot.base_from_camera.inverse();
                let at = camera_from_base * probe;
                let seen = visibility_at(&shot.surface, &at, &Vector3::zeros(), TOLERANCE);
                matches!(
                    seen,
                    Visibility::Through | Visibility::Here(_) | Visibility::NoReading
                )
            })
        });
        outline.push(OutlinePoint {
            point: *point,
            outwards: outwards.cast(),
            along: normal.cross(&outwards.cast()),
            is_open: !ends,
        });
    }
    outline
}

/// The direction out of the surface at a point of its outline; `None` inside.
fn outwards(
    point: &Point3<f32>,
    normal: &Vector3<f32>,
    points: &[Point3<f32>],
    tree: &KdTree,
) -> Option<Vector3<f64>> {
    let normal = normal.cast::<f64>();
    let across = if normal.x.abs() < 0.9 {
        Vector3::x()
    } else {
        Vector3::y()
    };
    let right = normal.cross(&across).try_normalize(1e-9)?;
    let up = normal.cross(&right);
    let mut angles: Vec<f64> = Vec::new();
    tree.within(point, REACH, |found| {
        let to: Vector3<f64> = (points[found.index] - point).cast();
        if found.distance_sq > 1e-8 {
            angles.push(to.dot(&up).atan2(to.dot(&right)));
        }
    });
    angles.sort_by(f64::total_cmp);
    let first = *angles.first()?;
    let next = angles.iter().skip(1).copied();
    let next = next.chain([first + std::f64::consts::TAU]);
    let (start, gap) = angles
        .iter()
        .zip(next)
        .map(|(angle, next)| (*angle, next - angle))
        .max_by(|a, b| a.1.total_cmp(&b.1))?;
    let middle = start + gap / 2.0;
    (gap > GAP).then(|| right * middle.cos() + up * middle.sin())
}
