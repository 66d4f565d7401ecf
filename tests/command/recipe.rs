//! Recipes as files: made, used, exported, and refused.

use std::fs;

use crate::workplace::Workplace;

#[test]
fn a_saved_recipe_is_used_by_name_by_file_and_by_default() {
    let place = Workplace::new();
    place.with_part("fender");
    let inspect = |code: i32, more: &[&str]| {
        let args = [
            &["inspect", "fender.pcd", "--json", "--library", "parts"],
            more,
        ]
        .concat();
        place.coded(code, &args).json()
    };
    let plain = inspect(0, &[]);
    assert_eq!(plain["recipe"]["name"], "built-in");
    assert_eq!(plain["recipe"]["is_changed"], false);
    let changed = inspect(1, &["--set", "accept.min_score=1"]);
    assert_eq!(changed["recipe"]["is_changed"], true);

    let strict = ["--set", "accept.min_score=1", "--set", "project.pixel=4 mm"];
    let save = [
        &["recipe", "save", "strict", "--notes", "no doubt"],
        &strict[..],
    ]
    .concat();
    let saved = place.accepted(&save);
    assert!(
        saved.out.contains("2 changed from default"),
        "{}",
        saved.out
    );
    let by_name = inspect(1, &["--recipe", "strict"]);
    assert_eq!(by_name["recipe"]["name"], "strict");
    assert_eq!(by_name["recipe"]["is_changed"], false);
    assert_ne!(by_name["recipe"]["identity"], plain["recipe"]["identity"]);
    // References and scene are prepared with the same parameters.
    assert_eq!(by_name["part"], "fender");
    assert_eq!(inspect(1, &strict)["score"], by_name["score"]);
    assert_eq!(
        inspect(1, &strict)["recipe"]["identity"],
        by_name["recipe"]["identity"]
    );
    let loosened = inspect(0, &["--recipe", "strict", "--set", "accept.min_score=0.9"]);
    assert_eq!(loosened["recipe"]["name"], "strict");
    assert_eq!(loosened["recipe"]["is_changed"], true);

    place.accepted(&["recipe", "export", "strict", "stick.toml"]);
    place.accepted(&["recipe", "remove", "strict"]);
    let by_file = inspect(1, &["--recipe", "stick.toml"]);
    assert_eq!(by_file["recipe"], by_name["recipe"]);
    place.accepted(&["recipe", "import", "stick.toml"]);
    let chosen = place.accepted(&["recipe", "default", "strict"]);
    assert_eq!(chosen.out, "Commands without --recipe now use strict\n");
    assert_eq!(inspect(1, &[])["recipe"]["name"], "strict");
    assert_eq!(
        inspect(0, &["--recipe", "built-in"])["recipe"]["name"],
        "built-in"
    );

    // History and reports hold the name.
    let history = place.accepted(&["history", "show", "1", "--json"]).json();
    assert_eq!(history["recipe_name"], "built-in");
    place.accepted(&["history", "export", "--csv", "all.csv"]);
    let csv = place.read("all.csv");
    assert!(
        csv.lines().any(|line| line.contains(",strict,true,,,,")),
        "{csv}"
    );
    place.coded(
        1,
        &[
            "report",
            "fender.pcd",
            "--library",
            "parts",
            "--out",
            "out",
            "--format",
            "json",
        ],
    );
    let report = fs::read_dir(place.path("out")).expect("written").next();
    let report = place.json(report.expect("a report").expect("a report").path());
    assert_eq!(report["recipe"]["name"], "strict");
    assert_eq!(report["recipe"]["identity"], by_name["recipe"]["identity"]);

    let list = place.accepted(&["recipe", "list", "--json"]).lines();
    let names: Vec<_> = list.iter().map(|line| line["name"].clone()).collect();
    assert_eq!(names, ["built-in", "as-in-the-paper", "strict"]);
    assert_eq!(list[2]["is_default"], true);
    assert_eq!(list[2]["notes"], "no doubt");
    let show = place
        .accepted(&["recipe", "show", "strict", "--json"])
        .json();
    let changed = show["changed"].as_array().expect("a list");
    assert_eq!(changed.len(), 2);
    assert_eq!(changed[0]["parameter"], "project.pixel");
    assert_eq!(changed[0]["value"], "4 mm");
    assert_eq!(changed[0]["against"], "5 mm");
}

#[test]
fn what_a_recipe_expects_counts_until_something_else_is_expected() {
    let place = Workplace::new();
    place.with_part("fender");
    let rack = "schema_version = 1
[[place]]
name = \"left hook\"
centre_mm = [0, 0, 1500]
size_mm = [3000, 3000, 3000]
";
    fs::write(place.path("rack.toml"), rack).expect("written");
    for (name, expect) in [
        ("own", "fender"),
        ("hook", "left hook=fender"),
        ("no_part", "bonnet"),
        ("no_place", "right hook=fender"),
        ("two", "left hook=fender,left hook=fender"),
    ] {
        place.accepted(&["recipe", "save", name, "--expect", expect]);
    }
    let inspect = |code: i32, more: &[&str]| {
        let args = ["inspect", "fender.pcd", "--json", "--library", "parts"];
        place.coded(code, &[&args, more].concat())
    };
    let own = inspect(0, &["--recipe", "own"]).json();
    assert_eq!(own["expected"], serde_json::json!(["fender"]));
    assert_eq!(own["as_expected"], true);
    assert_eq!(own["recipe"]["is_changed"], false);
    let hook = ["--rack", "rack.toml", "--recipe", "hook"];
    let at_hook = inspect(0, &hook).json();
    assert_eq!(at_hook["expected_places"], serde_json::json!(["left hook"]));
    let other = [&hook[..], &["--expect", "fender,fender"]].concat();
    let other = inspect(1, &other).json();
    assert_eq!(other["missing"], serde_json::json!(["fender"]));
    assert_eq!(other.get("expected_places"), None);
    // Frames of other parts are evaluated, and enrolled.
    place.accepted(&[
        "rack",
        "add",
        "new.toml",
        "fender.pcd",
        "--place",
        "1",
        "--recipe",
        "no_part",
        "--library",
        "parts",
    ]);
    for (name, why) in [
        (
            "no_part",
            "recipe no_part: bonnet is expected, but not enrolled",
        ),
        (
            "hook",
            "recipe hook: a part is expected at place \"left hook\", which the rack does not have",
        ),
    ] {
        let error = inspect(2, &["--recipe", name]).err;
        assert!(error.contains(why), "{error}");
    }
    let show = |code: i32, name: &str, more: &[&str]| {
        let args = ["recipe", "show", name, "--library", "parts"];
        place.coded(code, &[&args, more].concat())
    };
    let shown = show(0, "hook", &["--rack", "rack.toml"]).out;
    assert!(
        shown.contains("left hook=fender") && !shown.contains("same as"),
        "{shown}"
    );
    let json = show(0, "hook", &["--json"]).json();
    assert_eq!(json["expect"], serde_json::json!(["left hook=fender"]));
    assert_eq!(json["changed"], serde_json::json!([]));
    for (name, why) in [
        ("no_part", "bonnet is expected, but not enrolled"),
        (
            "no_place",
            "place \"right hook\", which the rack does not have",
        ),
        ("two", "two parts are expected at place \"left hook\""),
    ] {
        let warning = show(1, name, &["--rack", "rack.toml"]).err;
        assert!(warning.contains(why), "{warning}");
    }
}

#[test]
fn a_recipe_segments_what_is_enrolled_and_evaluated() {
    let place = Workplace::new();
    place.accepted(&["simulate", "--part", "fender", "--out", "fender.pcd"]);
    let enrol = [
        "enrol",
        "fender.pcd",
        "--name",
        "fender",
        "--library",
        "parts",
    ];
    let refused = place.coded(
        2,
        &[&enrol[..], &["--set", "segment.min_part_area=10000"]].concat(),
    );
    assert!(refused.err.contains("fender.pcd"), "{}", refused.err);
    place.accepted(&[
        "recipe",
        "save",
        "large",
        "--set",
        "segment.min_part_area=10000",
    ]);
    place.coded(2, &[&enrol[..], &["--recipe", "large"]].concat());
    place.accepted(&enrol);
    place.accepted(&[
        "simulate", "--cases", "cases", "--part", "fender", "--num", "1",
    ]);
    let evaluate = [
        "evaluate",
        "cases",
        "--library",
        "parts",
        "--recipe",
        "large",
        "--json",
        "e.json",
    ];
    place.accepted(&evaluate);
    let record = place.json("e.json");
    assert_eq!(record["recipe"]["name"], "large");
    assert_eq!(
        record["tally"]["accepted"].as_u64().unwrap_or(0),
        0,
        "{}",
        record["tally"]
    );
}

#[test]
fn a_recipe_that_cannot_be_used_stops_the_command_with_advice() {
    let place = Workplace::new();
    let with = |recipe: &str| {
        let ran = place.coded(2, &["inspect", "none.pcd", "--recipe", recipe]);
        assert_eq!(ran.out, "");
        assert!(ran.err.contains("to do: "), "{}", ran.err);
        ran.err
    };
    place.accepted(&["recipe", "save", "glossy"]);
    assert!(with("glosy").contains("nearest name is glossy"));
    let other = with("abcdefgh");
    assert!(
        other.contains("partsight recipe list") && !other.contains("nearest"),
        "{other}"
    );
    place.write(
        "bad.toml",
        "schema = 1\nname = \"x\"\n[parameters]\naccept.min_score = 7\n",
    );
    assert!(with("bad.toml").contains("from 0 to 1"));
    place.write("new.toml", "schema = 9\nname = \"x\"\n");
    assert!(with("new.toml").contains("schema 9"));
    place.write(
        "own.toml",
        "schema = 1\nname = \"built-in\"\n[parameters]\naccept.min_score = 0.5\n",
    );
    let own = with("own.toml");
    assert!(own.contains("own.toml: built-in is the name of"), "{own}");
    assert!(own.contains("another name in the file"), "{own}");
    // Its parameters may be kept under another name, and the program's own recipe may be a file.
    place.accepted(&["recipe", "import", "own.toml", "--name", "loose"]);
    place.accepted(&["recipe", "export", "built-in", "exported.toml"]);
    let exported = place.accepted(&["recipe", "show", "exported.toml"]);
    assert!(exported.out.contains("same as"), "{}", exported.out);
    fs::create_dir(place.path("folder.toml")).expect("made");
    with("folder.toml");
    place.write("large.toml", &"# \n".repeat(1 << 16));
    with("large.toml");

    let refused = |args: &[&str], words: &str| {
        let ran = place.coded(2, &[&["recipe"], args].concat());
        assert!(ran.err.contains(words), "{args:?}: {}", ran.err);
    };
    refused(&["save", "glossy"], "--replace");
    refused(&["save", "built-in"], "cannot be changed");
    refused(&["save", "Glossy"], "is not a valid name");
    refused(&["remove", "built-in"], "cannot be changed");
    refused(&["default", "matt"], "no recipe named matt");
    refused(&["import", "bad.toml"], "from 0 to 1");
    refused(&["export", "glossy", "no/such/folder/x.toml"], "to do: ");
    place.accepted(&[
        "recipe",
        "save",
        "glossy",
        "--replace",
        "--set",
        "pose=none",
    ]);

    // If the default recipe is missing, no other parameters are used instead.
    place.accepted(&["recipe", "default", "glossy"]);
    fs::remove_file(place.path("data/partsight/recipes/glossy.toml")).expect("there");
    let ran = place.coded(2, &["inspect", "none.pcd"]);
    assert!(
        ran.err.contains("the default recipe glossy cannot be used"),
        "{}",
        ran.err
    );
    place.accepted(&["recipe", "default", "built-in"]);
}

#[test]
fn files_that_cannot_be_used_are_named_and_the_others_are_listed() {
    let place = Workplace::new();
    place.accepted(&["recipe", "save", "glossy"]);
    let recipes = "data/partsight/recipes";
    place.write(&format!("{recipes}/Upper.toml"), "schema = 1\n");
    place.write(&format!("{recipes}/bad.toml"), "schema = 9\n");
    place.write(&format!("{recipes}/default"), "");
    let listed = place.accepted(&["recipe", "list"]);
    assert!(listed.out.contains("glossy"), "{}", listed.out);
    for words in ["Upper.toml", "bad.toml", "recipe default built-in"] {
        assert!(listed.err.contains(words), "{}", listed.err);
    }
    // They stay where they are.
    assert!(!listed.err.contains("aside"), "{}", listed.err);
    let refused = place.coded(2, &["inspect", "none.pcd"]);
    assert!(
        refused.err.contains("recipe default built-in"),
        "{}",
        refused.err
    );
    place.accepted(&["recipe", "rename", "glossy", "shiny"]);
    place.accepted(&["recipe", "remove", "shiny"]);
    place.accepted(&["recipe", "default", "built-in"]);
    assert_eq!(place.accepted(&["recipe", "default"]).out, "built-in\n");
}

#[test]
fn a_renamed_recipe_stays_what_it_is_and_takes_no_other_ones_name() {
    let place = Workplace::new();
    for (name, score) in [("glossy", "0.85"), ("matt", "0.8")] {
        let score = format!("accept.min_score={score}");
        place.accepted(&["recipe", "save", name, "--set", &score]);
    }
    place.accepted(&["recipe", "default", "glossy"]);
    let taken = place.coded(2, &["recipe", "rename", "glossy", "matt"]);
    assert!(
        taken.err.contains("there is a recipe named matt already"),
        "{}",
        taken.err
    );
    let same = place.coded(2, &["recipe", "rename", "glossy", "glossy"]);
    assert!(!same.err.contains("replace"), "{}", same.err);
    let renamed = place.accepted(&["recipe", "rename", "glossy", "shiny"]);
    assert!(
        renamed.out.contains("glossy is now named shiny"),
        "{}",
        renamed.out
    );
    assert_eq!(place.accepted(&["recipe", "default"]).out, "shiny\n");
    let shown = place
        .accepted(&["recipe", "show", "shiny", "--json"])
        .json();
    assert_eq!(shown["changed"][0]["value"], "0.85");
    place.coded(2, &["recipe", "show", "glossy"]);
    let same = place.accepted(&["recipe", "show", "built-in"]);
    assert!(
        same.out.contains("same as") && !same.out.contains(" 0 "),
        "{}",
        same.out
    );
    let refused = place.coded(2, &["inspect", "x.pcd", "--set", "accept.min_score=8"]);
    assert!(
        refused
            .err
            .contains("accept.min_score (Accept from) cannot be 8"),
        "{}",
        refused.err
    );
}
