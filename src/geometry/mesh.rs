//! A triangle mesh in metres.

use nalgebra::Point3;

/// Triangles over shared vertices, metres.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TriangleMesh {
    /// Vertex positions, metres, finite.
    pub vertices: Vec<Point3<f32>>,
    /// Three vertex indices per triangle, each below `vertices.len()`, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
}
