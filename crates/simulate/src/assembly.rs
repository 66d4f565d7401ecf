//! A mesh under construction, in f64, with the few whole-mesh operations that parts need.

use nalgebra::{Point3, Vector3};

use geometry::mesh::TriangleMesh;

/// Vertices and triangles so far. Winding is counter-clockwise seen from outside.
#[derive(Default)]
pub(super) struct Assembly {
    vertices: Vec<Point3<f64>>,
    triangles: Vec<[u32; 3]>,
}

impl Assembly {
    /// Adds a vertex and returns its index.
    pub(super) fn vertex(&mut self, point: Point3<f64>) -> u32 {
        self.vertices.push(point);
        self.vertices.len() as u32 - 1
    }

    /// Adds a triangle, unless it has no area.
    pub(super) fn triangle(&mut self, corners: [u32; 3]) {
        let [a, b, c] = corners.map(|i| self.vertices[i as usize]);
        if (b - a).cross(&(c - a)).norm_squared() > 1e-20 {
            self.triangles.push(corners);
        }
    }

    /// Adds a face of four corners, given in order around it.
    pub(super) fn quad(&mut self, [a, b, c, d]: [u32; 4]) {
        self.triangle([a, b, c]);
        self.triangle([a, c, d]);
    }

    /// Like [`Assembly::quad`], split along the diagonal that passes nearer to `middle`, a point of the surface: creases that
    /// run across a grid stay smooth that way.
    pub(super) fn quad_through(&mut self, corners: [u32; 4], middle: &Point3<f64>) {
        let [a, b, c, d] = corners.map(|i| self.vertices[i as usize]);
        let first = (nalgebra::center(&a, &c) - middle).norm_squared();
        let second = (nalgebra::center(&b, &d) - middle).norm_squared();
        let [a, b, c, d] = corners;
        if first <= second {
            self.quad([a, b, c, d]);
        } else {
            self.quad([b, c, d, a]);
        }
    }

    /// Adds a finished mesh, every vertex transformed by `place`.
    pub(super) fn add(&mut self, mesh: &TriangleMesh, place: impl Fn(Point3<f64>) -> Point3<f64>) {
        let first = self.vertices.len() as u32;
        self.vertices.extend(mesh.placed_vertices(place));
        self.triangles.extend(
            mesh.triangles
                .iter()
                .map(|corners| corners.map(|i| first + i)),
        );
    }

    /// Moves the mesh by `shift`.
    pub(super) fn moved(mut self, shift: Vector3<f64>) -> Self {
        for vertex in &mut self.vertices {
            *vertex += shift;
        }
        self
    }

    /// Returns the mesh with the centre of its bounding box at the origin.
    pub(super) fn centred(self) -> TriangleMesh {
        let middle = middle_of_box(&self.vertices);
        self.moved(-middle.coords).into_mesh()
    }

    /// Returns the mesh in place, without vertices that no triangle uses.
    pub(super) fn into_mesh(self) -> TriangleMesh {
        let mut new_index = vec![None; self.vertices.len()];
        let mut vertices = Vec::with_capacity(self.vertices.len());
        let triangles = self
            .triangles
            .iter()
            .map(|corners| {
                corners.map(|old| {
                    *new_index[old as usize].get_or_insert_with(|| {
                        vertices.push(self.vertices[old as usize].cast::<f32>());
                        vertices.len() as u32 - 1
                    })
                })
            })
            .collect();
        TriangleMesh {
            vertices,
            triangles,
        }
    }
}

/// Returns the smallest and largest coordinates of points.
pub(super) fn bounds(points: &[Point3<f64>]) -> Option<(Point3<f64>, Point3<f64>)> {
    let first = *points.first()?;
    let widened =
        |(low, high): (Point3<f64>, Point3<f64>), p: &Point3<f64>| (low.inf(p), high.sup(p));
    Some(points.iter().fold((first, first), widened))
}

/// Returns the centre of the bounding box of points; the origin if there are none.
pub(super) fn middle_of_box(points: &[Point3<f64>]) -> Point3<f64> {
    bounds(points).map_or_else(Point3::origin, |(low, high)| nalgebra::center(&low, &high))
}

/// Mirrors a mesh about x = 0, and reverses the winding so that outside stays outside.
pub(super) fn mirrored(mesh: &TriangleMesh) -> TriangleMesh {
    TriangleMesh {
        vertices: mesh
            .vertices
            .iter()
            .map(|p| Point3::new(-p.x, p.y, p.z))
            .collect(),
        triangles: mesh.triangles.iter().map(|&[a, b, c]| [a, c, b]).collect(),
    }
}
