//! The files of a program: written whole, split if too long, and removed before the next.

use std::{
    fs,
    io::Read as _,
    path::{Path, PathBuf},
};

use super::{
    MARK, Program, ProgramError, RobotLanguage,
    language::{Calls, Step},
    steps,
    text::{self, Lines},
};
use files::{FileError, crc32, disk, folder_of, open_regular, write_text};

/// The text of a program, and of the programs that it calls if one would be too long.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ProgramTexts {
    /// The main program, which has the file's name.
    pub main: String,
    /// Names and texts of the called programs, in order.
    pub parts: Vec<(String, String)>,
}

/// No program of ours is longer, bytes.
const MAX_BYTES: u64 = 64 << 20;
/// Hexadecimal digits of the checksum in the name of a part, as in `paint_1a2b3c4d_2`.
const CHECKSUM_DIGITS: usize = 8;

/// Removes an earlier program of this name, then the parts that it called, so that no robot runs it for the next part.
/// Returns true if there was one. Other files of these names stay.
pub fn remove_previous_program(path: &Path) -> Result<bool, FileError> {
    let mut is_found = false;
    let main = std::iter::once(path.to_owned());
    for path in main.chain(parts_beside(path)) {
        if is_own_program(&path) {
            disk::remove_file(&path).map_err(|source| FileError::writing(&path, source))?;
            is_found = true;
        }
    }
    Ok(is_found)
}

fn is_own_program(path: &Path) -> bool {
    let mut bytes = Vec::new();
    let read = open_regular(path).and_then(|file| file.take(MAX_BYTES).read_to_end(&mut bytes));
    // If it cannot be read, writing the next program will report the error.
    read.is_ok()
        && bytes
            .windows(MARK.len())
            .any(|part| part == MARK.as_bytes())
}

/// Files beside a program that are named like its parts, including those of an interrupted save.
fn parts_beside(path: &Path) -> Vec<PathBuf> {
    let is_named_so = |file: &Path| {
        let (name, stem) = (file.file_stem()?.to_str()?, path.file_stem()?.to_str()?);
        let numbers = name.strip_prefix(stem)?.strip_prefix('_')?;
        let (checksum, number) = numbers.split_once('_')?;
        let is_checksum =
            checksum.len() == CHECKSUM_DIGITS && checksum.bytes().all(|c| c.is_ascii_hexdigit());
        let is_number = !number.is_empty() && number.bytes().all(|c| c.is_ascii_digit());
        Some(is_checksum && is_number && file.extension() == path.extension())
    };
    let entries = fs::read_dir(folder_of(path));
    let files = entries.into_iter().flatten().flatten();
    let mut files: Vec<PathBuf> = files
        .map(|entry| entry.path())
        .filter(|file| is_named_so(file) == Some(true))
        .collect();
    files.sort();
    files
}

/// The path of a file in the same folder with the same ending.
pub(super) fn beside(path: &Path, name: &str) -> PathBuf {
    let mut file = path.with_file_name(name);
    if let Some(ending) = path.extension() {
        file.set_extension(ending);
    }
    file
}

impl RobotLanguage {
    /// Finds a language by the file's ending.
    pub fn from_file(path: &Path) -> Result<&'static Self, ProgramError> {
        let ending = path.extension().unwrap_or_default();
        let mut all = Self::ALL.into_iter();
        all.find(|language| ending.eq_ignore_ascii_case(language.ending))
            .ok_or_else(|| ProgramError::UnknownEnding {
                path: path.to_owned(),
            })
    }
}

impl Program<'_> {
    /// Writes the program, whole or not at all, with the file's name as its own. Programs that it calls are written
    /// beside it first; returns their number.
    pub fn save(
        &self,
        path: &Path,
        language: &'static RobotLanguage,
    ) -> Result<usize, ProgramError> {
        let name = path.file_stem().unwrap_or_default().to_string_lossy();
        let ProgramTexts { main, parts } = self.texts(language, &name)?;
        if !parts.is_empty() {
            // While the parts are written, there must be no main program that calls them.
            remove_previous_program(path)?;
        }
        let mut all = parts.iter();
        let saved = all
            .try_for_each(|(name, text)| write_text(&beside(path, name), text))
            .and_then(|()| write_text(path, &main));
        if saved.is_err() && !parts.is_empty() {
            // If this fails too, they are removed before the next program is written.
            drop(remove_previous_program(path));
        }
        saved?;
        Ok(parts.len())
    }

    /// Returns the program's text, split into several programs if one would be too long.
    pub fn texts(
        &self,
        language: &'static RobotLanguage,
        name: &str,
    ) -> Result<ProgramTexts, ProgramError> {
        self.check(language, name)?;
        let mut steps = self.steps(language);
        let header = self.header(language, &steps);
        let whole = self.write(language, &steps, &header, name);
        let calls = language.calls.as_ref();
        let is_too_long = |calls: &&Calls| whole.num_instructions() > calls.max_instructions;
        let Some(calls) = calls.filter(is_too_long) else {
            return Ok(ProgramTexts {
                main: whole.finish(language.line_end),
                parts: Vec::new(),
            });
        };
        if self.settings.tracking.is_some() {
            return Err(ProgramError::TrackedTooMany {
                language,
                found: whole.num_instructions(),
                most: calls.max_instructions,
            });
        }
        let checksum = crc32(whole.finish(language.line_end).as_bytes());
        let called = |number: usize| format!("{name}_{checksum:08x}_{number}");
        let header_of = |number: usize, all: usize| {
            let mut header = header.clone();
            let line = format!("part {number} of {all}, called by {name}, not by itself");
            header.insert(1, line);
            header
        };
        // With larger numbers than there will be, so that no header is longer.
        let most = calls.max_instructions;
        let empty = self.write(language, &[], &header_of(most, most), name);
        // A job of JBI may have to wait for its last move.
        let most = most.saturating_sub(empty.num_instructions() + 1);
        let ranges =
            steps::split(&mut steps, calls, most).map_err(|found| ProgramError::TooMany {
                language,
                found,
                most,
            })?;
        let names: Vec<String> = (1..=ranges.len()).map(called).collect();
        let longest = names.last().map_or(0, String::len);
        if longest > language.max_name {
            return Err(ProgramError::Name {
                language,
                name: called(ranges.len()),
                most: language.max_name.saturating_sub(longest - name.len()),
            });
        }
        let comments = text::comments(&header, language.comment_width);
        let main = (calls.write)(self, &names, &comments, name);
        let texts = ranges.iter().zip(&names).enumerate();
        let texts = texts.map(|(i, (range, name))| {
            let header = header_of(i + 1, ranges.len());
            self.write(language, &steps[range.clone()], &header, name)
                .finish(language.line_end)
        });
        Ok(ProgramTexts {
            main: main.finish(language.line_end),
            parts: names.iter().cloned().zip(texts).collect(),
        })
    }

    fn write(
        &self,
        language: &RobotLanguage,
        steps: &[Step],
        header: &[String],
        name: &str,
    ) -> Lines {
        let comments = text::comments(header, language.comment_width);
        (language.write)(self, steps, &comments, name)
    }
}
