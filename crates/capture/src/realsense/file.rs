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

use crate::{
    camera_error::{CameraError, CameraErrorKind, quoted},
    camera_library::REALSENSE,
    error::CaptureError,
};
use files::{FileError, open_regular};

const BAG_MARK: &[u8] = b"#ROSBAG V2.0\n";
const DB3_MARK: &[u8] = b"SQLite format 3\0";
/// Offsets in the header of a `SQLite` database: page size, 2 bytes, and number of pages, 4 bytes.
const DB3_PAGE_SIZE_OFFSET_BYTES: usize = 16;
const DB3_NUM_PAGES_OFFSET_BYTES: usize = 28;
/// Number of bytes read first: the magic, and the header of the database or of the first record.
const HEAD_BYTES: usize = 100;

/// Refuses a file that is missing, truncated or not a librealsense recording.
pub(super) fn check(path: &Path) -> Result<(), CaptureError> {
    match fault_of(path).map_err(|source| FileError::reading(path, source))? {
        None => Ok(()),
        Some(what) => Err(REALSENSE.file_unusable(path, what).into()),
    }
}

/// Converts an error for a file, where it has other causes than for a camera.
pub(super) fn not_played(error: CameraError, path: &Path) -> CameraError {
    let message = quoted(error.message.as_deref());
    let what = match error.kind {
        CameraErrorKind::NotOpened | CameraErrorKind::NotStarted => {
            format!("librealsense cannot play it{message}")
        }
        CameraErrorKind::Disconnected => {
            format!("librealsense cannot play the rest of it{message}")
        }
        CameraErrorKind::NoDepth { .. } | CameraErrorKind::NoFrames { .. } => {
            "it has no depth image that can be read".to_owned()
        }
        _ => return error,
    };
    REALSENSE.file_unusable(path, what)
}

/// Returns what is wrong with the file, if anything.
fn fault_of(path: &Path) -> io::Result<Option<&'static str>> {
    let mut file = BufReader::new(open_regular(path)?);
    let num_bytes = file.get_ref().metadata()?.len();
    let mut head = Vec::new();
    Read::by_ref(&mut file)
        .take(HEAD_BYTES as u64)
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
    let size = head.get(DB3_PAGE_SIZE_OFFSET_BYTES..)?.first_chunk()?;
    let num = head.get(DB3_NUM_PAGES_OFFSET_BYTES..)?.first_chunk()?;
    // 65536 does not fit into the field and is stored as 1.
    let size = match u16::from_be_bytes(*size) {
        1 => 65_536,
        size => u64::from(size),
    };
    let size = size * u64::from(u32::from_be_bytes(*num));
    (size > 0).then_some(size)
}

/// Least size of a record's header: its field `op`, one byte, with name and length.
const MIN_HEADER_BYTES: u64 = 8;
/// Least size of a record: that header and no data, each after its size.
const MIN_RECORD_BYTES: u64 = 4 + MIN_HEADER_BYTES + 4;

/// Follows the records of the index; true if the last ends with the file.
///
/// Each is at least as long as its shortest header, so that a damaged index takes no longer than reading it.
fn bag_ends_with_its_index(
    file: &mut BufReader<impl Read + Seek>,
    head: &[u8],
    num_bytes: u64,
) -> io::Result<bool> {
    let index = bag_field(head, b"index_pos=").map(u64::from_le_bytes);
    let num_connections = bag_field(head, b"conn_count=").map(u32::from_le_bytes);
    let num_chunks = bag_field(head, b"chunk_count=").map(u32::from_le_bytes);
    let (Some(index), Some(num_connections), Some(num_chunks)) =
        (index, num_connections, num_chunks)
    else {
        return Ok(false);
    };
    let num_records = u64::from(num_connections) + u64::from(num_chunks);
    // A file that was never closed has no index.
    let Some(mut left) = num_bytes.checked_sub(index).filter(|_| index > 0) else {
        return Ok(false);
    };
    if left / MIN_RECORD_BYTES < num_records {
        return Ok(false);
    }
    file.seek(SeekFrom::Start(index))?;
    for _ in 0..num_records {
        // Each record is a header, then data.
        for least in [MIN_HEADER_BYTES, 0] {
            if left < 4 {
                return Ok(false);
            }
            let mut size = [0; 4];
            file.read_exact(&mut size)?;
            let size = u32::from_le_bytes(size);
            let rest = left.checked_sub(4 + u64::from(size));
            let Some(rest) = rest.filter(|_| u64::from(size) >= least) else {
                return Ok(false);
            };
            left = rest;
            // Unlike `seek`, this keeps what was read ahead.
            file.seek_relative(i64::from(size))?;
        }
    }
    Ok(left == 0)
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
        bytes[DB3_PAGE_SIZE_OFFSET_BYTES..DB3_PAGE_SIZE_OFFSET_BYTES + 2]
            .copy_from_slice(&512_u16.to_be_bytes());
        bytes[DB3_NUM_PAGES_OFFSET_BYTES..DB3_NUM_PAGES_OFFSET_BYTES + 4]
            .copy_from_slice(&3_u32.to_be_bytes());
        bytes
    }

    /// Counts the bytes that are read.
    struct Counted<'a, R>(R, &'a std::cell::Cell<u64>);

    impl<R: Read> Read for Counted<'_, R> {
        fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
            let num = self.0.read(bytes)?;
            self.1.set(self.1.get() + num as u64);
            Ok(num)
        }
    }

    impl<R: Seek> Seek for Counted<'_, R> {
        fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
            self.0.seek(to)
        }
    }

    #[test]
    fn an_index_of_any_content_is_read_at_most_once() {
        const CHUNK_BYTES: usize = 1 << 20;
        let first = |num_chunks: u32| {
            let header = [
                field("chunk_count", &num_chunks.to_le_bytes()),
                field("conn_count", &0_u32.to_le_bytes()),
                field("index_pos", &100_u64.to_le_bytes()),
                field("op", &[3]),
            ];
            [BAG_MARK, &record(&header.concat(), b"")].concat()
        };
        let smallest = record(&field("op", &[6]), b"");
        let num_smallest = (CHUNK_BYTES - 100) / smallest.len();
        // Zeros, as in a sparse file; the smallest records; larger ones; and counts that do not fit.
        for (content, num_chunks, is_whole, max_read) in [
            (vec![0], 1 << 16, false, 16_384),
            (vec![0], u32::MAX, false, 0),
            (smallest.clone(), num_smallest as u32, true, CHUNK_BYTES),
            (smallest, u32::MAX, false, 0),
            (
                record(&field("op", &[6]), &[1; 9000]),
                100,
                false,
                CHUNK_BYTES,
            ),
        ] {
            let mut bytes = first(num_chunks);
            bytes.resize(100, 0);
            let index = content.iter().cycle().take(CHUNK_BYTES - 100);
            bytes.extend(index);
            bytes.truncate(100 + (CHUNK_BYTES - 100) / content.len() * content.len());
            let num_read = std::cell::Cell::new(0);
            let file = Counted(io::Cursor::new(&bytes), &num_read);
            let ends = bag_ends_with_its_index(
                &mut BufReader::new(file),
                &bytes[..HEAD_BYTES],
                bytes.len() as u64,
            );
            assert_eq!(
                ends.unwrap(),
                is_whole,
                "{num_chunks} of {} bytes",
                content.len()
            );
            assert!(
                num_read.get() <= max_read as u64,
                "{} bytes",
                num_read.get()
            );
        }
    }

    #[test]
    fn what_keeps_a_file_from_playing_names_the_file() {
        use crate::error::Recovery;
        let path = Path::new("a.bag");
        let played = |kind, message: Option<&str>| {
            let error = REALSENSE.error(kind).quoting(message.map(str::to_owned));
            not_played(error, path)
        };
        for kind in [
            CameraErrorKind::NotOpened,
            CameraErrorKind::NotStarted,
            CameraErrorKind::Disconnected,
        ] {
            let error = played(kind, Some("bad header"));
            assert!(error.to_string().starts_with("a.bag: "), "{error}");
            assert!(error.to_string().ends_with(": bad header"), "{error}");
            assert_eq!(error.recovery(), Recovery::None);
        }
        let title = String::from("It");
        let error = played(CameraErrorKind::NoDepth { title }, None);
        assert_eq!(error.recovery(), Recovery::None, "{error}");
        let other = played(CameraErrorKind::LibraryNotStarted, Some("bad header"));
        let text = other.to_string();
        assert!(
            text.starts_with("librealsense2 cannot be started"),
            "{text}"
        );
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
