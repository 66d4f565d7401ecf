//! Finds the point under the cursor by going through all points on a click.
//!
//! Of the points within a few pixels of the cursor, only the frontmost surface counts, and of its points the one nearest to
//! the cursor is picked. A million points take about 10 ms, once per click; an index would cost memory all the time.

use glam::{Vec2, Vec3};

use super::{
    camera::{ViewCamera, ViewSize},
    scene::ViewScene,
};

/// Maximum distance from the cursor, logical pixels: about the aiming error with a mouse.
const MAX_CURSOR_DISTANCE_PX: f32 = 10.0;
/// Points up to this share of the depth behind the foremost count as the same surface.
const SURFACE_DEPTH: f32 = 0.02;

/// A picked point of the scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PickedPoint {
    /// Index of the point set in the scene.
    pub set: usize,
    /// Index of the point in its set.
    pub index: usize,
    /// Position, world, metres.
    pub position: Vec3,
}

struct PickHit {
    point: PickedPoint,
    depth: f32,
    off_cursor_sq: f32,
}

/// Returns the visible point nearest to the cursor, if one is near; `is_shown` tells which roles are drawn.
pub(super) fn pick(
    camera: &ViewCamera,
    scene: &ViewScene,
    is_shown: impl Fn(super::style::Role) -> bool,
    cursor: Vec2,
    size: ViewSize,
) -> Option<PickedPoint> {
    let clip_from_world = camera.clip_from_world(size);
    let mut candidates = Vec::new();
    for (set_index, set) in scene.points.iter().enumerate() {
        let clip_from_set = clip_from_world * set.world_from_set;
        for (index, position) in set.positions().iter().enumerate() {
            let position = Vec3::from(*position);
            let clip = clip_from_set * position.extend(1.0);
            // Also false for NaN.
            let is_before_eye = clip.w > camera.near();
            if !is_before_eye {
                continue;
            }
            let screen = (Vec2::new(clip.x, -clip.y) / clip.w + 1.0) / 2.0 * size;
            let off_cursor_sq = screen.distance_squared(cursor);
            if off_cursor_sq <= MAX_CURSOR_DISTANCE_PX * MAX_CURSOR_DISTANCE_PX
                && is_shown(set.role(index))
            {
                let position = set.world_from_set.transform_point3(position);
                let point = PickedPoint {
                    set: set_index,
                    index,
                    position,
                };
                candidates.push(PickHit {
                    point,
                    depth: clip.w,
                    off_cursor_sq,
                });
            }
        }
    }
    let front = candidates
        .iter()
        .map(|c| c.depth)
        .fold(f32::INFINITY, f32::min);
    let on_surface = candidates
        .iter()
        .filter(|c| c.depth <= front * (1.0 + SURFACE_DEPTH));
    let nearest = on_surface.min_by(|a, b| a.off_cursor_sq.total_cmp(&b.off_cursor_sq));
    nearest.map(|candidate| candidate.point)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::viewport::{scene::PointSet, style::Role};

    const SIZE: ViewSize = Vec2::new(800.0, 600.0);

    fn scene() -> ViewScene {
        // A wall at 2 m behind a part at 1.5 m, with one missing reading.
        let grid = |z: f32| {
            (-20..20)
                .flat_map(move |y| (-20..20).map(move |x| [x as f32 * 0.02, y as f32 * 0.02, z]))
        };
        let part: Vec<[f32; 3]> = grid(1.5).chain([[f32::NAN; 3]]).collect();
        ViewScene {
            points: vec![
                PointSet::new(grid(2.0).collect::<Vec<_>>(), Role::Plane0),
                PointSet::new(part, Role::Part),
            ],
            ..ViewScene::default()
        }
    }

    #[test]
    fn the_point_in_front_is_picked_at_the_cursor() {
        let camera = ViewCamera::default();
        let at = Vec3::new(0.1, -0.2, 1.5);
        let cursor = camera.screen_from_world(at, SIZE).expect("in view");
        let picked = pick(&camera, &scene(), |_| true, cursor, SIZE).expect("a point");
        assert_eq!(picked.set, 1);
        assert!(picked.position.distance(at) < 1e-4, "{picked:?}");
    }

    #[test]
    fn hidden_roles_are_looked_through_and_nothing_is_picked_beside_the_cloud() {
        let camera = ViewCamera::default();
        let picked = pick(
            &camera,
            &scene(),
            |role| role != Role::Part,
            SIZE / 2.0,
            SIZE,
        );
        assert_eq!(picked.expect("the wall").set, 0);
        assert_eq!(pick(&camera, &scene(), |_| true, Vec2::ZERO, SIZE), None);
        assert_eq!(
            pick(&camera, &ViewScene::default(), |_| true, SIZE / 2.0, SIZE),
            None
        );
    }
}
