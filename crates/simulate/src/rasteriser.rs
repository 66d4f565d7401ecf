//! Draws triangles into a depth image, a label image and an image of the viewing angle.
//!
//! Coverage is tested by edge functions (Pineda, "A Parallel Algorithm for Polygon Rasterization", SIGGRAPH 1988) at pixel
//! centres. The reciprocal of depth is linear over the image of a plane, so each triangle's depth is exactly that of its
//! plane. Both faces of a triangle are drawn: sheet metal is seen from inside through openings.

use std::ops::Range;

use nalgebra::{Point3, Vector3};
use serde::{Deserialize, Serialize};

use geometry::mesh::TriangleMesh;
use geometry::rigid::RigidTransform;
use geometry::{depth_frame::Intrinsics, distortion::Distortion};

/// The surface that a pixel shows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SurfaceLabel {
    /// No surface: the ray leaves the cell.
    #[default]
    Background,
    /// The wall behind the part.
    Wall,
    /// The floor.
    Floor,
    /// The part, or the unknown object in its place.
    Part,
    /// The stand that holds the part.
    Stand,
    /// Anything else in the cell.
    Clutter,
    /// The part, or the unknown object, of this number on a rack, from 0 at the left.
    RackPart(u8),
}

/// Nothing nearer than this is drawn, in metres.
const NEAR_M: f64 = 0.05;
/// Slack of the edge test in pixel², so that no gaps open between neighbouring triangles.
const EDGE_SLACK: f64 = 1e-7;

/// An infinite plane in camera space: the points p with normal · p = offset.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plane {
    pub(super) normal: Vector3<f64>,
    pub(super) offset: f64,
}

impl Plane {
    /// Returns the y at this x and z of a roughly horizontal plane.
    pub(super) fn height_at(&self, x: f64, z: f64) -> f64 {
        (self.offset - self.normal.x * x - self.normal.z * z) / self.normal.y
    }
}

/// The images being drawn, row by row from the top left.
pub(super) struct Rendering {
    pub(super) intrinsics: Intrinsics,
    /// The rows in which meshes are drawn.
    pub(super) rows: Range<usize>,
    /// Depth along the optical axis in metres; infinite where nothing is drawn.
    pub(super) depth: Vec<f32>,
    /// |cosine| of the angle between the viewing ray and the surface normal, 0..1.
    pub(super) facing: Vec<f32>,
    pub(super) labels: Vec<SurfaceLabel>,
}

impl Rendering {
    /// Creates empty images of the camera without its lens distortion, so that straight edges stay straight.
    pub(super) fn new(intrinsics: Intrinsics) -> Self {
        let num_pixels = intrinsics.width * intrinsics.height;
        Self {
            intrinsics: Intrinsics {
                distortion: Distortion::NONE,
                ..intrinsics
            },
            rows: 0..intrinsics.height,
            depth: vec![f32::INFINITY; num_pixels],
            facing: vec![0.0; num_pixels],
            labels: vec![SurfaceLabel::Background; num_pixels],
        }
    }

    /// Counts the pixels that show `label`.
    pub(super) fn num_pixels(&self, label: SurfaceLabel) -> usize {
        self.labels.iter().filter(|&&l| l == label).count()
    }

    /// Draws a mesh.
    pub(super) fn draw_mesh(
        &mut self,
        mesh: &TriangleMesh,
        camera_from_mesh: &RigidTransform,
        label: SurfaceLabel,
    ) {
        let points = mesh.placed_vertices(|p| camera_from_mesh * p);
        for corners in &mesh.triangles {
            let corners = corners.map(|i| points[i as usize]);
            if corners.iter().all(|p| p.z >= NEAR_M) {
                self.draw_triangle(&corners, label);
            } else {
                let clipped = clip_near(&corners);
                for k in 1..clipped.len().saturating_sub(1) {
                    self.draw_triangle(&[clipped[0], clipped[k], clipped[k + 1]], label);
                }
            }
        }
    }

    /// Draws a plane wherever it lies in front of the camera.
    pub(super) fn draw_plane(&mut self, plane: &Plane, label: SurfaceLabel) {
        let camera = self.intrinsics;
        // Without distortion, a column's rays have one x.
        let columns = (0..camera.width).map(|u| camera.point_at(u as f64, 0.0, 1.0).x);
        let columns: Vec<f64> = columns.collect();
        for v in 0..camera.height {
            let y = camera.point_at(0.0, v as f64, 1.0).y;
            for (u, &x) in columns.iter().enumerate() {
                let ray = Vector3::new(x, y, 1.0);
                let slope = plane.normal.dot(&ray);
                let depth = plane.offset / slope;
                let pixel = v * camera.width + u;
                if depth > NEAR_M && depth < f64::from(self.depth[pixel]) {
                    self.depth[pixel] = depth as f32;
                    self.facing[pixel] = (slope / ray.norm()).abs() as f32;
                    self.labels[pixel] = label;
                }
            }
        }
    }

    /// Merges another rendering by the same camera; the nearer surface wins.
    pub(super) fn draw_behind(&mut self, other: &Self) {
        for pixel in 0..self.depth.len() {
            if other.depth[pixel] < self.depth[pixel] {
                self.depth[pixel] = other.depth[pixel];
                self.facing[pixel] = other.facing[pixel];
                self.labels[pixel] = other.labels[pixel];
            }
        }
    }

    fn draw_triangle(&mut self, corners: &[Point3<f64>; 3], label: SurfaceLabel) {
        let camera = self.intrinsics;
        let [a, b, c] = corners.map(|p| {
            (
                p.x / p.z * camera.fx + camera.cx,
                p.y / p.z * camera.fy + camera.cy,
            )
        });
        let double_area = (b.0 - a.0) * (c.1 - a.1) - (b.1 - a.1) * (c.0 - a.0);
        let normal = (corners[1] - corners[0]).cross(&(corners[2] - corners[0]));
        let offset = normal.dot(&corners[0].coords);
        if double_area.abs() < 1e-9 || offset.abs() < 1e-15 {
            return;
        }
        let low_u = a.0.min(b.0).min(c.0).ceil().max(0.0);
        let high_u = a.0.max(b.0).max(c.0).floor().min(camera.width as f64 - 1.0);
        let low_v = a.1.min(b.1).min(c.1).ceil().max(self.rows.start as f64);
        let high_v =
            a.1.max(b.1)
                .max(c.1)
                .floor()
                .min(self.rows.end as f64 - 1.0);
        if low_u > high_u || low_v > high_v {
            return;
        }
        // 1/z over the image: normal · ray(u, v) / offset.
        let inverse_u = normal.x / camera.fx / offset;
        let inverse_v = normal.y / camera.fy / offset;
        let inverse_0 = normal.z / offset - inverse_u * camera.cx - inverse_v * camera.cy;
        // Depths are clamped to those of the corners: triangles seen edge-on could exceed them within the slack.
        let nearest = corners[0].z.min(corners[1].z).min(corners[2].z);
        let farthest = corners[0].z.max(corners[1].z).max(corners[2].z);
        let sight = corners[0].coords + corners[1].coords + corners[2].coords;
        let facing = (normal.dot(&sight).abs() / (normal.norm() * sight.norm())) as f32;

        let sign = double_area.signum();
        let slack = EDGE_SLACK * double_area.abs().max(1.0);
        for v in low_v as usize..=high_v as usize {
            let y = v as f64;
            for u in low_u as usize..=high_u as usize {
                let x = u as f64;
                let e0 = sign * ((b.0 - a.0) * (y - a.1) - (b.1 - a.1) * (x - a.0));
                let e1 = sign * ((c.0 - b.0) * (y - b.1) - (c.1 - b.1) * (x - b.0));
                let e2 = sign * ((a.0 - c.0) * (y - c.1) - (a.1 - c.1) * (x - c.0));
                if e0 < -slack || e1 < -slack || e2 < -slack {
                    continue;
                }
                let depth = (1.0 / (inverse_u * x + inverse_v * y + inverse_0))
                    .clamp(nearest, farthest) as f32;
                let pixel = v * camera.width + u;
                if depth < self.depth[pixel] {
                    self.depth[pixel] = depth;
                    self.facing[pixel] = facing;
                    self.labels[pixel] = label;
                }
            }
        }
    }
}

/// Returns the part of a triangle beyond the near plane (Sutherland and Hodgman, "Reentrant Polygon Clipping", CACM 1974).
fn clip_near(corners: &[Point3<f64>; 3]) -> Vec<Point3<f64>> {
    let mut kept = Vec::with_capacity(4);
    for k in 0..3 {
        let (here, next) = (corners[k], corners[(k + 1) % 3]);
        if here.z >= NEAR_M {
            kept.push(here);
        }
        if (here.z >= NEAR_M) != (next.z >= NEAR_M) {
            kept.push(here + (next - here) * ((NEAR_M - here.z) / (next.z - here.z)));
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::object::ObjectKind;

    const SMALL: Intrinsics = Intrinsics {
        width: 64,
        height: 48,
        fx: 52.5,
        fy: 52.5,
        cx: 31.5,
        cy: 23.5,
        distortion: Distortion::NONE,
    };

    /// Moeller-Trumbore for every triangle: slow and obvious.
    fn cast(mesh: &TriangleMesh, pose: &RigidTransform, direction: &Vector3<f64>) -> f64 {
        let mut nearest = f64::INFINITY;
        for corners in &mesh.triangles {
            let [a, b, c] = corners.map(|i| pose * mesh.vertices[i as usize].cast::<f64>());
            let (e1, e2) = (b - a, c - a);
            let p = direction.cross(&e2);
            let determinant = e1.dot(&p);
            if determinant.abs() < 1e-14 {
                continue;
            }
            let s = -a.coords;
            let u = s.dot(&p) / determinant;
            let q = s.cross(&e1);
            let v = direction.dot(&q) / determinant;
            let t = e2.dot(&q) / determinant;
            if u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t > NEAR_M && t < nearest {
                nearest = t;
            }
        }
        nearest
    }

    #[test]
    fn it_agrees_with_a_ray_caster() {
        let cases = [
            (ObjectKind::Chair, [0.3, 0.5, 0.1, 0.05, -0.02, 1.1]),
            (ObjectKind::Wheel, [0.2, -0.6, 1.0, 0.0, 0.0, 0.7]),
            // Through the near plane.
            (ObjectKind::Board, [0.0, 1.2, 0.0, 0.1, 0.0, 0.2]),
        ];
        for (kind, pose) in cases {
            let mesh = kind.mesh();
            let pose = geometry::rigid::from_euler_zyx(pose);
            let mut rendering = Rendering::new(SMALL);
            rendering.draw_mesh(&mesh, &pose, SurfaceLabel::Part);
            let mut num_different = 0;
            let mut num_hit = 0;
            for v in 0..SMALL.height {
                for u in 0..SMALL.width {
                    let expected = cast(
                        &mesh,
                        &pose,
                        &SMALL.point_at(u as f64, v as f64, 1.0).coords,
                    );
                    let found = f64::from(rendering.depth[v * SMALL.width + u]);
                    num_hit += usize::from(expected.is_finite());
                    let same = if expected.is_finite() {
                        (expected - found).abs() < 1e-5 * expected
                    } else {
                        found.is_infinite()
                    };
                    num_different += usize::from(!same);
                }
            }
            assert!(num_hit > 200, "{kind:?} fills {num_hit} pixels");
            // Rounding may put a ray through an edge on either side.
            assert!(
                num_different <= 2,
                "{kind:?}: {num_different} of {num_hit} differ"
            );
        }
    }

    #[test]
    fn a_plane_has_its_own_depth_and_angle_everywhere() {
        let mut rendering = Rendering::new(SMALL);
        let plane = Plane {
            normal: Vector3::new(0.1, -0.2, 1.0).normalize(),
            offset: 2.0,
        };
        rendering.draw_plane(&plane, SurfaceLabel::Wall);
        for (u, v) in [(0, 0), (63, 0), (30, 47)] {
            let z = f64::from(rendering.depth[v * SMALL.width + u]);
            let point = SMALL.point_at(u as f64, v as f64, z);
            assert!((plane.normal.dot(&point.coords) - 2.0).abs() < 1e-6);
        }
        assert_eq!(rendering.num_pixels(SurfaceLabel::Wall), 64 * 48);
    }
}
