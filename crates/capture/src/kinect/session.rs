//! Recorded sessions, which libfreenect's fakenect build plays.
//!
//! `FAKENECT_PATH` names a folder with an `INDEX.txt` that lists one file per line: `d-TIME-TICKS.pgm` is a depth frame, a
//! header line followed by the frame's bytes. The library terminates the program if such a file is missing, and reads past
//! the end of one that is too short. The session is therefore checked before the library opens it.

use std::{
    collections::BTreeSet,
    env,
    fmt::Display,
    io::{self, BufRead as _, BufReader, Read as _},
    path::Path,
};

use crate::{camera_error::CameraError, camera_library::FREENECT};
use files::{open_regular, words_of};

const VARIABLE: &str = "FAKENECT_PATH";
/// Size of a frame after its header, bytes.
const FRAME_BYTES: u64 = 640 * 480 * 2;
/// Longest accepted header; it is `P5 640 480 65535` and a line end.
const MAX_HEADER_BYTES: u64 = 64;

/// Checks the session that the variable names; `library` names the library in an error. Returns the number of entries; the
/// library plays one per turn.
pub(super) fn check(library: &str) -> Result<usize, CameraError> {
    match env::var_os(VARIABLE).filter(|value| !value.is_empty()) {
        Some(folder) => check_folder(Path::new(&folder)),
        None => Err(FREENECT.unsuitable(
            format!("{library} plays recorded sessions, but {VARIABLE} names none"),
            format!(
                "Set {VARIABLE} to a recorded session, or take the fakenect folder out of the library's path to use a Kinect"
            ),
        )),
    }
}

fn check_folder(folder: &Path) -> Result<usize, CameraError> {
    let index = folder.join("INDEX.txt");
    let lines = open_regular(&index)
        .and_then(io::read_to_string)
        .map_err(|error| unusable(&index, words(&error)))?;
    // An empty line ends the session for the library too.
    let entries = || lines.split('\n').take_while(|line| !line.is_empty());
    let names: BTreeSet<&str> = entries().collect();
    for name in names {
        let path = folder.join(name);
        if !is_entry(name) {
            return Err(unusable(
                &index,
                format!("{name:?} is no entry of a session"),
            ));
        }
        let num_bytes =
            num_bytes_after_header(&path).map_err(|error| unusable(&path, words(&error)))?;
        if name.starts_with('d') && num_bytes < FRAME_BYTES {
            let what = format!("{num_bytes} bytes of depth, expected {FRAME_BYTES}");
            return Err(unusable(&path, what));
        }
    }
    Ok(entries().count())
}

/// The shared words for a missing file are about its folder.
fn words(error: &io::Error) -> String {
    match error.kind() {
        io::ErrorKind::NotFound => "it is not there".into(),
        _ => words_of(error),
    }
}

fn unusable(path: &Path, what: impl Display) -> CameraError {
    FREENECT.unsuitable(
        format!("{}: {what}", path.display()),
        "Record the session again, or take what is damaged out of its INDEX.txt",
    )
}

/// True for a name such as `d-1290.25-4711.pgm`: kind, seconds, ticks.
fn is_entry(name: &str) -> bool {
    let mut fields = name.splitn(3, '-');
    let kind = fields
        .next()
        .is_some_and(|kind| matches!(kind, "d" | "r" | "a"));
    let time = fields
        .next()
        .is_some_and(|time| time.parse::<f64>().is_ok_and(f64::is_finite));
    kind && time
        && fields
            .next()
            .is_some_and(|ticks| ticks.starts_with(|c: char| c.is_ascii_digit()))
}

/// Number of bytes after the first line; 0 if that line is longer than a header.
fn num_bytes_after_header(path: &Path) -> io::Result<u64> {
    let file = open_regular(path)?;
    let size = file.metadata()?.len();
    let mut header = Vec::new();
    let num_read = BufReader::new(file)
        .take(MAX_HEADER_BYTES)
        .read_until(b'\n', &mut header)?;
    Ok(if header.ends_with(b"\n") {
        size - num_read as u64
    } else {
        0
    })
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    fn session(index: &str, frame: &[u8]) -> tempfile::TempDir {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("INDEX.txt"), index).unwrap();
        fs::write(folder.path().join("d-1.5-90.pgm"), frame).unwrap();
        folder
    }

    fn whole() -> Vec<u8> {
        let mut frame = b"P5 640 480 65535\n".to_vec();
        frame.resize(frame.len() + FRAME_BYTES as usize, 1);
        frame
    }

    #[test]
    fn a_whole_session_passes_and_what_stands_behind_an_empty_line_is_not_played() {
        for (index, num_entries) in [
            ("d-1.5-90.pgm\nd-1.5-90.pgm\n", 2),
            ("d-1.5-90.pgm", 1),
            ("d-1.5-90.pgm\n\nmissing", 1),
        ] {
            let found = check_folder(session(index, &whole()).path()).unwrap();
            assert_eq!(found, num_entries);
        }
    }

    #[test]
    fn whatever_would_end_the_program_is_an_error_that_names_the_file() {
        let cut = &whole()[..5000];
        let endless = vec![b'5'; 2 * FRAME_BYTES as usize];
        for (index, frame, words) in [
            ("d-1.5-90.pgm\nd-2.5-91.pgm\n", whole(), "d-2.5-91.pgm"),
            (
                "d-1.5-90.pgm\n",
                cut.to_vec(),
                "bytes of depth, expected 614400",
            ),
            ("d-1.5-90.pgm\n", endless, "0 bytes of depth"),
            ("d-1.5-90.pgm\n", Vec::new(), "0 bytes of depth"),
            ("../../etc/passwd\n", whole(), "no entry of a session"),
            ("d-now-90.pgm\n", whole(), "no entry of a session"),
        ] {
            let error = check_folder(session(index, &frame).path()).expect_err(words);
            assert!(error.to_string().contains(words), "{error}");
        }
        let empty = tempfile::tempdir().unwrap();
        let error = check_folder(empty.path()).expect_err("no index");
        assert!(error.to_string().contains("INDEX.txt"), "{error}");
    }
}
