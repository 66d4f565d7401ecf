//! Turns the polygons of a file into a mesh that keeps the guarantees of [`TriangleMesh`].

use nalgebra::Point3;

use super::error::FileError;
use super::readings::MAX_COORDINATE;
use super::scalar::parse_real;
use super::source::Source;
use geometry::mesh::TriangleMesh;

/// Builds a mesh; refuses an empty one, and bad vertices or indices.
pub(super) fn checked_mesh(
    source: Source<'_>,
    vertices: Vec<Point3<f32>>,
    triangles: Vec<[u32; 3]>,
) -> Result<TriangleMesh, FileError> {
    if triangles.is_empty() {
        return Err(FileError::NoTriangles {
            path: source.path.to_owned(),
        });
    }
    let is_far = |vertex: &&Point3<f32>| vertex.iter().any(|c| c.abs() > MAX_COORDINATE);
    if let Some(far) = vertices.iter().find(is_far) {
        return Err(source.damaged(format!("a vertex at {:e}, {:e}, {:e}", far.x, far.y, far.z)));
    }
    TriangleMesh::new(vertices, triangles).map_err(|error| source.damaged(error.to_string()))
}

/// Splits a polygon into a fan of triangles about its first corner. Fewer than three corners yield none.
pub(super) fn push_fan(polygon: &[u32], triangles: &mut Vec<[u32; 3]>) {
    if let Some((&first, others)) = polygon.split_first() {
        let pairs = others.windows(2).filter_map(<[u32]>::first_chunk::<2>);
        triangles.extend(pairs.map(|&[second, third]| [first, second, third]));
    }
}

/// Reads three coordinates; `None` if one is missing or no number.
pub(super) fn point_of<'a>(mut words: impl Iterator<Item = &'a str>) -> Option<Point3<f32>> {
    let mut coordinate = || words.next().and_then(parse_real).map(|real| real as f32);
    Some(Point3::new(coordinate()?, coordinate()?, coordinate()?))
}
