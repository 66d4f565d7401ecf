//! The points of a PCD file as columns of bytes, for every storage.

use std::borrow::Cow;

use super::super::error::FileError;
use super::super::readings::{point_bytes, surplus_of};
use super::super::scalar::Column;
use super::super::source::Source;
use super::header::{Field, Header, Storage};
use super::lzf;

/// Further memory that an inspection needs per point, in bytes: a small packed file must not make that large either.
const INSPECTED_BYTES: usize = 24;

/// The points as bytes: row after row, or column after column in packed files.
pub(super) struct Body<'a> {
    bytes: Cow<'a, [u8]>,
    num_points: usize,
    layout: Layout,
    /// Bytes after the last point, trailing blanks aside. If there are any, the header does not fit the points.
    pub(super) surplus: u64,
}

enum Layout {
    Rows { row_bytes: usize },
    Columns,
}

impl<'a> Body<'a> {
    /// Reads all points that the header promises, so that no column reaches beyond the bytes; else returns an error.
    pub(super) fn read(source: Source<'a>, header: &Header) -> Result<Self, FileError> {
        let num_points = header.num_points;
        let stored = source.bytes.get(header.body_start..).unwrap_or_default();
        let Some(needed) = num_points.checked_mul(header.row_bytes) else {
            return Err(source.cut_before("more than a file can hold", "point data"));
        };
        let rows = Layout::Rows {
            row_bytes: header.row_bytes,
        };
        let copied = match header.storage {
            Storage::Binary => 0,
            Storage::Ascii => header.row_bytes,
            Storage::BinaryCompressed => header.row_bytes.saturating_add(INSPECTED_BYTES),
        };
        let has = |name| header.field(name).is_some();
        let point = point_bytes(has("normal_z"), has("rgb") || has("rgba"), has("label"));
        source.affordable(num_points, copied.saturating_add(point))?;
        let (bytes, layout, surplus) = match header.storage {
            Storage::Ascii => {
                let (bytes, surplus) = rows_of_text(source, header)?;
                (Cow::Owned(bytes), rows, surplus)
            }
            Storage::Binary => {
                let bytes = stored.get(..needed);
                let bytes =
                    bytes.ok_or_else(|| source.truncated("point data", stored.len(), needed))?;
                let rest = stored.get(needed..).unwrap_or_default();
                (Cow::Borrowed(bytes), rows, surplus_of(rest))
            }
            Storage::BinaryCompressed => {
                let (bytes, rest) = unpacked(source, stored, needed)?;
                (Cow::Owned(bytes), Layout::Columns, surplus_of(rest))
            }
        };
        Ok(Self {
            bytes,
            num_points,
            layout,
            surplus,
        })
    }

    pub(super) fn column(&self, field: &Field) -> Column<'_> {
        let (start, stride) = match self.layout {
            Layout::Rows { row_bytes } => (field.offset, row_bytes),
            Layout::Columns => (
                field.offset * self.num_points,
                field.scalar.size() * field.count,
            ),
        };
        Column {
            bytes: &self.bytes,
            start,
            stride,
            scalar: field.scalar,
            len: self.num_points,
        }
    }
}

/// Converts rows of text to the bytes of binary storage; also returns the number of bytes in surplus rows.
fn rows_of_text(source: Source<'_>, header: &Header) -> Result<(Vec<u8>, u64), FileError> {
    let text = Source {
        bytes: source.bytes.get(header.body_start..).unwrap_or_default(),
        ..source
    };
    let mut rows = Vec::new();
    let mut num_rows = 0;
    let mut surplus = 0;
    for (i, line) in text.lines() {
        if line.is_empty() || line.starts_with('#') {
            continue;
        }
        if num_rows == header.num_points {
            surplus += line.len() as u64;
            continue;
        }
        let mut tokens = line.split_whitespace();
        for field in &header.fields {
            for _ in 0..field.count {
                tokens
                    .next()
                    .and_then(|token| field.scalar.push_text(token, &mut rows))
                    .ok_or_else(|| {
                        source.malformed(
                            header.body_line + i - 1,
                            &line,
                            "one number for every field of the header",
                        )
                    })?;
            }
        }
        num_rows += 1;
    }
    if num_rows < header.num_points {
        // A number and its separator take at least two bytes.
        let needed = header
            .num_points
            .saturating_mul(header.fields.len())
            .saturating_mul(2);
        return Err(source.truncated(
            "point data",
            text.bytes.len(),
            needed.max(text.bytes.len() + 1),
        ));
    }
    Ok((rows, surplus))
}

/// Returns the unpacked points and the bytes after the packed block.
fn unpacked<'a>(
    source: Source<'_>,
    stored: &'a [u8],
    needed: usize,
) -> Result<(Vec<u8>, &'a [u8]), FileError> {
    let sizes = stored
        .first_chunk::<4>()
        .zip(stored.get(4..).and_then(<[u8]>::first_chunk::<4>));
    let Some((packed_size, unpacked_size)) = sizes else {
        return Err(source.truncated("sizes of the packed block", stored.len(), 8));
    };
    let (packed_size, unpacked_size) = (
        u32::from_le_bytes(*packed_size),
        u32::from_le_bytes(*unpacked_size),
    );
    let stored = stored.get(8..).unwrap_or_default();
    let Some((packed, rest)) = stored.split_at_checked(packed_size as usize) else {
        return Err(source.truncated("packed point data", stored.len(), packed_size as usize));
    };
    if unpacked_size as usize != needed {
        return Err(source.bad_header(
            format!("a packed block of {unpacked_size} bytes for points of {needed} bytes"),
            "a block as large as its points",
        ));
    }
    if needed > packed.len().saturating_mul(lzf::MAX_RATIO) {
        return Err(source.truncated("packed point data", packed.len(), needed / lzf::MAX_RATIO));
    }
    let points = lzf::decompress(packed, needed);
    let points = points.map_err(|error| source.damaged(error.to_string()))?;
    Ok((points, rest))
}
