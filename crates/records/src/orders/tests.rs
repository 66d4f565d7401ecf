use rand::{RngExt as _, SeedableRng as _};
use rand_pcg::Pcg64;

use super::*;
use geometry::{oriented_box::OrientedBox, units::Radians};
use inspection::fixtures::shipped_library;
use stages::rack::{MaxTurn, Place};

const TABLE: &str = "order;serial;parts\n4711;;front_door;fender\n";

fn parse(text: &str) -> Result<Orders, OrdersError> {
    Orders::parse(Path::new("orders.csv"), text)
}

/// The names that are expected for an order and a serial number, or why it is not known.
fn expected(orders: &Orders, order: &str, serial: &str) -> Result<Vec<String>, String> {
    let trace = Traceability {
        order: order.into(),
        serial: serial.into(),
        ..Traceability::default()
    };
    let library = shipped_library();
    let found = orders.expected(&trace, Some(Rack::ANYWHERE), |name| library.has_part(name));
    let found = found.map(|expected| {
        let parts = expected.parts().iter();
        parts.map(ToString::to_string).collect()
    });
    found.map_err(|error| format!("{error}: {}", error.advice()))
}

fn error_of(text: &str) -> String {
    let error = parse(text).expect_err(text);
    format!("{error}: {}", error.advice())
}

#[test]
fn the_same_table_is_read_however_a_spreadsheet_writes_it() {
    let usual = parse("order,serial,parts\n4711,,front_door|fender\n4711,S 1,grille\n");
    let usual = usual.expect("a table");
    for text in [
        "order;serial;parts\r\n4711;;\"front_door;fender\"\r\n4711;S 1;grille\r\n",
        "Parts\tNote\tSERIAL\t Order \nfront_door, fender\tx\t\t4711\ngrille\t\tS 1\t4711\n\t\t\t\n",
        "order,parts,serial\n4711,\"front_door,fender\"\n4711, grille ,S 1",
    ] {
        assert_eq!(parse(text).expect("a table"), usual, "{text}");
    }
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("orders.csv");
    std::fs::write(&path, format!("\u{feff}{TABLE}").replace("r;f", "r|f")).expect("written");
    let read = Orders::read(&path).expect("a table");
    assert_eq!(
        expected(&read, "4711", ""),
        Ok(vec!["front_door".into(), "fender".into()])
    );
    std::fs::write(&path, b"order,parts\n4711,T\xfcr\n").expect("written");
    let error = Orders::read(&path).expect_err("Latin-1");
    assert!(error.advice().contains("CSV UTF-8"), "{}", error.advice());
}

#[test]
fn a_part_of_an_order_may_have_a_place_of_the_rack() {
    let table = "order;parts\n4711;left hook=fender|grille\n4712;hook=fender\n4713;left hook=fender|left hook=grille\n";
    let orders = parse(table).expect("a table");
    let rack = Rack {
        places: vec![Place {
            name: "left hook".into(),
            region: OrientedBox {
                centre_m: [0.0; 3],
                size_m: [1.0; 3],
                angles_rad: [0.0; 3],
            },
            max_turn: MaxTurn::Total(Radians(1.0)),
            parts: Vec::new(),
        }],
        ..Rack::default()
    };
    let expected = |order: &str, rack: &Rack| {
        let trace = Traceability {
            order: order.into(),
            ..Traceability::default()
        };
        let expected = orders.expected(&trace, Some(rack), |_| true);
        expected.map_err(|error| format!("{error}: {}", error.advice()))
    };
    let of_order = expected("4711", &rack).expect("of the rack");
    let places: Vec<Option<&str>> = (of_order.parts().iter())
        .map(|part| part.place.as_deref())
        .collect();
    assert_eq!(places, [Some("left hook"), None]);
    for (order, rack, why) in [
        ("4711", Rack::ANYWHERE, "line 2, column parts"),
        ("4712", &rack, "Give a place of the rack: left hook"),
        (
            "4713",
            &rack,
            "two parts are expected at place \"left hook\"",
        ),
    ] {
        let error = expected(order, rack).expect_err(why);
        assert!(error.contains(why), "{error}");
    }
}

#[test]
fn lines_are_counted_from_the_hint_of_the_separator() {
    let error = error_of("sep=;\norder;parts\n4711;fender\n4712;\n");
    assert!(error.contains("line 4"), "{error}");
    let orders = parse(&format!("sep=;\r\n{}", TABLE.replace("r;f", "r|f"))).expect("a table");
    assert_eq!(
        expected(&orders, "4711", ""),
        Ok(vec!["front_door".into(), "fender".into()])
    );
}

#[test]
fn the_row_of_the_serial_number_comes_before_that_of_the_order() {
    let orders = parse(
        "order,serial,parts\n4711,,fender\n4711,S1,grille\n4712,S2,fender|fender\n4713,S2,grille\n4714,,bonnet\n",
    );
    let orders = orders.expect("a table");
    for (order, serial, parts) in [
        ("4711", "", &["fender"][..]),
        ("4711", "S1", &["grille"]),
        ("4711", "S9", &["fender"]),
        (" 4711 ", " S1 ", &["grille"]),
        ("", "S1", &["grille"]),
        ("4712", "S2", &["fender", "fender"]),
    ] {
        let parts: Vec<String> = parts.iter().map(|&part| part.into()).collect();
        assert_eq!(
            expected(&orders, order, serial),
            Ok(parts),
            "{order} {serial}"
        );
    }
    for (order, serial, what) in [
        ("", "", "no order is given"),
        ("471", "", "order 471 is not in the table"),
        ("471", "S1", "order 471 is not in the table"),
        ("", "S9", "serial number S9 is not in the table"),
        ("4712", "S9", "serial number S9 is not in the table"),
        ("4712", "", "order 4712 differs by serial number"),
        ("", "S2", "several orders have serial number S2"),
        ("4711", "S2", "serial number S2 is of order 4712, not 4711"),
        (
            "4714",
            "",
            "orders.csv, line 6, column parts: bonnet is expected, but not enrolled",
        ),
    ] {
        let error = expected(&orders, order, serial).expect_err(what);
        assert!(error.contains(what), "{error}");
    }
    for (error, ways) in [
        (OrderError::NotGiven, ["--order", "TRIGGER ORDER="]),
        (
            OrderError::SerialNotGiven {
                order: "4712".into(),
            },
            ["--serial", "TRIGGER SERIAL="],
        ),
    ] {
        let advice = error.advice();
        let says = |way: &str| advice.contains(way);
        assert!(ways.into_iter().all(says) && says("window"), "{advice}");
    }
}

#[test]
fn a_table_is_parsed_again_once_its_file_has_changed_and_only_then() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("orders.csv");
    let mut file = OrdersFile::at(&path);
    let parts = |table: &TableRead| {
        let table = table.as_ref().expect("a table");
        expected(table, "4711", "").expect("known").join(",")
    };
    let write = |part: &str, seconds_ago: u64| {
        std::fs::write(&path, format!("order;parts\n4711;{part}\n")).expect("written");
        let written = std::fs::File::options().write(true).open(&path);
        let at = SystemTime::now() - Duration::from_secs(seconds_ago);
        written.expect("there").set_modified(at).expect("dated");
        at
    };
    assert!(file.table().is_err());
    write("grille", 60);
    let first = file.table();
    assert_eq!(parts(&first), "grille");
    for _ in 0..3 {
        let again = file.table().expect("a table");
        assert!(Arc::ptr_eq(first.as_ref().expect("a table"), &again));
    }
    // As long as before.
    write("fender", 50);
    assert_eq!(parts(&file.table()), "fender");
    // On a disk that dates files roughly, it changes twice at one time.
    let at = write("grille", 0);
    assert_eq!(parts(&file.table()), "grille");
    write("fender", 0);
    let again = std::fs::File::options().write(true).open(&path);
    again.expect("there").set_modified(at).expect("dated");
    assert_eq!(parts(&file.table()), "fender");
    std::fs::remove_file(&path).expect("removed");
    assert!(file.table().is_err());
}

#[test]
fn a_file_that_could_not_be_read_is_tried_again_though_it_looks_the_same() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("orders.csv");
    let mut file = OrdersFile::at(&path);
    let at = SystemTime::now() - Duration::from_mins(1);
    let mut read = |bytes: &[u8]| {
        std::fs::write(&path, bytes).expect("written");
        let written = std::fs::File::options().write(true).open(&path);
        written.expect("there").set_modified(at).expect("dated");
        file.table()
    };
    let unread = read(b"order;parts\n4711;gr\xefll\xe9\n").expect_err("no UTF-8");
    assert!(matches!(*unread, OrdersError::File(_)), "{unread}");
    // A table with a fault is kept, and so is one without.
    let faulty = read(b"order;parts\n4711;      \n").expect_err("no parts");
    assert!(matches!(*faulty, OrdersError::Cell(_)), "{faulty}");
    let kept = read(b"order;parts\n4711;grille\n").expect_err("not read again");
    assert!(Arc::ptr_eq(&faulty, &kept), "{kept}");
}

#[test]
fn an_error_names_line_and_column() {
    let many = format!("order,parts\n1,{}\n", ["grille"; 9].join("|"));
    let long = format!("order,parts\n{},grille\n", "9".repeat(65));
    for (text, what) in [
        ("", "line 1: 0 columns are named order"),
        ("order,serial\n1,2\n", "line 1: 0 columns are named parts"),
        (
            "order,parts,Order\n1,grille,1\n",
            "line 1: 2 columns are named order",
        ),
        ("order,parts\n", "the table has no orders"),
        (
            "order,parts\r\n1,grille\r\n\r\n2,\r\n",
            "line 4, column parts: the cell is empty",
        ),
        (
            "order,parts\n1,;|\n",
            "line 2, column parts: the cell is empty",
        ),
        (
            "order,parts\n,grille\n",
            "line 2, column order: the cell is empty",
        ),
        (
            "order,serial,parts\n1,a,grille\n1,b,grille\n1,a,fender\n",
            "line 4, column order: the order and serial number are those of line 2",
        ),
        (
            "order,parts\n\"1,grille\n2,grille\n",
            "line 2, column order: the cell has line breaks",
        ),
        (
            &*many,
            "line 2, column parts: 9 parts are expected, and a frame can show 8",
        ),
        (
            &*long,
            "line 2, column order: the cell has line breaks, or more than 64 characters",
        ),
    ] {
        let error = error_of(text);
        assert!(error.contains(what), "{error}");
    }
}

#[test]
fn a_damaged_table_is_an_error_or_a_table_and_never_expects_nothing() {
    let mut random = Pcg64::seed_from_u64(1);
    let seed =
        "order;serial;parts\n4711;;\"front_door;fender\"\n4711;S 1;grille\n4712;;fender|fender\n";
    let marks = [
        "\"", ";", ",", "\n", "\r", "\u{feff}", "\0", "order", "ä", "|", "\t",
    ];
    let mut num_read = 0;
    for _ in 0..4000 {
        let mut text: Vec<char> = seed.chars().collect();
        for _ in 0..random.random_range(1..4) {
            let at = random.random_range(0..text.len());
            let to = (at + random.random_range(0..3)).min(text.len());
            let mark = marks[random.random_range(0..marks.len())];
            text.splice(at..to, mark.chars());
        }
        let Ok(orders) = parse(&text.into_iter().collect::<String>()) else {
            continue;
        };
        num_read += 1;
        for rows in orders.rows.values() {
            assert!(
                rows.values()
                    .all(|row| (1..=MAX_PARTS).contains(&row.parts.len()))
            );
        }
    }
    assert!(num_read > 100, "{num_read}");
}

#[test]
fn a_table_that_is_too_large_is_not_read() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("orders.csv");
    let file = std::fs::File::create(&path).expect("made");
    file.set_len(MAX_BYTES + 1).expect("long");
    let error = Orders::read(&path).expect_err("too long");
    assert!(matches!(error, OrdersError::File(_)), "{error}");
}

#[test]
fn what_is_longer_than_any_order_is_refused_before_the_table_is_searched() {
    let orders = parse("order;serial;parts\n4711;;front_door\n").expect("a table");
    let long = "9".repeat(Traceability::MAX_LETTERS + 1);
    for (order, serial) in [
        (&*long, ""),
        ("4711", &*long),
        ("47\n11", ""),
        ("4711", "a\tb"),
    ] {
        let why = expected(&orders, order, serial).expect_err("refused");
        assert!(why.contains("more than 64 characters"), "{why}");
    }
    assert!(expected(&orders, " 4711 ", &long[1..]).is_ok());
}
