//! STL: separate triangles, as text or as 84 + 50·n bytes.
//!
//! Source: 3D Systems, *Stereolithography Interface Specification* (1989). Corners with equal coordinates are welded into
//! one vertex. The stored normals are not used, because the order of the corners implies them.
//!
//! A binary file is recognised by its length, which must match its count of triangles, not by its first word: many begin
//! with "solid". A text may hold several solids; all are joined.

use std::collections::HashMap;

use nalgebra::Point3;

use super::error::FileError;
use super::source::Source;
use super::surface::{checked_mesh, point_of};
use geometry::mesh::TriangleMesh;

const HEADER_BYTES: usize = 84;
const TRIANGLE_BYTES: usize = 50;
/// Memory per triangle until welding is done, in bytes: the triangle, its indices, and half a vertex in list and hash map.
const WELDED_BYTES: usize = 36 + 12 + 22;

/// Returns true if the count in the header matches the length of the file.
pub(super) fn is_binary(bytes: &[u8]) -> bool {
    promised_length(bytes) == Some(bytes.len())
}

/// Returns true for a text that begins with the word "solid".
pub(super) fn is_ascii(bytes: &[u8]) -> bool {
    let text = bytes.trim_ascii_start();
    text.first_chunk::<5>()
        .is_some_and(|word| word.eq_ignore_ascii_case(b"solid"))
        && text.get(5).is_none_or(u8::is_ascii_whitespace)
}

/// Returns the error for an STL file that is neither text nor of the length that its count implies.
pub(super) fn wrong_length(source: Source<'_>) -> FileError {
    let found = source.bytes.len();
    match promised_length(source.bytes) {
        Some(promised) if promised < found => source.damaged(format!(
            "{} bytes behind the last triangle",
            found - promised
        )),
        Some(promised) => source.truncated("triangles", found, promised),
        None => source.truncated("STL header", found, HEADER_BYTES),
    }
}

pub(super) fn read(source: Source<'_>) -> Result<TriangleMesh, FileError> {
    let corners = if is_binary(source.bytes) {
        corners_of_binary(source)?
    } else {
        corners_of_text(source)?
    };
    let (vertices, triangles) = welded(&corners);
    checked_mesh(source, vertices, triangles)
}

fn promised_length(bytes: &[u8]) -> Option<usize> {
    let count = bytes.get(HEADER_BYTES - 4..HEADER_BYTES)?.first_chunk()?;
    let triangles_bytes = (u32::from_le_bytes(*count) as usize).checked_mul(TRIANGLE_BYTES)?;
    triangles_bytes.checked_add(HEADER_BYTES)
}

fn corners_of_binary(source: Source<'_>) -> Result<Vec<[Point3<f32>; 3]>, FileError> {
    let rows = source.bytes.get(HEADER_BYTES..).unwrap_or_default();
    let num_triangles = source.limited("triangles", rows.len() / TRIANGLE_BYTES)?;
    source.affordable(num_triangles, WELDED_BYTES)?;
    let number = |row: &[u8], i: usize| {
        let bytes = row.get(i * 4..).and_then(|rest| rest.first_chunk());
        bytes.map_or(f32::NAN, |bytes| f32::from_le_bytes(*bytes))
    };
    // A row is the normal's three numbers, three for each corner, then two bytes for other uses.
    let corner = |row: &[u8], i: usize| {
        let at = 3 + 3 * i;
        Point3::new(number(row, at), number(row, at + 1), number(row, at + 2))
    };
    let rows = rows.chunks_exact(TRIANGLE_BYTES);
    Ok(rows
        .map(|row| [corner(row, 0), corner(row, 1), corner(row, 2)])
        .collect())
}

fn corners_of_text(source: Source<'_>) -> Result<Vec<[Point3<f32>; 3]>, FileError> {
    let mut triangles = Vec::new();
    let mut corners: Vec<Point3<f32>> = Vec::new();
    let mut is_open = false;
    for (number, line) in source.lines() {
        let lower = line.to_ascii_lowercase();
        let mut words = lower.split_whitespace();
        let wrong = |expected| source.malformed(number, &line, expected);
        match words.next() {
            Some("solid") => is_open = true,
            Some("endsolid") => is_open = false,
            Some("facet") => corners.clear(),
            Some("vertex") => {
                let corner = point_of(words);
                corners.push(corner.ok_or_else(|| wrong("vertex and three numbers"))?);
            }
            Some("endfacet") => match *corners.as_slice() {
                [a, b, c] => {
                    triangles.push([a, b, c]);
                    source.affordable(triangles.len(), WELDED_BYTES)?;
                }
                _ => return Err(wrong("three vertices before the end of a facet")),
            },
            None | Some("outer" | "endloop" | "color") => {}
            Some(_) => {
                return Err(wrong(
                    "facet, outer loop, vertex, endloop, endfacet or endsolid",
                ));
            }
        }
    }
    if is_open {
        return Err(source.cut_before("the line endsolid", "STL text"));
    }
    source.limited("triangles", triangles.len())?;
    Ok(triangles)
}

fn welded(triangles: &[[Point3<f32>; 3]]) -> (Vec<Point3<f32>>, Vec<[u32; 3]>) {
    let mut vertices = Vec::new();
    let mut known: HashMap<[u32; 3], u32> = HashMap::new();
    let mut index_of = |corner: &Point3<f32>| {
        // Adding zero turns -0 into 0.
        let key = [corner.x, corner.y, corner.z].map(|coordinate| (coordinate + 0.0).to_bits());
        *known.entry(key).or_insert_with(|| {
            vertices.push(*corner);
            vertices.len() as u32 - 1
        })
    };
    let indices = triangles
        .iter()
        .map(|[a, b, c]| [index_of(a), index_of(b), index_of(c)])
        .collect();
    (vertices, indices)
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::Expected;

    const SQUARE: &str = "solid square\n\
        facet normal 0 0 1\n outer loop\n vertex 0 0 0\n vertex 1 0 0\n vertex 1 1 0\n endloop\nendfacet\n\
        facet normal 0 0 1\n outer loop\n vertex 0 0 0\n VERTEX 1.0 1e0 0\n vertex -0 1 0\n endloop\nendfacet\n\
        endsolid square\n";

    fn source(bytes: &[u8]) -> Source<'_> {
        Source {
            path: Path::new("test.stl"),
            bytes,
        }
    }

    /// One triangle after a header that begins like text.
    pub(super) fn binary_triangle() -> Vec<u8> {
        let mut bytes = b"solid but binary".to_vec();
        bytes.resize(80, 0);
        bytes.extend(1_u32.to_le_bytes());
        for number in [
            0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0, 3.0, 0.0_f32,
        ] {
            bytes.extend(number.to_le_bytes());
        }
        bytes.extend([0, 0]);
        bytes
    }

    #[test]
    fn equal_corners_become_one_vertex() {
        let mesh = read(source(SQUARE.as_bytes())).unwrap();
        assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3]]);
        assert_eq!(mesh.vertices.len(), 4);
    }

    #[test]
    fn a_binary_file_that_begins_with_solid_is_binary() {
        let bytes = binary_triangle();
        assert!(is_ascii(&bytes) && is_binary(&bytes));
        let mesh = read(source(&bytes)).unwrap();
        assert_eq!(
            mesh.vertices,
            [
                Point3::origin(),
                Point3::new(2.0, 0.0, 0.0),
                Point3::new(0.0, 3.0, 0.0)
            ]
        );
    }

    #[test]
    fn all_solids_of_a_text_are_taken() {
        let twice = format!("{SQUARE}{}", SQUARE.replace("vertex 1 0 0", "vertex 5 0 0"));
        assert_eq!(read(source(twice.as_bytes())).unwrap().triangles.len(), 4);
    }

    #[test]
    fn a_bad_line_and_a_missing_end_are_named() {
        let bad = SQUARE.replace("vertex 1 0 0", "vertex 1 zero 0");
        assert!(matches!(
            read(source(bad.as_bytes())),
            Err(FileError::Malformed { line: 5, .. })
        ));
        let cut = SQUARE.replace("endsolid square\n", "");
        assert!(matches!(
            read(source(cut.as_bytes())),
            Err(FileError::Truncated { .. })
        ));
        let short = SQUARE.replace("vertex 1 0 0\n", "");
        assert!(matches!(
            read(source(short.as_bytes())),
            Err(FileError::Malformed { .. })
        ));
    }

    #[test]
    fn a_count_beyond_the_bytes_takes_no_memory() {
        let mut bytes = binary_triangle();
        bytes[80..84].copy_from_slice(&u32::MAX.to_le_bytes());
        assert!(!is_binary(&bytes));
        assert!(
            matches!(wrong_length(source(&bytes)), FileError::Truncated { expected: Expected::Bytes(n), .. } if n > 200_000_000_000)
        );
    }

    #[test]
    fn vertices_without_a_place_are_refused() {
        for poison in [f32::NAN, f32::INFINITY, 1e30] {
            let mut bytes = binary_triangle();
            bytes[96..100].copy_from_slice(&poison.to_le_bytes());
            assert!(
                matches!(read(source(&bytes)), Err(FileError::Damaged { .. })),
                "{poison}"
            );
        }
    }
}
