//! LZF, the byte-wise compression of `binary_compressed` PCD files.
//!
//! A control byte `c` below 32 is followed by `c + 1` literal bytes. Any other is a back-reference: its upper three bits
//! plus two are the length (if they are seven, the next byte is added), its lower five bits and the next byte are the
//! distance minus one. Source: M. A. Lehmann, `LibLZF` 3.6, `lzf_d.c`, 2008.

use thiserror::Error;

/// The most bytes per packed byte: a reference of three bytes yields 264.
pub(super) const MAX_RATIO: usize = 88;

/// Why a packed block cannot be unpacked.
#[derive(Debug, PartialEq, Eq, Error)]
pub(super) enum LzfError {
    #[error("the packed points end inside a run")]
    EndsEarly,
    #[error("the packed points refer {distance} bytes back, where {available} are known")]
    BadReference { distance: usize, available: usize },
    #[error("the packed points unpack to {found} bytes or more, not {expected}")]
    WrongLength { found: usize, expected: usize },
}

/// Unpacks to exactly `expected` bytes. The caller must have checked that `expected` is a sensible amount of memory.
pub(super) fn decompress(packed: &[u8], expected: usize) -> Result<Vec<u8>, LzfError> {
    let mut out = Vec::with_capacity(expected);
    let mut rest = packed;
    while let Some((&control, after)) = rest.split_first() {
        rest = after;
        let control = usize::from(control);
        if control < 32 {
            let (literal, after) = rest
                .split_at_checked(control + 1)
                .ok_or(LzfError::EndsEarly)?;
            out.extend_from_slice(literal);
            rest = after;
        } else {
            let mut length = (control >> 5) + 2;
            if length == 9 {
                length += usize::from(take_byte(&mut rest)?);
            }
            let distance = ((control & 31) << 8) + usize::from(take_byte(&mut rest)?) + 1;
            copy_back(&mut out, distance, length)?;
        }
        if out.len() > expected {
            break;
        }
    }
    if out.len() == expected {
        Ok(out)
    } else {
        Err(LzfError::WrongLength {
            found: out.len(),
            expected,
        })
    }
}

fn take_byte(rest: &mut &[u8]) -> Result<u8, LzfError> {
    let (&byte, after) = rest.split_first().ok_or(LzfError::EndsEarly)?;
    *rest = after;
    Ok(byte)
}

fn copy_back(out: &mut Vec<u8>, distance: usize, mut length: usize) -> Result<(), LzfError> {
    let available = out.len();
    let start = available
        .checked_sub(distance)
        .ok_or(LzfError::BadReference {
            distance,
            available,
        })?;
    // A reference may overlap its own output; the bytes known so far then repeat.
    while length > 0 {
        let step = length.min(out.len() - start);
        out.extend_from_within(start..start + step);
        length -= step;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_and_references_unpack_as_in_the_reference_decoder() {
        // Four literal bytes, then twelve from one byte back, then three from sixteen back.
        let packed = [3, b'a', b'b', b'c', b'd', 0xE0, 3, 0, 0x20, 15];
        assert_eq!(
            decompress(&packed, 19).unwrap(),
            [b"abc".as_slice(), &[b'd'; 13], b"abc"].concat()
        );
    }

    #[test]
    fn every_kind_of_damage_has_its_own_error() {
        assert_eq!(decompress(&[5, 1], 6), Err(LzfError::EndsEarly));
        assert_eq!(decompress(&[0xE0], 6), Err(LzfError::EndsEarly));
        assert_eq!(
            decompress(&[0, 1, 0x20, 1], 4),
            Err(LzfError::BadReference {
                distance: 2,
                available: 1
            })
        );
        assert_eq!(
            decompress(&[0, 1], 4),
            Err(LzfError::WrongLength {
                found: 1,
                expected: 4
            })
        );
        assert_eq!(
            decompress(&[1, 1, 2], 1),
            Err(LzfError::WrongLength {
                found: 2,
                expected: 1
            })
        );
    }

    #[test]
    fn the_ratio_is_the_best_that_a_reference_reaches() {
        let mut packed = vec![0, 7];
        for _ in 0..1000 {
            packed.extend([0xE0, 255, 0]);
        }
        let unpacked = decompress(&packed, 1 + 264 * 1000).unwrap();
        assert!(unpacked.iter().all(|&byte| byte == 7));
        assert!(unpacked.len() <= packed.len() * MAX_RATIO);
    }
}
