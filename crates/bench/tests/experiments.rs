//! The program `partsight-bench`: its measurements and pictures.

#![allow(clippy::disallowed_methods, reason = "tests change files")]

#[allow(dead_code, reason = "the tests of the commands use the rest")]
#[path = "../../../tests/command/workplace.rs"]
mod workplace;

use std::{fs, path::Path};

use bench::cli::Cli;
use clap::Parser as _;
use serde_json::Value;

use self::workplace::Workplace;
use files::write_depth_png;
use simulate::{CellSetup, PartKind, Side, frame};

/// The tested program.
const PROGRAM: &str = env!("CARGO_BIN_EXE_partsight-bench");

#[test]
fn every_command_of_the_guide_is_one() {
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/guide/parameters.md");
    let text = fs::read_to_string(page).expect("text");
    let calls = text
        .lines()
        .filter_map(|line| line.split_once("-p partsight-bench -- "));
    let mut num_commands = 0;
    for (_, call) in calls {
        num_commands += 1;
        let words = call.split(" #").next().unwrap_or("").split_whitespace();
        if let Err(error) = Cli::try_parse_from(["partsight-bench"].into_iter().chain(words)) {
            panic!("{call}\n{error}");
        }
    }
    assert!(num_commands > 2, "{num_commands} commands");
}

#[test]
fn table_1_is_written_and_icp_ga_and_global_solve_t1_to_t5_where_icp_alone_does_not() {
    let place = Workplace::new();
    let ran = place.accepted(&[
        "table1", "--part", "grille", "--json", "t.json", "--csv", "t.csv",
    ]);
    assert!(ran.out.contains("icp-ga  5/5"), "{}", ran.out);
    let text = fs::read_to_string(place.path("t.json")).expect("written");
    let file: Value = serde_json::from_str(&text).expect("JSON");
    let attempts = file["attempts"].as_array().expect("a list");
    assert_eq!(attempts.len(), 15);
    for attempt in attempts {
        let number = |name: &str| attempt[name].as_f64();
        let is_below = number("e_m2").is_some_and(|e_m2| e_m2 < 1e-6);
        assert_eq!(is_below, attempt["method"] != "icp", "{attempt}");
        if is_below {
            let turn = number("rotation_error_deg").expect("a number");
            let shift = number("shift_error_mm").expect("a number");
            assert!(turn < 0.01 && shift < 0.1, "{attempt}");
        }
        assert_eq!(attempt["part"], "grille");
    }
    let rows = fs::read_to_string(place.path("t.csv")).expect("written");
    assert_eq!(rows.lines().count(), 16);
    let unknown = place.run(&["table1", "--part", "wing"]);
    assert_eq!(unknown.code, 2);
    assert!(unknown.err.contains("no part wing"), "{}", unknown.err);
}

#[test]
fn recognition_is_measured_beside_the_other_systems_and_its_worst_confusions_are_drawn() {
    let place = Workplace::new();
    let ran = place.accepted(&[
        "recognition",
        "--suite",
        "standard",
        "--poses",
        "1",
        "--json",
        "r.json",
        "--pictures",
        "why",
    ]);
    for output in [
        "standard",
        "SHOT",
        "paper's sources for its four are not known",
    ] {
        assert!(ran.out.contains(output), "{output}: {}", ran.out);
    }
    let text = fs::read_to_string(place.path("r.json")).expect("written");
    let file: Value = serde_json::from_str(&text).expect("JSON");
    let list = |value: &Value| value.as_array().expect("a list").len();
    assert_eq!(list(&file["suites"][0]["cases"]), 8);
    assert_eq!(list(&file["table1"]["frames"]), 8);
    let systems = file["table1"]["systems"].as_array().expect("a list");
    let names: Vec<&str> = systems
        .iter()
        .filter_map(|s| s["system"].as_str())
        .collect();
    let known = [
        "paper",
        "rank",
        "confirmed",
        "vfh",
        "spin_images",
        "fpfh",
        "shot",
    ];
    assert_eq!(names, known);
    for (system, name) in systems.iter().zip(known) {
        assert!(system["median_ms"].as_f64().is_some_and(|ms| ms > 0.0));
        assert_eq!(system["by_suite"][0]["num_frames"], 8);
        // The paper's matcher is right on about two of three frames.
        let least = if name == "paper" { 3 } else { 7 };
        let num_right = system["num_right"].as_u64().expect("a count");
        assert!(num_right >= least, "{system}");
        let is_descriptor = !["paper", "rank", "confirmed"].contains(&name);
        for rows in ["num_rows", "num_reference_rows"] {
            assert_eq!(system[rows].is_number(), is_descriptor, "{system}");
        }
    }
    assert_eq!(list(&file["closest"]), 8);
    let figures = &file["figures"][0];
    assert_eq!(figures["num_in_sight"], 8);
    let num_accepted = figures["num_accepted"].as_u64().expect("a count");
    let is_accepted = |case: &&Value| case["accepted"] == true && case["found"] == case["expected"];
    let cases = file["suites"][0]["cases"].as_array().expect("a list");
    assert_eq!(
        cases.iter().filter(is_accepted).count() as u64,
        num_accepted
    );
    assert!(figures["iou_median"].as_f64().is_some_and(|iou| iou > 0.9));
    assert!(ran.out.contains("bounds hold"), "{}", ran.out);
    let drawn = fs::read_dir(place.path("why")).expect("a folder");
    let drawn = drawn.filter_map(|entry| entry.ok()?.file_name().into_string().ok());
    let num_contenders = drawn.filter(|name| name.ends_with(".contenders.png"));
    assert_eq!(num_contenders.count(), 8);

    let gone = place.run(&["speed", "--only-ours"]);
    assert_eq!(gone.code, 2);
    assert!(
        gone.err.contains("unexpected argument '--only-ours'"),
        "{}",
        gone.err
    );
}

#[test]
fn racks_are_measured_part_by_part() {
    let place = Workplace::new();
    let racks = ["recognition", "--suite", "rack", "--poses", "1"];
    let ran = place.accepted(&[&racks[..], &["--only-ours", "--json", "r.json"]].concat());
    let text = fs::read_to_string(place.path("r.json")).expect("written");
    let file: Value = serde_json::from_str(&text).expect("JSON");
    let suites = file["suites"].as_array().expect("a list");
    let figures = file["racks"].as_array().expect("a list");
    assert_eq!((suites.len(), figures.len()), (8, 8));
    for (suite, figures) in suites.iter().zip(figures) {
        let name = suite["suite"].as_str().expect("a name");
        assert_eq!(figures["suite"], name);
        assert!(ran.out.contains(name), "{name}: {}", ran.out);
        // The first rack has two places.
        let cases = suite["cases"].as_array().expect("a list");
        let on_rack = |case: &&Value| case.get("surplus").is_none();
        let num_hung = if name == "rack_empty" { 1 } else { 2 };
        assert_eq!(cases.iter().filter(on_rack).count(), num_hung, "{name}");
        let num_parts = cases.iter().filter(|case| case["expected"].is_string());
        assert_eq!(figures["num_parts"], num_parts.count(), "{name}");
        let one_of_two = ["rack_mirrored", "rack_foreign"].contains(&name);
        assert_eq!(figures["num_unknown"], usize::from(one_of_two), "{name}");
    }
    assert!(ran.out.contains("accepted twice"), "{}", ran.out);
}

#[test]
fn whole_inspections_are_timed_by_set_and_compared_with_an_earlier_run() {
    let place = Workplace::new();
    // Half an hour per inspection.
    let before = r#"{"set":"placed","num_frames":8,"median_ms":2e6,"p95_ms":2e6,"longest_ms":2e6}"#;
    fs::write(
        place.path("before.json"),
        format!(r#"{{"sets":[{before}]}}"#),
    )
    .expect("written");
    let one = ["speed", "--poses", "1", "--json", "now.json"];
    let sets = ["--suite", "placed", "--suite", "standard"];
    let ran = place.accepted(&[&one[..], &sets, &["--compare", "before.json"]].concat());
    let text = fs::read_to_string(place.path("now.json")).expect("written");
    let now: Value = serde_json::from_str(&text).expect("JSON");
    for (set, name) in ["placed", "standard"].into_iter().enumerate() {
        let set = &now["sets"][set];
        assert_eq!((&set["set"], &set["num_frames"]), (&name.into(), &8.into()));
    }
    let row = |set: &str| {
        let line = ran.out.lines().find(|line| line.starts_with(set));
        line.expect("a row").split_whitespace().collect::<Vec<_>>()
    };
    assert_eq!(row("placed")[8], "0.00", "{}", ran.out);
    assert_eq!(row("standard")[8..], ["-", "-", "-"], "{}", ran.out);

    let fender = CellSetup::with_part(PartKind::Fender, Side::Left, 0, 1);
    write_depth_png(&place.path("frame.png"), &frame(&fender).frame).expect("written");
    // A folder with a scene and something else.
    fs::create_dir_all(place.path("frames/none")).expect("made");
    write_depth_png(&place.path("frames/frame.png"), &frame(&fender).frame).expect("written");
    fs::write(place.path("frames/about.md"), "").expect("written");
    let ran = place.accepted(&["speed", "--files", "frames", "frame.png"]);
    assert!(ran.out.starts_with("2 files"), "{}", ran.out);

    fs::write(place.path("note.txt"), "{}").expect("written");
    for (wrong, why) in [
        (&["--files", "gone.ply"][..], "gone.ply"),
        (&["--files", "frames/none"], "no scene in it"),
        (&["--compare", "note.txt"], "is no measurement of speed"),
        // What it has written itself is one.
        (
            &["--compare", "now.json", "--files", "gone.ply"],
            "gone.ply",
        ),
        (
            &["--files", "frame.png", "--poses", "2"],
            "cannot be used with",
        ),
    ] {
        let ran = place.run(&[&["speed"][..], wrong].concat());
        assert_eq!(ran.code, 2, "{}", ran.err);
        assert!(ran.err.contains(why), "{}", ran.err);
    }
}

#[test]
fn protocols_are_timed_beside_bare_exchanges_and_direct_calls() {
    let place = Workplace::new();
    let ran = place.accepted(&["serve", "--poses", "1", "--json", "s.json"]);
    let text = fs::read_to_string(place.path("s.json")).expect("written");
    let file: Value = serde_json::from_str(&text).expect("JSON");
    let mut protocols = vec!["ascii", "binary", "eki", "urscript"];
    if cfg!(feature = "plant") {
        protocols.push("http");
    }
    let rows = |list: &str| {
        let rows = file[list].as_array().expect("a list");
        let names: Vec<&str> = rows.iter().filter_map(|r| r["protocol"].as_str()).collect();
        assert_eq!(names, protocols, "{list}");
        rows
    };
    let number = |value: &Value| value.as_f64().filter(|number| *number > 0.0);
    let assert_ratio = |row: &Value, beside: &Value| {
        for (ratio, name) in [
            ("median", "median_ms"),
            ("p99", "p99_ms"),
            ("per_s", "per_s"),
            ("busy_per_s", "busy_per_s"),
        ] {
            let [found, of, by] = [&row["ratios"][ratio], &row["times"][name], &beside[name]]
                .map(|value| number(value).unwrap_or_else(|| panic!("{name}: {row} {beside}")));
            assert!((found - of / by).abs() < 1e-6 * found, "{name}: {row}");
        }
    };
    for row in rows("status") {
        assert_eq!(row["times"]["num"], 5000);
        assert_eq!(row["bare"]["num"], 5000);
        assert_ratio(row, &row["bare"]);
    }
    let binary = &rows("status")[1];
    assert_eq!(
        (&binary["request_bytes"], &binary["answer_bytes"]),
        (&20.into(), &256.into())
    );
    let direct = &file["direct"];
    assert_eq!(direct["num"], 8);
    for row in rows("triggers") {
        assert_eq!(row["times"]["num"], 8);
        assert_ratio(row, direct);
    }
    for output in ["status", "called directly", "urscript"] {
        assert!(ran.out.contains(output), "{output}: {}", ran.out);
    }
}

#[test]
fn runs_of_servoing_that_processes_share_are_shown_together_and_none_counts_twice() {
    let place = Workplace::new();
    let made = place.accepted(&["servo", "--runs", "1", "--first", "2", "--json", "a.json"]);
    let acceptance = |out: &str| {
        let (_, figures) = out
            .split_once("undisturbed, to camera poses:")
            .expect("shown");
        figures.to_owned()
    };
    let figures = acceptance(&made.out);
    assert!(
        figures.contains("1 of 1 at the target, 100.0 %"),
        "{figures}"
    );
    assert!(
        figures.contains("of 3 runs, wanted 0: beyond a limit"),
        "{figures}"
    );
    let read = place.accepted(&["servo", "--read", "a.json"]);
    assert_eq!(acceptance(&read.out), figures);
    let twice = place.coded(2, &["servo", "--read", "a.json", "a.json"]).err;
    assert!(
        twice.contains("also in another file") && twice.contains("to do"),
        "{twice}"
    );
}
