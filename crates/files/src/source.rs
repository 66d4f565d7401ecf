//! A file in memory, with its path for errors.

use std::borrow::Cow;
use std::fs::{self, File, Metadata};
use std::io::{self, Read as _};
use std::path::Path;
use std::thread;
use std::time::Duration;

use super::error::{Expected, FileError, NoFile};
use super::{MAX_FILE_BYTES, MAX_POINTS, MAX_UNPACKED_BYTES};

/// What is expected of a heading that names a coordinate twice.
pub(super) const ONE_COLUMN_EACH: &str = "one column each for x, y and z";

/// The bytes of a file and its path.
#[derive(Clone, Copy)]
pub(super) struct Source<'a> {
    pub(super) path: &'a Path,
    pub(super) bytes: &'a [u8],
}

/// Opens a regular file for reading. Anything else is refused before it is opened: opening a pipe without a writer would
/// block, and a device may never end.
pub fn open_regular(path: &Path) -> io::Result<File> {
    refuse_all_but_files(&fs::metadata(path)?)?;
    let file = File::open(path)?;
    // Another file may have taken its place meanwhile.
    refuse_all_but_files(&file.metadata()?)?;
    Ok(file)
}

/// Refuses anything but a regular file, before another reader or writer opens it. Nothing at all is fine.
pub fn refuse_special(path: &Path) -> io::Result<()> {
    fs::metadata(path).map_or(Ok(()), |found| refuse_all_but_files(&found))
}

fn refuse_all_but_files(found: &Metadata) -> io::Result<()> {
    if found.is_file() {
        Ok(())
    } else if found.is_dir() {
        Err(io::Error::new(io::ErrorKind::IsADirectory, NoFile::Folder))
    } else {
        Err(io::Error::new(io::ErrorKind::InvalidInput, NoFile::Device))
    }
}

/// Reads a whole capture, cloud or mesh: a regular file that is not empty and not above [`MAX_FILE_BYTES`].
pub fn read_bytes(path: &Path) -> Result<Vec<u8>, FileError> {
    read_limited(path, MAX_FILE_BYTES)
}

/// Reads a whole regular file that is not empty and has at most `limit` bytes. A file that changes meanwhile is refused,
/// because the bytes would mix two contents.
pub fn read_limited(path: &Path, limit: u64) -> Result<Vec<u8>, FileError> {
    let wrong = |error| FileError::reading(path, error);
    let too_large = |found| {
        let path = path.to_owned();
        if limit < MAX_FILE_BYTES {
            FileError::TooLong { path, found, limit }
        } else {
            FileError::TooLarge {
                path,
                what: "bytes",
                found,
                limit,
            }
        }
    };
    let file = open_regular(path).map_err(wrong)?;
    let changing = || FileError::Changing {
        path: path.to_owned(),
    };
    let before = settled(&file).map_err(wrong)?.ok_or_else(changing)?;
    if before.len() > limit {
        return Err(too_large(before.len()));
    }
    let mut bytes = Vec::with_capacity(before.len() as usize + 1);
    (&file)
        .take(limit + 1)
        .read_to_end(&mut bytes)
        .map_err(wrong)?;
    let found = bytes.len() as u64;
    if found > limit {
        return Err(too_large(found));
    }
    let after = file.metadata().map_err(wrong)?;
    if found != before.len() || stamp(&after) != stamp(&before) {
        return Err(changing());
    }
    if bytes.is_empty() {
        return Err(FileError::Empty {
            path: path.to_owned(),
        });
    }
    Ok(bytes)
}

/// Two changes within this time may have the same file time. It spans several ticks of the slowest system.
const FILE_CLOCK: Duration = Duration::from_millis(30);

/// Returns the metadata of a file once any later change would show in them; `None` if the file is changing now.
fn settled(file: &File) -> io::Result<Option<Metadata>> {
    let found = file.metadata()?;
    let age = found.modified().ok().and_then(|time| time.elapsed().ok());
    if let Some(left) = age.and_then(|age| FILE_CLOCK.checked_sub(age)) {
        thread::sleep(left);
        let again = file.metadata()?;
        return Ok((stamp(&again) == stamp(&found)).then_some(again));
    }
    Ok(Some(found))
}

fn stamp(found: &Metadata) -> (u64, Option<std::time::SystemTime>) {
    (found.len(), found.modified().ok())
}

/// Bytes at the beginning of a file in which its comments are looked for.
const HEAD: usize = 1024;

impl<'a> Source<'a> {
    /// Returns the lines with their number from 1, without line ends, byte order mark and surrounding spaces.
    pub(super) fn lines(self) -> impl Iterator<Item = (usize, Cow<'a, str>)> + Clone {
        let Self { bytes, .. } = self;
        let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
        bytes
            .split(|&byte| byte == b'\n')
            .enumerate()
            .map(|(i, line)| (i + 1, String::from_utf8_lossy(line.trim_ascii())))
    }

    /// Returns true if a comment at the beginning of the file marks its points as simulated, as this program's writers do.
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

    /// Like [`Self::truncated`], where the number of missing bytes is unknown, but not what is missing.
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

    /// Refuses to unpack to more than [`MAX_UNPACKED_BYTES`], before memory is allocated: a header or a packed block of a few
    /// bytes can stand for any amount.
    pub(super) fn affordable(self, count: usize, bytes_each: usize) -> Result<(), FileError> {
        let found = (count as u64).saturating_mul(bytes_each as u64);
        if found <= MAX_UNPACKED_BYTES {
            return Ok(());
        }
        Err(FileError::TooLarge {
            path: self.path.to_owned(),
            what: "bytes unpacked",
            found,
            limit: MAX_UNPACKED_BYTES,
        })
    }

    /// Returns `count` if it is at most [`MAX_POINTS`].
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

/// Returns a line of a header as text, cut at 4096 bytes: a longer line is data after a damaged header.
pub(super) fn header_text(line: &[u8]) -> Cow<'_, str> {
    String::from_utf8_lossy(line.get(..4096).unwrap_or(line).trim_ascii())
}

/// Returns the first 60 characters: enough to find the place, short enough for one line of the window.
pub fn shortened(text: &str) -> String {
    match text.char_indices().nth(60) {
        Some((end, _)) => format!("{}…", text.get(..end).unwrap_or_default()),
        None => text.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use std::io::{Seek as _, SeekFrom, Write as _};
    use std::sync::atomic::{AtomicBool, Ordering};

    use super::*;
    use crate::FileLock;

    #[test]
    fn a_file_that_is_written_while_it_is_read_is_never_a_mixture() {
        const SIZE: usize = 1 << 20;
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("written.bin");
        fs::write(&path, vec![b'a'; SIZE]).unwrap();
        let is_over = AtomicBool::new(false);
        let (mut num_whole, mut num_refused) = (0, 0);
        let mut wrong = None;
        thread::scope(|scope| {
            scope.spawn(|| {
                let mut file = File::options().write(true).open(&path).unwrap();
                for letter in [b'b', b'a'].into_iter().cycle() {
                    if is_over.load(Ordering::Relaxed) {
                        break;
                    }
                    file.seek(SeekFrom::Start(0)).unwrap();
                    for piece in vec![letter; SIZE].chunks(SIZE / 16) {
                        file.write_all(piece).unwrap();
                        // However fast the computer is, some reads meet a write.
                        thread::sleep(FILE_CLOCK / 15);
                    }
                    // Long enough that a whole read fits in now and then.
                    thread::sleep(FILE_CLOCK + FILE_CLOCK / 3);
                }
            });
            // However slow the computer is, both are seen long before the last.
            for _ in 0..5000 {
                if wrong.is_some() || (num_whole >= 10 && num_refused >= 10) {
                    break;
                }
                match read_bytes(&path) {
                    Ok(bytes) if bytes.iter().all(|byte| *byte == bytes[0]) => num_whole += 1,
                    Ok(_) => wrong = Some("a mixture".to_owned()),
                    Err(FileError::Changing { .. }) => num_refused += 1,
                    Err(error) => wrong = Some(error.to_string()),
                }
            }
            // Asserted only after the writer has been stopped, so that a failure cannot leave it running.
            is_over.store(true, Ordering::Relaxed);
        });
        assert_eq!(wrong, None);
        assert!(
            num_whole >= 10 && num_refused >= 10,
            "{num_whole} whole, {num_refused} refused"
        );
    }

    #[cfg(unix)]
    #[test]
    fn a_pipe_or_a_device_is_refused_at_once_wherever_a_file_is_read_or_locked() {
        let folder = tempfile::tempdir().unwrap();
        let pipe = folder.path().join("pipe");
        let made = std::process::Command::new("mkfifo").arg(&pipe).status();
        assert!(made.is_ok_and(|made| made.success()), "mkfifo");
        let device = folder.path().join("device.toml");
        std::os::unix::fs::symlink("/dev/zero", &device).unwrap();
        for path in [pipe, device] {
            let is_refused = |error: FileError| {
                assert!(
                    matches!(
                        error,
                        FileError::NotAFile {
                            found: NoFile::Device,
                            ..
                        }
                    ),
                    "{error}"
                );
            };
            is_refused(read_bytes(&path).unwrap_err());
            is_refused(super::super::read_text(&path, 100).unwrap_err());
            is_refused(super::super::read_picture(&path).unwrap_err());
            is_refused(super::super::open(&path).unwrap_err());
            is_refused(super::super::DepthCamera::read(&path).unwrap_err());
            let opened = open_regular(&path).map(drop);
            let locked = FileLock::exclusive(&path).map(drop);
            for opened in [opened, locked] {
                let error = opened.unwrap_err();
                assert_eq!(error.to_string(), "not a regular file");
            }
        }
    }

    #[test]
    fn a_file_above_its_limit_is_refused_before_it_is_read() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("sparse.toml");
        File::create(&path).unwrap().set_len(1 << 40).unwrap();
        assert!(matches!(
            read_limited(&path, 1000),
            Err(FileError::TooLong { limit: 1000, found, .. }) if found == 1 << 40
        ));
        assert!(matches!(read_bytes(&path), Err(FileError::TooLarge { .. })));
    }

    #[test]
    fn a_count_that_overflows_is_too_large() {
        let source = Source {
            path: Path::new("bomb"),
            bytes: &[],
        };
        assert!(source.affordable(1 << 20, 1 << 10).is_ok());
        for (count, each) in [((1 << 20) + 1, 1 << 10), (usize::MAX, usize::MAX)] {
            assert!(matches!(
                source.affordable(count, each),
                Err(FileError::TooLarge {
                    limit: MAX_UNPACKED_BYTES,
                    ..
                })
            ));
        }
    }
}
