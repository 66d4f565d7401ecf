//! PCD, the format of the Point Cloud Library: a text header, then rows (ascii, binary) or LZF-packed columns
//! (`binary_compressed`).
//!
//! Source: the Point Cloud Library, its page `PCD_V7` and `io/src/pcd_io.cpp`. x, y, z may have any number type;
//! `normal_x/y/z`, `rgb` or `rgba` (0xAARRGGBB in four bytes of any type) and `label` are kept, other fields
//! skipped. `HEIGHT` above 1 makes the cloud organised.
//!
//! `VIEWPOINT` is ignored on purpose: it is the sensor's pose in some world, while the points stay in camera space, which
//! is the space used here.
//!
//! Deviations: a cut packed block is refused as a whole, where the library fills up with zeros; bytes after the last point
//! are counted, where the library ignores them.

mod body;
mod header;
mod lzf;
mod write;

pub use self::write::write_pcd;

use super::error::FileError;
use super::readings::{normals_from, points_from, tidy};
use super::source::Source;
use geometry::cloud::PointCloud;

use self::body::Body;
use self::header::Header;

/// Returns true if the first line that is not a comment begins a PCD header.
pub(super) fn is_pcd(source: Source<'_>) -> bool {
    // The file may be binary after the header, so that a line could be as long as the file.
    let beginning = source.bytes.get(..4096).unwrap_or(source.bytes);
    let lines = Source {
        bytes: beginning,
        ..source
    }
    .lines();
    let mut lines = lines.map(|(_, line)| line);
    lines
        .find(|line| !line.is_empty() && !line.starts_with('#'))
        .is_some_and(|line| {
            let keyword = line.split_whitespace().next();
            // Before version 0.7 the VERSION line was optional, and FIELDS were called COLUMNS.
            matches!(keyword, Some("VERSION" | "FIELDS" | "COLUMNS"))
        })
}

pub(super) fn read(source: Source<'_>) -> Result<PointCloud, FileError> {
    let header = Header::parse(source)?;
    let body = Body::read(source, &header)?;
    let column = |name| header.field(name).map(|field| body.column(field));
    let expected = "the fields x, y and z";
    let coordinate =
        |name| column(name).ok_or_else(|| source.bad_header(header.field_names(), expected));
    let (x, y, z) = (coordinate("x")?, coordinate("y")?, coordinate("z")?);
    let normals = (column("normal_x"), column("normal_y"), column("normal_z"));
    let cloud = PointCloud {
        points: points_from([x, y, z]),
        normals: match normals {
            (Some(x), Some(y), Some(z)) => Some(normals_from([x, y, z])),
            _ => None,
        },
        colours: column("rgb")
            .or_else(|| column("rgba"))
            .filter(|packed| packed.scalar.size() == 4)
            .map(|packed| packed.raw_u32s().into_iter().map(unpacked_colour).collect()),
        labels: column("label").map(super::scalar::Column::u32s),
        grid: header.grid,
        is_simulated: source.says_simulated(),
        surplus_bytes: body.surplus,
    };
    tidy(cloud, source)
}

fn unpacked_colour(packed: u32) -> [u8; 3] {
    let [_alpha, red, green, blue] = packed.to_be_bytes();
    [red, green, blue]
}

#[cfg(test)]
pub(super) mod tests;
