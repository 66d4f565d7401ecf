//! Text files that people write: whole in memory, with a limit.

use std::path::Path;

use super::{FileError, read_bytes};

/// The text of a file of at most `limit` bytes, without a byte order mark.
pub(crate) fn read_text(path: &Path, limit: u64) -> Result<String, FileError> {
    let bytes = read_bytes(path)?;
    if bytes.len() as u64 > limit {
        return Err(FileError::TextTooLong {
            path: path.to_owned(),
            found: bytes.len() as u64,
            limit,
        });
    }
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
