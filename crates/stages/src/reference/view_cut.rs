//! The planes at which the field of view of the capture cuts off a reference.
//!
//! A door is larger than what a camera on a robot's flange sees of it. The border of such a reference is only partly
//! the part's own; elsewhere the part continues, and points beyond it are no counter-evidence. The borders of a field
//! of view are straight, so each is a plane through the camera, which is the origin of part space.
//!
//! Known limits: a border caused by a nearer object is taken for the part's own.

use nalgebra::Point3;

use crate::{scene::SceneCloud, segment::SegmentedPart};

/// Tangents x / z and y / z of the planes that cut off the part; `None` on a side where the part itself ends.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct ViewCut {
    /// Towards negative x.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub left: Option<f64>,
    /// Towards positive x.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub right: Option<f64>,
    /// Towards negative y.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub top: Option<f64>,
    /// Towards positive y.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bottom: Option<f64>,
}

/// Distance to the border of the view up to which a part is cut off by it, pixels.
const AT_EDGE: u32 = 6;
/// Shortest stretch of the border that counts as a cut, as a share of the part's rows or columns.
const LEAST_STRETCH: f64 = 0.04;
/// Minimum number of rows or columns of such a stretch.
const LEAST_LINES: usize = 6;

impl ViewCut {
    /// Finds the cuts of a part in a captured scene; none if the scene is not organised.
    pub fn of(part: &SegmentedPart, scene: &SceneCloud) -> Self {
        let (Some(camera), Some(grid)) = (scene.intrinsics, scene.cloud.grid) else {
            return Self::default();
        };
        let Some(view) = scene.field_of_view() else {
            return Self::default();
        };
        let mut rows: Vec<Option<[usize; 2]>> = vec![None; grid.height];
        let mut columns: Vec<Option<[usize; 2]>> = vec![None; grid.width];
        for &i in &part.indices {
            let (u, v) = (i as usize % grid.width, i as usize / grid.width);
            widen(&mut rows[v], u);
            widen(&mut columns[u], v);
        }
        let side = |lines: &[Option<[usize; 2]>], end: usize, is_row: bool| {
            let ends = lines.iter().enumerate().filter_map(|(line, extent)| {
                let at = (*extent)?[end];
                let of_line = if is_row {
                    view.row_ends(line)
                } else {
                    view.column_ends(line)
                };
                (of_line?[end].abs_diff(at as u32) <= AT_EDGE).then_some(at)
            });
            let mut ends: Vec<usize> = ends.collect();
            let num_lines = lines.iter().flatten().count() as f64;
            if ends.len() < LEAST_LINES.max((LEAST_STRETCH * num_lines) as usize) {
                return None;
            }
            let middle = ends.len() / 2;
            let (_, median, _) = ends.select_nth_unstable(middle);
            let (centre, focal) = if is_row {
                (camera.cx, camera.fx)
            } else {
                (camera.cy, camera.fy)
            };
            Some(((*median as f64 - centre) / focal * 1e5).round() / 1e5)
        };
        Self {
            left: side(&rows, 0, true),
            right: side(&rows, 1, true),
            top: side(&columns, 0, false),
            bottom: side(&columns, 1, false),
        }
    }

    /// Returns true if nothing was cut off.
    pub fn is_nothing(&self) -> bool {
        *self == Self::default()
    }

    /// Returns the distance of a point in part space to the planes, metres; below 0 beyond one of them, infinite
    /// without cuts.
    pub fn depth_inside(&self, p: &Point3<f64>) -> f64 {
        let Self {
            left,
            right,
            top,
            bottom,
        } = self;
        let sides = [
            left.map(|t| p.x - t * p.z),
            right.map(|t| t * p.z - p.x),
            top.map(|t| p.y - t * p.z),
            bottom.map(|t| t * p.z - p.y),
        ];
        sides.into_iter().flatten().fold(f64::INFINITY, f64::min)
    }
}

fn widen(extent: &mut Option<[usize; 2]>, at: usize) {
    let [first, last] = extent.unwrap_or([at, at]);
    *extent = Some([first.min(at), last.max(at)]);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        fixtures::scene_of,
        segment::{SegmentParams, segment},
    };
    use geometry::rigid::RigidTransform;
    use simulate::{CellSetup, PartKind, PartPose, Side};

    /// A front door, moved to the right and down.
    fn door_at(right: f64, down: f64) -> (ViewCut, SegmentedPart) {
        let mut setup = CellSetup::with_part(PartKind::FrontDoor, Side::Left, 0, 3);
        setup.pose = PartPose::Fixed(RigidTransform::translation(right, down, 1.3));
        let scene = scene_of(&setup);
        let part = segment(&scene, &SegmentParams::default()).part;
        let part = part.expect("a part");
        (ViewCut::of(&part, &scene), part)
    }

    #[test]
    fn a_part_within_the_view_is_not_cut() {
        let (cut, part) = door_at(0.0, 0.0);
        assert!(cut.is_nothing(), "{cut:?}");
        let first: Point3<f64> = part.cloud.points[0].cast();
        assert!(cut.depth_inside(&first) > 1e6);
    }

    #[test]
    fn a_part_that_leaves_the_view_is_cut_on_that_side_alone() {
        let (cut, part) = door_at(0.5, 0.0);
        assert!(
            cut.right.is_some() && cut.left.is_none() && cut.top.is_none() && cut.bottom.is_none(),
            "{cut:?}"
        );
        let depths = part
            .cloud
            .points
            .iter()
            .map(|p| cut.depth_inside(&p.cast()));
        let least = depths.fold(f64::INFINITY, f64::min);
        // A pixel is about 2.5 mm there.
        assert!(least > -0.03 && least < 0.005, "{least}");
        assert!(cut.depth_inside(&Point3::new(2.0, 0.0, 1.3)) < -0.5);
    }
}
