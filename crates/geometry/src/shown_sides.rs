//! Which sides of a surface a camera can see, from every direction.
//!
//! The winding of triangles does not tell: whole solids are wound inside out, and an open sheet can be seen from both sides. So
//! orthographic depth images are drawn along directions that are even over the sphere. Each keeps the nearest and the farthest
//! depth and so serves two opposite directions. A side of a point is shown where nothing hides it in enough of them.

use nalgebra::{Point3, Vector3};

use crate::{
    mesh::TriangleMesh,
    parallel::{map_each, num_cores},
    statistics::even_directions,
    units::Metres,
};

/// Each is looked along both ways.
const NUM_AXES: usize = 48;
/// Pixels along the diagonal of the mesh.
const DIAGONAL_PIXELS: f64 = 1000.0;
/// Depth by which a surface must be nearer to hide a point: less than the thickness of sheet metal.
pub const MIN_HIDING_DEPTH: Metres = Metres(2e-4);
/// The same as a share of the mesh's diagonal, where rounding of large coordinates is more.
const MIN_HIDING_SHARE: f64 = 2e-6;
/// Slack of the test whether a pixel is in a triangle, so that no gap opens between neighbours.
const EDGE_SLACK: f64 = 1e-9;
/// Least cosine between the normal of a side and a direction that counts for it: at flatter angles a pixel spans much depth.
const MIN_FACING_COSINE: f64 = 0.4;
/// Share of the directions before a side that must show it. At an edge, a pixel may miss the surface that hides another.
const MIN_SHOWN_SHARE: f64 = 0.15;

/// Returns for each point on the surface, given with the unit normal of its triangle, whether a camera can see it from the side
/// that the normal points to, and from the other side. What is nearer by less than `min_hiding` hides nothing: [`MIN_HIDING_DEPTH`] for
/// an exact mesh.
pub fn shown_sides(
    mesh: &TriangleMesh,
    points: &[Point3<f32>],
    normals: &[Vector3<f32>],
    min_hiding: Metres,
) -> Vec<[bool; 2]> {
    let axes: Vec<Vector3<f64>> = even_directions(2 * NUM_AXES).take(NUM_AXES).collect();
    let seen = map_each(axes.len(), num_cores(), |i| {
        let range = DepthRange::along(axes[i], mesh, min_hiding);
        let of_point = |(p, n): (&Point3<f32>, &Vector3<f32>)| range.shows(&p.cast(), &n.cast());
        points.iter().zip(normals).map(of_point).collect::<Vec<_>>()
    });
    (0..points.len())
        .map(|i| {
            let before: Vec<[bool; 2]> = seen.iter().filter_map(|seen| seen[i]).collect();
            let num = [0, 1].map(|side| before.iter().filter(|shown| shown[side]).count());
            let is_enough = |num: usize| num as f64 > MIN_SHOWN_SHARE * before.len() as f64;
            match num.map(is_enough) {
                // At the bottom of a pocket.
                [false, false] if num != [0; 2] => [num[0] >= num[1], num[0] < num[1]],
                shown => shown,
            }
        })
        .collect()
}

/// The nearest and the farthest depth of a mesh along an axis.
struct DepthRange {
    axis: Vector3<f64>,
    right: Vector3<f64>,
    down: Vector3<f64>,
    /// Of the middle of pixel (0, 0).
    origin: [f64; 2],
    pixel: f64,
    width: usize,
    height: usize,
    /// Row by row; the nearest is infinite where there is no surface.
    depths: Vec<[f32; 2]>,
    min_hiding: f64,
}

impl DepthRange {
    fn along(axis: Vector3<f64>, mesh: &TriangleMesh, min_hiding: Metres) -> Self {
        let right = axis.cross(&Vector3::ith(axis.iamin(), 1.0)).normalize();
        let down = axis.cross(&right);
        let in_image = |p: &Point3<f32>| {
            let p = p.coords.cast::<f64>();
            [right.dot(&p), down.dot(&p), axis.dot(&p)]
        };
        let corners: Vec<[f64; 3]> = mesh.vertices.iter().map(in_image).collect();
        let bound = |along: usize, pick: fn(f64, f64) -> f64| {
            corners.iter().map(|p| p[along]).reduce(pick).unwrap_or(0.0)
        };
        let low = [0, 1].map(|along| bound(along, f64::min));
        let extent = [0, 1].map(|along| bound(along, f64::max) - low[along]);
        let diagonal = mesh.bounds().map_or(0.0, |(low, high)| (high - low).norm());
        let pixel = f64::from(diagonal) / DIAGONAL_PIXELS;
        let [width, height] = extent.map(|extent| (extent / pixel) as usize + 1);
        let mut range = Self {
            axis,
            right,
            down,
            // Between the corners of a mesh that lies on a grid.
            origin: low.map(|low| low + 0.37 * pixel),
            pixel,
            width,
            height,
            depths: vec![[f32::INFINITY, f32::NEG_INFINITY]; width * height],
            min_hiding: min_hiding.0.max(MIN_HIDING_SHARE * f64::from(diagonal)),
        };
        for triangle in &mesh.triangles {
            range.draw(triangle.map(|corner| corners[corner as usize]));
        }
        range
    }

    /// Draws a triangle at the middles of its pixels (J. Pineda, "A parallel algorithm for polygon rasterization", SIGGRAPH 1988).
    fn draw(&mut self, corners: [[f64; 3]; 3]) {
        let [a, b, c] = corners.map(|[x, y, z]| {
            let [u, v] = [x - self.origin[0], y - self.origin[1]].map(|along| along / self.pixel);
            [u, v, z]
        });
        let area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        if area == 0.0 || !area.is_finite() {
            return;
        }
        let pixels = |along: usize, num: usize| {
            let low = a[along].min(b[along]).min(c[along]).ceil().max(0.0);
            let high = a[along].max(b[along]).max(c[along]).floor();
            low as usize..((high + 1.0).max(0.0) as usize).min(num)
        };
        for v in pixels(1, self.height) {
            for u in pixels(0, self.width) {
                let (x, y) = (u as f64, v as f64);
                let share = |p: [f64; 3], q: [f64; 3]| {
                    ((p[0] - x) * (q[1] - y) - (p[1] - y) * (q[0] - x)) / area
                };
                let of_corners = [share(b, c), share(c, a), share(a, b)];
                if of_corners.iter().all(|share| *share >= -EDGE_SLACK) {
                    let [of_a, of_b, of_c] = of_corners;
                    let depth = (of_a * a[2] + of_b * b[2] + of_c * c[2]) as f32;
                    let [near, far] = &mut self.depths[v * self.width + u];
                    *near = near.min(depth);
                    *far = far.max(depth);
                }
            }
        }
    }

    /// Returns whether a point with this normal is shown from the side of its normal and from the other; `None` where it is seen
    /// at too flat an angle.
    fn shows(&self, p: &Point3<f64>, normal: &Vector3<f64>) -> Option<[bool; 2]> {
        let along = normal.dot(&self.axis);
        if along.abs() < MIN_FACING_COSINE {
            return None;
        }
        let at = [self.right.dot(&p.coords), self.down.dot(&p.coords)];
        let place = [0, 1].map(|i| (at[i] - self.origin[i]) / self.pixel);
        let [u, v] = [(place[0], self.width), (place[1], self.height)]
            .map(|(place, num)| place.round().clamp(0.0, num as f64 - 1.0));
        let beside = (self.right * (u - place[0]) + self.down * (v - place[1])) * self.pixel;
        // Of the point's own plane in the middle of the pixel.
        let depth = self.axis.dot(&p.coords) - normal.dot(&beside) / along;
        let [near, far] = self.depths[v as usize * self.width + u as usize].map(f64::from);
        let from_before = near >= depth - self.min_hiding;
        let from_behind = far <= depth + self.min_hiding;
        Some(if along < 0.0 {
            [from_before, from_behind]
        } else {
            [from_behind, from_before]
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A box with these sides about a point, its triangles facing outwards.
    fn cuboid(sides: [f32; 3], middle: [f32; 3]) -> TriangleMesh {
        let vertices = (0..8).map(|corner| {
            Point3::from(std::array::from_fn(|axis| {
                let half = if corner >> axis & 1 == 0 { -0.5 } else { 0.5 };
                middle[axis] + half * sides[axis]
            }))
        });
        let faces = [
            [0, 2, 3, 1],
            [4, 5, 7, 6],
            [0, 1, 5, 4],
            [2, 6, 7, 3],
            [0, 4, 6, 2],
            [1, 3, 7, 5],
        ];
        let triangles = faces
            .iter()
            .flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]);
        TriangleMesh::new(vertices.collect(), triangles.collect()).expect("a mesh")
    }

    /// Shares of the surface shown on the side of its normals, on the other, on both, and on none.
    fn shares(mesh: &TriangleMesh) -> [f64; 4] {
        let cloud = mesh.sample_evenly(4000, 1).expect("an area");
        let normals = cloud.normals.expect("normals");
        let shown = shown_sides(mesh, &cloud.points, &normals, MIN_HIDING_DEPTH);
        let share = |of: [bool; 2]| {
            let num = shown.iter().filter(|shown| **shown == of).count();
            num as f64 / shown.len() as f64
        };
        [[true, false], [false, true], [true, true], [false, false]].map(share)
    }

    fn turned(mut mesh: TriangleMesh) -> TriangleMesh {
        mesh.triangles
            .iter_mut()
            .for_each(|corners| corners.swap(1, 2));
        mesh
    }

    #[test]
    fn a_closed_sheet_is_shown_outside_however_thin_it_is_and_however_it_is_wound() {
        for thickness in [0.0005, 0.002, 0.02, 0.3] {
            let sheet = cuboid([0.9, 0.6, thickness], [0.2, -0.1, 1.5]);
            let [outside, ..] = shares(&sheet);
            assert!(outside > 0.98, "{thickness}: {outside}");
            let [_, inside, ..] = shares(&turned(sheet.clone()));
            assert!(inside > 0.98, "{thickness}: {inside}");
            let mut mixed = sheet;
            let mut of_one_winding = mixed.triangles.iter_mut().step_by(2);
            of_one_winding
                .by_ref()
                .for_each(|corners| corners.swap(1, 2));
            let [outside, inside, ..] = shares(&mixed);
            assert!(outside + inside > 0.98 && (outside - 0.5).abs() < 0.05);
        }
    }

    #[test]
    fn an_open_surface_is_shown_on_both_sides() {
        let mut sheet = cuboid([0.9, 0.6, 0.1], [0.0; 3]);
        sheet.triangles.truncate(2);
        let [.., both, _] = shares(&sheet);
        assert!(both > 0.99, "{both}");
        // A box without its lid: the inside is in sight, too.
        let mut open = cuboid([0.9, 0.6, 0.1], [0.0; 3]);
        open.triangles.drain(2..4);
        let [.., both, _] = shares(&open);
        assert!(both > 0.9, "{both}");
    }

    #[test]
    fn what_lies_inside_is_not_shown() {
        let mut mesh = cuboid([0.9, 0.6, 0.1], [0.0; 3]);
        let inner = cuboid([0.5, 0.4, 0.05], [0.0; 3]);
        let share = inner.area() / (inner.area() + mesh.area());
        mesh.append(&inner);
        let [outside, _, _, none] = shares(&mesh);
        assert!((none - share).abs() < 0.01 && (outside + share - 1.0).abs() < 0.02);
    }
}
