//! The history in a real PostgreSQL, started by each test at a free port (`apt-get install postgresql`). Without it
//! the tests report that they are skipped; with `PARTSIGHT_REQUIRE_POSTGRES=1` they fail.

mod errors;
mod kills;
mod outage;
mod program;
mod server;

use std::{fs, ops::Range, path::Path, thread};

use partsight::{
    history::{
        Column, ColumnKind, DETAIL_COLUMNS, FILE, Filter, History, INSPECTION_COLUMNS, KeepFrames,
        NewEntry, RECIPE_COLUMNS, Record, Retention, SceneTitle, StoredVerdict, Traceability,
    },
    library::Truth,
    plant::database::{
        BATCH, CellHistory, Database, DatabaseError, HistorySender, SendNews, TransferError,
    },
};
use serde_json::{Value, json};

use crate::kit::{history_entry, moment, new_history, open_history};

use self::server::{Postgres, wait_until};

const ALL: Retention = Retention {
    keep: KeepFrames::All,
    max_days: 1,
    max_gigabytes: 10.0,
};

fn add(history: &mut History, entry: &NewEntry) -> i64 {
    history.add(entry, &ALL).expect("written")
}

/// Adds an inspection per second of the range; many of them in one go and without frames.
fn add_some(history: &mut History, seconds: Range<i64>) {
    let is_many = seconds.end - seconds.start > 20;
    let entries = seconds.map(|seconds| {
        let verdict = StoredVerdict::ALL[seconds as usize % 4];
        history_entry(seconds, verdict, "fender")
    });
    if is_many {
        history.add_all(entries).expect("written");
    } else {
        for entry in entries {
            add(history, &entry);
        }
    }
}

fn cell_of(history: &mut History, cell: &str) -> CellHistory {
    CellHistory {
        cell: cell.parse().expect("a name"),
        history: history.note_changes().expect("noted"),
    }
}

/// Sends everything, as `history send` does, and returns the number of inspections sent.
fn send(
    database: &mut Database,
    history: &mut History,
    whose: &CellHistory,
) -> Result<usize, TransferError> {
    let mut num = 0;
    loop {
        let rows = database.send(whose, || Ok(history.unsent(BATCH)?))?;
        history.note_sent(&rows)?;
        num += rows.num();
        if rows.num() < BATCH {
            return Ok(num);
        }
    }
}

/// The rows of a table in a history's file, as the database should have them.
fn rows_here(folder: &Path, table: &str, columns: &[Column]) -> Vec<Value> {
    let file = rusqlite::Connection::open(folder.join(FILE)).expect("there");
    let names: Vec<&str> = columns.iter().map(|(name, _)| *name).collect();
    let asked = format!("SELECT {} FROM {table}", names.join(", "));
    let mut asked = file.prepare(&asked).expect("asked");
    let rows = asked.query_map([], |row| {
        let values = columns.iter().enumerate();
        let values = values.map(|(place, (_, kind))| -> rusqlite::Result<Value> {
            Ok(match (kind, row.get(place)?) {
                (_, rusqlite::types::Value::Null) => Value::Null,
                (ColumnKind::Boolean, rusqlite::types::Value::Integer(number)) => {
                    json!(number != 0)
                }
                (_, rusqlite::types::Value::Integer(number)) => json!(number),
                (_, rusqlite::types::Value::Real(number)) => json!(number),
                (_, rusqlite::types::Value::Text(text)) => json!(text.replace('\0', "\u{fffd}")),
                (_, rusqlite::types::Value::Blob(bytes)) => {
                    let digits = bytes.iter().map(|byte| format!("{byte:02x}"));
                    json!(digits.collect::<String>())
                }
            })
        });
        values.collect::<rusqlite::Result<Vec<Value>>>()
    });
    let rows = rows.expect("asked").map(|row| json!(row.expect("read")));
    sorted(rows.collect())
}

/// The rows of a table that a cell has sent.
fn rows_there(server: &Postgres, cell: &str, table: &str, columns: &[Column]) -> Vec<Value> {
    let values = columns.iter().map(|(name, kind)| match kind {
        ColumnKind::Bytes => format!("encode({name}, 'hex')"),
        _ => (*name).to_owned(),
    });
    let values: Vec<String> = values.collect();
    let rows = server.sql(&format!(
        "SELECT json_build_array({}) FROM partsight.{table} WHERE cell = '{}'",
        values.join(", "),
        cell.replace('\'', "''")
    ));
    let rows = rows.iter().map(|row| {
        let mut row: Vec<Value> = serde_json::from_str(row).expect("JSON");
        for (value, (_, kind)) in row.iter_mut().zip(columns) {
            // PostgreSQL writes the number 23.0 as 23.
            if let (ColumnKind::Real, Some(number)) = (kind, value.as_f64()) {
                *value = json!(number);
            }
        }
        json!(row)
    });
    sorted(rows.collect())
}

fn sorted(mut rows: Vec<Value>) -> Vec<Value> {
    rows.sort_by_key(Value::to_string);
    rows
}

/// Checks that every value of every row is the same in both places, and returns the number of inspections.
fn assert_same(server: &Postgres, folder: &Path, cell: &str) -> usize {
    let mut num = 0;
    for (table, columns) in [
        ("recipe", &RECIPE_COLUMNS[..]),
        ("detail", &DETAIL_COLUMNS[..]),
        ("inspection", &INSPECTION_COLUMNS[..]),
    ] {
        let (here, there) = (
            rows_here(folder, table, columns),
            rows_there(server, cell, table, columns),
        );
        assert_eq!(here.len(), there.len(), "{table} of {cell}");
        for (here, there) in here.iter().zip(&there) {
            assert_eq!(here, there, "{table} of {cell}");
        }
        num = here.len();
    }
    num
}

/// A text that breaks queries and outputs without proper escaping.
const HOSTILE: &str =
    "'; DROP TABLE partsight.inspection; -- \"$1\" \\ {} [] \u{1b}[31m 七 \u{202e}\n\t%s\0end";

#[test]
fn everything_arrives_value_by_value_and_so_does_every_later_change() {
    let Some(server) = Postgres::start_new() else {
        return;
    };
    let (folder, mut history) = new_history();
    // More than one batch, all written before the first sending.
    add_some(&mut history, 0..BATCH as i64 + 5);
    let cell = "Halle 3's \"cell\"; --";
    let whose = cell_of(&mut history, cell);
    let mut hostile = history_entry(9000, StoredVerdict::Rejected, "fender");
    let summary = &mut hostile.record.summary;
    summary.total_ms = 23.0;
    summary.scene = SceneTitle::Named(HOSTILE.into());
    for text in [&mut summary.source, &mut summary.title, &mut summary.remark] {
        HOSTILE.clone_into(text);
    }
    summary.part = Some(HOSTILE.into());
    summary.trace = Traceability {
        serial: HOSTILE.into(),
        order: String::new(),
        operator: "O'Brien".into(),
    };
    summary.total_ms = f64::MIN_POSITIVE;
    summary.score = Some([1.0 / 3.0, 1e300]);
    hostile.record.detail.line = HOSTILE.into();
    let refused = add(&mut history, &hostile);
    let mut database = server.open().expect("made");
    let num = send(&mut database, &mut history, &whose).expect("sent");
    assert_eq!(num, BATCH + 6);
    assert_eq!(assert_same(&server, folder.path(), cell), BATCH + 6);
    let at = server.sql(
        "SELECT count(*) FROM partsight.inspection WHERE extract(epoch FROM time) * 1000000 <> at",
    );
    assert_eq!(at, ["0"], "times are those of the inspections");

    // No row is sent twice, and sending one again changes nothing.
    assert_eq!(send(&mut database, &mut history, &whose).expect("sent"), 0);
    let changed = "SELECT max(changed) FROM partsight.inspection";
    let before = server.sql(changed);
    let file = rusqlite::Connection::open(folder.path().join(FILE)).expect("there");
    file.execute(
        "INSERT INTO unsent (number) SELECT number FROM inspection",
        [],
    )
    .expect("noted");
    let num = send(&mut database, &mut history, &whose).expect("sent");
    assert_eq!((num, server.sql(changed)), (BATCH + 6, before));

    // Add a label, a remark, and a later acceptance of the refused part.
    let label = Truth::Part(HOSTILE.into());
    history.set_label(3, Some(&label)).expect("written");
    history.set_remark(4, HOSTILE).expect("written");
    let mut accepted = history_entry(9001, StoredVerdict::Accepted, "fender");
    accepted.record.summary.hung = hostile.record.summary.hung.clone();
    let accepted = add(&mut history, &accepted);
    let num = send(&mut database, &mut history, &whose).expect("sent");
    assert_eq!(num, 4, "two marked ones, the new one and the one below it");
    assert_eq!(assert_same(&server, folder.path(), cell), BATCH + 7);
    let parent = server.sql(&format!(
        "SELECT parent FROM partsight.inspection WHERE number = {refused}"
    ));
    assert_eq!(parent, [accepted.to_string()]);
    let page = database.page(&Filter::default(), Some(&whose.cell), 1);
    let page = page.expect("read");
    assert_eq!(
        (page.num_all, page.cells[0].num_matching),
        (BATCH + 6, BATCH + 6)
    );
}

#[test]
fn what_is_read_from_the_database_is_what_the_history_itself_shows() {
    let Some(server) = Postgres::start_new() else {
        return;
    };
    let (_folder, mut history) = new_history();
    add_some(&mut history, 0..12);
    history.set_remark(5, "left ? dent").expect("written");
    let mut again = history_entry(30, StoredVerdict::Accepted, "grille");
    again.record.summary.hung = history.known(2).expect("there").summary.hung;
    again.record.summary.trace.order = "A 17".into();
    again.record.summary.trace.serial = "TL-4711".into();
    add(&mut history, &again);
    let whose = cell_of(&mut history, "cell7");
    let mut database = server.open().expect("made");
    send(&mut database, &mut history, &whose).expect("sent");
    let filters = [
        Filter::default(),
        Filter {
            with_below: true,
            ..Filter::default()
        },
        Filter {
            verdict: Some(StoredVerdict::Rejected.into()),
            since: Some(moment(4)),
            ..Filter::default()
        },
        Filter {
            text: "? DENT".into(),
            ..Filter::default()
        },
        Filter {
            part: Some("grille".into()),
            is_simulated: Some(true),
            until: Some(moment(31)),
            ..Filter::default()
        },
        Filter {
            is_simulated: Some(false),
            ..Filter::default()
        },
        Filter {
            order: Some("A 17".into()),
            serial: Some("TL-4711".into()),
            ..Filter::default()
        },
    ];
    for filter in filters {
        let here = history.page(&filter, 0, 5).expect("asked");
        let there = database.page(&filter, None, 5).expect("asked");
        let rows = there.rows.iter().map(|(cell, row)| {
            assert_eq!(cell, "cell7");
            row.clone()
        });
        assert_eq!(rows.collect::<Vec<_>>(), here.rows, "{filter:?}");
        let counts = (there.cells[0].num_matching, there.num_all);
        assert_eq!(counts, (here.num_matching, here.num_all), "{filter:?}");
        let mut expected: Vec<Record> = Vec::new();
        let read = history.each::<TransferError>(&filter, |mut record| {
            record.detail.thumbnail.clear();
            expected.push(record);
            Ok(())
        });
        read.expect("read");
        let mut found = Vec::new();
        let read = database.each::<TransferError>(&filter, Some(&whose.cell), |_, record| {
            found.push(record);
            Ok(())
        });
        read.expect("read");
        assert_eq!(found, expected, "{filter:?}");
    }
}

#[test]
fn twenty_cells_start_at_once_and_each_keeps_its_own() {
    let Some(server) = Postgres::start_new() else {
        return;
    };
    let folders: Vec<_> = (0..20)
        .map(|_| tempfile::tempdir().expect("a folder"))
        .collect();
    thread::scope(|scope| {
        for (number, folder) in folders.iter().enumerate() {
            let server = &server;
            scope.spawn(move || {
                let mut history = open_history(folder.path());
                add_some(&mut history, 0..number as i64 + 1);
                let whose = cell_of(&mut history, &format!("cell {number}"));
                let mut database = server.open().expect("made");
                send(&mut database, &mut history, &whose).expect("sent");
            });
        }
    });
    for (number, folder) in folders.iter().enumerate() {
        let num = assert_same(&server, folder.path(), &format!("cell {number}"));
        assert_eq!(num, number + 1);
    }
    assert_eq!(
        server.sql("SELECT version FROM partsight.schema_version"),
        ["1"]
    );
}

#[test]
fn a_frame_that_is_not_kept_any_longer_takes_no_row_away_in_the_database() {
    let Some(server) = Postgres::start_new() else {
        return;
    };
    let (folder, mut history) = new_history();
    add_some(&mut history, 0..3);
    let whose = cell_of(&mut history, "cell7");
    let mut database = server.open().expect("made");
    send(&mut database, &mut history, &whose).expect("sent");
    let kept = "SELECT count(*) FROM partsight.inspection WHERE frame_bytes IS NOT NULL";
    assert_eq!(server.sql(kept), ["3"]);
    let file = rusqlite::Connection::open(folder.path().join(FILE)).expect("there");
    // Each takes more than the rule allows for all.
    file.execute_batch("UPDATE inspection SET frame_bytes = 20000000000")
        .expect("changed");
    let swept = history.sweep(&ALL, moment(3)).expect("swept");
    assert_eq!(swept.num_frames, 3);
    // Nor does a row that a user removes from the file.
    file.execute_batch("PRAGMA foreign_keys = ON; DELETE FROM inspection WHERE number = 2")
        .expect("removed");
    send(&mut database, &mut history, &whose).expect("sent");
    let found =
        "SELECT number || ' ' || (frame_bytes IS NULL) FROM partsight.inspection ORDER BY number";
    assert_eq!(server.sql(found), ["1 true", "2 false", "3 true"]);
    assert_eq!(history.num_unsent().expect("asked"), 0);
}

#[test]
fn the_name_of_another_history_is_refused_until_it_is_taken_over() {
    let Some(server) = Postgres::start_new() else {
        return;
    };
    let (first_folder, mut first) = new_history();
    let (_second_folder, mut second) = new_history();
    add_some(&mut first, 0..3);
    add_some(&mut second, 100..105);
    let (old, new) = (cell_of(&mut first, "cell7"), cell_of(&mut second, "cell7"));
    let mut database = server.open().expect("made");
    send(&mut database, &mut first, &old).expect("sent");
    let refused = send(&mut database, &mut second, &new).expect_err("another one");
    let is_taken = matches!(
        refused,
        TransferError::Database(DatabaseError::Taken { .. })
    );
    assert!(is_taken, "{refused}");
    assert_eq!(second.num_unsent().expect("asked"), 5);
    // The connection can still be used.
    assert_eq!(assert_same(&server, first_folder.path(), "cell7"), 3);
    database.take_over(&new).expect("taken");
    assert_eq!(send(&mut database, &mut second, &new).expect("sent"), 5);
    send(&mut database, &mut first, &old).expect_err("it is the other's now");
    let num = "SELECT inspection.history = cell.history, count(*) FROM partsight.inspection
        JOIN partsight.cell USING (cell) GROUP BY 1 ORDER BY 1";
    assert_eq!(server.sql(num), ["f|3", "t|5"]);
}

#[test]
fn a_copy_of_a_history_is_noticed_before_anything_is_mixed() {
    let Some(server) = Postgres::start_new() else {
        return;
    };
    let (folder, mut history) = new_history();
    add_some(&mut history, 0..2);
    let whose = cell_of(&mut history, "cell7");
    drop(history);
    let copy = tempfile::tempdir().expect("a folder");
    fs::copy(folder.path().join(FILE), copy.path().join(FILE)).expect("copied");
    let mut history = open_history(folder.path());
    let mut copied = open_history(copy.path());
    assert_eq!(cell_of(&mut copied, "cell7"), whose, "a copy tells nothing");
    add_some(&mut history, 10..11);
    add_some(&mut copied, 20..21);
    let mut database = server.open().expect("made");
    assert_eq!(send(&mut database, &mut history, &whose).expect("sent"), 3);
    let refused = send(&mut database, &mut copied, &whose).expect_err("another third one");
    let is_copied = matches!(
        refused,
        TransferError::Database(DatabaseError::Copied { .. })
    );
    assert!(is_copied, "{refused}");
    assert_eq!(assert_same(&server, folder.path(), "cell7"), 3);
    let other = cell_of(&mut copied, "cell8");
    assert_eq!(send(&mut database, &mut copied, &other).expect("sent"), 3);
    assert_eq!(assert_same(&server, copy.path(), "cell8"), 3);
}

#[test]
fn an_encrypted_connection_shows_a_certificate() {
    let Some(server) = Postgres::start_new() else {
        return;
    };
    let (folder, mut history) = new_history();
    add_some(&mut history, 0..3);
    let whose = cell_of(&mut history, "cell7");
    let address = format!("{}?sslmode=verify-full", server.address());
    let mut database = Database::open(&server.access_to(&address, server::PASSWORD)).expect("made");
    let encrypted = "SELECT count(*) FROM pg_stat_ssl JOIN pg_stat_activity USING (pid) WHERE usename = 'cell' AND ssl";
    assert_eq!(server.sql(encrypted), ["1"]);
    send(&mut database, &mut history, &whose).expect("sent");
    assert_eq!(assert_same(&server, folder.path(), "cell7"), 3);
}

#[test]
fn inspections_are_sent_as_they_come_and_each_outage_is_told_once() {
    let Some(mut server) = Postgres::start_new() else {
        return;
    };
    let (folder, mut history) = new_history();
    let cell = "cell7".parse().expect("a name");
    let sender = HistorySender::start(folder.path().to_owned(), server.access(), cell);
    let mut sender = sender.expect("started");
    add_some(&mut history, 0..5);
    wait_until("five are there", || server_count(&server) == "5");
    server.kill();
    // Adding does not wait for the server.
    add_some(&mut history, 5..305);
    wait_until("the outage is noticed", || sender.num_waiting() == 300);
    server.start();
    wait_until("all are there", || server_count(&server) == "305");
    wait_until("nothing waits", || sender.num_waiting() == 0);
    assert_eq!(assert_same(&server, folder.path(), "cell7"), 305);
    let news: Vec<SendNews> = std::iter::from_fn(|| sender.news()).collect();
    let num_connected = news
        .iter()
        .filter(|news| matches!(news, SendNews::Connected { .. }));
    assert_eq!(num_connected.count(), 2, "{news:?}");
    assert!(matches!(news[0], SendNews::Connected { .. }), "{news:?}");
    assert!(matches!(news[1], SendNews::Failed(_)), "{news:?}");
    add_some(&mut history, 400..401);
    assert_eq!(sender.end(), Ok(()), "the last one goes out at the end");
    assert_eq!(assert_same(&server, folder.path(), "cell7"), 306);
}

/// Number of inspections of the only cell; 0 as long as there is no table.
fn server_count(server: &Postgres) -> String {
    let has_tables = server.sql("SELECT to_regclass('partsight.inspection') IS NOT NULL");
    if has_tables != ["t"] {
        return "0".into();
    }
    server
        .sql("SELECT count(*) FROM partsight.inspection")
        .concat()
}
