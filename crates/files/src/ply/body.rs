//! The elements of a PLY file, read one after the other.

use std::borrow::Cow;

use super::super::error::FileError;
use super::super::readings::{point_bytes, surplus_of};
use super::super::scalar::{Column, Scalar};
use super::super::source::Source;
use super::header::{Element, Header, Kind, Storage};

/// The rows of one element: its scalars as little-endian bytes, and one of its lists.
pub(super) struct Rows<'a> {
    scalars: Cow<'a, [u8]>,
    row_bytes: usize,
    count: usize,
    /// Length of the wanted list in each row; empty without a wanted list.
    pub(super) list_lengths: Vec<u32>,
    /// The values of the wanted list, row after row. A value that is no valid index becomes `u32::MAX`.
    pub(super) list_values: Vec<u32>,
}

impl Rows<'_> {
    pub(super) fn column(&self, offset: usize, scalar: Scalar) -> Column<'_> {
        Column {
            bytes: &self.scalars,
            start: offset,
            stride: self.row_bytes,
            scalar,
            len: self.count,
        }
    }
}

/// The unread rest of the file.
pub(super) struct Body<'a> {
    source: Source<'a>,
    storage: Storage,
    rest: &'a [u8],
    /// The line at which `rest` begins, for text.
    line: usize,
}

impl<'a> Body<'a> {
    pub(super) fn new(source: Source<'a>, header: &Header) -> Self {
        Self {
            source,
            storage: header.storage,
            rest: source.bytes.get(header.body_start..).unwrap_or_default(),
            line: header.body_line,
        }
    }

    /// Skips an element.
    pub(super) fn skip(&mut self, element: &Element) -> Result<(), FileError> {
        if element.is_fixed() && self.storage != Storage::Ascii {
            return self.take_fixed(element).map(|_| ());
        }
        self.check_count(element)?;
        let mut unused = Vec::new();
        for _ in 0..element.count {
            for property in &element.properties {
                match property.kind {
                    Kind::Scalar(scalar) => self.push_number(scalar, &mut unused)?,
                    Kind::List { length, item } => {
                        for _ in 0..self.list_length(length)? {
                            unused.clear();
                            self.push_number(item, &mut unused)?;
                        }
                    }
                }
            }
            unused.clear();
        }
        Ok(())
    }

    /// Reads an element. `wanted_list` is the index of the property whose list is kept.
    pub(super) fn rows(
        &mut self,
        element: &Element,
        wanted_list: Option<usize>,
    ) -> Result<Rows<'a>, FileError> {
        let mut rows = Rows {
            scalars: Cow::Borrowed(&[]),
            row_bytes: element.scalar_bytes(),
            count: element.count,
            list_lengths: Vec::new(),
            list_values: Vec::new(),
        };
        if element.is_fixed() && self.storage == Storage::LittleEndian {
            rows.scalars = Cow::Borrowed(self.take_fixed(element)?);
            return Ok(rows);
        }
        self.check_count(element)?;
        let has = |name| element.scalar_at(name).is_some();
        let point = point_bytes(has("nz"), has("blue"), has("label"));
        let row_bytes = rows.row_bytes.saturating_add(point);
        self.source.affordable(element.count, row_bytes)?;
        let mut scalars = Vec::with_capacity(
            element
                .count
                .saturating_mul(rows.row_bytes)
                .min(self.rest.len() * 8),
        );
        let mut item_bytes = Vec::new();
        for _ in 0..element.count {
            for (i, property) in element.properties.iter().enumerate() {
                match property.kind {
                    Kind::Scalar(scalar) => self.push_number(scalar, &mut scalars)?,
                    Kind::List { length, item } => {
                        let length = self.list_length(length)?;
                        let is_wanted = wanted_list == Some(i);
                        if is_wanted {
                            let num = rows.list_values.len() + length as usize;
                            self.source.affordable(num, size_of::<u32>())?;
                            rows.list_lengths.push(length);
                        }
                        for _ in 0..length {
                            item_bytes.clear();
                            self.push_number(item, &mut item_bytes)?;
                            if is_wanted {
                                rows.list_values.push(index_of(item, &item_bytes));
                            }
                        }
                    }
                }
            }
        }
        rows.scalars = Cow::Owned(scalars);
        Ok(rows)
    }

    /// Bytes after the last row, trailing blanks aside. If there are any, the header does not fit the rows.
    pub(super) fn surplus(&self) -> u64 {
        surplus_of(self.rest)
    }

    /// Returns the bytes of an element without lists.
    fn take_fixed(&mut self, element: &Element) -> Result<&'a [u8], FileError> {
        let needed = element.count.saturating_mul(element.scalar_bytes());
        let Some((bytes, rest)) = self.rest.split_at_checked(needed) else {
            return Err(self.source.truncated("rows", self.rest.len(), needed));
        };
        self.rest = rest;
        // Any number of rows without bytes would fit.
        self.check_has_properties(element)?;
        Ok(bytes)
    }

    /// Refuses more rows than the rest of the file can hold, before memory is allocated for them.
    fn check_count(&self, element: &Element) -> Result<(), FileError> {
        self.check_has_properties(element)?;
        let min_row_bytes = match self.storage {
            // A digit and a separator each; the file's last number needs no separator.
            Storage::Ascii => 2 * element.properties.len(),
            Storage::LittleEndian | Storage::BigEndian => element.min_row_bytes(),
        };
        let needed = element.count.saturating_mul(min_row_bytes);
        if needed > self.rest.len() + 1 {
            return Err(self.source.truncated("rows", self.rest.len(), needed));
        }
        Ok(())
    }

    fn check_has_properties(&self, element: &Element) -> Result<(), FileError> {
        if element.count > 0 && element.properties.is_empty() {
            let found = format!("element {} without properties", element.name);
            return Err(self.source.bad_header(found, "properties of every element"));
        }
        Ok(())
    }

    fn list_length(&mut self, scalar: Scalar) -> Result<u32, FileError> {
        let mut bytes = Vec::with_capacity(8);
        self.push_number(scalar, &mut bytes)?;
        let length = scalar.value(&bytes).unwrap_or_default();
        if !(0.0..=self.rest.len() as f64).contains(&length) {
            return Err(self
                .source
                .truncated("rows", self.rest.len(), length.max(0.0) as usize));
        }
        Ok(length as u32)
    }

    /// Appends the next number as little-endian bytes.
    fn push_number(&mut self, scalar: Scalar, out: &mut Vec<u8>) -> Result<(), FileError> {
        if self.storage == Storage::Ascii {
            let token = self.next_token()?;
            let text = String::from_utf8_lossy(token);
            return scalar
                .push_text(&text, out)
                .ok_or_else(|| self.source.malformed(self.line, &text, "a number"));
        }
        let Some((bytes, rest)) = self.rest.split_at_checked(scalar.size()) else {
            return Err(self
                .source
                .truncated("rows", self.rest.len(), scalar.size()));
        };
        self.rest = rest;
        if self.storage == Storage::BigEndian {
            out.extend(bytes.iter().rev());
        } else {
            out.extend_from_slice(bytes);
        }
        Ok(())
    }

    fn next_token(&mut self) -> Result<&'a [u8], FileError> {
        let gap = self
            .rest
            .iter()
            .position(|byte| !byte.is_ascii_whitespace());
        let (gap, rest) = self.rest.split_at(gap.unwrap_or(self.rest.len()));
        self.line += gap.split(|&byte| byte == b'\n').count() - 1;
        if rest.is_empty() {
            return Err(self.source.cut_before("more numbers", "rows"));
        }
        let end = rest.iter().position(u8::is_ascii_whitespace);
        let (token, rest) = rest.split_at(end.unwrap_or(rest.len()));
        self.rest = rest;
        Ok(token)
    }
}

/// Returns the vertex that an item of a list names; `u32::MAX` for a negative number or one that does not fit.
fn index_of(scalar: Scalar, bytes: &[u8]) -> u32 {
    let value = scalar
        .value(bytes)
        .filter(|value| (0.0..f64::from(u32::MAX)).contains(value));
    value.map_or(u32::MAX, |value| value as u32)
}
