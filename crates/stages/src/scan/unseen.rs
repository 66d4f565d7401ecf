//! Share of a scanned part's outline where the part may go on outside every frame's view.
//!
//! At each point of the outline, probes are placed beyond it along the surface. A frame that looks past a probe, or sees
//! another surface there, shows that the part ends. Where the probes are hidden from all frames, or outside their
//! pictures, the part may go on.

use nalgebra::{Point3, Vector3};

use super::{
    Scan,
    visibility::{Visibility, visibility_at},
};
use geometry::nearest::KdTree;

/// Radius within which neighbours are looked at, in metres: three voxels.
const REACH_M: f32 = 0.012;
/// A gap at least this wide between the directions to the neighbours marks the outline, in radians.
const GAP_RAD: f64 = 2.4;
/// Distances of the probes beyond the outline, in metres.
const PROBES_M: [f64; 2] = [0.02, 0.04];
/// A surface within this distance of the probe counts as there, in metres.
const TOLERANCE_M: f64 = 0.012;
/// Approximate number of the part's points that are examined.
const NUM_POINTS: usize = 8000;

/// A point of a scanned part's outline, in the base frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OutlinePoint {
    /// Position in metres.
    pub point: Point3<f32>,
    /// Unit vector along the surface, away from the part.
    pub outwards: Vector3<f32>,
    /// Unit vector along the outline.
    pub along: Vector3<f32>,
    /// True if no frame shows that the part ends here.
    pub is_open: bool,
}

/// Returns the share of the part's outline where no frame shows that the part ends, 0..1.
pub fn unseen_share(scan: &Scan) -> f64 {
    open_share(&outline(scan))
}

/// Returns the share of these points where the outline is open, 0..1.
pub fn open_share(outline: &[OutlinePoint]) -> f64 {
    let num_open = outline.iter().filter(|point| point.is_open).count();
    num_open as f64 / outline.len().max(1) as f64
}

/// Returns points of the part's outline, found among several thousand of its points.
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
        let ends = PROBES_M.iter().any(|far| {
            let probe = point.cast::<f64>() + outwards * *far;
            scan.used().any(|(_, shot)| {
                let camera_from_base = shot.base_from_camera.inverse();
                let at = camera_from_base * probe;
                let seen = visibility_at(&shot.surface, &at, &Vector3::zeros(), TOLERANCE_M);
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

/// Returns the direction away from the part, along the surface, at a point of its outline; `None` inside the part.
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
    tree.within(point, REACH_M, |found| {
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
    (gap > GAP_RAD).then(|| right * middle.cos() + up * middle.sin())
}
