//! `partsight evaluate`: cases are simulated, inspected, compared with an earlier run, and damaged.

use std::{
    fs,
    path::Path,
    process::{Command, Stdio},
};

use serde_json::Value;

use crate::workplace::{Ran, Workplace};

/// Leaves seven simulated cases there: two placements of three parts, and a box.
fn with_cases(place: &Workplace) {
    place.with_made(&["cases"], make_cases);
}

fn make_cases(place: &Workplace) {
    let parts = ["--part", "fender,grille,front_door", "--num", "6"];
    let simulate = ["simulate", "--cases", "cases", "--seed", "40"];
    let placements = ["--placement", "facing,placed"];
    place.accepted(&[&simulate[..], &parts, &placements].concat());
    let other = ["--part", "box", "--num", "1", "--difficulty", "unknown"];
    place.accepted(&[&simulate[..], &other].concat());
}

/// Names of the files in the folder and among its cases.
fn names(place: &Workplace) -> Vec<String> {
    let names = |folder: &Path| -> Vec<String> {
        let entries = fs::read_dir(folder).expect("listed");
        let names = entries.map(|e| e.expect("an entry").file_name());
        names.map(|n| n.to_string_lossy().into_owned()).collect()
    };
    let mut all = names(&place.path(""));
    all.extend(names(&place.path("cases")));
    // The program's data folder.
    all.retain(|name| name != "data");
    all.sort();
    all
}

/// The cases without their times.
fn cases_of(record: &Value) -> Vec<Value> {
    let mut cases = record["cases"].as_array().expect("cases").clone();
    for case in &mut cases {
        case.as_object_mut().expect("a case").remove("total_ms");
    }
    cases
}

#[test]
fn simulated_cases_are_evaluated_with_the_same_results_on_any_number_of_threads() {
    let place = Workplace::new();
    with_cases(&place);
    let evaluate = ["evaluate", "cases", "--json"];
    let out = place.accepted(&[&evaluate[..], &["a.json", "--report", "a.png"]].concat());
    for place in ["The results are in a.json", "The report is in a.png"] {
        assert!(out.err.contains(place), "{}", out.err);
    }
    let out = out.out;
    for expected in [
        "fender",
        "not_enrolled",
        "facing",
        "unknown",
        "Confusion matrix",
        "Calibration",
        "Pose of 6 right guesses",
    ] {
        assert!(out.contains(expected), "no {expected} in\n{out}");
    }
    let record = place.json("a.json");
    assert_eq!(record["schema"], 1);
    assert_eq!(record["tally"]["total"], 7);
    assert_eq!(record["tally"]["right"], 7);
    assert_eq!(record["pose_errors"]["num"], 6);
    let median = &record["pose_errors"]["median"];
    assert!(
        median["rotation_deg"].as_f64().expect("degrees") < 2.0,
        "{median}"
    );
    assert!(
        median["shift_mm"].as_f64().expect("millimetres") < 10.0,
        "{median}"
    );
    let difficulties: Vec<(&str, u64)> = record["by_difficulty"]
        .as_array()
        .expect("difficulties")
        .iter()
        .map(|d| {
            let num = d["tally"]["total"].as_u64().expect("a number");
            (d["difficulty"].as_str().expect("words"), num)
        })
        .collect();
    assert_eq!(difficulties, [("facing", 3), ("placed", 3), ("unknown", 1)]);
    let png = fs::read(place.path("a.png")).expect("drawn");
    assert!(png.starts_with(b"\x89PNG"));

    assert_eq!(record["changed"], Value::Null);
    let strict = ["c.json", "--set", "accept.min_score=1"];
    place.run(&[&evaluate[..], &strict].concat());
    let changed = &place.json("c.json")["changed"];
    assert_eq!(changed, &serde_json::json!(["accept.min_score=1"]));

    for threads in ["1", "3"] {
        let more = ["b.json", "--threads", threads, "--against", "a.json"];
        let out = place.accepted(&[&evaluate[..], &more].concat()).out;
        assert!(out.contains("7 cases of both: 0 worse, 0 better, 0 with another score"));
        assert_eq!(cases_of(&place.json("b.json")), cases_of(&record));
    }
}

#[test]
fn what_is_worse_than_before_is_listed_and_decides_the_exit_code() {
    let place = Workplace::new();
    with_cases(&place);
    place.accepted(&["evaluate", "cases", "--json", "now.json"]);
    let mut record = place.json("now.json");

    // Pretend that a fender was refused before, so that it has improved since.
    let mut cases = record["cases"].as_array_mut().expect("cases").iter_mut();
    let fender = cases.find(|case| case["name"] == "fender_facing_40");
    let found = &mut fender.expect("there")["found"];
    found["accepted"] = false.into();
    found["score"] = 0.5.into();
    fs::write(place.path("before.json"), record.to_string()).expect("written");
    let out = place
        .accepted(&["evaluate", "cases", "--against", "before.json"])
        .out;
    assert!(
        out.contains("0 worse, 1 better, 0 with another score"),
        "{out}"
    );

    // Without a pose, the paper's matcher accepts nothing, so every part that was right is worse.
    let worse = [
        "--against",
        "now.json",
        "--matcher",
        "paper",
        "--pose",
        "none",
    ];
    let out = place
        .coded(1, &[&["evaluate", "cases"], &worse[..]].concat())
        .out;
    assert!(
        out.contains("6 worse, 0 better, 1 with another score"),
        "{out}"
    );
    let line = out
        .lines()
        .find(|line| line.contains("worse: fender_facing_40"));
    let line = line.expect("named");
    assert!(
        line.contains("right before") && line.contains("refused now"),
        "{line}"
    );

    // Labelled as not enrolled, the grille is now a false accept.
    let toml = place.path("cases/grille_placed_44/case.toml");
    let text = fs::read_to_string(&toml).expect("read");
    let text = text.replace("is = \"part\"\npart = \"grille\"", "is = \"not_enrolled\"");
    fs::write(&toml, text).expect("written");
    let out = place.coded(1, &["evaluate", "cases"]).out;
    assert!(
        out.contains("grille_placed_44: false accept, it is not_enrolled"),
        "{out}"
    );
}

#[test]
fn damaged_cases_are_named_and_left_out() {
    let place = Workplace::new();
    with_cases(&place);
    let scene = place.path("cases/fender_facing_40/scene.png");
    let mut bytes = fs::read(&scene).expect("read");
    bytes[9000] ^= 1;
    fs::write(&scene, bytes).expect("written");
    fs::write(
        place.path("cases/grille_facing_41/case.toml"),
        "schema_version = 1",
    )
    .expect("written");
    let Ran { out, err, .. } = place.coded(2, &["evaluate", "cases", "--json", "a.json"]);
    assert!(
        err.contains("fender_facing_40 is damaged") && err.contains("its checksum"),
        "{err}"
    );
    assert!(err.contains("grille_facing_41 is damaged"), "{err}");
    assert!(out.contains("2 damaged and left out"));
    let record = place.json("a.json");
    assert_eq!(record["tally"]["total"], 5);
    assert_eq!(record["damaged"].as_array().expect("named").len(), 2);
}

#[test]
fn what_cannot_be_evaluated_is_said_in_words() {
    let place = Workplace::new();
    fs::create_dir(place.path("cases")).expect("made");
    fs::write(place.path("newer.json"), "{\"schema\":2}").expect("written");
    fs::write(place.path("other.json"), "{\"schema\":1}").expect("written");
    for (args, expected) in [
        (&["evaluate", "cases"][..], "there are no cases"),
        (&["evaluate", "nowhere"], "no such folder"),
        (
            &["evaluate", "cases", "--against", "none.json"],
            "none.json",
        ),
        (
            &["evaluate", "cases", "--against", "newer.json"],
            "newer version",
        ),
        (
            &["evaluate", "cases", "--against", "other.json"],
            "not an evaluation",
        ),
        (
            &["evaluate", "cases", "--json", "x", "--report", "x"],
            "Give two different files",
        ),
        (
            &["simulate", "--part", "all", "--out", "x.pcd"],
            "one file shows one part",
        ),
        (
            &["simulate", "--cases", "c", "--out", "x.pcd"],
            "cannot be used with",
        ),
        (
            &[
                "simulate", "--part", "box", "--out", "x.pcd", "--noise", "9",
            ],
            "0 to 5",
        ),
    ] {
        let err = place.coded(2, args).err;
        assert!(err.contains(expected), "{args:?}: {err}");
    }
    assert_eq!(names(&place), ["cases", "newer.json", "other.json"]);
}

#[test]
fn cases_do_not_get_into_a_library() {
    let place = Workplace::new();
    place.with_part("fender");
    let before = fs::read_dir(place.path("parts")).expect("listed").count();
    let err = place.coded(2, &["evaluate", "parts"]).err;
    assert!(err.contains("simulate --cases NEW_FOLDER"), "{err}");
    for folder in ["parts", "parts/fender"] {
        let err = place
            .coded(2, &["simulate", "--cases", folder, "--num", "1"])
            .err;
        assert!(err.contains("holds parts of a library"), "{err}");
    }
    let after = fs::read_dir(place.path("parts")).expect("listed").count();
    assert_eq!(after, before);
}

/// Each case has its own seed, so that a folder of cases can be reproduced to the last byte.
#[test]
fn the_same_arguments_make_the_same_cases() {
    let place = Workplace::new();
    make_cases(&place);
    let again = Workplace::new();
    make_cases(&again);
    assert_eq!(names(&place), names(&again));
    for case in names(&place).iter().filter(|name| name.contains("facing")) {
        for file in ["case.toml", "scene.png", "intrinsics.json"] {
            let path = format!("cases/{case}/{file}");
            let read = |place: &Workplace| fs::read(place.path(&path)).expect("read");
            assert!(read(&place) == read(&again), "{path}");
        }
    }
}

#[cfg(unix)]
#[test]
fn ctrl_c_leaves_nothing_half_written() {
    use std::{os::unix::process::ExitStatusExt as _, thread, time::Duration};

    let place = Workplace::new();
    let simulate = ["simulate", "--cases", "cases", "--num", "24"];
    place.accepted(&[&simulate[..], &["--placement", "facing"]].concat());
    // Creates the library.
    place.accepted(&["library", "list"]);
    let before = names(&place);
    let mut running = place
        .command(&["evaluate", "cases", "--json", "a.json", "--report", "a.png"])
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .expect("starts");
    thread::sleep(Duration::from_millis(150));
    let killed = Command::new("kill")
        .args(["-INT", &running.id().to_string()])
        .status();
    assert!(killed.expect("kill").success());
    let status = running.wait().expect("ended");
    // On a quick machine it may have ended before the kill, and written both.
    if status.signal().is_some() {
        assert_eq!(names(&place), before);
    } else {
        assert!(place.path("a.json").exists() && place.path("a.png").exists());
    }
}
