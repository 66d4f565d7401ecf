//! The buffers of a glTF document, and the numbers in them.

use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::path::{Path, PathBuf};

use ::gltf::accessor::{Accessor, DataType, Dimensions};
use ::gltf::buffer::{self, Buffer};
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;

use super::super::MAX_UNPACKED_BYTES;
use super::super::error::FileError;
use super::super::names::stays_inside;
use super::super::source::{Source, read_limited};

/// The buffers of a document, loaded on first use.
pub(super) struct Buffers<'a> {
    source: Source<'a>,
    /// The binary chunk of a GLB.
    blob: Option<&'a [u8]>,
    loaded: HashMap<usize, Vec<u8>>,
}

impl<'a> Buffers<'a> {
    pub(super) fn new(source: Source<'a>, blob: Option<&'a [u8]>) -> Self {
        Self {
            source,
            blob,
            loaded: HashMap::new(),
        }
    }

    /// Reads three numbers per element.
    pub(super) fn positions(
        &mut self,
        accessor: &Accessor<'_>,
    ) -> Result<Vec<[f32; 3]>, FileError> {
        if (accessor.data_type(), accessor.dimensions()) != (DataType::F32, Dimensions::Vec3) {
            return Err(self.source.damaged("positions that are not three reals"));
        }
        let number = |cell: &[u8], at: usize| {
            let bytes = cell.get(at..).and_then(<[u8]>::first_chunk);
            bytes.map_or(f32::NAN, |bytes| f32::from_le_bytes(*bytes))
        };
        let cells = self.cells(accessor)?;
        Ok(cells
            .map(|cell| [number(cell, 0), number(cell, 4), number(cell, 8)])
            .collect())
    }

    /// Reads one whole number per element.
    pub(super) fn indices(&mut self, accessor: &Accessor<'_>) -> Result<Vec<u32>, FileError> {
        if accessor.dimensions() != Dimensions::Scalar {
            return Err(self.source.damaged("indices that are not single numbers"));
        }
        let index: fn(&[u8]) -> Option<u32> = match accessor.data_type() {
            DataType::U8 => |cell| cell.first().map(|&byte| u32::from(byte)),
            DataType::U16 => |cell| {
                cell.first_chunk()
                    .map(|bytes| u32::from(u16::from_le_bytes(*bytes)))
            },
            DataType::U32 => |cell| cell.first_chunk().map(|bytes| u32::from_le_bytes(*bytes)),
            _ => return Err(self.source.damaged("indices that are not whole numbers")),
        };
        Ok(self.cells(accessor)?.filter_map(index).collect())
    }

    /// Returns the bytes of each element, after a check that all lie within their view and buffer.
    fn cells(&mut self, accessor: &Accessor<'_>) -> Result<impl Iterator<Item = &[u8]>, FileError> {
        let source = self.source;
        let (Some(view), None) = (accessor.view(), accessor.sparse()) else {
            let found = "positions or indices without a buffer view, or with a sparse one";
            return Err(source.unsupported(found, "glTF without sparse accessors"));
        };
        let size = accessor.size();
        let stride = view.stride().unwrap_or(size);
        let (count, offset) = (accessor.count(), accessor.offset());
        if stride < size {
            return Err(source.damaged(format!("elements of {size} bytes every {stride}")));
        }
        source.limited("points", count)?;
        let end = count
            .checked_mul(stride)
            .and_then(|bytes| bytes.checked_add(offset));
        // The last element needs no gap behind it.
        let end = end.map(|end| end - if count > 0 { stride - size } else { 0 });
        let bytes = self.view(&view)?;
        let Some(bytes) = end.and_then(|end| bytes.get(offset..end)) else {
            return Err(source.truncated("buffer view", bytes.len(), end.unwrap_or(usize::MAX)));
        };
        Ok(bytes.chunks(stride).take(count))
    }

    fn view(&mut self, view: &buffer::View<'_>) -> Result<&[u8], FileError> {
        let source = self.source;
        let buffer = self.buffer(&view.buffer())?;
        let end = view.offset().checked_add(view.length());
        let bytes = end.and_then(|end| buffer.get(view.offset()..end));
        bytes.ok_or_else(|| source.truncated("buffer", buffer.len(), end.unwrap_or(usize::MAX)))
    }

    fn buffer(&mut self, buffer: &Buffer<'_>) -> Result<&[u8], FileError> {
        let source = self.source;
        let bytes = match buffer.source() {
            buffer::Source::Bin => self.blob.ok_or_else(|| source.damaged("no binary chunk"))?,
            buffer::Source::Uri(uri) => {
                let num_loaded: usize = self.loaded.values().map(Vec::len).sum();
                let bytes = match self.loaded.entry(buffer.index()) {
                    Entry::Occupied(known) => known.into_mut(),
                    Entry::Vacant(unknown) => {
                        // Several buffers may name the same file, so bound their sum.
                        let room = MAX_UNPACKED_BYTES.saturating_sub(num_loaded as u64);
                        unknown.insert(load(source, uri, room)?)
                    }
                };
                bytes.as_slice()
            }
        };
        bytes
            .get(..buffer.length())
            .ok_or_else(|| source.truncated("buffer", bytes.len(), buffer.length()))
    }
}

/// Loads the bytes at a URI. A file may have at most `room` bytes; embedded data is bounded by the document itself.
fn load(source: Source<'_>, uri: &str, room: u64) -> Result<Vec<u8>, FileError> {
    if let Some(data) = uri.strip_prefix("data:") {
        let encoded = data.split_once(";base64,").map(|(_, encoded)| encoded);
        let decoded = encoded.and_then(|encoded| STANDARD.decode(encoded).ok());
        return decoded.ok_or_else(|| source.damaged("an embedded buffer that is not base64"));
    }
    let Some(relative) = relative_path(uri) else {
        let found = format!("a buffer at {}", uri.chars().take(60).collect::<String>());
        return Err(source.unsupported(found, "glTF with its buffers beside it or inside it"));
    };
    let folder = source.path.parent().unwrap_or(Path::new(""));
    read_limited(&folder.join(relative), room)
}

/// Returns the path that a URI names below the document's own folder; `None` for anything else.
fn relative_path(uri: &str) -> Option<PathBuf> {
    let decoded = percent_decoded(uri)?;
    // A colon means a scheme or a drive, a backslash a folder on Windows.
    if decoded.is_empty() || decoded.contains([':', '\\', '\0']) {
        return None;
    }
    let path = PathBuf::from(decoded);
    stays_inside(&path).then_some(path)
}

fn percent_decoded(uri: &str) -> Option<String> {
    let mut parts = uri.split('%');
    let mut bytes = parts.next()?.as_bytes().to_vec();
    for part in parts {
        let (code, rest) = part.split_at_checked(2)?;
        bytes.push(u8::from_str_radix(code, 16).ok()?);
        bytes.extend_from_slice(rest.as_bytes());
    }
    String::from_utf8(bytes).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_paths_below_the_folder_are_followed() {
        assert_eq!(relative_path("car.bin"), Some("car.bin".into()));
        assert_eq!(
            relative_path("./data/my%20car.bin"),
            Some("./data/my car.bin".into())
        );
        for uri in [
            "",
            "/etc/passwd",
            "../car.bin",
            "data/../../car.bin",
            "%2e%2e/car.bin",
            "%2Fetc%2Fpasswd",
            "http://example.org/car.bin",
            "file:///etc/passwd",
            "C:/car.bin",
            "..\\car.bin",
            "car%2",
            "car%zz",
            "car%ff",
            "car%00",
        ] {
            assert_eq!(relative_path(uri), None, "{uri}");
        }
    }
}
