//! A database that cannot be used gives an error with advice.

use std::fs;

use partsight::{
    Advice as _,
    plant::database::{Database, DatabaseError},
};

use crate::kit::open_history;

use crate::postgres::{
    add_some,
    program::run,
    server::{PASSWORD, Postgres},
};

/// Returns why a database at this address cannot be used with this password.
fn refused(server: &Postgres, address: &str, password: &str) -> DatabaseError {
    let opened = Database::open(&server.access_to(address, password));
    let error = opened.err().expect("it cannot be used");
    assert!(!error.advice().is_empty(), "{error}");
    assert!(!error.to_string().contains(password), "{error}");
    error
}

#[test]
fn what_cannot_be_used_says_why() {
    let Some(mut server) = Postgres::start_new() else {
        return;
    };
    let address = server.address();
    let error = refused(&server, &address, "wrong secret");
    assert!(matches!(error, DatabaseError::Refused { .. }), "{error}");
    assert!(error.advice().contains("--database-password-file"));
    let error = refused(&server, &server.address_of("nowhere"), PASSWORD);
    assert!(matches!(error, DatabaseError::NotFound { .. }), "{error}");
    let unknown = "postgres://cell@no-such-host.invalid/plant?sslmode=disable";
    let error = refused(&server, unknown, PASSWORD);
    assert!(
        matches!(error, DatabaseError::Unreachable { .. }),
        "{error}"
    );
    // A database that belongs to another user.
    let error = refused(&server, &server.address_of("postgres"), PASSWORD);
    assert!(matches!(error, DatabaseError::Forbidden { .. }), "{error}");
    assert!(error.advice().contains("GRANT"), "{}", error.advice());
    let empty = Database::open_to_read(&server.access());
    let empty = empty.err().expect("there is nothing");
    assert!(matches!(empty, DatabaseError::Empty { .. }), "{empty}");

    drop(server.open().expect("made"));
    server.sql("INSERT INTO partsight.schema_version (version) VALUES (7)");
    let newer = DatabaseError::Newer {
        database: Box::new(address.parse().expect("an address")),
        found: 7,
        known: 1,
    };
    assert_eq!(refused(&server, &address, PASSWORD), newer);
    let read = Database::open_to_read(&server.access());
    assert_eq!(read.err(), Some(newer));
    server.kill();
    let error = refused(&server, &address, PASSWORD);
    assert!(
        matches!(error, DatabaseError::Unreachable { .. }),
        "{error}"
    );
}

#[test]
fn the_program_says_what_to_do_and_keeps_the_history() {
    let Some(server) = Postgres::start_new() else {
        return;
    };
    let folder = tempfile::tempdir().expect("a folder");
    let mut history = open_history(&folder.path().join("here"));
    add_some(&mut history, 0..3);
    fs::write(folder.path().join("password"), "wrong secret").expect("written");
    let address = server.address();
    let send = ["history", "send", "--history", "here", "--to", &address];
    let rest = ["--cell", "cell7", "--database-password-file", "password"];
    let [_, output] = run(folder.path(), &[&send[..], &rest].concat(), 2);
    assert!(
        output.contains("refuses the connection") && output.contains("to do:"),
        "{output}"
    );
    assert!(!output.contains("wrong secret"), "{output}");
    assert_eq!(history.num_unsent().expect("asked"), 3);
    // Verdicts count even if the database refuses.
    let inspect = [
        "inspect",
        "--source",
        "simulated,fps=5:fender",
        "--frames",
        "1",
    ];
    let to = ["--history-to", &address, "--history", "here"];
    let [_, output] = run(folder.path(), &[&inspect[..], &to, &rest].concat(), 0);
    assert!(
        output.contains("Database: ") && output.contains("not in the plant's database yet"),
        "{output}"
    );
    for (args, words) in [
        (["--from", "postgres://me:hidden@db/parts"], "password"),
        (["--from", "me:hidden@db/parts"], "does not begin"),
        (["--database-password-file", "password"], "none is given"),
    ] {
        let args = [&["history", "list"][..], &args].concat();
        let [_, output] = run(folder.path(), &args, 2);
        assert!(
            output.contains(words) && output.contains("to do:"),
            "{output}"
        );
        assert!(!output.contains("hidden"), "{output}");
    }
}
