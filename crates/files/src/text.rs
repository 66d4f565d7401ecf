//! Reading of text files that people write, up to a limit; and text from files made safe for terminals.

use std::{borrow::Cow, fmt::Write as _, path::Path};

use serde::{Deserialize, de::DeserializeOwned};

use super::{FileError, read_limited};

/// Reads a text file of at most `limit` bytes, without a byte order mark.
pub fn read_text(path: &Path, limit: u64) -> Result<String, FileError> {
    let bytes = read_limited(path, limit)?;
    let text = String::from_utf8(bytes).map_err(|error| FileError::Damaged {
        path: path.to_owned(),
        what: format!(
            "it is not text: byte {} is no UTF-8",
            error.utf8_error().valid_up_to() + 1
        ),
    })?;
    Ok(match text.strip_prefix('\u{feff}') {
        Some(rest) => rest.to_owned(),
        None => text,
    })
}

/// The version of a file's format, whatever the format calls it.
#[derive(Deserialize)]
struct Versioned {
    #[serde(default, alias = "schema_version", alias = "partsight_recording")]
    schema: u32,
}

impl Versioned {
    fn check(self, path: &Path, known: u32) -> Result<(), FileError> {
        if self.schema > known {
            return Err(FileError::Newer {
                path: path.to_owned(),
                found: self.schema,
                known,
            });
        }
        Ok(())
    }
}

/// Parses the TOML of a file whose version is at most `known`. What is no such TOML is `bad`.
pub fn parse_toml<T: DeserializeOwned, E: From<FileError>>(
    path: &Path,
    text: &str,
    known: u32,
    bad: impl Fn(toml::de::Error) -> E,
) -> Result<T, E> {
    let versioned: Versioned = toml::from_str(text).map_err(&bad)?;
    versioned.check(path, known)?;
    toml::from_str(text).map_err(bad)
}

/// Parses the JSON of a file whose version is at most `known`. What is no such JSON is `bad`.
pub fn parse_json<T: DeserializeOwned, E: From<FileError>>(
    path: &Path,
    json: &[u8],
    known: u32,
    bad: impl Fn(serde_json::Error) -> E,
) -> Result<T, E> {
    let versioned: Versioned = serde_json::from_slice(json).map_err(&bad)?;
    versioned.check(path, known)?;
    serde_json::from_slice(json).map_err(bad)
}

/// What is wrong with a TOML text, in one line, after the number of its line from 1.
pub fn toml_problem(text: &str, error: &toml::de::Error) -> String {
    let what = error.message().lines().next().unwrap_or_default();
    let before = error.span().and_then(|span| text.get(..span.start));
    match before {
        Some(before) => format!("line {}: {what}", before.matches('\n').count() + 1),
        None => what.to_owned(),
    }
}

/// A text from a file, or a file's name, for a terminal: control characters, which could move the cursor or recolour what
/// stands before, and marks that turn the direction of writing are shown as `\u001b`, which JSON reads as the same
/// character.
pub fn visible(text: &str) -> Cow<'_, str> {
    let is_hidden = |c: char| {
        c.is_control()
            || matches!(c, '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
    };
    if !text.contains(is_hidden) {
        return text.into();
    }
    let mut shown = String::with_capacity(text.len() + 16);
    for c in text.chars() {
        if is_hidden(c) {
            // Writing to memory cannot fail.
            let _ = write!(shown, "\\u{:04x}", u32::from(c));
        } else {
            shown.push(c);
        }
    }
    shown.into()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_would_steer_a_terminal_is_shown_in_letters() {
        assert_eq!(visible("tür 2.pcd"), "tür 2.pcd");
        assert_eq!(
            visible("a\u{1b}[2Jb\n\u{9b}31m\u{7f}\u{202e}"),
            "a\\u001b[2Jb\\u000a\\u009b31m\\u007f\\u202e"
        );
        let json = serde_json::to_string("a\u{9b}b\u{202e}").expect("JSON");
        let read: String = serde_json::from_str(&visible(&json)).expect("still JSON");
        assert_eq!(read, "a\u{9b}b\u{202e}");
    }
}
