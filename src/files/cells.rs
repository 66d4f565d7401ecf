//! Lines of numbers as spreadsheets and people write them: cells between semicolons, commas, tabs or spaces.

use super::scalar::parse_real;

/// The cells of a line. Only between semicolons or commas can one be empty.
pub(crate) fn cells(line: &str) -> Box<dyn Iterator<Item = &str> + '_> {
    let separator = [';', ',']
        .into_iter()
        .find(|&separator| line.contains(separator));
    match separator {
        // "1, 2, 3" has commas and spaces; "1,2,3 4" does not occur.
        Some(separator) => Box::new(line.split(separator).map(str::trim)),
        None => Box::new(line.split_whitespace()),
    }
}

/// The number in a cell of this line. Beside semicolons a comma is a decimal one, as in half of Europe.
pub(crate) fn number_in(line: &str, cell: &str) -> Option<f64> {
    if line.contains(';') {
        parse_real(&cell.replace(',', "."))
    } else {
        parse_real(cell)
    }
}

/// The lines that are neither empty nor comments, with their number from 1.
pub(crate) fn content_lines(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let lines = text.lines().enumerate();
    lines
        .map(|(i, line)| (i + 1, line.trim()))
        .filter(|(_, line)| !line.is_empty() && !line.starts_with('#') && !line.starts_with("//"))
}
