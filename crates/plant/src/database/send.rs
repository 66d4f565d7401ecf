//! Sends rows of a history's file to the tables.

use rusqlite::types::Value;
use tokio_postgres::{Transaction, types::ToSql};

use super::{
    cell::CellHistory,
    client::{Database, Link},
    error::{DatabaseError, TransferError},
};
use records::history::{
    Column, ColumnKind, DETAIL_COLUMNS, INSPECTION_COLUMNS, RECIPE_COLUMNS, UnsentRows,
};

/// Maximum number of inspections per transaction: a few megabytes with their thumbnails.
pub const BATCH: usize = 200;

/// Adds the cell, or locks its row until the end of the transaction; affects no row if the cell belongs to another history.
const CLAIM: &str = "INSERT INTO partsight.cell AS there (cell, history) VALUES ($1, $2)
    ON CONFLICT (cell) DO UPDATE SET sent = now() WHERE there.history = excluded.history";

/// True if the table has another inspection under one of the given numbers: an inspection's time and hung part never
/// change.
const IS_COPIED: &str = "SELECT EXISTS (SELECT 1 FROM partsight.inspection AS there
    JOIN unnest($3::bigint[], $4::bigint[], $5::text[]) AS given (number, at, hung) ON there.number = given.number
    WHERE there.cell = $1 AND there.history = $2 AND (there.at <> given.at OR there.hung <> given.hung))";

/// Values of one column.
type Array = Box<dyn ToSql + Sync>;

impl Database {
    /// Sends and commits the rows that `read` returns. `read` is called once no other sender of this history can interfere.
    /// Sending the same rows again changes nothing.
    pub fn send(
        &mut self,
        whose: &CellHistory,
        read: impl FnOnce() -> Result<UnsentRows, TransferError>,
    ) -> Result<UnsentRows, TransferError> {
        let Self { link, client } = self;
        let (cell, history) = (whose.cell.as_str(), whose.history.as_str());
        let transaction = link.wait(client.transaction())?;
        let claimed = link.wait(transaction.execute(CLAIM, &[&cell, &history]))?;
        if claimed == 0 {
            let (database, cell) = (link.address.clone(), whose.cell.clone());
            return Err(DatabaseError::Taken { database, cell }.into());
        }
        let rows = read()?;
        refuse_copy(link, &transaction, whose, &rows.inspections)?;
        for (table, columns, rows) in [
            ("recipe", &RECIPE_COLUMNS[..], &rows.recipes),
            ("inspection", &INSPECTION_COLUMNS[..], &rows.inspections),
            ("detail", &DETAIL_COLUMNS[..], &rows.details),
        ] {
            let mut values = identity_of(whose);
            for (index, (_, kind)) in columns.iter().enumerate() {
                values.push(array(*kind, rows, index));
            }
            let statement = upsert(table, columns);
            link.wait(transaction.execute(statement.as_str(), &borrowed(&values)))?;
        }
        link.wait(transaction.commit())?;
        Ok(rows)
    }

    /// Gives the cell's name to this history. What the previous history sent under it stays.
    pub fn take_over(&mut self, whose: &CellHistory) -> Result<(), DatabaseError> {
        let (cell, history) = (whose.cell.as_str(), whose.history.as_str());
        let statement = "UPDATE partsight.cell SET history = $2, since = now() WHERE cell = $1";
        self.link
            .wait(self.client.execute(statement, &[&cell, &history]))
            .map(|_| ())
    }
}

fn refuse_copy(
    link: &Link,
    transaction: &Transaction<'_>,
    whose: &CellHistory,
    inspections: &[Vec<Value>],
) -> Result<(), DatabaseError> {
    let mut values = identity_of(whose);
    // `number`, `at` and `hung` come in this order among the columns.
    for (index, (name, kind)) in INSPECTION_COLUMNS.iter().enumerate() {
        if ["number", "at", "hung"].contains(name) {
            values.push(array(*kind, inspections, index));
        }
    }
    let row = link.wait(transaction.query_one(IS_COPIED, &borrowed(&values)))?;
    if matches!(row.try_get(0), Ok(false)) {
        return Ok(());
    }
    Err(DatabaseError::Copied {
        database: link.address.clone(),
        cell: whose.cell.clone(),
    })
}

/// The first two parameters of every statement about a history.
fn identity_of(whose: &CellHistory) -> Vec<Array> {
    vec![
        Box::new(whose.cell.to_string()),
        Box::new(whose.history.clone()),
    ]
}

/// The statement that adds rows or updates those that have changed. Its parameters are the cell, the history, and an array
/// for each column.
fn upsert(table: &str, columns: &[Column]) -> String {
    let names = |of: &str| {
        let names = columns.iter().map(|(name, _)| format!("{of}{name}"));
        names.collect::<Vec<_>>().join(", ")
    };
    let arrays = (3..).zip(columns).map(|(number, (_, kind))| {
        let kind = match kind {
            ColumnKind::Boolean => "boolean",
            ColumnKind::Integer => "bigint",
            ColumnKind::Real => "double precision",
            ColumnKind::Text => "text",
            ColumnKind::Bytes => "bytea",
        };
        format!("${number}::{kind}[]")
    });
    let arrays = arrays.collect::<Vec<_>>().join(", ");
    let set = columns
        .iter()
        .map(|(name, _)| format!("{name} = excluded.{name}"));
    let set = set.collect::<Vec<_>>().join(", ");
    format!(
        "INSERT INTO partsight.{table} AS there (cell, history, {})
        SELECT $1::text, $2::text, given.* FROM unnest({arrays}) AS given
        ON CONFLICT (cell, history, {}) DO UPDATE SET {set}, changed = now()
        WHERE ROW({}) IS DISTINCT FROM ROW({})",
        names(""),
        columns[0].0,
        names("there."),
        names("excluded.")
    )
}

/// The values of one column of the rows.
fn array(kind: ColumnKind, rows: &[Vec<Value>], index: usize) -> Array {
    let values = rows.iter().map(|row| row.get(index));
    match kind {
        ColumnKind::Boolean => {
            let values = values.map(|value| integer(value).map(|value| value != 0));
            Box::new(values.collect::<Vec<Option<bool>>>())
        }
        ColumnKind::Integer => Box::new(values.map(integer).collect::<Vec<Option<i64>>>()),
        ColumnKind::Real => Box::new(values.map(real).collect::<Vec<Option<f64>>>()),
        ColumnKind::Text => Box::new(values.map(text).collect::<Vec<Option<String>>>()),
        ColumnKind::Bytes => Box::new(values.map(bytes).collect::<Vec<Option<Vec<u8>>>>()),
    }
}

fn integer(value: Option<&Value>) -> Option<i64> {
    match value? {
        Value::Integer(number) => Some(*number),
        _ => None,
    }
}

fn real(value: Option<&Value>) -> Option<f64> {
    match value? {
        Value::Real(number) => Some(*number),
        Value::Integer(number) => Some(*number as f64),
        _ => None,
    }
}

/// PostgreSQL's text cannot contain the character U+0000.
fn text(value: Option<&Value>) -> Option<String> {
    match value? {
        Value::Text(text) => Some(text.replace('\0', "\u{fffd}")),
        _ => None,
    }
}

fn bytes(value: Option<&Value>) -> Option<Vec<u8>> {
    match value? {
        Value::Blob(bytes) => Some(bytes.clone()),
        _ => None,
    }
}

pub(super) fn borrowed(values: &[Array]) -> Vec<&(dyn ToSql + Sync)> {
    values
        .iter()
        .map(|value| &**value as &(dyn ToSql + Sync))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_statement_names_every_column_and_changes_only_what_differs() {
        assert_eq!(
            upsert("recipe", &RECIPE_COLUMNS),
            "INSERT INTO partsight.recipe AS there (cell, history, identity, json)
        SELECT $1::text, $2::text, given.* FROM unnest($3::text[], $4::text[]) AS given
        ON CONFLICT (cell, history, identity) DO UPDATE SET identity = excluded.identity, json = excluded.json, changed = now()
        WHERE ROW(there.identity, there.json) IS DISTINCT FROM ROW(excluded.identity, excluded.json)"
        );
    }

    #[test]
    fn values_keep_their_kind_and_a_letter_that_cannot_be_kept_is_replaced() {
        assert_eq!(real(Some(&Value::Integer(3))), Some(3.0));
        assert_eq!(real(Some(&Value::Null)), None);
        assert_eq!(integer(None), None);
        let hostile = Value::Text("a\0b'; --".into());
        assert_eq!(text(Some(&hostile)), Some("a\u{fffd}b'; --".into()));
        assert_eq!(bytes(Some(&Value::Blob(vec![0, 255]))), Some(vec![0, 255]));
    }
}
