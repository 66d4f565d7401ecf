//! The header of a PLY file.

use super::super::error::FileError;
use super::super::scalar::Scalar;
use super::super::source::{ONE_COLUMN_EACH, Source, header_text};

/// How the rows are stored after the header.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Storage {
    Ascii,
    LittleEndian,
    BigEndian,
}

/// One property of an element.
#[derive(Clone, Debug)]
pub(super) struct Property {
    pub(super) name: String,
    pub(super) kind: Kind,
}

/// One number, or a list of numbers with its length.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Scalar(Scalar),
    List { length: Scalar, item: Scalar },
}

/// A table of the file.
#[derive(Clone, Debug)]
pub(super) struct Element {
    pub(super) name: String,
    pub(super) count: usize,
    pub(super) properties: Vec<Property>,
}

impl Element {
    /// Returns the least size of a binary row: its scalars, and its lists without items.
    pub(super) fn min_row_bytes(&self) -> usize {
        let bytes = self.properties.iter().map(|property| match property.kind {
            Kind::Scalar(scalar) => scalar.size(),
            Kind::List { length, .. } => length.size(),
        });
        bytes.sum()
    }

    /// Returns true if every row has the same number of bytes.
    pub(super) fn is_fixed(&self) -> bool {
        let mut kinds = self.properties.iter().map(|property| property.kind);
        kinds.all(|kind| matches!(kind, Kind::Scalar(_)))
    }

    /// Returns the bytes of one row's scalars.
    pub(super) fn scalar_bytes(&self) -> usize {
        self.scalars().map(|(_, scalar)| scalar.size()).sum()
    }

    /// Returns offset (among the scalars of a row) and type of the named scalar.
    pub(super) fn scalar_at(&self, name: &str) -> Option<(usize, Scalar)> {
        let mut offset = 0;
        for (own_name, scalar) in self.scalars() {
            if own_name == name {
                return Some((offset, scalar));
            }
            offset += scalar.size();
        }
        None
    }

    /// Returns the index of the first list property with one of these names.
    pub(super) fn list(&self, names: &[&str]) -> Option<usize> {
        let is_wanted = |property: &Property| {
            matches!(property.kind, Kind::List { .. }) && names.contains(&property.name.as_str())
        };
        self.properties.iter().position(is_wanted)
    }

    fn scalars(&self) -> impl Iterator<Item = (&str, Scalar)> {
        self.properties
            .iter()
            .filter_map(|property| match property.kind {
                Kind::Scalar(scalar) => Some((property.name.as_str(), scalar)),
                Kind::List { .. } => None,
            })
    }
}

/// A parsed PLY header.
pub(super) struct Header {
    pub(super) storage: Storage,
    pub(super) elements: Vec<Element>,
    /// Offset of the rows in the file.
    pub(super) body_start: usize,
    /// The line at which the rows begin, from 1.
    pub(super) body_line: usize,
}

impl Header {
    pub(super) fn parse(source: Source<'_>) -> Result<Self, FileError> {
        let mut storage = None;
        let mut elements: Vec<Element> = Vec::new();
        let mut start = 0;
        for (i, line) in source
            .bytes
            .split_inclusive(|&byte| byte == b'\n')
            .enumerate()
        {
            start += line.len();
            let text = header_text(line);
            let words: Vec<&str> = text.split_whitespace().collect();
            match words.as_slice() {
                [] | ["ply" | "comment" | "obj_info", ..] => {}
                ["format", format, ..] => {
                    storage = Some(match *format {
                        "ascii" => Storage::Ascii,
                        "binary_little_endian" => Storage::LittleEndian,
                        "binary_big_endian" => Storage::BigEndian,
                        _ => {
                            return Err(source
                                .bad_header(&text, "format ascii or binary_little/big_endian"));
                        }
                    });
                }
                ["element", name, count] => elements.push(Element {
                    name: (*name).to_owned(),
                    count: count
                        .parse()
                        .ok()
                        .ok_or_else(|| source.bad_header(&text, "element NAME COUNT"))?,
                    properties: Vec::new(),
                }),
                // Names may contain any characters: CloudCompare writes brackets.
                ["property", rest @ ..] => {
                    let property = property_of(rest)
                        .ok_or_else(|| source.bad_header(&text, "property TYPE NAME"))?;
                    let element = elements.last_mut();
                    let element = element.ok_or_else(|| {
                        source.bad_header(&text, "an element before its properties")
                    })?;
                    let is_same = |known: &Property| known.name == property.name;
                    let is_read = ["x", "y", "z"].contains(&&*property.name);
                    if is_read && element.properties.iter().any(is_same) {
                        return Err(source.bad_header(&text, ONE_COLUMN_EACH));
                    }
                    element.properties.push(property);
                }
                ["end_header"] => {
                    return Ok(Self {
                        storage: storage
                            .ok_or_else(|| source.bad_header("no format", "a line format"))?,
                        elements,
                        body_start: start,
                        body_line: i + 2,
                    });
                }
                _ => return Err(source.malformed(i + 1, &text, "a line of a PLY header")),
            }
        }
        Err(source.cut_before("the end of the header", "PLY header"))
    }

    /// Returns true if the file has faces that have not been read.
    pub(super) fn has_faces_left(&self, are_read: bool) -> bool {
        let mut elements = self.elements.iter();
        !are_read
            && elements.any(|element| {
                matches!(element.name.as_str(), "face" | "tristrips") && element.count > 0
            })
    }
}

fn property_of(words: &[&str]) -> Option<Property> {
    let (kind, name) = match words {
        ["list", length, item, name @ ..] => {
            let length = scalar_of(length).filter(|scalar| !scalar.is_float())?;
            (
                Kind::List {
                    length,
                    item: scalar_of(item)?,
                },
                name,
            )
        }
        [scalar, name @ ..] => (Kind::Scalar(scalar_of(scalar)?), name),
        [] => return None,
    };
    (!name.is_empty()).then(|| Property {
        name: name.join(" "),
        kind,
    })
}

fn scalar_of(name: &str) -> Option<Scalar> {
    Some(match name {
        "char" | "int8" => Scalar::I8,
        "uchar" | "uint8" => Scalar::U8,
        "short" | "int16" => Scalar::I16,
        "ushort" | "uint16" => Scalar::U16,
        "int" | "int32" => Scalar::I32,
        "uint" | "uint32" => Scalar::U32,
        "float" | "float32" => Scalar::F32,
        "double" | "float64" => Scalar::F64,
        _ => return None,
    })
}
