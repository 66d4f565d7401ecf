//! Number types of PCD and PLY, and columns of them in a block of bytes.

/// A number type of PCD and PLY; always little endian here, whatever the file's byte order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    I64,
    U64,
    F32,
    F64,
}

impl Scalar {
    /// Returns the size of one number, in bytes.
    pub(super) fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::I64 | Self::U64 | Self::F64 => 8,
        }
    }

    pub(super) fn is_float(self) -> bool {
        matches!(self, Self::F32 | Self::F64)
    }

    /// Reads the number in the first bytes of `cell`; `None` if there are too few.
    pub(super) fn value(self, cell: &[u8]) -> Option<f64> {
        Some(match self {
            Self::I8 => f64::from(i8::from_le_bytes(*cell.first_chunk()?)),
            Self::U8 => f64::from(u8::from_le_bytes(*cell.first_chunk()?)),
            Self::I16 => f64::from(i16::from_le_bytes(*cell.first_chunk()?)),
            Self::U16 => f64::from(u16::from_le_bytes(*cell.first_chunk()?)),
            Self::I32 => f64::from(i32::from_le_bytes(*cell.first_chunk()?)),
            Self::U32 => f64::from(u32::from_le_bytes(*cell.first_chunk()?)),
            Self::I64 => i64::from_le_bytes(*cell.first_chunk()?) as f64,
            Self::U64 => u64::from_le_bytes(*cell.first_chunk()?) as f64,
            Self::F32 => f64::from(f32::from_le_bytes(*cell.first_chunk()?)),
            Self::F64 => f64::from_le_bytes(*cell.first_chunk()?),
        })
    }

    /// Appends the number written as `token`; `None` if it is not one of this type.
    pub(super) fn push_text(self, token: &str, row: &mut Vec<u8>) -> Option<()> {
        match self {
            Self::F32 => row.extend((parse_real(token)? as f32).to_le_bytes()),
            Self::F64 => row.extend(parse_real(token)?.to_le_bytes()),
            Self::I8 => row.extend(i8::try_from(parse_whole(token)?).ok()?.to_le_bytes()),
            Self::U8 => row.extend(u8::try_from(parse_whole(token)?).ok()?.to_le_bytes()),
            Self::I16 => row.extend(i16::try_from(parse_whole(token)?).ok()?.to_le_bytes()),
            Self::U16 => row.extend(u16::try_from(parse_whole(token)?).ok()?.to_le_bytes()),
            Self::I32 => row.extend(i32::try_from(parse_whole(token)?).ok()?.to_le_bytes()),
            Self::U32 => row.extend(u32::try_from(parse_whole(token)?).ok()?.to_le_bytes()),
            Self::I64 => row.extend(i64::try_from(parse_whole(token)?).ok()?.to_le_bytes()),
            Self::U64 => row.extend(u64::try_from(parse_whole(token)?).ok()?.to_le_bytes()),
        }
        Some(())
    }
}

/// Parses a real number. `nan(ind)` and the like are what C libraries print for NaN.
pub(super) fn parse_real(token: &str) -> Option<f64> {
    token.parse().ok().or_else(|| {
        let unsigned = token.trim_start_matches(['-', '+']).to_ascii_lowercase();
        (unsigned.starts_with("nan(") || unsigned.starts_with("1.#")).then_some(f64::NAN)
    })
}

/// Parses a whole number; some writers print `255.0` in a column of bytes.
fn parse_whole(token: &str) -> Option<i128> {
    let from_real = || {
        parse_real(token)
            .filter(|real| real.fract() == 0.0)
            .map(|real| real as i128)
    };
    token.parse().ok().or_else(from_real)
}

/// One field of every row in a block of bytes.
#[derive(Clone, Copy)]
pub(super) struct Column<'a> {
    pub(super) bytes: &'a [u8],
    /// Offset of the first cell.
    pub(super) start: usize,
    /// Bytes from one cell to the next.
    pub(super) stride: usize,
    pub(super) scalar: Scalar,
    /// The number of cells. The caller must have checked that they lie within `bytes`.
    pub(super) len: usize,
}

impl<'a> Column<'a> {
    fn cells(self) -> impl Iterator<Item = &'a [u8]> {
        let Self {
            bytes,
            start,
            stride,
            scalar,
            len,
        } = self;
        (0..len).map_while(move |i| bytes.get(start + i * stride..)?.get(..scalar.size()))
    }

    /// Returns every cell as a real number.
    pub(super) fn f32s(self) -> impl Iterator<Item = f32> + 'a {
        let is_f32 = self.scalar == Scalar::F32;
        self.cells().filter_map(move |cell| {
            if is_f32 {
                return cell.first_chunk().map(|bytes| f32::from_le_bytes(*bytes));
            }
            self.scalar.value(cell).map(|value| value as f32)
        })
    }

    /// Returns every cell as a whole number; fractions are truncated, negative numbers become 0.
    pub(super) fn u32s(self) -> Vec<u32> {
        if self.scalar == Scalar::U32 {
            return self.raw_u32s();
        }
        let values = self.cells().filter_map(|cell| self.scalar.value(cell));
        values.map(|value| value as u32).collect()
    }

    /// Returns the four bytes of every cell as they are, whatever their type in the file.
    pub(super) fn raw_u32s(self) -> Vec<u32> {
        let chunks = self.cells().filter_map(|cell| cell.first_chunk());
        chunks.map(|chunk| u32::from_le_bytes(*chunk)).collect()
    }

    /// Returns every cell as a channel of a colour: whole numbers are 0..=255, reals 0..=1.
    pub(super) fn channel(self) -> Vec<u8> {
        let scale = if self.scalar.is_float() { 255.0 } else { 1.0 };
        let values = self.cells().filter_map(|cell| self.scalar.value(cell));
        values.map(|value| (value * scale).round() as u8).collect()
    }
}
