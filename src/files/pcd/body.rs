//! The points of a PCD file as columns of bytes, whichever way they are stored.

use std::borrow::Cow;

use super::super::error::FileError;
use super::super::scalar::Column;
use super::super::source::Source;
use super::header::{Field, Header, Storage};
use super::lzf;

/// The points as bytes: row after row, or field after field where the file was packed.
pub(super) struct Body<'a> {
    bytes: Cow<'a, [u8]>,
    num_points: usize,
    layout: Layout,
}

enum Layout {
    Rows { row_bytes: usize },
    Columns,
}

impl<'a> Body<'a> {
    /// All points that the header promises, or an error: the block is never shorter than its columns claim.
    pub(super) fn read(source: Source<'a>, header: &Header) -> Result<Self, FileError> {
        let num_points = header.num_points;
        let stored = source.bytes.get(header.body_start..).unwrap_or_default();
        let Some(needed) = num_points.checked_mul(header.row_bytes) else {
            return Err(source.cut_before("more than a file can hold", "point data"));
        };
        let rows = Layout::Rows {
            row_bytes: header.row_bytes,
        };
        let (bytes, layout) = match header.storage {
            Storage::Ascii => (Cow::Owned(rows_of_text(source, header)?), rows),
            Storage::Binary => {
                let bytes = stored.get(..needed);
                let bytes =
                    bytes.ok_or_else(|| source.truncated("point data", stored.len(), needed))?;
                (Cow::Borrowed(bytes), rows)
            }
            Storage::BinaryCompressed => (
                Cow::Owned(unpacked(source, stored, needed)?),
                Layout::Columns,
            ),
        };
        Ok(Self {
            bytes,
            num_points,
            layout,
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

/// Text rows as the bytes that binary storage would have.
fn rows_of_text(source: Source<'_>, header: &Header) -> Result<Vec<u8>, FileError> {
    let text = Source {
        bytes: source.bytes.get(header.body_start..).unwrap_or_default(),
        ..source
    };
    let mut rows = Vec::new();
    let mut num_rows = 0;
    for (i, line) in text.lines() {
        if num_rows == header.num_points {
            break;
        }
        if line.is_empty() || line.starts_with('#') {
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
        // A number and what parts it from the next take two bytes at least.
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
    Ok(rows)
}

fn unpacked(source: Source<'_>, stored: &[u8], needed: usize) -> Result<Vec<u8>, FileError> {
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
    let Some(packed) = stored.get(..packed_size as usize) else {
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
    lzf::decompress(packed, needed).map_err(|error| source.damaged(error.to_string()))
}
