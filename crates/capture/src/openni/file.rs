//! Checks that a recorded file is complete.
//!
//! libOpenNI2 does not report the end of some truncated files, and is not robust against damaged ones. The chain of records
//! is therefore followed to its last one before the library opens the file. The layout is that of `DataRecords.h` of OpenNI
//! 2: a file header, then records, each with its magic, kind, node, and the sizes of its fields and its payload.

use std::{
    io::{self, BufReader, Read as _},
    path::Path,
};

use crate::{camera_library::OPENNI, error::CaptureError};
use files::{FileError, open_regular};

const FILE_MAGIC: &[u8] = b"NI10";
const FILE_HEADER_BYTES: u64 = 24;
const RECORD_MAGIC: u32 = u32::from_le_bytes(*b"NIR\0");
/// Size of a record's header in earlier versions; later ones add four bytes.
const MIN_FIELD_BYTES: u32 = 24;
/// Number of bytes read of a record's header.
const HEAD_BYTES: usize = 20;
/// `RECORD_END`.
const RECORD_END: u32 = 0x0B;

/// Refuses a file that is missing, truncated or not an OpenNI recording.
pub(super) fn check(path: &Path) -> Result<(), CaptureError> {
    match end_of_whole(path).map_err(|source| FileError::reading(path, source))? {
        Ok(()) => Ok(()),
        Err(what) => Err(OPENNI.file_unusable(path, what).into()),
    }
}

/// Follows the records; the inner error gives the place where they break off.
fn end_of_whole(path: &Path) -> io::Result<Result<(), String>> {
    let file = open_regular(path)?;
    let num_bytes = file.metadata()?.len();
    let mut file = BufReader::new(file);
    let mut header = [0; FILE_HEADER_BYTES as usize];
    if num_bytes < FILE_HEADER_BYTES {
        return Ok(Err("no recording of OpenNI".into()));
    }
    file.read_exact(&mut header)?;
    if !header.starts_with(FILE_MAGIC) {
        return Ok(Err("no recording of OpenNI".into()));
    }
    let mut at = FILE_HEADER_BYTES;
    loop {
        let broken = || Ok(Err(format!("cut off or damaged at byte {at}")));
        if num_bytes - at < u64::from(MIN_FIELD_BYTES) {
            return broken();
        }
        let mut head = [0; HEAD_BYTES];
        file.read_exact(&mut head)?;
        let word = |k: usize| {
            let mut bytes = [0; 4];
            bytes.copy_from_slice(&head[4 * k..4 * k + 4]);
            u32::from_le_bytes(bytes)
        };
        let [magic, kind, fields, payload] = [0, 1, 3, 4].map(word);
        let next = at + u64::from(fields) + u64::from(payload);
        if magic != RECORD_MAGIC || fields < MIN_FIELD_BYTES || next > num_bytes {
            return broken();
        }
        if kind == RECORD_END {
            return Ok(Ok(()));
        }
        file.seek_relative((next - at - HEAD_BYTES as u64) as i64)?;
        at = next;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn record(kind: u32, payload: u32) -> Vec<u8> {
        let words = [RECORD_MAGIC, kind, 1, 28, payload, 0, 0];
        let mut bytes: Vec<u8> = words.into_iter().flat_map(u32::to_le_bytes).collect();
        bytes.resize(bytes.len() + payload as usize, 7);
        bytes
    }

    #[test]
    fn only_a_file_with_its_last_record_is_whole() {
        let mut whole = b"NI10".to_vec();
        whole.resize(FILE_HEADER_BYTES as usize, 0);
        whole.extend(record(0x0A, 500));
        whole.extend(record(RECORD_END, 0));
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.oni");
        for num in 0..=whole.len() {
            std::fs::write(&path, &whole[..num]).unwrap();
            assert_eq!(check(&path).is_ok(), num == whole.len(), "{num} bytes");
        }
        // The library leaves bytes after the end.
        std::fs::write(&path, [&whole[..], &[0; 99]].concat()).unwrap();
        check(&path).unwrap();
        for at in [0, 24, 36, 39, 552] {
            let mut damaged = whole.clone();
            damaged[at] = 0xFF;
            std::fs::write(&path, damaged).unwrap();
            assert!(check(&path).is_err(), "byte {at}");
        }
    }
}
