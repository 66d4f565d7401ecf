//! Tables as spreadsheets and people write them: rows of cells between semicolons, commas, tabs or spaces.

use std::borrow::Cow;
use std::path::Path;

use super::error::FileError;
use super::scalar::parse_real;
use super::source::Source;

/// A longer line is no row of a table.
pub(super) const MAX_ROW_BYTES: usize = 1 << 16;
/// Cells of a row at most.
pub(super) const MAX_COLUMNS: usize = 1000;
/// What the error says of more.
const ROW: &str = "a row of at most 1000 cells and 65536 bytes";

/// One line of a table; what parts its cells is looked for once.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Row<'a> {
    text: &'a str,
    /// `None` for spaces and tabs.
    separator: Option<char>,
}

impl<'a> Row<'a> {
    pub(crate) fn of(text: &'a str) -> Self {
        // "1, 2, 3" has commas and spaces; "1,2,3 4" does not occur.
        let mut known = [';', ','].into_iter();
        Self {
            text,
            separator: known.find(|&separator| text.contains(separator)),
        }
    }

    /// The line as it stands.
    pub(crate) fn text(self) -> &'a str {
        self.text
    }

    /// The cells. Only between semicolons or commas can one be empty.
    pub(crate) fn cells(self) -> impl Iterator<Item = &'a str> {
        let separator = self.separator;
        let parted = separator.map(|separator| self.text.split(separator).map(str::trim));
        let spaced = separator.is_none().then(|| self.text.split_whitespace());
        parted
            .into_iter()
            .flatten()
            .chain(spaced.into_iter().flatten())
    }

    /// The number in a cell of this row. Beside semicolons a comma is a decimal one, as in half of Europe.
    pub(crate) fn number(self, cell: &str) -> Option<f64> {
        if self.separator == Some(';') {
            parse_real(&cell.replace(',', "."))
        } else {
            parse_real(cell)
        }
    }

    /// The same again if it has no more than a row may have.
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

/// The lines of a table that are neither empty nor comments, with their number from 1; `path` is for the errors.
pub(crate) fn table_rows<'a>(
    text: &'a str,
    path: &Path,
) -> Result<Vec<(usize, Row<'a>)>, FileError> {
    let source = Source {
        path,
        bytes: text.as_bytes(),
    };
    let lines = text.lines().enumerate();
    lines
        .map(|(i, line)| (i + 1, line.trim()))
        .filter(|(_, line)| !line.is_empty() && !line.starts_with('#') && !line.starts_with("//"))
        .map(|(number, line)| Ok((number, Row::of(line).limited(source, number)?)))
        .collect()
}

/// True for what a spreadsheet would run as a formula; a number with a sign is none.
fn is_formula(text: &str) -> bool {
    text.starts_with(['=', '+', '-', '@', '\t', '\r']) && text.trim().parse::<f64>().is_err()
}

/// A text inside a comment of a CSV file, which spreadsheets take for a row like any other.
pub(crate) fn csv_comment(text: &str) -> String {
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

/// A text as a cell of a CSV file, quoted as RFC 4180 has it. One that a spreadsheet would run as a formula gets an
/// apostrophe before it, which spreadsheets take for "this is text".
pub(crate) fn csv_text(text: &str) -> Cow<'_, str> {
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
