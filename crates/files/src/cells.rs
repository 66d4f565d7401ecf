//! Tables from spreadsheets and from people: rows of cells separated by semicolons, commas, tabs or spaces.

use std::borrow::Cow;
use std::path::Path;

use super::error::FileError;
use super::scalar::parse_real;
use super::source::Source;

/// The longest row of a table that is read, in bytes.
pub(super) const MAX_ROW_BYTES: usize = 1 << 16;
/// The most cells of a row that are read.
pub(super) const MAX_COLUMNS: usize = 1000;
/// The limits above, as error messages state them.
const ROW: &str = "a row of at most 1000 cells and 65536 bytes";

/// One line of a table, with its separator found once.
#[derive(Clone, Copy, Debug)]
pub struct Row<'a> {
    text: &'a str,
    /// `None` for spaces and tabs.
    separator: Option<char>,
}

impl<'a> Row<'a> {
    pub fn new(text: &'a str) -> Self {
        // "1, 2, 3" has commas and spaces; "1,2,3 4" does not occur.
        let mut known = [';', ','].into_iter();
        Self {
            text,
            separator: known.find(|&separator| text.contains(separator)),
        }
    }

    /// Returns the whole line.
    pub fn text(self) -> &'a str {
        self.text
    }

    /// Returns the cells. A cell can be empty only between semicolons or commas.
    pub fn cells(self) -> impl Iterator<Item = &'a str> {
        let separator = self.separator;
        let parted = separator.map(|separator| self.text.split(separator).map(str::trim));
        let spaced = separator.is_none().then(|| self.text.split_whitespace());
        parted
            .into_iter()
            .flatten()
            .chain(spaced.into_iter().flatten())
    }

    /// Parses a cell of this row as a number. In rows with semicolons a comma is a decimal comma, as in much of Europe.
    pub fn number(self, cell: &str) -> Option<f64> {
        if self.separator == Some(';') {
            parse_real(&cell.replace(',', "."))
        } else {
            parse_real(cell)
        }
    }

    /// Returns the row if it is within the limits for bytes and cells.
    pub(super) fn limited(self, source: Source<'_>, line: usize) -> Result<Self, FileError> {
        let num_bytes = self.text.len();
        let is_row = num_bytes <= MAX_ROW_BYTES
            && (num_bytes < MAX_COLUMNS || self.cells().nth(MAX_COLUMNS).is_none());
        if is_row {
            Ok(self)
        } else {
            Err(source.malformed(line, self.text, ROW))
        }
    }
}

/// Returns the lines of a table that are neither empty nor comments, with their numbers from 1. `path` is for errors.
pub fn table_rows<'a>(text: &'a str, path: &Path) -> Result<Vec<(usize, Row<'a>)>, FileError> {
    let source = Source {
        path,
        bytes: text.as_bytes(),
    };
    let lines = text.lines().enumerate();
    lines
        .map(|(i, line)| (i + 1, line.trim()))
        .filter(|(_, line)| !line.is_empty() && !line.starts_with('#') && !line.starts_with("//"))
        .map(|(number, line)| Ok((number, Row::new(line).limited(source, number)?)))
        .collect()
}

/// Returns true if a spreadsheet would run the text as a formula; a signed number is not a formula.
fn is_formula(text: &str) -> bool {
    text.starts_with(['=', '+', '-', '@', '\t', '\r']) && text.trim().parse::<f64>().is_err()
}

/// Escapes a text for a comment of a CSV file, which spreadsheets read as an ordinary row.
pub fn csv_comment(text: &str) -> String {
    let mut shown = String::with_capacity(text.len());
    for (i, piece) in text
        .split_inclusive([',', ';', '\t', '\n', '\r'])
        .enumerate()
    {
        if i > 0 && is_formula(piece.trim_start()) {
            shown.push('\'');
        }
        shown.extend(piece.chars().map(|c| if c.is_control() { ' ' } else { c }));
    }
    shown
}

/// Escapes a text for a cell of a CSV file, quoted as in RFC 4180. A text that a spreadsheet would run as a formula gets
/// an apostrophe before it, which spreadsheets read as "this is text".
pub fn csv_text(text: &str) -> Cow<'_, str> {
    let is_formula = is_formula(text);
    let is_quoted = text.contains([',', '"', '\n', '\r']);
    match (is_formula, is_quoted) {
        (false, false) => text.into(),
        (true, false) => format!("'{text}").into(),
        (_, true) => {
            let mark = if is_formula { "'" } else { "" };
            format!("\"{mark}{}\"", text.replace('"', "\"\"")).into()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_row_beyond_the_limits_is_named_by_its_line() {
        let path = Path::new("table.csv");
        let wide = "1;".repeat(MAX_COLUMNS);
        let long = format!("{} 2", "1".repeat(MAX_ROW_BYTES));
        for bad in [wide, long] {
            let text = format!("# a comment\n1;2;3\n{bad}\n");
            let error = table_rows(&text, path).expect_err("too much");
            assert!(
                matches!(error, FileError::Malformed { line: 3, .. }),
                "{error}"
            );
            assert!(error.to_string().len() < 300, "{error}");
        }
        let most = "1;".repeat(MAX_COLUMNS - 1) + "1";
        let rows = table_rows(&most, path).expect("as many as may be");
        assert_eq!(rows[0].1.cells().count(), MAX_COLUMNS);
    }

    #[test]
    fn a_text_that_begins_a_formula_is_marked_as_text() {
        for (text, expected) in [
            ("door.pcd", "door.pcd"),
            ("a \"b\", c", "\"a \"\"b\"\", c\""),
            ("two\nlines", "\"two\nlines\""),
            ("=1+1", "'=1+1"),
            ("+49 123", "'+49 123"),
            ("-dash", "'-dash"),
            ("@SUM(A1)", "'@SUM(A1)"),
            (
                "=HYPERLINK(\"x\",\"y\")",
                "\"'=HYPERLINK(\"\"x\"\",\"\"y\"\")\"",
            ),
            ("\t=1", "'\t=1"),
            ("-0.25", "-0.25"),
            ("+1e-3", "+1e-3"),
        ] {
            assert_eq!(csv_text(text), expected);
        }
        assert_eq!(csv_comment("a,=1+1\n=2;b, -x"), "a,'=1+1 '=2;b,' -x");
    }
}
