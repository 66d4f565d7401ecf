//! The buffers of a glTF document, and the numbers in them.

use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::path::{Path, PathBuf};

use ::gltf::accessor::{Accessor, DataType, Dimensions, sparse::IndexType};
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
    /// Whether positions may be whole numbers.
    is_quantised: bool,
    loaded: HashMap<usize, Vec<u8>>,
}

impl<'a> Buffers<'a> {
    pub(super) fn new(source: Source<'a>, blob: Option<&'a [u8]>, is_quantised: bool) -> Self {
        Self {
            source,
            blob,
            is_quantised,
            loaded: HashMap::new(),
        }
    }

    /// Reads three reals, or whole numbers that stand for them (extension `KHR_mesh_quantization`), per element.
    pub(super) fn positions(
        &mut self,
        accessor: &Accessor<'_>,
    ) -> Result<Vec<[f32; 3]>, FileError> {
        let number: fn(&[u8]) -> Option<f32> = match (accessor.data_type(), accessor.normalized()) {
            (DataType::F32, _) => |bytes| bytes.first_chunk().map(|b| f32::from_le_bytes(*b)),
            _ if !self.is_quantised => {
                return Err(self.source.damaged("positions that are no reals"));
            }
            (DataType::I8, false) => |bytes| bytes.first().map(|&b| f32::from(b as i8)),
            (DataType::U8, false) => |bytes| bytes.first().map(|&b| f32::from(b)),
            (DataType::I16, false) => |bytes| {
                bytes
                    .first_chunk()
                    .map(|b| f32::from(i16::from_le_bytes(*b)))
            },
            (DataType::U16, false) => |bytes| {
                bytes
                    .first_chunk()
                    .map(|b| f32::from(u16::from_le_bytes(*b)))
            },
            (DataType::I8, true) => |bytes| {
                bytes
                    .first()
                    .map(|&b| (f32::from(b as i8) / 127.0).max(-1.0))
            },
            (DataType::U8, true) => |bytes| bytes.first().map(|&b| f32::from(b) / 255.0),
            (DataType::I16, true) => |bytes| {
                let number = bytes.first_chunk().map(|b| i16::from_le_bytes(*b));
                number.map(|number| (f32::from(number) / 32767.0).max(-1.0))
            },
            (DataType::U16, true) => |bytes| {
                let number = bytes.first_chunk().map(|b| u16::from_le_bytes(*b));
                number.map(|number| f32::from(number) / 65535.0)
            },
            (DataType::U32, _) => return Err(self.source.damaged("positions that are no reals")),
        };
        if accessor.dimensions() != Dimensions::Vec3 {
            return Err(self.source.damaged("positions that are not three numbers"));
        }
        let size = accessor.data_type().size();
        let position = |cell: &[u8]| {
            [0, 1, 2].map(|axis| cell.get(axis * size..).and_then(number).unwrap_or(f32::NAN))
        };
        self.elements(accessor, position, [0.0; 3])
    }

    /// Reads one whole number per element.
    pub(super) fn indices(&mut self, accessor: &Accessor<'_>) -> Result<Vec<u32>, FileError> {
        if accessor.dimensions() != Dimensions::Scalar {
            return Err(self.source.damaged("indices that are not single numbers"));
        }
        let Some(index) = whole_number(accessor.data_type()) else {
            return Err(self.source.damaged("indices that are not whole numbers"));
        };
        self.elements(accessor, index, 0)
    }

    /// Reads the elements of an accessor; those that a sparse one leaves out are `zero`.
    fn elements<T: Clone>(
        &mut self,
        accessor: &Accessor<'_>,
        element: impl Fn(&[u8]) -> T,
        zero: T,
    ) -> Result<Vec<T>, FileError> {
        let source = self.source;
        let (count, size) = (accessor.count(), accessor.size());
        source.limited("points", count)?;
        let mut elements = if let Some(view) = accessor.view() {
            self.cells(&view, accessor.offset(), size, count, &element)?
        } else {
            source.affordable(count, size_of::<T>())?;
            vec![zero; count]
        };
        if let Some(sparse) = accessor.sparse() {
            let (of_index, of_value) = (sparse.indices(), sparse.values());
            let data_type = match of_index.index_type() {
                IndexType::U8 => DataType::U8,
                IndexType::U16 => DataType::U16,
                IndexType::U32 => DataType::U32,
            };
            let index = whole_number(data_type).expect("a whole number without a sign");
            let num = sparse.count();
            let (view, offset) = (of_index.view(), of_index.offset());
            let indices = self.cells(&view, offset, data_type.size(), num, index)?;
            let values = self.cells(&of_value.view(), of_value.offset(), size, num, &element)?;
            for (index, value) in indices.into_iter().zip(values) {
                let place = elements.get_mut(index as usize);
                *place.ok_or_else(|| source.damaged(format!("no element {index} of {count}")))? =
                    value;
            }
        }
        Ok(elements)
    }

    /// Reads elements of this size from a view.
    fn cells<T>(
        &mut self,
        view: &buffer::View<'_>,
        offset: usize,
        size: usize,
        count: usize,
        element: impl Fn(&[u8]) -> T,
    ) -> Result<Vec<T>, FileError> {
        let source = self.source;
        let stride = view.stride().unwrap_or(size);
        if stride < size {
            return Err(source.damaged(format!("elements of {size} bytes every {stride}")));
        }
        let end = count
            .checked_mul(stride)
            .and_then(|bytes| bytes.checked_add(offset));
        // The last element needs no gap behind it.
        let end = end.map(|end| end - if count > 0 { stride - size } else { 0 });
        let bytes = self.view(view)?;
        let Some(bytes) = end.and_then(|end| bytes.get(offset..end)) else {
            return Err(source.truncated("buffer view", bytes.len(), end.unwrap_or(usize::MAX)));
        };
        Ok(bytes.chunks(stride).take(count).map(element).collect())
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

/// Returns how a whole number without a sign is read; `None` for another type.
fn whole_number(data_type: DataType) -> Option<fn(&[u8]) -> u32> {
    match data_type {
        DataType::U8 => Some(|cell| cell.first().map_or(0, |&byte| u32::from(byte))),
        DataType::U16 => Some(|cell| {
            let bytes = cell.first_chunk();
            bytes.map_or(0, |bytes| u32::from(u16::from_le_bytes(*bytes)))
        }),
        DataType::U32 => Some(|cell| {
            let bytes = cell.first_chunk();
            bytes.map_or(0, |bytes| u32::from_le_bytes(*bytes))
        }),
        _ => None,
    }
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
