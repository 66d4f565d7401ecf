//! Turns the polygons of a file into a mesh that keeps the guarantees of [`TriangleMesh`].

use earcut::Earcut;
use nalgebra::{Point3, Vector3};

use super::error::FileError;
use super::readings::MAX_COORDINATE_M;
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
    let is_far = |vertex: &&Point3<f32>| vertex.iter().any(|c| c.abs() > MAX_COORDINATE_M);
    if let Some(far) = vertices.iter().find(is_far) {
        return Err(source.damaged(format!("a vertex at {:e}, {:e}, {:e}", far.x, far.y, far.z)));
    }
    TriangleMesh::new(vertices, triangles).map_err(|error| source.damaged(error.to_string()))
}

/// Corners of a polygon at most: a polygon that crosses itself takes a time that grows with their square.
const MAX_CORNERS: usize = 4096;

/// Splits polygons into triangles that cover them, concave ones too, whichever corner comes first (the library `earcut`).
#[derive(Default)]
pub(super) struct Triangulation {
    earcut: Earcut<f64>,
    corners: Vec<u32>,
}

impl Triangulation {
    /// Adds the triangles of a polygon, with its winding; none for fewer than three corners.
    pub(super) fn push(
        &mut self,
        source: Source<'_>,
        polygon: &[u32],
        vertices: &[Point3<f32>],
        triangles: &mut Vec<[u32; 3]>,
    ) -> Result<(), FileError> {
        let at = |index: &u32| Some(vertices.get(*index as usize)?.cast::<f64>());
        let corners: Option<Vec<Point3<f64>>> = polygon.iter().map(at).collect();
        // A corner that does not exist is reported with the mesh.
        let flat = corners.filter(|_| polygon.len() > 3).and_then(flattened);
        let Some(flat) = flat else {
            push_fan(polygon, triangles);
            return Ok(());
        };
        if polygon.len() > MAX_CORNERS {
            let found = format!("a polygon with {} corners", polygon.len());
            return Err(source.unsupported(found, "a mesh of triangles"));
        }
        let no_holes: [u32; 0] = [];
        self.earcut
            .earcut_slice(&flat, &no_holes, &mut self.corners);
        triangles.extend(self.corners.as_chunks::<3>().0.iter().map(|&[a, b, c]| {
            let [p, q, r] = [a, b, c].map(|corner| flat[corner as usize]);
            let area = (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
            let wound = if area < 0.0 { [a, c, b] } else { [a, b, c] };
            wound.map(|corner| polygon[corner as usize])
        }));
        Ok(())
    }
}

/// Returns the corners in the polygon's plane, counter-clockwise; `None` without an area. The normal is the vector area (M. E.
/// Newell, "The utilization of procedure models in digital image synthesis", 1975).
fn flattened(corners: Vec<Point3<f64>>) -> Option<Vec<[f64; 2]>> {
    let first = corners[0];
    let pairs = corners.windows(2);
    let area: Vector3<f64> = pairs
        .map(|pair| (pair[0] - first).cross(&(pair[1] - first)))
        .sum();
    let normal = area.try_normalize(f64::MIN_POSITIVE)?;
    let right = normal.cross(&Vector3::ith(normal.iamin(), 1.0)).normalize();
    let up = normal.cross(&right);
    let flat = |p: Point3<f64>| [right.dot(&(p - first)), up.dot(&(p - first))];
    Some(corners.into_iter().map(flat).collect())
}

/// Splits a polygon into a fan of triangles about its first corner.
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

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;

    #[test]
    fn a_concave_polygon_in_space_is_covered_once_whichever_corner_comes_first() {
        // An L of 3 square metres, seen from both sides, turned.
        let flat = [
            (0.0, 0.0),
            (2.0, 0.0),
            (2.0, 1.0),
            (1.0, 1.0),
            (1.0, 2.0),
            (0.0, 2.0),
        ];
        let turn = nalgebra::Rotation3::from_euler_angles(0.5, -0.4, 1.1);
        let vertices = flat.map(|(x, y)| (turn * Point3::new(x, y, 3.0)).cast::<f32>());
        let source = Source {
            path: Path::new("test.obj"),
            bytes: &[],
        };
        for (first, is_reversed) in (0..6).flat_map(|first| [(first, false), (first, true)]) {
            let mut polygon: Vec<u32> = (0..6).map(|i| (first + i) % 6).collect();
            if is_reversed {
                polygon.reverse();
            }
            let mut triangles = Vec::new();
            let mut triangulation = Triangulation::default();
            let done = triangulation.push(source, &polygon, &vertices, &mut triangles);
            done.expect("few corners");
            let mesh = TriangleMesh::new(vertices.to_vec(), triangles).expect("a mesh");
            assert!((mesh.area() - 3.0).abs() < 1e-5, "{first}: {}", mesh.area());
            let up = (turn * Vector3::z()).cast::<f32>() * if is_reversed { -1.0 } else { 1.0 };
            let sampled = mesh.sample_evenly(500, 1).expect("an area");
            assert!(
                sampled
                    .normals
                    .expect("normals")
                    .iter()
                    .all(|n| n.dot(&up) > 0.99)
            );
        }
        let many: Vec<u32> = (0..5000).map(|i| i % 6).collect();
        let refused = Triangulation::default().push(source, &many, &vertices, &mut Vec::new());
        assert!(refused.is_err());
    }
}
