//! Inspecting scenes.

use std::{fs, path::Path};

use serde_json::Value;

use crate::{
    kit::csv_column,
    workplace::{Workplace, matrix},
};

#[test]
fn the_pose_is_that_of_the_simulation() {
    let place = Workplace::new();
    place.with_part("front_door");
    let moved = [
        "simulate",
        "--part",
        "front_door",
        "--pose",
        "5deg -10deg 20deg 40mm -30mm 1600mm",
    ];
    place.accepted(&[&moved[..], &["--out", "moved.png", "--truth", "truth.json"]].concat());
    let line = &place
        .accepted(&["inspect", "moved.png", "--json", "--library", "parts"])
        .lines()[0];
    let found = matrix(&line["pose"]["camera_from_part"]);
    let truth: Value =
        serde_json::from_slice(&fs::read(place.path("truth.json")).expect("written"))
            .expect("JSON");
    // Part space is the camera frame at enrolment, 1.4 m in front of the part; the truth refers to the model's frame
    // in its middle.
    let model = matrix(&truth["camera_from_model"]);
    for row in 0..3 {
        let [c, d] = [2, 3].map(|column| found[row * 4 + column]);
        for column in 0..3 {
            let difference = (found[row * 4 + column] - model[row * 4 + column]).abs();
            assert!(
                difference < 0.02,
                "the turn is off by {difference} in row {row}"
            );
        }
        let difference = (c * 1.4 + d - model[row * 4 + 3]).abs();
        assert!(
            difference < 0.01,
            "the middle is off by {difference} m in row {row}"
        );
    }
}

#[test]
fn a_surface_is_averaged_over_frames_of_a_standing_part_and_only_if_asked_for() {
    let place = Workplace::new();
    place.with_part("fender");
    for seed in ["1", "2", "3"] {
        let out = format!("{seed}.png");
        let pose = "2deg -3deg 5deg 0mm 0mm 1200mm";
        place.accepted(&[
            "simulate", "--part", "fender", "--pose", pose, "--seed", seed, "--out", &out,
        ]);
    }
    let frames = ["inspect", "1.png", "2.png", "3.png", "--library", "parts"];
    let averaged = [&frames[..], &["--surface", "--average", "3"]].concat();
    let ran = place.run(&[&averaged[..], &["--json"]].concat());
    let lines = ran.lines();
    let [line] = &lines[..] else {
        panic!("{}", ran.out);
    };
    let surface = &line["surface"];
    assert_eq!(line["accepted"], true, "{line}");
    assert_eq!(surface["measured"]["frames"], 3, "{line}");
    let between = surface["measured"]["noise_between_m"].as_f64();
    let noise = surface["measured"]["noise_m"].as_f64();
    assert!(noise.is_some_and(|noise| noise < 0.005), "{line}");
    assert!(between.is_some_and(|between| between > 0.0), "{line}");
    // The surface decides the exit code, too.
    assert_eq!(ran.code, i32::from(surface["verdict"] != "ok"), "{line}");
    let card = place.run(&averaged).out;
    assert!(card.contains("3 frames averaged"), "{card}");
    let plain = place.accepted(&[&frames[..], &["--json"]].concat());
    let lines = plain.lines();
    assert_eq!(lines.len(), 3);
    assert!(lines.iter().all(|line| line.get("surface").is_none()));

    // The zones of a part ask for it.
    let library = ["--library", "parts"];
    let set = ["library", "surface", "fender", "--check", "true"];
    let set = [&set[..], &["--tolerance", "30"], &library].concat();
    assert!(place.accepted(&set).out.contains("good up to 30 mm"));
    let checked = place.run(&["inspect", "1.png", "--json", "--library", "parts"]);
    let verdict = checked.lines()[0]["surface"]["verdict"].clone();
    assert!(verdict == "ok" || verdict == "not_judged", "{verdict}");
    let refused = place.run(&["inspect", "1.png", "--average", "3"]);
    assert_eq!(refused.code, 2, "{}", refused.err);
}

/// Writes a depth image of two parts: at each pixel the nearer reading of two frames with one of them each.
fn two_parts(place: &Workplace, merged: &str) {
    place.with_made(&["two parts", merged], |place| {
        make_two_parts(place, merged);
    });
}

fn make_two_parts(place: &Workplace, merged: &str) {
    for (part, pose, name) in [
        ("front_door", "0deg 0deg 6deg -500mm 0mm 1900mm", "left"),
        ("trunk_lid", "0deg 0deg -11deg 520mm 0mm 1950mm", "right"),
    ] {
        let out = format!("{name}.png");
        place.accepted(&[
            "simulate", "--part", part, "--pose", pose, "--seed", "7", "--out", &out,
        ]);
    }
    let read = |name: &str| {
        let image = image::open(place.path(name)).expect("a picture");
        image.into_luma16()
    };
    let (left, mut both) = (read("left.png"), read("right.png"));
    for (depth, left) in both.iter_mut().zip(left.iter()) {
        *depth = match (*depth, *left) {
            (0, other) | (other, 0) => other,
            (a, b) => a.min(b),
        };
    }
    both.save(place.path(merged)).expect("written");
    let camera = Path::new(merged).with_extension("json");
    let camera = place.path(camera.to_str().expect("ASCII"));
    fs::copy(place.path("left.json"), camera).expect("copied");
}

#[test]
fn several_parts_are_listed_from_left_to_right_each_with_its_row_in_the_history() {
    let place = Workplace::new();
    place.with_part("front_door");
    place.with_part("trunk_lid");
    two_parts(&place, "both.png");
    let inspect = ["inspect", "both.png", "--library", "parts"];
    let several = ["--set", "segment.max_parts=4"];
    let line = &place
        .accepted(&[&inspect[..], &several, &["--json", "--history", "history"]].concat())
        .lines()[0];
    let parts = line["parts"].as_array().expect("a list");
    let names: Vec<&Value> = parts.iter().map(|part| &part["part"]).collect();
    assert_eq!(names, ["front_door", "trunk_lid"]);
    assert!(parts.iter().all(|part| part["accepted"] == true), "{line}");
    for field in ["part", "score", "pose", "status"] {
        assert_eq!(
            line[field], parts[0][field],
            "those of the line are of the first"
        );
    }
    let card = place.run(&[&inspect[..], &several].concat()).out;
    let at = |words: &str| {
        card.find(words)
            .unwrap_or_else(|| panic!("{words} in {card}"))
    };
    assert!(at("1 of 2") < at("front_door: accepted"));
    assert!(at("front_door: accepted") < at("2 of 2") && at("2 of 2") < at("trunk_lid: accepted"));
    let listed = place.run(&["history", "list", "--history", "history", "--json"]);
    assert_eq!(listed.lines().len(), 2, "{}", listed.out);

    // Each row is inspected again as the part that it is of.
    place.accepted(&["history", "keep", "all", "--history", "history"]);
    place.accepted(&[&inspect[..], &several, &["--history", "history"]].concat());
    for (number, part) in [("3", "front_door"), ("4", "trunk_lid")] {
        let again = [
            "history",
            "show",
            number,
            "--again",
            "--json",
            "--history",
            "history",
        ];
        let again = &place
            .accepted(&[&again[..], &["--library", "parts"]].concat())
            .lines()[0];
        assert_eq!(again["nearest"], part, "{again}");
        assert_eq!(again["again"]["nearest"], part, "{again}");
        assert_eq!(again["again"]["pose_shift_m"], 0.0, "{again}");
    }

    // By default, one.
    let one = &place.run(&[&inspect[..], &["--json"]].concat()).lines()[0];
    assert!(one.get("parts").is_none(), "{one}");
}

#[test]
fn a_wrong_part_a_missing_one_and_one_too_many_are_told_by_what_is_expected() {
    let place = Workplace::new();
    for part in ["front_door", "trunk_lid", "grille"] {
        place.with_part(part);
    }
    two_parts(&place, "both.png");
    let expecting = |names: &str, options: &[&str]| {
        let inspect = [
            "inspect",
            "both.png",
            "--library",
            "parts",
            "--expect",
            names,
        ];
        place.run(&[&inspect[..], options].concat())
    };
    let json = |names: &str, code: i32| {
        let ran = expecting(names, &["--json", "--history", "history"]);
        assert_eq!(ran.code, code, "{names}: {}", ran.err);
        ran.lines().remove(0)
    };
    let reasons = |line: &Value| -> Vec<[String; 2]> {
        let parts = line["parts"].as_array().expect("a list").iter();
        let text = |value: &Value| value.as_str().unwrap_or_default().to_owned();
        parts
            .map(|part| [text(&part["part"]), text(&part["reason_kind"])])
            .collect()
    };
    let both = json("trunk_lid,front_door", 0);
    assert_eq!(both["as_expected"], true);
    assert_eq!(both["missing"], Value::Array(vec![]));
    assert_eq!(reasons(&both), [["front_door", ""], ["trunk_lid", ""]]);
    let wrong = json("front_door,grille", 1);
    assert_eq!(wrong["as_expected"], false);
    assert_eq!(
        reasons(&wrong),
        [["front_door", ""], ["trunk_lid", "wrong_part"]]
    );
    let missing = json("front_door,trunk_lid,grille", 1);
    assert_eq!(missing["missing"], serde_json::json!(["grille"]));
    // It looks on beside a part that is not expected.
    let surplus = json("trunk_lid", 1);
    assert_eq!(
        reasons(&surplus),
        [["trunk_lid", ""], ["front_door", "not_expected"]]
    );

    let card = expecting("front_door,trunk_lid", &["--no-history"]).out;
    assert!(card.contains("as expected"), "{card}");
    let card = expecting("front_door,trunk_lid,grille", &["--no-history"]).out;
    assert!(
        card.contains("missing") && card.contains("grille"),
        "{card}"
    );
    let card = expecting("front_door,grille", &["--no-history"]).out;
    assert!(
        card.contains("wrong part: trunk_lid hangs there instead of grille"),
        "{card}"
    );
    let unknown = expecting("front_door,bonnet", &["--no-history"]);
    assert_eq!(unknown.code, 2);
    assert!(
        unknown.err.contains("bonnet is expected, but not enrolled")
            && unknown.err.contains("library list"),
        "{}",
        unknown.err
    );
    // The history knows what was expected of a frame.
    place.accepted(&["history", "keep", "all", "--history", "history"]);
    json("front_door,grille", 1);
    let listed = place.run(&["history", "list", "--history", "history", "--json"]);
    let newest = &listed.lines()[0];
    let again = [
        "history",
        "show",
        &newest["number"].to_string(),
        "--again",
        "--json",
    ];
    let options = ["--history", "history", "--library", "parts"];
    let again = &place.accepted(&[&again[..], &options].concat()).lines()[0];
    assert_eq!(again["again"]["same"], true, "{again}");
    assert_eq!(again["again"]["changed"], Value::Array(vec![]), "{again}");
    assert_eq!(again["verdict"], "not_accepted", "{again}");
    // What was missing is in the row of the first part alone.
    for (expected, missing) in [
        ("front_door|trunk_lid|grille", ["", "grille"]),
        ("trunk_lid", ["", ""]),
    ] {
        assert_eq!(recorded_as_missing(&place, expected), missing);
    }
}

/// What `history show` and the export say was missing, in the rows of frames in which these parts were expected.
fn recorded_as_missing(place: &Workplace, expected: &str) -> Vec<String> {
    let history = ["--history", "history"];
    let export = ["history", "export", "--csv", "all.csv"];
    place.accepted(&[&export[..], &history].concat());
    let table = place.read("all.csv");
    let columns = ["number", "expected", "missing"].map(|column| csv_column(&table, column));
    let [numbers, all_expected, all_missing] = columns;
    let mut found = Vec::new();
    for ((number, of_row), missing) in numbers.iter().zip(&all_expected).zip(all_missing) {
        if of_row != expected {
            continue;
        }
        let shown = place.accepted(&[&["history", "show", number], &history[..]].concat());
        let row = |name: &str| {
            let mut lines = shown.out.lines();
            let line = lines.find_map(|line| line.strip_prefix(name));
            line.unwrap_or_default().trim().replace(", ", "|")
        };
        assert_eq!([&row("expected"), &row("missing")], [of_row, &missing]);
        found.push(missing);
    }
    found.sort();
    found
}

#[test]
fn each_place_of_a_rack_may_expect_a_part_of_its_own() {
    let place = Workplace::new();
    for part in ["front_door", "trunk_lid", "grille"] {
        place.with_part(part);
    }
    two_parts(&place, "both.png");
    let add = ["rack", "add", "rack.toml", "both.png", "--each"];
    place.accepted(&[&add[..], &["--library", "parts"]].concat());
    place.write(
        "orders.csv",
        "order;parts\n4711;1=front_door|2=trunk_lid\n4712;1=trunk_lid|2=front_door\n",
    );
    let inspect = ["inspect", "both.png", "--library", "parts", "--no-history"];
    let run = |options: &[&str]| {
        let rack = ["--rack", "rack.toml"];
        place.run(&[&inspect[..], &rack, options].concat())
    };
    let text = |value: &Value| value.as_str().unwrap_or_default().to_owned();
    for (options, code, reasons) in [
        (&["--expect", "1=front_door,2=trunk_lid"][..], 0, ["", ""]),
        (&["--expect", "1=front_door,trunk_lid"], 0, ["", ""]),
        (&["--orders", "orders.csv", "--order", "4711"], 0, ["", ""]),
        (
            &["--expect", "1=trunk_lid,2=front_door"],
            1,
            ["wrong_part", "wrong_part"],
        ),
        (
            &["--orders", "orders.csv", "--order", "4712"],
            1,
            ["wrong_part", "wrong_part"],
        ),
        (
            &["--expect", "2=front_door"],
            1,
            ["wrong_part", "expected_elsewhere"],
        ),
    ] {
        let ran = run(&[options, &["--json"]].concat());
        assert_eq!(ran.code, code, "{options:?}: {}", ran.err);
        let line = ran.json();
        assert_eq!(line["as_expected"], code == 0, "{line}");
        let parts = line["parts"].as_array().expect("a list").iter();
        let mut found: Vec<String> = parts.map(|part| text(&part["reason_kind"])).collect();
        found.sort();
        let mut reasons = reasons.map(str::to_owned);
        reasons.sort();
        assert_eq!(found, reasons, "{line}");
    }
    let file = std::fs::read_to_string(place.path("rack.toml")).expect("a rack");
    let far = "[[place]]\nname = \"far\"\ncentre_mm = [9000, 0, 2000]\nsize_mm = [99, 99, 99]\n";
    place.write("rack.toml", &(file + far));
    let missing = ["--expect", "1=front_door,far=grille"];
    let line = run(&[&missing[..], &["--json"]].concat()).json();
    assert_eq!(
        line["expected"],
        serde_json::json!(["front_door", "grille"])
    );
    assert_eq!(line["expected_places"], serde_json::json!(["1", "far"]));
    assert_eq!(line["missing"], serde_json::json!(["grille"]));
    assert_eq!(line["missing_places"], serde_json::json!(["far"]));
    let card = run(&missing).out;
    assert!(card.contains("grille at far"), "{card}");
    for (expected, why) in [
        ("3=grille", "Give a place of the rack: 1, 2, far"),
        ("1=grille,1=front_door", "two parts are expected at place"),
    ] {
        let refused = run(&["--expect", expected]);
        assert_eq!(refused.code, 2, "{}", refused.err);
        assert!(refused.err.contains(why), "{}", refused.err);
    }
    let without = place.run(&[&inspect[..], &["--expect", "1=grille"]].concat());
    assert!(without.err.contains("--rack"), "{}", without.err);
}

#[test]
fn of_two_car_models_that_fit_equally_well_the_expected_one_is_found_and_never_the_other() {
    let place = Workplace::new();
    for model in ["0", "1"] {
        let file = format!("{model}.pcd");
        let simulate = ["simulate", "--part", "grille", "--model", model];
        let facing = ["--pose", "0 0 0 0 0 1.4", "--out", &file];
        place.accepted(&[&simulate[..], &facing].concat());
        let name = format!("grille_{model}");
        place.accepted(&["enrol", &file, "--name", &name, "--library", "parts"]);
    }
    // The score of the second frame is higher as the other model.
    for (model, other, seed, best) in [("0", "1", "2", "0"), ("1", "0", "3", "0")] {
        let simulate = ["simulate", "--part", "grille", "--model", model];
        let placed = ["--placement", "facing", "--seed", seed, "--out", "hung.png"];
        place.accepted(&[&simulate[..], &placed].concat());
        let inspect = ["inspect", "hung.png", "--library", "parts", "--no-history"];
        let found = |options: &[&str]| {
            let line = place.run(&[&inspect[..], &["--json"], options].concat());
            let line = line.json();
            let part = line["part"].as_str().unwrap_or_default().to_owned();
            (part, line["accepted"].as_bool())
        };
        let grille = |model: &str| format!("grille_{model}");
        assert_eq!(found(&[]), (grille(best), Some(false)));
        let right = found(&["--expect", &grille(model)]);
        assert_eq!(right, (grille(model), Some(true)));
        assert_eq!(found(&["--expect", &grille(other)]).1, Some(false));
    }
}

#[test]
fn the_history_lists_what_hung_in_a_rack_by_its_name() {
    let place = Workplace::new();
    for part in ["front_door", "trunk_lid"] {
        place.with_part(part);
    }
    two_parts(&place, "both.png");
    let library = ["--library", "parts", "--history", "history"];
    let add = ["rack", "add", "left.toml", "both.png", "--each"];
    place.accepted(&[&add[..], &library[..2]].concat());
    let rack = place.read("left.toml");
    let renamed = rack.replacen("name = \"1\"", "name = \"front hook\"", 1);
    assert_ne!(renamed, rack);
    place.write("left.toml", &renamed);
    let inspect = ["inspect", "both.png"];
    place.accepted(&[&inspect[..], &library, &["--rack", "left.toml"]].concat());
    place.accepted(&[&inspect[..], &library].concat());
    let listed = |options: &[&str]| {
        let list = ["history", "list", "--history", "history", "--json"];
        place.accepted(&[&list[..], options].concat()).lines()
    };
    for (options, num) in [
        (&[][..], 3),
        (&["--rack", "left"], 2),
        (&["--rack", "LEFT"], 0),
        (&["--text", "LEFT"], 2),
    ] {
        let rows = listed(options);
        assert_eq!(rows.len(), num, "{options:?}: {rows:?}");
        let in_rack = rows.iter().filter(|row| row["rack"] == "left").count();
        assert_eq!(in_rack, 2.min(num), "{options:?}: {rows:?}");
    }
    let export = ["history", "export", "--history", "history"];
    place.accepted(&[&export[..], &["--csv", "all.csv"]].concat());
    let table = place.read("all.csv");
    let columns = ["place", "place_number"].map(|column| csv_column(&table, column));
    let mut places: Vec<[&str; 2]> = (columns[0].iter().zip(&columns[1]))
        .map(|(name, number)| [name.as_str(), number.as_str()])
        .collect();
    places.sort_unstable();
    assert_eq!(places, [["", ""], ["2", "2"], ["front hook", "1"]]);
}

#[test]
fn the_table_of_orders_says_what_should_hang_there() {
    let place = Workplace::new();
    for part in ["front_door", "trunk_lid", "grille"] {
        place.with_part(part);
    }
    two_parts(&place, "both.png");
    place.write(
        "orders.csv",
        "order;serial;parts\n4711;;\"front_door;trunk_lid\"\n4711;TL-1;front_door|grille\n4712;;bonnet\n",
    );
    let inspect = ["inspect", "both.png", "--library", "parts", "--no-history"];
    let run = |options: &[&str]| place.run(&[&inspect[..], options].concat());
    let with = |options: &[&str]| run(&[&["--json", "--orders", "orders.csv"], options].concat());
    let right = with(&["--order", "4711"]);
    assert_eq!(
        (right.code, &right.json()["as_expected"]),
        (0, &Value::Bool(true)),
        "{}",
        right.err
    );
    let wrong = with(&["--order", "4711", "--serial", "TL-1"]);
    assert_eq!(wrong.code, 1, "{}", wrong.err);
    assert_eq!(wrong.json()["parts"][1]["reason_kind"], "wrong_part");
    for (options, what) in [
        (
            &["--order", "471"][..],
            "order 471 is not in the table of orders",
        ),
        (&[], "no order is given"),
        (
            &["--order", "4712"],
            "orders.csv, line 4, column parts: bonnet is expected, but not enrolled",
        ),
        (
            &["--order", "4711", "--expect", "grille"],
            "cannot be used with",
        ),
    ] {
        let refused = with(options);
        assert_eq!((refused.code, &*refused.out), (2, ""), "{options:?}");
        assert!(refused.err.contains(what), "{}", refused.err);
    }
    place.write("orders.csv", "order;parts\n4711;\n");
    let empty = with(&["--order", "4711"]);
    assert!(
        empty
            .err
            .contains("line 2, column parts: the cell is empty"),
        "{}",
        empty.err
    );
}

#[test]
fn one_bad_file_does_not_stop_the_others() {
    let place = Workplace::new();
    place.with_part("fender");
    fs::write(place.path("bad.pcd"), "VERSION 0.7\nnothing").expect("written");
    let files = ["bad.pcd", "fender.pcd", "missing.pcd"];
    let ran = place.run(&[&["inspect", "--json", "--library", "parts"], &files[..]].concat());
    assert_eq!(ran.code, 2);
    let lines = ran.lines();
    let of = |key: &str| lines.iter().map(|l| l[key].clone()).collect::<Vec<_>>();
    assert_eq!(of("scene"), files);
    assert_eq!(of("status"), ["unreadable", "ok", "unreadable"]);
    assert_eq!(of("accepted"), [false, true, false]);
    assert!(
        lines[0]["reason"]
            .as_str()
            .expect("words")
            .contains("bad.pcd")
    );
    assert!(ran.err.contains("to do:"), "{}", ran.err);

    let rows = place.run(&[&["inspect", "--library", "parts"], &files[..]].concat());
    assert_eq!(rows.code, 2);
    assert!(
        rows.out.contains("unreadable") && rows.out.contains("accepted"),
        "{}",
        rows.out
    );
}

#[test]
fn an_empty_cell_and_an_unknown_part_are_not_accepted() {
    let place = Workplace::new();
    place.with_part("grille");
    // The part is far too high: only wall and floor are in the picture.
    let away = [
        "simulate",
        "--part",
        "grille",
        "--pose",
        "0 0 0 0 -5 1.4",
        "--out",
        "empty.pcd",
    ];
    place.accepted(&away);
    let other = [
        "simulate",
        "--part",
        "front_door",
        "--placement",
        "facing",
        "--out",
        "other.pcd",
    ];
    place.accepted(&other);
    let ran = place.run(&[
        "inspect",
        "empty.pcd",
        "other.pcd",
        "--json",
        "--library",
        "parts",
    ]);
    assert_eq!(ran.code, 1, "{}", ran.err);
    let lines = ran.lines();
    assert_eq!(lines[0]["status"], "no_part");
    assert_eq!(lines[0]["part"], Value::Null);
    assert_eq!(lines[1]["status"], "unknown");
    assert_eq!(lines[1]["part"], Value::Null);
    assert_eq!(lines[1]["reason_kind"], "unknown");
    for line in &lines {
        assert_eq!(line["accepted"], false);
        assert!(line["reason"].is_string() && line["reason_kind"].is_string());
    }
    let card = place.run(&["inspect", "other.pcd", "--library", "parts"]);
    assert!(
        card.out.contains("why not") && card.out.contains("to do"),
        "{}",
        card.out
    );
    // What is like no part has no pose of one; the line of JSON still has that of the best match.
    assert!(lines[1]["score"].as_f64().expect("a score") < 0.05);
    assert!(lines[1]["pose"]["camera_from_part"].is_array());
    for label in ["  middle ", "  turn ", "  fit ", "  bounds "] {
        assert!(!card.out.contains(label), "{label}: {}", card.out);
    }
}

#[test]
fn what_stands_in_the_empty_cell_is_no_part_and_a_second_reference_names_its_part() {
    let place = Workplace::new();
    place.with_part("fender");
    let seen = |name: &'static str, options: &[&'static str]| {
        let simulate = [
            "simulate",
            "--part",
            "fender",
            "--placement",
            "facing",
            "--out",
            name,
        ];
        place.accepted(&[&simulate, options].concat());
    };
    seen("scene.pcd", &["--seed", "8"]);
    // If the empty cell contains the fender, it is background.
    let inspect = ["inspect", "scene.pcd", "--json", "--library", "parts"];
    let empty = place.run(&[&inspect[..], &["--empty-cell", "scene.pcd"]].concat());
    assert_eq!(empty.code, 1, "{}", empty.err);
    assert_eq!(empty.lines()[0]["status"], "no_part");
    let command = ["inspect", "scene.pcd", "--library", "parts"];
    let ran = place.run(&[&command[..], &["--empty-cell", "scene.pcd"]].concat());
    let output = ran.out + &ran.err;
    assert!(output.contains("the empty cell was captured"), "{output}");
    seen("other_make.pcd", &["--model", "5"]);
    let enrol = [
        "enrol",
        "other_make.pcd",
        "--name",
        "fender_b",
        "--as",
        "fender",
    ];
    place.accepted(&[&enrol[..], &["--library", "parts"]].concat());
    seen("other_scene.pcd", &["--model", "5", "--seed", "9"]);
    let line = place
        .run(&["inspect", "other_scene.pcd", "--json", "--library", "parts"])
        .lines()
        .remove(0);
    assert_eq!(
        (&line["part"], &line["accepted"]),
        (&"fender".into(), &true.into())
    );
    assert_eq!(line["ranking"].as_array().map(Vec::len), Some(1));
    // The pose is in the coordinates of this reference, not in those of the part's first one.
    assert_eq!(line["pose"]["reference"], "fender_b");
    let command = place.accepted(&["inspect", "other_scene.pcd", "--library", "parts"]);
    assert!(
        command
            .out
            .contains("fender_b, another reference of this part"),
        "{}",
        command.out
    );
    let own = place.accepted(&["inspect", "scene.pcd", "--json", "--library", "parts"]);
    assert_eq!(own.lines()[0]["pose"]["reference"], "fender");
    let report = [
        "report",
        "other_scene.pcd",
        "--library",
        "parts",
        "--out",
        "reports",
    ];
    place.accepted(&report);
    let report = place.json("reports/other_scene.pose.json");
    let pose = &report["pose"];
    assert_eq!(pose["reference"], "fender_b");
    let cautions = pose["cautions"].to_string();
    assert!(
        cautions.contains("a standard position of its own"),
        "{cautions}"
    );
}

#[test]
fn the_paper_can_be_chosen_and_the_pose_left_out() {
    let place = Workplace::new();
    place.with_part("fender");
    let inspect = [
        "inspect",
        "fender-reference.pcd",
        "--json",
        "--library",
        "parts",
    ];
    let line = |more: &[&str]| place.run(&[&inspect[..], more].concat()).lines().remove(0);
    let icp = line(&["--matcher", "paper", "--pose", "icp"]);
    assert_eq!(
        (&icp["part"], &icp["pose"]["method"]),
        (&"fender".into(), &"icp".into())
    );
    assert_eq!(line(&["--pose", "none"])["pose"], Value::Null);
}

#[test]
fn any_parameter_can_be_set_and_what_is_no_value_is_refused() {
    let place = Workplace::new();
    place.with_part("fender");
    let inspect = ["inspect", "fender-reference.pcd", "--library", "parts"];
    let with = |more: &[&'static str]| [&inspect[..], more].concat();
    place.accepted(&inspect);
    let strict = place.coded(1, &with(&["--json", "--set", "accept.min_score=1"]));
    assert_eq!(strict.lines()[0]["accepted"], false);
    let icp = with(&["--json", "--set", "pose=icp", "--set", "rank.matcher=paper"]);
    assert_eq!(place.run(&icp).lines()[0]["pose"]["method"], "icp");
    for (setting, expected) in [
        ("segment.plane_distance=90", "it ranges from 1 to 50 mm"),
        ("plane_distance=9", "the nearest is segment.plane_distance"),
        ("accept.min_score", "no = between name and value"),
    ] {
        let refused = place.coded(2, &with(&["--set", setting]));
        assert!(refused.err.contains(expected), "{setting}: {}", refused.err);
    }
}

#[test]
fn a_report_holds_the_line_and_a_picture_of_every_stage() {
    let place = Workplace::new();
    place.with_part("fender");
    fs::create_dir(place.path("again")).expect("made");
    fs::copy(place.path("fender.pcd"), place.path("again/fender.pcd")).expect("copied");
    let files = ["fender.pcd", "again/fender.pcd", "missing.pcd"];
    let inspect = [
        "inspect",
        "--json",
        "--library",
        "parts",
        "--report",
        "why/deep",
    ];
    let ran = place.run(&[&inspect[..], &files].concat());
    assert_eq!(ran.code, 2);
    let output = "The reports are in why/deep";
    assert!(ran.err.contains(output), "{}", ran.err);
    let read = |name: &str| fs::read_to_string(place.path("why/deep").join(name)).expect("there");
    let written = [
        "fender.report.json",
        "fender-2.report.json",
        "missing.report.json",
    ]
    .map(read)
    .concat();
    assert_eq!(written, ran.out);
    for stage in ["segmentation", "binary", "contour", "signature"] {
        let picture = place.path("why/deep").join(format!("fender.{stage}.png"));
        assert!(image::open(picture).is_ok(), "{stage}");
    }
    let nowhere = [
        "inspect",
        "fender.pcd",
        "--library",
        "parts",
        "--report",
        "fender.pcd",
    ];
    assert_eq!(place.run(&nowhere).code, 2);
    // Where nothing could be written, no reports are said to be.
    fs::create_dir_all(place.path("taken/fender.report.json")).expect("made");
    let inspect = ["inspect", "fender.pcd", "--library", "parts"];
    let ran = place.run(&[&inspect[..], &["--report", "taken"]].concat());
    assert_eq!(ran.code, 2);
    assert!(
        ran.err.contains("fender.report.json") && !ran.err.contains("The reports are in"),
        "{}",
        ran.err
    );
}

#[test]
fn a_part_that_runs_out_of_the_picture_is_found_and_that_is_said() {
    let place = Workplace::new();
    place.with_part("front_door");
    for (x, is_cut) in [("0", false), ("600mm", true)] {
        let pose = format!("0 0 0 {x} 0 1500mm");
        let door = ["simulate", "--part", "front_door", "--out", "door.pcd"];
        place.accepted(&[&door[..], &["--pose", &pose]].concat());
        let ran = place.run(&["inspect", "door.pcd", "--json", "--library", "parts"]);
        let line = &ran.lines()[0];
        assert_eq!(line["touches_edge"], is_cut, "{line}");
        assert_eq!(line["part"], "front_door", "{line}");
        let card = place.run(&["inspect", "door.pcd", "--library", "parts"]);
        let is_said = card.out.contains("reaches the picture's edge");
        assert_eq!(is_said, is_cut, "{}", card.out);
    }
}

#[test]
fn a_report_beside_its_captures_leaves_them_as_they_were() {
    let place = Workplace::new();
    place.with_part("fender");
    fs::create_dir(place.path("cap")).expect("made");
    // The second and third captures have the names of files that a report on the first would write.
    let files = ["cap/g1.png", "cap/g1.contour.png", "cap/g1.report.png"];
    for file in files {
        place.accepted(&["simulate", "--part", "fender", "--out", file]);
    }
    let contents = || {
        let json = files.map(|f| f.replace(".png", ".json"));
        let all = files.iter().map(|f| (*f).to_owned()).chain(json);
        all.map(|f| fs::read(place.path(&f)).expect("there"))
            .collect::<Vec<_>>()
    };
    let before = contents();
    let inspect = ["inspect", "--library", "parts", "--report", "cap"];
    for _ in 0..2 {
        place.run(&[&inspect[..], &files].concat());
        assert!(contents() == before, "a capture was overwritten");
    }
    assert!(place.path("cap/g1.contour.report.json").exists());
    let num_files = fs::read_dir(place.path("cap")).expect("listed").count();
    place.run(&[&inspect[..], &files].concat());
    let again = fs::read_dir(place.path("cap")).expect("listed").count();
    assert_eq!(num_files, again, "an earlier report is replaced");
}

#[test]
fn a_pose_that_is_not_found_is_a_line_with_its_reason_and_names_the_file() {
    let place = Workplace::new();
    place.with_part("fender");
    fs::write(place.path("few.xyz"), "0 0 1\n1 0 1\n0 1 1\n").expect("written");
    let ran = place.run(&["align", "few.xyz", "parts/fender/cloud.ply", "--json"]);
    assert_eq!(ran.code, 1, "{}", ran.err);
    let line = &ran.lines()[0];
    assert_eq!(line["target_from_source"], Value::Null);
    assert!(line["reason"].as_str().expect("words").contains("3 points"));
    assert!(
        ran.err.contains("few.xyz: ") && !ran.err.contains("cloud.ply: "),
        "{}",
        ran.err
    );
    let enrol = place.run(&["enrol", "few.xyz", "--name", "few", "--library", "parts"]);
    assert!(
        enrol.err.contains("few.xyz: the cloud has 3 points"),
        "{}",
        enrol.err
    );
    let title = "t".repeat(81);
    let long = ["enrol", "few.xyz", "--name", "few", "--title", &title];
    assert!(place.run(&long).err.contains("at most 80"));
}

#[test]
fn the_card_names_a_margin_and_no_difference_of_scores() {
    let place = Workplace::new();
    let simulate = ["simulate", "--part", "fender", "--placement", "facing"];
    place.accepted(&[&simulate[..], &["--out", "fender.pcd"]].concat());
    let card = place.accepted(&["inspect", "fender.pcd"]).out;
    assert!(
        card.contains(", margin ") && !card.contains("ahead of"),
        "{card}"
    );
}

#[test]
fn only_the_command_line_names_the_option_for_millimetres() {
    let place = Workplace::new();
    let points = (0..2500).map(|i| format!("{} {} 1400\n", 20 * (i % 50), 20 * (i / 50)));
    let cloud = points.collect::<Vec<_>>().concat();
    place.write("part.xyz", &cloud);
    let ran = place.run(&["inspect", "part.xyz"]);
    assert!(ran.err.contains("--units mm"), "{}", ran.err);
}

#[test]
fn a_depth_image_in_the_wrong_unit_is_advised_on_its_json() {
    let place = Workplace::new();
    place.accepted(&["simulate", "--part", "fender", "--out", "fender.png"]);
    let mut camera = place.json("fender.json");
    camera["metres_per_unit"] = 1.into();
    place.write("fender.json", &camera.to_string());
    let ran = place.coded(1, &["inspect", "fender.png"]);
    let shown = ran.out + &ran.err;
    assert!(shown.contains("correct metres_per_unit"), "{shown}");
}

#[test]
fn a_capture_in_metres_that_is_read_as_millimetres_gets_a_hint_on_its_unit() {
    let place = Workplace::new();
    place.accepted(&["simulate", "--part", "fender", "--out", "fender.pcd"]);
    let ran = place.coded(1, &["inspect", "fender.pcd", "--units", "mm"]);
    assert!(ran.err.contains("the points span only"), "{}", ran.err);
    assert!(ran.err.contains("--units m,"), "{}", ran.err);
}
