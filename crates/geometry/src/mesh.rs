//! A triangle mesh in metres, and points spread evenly over its surface.
//!
//! # Sampling
//! The triangles are laid end to end on a line, each as long as its area, and the line is sampled at equal steps, so the
//! number of points on each triangle is proportional to its area to within one. Inside a triangle the points follow the
//! R2 sequence (M. Roberts, *The Unreasonable Effectiveness of Quasirandom Sequences*, 2018), any run of which fills a
//! square evenly, mapped to the triangle as by E. Heitz (*A Low-Distortion Map Between Triangle and Square*, 2019).
//!
//! Limit: across many small triangles the points are evenly dense but not spaced like Poisson-disk samples.

use nalgebra::{Point3, Vector3};
use rand::{RngExt as _, SeedableRng as _};
use rand_pcg::Pcg64;
use thiserror::Error;

use super::cloud::{PointCloud, is_finite};
use crate::error::Advice;

/// Triangles over shared vertices, metres.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TriangleMesh {
    /// Vertex positions, metres, finite.
    pub vertices: Vec<Point3<f32>>,
    /// Three vertex indices per triangle, each below `vertices.len()`, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
}

/// Reason why vertices and triangles do not form a mesh.
#[derive(Clone, Debug, PartialEq, Eq, Error, Advice)]
#[advice = "Export the mesh again from the program that made it"]
pub enum MeshError {
    /// A triangle refers to a vertex that does not exist.
    #[error("triangle {triangle} refers to vertex {index}, but there are {num_vertices}")]
    NoSuchVertex {
        /// Index of the triangle.
        triangle: usize,
        /// The invalid vertex index.
        index: u32,
        /// The number of vertices.
        num_vertices: usize,
    },
    /// A coordinate of a vertex is NaN or infinite.
    #[error("vertex {vertex} is not finite")]
    NotFinite {
        /// Index of the vertex.
        vertex: usize,
    },
}

impl TriangleMesh {
    /// Creates a mesh; fails if an index is out of range or a vertex is not finite.
    pub fn new(vertices: Vec<Point3<f32>>, triangles: Vec<[u32; 3]>) -> Result<Self, MeshError> {
        let num_vertices = vertices.len();
        if let Some(vertex) = vertices.iter().position(|vertex| !is_finite(vertex)) {
            return Err(MeshError::NotFinite { vertex });
        }
        let mut corners = triangles
            .iter()
            .enumerate()
            .flat_map(|(i, corners)| corners.map(|index| (i, index)));
        if let Some((triangle, index)) = corners.find(|&(_, index)| index as usize >= num_vertices)
        {
            return Err(MeshError::NoSuchVertex {
                triangle,
                index,
                num_vertices,
            });
        }
        Ok(Self {
            vertices,
            triangles,
        })
    }

    /// Returns the smallest and largest coordinates of the vertices; `None` if there are none.
    pub fn bounds(&self) -> Option<(Point3<f32>, Point3<f32>)> {
        let first = *self.vertices.first()?;
        let widened =
            |(low, high): (Point3<f32>, Point3<f32>), p: &Point3<f32>| (low.inf(p), high.sup(p));
        Some(self.vertices.iter().fold((first, first), widened))
    }

    /// Returns the vertices, each moved by `place`.
    pub fn placed_vertices(&self, place: impl Fn(Point3<f64>) -> Point3<f64>) -> Vec<Point3<f64>> {
        self.vertices.iter().map(|p| place(p.cast())).collect()
    }

    /// Returns the total area of the triangles, square metres.
    pub fn area(&self) -> f64 {
        self.faces().map(|face| face.area).sum()
    }

    /// Returns the volume inside a closed mesh, cubic metres; below 0 if its triangles face inwards.
    pub fn signed_volume(&self) -> f64 {
        let middle = self.bounds().map_or_else(Point3::origin, |(low, high)| {
            nalgebra::center(&low.cast(), &high.cast())
        });
        let tetrahedron = |face: Face| {
            let height = (face.corner - middle).dot(&face.normal);
            face.area * height / 3.0
        };
        self.faces().map(tetrahedron).sum()
    }

    /// Appends another mesh; vertices are not merged.
    ///
    /// # Panics
    /// If both meshes together have more vertices than a `u32` index can address.
    pub fn append(&mut self, other: &Self) {
        let Self {
            vertices,
            triangles,
        } = other;
        let num_together = self.vertices.len() + vertices.len();
        assert!(
            u32::try_from(num_together).is_ok(),
            "more vertices than indices"
        );
        let offset = self.vertices.len() as u32;
        self.vertices.extend_from_slice(vertices);
        self.triangles.extend(
            triangles
                .iter()
                .map(|corners| corners.map(|index| index + offset)),
        );
    }

    /// Samples `num_points` points evenly over the surface, with the unit normals of their triangles (outwards if the
    /// corners run counter-clockwise seen from outside); `None` if the mesh has no area.
    ///
    /// The same mesh, number and seed give the same points on every machine.
    pub fn sample_evenly(&self, num_points: usize, seed: u64) -> Option<PointCloud> {
        let total_area = self.area();
        if !(total_area > 0.0 && total_area.is_finite()) {
            return None;
        }
        let mut rng = Pcg64::seed_from_u64(seed);
        let start: [f64; 3] = std::array::from_fn(|_| rng.random());
        let mut cloud = PointCloud {
            normals: Some(Vec::with_capacity(num_points)),
            points: Vec::with_capacity(num_points),
            ..PointCloud::default()
        };
        let mut faces = self.faces();
        let mut face = faces.next()?;
        let mut area_before = 0.0;
        for i in 0..num_points {
            let area_at_point = (i as f64 + start[0]) / num_points as f64 * total_area;
            while area_before + face.area < area_at_point {
                // Rounding may put the last point beyond the last triangle.
                let Some(next) = faces.next() else {
                    break;
                };
                area_before += face.area;
                face = next;
            }
            let along = |axis: usize| (start[axis + 1] + (i + 1) as f64 * R2[axis]).fract();
            cloud.points.push(face.point_at(along(0), along(1)).cast());
            if let Some(normals) = &mut cloud.normals {
                normals.push(face.normal.cast());
            }
        }
        Some(cloud)
    }

    /// Iterates over the triangles with an area above 0.
    fn faces(&self) -> impl Iterator<Item = Face> {
        self.triangles.iter().filter_map(|corners| {
            let corner = |i: usize| {
                self.vertices
                    .get(corners[i] as usize)
                    .map(|p| p.cast::<f64>())
            };
            Face::new(corner(0)?, corner(1)?, corner(2)?)
        })
    }
}

/// The steps of the R2 sequence: the inverse and the inverse square of the plastic number, the root of g³ = g + 1.
const R2: [f64; 2] = [0.754_877_666_246_692_8, 0.569_840_290_998_053_3];

/// A triangle with an area above 0. Double precision, because the area of a small triangle is a difference of products.
struct Face {
    corner: Point3<f64>,
    edges: [Vector3<f64>; 2],
    area: f64,
    normal: Vector3<f64>,
}

impl Face {
    fn new(a: Point3<f64>, b: Point3<f64>, c: Point3<f64>) -> Option<Self> {
        let edges = [b - a, c - a];
        let cross = edges[0].cross(&edges[1]);
        let doubled_area = cross.norm();
        (doubled_area > 0.0 && doubled_area.is_finite()).then(|| Self {
            corner: a,
            edges,
            area: doubled_area / 2.0,
            normal: cross / doubled_area,
        })
    }

    /// Maps a point of the unit square to the triangle; each half of the square fills half of the triangle (Heitz 2019).
    fn point_at(&self, u: f64, v: f64) -> Point3<f64> {
        let (s, t) = if v > u {
            (u / 2.0, v - u / 2.0)
        } else {
            (u - v / 2.0, v / 2.0)
        };
        self.corner + self.edges[0] * s + self.edges[1] * t
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;

    /// The unit square at z = 0, seen from above, as two triangles.
    fn unit_square() -> TriangleMesh {
        let corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)];
        let vertices = corners.map(|(x, y)| Point3::new(x, y, 0.0)).to_vec();
        TriangleMesh::new(vertices, vec![[0, 1, 2], [0, 2, 3]]).unwrap()
    }

    /// The unit sphere as a grid of angles.
    fn unit_sphere(num_rings: usize) -> TriangleMesh {
        let num_columns = 2 * num_rings;
        let at = |ring: usize, column: usize| {
            let (polar, turn) = (
                PI * ring as f64 / num_rings as f64,
                PI * column as f64 / num_rings as f64,
            );
            Point3::new(
                polar.sin() * turn.cos(),
                polar.sin() * turn.sin(),
                polar.cos(),
            )
            .cast::<f32>()
        };
        let mut mesh = TriangleMesh::default();
        for ring in 0..num_rings {
            for column in 0..num_columns {
                let vertices = vec![
                    at(ring, column),
                    at(ring + 1, column),
                    at(ring + 1, column + 1),
                    at(ring, column + 1),
                ];
                mesh.append(&TriangleMesh {
                    vertices,
                    triangles: vec![[0, 1, 2], [0, 2, 3]],
                });
            }
        }
        mesh
    }

    #[test]
    fn square_and_sphere_have_their_known_area_and_bounds() {
        assert!((unit_square().area() - 1.0).abs() < 1e-12);
        assert_eq!(
            unit_square().bounds(),
            Some((Point3::origin(), Point3::new(1.0, 1.0, 0.0)))
        );
        // The inscribed polyhedron's area is too small by about the square of the angle between rings.
        assert!((unit_sphere(100).area() / (4.0 * PI) - 1.0).abs() < 1e-3);
        assert_eq!(TriangleMesh::default().bounds(), None);
    }

    #[test]
    fn points_on_a_square_are_even_whatever_the_seed() {
        for seed in 0..20 {
            let cloud = unit_square().sample_evenly(2500, seed).unwrap();
            let normals = cloud.normals.unwrap();
            assert!(
                normals
                    .iter()
                    .all(|normal| (normal - Vector3::z()).norm() < 1e-6)
            );
            // 100 cells of 25 points each. Random points would give a standard deviation of 5, and 10 to 40 points per cell.
            let mut cells = [0_i32; 100];
            for p in &cloud.points {
                assert!(
                    p.z.abs() < 1e-6 && (0.0..=1.0).contains(&p.x) && (0.0..=1.0).contains(&p.y)
                );
                let (column, row) = (
                    (p.x * 10.0).min(9.0) as usize,
                    (p.y * 10.0).min(9.0) as usize,
                );
                cells[row * 10 + column] += 1;
            }
            let variance = cells.iter().map(|count| (count - 25).pow(2)).sum::<i32>() / 100;
            assert!(variance < 9, "seed {seed}: variance {variance}, {cells:?}");
        }
    }

    #[test]
    fn points_on_a_sphere_are_on_it_and_even_with_outward_normals() {
        let cloud = unit_sphere(60).sample_evenly(8000, 7).unwrap();
        let normals = cloud.normals.as_ref().unwrap();
        let mut octants = [0_i32; 8];
        for (p, normal) in cloud.points.iter().zip(normals) {
            assert!((p.coords.norm() - 1.0).abs() < 2e-3);
            assert!((normal.norm() - 1.0).abs() < 1e-6);
            assert!(normal.dot(&p.coords) > 0.99);
            octants[usize::from(p.x > 0.0)
                + 2 * usize::from(p.y > 0.0)
                + 4 * usize::from(p.z > 0.0)] += 1;
        }
        assert!(
            octants.iter().all(|count| (count - 1000).abs() < 30),
            "{octants:?}"
        );
    }

    #[test]
    fn a_seed_gives_the_same_points_again_and_another_gives_others() {
        let sample = |seed| unit_square().sample_evenly(100, seed).unwrap().points;
        assert_eq!(sample(3), sample(3));
        assert_ne!(sample(3), sample(4));
        assert_eq!(unit_square().sample_evenly(0, 3).unwrap().points, []);
    }

    #[test]
    fn triangles_without_area_get_no_points() {
        let mut mesh = unit_square();
        mesh.triangles.splice(0..0, [[0, 0, 1], [1, 1, 1]]);
        mesh.triangles.push([2, 3, 2]);
        assert_eq!(
            mesh.sample_evenly(500, 1),
            unit_square().sample_evenly(500, 1)
        );
        mesh.triangles.truncate(2);
        assert_eq!(mesh.sample_evenly(500, 1), None);
        assert_eq!(TriangleMesh::default().sample_evenly(500, 1), None);
    }

    #[test]
    fn what_is_no_mesh_is_refused() {
        let square = unit_square();
        let beyond = TriangleMesh::new(square.vertices.clone(), vec![[0, 1, 2], [0, 4, 1]]);
        assert_eq!(
            beyond,
            Err(MeshError::NoSuchVertex {
                triangle: 1,
                index: 4,
                num_vertices: 4
            })
        );
        let mut vertices = square.vertices;
        vertices[2].y = f32::NAN;
        assert_eq!(
            TriangleMesh::new(vertices, Vec::new()),
            Err(MeshError::NotFinite { vertex: 2 })
        );
    }

    #[test]
    fn an_appended_mesh_keeps_its_own_vertices() {
        let mut mesh = unit_square();
        mesh.append(&unit_square());
        assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]]);
        assert!((mesh.area() - 2.0).abs() < 1e-12);
    }
}
