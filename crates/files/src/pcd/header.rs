//! The header of a PCD file.

use super::super::error::FileError;
use super::super::scalar::Scalar;
use super::super::source::{ONE_COLUMN_EACH, Source, header_text};
use geometry::cloud::Grid;

/// How the points are stored after the header.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Storage {
    Ascii,
    Binary,
    BinaryCompressed,
}

/// One field of every point.
#[derive(Clone, Debug)]
pub(super) struct Field {
    pub(super) name: String,
    pub(super) scalar: Scalar,
    /// Numbers of this type per point; only the first is used.
    pub(super) count: usize,
    /// Offset of this field within a point, in bytes.
    pub(super) offset: usize,
}

/// A parsed PCD header. Its sizes are checked for overflow and against the limit of points.
pub(super) struct Header {
    pub(super) fields: Vec<Field>,
    /// Bytes per point in binary storage.
    pub(super) row_bytes: usize,
    pub(super) num_points: usize,
    /// Set if the cloud is organised.
    pub(super) grid: Option<Grid>,
    pub(super) storage: Storage,
    /// Offset of the points in the file.
    pub(super) body_start: usize,
    /// The line at which the points begin, from 1.
    pub(super) body_line: usize,
}

/// The unparsed words of the header lines, by keyword.
#[derive(Default)]
struct Lines {
    fields: Vec<String>,
    sizes: Vec<String>,
    types: Vec<String>,
    counts: Vec<String>,
    width: Option<String>,
    height: Option<String>,
    points: Option<String>,
}

impl Header {
    pub(super) fn parse(source: Source<'_>) -> Result<Self, FileError> {
        let mut lines = Lines::default();
        let mut start = 0;
        for (i, line) in source
            .bytes
            .split_inclusive(|&byte| byte == b'\n')
            .enumerate()
        {
            start += line.len();
            let text = header_text(line);
            let text = text.trim_start_matches('\u{feff}');
            if text.starts_with('#') {
                continue;
            }
            let mut words = text.split_whitespace().map(str::to_owned);
            let Some(keyword) = words.next() else {
                continue;
            };
            match keyword.as_str() {
                "FIELDS" | "COLUMNS" => lines.fields = words.collect(),
                "SIZE" => lines.sizes = words.collect(),
                "TYPE" => lines.types = words.collect(),
                "COUNT" => lines.counts = words.collect(),
                "WIDTH" => lines.width = words.next(),
                "HEIGHT" => lines.height = words.next(),
                "POINTS" => lines.points = words.next(),
                // VIEWPOINT is ignored, see the module's description.
                "VERSION" | "VIEWPOINT" => {}
                "DATA" => {
                    let storage = match words.next().as_deref() {
                        Some("ascii") => Storage::Ascii,
                        Some("binary") => Storage::Binary,
                        Some("binary_compressed") => Storage::BinaryCompressed,
                        _ => {
                            return Err(
                                source.bad_header(text, "DATA ascii, binary or binary_compressed")
                            );
                        }
                    };
                    return lines.header(source, storage, start, i + 2);
                }
                _ => return Err(source.malformed(i + 1, text, "a line of a PCD header")),
            }
        }
        Err(source.cut_before("the end of the header", "PCD header"))
    }

    /// Returns the first field of that name that holds at least one number.
    pub(super) fn field(&self, name: &str) -> Option<&Field> {
        self.fields
            .iter()
            .find(|field| field.name == name && field.count > 0)
    }

    /// Returns the field names in one line, for errors.
    pub(super) fn field_names(&self) -> String {
        let names: Vec<&str> = self
            .fields
            .iter()
            .map(|field| field.name.as_str())
            .collect();
        format!("FIELDS {}", names.join(" "))
    }
}

impl Lines {
    fn header(
        self,
        source: Source<'_>,
        storage: Storage,
        body_start: usize,
        body_line: usize,
    ) -> Result<Header, FileError> {
        let (fields, row_bytes) = self.fields(source)?;
        let (num_points, grid) = self.shape(source)?;
        Ok(Header {
            fields,
            row_bytes,
            num_points: source.limited("points", num_points)?,
            grid,
            storage,
            body_start,
            body_line,
        })
    }

    fn fields(&self, source: Source<'_>) -> Result<(Vec<Field>, usize), FileError> {
        let num_fields = self.fields.len();
        let num_of = |name| self.fields.iter().filter(|field| *field == name).count();
        if ["x", "y", "z"].into_iter().any(|name| num_of(name) > 1) {
            let fields = format!("FIELDS {}", self.fields.join(" "));
            return Err(source.bad_header(fields, ONE_COLUMN_EACH));
        }
        let is_consistent = self.sizes.len() == num_fields
            && self.types.len() == num_fields
            && (self.counts.is_empty() || self.counts.len() == num_fields);
        if num_fields == 0 || !is_consistent {
            return Err(source.bad_header(
                format!(
                    "{num_fields} FIELDS, {} SIZE, {} TYPE, {} COUNT",
                    self.sizes.len(),
                    self.types.len(),
                    self.counts.len()
                ),
                "one SIZE, TYPE and COUNT for each of the FIELDS",
            ));
        }
        let mut fields = Vec::new();
        let mut offset = 0_usize;
        for (i, ((name, size), kind)) in self
            .fields
            .iter()
            .zip(&self.sizes)
            .zip(&self.types)
            .enumerate()
        {
            let wrong = |expected| {
                source.bad_header(format!("field {name}: SIZE {size} TYPE {kind}"), expected)
            };
            let scalar = scalar_of(kind, size)
                .ok_or_else(|| wrong("TYPE F of SIZE 4 or 8, I or U of 1, 2, 4 or 8"))?;
            let count = match self.counts.get(i) {
                Some(count) => whole(source, "COUNT", count)?,
                None => 1,
            };
            fields.push(Field {
                name: name.clone(),
                scalar,
                count,
                offset,
            });
            offset = scalar
                .size()
                .checked_mul(count)
                .and_then(|bytes| offset.checked_add(bytes))
                .ok_or_else(|| wrong("a COUNT that fits into memory"))?;
        }
        Ok((fields, offset))
    }

    fn shape(&self, source: Source<'_>) -> Result<(usize, Option<Grid>), FileError> {
        let number = |name, text: &Option<String>| {
            text.as_deref()
                .map(|text| whole(source, name, text))
                .transpose()
        };
        let width = number("WIDTH", &self.width)?;
        let height = number("HEIGHT", &self.height)?;
        let points = number("POINTS", &self.points)?;
        // The oldest files have only POINTS, careless writers give only WIDTH and HEIGHT.
        let (width, height) = match (width, height, points) {
            (Some(width), height, _) => (width, height.unwrap_or(1)),
            (None, _, Some(points)) => (points, 1),
            (None, _, None) => {
                return Err(source.bad_header("no WIDTH and no POINTS", "WIDTH, HEIGHT and POINTS"));
            }
        };
        let num_cells = width.checked_mul(height);
        let num_points = points.or(num_cells);
        if num_points != num_cells {
            return Err(source.bad_header(
                format!(
                    "WIDTH {width} HEIGHT {height} POINTS {}",
                    points.unwrap_or_default()
                ),
                "POINTS to be WIDTH times HEIGHT",
            ));
        }
        let num_points = num_points.unwrap_or(usize::MAX);
        Ok((num_points, (height > 1).then_some(Grid { width, height })))
    }
}

fn whole(source: Source<'_>, name: &str, text: &str) -> Result<usize, FileError> {
    let parsed = text.parse().ok();
    parsed.ok_or_else(|| source.bad_header(format!("{name} {text}"), "a whole number"))
}

fn scalar_of(kind: &str, size: &str) -> Option<Scalar> {
    Some(match (kind, size) {
        ("I", "1") => Scalar::I8,
        ("U", "1") => Scalar::U8,
        ("I", "2") => Scalar::I16,
        ("U", "2") => Scalar::U16,
        ("I", "4") => Scalar::I32,
        ("U", "4") => Scalar::U32,
        ("I", "8") => Scalar::I64,
        ("U", "8") => Scalar::U64,
        ("F", "4") => Scalar::F32,
        ("F", "8") => Scalar::F64,
        _ => return None,
    })
}
