//! What a database of the plant has not got of this history yet, and the columns that it gets.
//!
//! From the first sending on, triggers in the file note every inspection that is added or changed, in the same
//! transaction, whichever program writes. A note goes once the database has committed the row, unless the row has changed
//! again meanwhile: then there is a newer note.

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

/// What a column holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ColumnKind {
    /// 0 or 1.
    Boolean,
    /// 64 bits.
    Integer,
    /// 64 bits.
    Real,
    /// UTF-8.
    Text,
    /// A picture.
    Bytes,
}

/// The name of a column, and what it holds.
pub type Column = (&'static str, ColumnKind);

/// Every column of `inspection`; the first is the key.
pub const INSPECTION_COLUMNS: [Column; 21] = [
    ("number", Integer),
    ("at", Integer),
    ("scene", Text),
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
];

/// Every column of `detail`; the first is the key.
pub const DETAIL_COLUMNS: [Column; 15] = [
    ("number", Integer),
    ("nearest", Text),
    ("reason", Text),
    ("advice", Text),
    ("camera_from_part", Text),
    ("recipe", Text),
    ("library", Text),
    ("program", Text),
    ("line", Text),
    ("thumbnail", Bytes),
    ("origin", Text),
    ("frame", Text),
    ("recipe_name", Text),
    ("recipe_changed", Boolean),
    ("refusal", Text),
];

/// Every column of `recipe`; the first is the key.
pub const RECIPE_COLUMNS: [Column; 2] = [("identity", Text), ("json", Text)];

/// Rows that a database has not got, or not as they are now.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct UnsentRows {
    /// Of `inspection`, in the order in which they changed last.
    pub inspections: Vec<Vec<Value>>,
    /// Of `detail`, of the same inspections.
    pub details: Vec<Vec<Value>>,
    /// Of `recipe`, those that the details name.
    pub recipes: Vec<Vec<Value>>,
    /// The notes.
    changes: Vec<i64>,
}

impl UnsentRows {
    /// Inspections that were noted, also such as are not there any more.
    pub fn num(&self) -> usize {
        self.changes.len()
    }
}

/// What notes the changes. A statement in a trigger resolves conflicts as the statement that fired it, so `OR REPLACE`
/// would not be certain.
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
    END;
    INSERT INTO unsent (number)
        SELECT number FROM inspection WHERE number NOT IN (SELECT number FROM unsent) ORDER BY number;";

impl History {
    /// Notes from now on which inspections are added or changed, and all that are there if nobody has noted them.
    /// Answers with the identity of this history, the same for good: another file has another one, its copy the same.
    pub fn note_changes(&mut self) -> Result<String, HistoryError> {
        note_changes(&mut self.file).map_err(|error| self.error(error))
    }

    /// How many inspections are noted as not sent.
    pub fn num_unsent(&self) -> Result<usize, HistoryError> {
        let asked = "SELECT count(*) FROM unsent";
        let num = self.file.query_row(asked, [], |row| row.get::<_, i64>(0));
        num.map(|num| num as usize)
            .map_err(|error| self.error(error))
    }

    /// Inspections that are noted as not sent, those that changed first, at most so many.
    pub fn unsent(&mut self, most: usize) -> Result<UnsentRows, HistoryError> {
        unsent(&mut self.file, most).map_err(|error| self.error(error))
    }

    /// Takes the notes of these rows away, which were sent. What has changed since it was read stays noted.
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
    // A later version may have made a table anew, and its triggers went with the old one: all is noted again.
    if !is_noting(&file)? {
        file.execute_batch(NOTES)?;
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

/// Under this name the identity stands among the settings.
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
    // One transaction: a note and its row belong together.
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
        // One that a person removed from the file stays where it was sent.
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

/// The columns of a row by its key.
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

/// Text that is no UTF-8 is read as far as it is.
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

/// Reads inspections of values that came from elsewhere, as from rows of the file.
pub struct RowReader {
    memory: Connection,
    asked: String,
}

impl RowReader {
    /// Of values in the order of these columns.
    pub fn new(names: &[&str]) -> rusqlite::Result<Self> {
        let columns: Vec<String> = names.iter().map(|name| format!("? AS {name}")).collect();
        Ok(Self {
            memory: Connection::open_in_memory()?,
            asked: format!("SELECT {}", columns.join(", ")),
        })
    }

    /// What lists show.
    pub fn summary(&self, values: Vec<Value>) -> rusqlite::Result<Summary> {
        self.memory
            .query_row(&self.asked, params_from_iter(values), summary_of)
    }

    /// All of it.
    pub fn record(&self, values: Vec<Value>) -> rusqlite::Result<Record> {
        self.memory
            .query_row(&self.asked, params_from_iter(values), record_of)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        history::{FILE, KeepFrames, Retention, StoredVerdict},
        kit::{history_entry, moment, new_history, open_history},
        library::Truth,
    };

    const ALL: Retention = Retention {
        keep: KeepFrames::All,
        max_days: 1,
        max_gigabytes: 10.0,
    };

    fn add(history: &mut History, seconds: i64) {
        let entry = history_entry(seconds, StoredVerdict::NotAccepted, "fender");
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
        // The same again by another sender takes nothing away that came later.
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
        let read = history.unsent(10).expect("read");
        history.note_sent(&read).expect("noted");
        let swept = history.sweep(&ALL, moment(400 * 86_400)).expect("swept");
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
    fn a_history_of_the_first_version_is_noted_whole_and_opened_again() {
        let folder = tempfile::tempdir().expect("a folder");
        let file = Connection::open(folder.path().join(FILE)).expect("made");
        file.execute_batch(include_str!("first_version.sql"))
            .expect("written");
        drop(file);
        let mut history = open_history(folder.path());
        let identity = history.note_changes().expect("noted");
        assert_eq!(numbers(&history.unsent(10).expect("read")), [1, 2, 3]);
        drop(history);
        let mut history = open_history(folder.path());
        assert_eq!(history.note_changes().expect("noted"), identity);
        assert_eq!(history.num_unsent().expect("asked"), 3);
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
