//! The built program: sending the history, and the overview of the cells.

use std::{fs, path::Path, process::Command};

use partsight::history::{SceneTitle, StoredVerdict};
use serde_json::{Value, json};

use crate::kit::{csv_column, history_entry, open_history};

use crate::postgres::{
    add, add_some, assert_same, cell_of, send,
    server::{PASSWORD, Postgres},
};

pub(crate) fn partsight(folder: &Path, args: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_partsight"));
    command
        .args(args)
        .current_dir(folder)
        .env_remove("DISPLAY")
        .env_remove("WAYLAND_DISPLAY")
        .env("XDG_DATA_HOME", folder.join("data"))
        .env("HOME", folder);
    command
}

/// Runs a command that must end with this code, and returns both outputs.
pub(crate) fn run(folder: &Path, args: &[&str], code: i32) -> [String; 2] {
    let output = partsight(folder, args).output().expect("starts");
    let words = [output.stdout, output.stderr];
    let words = words.map(|bytes| String::from_utf8_lossy(&bytes).into_owned());
    assert_eq!(output.status.code(), Some(code), "{words:?}");
    words
}

#[test]
fn an_overview_over_cells_is_listed_and_exported() {
    let Some(server) = Postgres::start_new() else {
        return;
    };
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("password"), PASSWORD).expect("written");
    let mut database = server.open().expect("made");
    let cells = ["cell7", "cell \"8\", b"];
    for (index, cell) in cells.iter().enumerate() {
        let mut history = open_history(&folder.path().join(index.to_string()));
        add_some(&mut history, 0..3 + index as i64);
        let mut late = history_entry(100 + index as i64, StoredVerdict::Accepted, "grille");
        late.record.summary.scene = SceneTitle::Named("\u{1b}[31mred, \"quoted\"".into());
        add(&mut history, &late);
        let whose = cell_of(&mut history, cell);
        send(&mut database, &mut history, &whose).expect("sent");
    }
    let address = server.address();
    let from = ["--from", &address, "--database-password-file", "password"];
    let with =
        |args: &[&str]| -> [String; 2] { run(folder.path(), &[args, &from[..]].concat(), 0) };
    let [table, notes] = with(&["history", "list"]);
    let heading = table.lines().next().expect("a heading");
    assert!(
        heading.starts_with("CELL") && heading.contains("VERDICT"),
        "{table}"
    );
    assert_eq!(table.lines().count(), 1 + 9, "{table}");
    assert!(!table.contains('\u{1b}'), "{table}");
    assert!(
        notes.contains("9 of 9 parts shown, 9 parts in all"),
        "{notes}"
    );
    assert!(notes.contains("cell7: 4, 2 of them accepted"), "{notes}");
    let [lines, _] = with(&["history", "list", "--json", "--part", "grille"]);
    let lines: Vec<Value> = lines
        .lines()
        .map(|line| serde_json::from_str(line).expect("JSON"))
        .collect();
    assert_eq!(lines.len(), 2, "the newest of each");
    assert_eq!(
        (&lines[0]["cell"], &lines[1]["cell"]),
        (&json!(cells[1]), &json!(cells[0]))
    );
    assert_eq!(lines[0]["schema"], 1);
    let [table, _] = with(&["history", "list", "--cell", "cell7", "--limit", "2"]);
    assert_eq!(table.lines().count(), 1 + 2, "{table}");

    // Both cells have a number 4; in the second it is no grille.
    let [cards, _] = with(&["history", "show", "4"]);
    let is_cell = |line: &&str| line.starts_with("cell ");
    assert_eq!(cards.lines().filter(is_cell).count(), 2, "{cards}");
    let [line, _] = with(&["history", "show", "4", "--json", "--cell", "cell7"]);
    let line: Value = serde_json::from_str(&line).expect("one line of JSON");
    assert_eq!(
        (&line["cell"], &line["part"], &line["frame_kept"]),
        (&json!("cell7"), &json!("grille"), &json!(true))
    );
    for (more, what) in [
        ("--again", "stays at its cell"),
        ("--json", "no inspection 99"),
    ] {
        let number = if more == "--again" { "4" } else { "99" };
        let show = ["history", "show", number, more];
        let [_, words] = run(folder.path(), &[&show[..], &from].concat(), 2);
        assert!(words.contains(what), "{words}");
    }

    with(&["history", "export", "--csv", "all.csv"]);
    let text = fs::read_to_string(folder.path().join("all.csv")).expect("written");
    let written = csv_column(&text, "cell");
    let are_known = written.iter().all(|cell| cells.contains(&cell.as_str()));
    assert!(written.len() == 9 && are_known, "{written:?}");
    let cases = ["history", "export", "--csv", "a.csv", "--cases", "cases"];
    let [_, words] = run(folder.path(), &[&cases[..], &from].concat(), 2);
    assert!(words.contains("frames"), "{words}");
    let unknown = ["history", "list", "--cell", "cell9"];
    let [_, words] = run(folder.path(), &[&unknown[..], &from].concat(), 2);
    assert!(
        words.contains("cell9") && words.contains("to do: Give one of"),
        "{words}"
    );
    // No data folder was created.
    assert!(!folder.path().join("data").exists());

    // A part that drifts at one of the cells.
    let mut history = open_history(&folder.path().join("0"));
    for index in 0..60_u8 {
        let mut entry = history_entry(200 + i64::from(index), StoredVerdict::Accepted, "hood");
        // The log odds of a score; those of 0.9 are 2.197.
        let log_odds = 4.0 - 0.02 * f64::from(index);
        entry.record.summary.score = Some([1.0 / (1.0 + (-log_odds).exp()), 0.8]);
        (entry.scene, entry.picture) = (None, None);
        add(&mut history, &entry);
    }
    let whose = cell_of(&mut history, cells[0]);
    send(&mut database, &mut history, &whose).expect("sent");
    let drift = ["history", "drift", "--json"];
    let [line, _] = run(folder.path(), &[&drift[..], &from].concat(), 1);
    let line: Value = serde_json::from_str(&line).expect("one line of JSON");
    assert_eq!(
        (&line["cell"], &line["part"], &line["inspections"]),
        (&json!("cell7"), &json!("hood"), &json!(60))
    );
    assert_eq!(line["quantities"][0]["trend"]["refuses_in"], 32);
}

#[test]
fn what_is_inspected_while_a_database_is_named_arrives_there() {
    let Some(server) = Postgres::start_new() else {
        return;
    };
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("password"), PASSWORD).expect("written");
    let address = server.address();
    let to = [
        "--history-to",
        &address,
        "--cell",
        "cell7",
        "--history",
        "here",
    ];
    let to = [&to[..], &["--database-password-file", "password"]].concat();
    let inspect = [
        "inspect",
        "--source",
        "simulated,fps=5:fender",
        "--frames",
        "1",
    ];
    let [_, words] = run(folder.path(), &[&inspect[..], &to].concat(), 0);
    assert!(!words.contains(PASSWORD), "{words}");
    // Send what was not sent in the last seconds of the run.
    let send = ["history", "send", "--history", "here", "--to", &address];
    let rest = ["--cell", "cell7", "--database-password-file", "password"];
    let [_, words] = run(folder.path(), &[&send[..], &rest].concat(), 0);
    assert!(
        words.contains("inspections sent to postgres://127.0.0.1"),
        "{words}"
    );
    let num = assert_same(&server, &folder.path().join("here"), "cell7");
    assert_eq!(num, 1, "one part hung there");
    // As if an older state of the database had been restored.
    server.sql("DELETE FROM partsight.detail");
    server.sql("DELETE FROM partsight.inspection");
    for (all, num) in [(&[][..], 0), (&["--all"], 1)] {
        let [_, words] = run(folder.path(), &[&send[..], &rest, all].concat(), 0);
        let expected = format!("{num} inspections sent");
        assert!(words.contains(&expected), "{words}");
    }
    let num = assert_same(&server, &folder.path().join("here"), "cell7");
    assert_eq!(num, 1, "sent again");
}
