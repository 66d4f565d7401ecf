//! Inspections as comma-separated values.

use std::{
    io::{self, Write},
    path::Path,
};

use super::{entry::Record, error::HistoryError};
use files::{FileError, write_atomically};
use inspection::{
    library::Truth,
    pipeline::{ExpectedPart, RefusalKind},
};
use texts::Language;

/// Header line.
const HEAD: &str = "number,time,scene,source,simulated,verdict,part,nearest,score,margin,reason,total_ms,\
    label,remark,recipe,library,program,parent,reinspections,\
    m00,m01,m02,m03,m10,m11,m12,m13,m20,m21,m22,m23,m30,m31,m32,m33,recipe_name,recipe_changed,\
    serial,order,operator,reason_kind,robot_doubts,motion_checked,rack,expected,missing,place,place_number";

/// Writes the inspections that `each` passes on into this file, and returns their number. If one cannot be read, the
/// file stays as it was.
///
/// Times are UTC; `parent` is the number of the inspection that stands for the same part, `reinspections` the number of
/// re-inspections below it; m00..m33 are `camera_from_part` in row-major order, metres. Of what was expected in a frame, one of its
/// lines alone says what was missing.
pub fn write_table(
    path: &Path,
    each: impl FnOnce(&mut dyn FnMut(Record) -> Result<(), HistoryError>) -> Result<(), HistoryError>,
) -> Result<usize, HistoryError> {
    let mut table = Table::new("");
    each(&mut |record| table.add(path, &record, ""))?;
    table.write(path)
}

/// As [`write_table`] for several cells, with the name of the cell in the last column.
pub fn write_cells_table<E: From<HistoryError>>(
    path: &Path,
    each: impl FnOnce(&mut dyn FnMut(&str, Record) -> Result<(), E>) -> Result<(), E>,
) -> Result<usize, E> {
    let mut table = Table::new(",cell");
    each(&mut |cell: &str, record: Record| {
        let cell = format!(",{}", quoted(cell));
        table.add(path, &record, &cell).map_err(E::from)
    })?;
    Ok(table.write(path)?)
}

/// The lines so far.
struct Table {
    text: Vec<u8>,
    num: usize,
}

impl Table {
    /// Creates a table with additional columns, each preceded by a comma.
    fn new(columns: &str) -> Self {
        Self {
            text: format!("{HEAD}{columns}\n").into_bytes(),
            num: 0,
        }
    }

    /// Adds a line; `columns` are the additional fields, each preceded by a comma.
    fn add(&mut self, path: &Path, record: &Record, columns: &str) -> Result<(), HistoryError> {
        self.num += 1;
        let written = write_row(&mut self.text, record, columns);
        written.map_err(|error| FileError::writing(path, error).into())
    }

    fn write(self, path: &Path) -> Result<usize, HistoryError> {
        write_atomically(path, |writer| writer.write_all(&self.text))?;
        Ok(self.num)
    }
}

fn write_row(writer: &mut dyn Write, record: &Record, columns: &str) -> io::Result<()> {
    let Record { summary, detail } = record;
    let [score, margin] = summary
        .score
        .map_or_else(Default::default, |both| both.map(|x| format!("{x:.4}")));
    let reason = record.titled_refusal(str::to_owned);
    let reason = reason.map_or_else(String::new, |why| why.text(Language::English));
    let kind = summary.reason.as_ref().map_or("", RefusalKind::name);
    let pose = match record.matrix() {
        Some(numbers) => numbers.map(|x| format!(",{x:.9}")).concat(),
        None => ",".repeat(16),
    };
    let recipe = &detail.recipe_label;
    let recipe = format!("{},{}", quoted(&recipe.name), recipe.is_changed);
    let label = summary.label.as_ref().map_or("", Truth::name);
    let trace = &summary.trace;
    let [serial, order, operator] =
        [&trace.serial, &trace.order, &trace.operator].map(|text| quoted(text));
    let marks = summary.robot_marks();
    let doubts = marks.robot_doubts.join(" ");
    let motion_checked = marks
        .motion_checked
        .map_or("", |is| if is { "true" } else { "false" });
    let rack = quoted(summary.rack.as_deref().unwrap_or(""));
    // As in a table of orders.
    let cell = |parts: &[ExpectedPart]| {
        let parts = parts.iter().cloned().map(String::from);
        quoted(&parts.collect::<Vec<_>>().join("|"))
    };
    let expected = cell(detail.expected().parts());
    let missing = cell(&detail.missing().unwrap_or_default());
    let place = quoted(&detail.place().unwrap_or_default());
    let place_number = detail.place_number().map(|number| number.to_string());
    let place_number = place_number.unwrap_or_default();
    writeln!(
        writer,
        "{},{},{},{},{},{},{},{},{score},{margin},{},{:.3},{},{},{},{},{},{},{}{pose},{recipe},{serial},{order},{operator},{kind},{doubts},{motion_checked},{rack},{expected},{missing},{place},{place_number}{columns}",
        summary.number,
        summary.at,
        quoted(&summary.scene.to_string()),
        quoted(&summary.source),
        summary.is_simulated,
        summary.verdict.name(),
        summary.part.as_deref().unwrap_or(""),
        detail.nearest.as_deref().unwrap_or(""),
        quoted(&reason),
        summary.total_ms,
        label,
        quoted(&summary.remark),
        detail.recipe_identity,
        detail.library_identity,
        detail.program,
        summary
            .parent
            .map_or_else(String::new, |number| number.to_string()),
        summary.num_below,
    )
}

/// Quotes a field according to RFC 4180.
fn quoted(text: &str) -> String {
    files::csv_text(text).into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_field_with_a_comma_or_a_quote_is_quoted() {
        assert_eq!(quoted("a \"b\", c"), "\"a \"\"b\"\", c\"");
        assert_eq!(quoted("plain"), "plain");
        assert_eq!(quoted("two\nlines"), "\"two\nlines\"");
    }
}
