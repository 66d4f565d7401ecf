//! Checks that a recorded file is complete.
//!
//! librealsense plays a truncated file as if it ended there, and is not robust against damaged ones. The size recorded in
//! the file is therefore checked before the library opens it.
//!
//! - `.bag`, of older versions of librealsense, has the layout of ROS bag 2.0: after the magic, records consisting of a
//!   header with its length and data with their length. The first record has the position of the index, or 0 if the file
//!   was never closed, and the number of the index records; the index ends with the file.
//! - `.db3`, of newer versions, is a `SQLite` database, whose header has its number of pages.

use std::{
    io::{self, BufReader, Read, Seek, SeekFrom},
    path::Path,
};

use super::error::RealsenseError;
use crate::{
    capture::error::CaptureError,
    files::{FileError, open_regular},
};

const BAG_MARK: &[u8] = b"#ROSBAG V2.0\n";
const DB3_MARK: &[u8] = b"SQLite format 3\0";
/// Offsets in the header of a `SQLite` database: page size, 2 bytes, and number of pages, 4 bytes.
const DB3_PAGE_SIZE: usize = 16;
const DB3_NUM_PAGES: usize = 28;
/// Number of bytes read first: the magic, and the header of the database or of the first record.
const HEAD: usize = 100;

/// Refuses a file that is missing, truncated or not a librealsense recording.
pub(super) fn check(path: &Path) -> Result<(), CaptureError> {
    match fault_of(path).map_err(|source| FileError::reading(path, source))? {
        None => Ok(()),
        Some(what) => Err(RealsenseError::FileUnusable {
            path: path.to_path_buf(),
            what: what.to_owned(),
        }
        .into()),
    }
}

/// Returns what is wrong with the file, if anything.
fn fault_of(path: &Path) -> io::Result<Option<&'static str>> {
    let mut file = BufReader::new(open_regular(path)?);
    let num_bytes = file.get_ref().metadata()?.len();
    let mut head = Vec::new();
    Read::by_ref(&mut file)
        .take(HEAD as u64)
        .read_to_end(&mut head)?;
    let is_whole = if head.starts_with(DB3_MARK) {
        db3_size(&head).is_some_and(|size| size <= num_bytes)
    } else if head.starts_with(BAG_MARK) {
        bag_ends_with_its_index(&mut file, &head, num_bytes)?
    } else {
        return Ok(Some("no recording of librealsense"));
    };
    Ok((!is_whole).then_some("cut off or damaged"))
}

/// Size of a database according to its header, bytes.
fn db3_size(head: &[u8]) -> Option<u64> {
    let size = head.get(DB3_PAGE_SIZE..)?.first_chunk()?;
    let num = head.get(DB3_NUM_PAGES..)?.first_chunk()?;
    // 65536 does not fit into the field and is stored as 1.
    let size = match u16::from_be_bytes(*size) {
        1 => 65_536,
        size => u64::from(size),
    };
    let size = size * u64::from(u32::from_be_bytes(*num));
    (size > 0).then_some(size)
}

/// Follows the records of the index; true if the last ends with the file.
fn bag_ends_with_its_index(
    file: &mut (impl Read + Seek),
    head: &[u8],
    num_bytes: u64,
) -> io::Result<bool> {
    let index = bag_field(head, b"index_pos=").map(u64::from_le_bytes);
    let num_connections = bag_field(head, b"conn_count=").map(u32::from_le_bytes);
    let num_chunks = bag_field(head, b"chunk_count=").map(u32::from_le_bytes);
    let (Some(mut at), Some(num_connections), Some(num_chunks)) =
        (index, num_connections, num_chunks)
    else {
        return Ok(false);
    };
    if at == 0 {
        return Ok(false);
    }
    // Each record is a header, then data.
    for _ in 0..2 * (u64::from(num_connections) + u64::from(num_chunks)) {
        if at.saturating_add(4) > num_bytes {
            return Ok(false);
        }
        let mut size = [0; 4];
        file.seek(SeekFrom::Start(at))?;
        file.read_exact(&mut size)?;
        at += 4 + u64::from(u32::from_le_bytes(size));
    }
    Ok(at == num_bytes)
}

/// Returns the value of a field of the first record.
fn bag_field<const N: usize>(head: &[u8], name: &[u8]) -> Option<[u8; N]> {
    let at = head.windows(name.len()).position(|text| text == name)?;
    head.get(at + name.len()..)?.first_chunk().copied()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn record(header: &[u8], data: &[u8]) -> Vec<u8> {
        let with_size = |part: &[u8]| [&(part.len() as u32).to_le_bytes()[..], part].concat();
        [with_size(header), with_size(data)].concat()
    }

    fn field(name: &str, value: &[u8]) -> Vec<u8> {
        let text = [name.as_bytes(), b"=", value].concat();
        [&(text.len() as u32).to_le_bytes()[..], &text].concat()
    }

    /// A file with one chunk and an index of two records.
    fn bag() -> Vec<u8> {
        let chunk = record(&field("op", &[5]), &[7; 300]);
        let first = |index: u64| {
            let header = [
                field("chunk_count", &1_u32.to_le_bytes()),
                field("conn_count", &1_u32.to_le_bytes()),
                field("index_pos", &index.to_le_bytes()),
                field("op", &[3]),
            ];
            record(&header.concat(), &[b' '; 40])
        };
        let index = BAG_MARK.len() + first(0).len() + chunk.len();
        [
            BAG_MARK.to_vec(),
            first(index as u64),
            chunk,
            record(&field("op", &[7]), b"a connection"),
            record(&field("op", &[6]), b"its chunk"),
        ]
        .concat()
    }

    /// Three pages of 512 bytes.
    fn db3() -> Vec<u8> {
        let mut bytes = DB3_MARK.to_vec();
        bytes.resize(3 * 512, 7);
        bytes[DB3_PAGE_SIZE..DB3_PAGE_SIZE + 2].copy_from_slice(&512_u16.to_be_bytes());
        bytes[DB3_NUM_PAGES..DB3_NUM_PAGES + 4].copy_from_slice(&3_u32.to_be_bytes());
        bytes
    }

    #[test]
    fn only_a_whole_file_of_either_kind_is_let_through() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.bag");
        for whole in [bag(), db3()] {
            for num in 0..=whole.len() {
                std::fs::write(&path, &whole[..num]).unwrap();
                assert_eq!(check(&path).is_ok(), num == whole.len(), "{num} bytes");
            }
        }
        // A file that was never closed.
        let mut open = bag();
        let name = b"index_pos=";
        let at = open.windows(name.len()).position(|text| text == name);
        let at = at.unwrap() + name.len();
        open[at..at + 8].fill(0);
        std::fs::write(&path, open).unwrap();
        assert!(check(&path).is_err());
        std::fs::write(&path, b"something else").unwrap();
        let error = check(&path).expect_err("no recording");
        assert!(error.to_string().contains("no recording"), "{error}");
    }
}
