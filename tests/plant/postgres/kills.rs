//! The program or the server is killed while it works.

use std::{
    env, fs,
    path::Path,
    process::{Command, Stdio, abort},
    thread,
    time::Duration,
};

use partsight::plant::database::{BATCH, Database, DatabaseAccess, HistorySender};

use crate::kit::{new_history, open_history};

use crate::postgres::{
    add_some, assert_same, cell_of,
    program::partsight,
    send,
    server::{PASSWORD, Postgres, wait_until},
};

/// Environment variables of the process that kills itself: the history's folder, and the server's address.
const FOLDER: &str = "PARTSIGHT_POSTGRES_TEST_FOLDER";
const ADDRESS: &str = "PARTSIGHT_POSTGRES_TEST_ADDRESS";

/// The process of its own: sends a batch, and ends before it can note that.
#[test]
fn body() {
    let (Some(folder), Ok(address)) = (env::var_os(FOLDER), env::var(ADDRESS)) else {
        return;
    };
    let folder = Path::new(&folder);
    let password = folder.join("password");
    let address = address.parse().expect("an address");
    let access = DatabaseAccess::new(address, Some(&password), None);
    let mut database = Database::open(&access.expect("usable")).expect("made");
    let mut history = open_history(folder);
    let whose = cell_of(&mut history, "cell7");
    let sent = database.send(&whose, || Ok(history.unsent(BATCH)?));
    assert_eq!(sent.expect("sent").num(), BATCH);
    abort();
}

#[test]
fn a_sender_that_is_killed_between_its_commit_and_its_note_sends_nothing_twice() {
    let Some(server) = Postgres::start_new() else {
        return;
    };
    let (folder, mut history) = new_history();
    fs::write(folder.path().join("password"), PASSWORD).expect("written");
    let num = BATCH + 10;
    add_some(&mut history, 0..num as i64);
    drop(history);
    for _ in 0..3 {
        let status = Command::new(env::current_exe().expect("this program"))
            .args(["postgres::kills::body", "--exact", "--test-threads=1"])
            .env(FOLDER, folder.path())
            .env(ADDRESS, server.address())
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .status();
        assert_eq!(status.expect("started").code(), None, "it killed itself");
        let there = server.sql("SELECT count(*) FROM partsight.inspection");
        assert_eq!(there, [BATCH.to_string()]);
    }
    let mut history = open_history(folder.path());
    assert_eq!(history.num_unsent().expect("asked"), num);
    let whose = cell_of(&mut history, "cell7");
    let mut database = server.open().expect("made");
    send(&mut database, &mut history, &whose).expect("sent");
    assert_eq!(assert_same(&server, folder.path(), "cell7"), num);
}

#[test]
fn a_program_that_is_killed_at_any_moment_loses_and_doubles_nothing() {
    let Some(server) = Postgres::start_new() else {
        return;
    };
    let (folder, mut history) = new_history();
    fs::write(folder.path().join("password"), PASSWORD).expect("written");
    let address = server.address();
    let place = folder.path().display().to_string();
    let args = ["history", "send", "--history", &place, "--to", &address];
    let rest = ["--cell", "cell7", "--database-password-file", "password"];
    let args = [&args[..], &rest].concat();
    for round in 0..15 {
        add_some(&mut history, round * 40..round * 40 + 40);
        let mut child = partsight(folder.path(), &args)
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .expect("starts");
        thread::sleep(Duration::from_millis(15 * round as u64));
        // It may have ended by itself.
        let _ = child.kill();
        child.wait().expect("ended");
    }
    let sent = partsight(folder.path(), &args).output().expect("starts");
    assert!(sent.status.success(), "{sent:?}");
    assert_eq!(assert_same(&server, folder.path(), "cell7"), 600);
    assert_eq!(history.num_unsent().expect("asked"), 0);
}

#[test]
fn a_server_that_is_killed_again_and_again_while_inspections_are_stored_has_all_of_them_once() {
    let Some(mut server) = Postgres::start_new() else {
        return;
    };
    let (folder, mut history) = new_history();
    let cell = "cell7".parse().expect("a name");
    let access = server.access();
    let sender = HistorySender::start(folder.path().to_owned(), access, cell);
    let mut sender = sender.expect("started");
    for round in 0..4 {
        add_some(&mut history, round * 1000..round * 1000 + 3 * BATCH as i64);
        // The kill comes while it sends them, or before.
        thread::sleep(Duration::from_millis(200 * round as u64));
        server.kill();
        history
            .set_remark(round + 1, "seen meanwhile")
            .expect("written");
        add_some(&mut history, round * 1000 + 700..round * 1000 + 710);
        server.start();
    }
    let num = 4 * (3 * BATCH + 10);
    wait_until("all are there", || {
        let there = crate::postgres::server_count(&server);
        there == num.to_string() && sender.num_waiting() == 0
    });
    assert_eq!(sender.end(), Ok(()));
    assert_eq!(assert_same(&server, folder.path(), "cell7"), num);
}
