//! One file in memory, with its path for the errors about it.

use std::borrow::Cow;
use std::fs::{self, File};
use std::io::Read as _;
use std::path::Path;

use super::error::{Expected, FileError, NoFile};
use super::{MAX_FILE_BYTES, MAX_POINTS};

/// The bytes of a file and where they came from.
#[derive(Clone, Copy)]
pub(super) struct Source<'a> {
    pub(super) path: &'a Path,
    pub(super) bytes: &'a [u8],
}

/// All bytes of a regular file that is not empty and not above [`MAX_FILE_BYTES`].
pub(crate) fn read_bytes(path: &Path) -> Result<Vec<u8>, FileError> {
    let wrong = |error| FileError::reading(path, error);
    // Before it is opened: a pipe without a writer would keep the opener waiting.
    let metadata = fs::metadata(path).map_err(wrong)?;
    if !metadata.is_file() {
        let found = if metadata.is_dir() {
            NoFile::Folder
        } else {
            NoFile::Device
        };
        return Err(FileError::NotAFile {
            path: path.to_owned(),
            found,
        });
    }
    let too_large = |found| FileError::TooLarge {
        path: path.to_owned(),
        what: "bytes",
        found,
        limit: MAX_FILE_BYTES,
    };
    if metadata.len() > MAX_FILE_BYTES {
        return Err(too_large(metadata.len()));
    }
    let mut bytes = Vec::with_capacity(metadata.len() as usize + 1);
    // A file that is still being written may be longer by now than its metadata said.
    File::open(path)
        .map_err(wrong)?
        .take(MAX_FILE_BYTES + 1)
        .read_to_end(&mut bytes)
        .map_err(wrong)?;
    match bytes.len() as u64 {
        0 => Err(FileError::Empty {
            path: path.to_owned(),
        }),
        found if found > MAX_FILE_BYTES => Err(too_large(found)),
        _ => Ok(bytes),
    }
}

/// Bytes at the beginning of a file in which its comments are looked for.
const HEAD: usize = 1024;

impl<'a> Source<'a> {
    /// The lines with their number from 1, without line ends, a byte order mark or spaces around them.
    pub(super) fn lines(self) -> impl Iterator<Item = (usize, Cow<'a, str>)> + Clone {
        let Self { bytes, .. } = self;
        let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
        bytes
            .split(|&byte| byte == b'\n')
            .enumerate()
            .map(|(i, line)| (i + 1, String::from_utf8_lossy(line.trim_ascii())))
    }

    /// True if a comment in the head of the file says that no camera read what follows: what we write of simulated
    /// points begins so.
    pub(super) fn says_simulated(self) -> bool {
        let head = self.bytes.get(..HEAD).unwrap_or(self.bytes);
        let mut lines = head.split(|&byte| byte == b'\n').map(<[u8]>::trim_ascii);
        lines.any(|line| line == b"# simulated" || line == b"comment simulated")
    }

    pub(super) fn truncated(self, what: &'static str, found: usize, expected: usize) -> FileError {
        FileError::Truncated {
            path: self.path.to_owned(),
            what,
            found: found as u64,
            expected: Expected::Bytes(expected as u64),
        }
    }

    /// As [`Self::truncated`], where nobody can say how many bytes are missing, only what should still come.
    pub(super) fn cut_before(self, missing: &'static str, what: &'static str) -> FileError {
        FileError::Truncated {
            path: self.path.to_owned(),
            what,
            found: self.bytes.len() as u64,
            expected: Expected::More(missing),
        }
    }

    pub(super) fn bad_header(self, found: impl AsRef<str>, expected: &'static str) -> FileError {
        FileError::BadHeader {
            path: self.path.to_owned(),
            found: shortened(found.as_ref()),
            expected,
        }
    }

    pub(super) fn malformed(self, line: usize, found: &str, expected: &'static str) -> FileError {
        FileError::Malformed {
            path: self.path.to_owned(),
            line,
            found: shortened(found),
            expected,
        }
    }

    pub(super) fn damaged(self, what: impl Into<String>) -> FileError {
        FileError::Damaged {
            path: self.path.to_owned(),
            what: what.into(),
        }
    }

    pub(super) fn unsupported(self, found: impl Into<String>, expected: &'static str) -> FileError {
        FileError::Unsupported {
            path: self.path.to_owned(),
            found: found.into(),
            expected,
        }
    }

    /// `count` again if it is within [`MAX_POINTS`].
    pub(super) fn limited(self, what: &'static str, count: usize) -> Result<usize, FileError> {
        if count <= MAX_POINTS {
            return Ok(count);
        }
        Err(FileError::TooLarge {
            path: self.path.to_owned(),
            what,
            found: count as u64,
            limit: MAX_POINTS as u64,
        })
    }
}

/// A line of a header as text. Longer ones are cut: they are bytes that follow a damaged header.
pub(super) fn header_text(line: &[u8]) -> Cow<'_, str> {
    String::from_utf8_lossy(line.get(..4096).unwrap_or(line).trim_ascii())
}

/// The first 60 characters: enough to find the place, short enough for one line of the window.
fn shortened(text: &str) -> String {
    match text.char_indices().nth(60) {
        Some((end, _)) => format!("{}…", text.get(..end).unwrap_or_default()),
        None => text.to_owned(),
    }
}
