//! The check of the cell.

use crate::workplace::Workplace;

/// A simulated camera that looks at a fender at this distance.
fn fender_at(distance: &str) -> String {
    format!("simulated,pose=5deg -10deg 3deg 20mm -30mm {distance}:fender")
}

#[test]
fn a_part_that_moved_is_found_told_and_listed() {
    let place = Workplace::new();
    let check = |code: i32, distance: &str| {
        let source = fender_at(distance);
        let args = [
            "cell", "check", "--source", &source, "--frames", "3", "--json",
        ];
        place.coded(code, &args).json()
    };
    let none = place.coded(2, &["cell", "check", "--source", "simulated:fender"]);
    assert!(none.err.contains("partsight cell baseline"), "{}", none.err);
    let empty = place.accepted(&["cell", "list"]);
    assert!(empty.out.contains("No check yet"), "{}", empty.out);

    let source = fender_at("1400mm");
    let taken = place.accepted(&["cell", "baseline", "--source", &source]);
    assert!(taken.out.contains("5 simulated frames"), "{}", taken.out);
    let still = check(0, "1400mm");
    assert_eq!(still["finding"], "in_place");
    assert_eq!(still["num_frames"], 3);
    assert_eq!(still["is_simulated"], true);
    let moved = check(1, "1412mm");
    assert_eq!(moved["finding"], "part_moved");
    let z = moved["shift_m"][2].as_f64().expect("a number");
    assert!((z - 0.012).abs() < 0.002, "{moved}");

    let read = place.accepted(&["cell", "list"]);
    assert!(
        read.out.contains("camera and part are in place"),
        "{}",
        read.out
    );
    assert!(read.out.contains("the part moved"), "{}", read.out);
    assert!(read.out.starts_with("TIME"), "{}", read.out);
    let lines = place.accepted(&["cell", "list", "--json"]).out;
    assert_eq!(lines.lines().count(), 2);
    place.accepted(&["cell", "list", "--csv", "drift.csv"]);
    let table = place.read("drift.csv");
    let rows: Vec<usize> = table.lines().map(|row| row.split(',').count()).collect();
    assert_eq!(rows, [12, 12, 12], "{table}");
    // A check of files, kept out of the list.
    let pose = "5deg -10deg 3deg 20mm -30mm 1400mm";
    place.accepted(&[
        "simulate", "--part", "fender", "--pose", pose, "--out", "now.pcd",
    ]);
    let reply = place.run(&["cell", "check", "now.pcd", "--no-list"]);
    // In a cell of another seed the wall stands elsewhere.
    assert!(reply.out.contains("in place"), "{}", reply.out);
    assert_eq!(place.accepted(&["cell", "list", "--json"]).out, lines);
}

#[test]
fn what_cannot_be_compared_says_why() {
    let place = Workplace::new();
    place.accepted(&["cell", "baseline", "--source", "simulated:fender"]);
    let output = |args: &[&str]| {
        let all = [&["cell"], args].concat();
        place.coded(2, &all).err
    };
    let other = output(&["check", "--source", "simulated:front_door"]);
    assert!(
        other.contains("lies on the part of the baseline"),
        "{other}"
    );
    assert!(other.contains("Hang the part"), "{other}");
    let nothing = output(&["check", "--source", "simulated:empty"]);
    assert!(nothing.contains("nothing the size of a part"), "{nothing}");
    assert!(output(&["check", "missing.pcd"]).contains("no such file"));
    assert!(
        output(&["check", "--frames", "99", "--source", "simulated:fender"]).contains("1..=16")
    );
    assert!(output(&["baseline", "x.pcd", "--max-shift", "0"]).contains("from 0.5 to 100"));
    let listed = place.accepted(&["cell", "list", "--json"]);
    assert_eq!(listed.out, "");
    place.write(
        "data/partsight/cell-check/baseline.toml",
        "schema_version = 7",
    );
    let newer = output(&["check", "--source", "simulated:fender"]);
    assert!(
        newer.contains("newer version") && newer.contains("Update"),
        "{newer}"
    );
}
