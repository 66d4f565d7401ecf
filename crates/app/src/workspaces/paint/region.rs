//! Converts what is drawn over the view into regions and corrections of the path.

use glam::{DVec2, DVec4, Mat4, Vec2};
use nalgebra::Point3;

use robot::paint::{KeepOut, PaintSurface};
use ui::viewport::{DrawnShape, seen_at, vec3};

/// What a left drag in the view does.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PaintTool {
    /// Turns the view.
    #[default]
    Look,
    /// Draws around a region.
    Outline(DrawnShape, RegionUse),
    /// Adds what it passes over to the keep-outs.
    Brush,
    /// Corrects the path, beginning at a point of it.
    Edit(EditKind),
}

/// What dragging a point of the path moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EditKind {
    /// The whole stroke.
    Stroke,
    /// The point, and to a lesser degree its neighbours.
    Point,
    /// The direction of the gun about the point that it aims at.
    Turn,
}

/// Use of a region that is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RegionUse {
    /// It gets no paint.
    KeepOut,
    /// Only such regions get paint.
    PaintOnly,
}

/// Radius of the brush, metres.
pub(super) const BRUSH: f64 = 0.03;

/// Where points of a surface are seen, as fractions of the view's width and height from the top left.
struct Seen<'a> {
    surface: &'a PaintSurface,
    at: Vec<Option<Vec2>>,
}

impl<'a> Seen<'a> {
    fn new(surface: &'a PaintSurface, clip_from_part: &Mat4) -> Self {
        let points = surface.points.iter();
        let at = points.map(|point| seen_at(clip_from_part, vec3(point)));
        Self {
            surface,
            at: at.collect(),
        }
    }

    /// The point seen nearest to a place, and its distance in the view, in the same fractions.
    fn nearest(&self, place: Vec2) -> Option<(Point3<f64>, f32)> {
        let each = self.at.iter().zip(&self.surface.points);
        let each = each.filter_map(|(at, p)| Some((*p, (*at)?.distance(place))));
        each.min_by(|a, b| a.1.total_cmp(&b.1))
    }
}

/// Unprojects `place` to the depth of `depth_of`; part frame.
pub(super) fn at_depth_of(
    depth_of: &Point3<f64>,
    place: Vec2,
    clip_from_part: &Mat4,
) -> Point3<f64> {
    let clip_from_part = clip_from_part.as_dmat4();
    let clip = clip_from_part * DVec4::new(depth_of.x, depth_of.y, depth_of.z, 1.0);
    let flat = place.as_dvec2() * DVec2::new(2.0, -2.0) + DVec2::new(-1.0, 1.0);
    let there = clip_from_part.inverse() * (flat * clip.w).extend(clip.z).extend(clip.w);
    let there = there / there.w;
    Point3::new(there.x, there.y, there.z)
}

/// The corners of an outline in the part frame, each at the depth of the surface point seen nearest to it.
pub(super) fn corners_of(
    outline: &[Vec2],
    surface: &PaintSurface,
    clip_from_part: &Mat4,
) -> Vec<Point3<f64>> {
    let seen = Seen::new(surface, clip_from_part);
    let corners = outline.iter().filter_map(|place| {
        let (near, _) = seen.nearest(*place)?;
        Some(at_depth_of(&near, *place, clip_from_part))
    });
    corners.collect()
}

/// Returns spheres along a brush stroke over the surface; nothing where the brush is beside the part.
pub(super) fn brushed(
    trail: &[Vec2],
    surface: &PaintSurface,
    clip_from_part: &Mat4,
) -> Vec<KeepOut> {
    /// Distance to the nearest point from which the brush is beside the part, fraction of the view.
    const BESIDE: f32 = 0.02;
    /// Largest distance between places along the trail, fraction of the view.
    const STEP: f32 = 0.005;
    let seen = Seen::new(surface, clip_from_part);
    let mut middles: Vec<Point3<f64>> = Vec::new();
    // Interpolate: a quick drag is sampled at only a few places.
    let between = trail.windows(2).flat_map(|ends| {
        let num = (ends[0].distance(ends[1]) / STEP).ceil().max(1.0) as usize;
        (1..=num).map(move |i| ends[0].lerp(ends[1], i as f32 / num as f32))
    });
    for place in trail.iter().take(1).copied().chain(between) {
        let Some((at, off)) = seen.nearest(place) else {
            continue;
        };
        let is_new = middles
            .last()
            .is_none_or(|last| (at - last).norm() > BRUSH / 2.0);
        if off < BESIDE && is_new {
            middles.push(at);
        }
    }
    let spheres = middles.into_iter().map(|centre| KeepOut::Sphere {
        centre,
        radius: BRUSH,
    });
    spheres.collect()
}

#[cfg(test)]
mod tests {
    use glam::Vec3;
    use nalgebra::Vector3;

    use super::*;
    use stages::reference::Coverage;
    use ui::viewport::ViewCamera;

    /// A plate of 1 m by 0.6 m that faces the camera, 2 m away.
    fn plate() -> PaintSurface {
        let grid = (0..61).flat_map(|row| (0..101).map(move |column| (column, row)));
        let points: Vec<Point3<f64>> = grid
            .map(|(x, y)| Point3::new(f64::from(x) / 100.0 - 0.5, f64::from(y) / 100.0 - 0.3, 2.0))
            .collect();
        let normals = vec![-Vector3::z(); points.len()];
        PaintSurface::new(&points, &normals, Coverage::OneSide, None).expect("a surface")
    }

    const SIZE: Vec2 = Vec2::new(800.0, 600.0);

    fn seen(camera: &ViewCamera, at: [f32; 3]) -> Vec2 {
        let at = camera.screen_from_world(Vec3::from(at), SIZE);
        at.expect("in view") / SIZE
    }

    #[test]
    fn corners_lie_on_the_surface_where_they_are_drawn_and_level_with_it_beside() {
        let (surface, camera) = (plate(), ViewCamera::default());
        let drawn = [[-0.2, -0.1, 2.0], [0.7, 0.0, 2.0], [0.1, 0.2, 2.0]];
        let outline = drawn.map(|at| seen(&camera, at));
        let corners = corners_of(&outline, &surface, &camera.clip_from_world(SIZE));
        for (corner, drawn) in corners.iter().zip(drawn) {
            let drawn = Point3::from(drawn.map(f64::from));
            assert!((corner - drawn).norm() < 2e-3, "{corner} {drawn}");
        }
    }

    #[test]
    fn a_brush_leaves_spheres_on_the_part_alone() {
        let (surface, camera) = (plate(), ViewCamera::default());
        let trail: Vec<Vec2> = (0..=100)
            .map(|i| seen(&camera, [-0.9 + 0.018 * i as f32, 0.1, 2.0]))
            .collect();
        let spheres = brushed(&trail, &surface, &camera.clip_from_world(SIZE));
        assert!(spheres.len() > 40, "{}", spheres.len());
        for sphere in spheres {
            let KeepOut::Sphere { centre, radius } = sphere else {
                panic!("a sphere");
            };
            assert!((radius - BRUSH).abs() < 1e-12);
            assert!(
                centre.x.abs() <= 0.5 && (centre.y - 0.1).abs() < 0.011,
                "{centre}"
            );
        }
    }
}
