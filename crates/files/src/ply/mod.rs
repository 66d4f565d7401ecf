//! PLY, the polygon file format: a header that declares elements with their properties, then their rows as text or as
//! bytes in either order.
//!
//! Source: G. Turk, *The PLY Polygon File Format* (1994). Of the element `vertex` x y z, nx ny nz, red green blue (bytes,
//! or reals of 0..1) and `label` are kept; of `face` the list `vertex_indices` or `vertex_index`, whose polygons are split
//! into triangles. Everything else is ignored.
//!
//! The Stanford scans have a `range_grid`: the scanner cell of each vertex. It is ignored, because these cells lie on a
//! turntable's cylinder, whereas a grid here means the image of a pinhole camera.
//!
//! Triangle strips are refused. A row of text may span several lines, or share one with others.

mod body;
mod header;
mod write;

pub use self::write::{PointProperty, write_ply, write_ply_with};

use nalgebra::Point3;

use super::content::FileContent;
use super::error::FileError;
use super::readings::{normals_from, points_from, tidy};
use super::scalar::Column;
use super::source::Source;
use super::surface::{Triangulation, checked_mesh};
use geometry::cloud::PointCloud;

use self::body::{Body, Rows};
use self::header::Header;

/// Returns true for the word "ply" and a line end of any kind.
pub(super) fn is_ply(bytes: &[u8]) -> bool {
    bytes
        .strip_prefix(b"ply")
        .is_some_and(|rest| rest.first().is_none_or(u8::is_ascii_whitespace))
}

pub(super) fn read(source: Source<'_>) -> Result<FileContent, FileError> {
    let header = Header::parse(source)?;
    let mut body = Body::new(source, &header);
    let (mut vertices, mut faces) = (None, None);
    let mut is_read_to_end = true;
    for element in &header.elements {
        match element.name.as_str() {
            "vertex" if vertices.is_none() => {
                source.limited("points", element.count)?;
                vertices = Some((element, body.rows(element, None)?));
            }
            "face" if faces.is_none() && element.count > 0 => {
                source.limited("faces", element.count)?;
                let indices = element.list(&["vertex_indices", "vertex_index"]);
                let indices = indices
                    .ok_or_else(|| source.bad_header("element face", "a list vertex_indices"))?;
                faces = Some(body.rows(element, Some(indices))?);
            }
            "tristrips" if element.count > 0 && faces.is_none() => {
                return Err(source.unsupported("a PLY of triangle strips", "PLY with faces"));
            }
            // Do not read beyond the last element of use.
            _ if vertices.is_some() && !header.has_faces_left(faces.is_some()) => {
                is_read_to_end = false;
                break;
            }
            _ => body.skip(element)?,
        }
    }
    let Some((element, rows)) = vertices else {
        return Err(source.bad_header("no element vertex", "the element vertex"));
    };
    let column = |name: &str| {
        element
            .scalar_at(name)
            .map(|(offset, scalar)| rows.column(offset, scalar))
    };
    let mut cloud = cloud_of(source, column)?;
    if let Some(faces) = faces {
        let triangles = triangulated(source, &faces, &cloud.points)?;
        return checked_mesh(source, cloud.points, triangles).map(FileContent::Mesh);
    }
    if is_read_to_end {
        cloud.surplus_bytes = body.surplus();
    }
    tidy(cloud, source).map(FileContent::Cloud)
}

fn cloud_of<'a>(
    source: Source<'_>,
    column: impl Fn(&str) -> Option<Column<'a>>,
) -> Result<PointCloud, FileError> {
    let coordinate = |name| {
        column(name).ok_or_else(|| source.bad_header("element vertex", "the properties x, y and z"))
    };
    let (x, y, z) = (coordinate("x")?, coordinate("y")?, coordinate("z")?);
    let three = |a, b, c| column(a).zip(column(b)).zip(column(c));
    Ok(PointCloud {
        is_simulated: source.says_simulated(),
        points: points_from([x, y, z]),
        normals: three("nx", "ny", "nz").map(|((x, y), z)| normals_from([x, y, z])),
        colours: three("red", "green", "blue").map(|((red, green), blue)| {
            let (red, green, blue) = (red.channel(), green.channel(), blue.channel());
            let rows = red.into_iter().zip(green).zip(blue);
            rows.map(|((red, green), blue)| [red, green, blue])
                .collect()
        }),
        labels: column("label").map(Column::u32s),
        grid: None,
        surplus_bytes: 0,
    })
}

/// Splits polygons into triangles; polygons with fewer than three corners yield none.
fn triangulated(
    source: Source<'_>,
    faces: &Rows<'_>,
    vertices: &[Point3<f32>],
) -> Result<Vec<[u32; 3]>, FileError> {
    let num_corners = faces.list_lengths.iter().map(|&length| length as usize);
    let num_triangles = num_corners
        .clone()
        .map(|corners| corners.saturating_sub(2))
        .sum();
    source.affordable(num_triangles, size_of::<[u32; 3]>())?;
    let mut triangles = Vec::with_capacity(source.limited("triangles", num_triangles)?);
    let mut rest = faces.list_values.as_slice();
    let mut triangulation = Triangulation::default();
    for corners in num_corners {
        let Some((polygon, after)) = rest.split_at_checked(corners) else {
            break;
        };
        rest = after;
        triangulation.push(source, polygon, vertices, &mut triangles)?;
    }
    Ok(triangles)
}

#[cfg(test)]
pub(super) mod tests;
