//! Reads the histories of all cells from the database.

use std::fmt::Write as _;

use jiff::Timestamp;
use rusqlite::types::Value;
use tokio_postgres::{
    Row,
    types::{FromSql, ToSql},
};

use super::{cell::CellName, client::Database, error::DatabaseError, send::borrowed};
use records::history::{
    Column, ColumnKind, DETAIL_COLUMNS, Filter, INSPECTION_COLUMNS, RECIPE_COLUMNS, Record,
    RowReader, Summary,
};

/// Rows per query.
const READ_AT_ONCE: i64 = 500;

/// Position of `at` among the columns of an inspection.
const AT: usize = 1;

/// Number of re-inspections below an inspection.
const NUM_BELOW: &str = "(SELECT count(*) FROM partsight.inspection AS other
    WHERE other.cell = there.cell AND other.history = there.history AND other.parent = there.number)";

/// A list of inspections, newest first, with counts.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CellPage {
    /// The listed inspections, each with the name of its cell.
    pub rows: Vec<(String, Summary)>,
    /// Counts of every cell, or of the one asked for, ordered by name.
    pub cells: Vec<CellCount>,
    /// Number of all hung parts, whatever the filter.
    pub num_all: usize,
}

/// What a cell has sent.
#[derive(Clone, Debug, PartialEq)]
pub struct CellCount {
    /// Name of the cell.
    pub cell: String,
    /// When it last sent something.
    pub sent: Timestamp,
    /// Number of rows that pass the filter.
    pub num_matching: usize,
    /// Number of accepted ones among them.
    pub num_accepted: usize,
}

/// An inspection of a cell.
#[derive(Clone, Debug)]
pub struct CellRecord {
    /// Name of the cell.
    pub cell: String,
    /// Identity of the history that the inspection comes from.
    pub history: String,
    /// The inspection, without its thumbnail.
    pub record: Record,
    /// Its time as the database has it: the record has another one if this is out of range.
    at: i64,
}

/// An SQL condition and the values of its parameters.
struct Condition {
    sql: String,
    values: Vec<Box<dyn ToSql + Sync>>,
}

impl Condition {
    /// The condition for rows of the alias `there`.
    fn of(filter: &Filter, cell: Option<&CellName>) -> Self {
        let (sqlite, given) = filter.condition();
        // Translate expressions that are written differently in SQLite.
        let named = sqlite.replace("instr(search, ?)", "strpos(search, ?) > 0");
        let named = named.replace("simulated = ?", "simulated::integer::bigint = ?");
        let mut sql = String::new();
        for (number, piece) in named.split('?').enumerate() {
            if number > 0 {
                write!(sql, "${number}").expect("a string takes everything");
            }
            sql.push_str(piece);
        }
        if given.is_empty() && sql == "1" {
            sql = "TRUE".into();
        }
        let mut condition = Self {
            sql,
            values: given.into_iter().map(boxed).collect(),
        };
        if let Some(cell) = cell {
            condition.and("cell", cell.to_string());
        }
        condition
    }

    /// Also demands this value of a column of the inspection.
    fn and(&mut self, column: &str, value: impl ToSql + Sync + 'static) {
        let place = self.take(value);
        write!(self.sql, " AND there.{column} = {place}").expect("a string takes everything");
    }

    /// Adds a value, and returns its placeholder.
    fn take(&mut self, value: impl ToSql + Sync + 'static) -> String {
        self.values.push(Box::new(value));
        format!("${}", self.values.len())
    }
}

/// Values of a filter are only integers and texts.
fn boxed(value: Value) -> Box<dyn ToSql + Sync> {
    match value {
        Value::Integer(number) => Box::new(number),
        Value::Text(text) => Box::new(text.replace('\0', "\u{fffd}")),
        _ => Box::new(None::<String>),
    }
}

impl Database {
    /// Lists the newest rows, at most `most`, that pass the filter, of one cell or of all.
    pub fn page(
        &self,
        filter: &Filter,
        cell: Option<&CellName>,
        most: usize,
    ) -> Result<CellPage, DatabaseError> {
        let cells = self.counts(filter, cell)?;
        let all = Condition::of(&Filter::default(), cell);
        let asked = format!(
            "SELECT count(*) FROM partsight.inspection AS there WHERE {}",
            all.sql
        );
        let values = borrowed(&all.values);
        let row = self
            .link
            .wait(self.client.query_one(asked.as_str(), &values))?;
        let num_all: i64 = self.read(&row, 0)?;
        let mut condition = Condition::of(filter, cell);
        let limit = condition.take(i64::try_from(most).unwrap_or(i64::MAX));
        let names = names_of(&INSPECTION_COLUMNS);
        let asked = format!(
            "SELECT {}, {NUM_BELOW}, there.cell FROM partsight.inspection AS there WHERE {}
                ORDER BY there.at DESC, there.cell, there.number DESC LIMIT {limit}",
            names.join(", "),
            condition.sql
        );
        let reader = self.reader(names)?;
        let mut page = CellPage {
            rows: Vec::new(),
            cells,
            num_all: num_all as usize,
        };
        for row in self.query(&asked, &condition.values)? {
            let (values, index) = self.values(&row, &INSPECTION_COLUMNS)?;
            let summary = reader.summary(values);
            let summary = summary.map_err(|error| self.unreadable(&error))?;
            page.rows.push((self.read(&row, index)?, summary));
        }
        Ok(page)
    }

    /// Calls `each` for all rows that pass the filter, of one cell or of all, oldest first, until it returns an error. Each
    /// row comes with the name of its cell and without its thumbnail.
    pub fn each<E: From<DatabaseError>>(
        &self,
        filter: &Filter,
        cell: Option<&CellName>,
        mut each: impl FnMut(&str, Record) -> Result<(), E>,
    ) -> Result<(), E> {
        self.counts(filter, cell)?;
        let mut last = (i64::MIN, String::new(), String::new(), 0);
        loop {
            let mut condition = Condition::of(filter, cell);
            let (at, of, history, number) = last.clone();
            let from = [
                condition.take(at),
                condition.take(of),
                condition.take(history),
                condition.take(number),
            ];
            write!(
                condition.sql,
                " AND (there.at, there.cell, there.history, there.number) > ({})",
                from.join(", ")
            )
            .expect("a string takes everything");
            let rows = self.records(&condition, READ_AT_ONCE)?;
            let is_last = (rows.len() as i64) < READ_AT_ONCE;
            for row in rows {
                let number = row.record.summary.number;
                each(&row.cell, row.record)?;
                last = (row.at, row.cell, row.history, number);
            }
            if is_last {
                return Ok(());
            }
        }
    }

    /// Returns the inspections with this number, of one cell or of all, oldest first. There may be several: a number is
    /// unique only within a history, and a cell may have had several histories.
    pub fn numbered(
        &self,
        number: i64,
        cell: Option<&CellName>,
    ) -> Result<Vec<CellRecord>, DatabaseError> {
        let all = with_below();
        self.counts(&all, cell)?;
        let mut condition = Condition::of(&all, cell);
        condition.and("number", number);
        self.records(&condition, i64::MAX)
    }

    /// Returns the re-inspections below an inspection, oldest first.
    pub fn below(&self, of: &CellRecord) -> Result<Vec<CellRecord>, DatabaseError> {
        let mut condition = Condition::of(&with_below(), None);
        condition.and("cell", of.cell.clone());
        condition.and("history", of.history.clone());
        condition.and("parent", of.record.summary.number);
        self.records(&condition, i64::MAX)
    }

    /// Reads the inspections that meet a condition, oldest first, at most `most`.
    fn records(&self, condition: &Condition, most: i64) -> Result<Vec<CellRecord>, DatabaseError> {
        let columns = [
            &INSPECTION_COLUMNS[..],
            &DETAIL_COLUMNS[1..],
            &RECIPE_COLUMNS[..],
        ]
        .concat();
        let names = names_of(&columns);
        let reader = self.reader(names.clone())?;
        let names = names.iter().map(|name| match *name {
            "number" => "there.number".to_owned(),
            "thumbnail" => "NULL::bytea".to_owned(),
            name => name.to_owned(),
        });
        let asked = format!(
            "SELECT {}, {NUM_BELOW}, there.cell, there.history FROM partsight.inspection AS there
                LEFT JOIN partsight.detail AS rest USING (cell, history, number)
                LEFT JOIN partsight.recipe AS known ON known.cell = there.cell AND known.history = there.history
                    AND known.identity = rest.recipe
                WHERE {} ORDER BY there.at, there.cell, there.history, there.number LIMIT {most}",
            names.collect::<Vec<_>>().join(", "),
            condition.sql
        );
        let rows = self.query(&asked, &condition.values)?;
        let read = |row: &Row| {
            let (values, index) = self.values(row, &columns)?;
            let record = reader.record(values);
            Ok(CellRecord {
                cell: self.read(row, index)?,
                history: self.read(row, index + 1)?,
                record: record.map_err(|error| self.unreadable(&error))?,
                at: self.read(row, AT)?,
            })
        };
        rows.iter().map(read).collect()
    }

    /// Counts what every cell, or one, has sent; an unknown cell is an error.
    fn counts(
        &self,
        filter: &Filter,
        cell: Option<&CellName>,
    ) -> Result<Vec<CellCount>, DatabaseError> {
        let condition = Condition::of(filter, None);
        let asked = format!(
            "SELECT cell, (extract(epoch FROM sent) * 1000000)::bigint, coalesce(num, 0), coalesce(accepted, 0)
                FROM partsight.cell LEFT JOIN (
                    SELECT cell, count(*) AS num, count(*) FILTER (WHERE verdict = 'accepted') AS accepted
                        FROM partsight.inspection AS there WHERE {} GROUP BY cell
                ) AS matching USING (cell) ORDER BY cell",
            condition.sql
        );
        let mut cells = Vec::new();
        for row in self.query(&asked, &condition.values)? {
            let sent: i64 = self.read(&row, 1)?;
            let [num_matching, num_accepted] = [self.read::<i64>(&row, 2)?, self.read(&row, 3)?];
            cells.push(CellCount {
                cell: self.read(&row, 0)?,
                sent: Timestamp::from_microsecond(sent).unwrap_or(Timestamp::UNIX_EPOCH),
                num_matching: num_matching as usize,
                num_accepted: num_accepted as usize,
            });
        }
        let Some(cell) = cell else {
            return Ok(cells);
        };
        let known: Vec<String> = cells.iter().map(|count| count.cell.clone()).collect();
        cells.retain(|count| count.cell == cell.as_str());
        if cells.is_empty() {
            return Err(DatabaseError::NoSuchCell {
                database: self.link.address.clone(),
                cell: cell.clone(),
                known,
            });
        }
        Ok(cells)
    }

    fn query(
        &self,
        asked: &str,
        values: &[Box<dyn ToSql + Sync>],
    ) -> Result<Vec<Row>, DatabaseError> {
        self.link.wait(self.client.query(asked, &borrowed(values)))
    }

    fn reader(&self, mut names: Vec<&str>) -> Result<RowReader, DatabaseError> {
        names.push("num_below");
        RowReader::new(&names).map_err(|error| self.unreadable(&error))
    }

    /// Reads the columns of a row and the number of re-inspections; also returns the position of the next column.
    fn values(&self, row: &Row, columns: &[Column]) -> Result<(Vec<Value>, usize), DatabaseError> {
        let mut values = Vec::with_capacity(columns.len() + 1);
        for (index, (_, kind)) in columns.iter().enumerate() {
            values.push(match kind {
                ColumnKind::Boolean => self.value::<bool>(row, index)?,
                ColumnKind::Integer => self.value::<i64>(row, index)?,
                ColumnKind::Real => self.value::<f64>(row, index)?,
                ColumnKind::Text => self.value::<String>(row, index)?,
                ColumnKind::Bytes => self.value::<Vec<u8>>(row, index)?,
            });
        }
        values.push(self.value::<i64>(row, columns.len())?);
        Ok((values, columns.len() + 1))
    }

    fn value<'a, T: FromSql<'a> + Into<Value>>(
        &self,
        row: &'a Row,
        index: usize,
    ) -> Result<Value, DatabaseError> {
        let value: Option<T> = self.read(row, index)?;
        Ok(value.map_or(Value::Null, Into::into))
    }

    fn unreadable(&self, error: &rusqlite::Error) -> DatabaseError {
        DatabaseError::Failed {
            database: self.link.address.clone(),
            cause: format!("a row cannot be read: {error}"),
        }
    }
}

/// The filter that passes every inspection.
fn with_below() -> Filter {
    Filter {
        with_below: true,
        ..Filter::default()
    }
}

fn names_of(columns: &[Column]) -> Vec<&'static str> {
    columns.iter().map(|(name, _)| *name).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use records::history::StoredVerdict;

    #[test]
    fn a_filter_becomes_a_condition_of_the_server() {
        let cell: CellName = "cell7".parse().expect("a name");
        assert_eq!(Condition::of(&with_below(), None).sql, "TRUE");
        let one = Condition::of(&with_below(), Some(&cell));
        assert_eq!(
            (one.sql.as_str(), one.values.len()),
            ("TRUE AND there.cell = $1", 1)
        );
        let filter = Filter {
            verdict: Some(StoredVerdict::Accepted.into()),
            is_simulated: Some(true),
            text: "left ? door".into(),
            ..Filter::default()
        };
        let condition = Condition::of(&filter, Some(&cell));
        assert_eq!(
            condition.sql,
            "simulated::integer::bigint = $1 AND (strpos(search, $2) > 0) AND (strpos(search, $3) > 0) \
            AND (strpos(search, $4) > 0) AND verdict = $5 AND parent IS NULL AND there.cell = $6"
        );
        assert_eq!(condition.values.len(), 6);
    }
}
