//! Names of cells, and the histories sent under them.

use std::{fmt, str::FromStr};

use thiserror::Error;

use geometry::error::Advice;

/// Name of a cell in the plant's database, one line of at most 64 characters.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct CellName(String);

/// Longest name, characters.
const MAX_LETTERS: usize = 64;

/// A text is not a valid name of a cell.
#[derive(Clone, Debug, PartialEq, Eq, Error, Advice)]
#[error("{name:?} is not a valid name of a cell")]
#[advice = "Give 1 to {MAX_LETTERS} letters on one line, without blanks at the ends"]
pub struct BadCellName {
    name: String,
}

impl FromStr for CellName {
    type Err = BadCellName;

    fn from_str(name: &str) -> Result<Self, BadCellName> {
        let is_good = (1..=MAX_LETTERS).contains(&name.chars().count())
            && name.trim() == name
            && !name.contains(char::is_control);
        let name = name.to_owned();
        if is_good {
            Ok(Self(name))
        } else {
            Err(BadCellName { name })
        }
    }
}

impl CellName {
    /// The name as text.
    pub fn as_str(&self) -> &str {
        &self.0
    }
}

impl fmt::Display for CellName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

/// A history and the name of its cell.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CellHistory {
    /// The cell.
    pub cell: CellName,
    /// The history's identity, from `History::note_changes`.
    pub history: String,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cell_may_be_called_anything_that_fits_on_a_line() {
        let longest = "七".repeat(MAX_LETTERS);
        for name in ["cell7", "Halle 3, Zelle 7", "'; DROP TABLE x; --", &longest] {
            let read: CellName = name.parse().expect(name);
            assert_eq!(read.to_string(), name);
        }
        for name in ["", " ", " a", "a\n", "a\0b", &format!("{longest}a")] {
            let error = name.parse::<CellName>().expect_err(name);
            assert!(error.advice().contains("64"), "{error}");
        }
    }
}
