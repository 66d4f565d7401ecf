//! The rows that a database of the plant does not have yet, and the columns that it gets.
//!
//! From the first sending on, triggers in the file record every inspection that is added or changed, in the same
//! transaction, whichever program writes. Once the database has committed the row, its record is deleted, unless the
//! row has changed again meanwhile: then there is a newer record.

use std::collections::BTreeSet;

use rusqlite::{
    Connection, OptionalExtension as _, TransactionBehavior, params_from_iter,
    types::{Value, ValueRef},
};

use self::ColumnKind::{Boolean, Bytes, Integer, Real, Text};
use super::{
    entry::{Record, Summary},
    error::HistoryError,
    rows::{record_of, summary_of},
    store::History,
};

/// Type of a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ColumnKind {
    /// 0 or 1.
    Boolean,
    /// 64-bit integer.
    Integer,
    /// 64-bit floating point.
    Real,
    /// UTF-8.
    Text,
    /// Binary data: a picture.
    Bytes,
}

/// Name and type of a column.
pub type Column = (&'static str, ColumnKind);

/// All columns of `inspection`; the first is the key.
pub const INSPECTION_COLUMNS: [Column; 26] = [
    ("number", Integer),
    ("at", Integer),
    ("scene", Text),
    ("simulated_frame", Integer),
    ("num_shots", Integer),
    ("source", Text),
    ("simulated", Boolean),
    ("verdict", Text),
    ("part", Text),
    ("title", Text),
    ("score", Real),
    ("margin", Real),
    ("total_ms", Real),
    ("remark", Text),
    ("label", Text),
    ("frame_bytes", Integer),
    ("search", Text),
    ("hung", Text),
    ("parent", Integer),
    ("serial", Text),
    ("job_order", Text),
    ("operator", Text),
    ("reason_kind", Text),
    ("robot_doubts", Text),
    ("motion_checked", Boolean),
    ("rack", Text),
];

/// All columns of `detail`; the first is the key.
pub const DETAIL_COLUMNS: [Column; 13] = [
    ("number", Integer),
    ("nearest", Text),
    ("refusal", Text),
    ("camera_from_part", Text),
    ("recipe", Text),
    ("recipe_name", Text),
    ("recipe_changed", Boolean),
    ("library", Text),
    ("program", Text),
    ("line", Text),
    ("thumbnail", Bytes),
    ("origin", Text),
    ("frame", Text),
];

/// All columns of `recipe`; the first is the key.
pub const RECIPE_COLUMNS: [Column; 2] = [("identity", Text), ("json", Text)];

/// Rows that a database does not have in their present state.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct UnsentRows {
    /// Rows of `inspection`, in the order of their last change.
    pub inspections: Vec<Vec<Value>>,
    /// Rows of `detail` of the same inspections.
    pub details: Vec<Vec<Value>>,
    /// Rows of `recipe` that the details refer to.
    pub recipes: Vec<Vec<Value>>,
    /// Keys of the change records.
    changes: Vec<i64>,
}

impl UnsentRows {
    /// Returns the number of recorded changes, including those of inspections that no longer exist.
    pub fn num(&self) -> usize {
        self.changes.len()
    }
}

/// Table and triggers that record the changes. A statement in a trigger resolves conflicts like the statement that
/// fired it, so `OR REPLACE` would not be reliable.
const NOTES: &str = "
    CREATE TABLE IF NOT EXISTS unsent (
        change INTEGER PRIMARY KEY AUTOINCREMENT, -- never used again: a later change has another
        number INTEGER NOT NULL UNIQUE            -- of the inspection
    );
    CREATE TRIGGER IF NOT EXISTS unsent_added AFTER INSERT ON inspection BEGIN
        DELETE FROM unsent WHERE number = NEW.number;
        INSERT INTO unsent (number) VALUES (NEW.number);
    END;
    CREATE TRIGGER IF NOT EXISTS unsent_changed AFTER UPDATE ON inspection BEGIN
        DELETE FROM unsent WHERE number = NEW.number;
        INSERT INTO unsent (number) VALUES (NEW.number);
    END;
    CREATE TRIGGER IF NOT EXISTS unsent_detail AFTER UPDATE ON detail BEGIN
        DELETE FROM unsent WHERE number = NEW.number;
        INSERT INTO unsent (number) VALUES (NEW.number);
    END;";
/// Records all inspections that are not recorded yet.
const NOTE_ALL: &str = "INSERT INTO unsent (number)
    SELECT number FROM inspection WHERE number NOT IN (SELECT number FROM unsent) ORDER BY number";

impl History {
    /// Starts recording which inspections are added or changed; at the first call also records all that exist. Returns
    /// the identity of this history, which never changes: another file has another one, a copy of it the same.
    pub fn note_changes(&mut self) -> Result<String, HistoryError> {
        note_changes(&mut self.file).map_err(|error| self.error(error))
    }

    /// Records all inspections as not sent: the database is another one, or an older state of it was restored.
    pub fn note_all(&mut self) -> Result<(), HistoryError> {
        let noted = self.file.execute(NOTE_ALL, []);
        noted.map(|_| ()).map_err(|error| self.error(error))
    }

    /// Returns the number of inspections that are recorded as not sent.
    pub fn num_unsent(&self) -> Result<usize, HistoryError> {
        let asked = "SELECT count(*) FROM unsent";
        let num = self.file.query_row(asked, [], |row| row.get::<_, i64>(0));
        num.map(|num| num as usize)
            .map_err(|error| self.error(error))
    }

    /// Returns up to `most` unsent inspections, those that changed first at the front.
    pub fn unsent(&mut self, most: usize) -> Result<UnsentRows, HistoryError> {
        unsent(&mut self.file, most).map_err(|error| self.error(error))
    }

    /// Deletes the change records of these rows, which were sent. A row changed after it was read stays recorded.
    pub fn note_sent(&mut self, rows: &UnsentRows) -> Result<(), HistoryError> {
        note_sent(&mut self.file, &rows.changes).map_err(|error| self.error(error))
    }
}

fn note_changes(file: &mut Connection) -> rusqlite::Result<String> {
    if is_noting(file)?
        && let Some(known) = identity(file)?
    {
        return Ok(known);
    }
    let file = file.transaction_with_behavior(TransactionBehavior::Immediate)?;
    // A later version may have recreated a table, which drops its triggers: record everything again.
    if !is_noting(&file)? {
        file.execute_batch(NOTES)?;
        file.execute(NOTE_ALL, [])?;
    }
    file.execute(
        "INSERT INTO setting (name, json) VALUES (?, '\"' || lower(hex(randomblob(16))) || '\"')
            ON CONFLICT (name) DO NOTHING",
        [IDENTITY],
    )?;
    let made = identity(&file)?;
    file.commit()?;
    Ok(made.unwrap_or_default())
}

/// Name under which the settings hold the identity.
const IDENTITY: &str = "identity";

fn identity(file: &Connection) -> rusqlite::Result<Option<String>> {
    let asked = "SELECT json FROM setting WHERE name = ?";
    let json = file.query_row(asked, [IDENTITY], |row| row.get::<_, String>(0));
    let json = json.optional()?;
    Ok(json.and_then(|json| serde_json::from_str(&json).ok()))
}

fn is_noting(file: &Connection) -> rusqlite::Result<bool> {
    let asked = "SELECT count(*) = 4 FROM sqlite_schema
        WHERE name IN ('unsent', 'unsent_added', 'unsent_changed', 'unsent_detail')";
    file.query_row(asked, [], |row| row.get(0))
}

fn unsent(file: &mut Connection, most: usize) -> rusqlite::Result<UnsentRows> {
    // One transaction keeps each change record consistent with its row.
    let file = file.transaction()?;
    let mut asked = file.prepare("SELECT change, number FROM unsent ORDER BY change LIMIT ?")?;
    let notes = asked.query_map([most as i64], |row| Ok((row.get(0)?, row.get(1)?)))?;
    let notes = notes.collect::<rusqlite::Result<Vec<(i64, i64)>>>()?;
    let mut rows = UnsentRows::default();
    let mut recipes = BTreeSet::new();
    let recipe = DETAIL_COLUMNS
        .iter()
        .position(|(name, _)| *name == "recipe");
    for (change, number) in notes {
        rows.changes.push(change);
        // An inspection that was deleted from the file stays in the database.
        let key = Value::from(number);
        let Some(inspection) = row(&file, "inspection", &INSPECTION_COLUMNS, &key)? else {
            continue;
        };
        rows.inspections.push(inspection);
        if let Some(detail) = row(&file, "detail", &DETAIL_COLUMNS, &key)? {
            if let Some(Value::Text(identity)) = recipe.and_then(|place| detail.get(place)) {
                recipes.insert(identity.clone());
            }
            rows.details.push(detail);
        }
    }
    for identity in recipes {
        let key = Value::from(identity);
        rows.recipes
            .extend(row(&file, "recipe", &RECIPE_COLUMNS, &key)?);
    }
    Ok(rows)
}

/// Reads the columns of a row by its key.
fn row(
    file: &Connection,
    table: &str,
    columns: &[Column],
    key: &Value,
) -> rusqlite::Result<Option<Vec<Value>>> {
    let names: Vec<&str> = columns.iter().map(|(name, _)| *name).collect();
    let asked = format!(
        "SELECT {} FROM {table} WHERE {} = ?",
        names.join(", "),
        names[0]
    );
    let read = file.query_row(&asked, [key], |row| {
        let values = (0..names.len()).map(|place| row.get_ref(place).map(value_of));
        values.collect::<rusqlite::Result<Vec<Value>>>()
    });
    read.optional()
}

/// Text that is not valid UTF-8 is read lossily.
fn value_of(value: ValueRef<'_>) -> Value {
    match value {
        ValueRef::Null => Value::Null,
        ValueRef::Integer(number) => Value::Integer(number),
        ValueRef::Real(number) => Value::Real(number),
        ValueRef::Text(text) => Value::Text(String::from_utf8_lossy(text).into_owned()),
        ValueRef::Blob(bytes) => Value::Blob(bytes.to_vec()),
    }
}

fn note_sent(file: &mut Connection, changes: &[i64]) -> rusqlite::Result<()> {
    let file = file.transaction_with_behavior(TransactionBehavior::Immediate)?;
    for change in changes {
        file.execute("DELETE FROM unsent WHERE change = ?", [change])?;
    }
    file.commit()
}

/// Converts values from elsewhere into inspections, as if they were rows of the file.
pub struct RowReader {
    memory: Connection,
    asked: String,
}

impl RowReader {
    /// Creates a reader of values in the order of these columns.
    pub fn new(names: &[&str]) -> rusqlite::Result<Self> {
        let columns: Vec<String> = names.iter().map(|name| format!("? AS {name}")).collect();
        Ok(Self {
            memory: Connection::open_in_memory()?,
            asked: format!("SELECT {}", columns.join(", ")),
        })
    }

    /// Reads the row for lists.
    pub fn summary(&self, values: Vec<Value>) -> rusqlite::Result<Summary> {
        self.memory
            .query_row(&self.asked, params_from_iter(values), summary_of)
    }

    /// Reads an inspection in full.
    pub fn record(&self, values: Vec<Value>) -> rusqlite::Result<Record> {
        self.memory
            .query_row(&self.asked, params_from_iter(values), record_of)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        fixtures::{history_entry, new_history, open_history},
        history::{KeepFrames, Retention, StoredVerdict, TraceChange, Traceability},
    };
    use capture::fixtures::moment;
    use inspection::library::Truth;

    const ALL: Retention = Retention {
        keep: KeepFrames::All,
        max_days: 1,
        max_gigabytes: 10.0,
    };

    fn add(history: &mut History, seconds: i64) {
        let entry = history_entry(seconds, StoredVerdict::Rejected, "fender");
        history.add(&entry, &ALL).expect("written");
    }

    fn numbers(rows: &UnsentRows) -> Vec<i64> {
        let numbers = rows.inspections.iter().map(|row| match &row[..] {
            [Value::Integer(number), ..] => *number,
            other => panic!("{other:?}"),
        });
        numbers.collect()
    }

    fn columns_of(history: &History, table: &str) -> Vec<String> {
        let asked = format!("SELECT name FROM pragma_table_info('{table}')");
        let mut asked = history.file.prepare(&asked).expect("asked");
        let names = asked.query_map([], |row| row.get(0)).expect("asked");
        names.map(|name| name.expect("text")).collect()
    }

    #[test]
    fn every_column_of_the_file_is_sent() {
        let (_folder, history) = new_history();
        for (table, columns) in [
            ("inspection", &INSPECTION_COLUMNS[..]),
            ("detail", &DETAIL_COLUMNS[..]),
            ("recipe", &RECIPE_COLUMNS[..]),
        ] {
            let sent: BTreeSet<_> = columns.iter().map(|(name, _)| (*name).to_owned()).collect();
            let found = columns_of(&history, table);
            assert_eq!(BTreeSet::from_iter(found.clone()), sent, "{table}");
            assert_eq!(found[0], columns[0].0, "the key of {table}");
        }
    }

    #[test]
    fn what_is_there_and_what_changes_is_noted_until_it_is_sent() {
        let (folder, mut history) = new_history();
        add(&mut history, 1);
        add(&mut history, 2);
        let identity = history.note_changes().expect("noted");
        assert_eq!(identity.len(), 32, "{identity}");
        add(&mut history, 3);
        assert_eq!(history.num_unsent().expect("asked"), 3);
        let first = history.unsent(2).expect("read");
        assert_eq!(numbers(&first), [1, 2]);
        assert_eq!((first.details.len(), first.recipes.len()), (2, 1));
        history.note_sent(&first).expect("noted");
        let rest = history.unsent(10).expect("read");
        assert_eq!(numbers(&rest), [3]);
        history.note_sent(&rest).expect("noted");
        assert_eq!(history.unsent(10).expect("read").num(), 0);
        // Another program labels one.
        let label = Truth::Part("grille".into());
        let mut other = open_history(folder.path());
        other.set_label(2, Some(&label)).expect("written");
        assert_eq!(numbers(&history.unsent(10).expect("read")), [2]);
        assert_eq!(history.note_changes().expect("noted"), identity);
        assert_eq!(history.num_unsent().expect("asked"), 1);
        // A serial number comes after the verdict.
        let hung = other.known(1).expect("there").summary.hung;
        let known = TraceChange::Fill(Traceability {
            serial: "TL-4711".into(),
            ..Traceability::default()
        });
        other.trace_part(&hung, &known).expect("written");
        let changed = history.unsent(10).expect("read");
        assert_eq!(numbers(&changed), [2, 1]);
        let mut columns = INSPECTION_COLUMNS.iter();
        let serial = columns.position(|(name, _)| *name == "serial");
        let serial = &changed.inspections[1][serial.expect("a column")];
        assert_eq!(*serial, Value::Text("TL-4711".into()));
    }

    #[test]
    fn a_change_while_its_row_is_sent_stays_noted() {
        let (_folder, mut history) = new_history();
        history.note_changes().expect("noted");
        add(&mut history, 1);
        let read = history.unsent(10).expect("read");
        history.set_remark(1, "a dent").expect("written");
        history.note_sent(&read).expect("noted");
        let again = history.unsent(10).expect("read");
        assert_eq!(numbers(&again), [1]);
        history.note_sent(&again).expect("noted");
        // Deleting the same records twice does not delete later ones.
        history.set_remark(1, "no dent").expect("written");
        history.note_sent(&read).expect("noted");
        history.note_sent(&again).expect("noted");
        assert_eq!(history.num_unsent().expect("asked"), 1);
    }

    #[test]
    fn a_frame_that_is_swept_away_is_a_change_and_the_row_stays() {
        let (_folder, mut history) = new_history();
        history.note_changes().expect("noted");
        add(&mut history, 1);
        let without_frames = Retention {
            keep: KeepFrames::None,
            ..ALL
        };
        // The age goes on with each inspection.
        for days in 1..=11 {
            let entry = history_entry(days * 86_400, StoredVerdict::Rejected, "fender");
            history.add(&entry, &without_frames).expect("written");
        }
        let read = history.unsent(100).expect("read");
        history.note_sent(&read).expect("noted");
        let swept = history.sweep(&ALL, moment(12 * 86_400)).expect("swept");
        assert_eq!(swept.num_frames, 1);
        assert_eq!(numbers(&history.unsent(10).expect("read")), [1]);
    }

    #[test]
    fn triggers_that_are_gone_come_back_and_all_is_noted_again() {
        let (_folder, mut history) = new_history();
        let identity = history.note_changes().expect("noted");
        add(&mut history, 1);
        let read = history.unsent(10).expect("read");
        history.note_sent(&read).expect("noted");
        history
            .file
            .execute_batch("DROP TRIGGER unsent_changed")
            .expect("dropped");
        history.set_remark(1, "unnoticed").expect("written");
        assert_eq!(history.num_unsent().expect("asked"), 0);
        assert_eq!(history.note_changes().expect("noted"), identity);
        assert_eq!(history.num_unsent().expect("asked"), 1);
    }

    #[test]
    fn values_from_elsewhere_are_read_as_rows_of_the_file_are() {
        let (_folder, mut history) = new_history();
        history.note_changes().expect("noted");
        add(&mut history, 1);
        let rows = history.unsent(10).expect("read");
        let names = [
            &INSPECTION_COLUMNS[..],
            &DETAIL_COLUMNS[1..],
            &RECIPE_COLUMNS[..],
        ]
        .concat();
        let mut names: Vec<&str> = names.iter().map(|(name, _)| *name).collect();
        names.push("num_below");
        let mut values = rows.inspections[0].clone();
        values.extend_from_slice(&rows.details[0][1..]);
        values.extend_from_slice(&rows.recipes[0]);
        values.push(Value::from(0));
        let reader = RowReader::new(&names).expect("made");
        let record = reader.record(values).expect("read");
        assert_eq!(record, history.known(1).expect("there"));
    }
}
